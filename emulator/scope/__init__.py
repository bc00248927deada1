"""The scope: signals of a unit by name, recorded at servo rate.

unit_scope  what to record, when, and the recording as arrays    files  as CSV, numpy and pictures
command     `oem6250 scope`
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.scope.unit_scope import Recording, ScopeError, UnitScope

__all__ = ["Recording", "ScopeError", "UnitScope"]


def __getattr__(name: str) -> Any:
    """The names above, when they are asked for: the command line imports this package for its options alone."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from emulator.scope import unit_scope

    return getattr(unit_scope, name)

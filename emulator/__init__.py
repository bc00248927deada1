"""An OEM6250 motion controller that host software can be plugged into.

Importing this package costs next to nothing: `oem6250 --help` must answer at once, and numba and numpy take half a
second to import. `Emulator`, `Machine` and `MachineError` are therefore looked up on first use (PEP 562).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.emulator import Emulator
    from emulator.machine import Machine, MachineError

__version__ = "0.1.0"

__all__ = ["Emulator", "Machine", "MachineError", "__version__"]

_HOME_OF = {"Emulator": "emulator.emulator", "Machine": "emulator.machine", "MachineError": "emulator.machine"}


def __getattr__(name: str) -> Any:
    """Import the module that holds a public name the first time it is asked for."""
    if name not in _HOME_OF:
        raise AttributeError(f"module 'emulator' has no attribute {name!r}")
    import importlib

    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(__all__))

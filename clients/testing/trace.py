"""Signals of an axis over time, sample by sample, as numpy arrays: the emulator's scope in a test's terms.

trace = emu.trace("position error", axis=1)
emu.client.write("GO1")
emu.advance(1.0)
assert abs(trace.values).max() < 50
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.emulator import Unit

if TYPE_CHECKING:
    import numpy.typing as npt

ALIASES = {
    "commanded position": "position.commanded",
    "position": "position.encoder",
    "actual position": "position.encoder",
    "commanded velocity": "velocity.commanded",
    "velocity": "velocity.actual",
    "output": "dac",
}
"""What people call signals, beside the registry's names with blanks for dots."""


def signal_name(name: str, axis: int | None) -> str:
    """The registry's name of a signal: ``position error`` of axis 1 is ``axis1.position.error``."""
    plain = ALIASES.get(name.lower(), name.lower().replace(" ", "."))
    return plain if axis is None else f"axis{axis}.{plain}"


class Trace:
    """One signal being recorded; ``values`` and ``time_s`` are what there is of it up to now.

    It is an array to numpy: ``np.max(trace)``, ``trace[-1]``.
    """

    def __init__(self, scope: Any, name: str) -> None:
        self._scope = scope
        self.name = name

    @property
    def values(self) -> npt.NDArray[Any]:
        """The signal in its unit, one value a servo sample."""
        return np.asarray(self._scope.read()[self.name])

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """The virtual time of each value."""
        return np.asarray(self._scope.read().time_s)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.values, dtype=dtype)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]


def begin_trace(unit: Unit, name: str, *, axis: int | None, seconds: float | None) -> Trace:
    """Begin to record a signal.

    Raises:
        AttributeError: this emulator has no scope.
        ValueError: the signal cannot be recorded.
    """
    full = signal_name(name, axis)
    scope: Any = getattr(unit, "scope")  # noqa: B009 - not every emulator has one, and the type checker cannot know
    scope.record([full], seconds=seconds)
    return Trace(scope, full)

"""Signals of an axis over time, sample by sample, as numpy arrays: the emulator's scope in a test's terms.

trace = emu.trace("position error", axis=1)
emu.client.write("GO1")
emu.advance(1.0)
assert abs(trace.values).max() < 50
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

if TYPE_CHECKING:
    from emulator.emulator import Unit
    from emulator.scope import UnitScope

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


class Trace(NDArrayOperatorsMixin):
    """One signal being recorded; ``values`` and ``time_s`` are what there is of it up to now.

    It is an array wherever one is wanted: ``np.max(trace)``, ``abs(trace) < 50``, ``trace[-1]``, ``trace.max()``.
    """

    def __init__(self, scope: UnitScope, name: str) -> None:
        self._scope = scope
        self._ended: tuple[npt.NDArray[Any], npt.NDArray[np.float64]] | None = None
        self.name = name

    @property
    def values(self) -> npt.NDArray[Any]:
        """The signal in its unit, one value a servo sample."""
        return self._read()[0]

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """The virtual time of each value."""
        return self._read()[1]

    def end(self) -> None:
        """Keep what there is; the scope is wanted for something else."""
        self._ended = self._read()

    def _read(self) -> tuple[npt.NDArray[Any], npt.NDArray[np.float64]]:
        if self._ended is not None:
            return self._ended
        recording = self._scope.read()
        return np.asarray(recording[self.name]), np.asarray(recording.time_s)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.values, dtype=dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        arrays = [each.values if isinstance(each, Trace) else each for each in inputs]
        return getattr(ufunc, method)(*arrays, **options)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.values, name)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index: Any) -> Any:
        return self.values[index]


def begin_trace(unit: Unit, name: str, *, axis: int | None, seconds: float | None) -> Trace:
    """Begin to record a signal.

    Raises:
        ScopeError (a ValueError): the signal cannot be recorded.
    """
    full = signal_name(name, axis)
    unit.scope.record([full], seconds=seconds)
    return Trace(unit.scope, full)

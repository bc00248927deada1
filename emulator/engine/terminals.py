"""The wires of a unit and what the servo catches on them: home edges and index pulses.

The writing half of `Engine` that belongs to the outside world rather than to the servo.
"""

from __future__ import annotations

from .layout import AXIS, UNIT, word_of
from .memory import Memory, write_fields
from .readings import FEEDBACK, AxisReadings, axis_word
from .travel import Capture, home_active

_WIRES, _INPUTS, _REPORTED_WIRES = (word_of(UNIT, name) for name in ("wires", "inputs", "reported_wires"))
_OUTPUTS = word_of(UNIT, "outputs")
_OPERATED = axis_word("operated_switches")
_NO_WIRES = -1
"""A state of `reported_wires` that the wires can never have."""


class Terminals(AxisReadings):
    """Wires, inputs, home and index of one unit."""

    def __init__(self, memory: Memory) -> None:
        super().__init__(memory)
        self._memory = memory
        self._unit = memory.unit.ints
        self._stale = True

    def _write(self, axis_index: int, **fields: float | None) -> None:
        """Set those fields of an axis that are given."""
        given = {name: value for name, value in fields.items() if value is not None}
        write_fields(self._memory.axis[axis_index], AXIS, given)
        self._stale = True

    # Wires

    @property
    def wires(self) -> int:
        """Electrical state of limits, homes, drive faults and ENABLE, bits of `wire_mask`; 1 = grounded."""
        return self._unit[_WIRES]

    def set_wires(self, bits: int) -> None:
        """Set the state all wires have while no switch is operated; an operated switch changes its contact over."""
        self._unit[_WIRES] = bits ^ self._operated

    @property
    def resting_wires(self) -> int:
        """The state the wires have, or would have, while no switch is operated."""
        return self._unit[_WIRES] ^ self._operated

    @property
    def _operated(self) -> int:
        return sum(ints[_OPERATED] for ints in self._ints)

    def report_wires(self) -> None:
        """Report WIRES at the next system update, changed or not (an analogue voltage has changed)."""
        self._unit[_REPORTED_WIRES] = _NO_WIRES

    @property
    def inputs(self) -> int:
        """Electrical state of the programmable inputs, bit 0 = input 1; 1 = grounded."""
        return self._unit[_INPUTS]

    def set_inputs(self, bits: int) -> None:
        """Set the electrical state of all programmable inputs."""
        self._unit[_INPUTS] = bits

    def set_outputs(self, bits: int) -> None:
        """Tell which programmable outputs are on, bit 0 = output 1; for the scope, the servo has no use for it."""
        self._unit[_OUTPUTS] = bits

    # Home and index

    def set_home_level(self, axis_index: int, active_level: int) -> None:
        """1: a grounded home input is active (HOMLVL0), 0: an open one."""
        self._write(axis_index, home_active_level=active_level)

    def home_active(self, axis_index: int) -> bool:
        """Whether the home input is at its active level."""
        return bool(home_active(self._memory.units[0], self._memory.axes[axis_index]))

    def capture_home(self, axis_index: int, *, active: bool, direction: int) -> None:
        """Report HOME_EDGE when the home input becomes active (or inactive) with the encoder on the `direction` side
        (+1, -1) of where it is now."""
        self._write(
            axis_index,
            capture_mode=Capture.HOME_ON if active else Capture.HOME_OFF,
            capture_direction=direction,
            capture_origin_counts=self._ints[axis_index][FEEDBACK],
            home_was_active=self.home_active(axis_index),
        )

    def capture_index(self, axis_index: int) -> None:
        """Report INDEX at the first index pulse passed while the home input is active."""
        self._write(axis_index, capture_mode=Capture.INDEX)

    def cancel_capture(self, axis_index: int) -> None:
        """Wait for no edge or pulse any more."""
        self._write(axis_index, capture_mode=Capture.NONE)

"""Trigger inputs, mark sensors and position comparisons of one unit: what is asked of the servo between its samples.

Trigger n (from 0: TRG-A, TRG-B) belongs to encoder n. Positions are reported counts: what was latched is kept raw, so
a PSET after the capture moves it too (6000 Programmer's Guide PDF p. 128: captured values are offset).
"""

from __future__ import annotations

from typing import NamedTuple

from .layout import UNIT, word_of
from .readings import ANI_OFFSET, ENCODER_OFFSET, OFFSET, axis_word
from .terminals import Terminals
from .trigger_capture import COMPARISONS_ARMED, NO_TIME, SENSORS_FITTED, MarkSensor, take_edge

_INPUTS, _WORK, _TIME = (word_of(UNIT, name) for name in ("inputs", "trigger_work", "time_ns"))
_MASK, _LEVEL, _OPERATED = (axis_word(name) for name in ("trigger_mask", "trigger_active_level", "sensor_operated"))
_SENSOR, _COMPARING, _PASSED = (axis_word(name) for name in ("sensor_fitted", "compare_direction", "compare_passed_ns"))
_CAPTURED_NS, _CAPTURES = axis_word("captured_edge_ns"), axis_word("captures")
_OWN = tuple(axis_word(f"own_{name}_capture") for name in ("encoder", "commanded", "ani"))
_OTHER = tuple(axis_word(f"other_{name}_capture") for name in ("encoder", "commanded", "ani"))
_MASTER_SOURCE, _MASTER_INDEX, _MASTER_SIGN, _MASTER_RAW, _MASTER_COUNTS = (
    axis_word(f"master_{name}") for name in ("source", "index", "sign", "raw", "counts")
)
_MASTER_ENCODER, _MASTER_ANI = 1, 2


class CapturedPositions(NamedTuple):
    """What a trigger has latched of one axis, reported counts."""

    encoder: int
    commanded: int
    ani: int


class TriggerInputs(Terminals):
    """The part of `Engine` that belongs to instants between samples."""

    # Triggers.

    def connect_trigger(self, trigger_index: int, input_mask: int) -> None:
        """Say which bit of `inputs` a trigger is; it latches nothing before `arm_trigger`."""
        self._write(trigger_index, trigger_mask=input_mask, trigger_edge_ns=NO_TIME, captured_edge_ns=NO_TIME)

    def arm_trigger(
        self,
        trigger_index: int,
        *,
        armed: bool | None = None,
        active_level: int | None = None,
        lockout_ns: int | None = None,
    ) -> None:
        """Whether a trigger latches positions, at which edge (1: when it is grounded, 0: when it opens), and how long
        after a capture it latches none."""
        self._write(
            trigger_index, trigger_armed=armed, trigger_active_level=active_level, trigger_lockout_ns=lockout_ns
        )

    def set_inputs(self, bits: int) -> None:
        """Set the state all programmable inputs have while no mark is at a sensor; one at a mark changes its contact
        over. An active edge at a trigger happens now, at `time_ns`."""
        was = self._unit[_INPUTS]
        now = bits ^ self._at_marks
        self._unit[_INPUTS] = now
        for trigger_index, ints in enumerate(self._ints):
            if (was ^ now) & ints[_MASK] and bool(now & ints[_MASK]) == bool(ints[_LEVEL]):
                take_edge(self._memory.units[0], self._memory.axes[trigger_index], self._unit[_TIME])

    @property
    def resting_inputs(self) -> int:
        """The state the programmable inputs have, or would have, while no mark is at a sensor."""
        return self._unit[_INPUTS] ^ self._at_marks

    @property
    def _at_marks(self) -> int:
        return sum(ints[_OPERATED] for ints in self._ints)

    def captured_at_ns(self, trigger_index: int) -> int | None:
        """When a trigger last latched positions; None for never."""
        edge_ns = self._ints[trigger_index][_CAPTURED_NS]
        return None if edge_ns == NO_TIME else edge_ns

    def capture_count(self, trigger_index: int) -> int:
        """How often a trigger has latched positions since power-up."""
        return self._ints[trigger_index][_CAPTURES]

    def captured_positions(self, trigger_index: int, axis_index: int) -> CapturedPositions:
        """What a trigger latched of an axis when it last did; at first nothing but zeros."""
        ints = self._ints[axis_index]
        encoder, commanded, ani = (ints[word] for word in (_OWN if trigger_index == axis_index else _OTHER))
        return CapturedPositions(encoder - ints[ENCODER_OFFSET], commanded - ints[OFFSET], ani - ints[ANI_OFFSET])

    def master_at_capture(self, trigger_index: int, axis_index: int) -> int:
        """The master travel (`master_counts`) of a slave when a trigger last latched positions."""
        ints = self._ints[axis_index]
        master_index = ints[_MASTER_INDEX]
        words = _OWN if trigger_index == master_index else _OTHER
        encoder, commanded, ani = (self._ints[master_index][word] for word in words)
        latched = {_MASTER_ENCODER: encoder, _MASTER_ANI: ani}.get(ints[_MASTER_SOURCE], commanded)
        return ints[_MASTER_COUNTS] + ints[_MASTER_SIGN] * (latched - ints[_MASTER_RAW])

    def forget_captures(self) -> None:
        """Power-up: nothing is latched."""
        for axis_index in range(len(self._ints)):
            kept = {
                f"{whose}_{name}_capture": 0 for whose in ("own", "other") for name in ("encoder", "commanded", "ani")
            }
            self._write(axis_index, trigger_edge_ns=NO_TIME, captured_edge_ns=NO_TIME, captures=0, **kept)
            self._write(axis_index, trigger_locked_until_ns=0)

    # Sensors.

    def fit_mark_sensor(self, trigger_index: int, sensor: MarkSensor | None) -> None:
        """Connect a trigger to a sensor that sees marks on an axis, or to none; ValueError for an axis that is not
        there."""
        if sensor is not None and not 0 <= sensor.axis_index < len(self._ints):
            raise ValueError(f"there is no axis {sensor.axis_index + 1} for a mark sensor")
        self._unit[_INPUTS] = self._unit[_INPUTS] ^ self._ints[trigger_index][_OPERATED]
        self._write(trigger_index, sensor_operated=0, **(sensor.fields() if sensor else {"sensor_fitted": 0}))
        self._note_work()

    # Positions.

    def compare_position(self, axis_index: int, counts: int, *, upwards: bool) -> None:
        """Report VALUE once the encoder has come to a position (reported counts) from below, or from above;
        `passed_position_ns` says when that was. At once, if it is there already."""
        self._write(
            axis_index,
            compare_counts=counts + self._ints[axis_index][ENCODER_OFFSET],
            compare_direction=1 if upwards else -1,
            compare_passed_ns=NO_TIME,
        )
        self._note_work()

    def compare_no_position(self, axis_index: int) -> None:
        """Wait for no position any more."""
        self._write(axis_index, compare_direction=0, compare_passed_ns=NO_TIME)
        self._note_work()

    def passed_position_ns(self, axis_index: int) -> int | None:
        """When the encoder passed the position last waited for; None while it has not."""
        passed_ns = self._ints[axis_index][_PASSED]
        return None if passed_ns == NO_TIME else passed_ns

    def _note_work(self) -> None:
        """Samples are looked between only while there is a reason."""
        work = self._unit[_WORK] & ~(SENSORS_FITTED | COMPARISONS_ARMED)
        if any(ints[_SENSOR] for ints in self._ints):
            work |= SENSORS_FITTED
        if any(ints[_COMPARING] for ints in self._ints):
            work |= COMPARISONS_ARMED
        self._unit[_WORK] = work

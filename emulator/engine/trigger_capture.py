"""Instants between two servo samples: trigger edges and what is latched at them, marks that pass a sensor, and the
encoder passing a position.

Nothing of this waits for a sample on a real unit: a trigger latches its encoder's counter in hardware, a mark passes
its sensor when it does. So whatever happens here has a time in nanoseconds, and positions at that time are those of a
cubic between the two samples around it, through the machine's positions and velocities there; that is within a
thousandth of a count of where the machine really was, even while it accelerates hard.

What a trigger latches (6000 Programmer's Guide PDF p. 128):

the encoder it belongs to   in hardware, within a count at any speed, whatever SFB says
the selected feedback       within 50 us times the velocity; the steps in which the unit tells the time are assumed
a device not selected       its last sample
the commanded position      from the last sample of the feedback, the position error and the time since

Trigger n belongs to axis n and its record; `own` fields hold what an axis's own trigger has latched of it, `other`
fields what the other axis's has.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .encoder import ANI_SOURCE, ENCODER_SOURCE
from .events import EVENT_TRIGGER, EVENT_VALUE
from .kernels import Record, Records, kernel, seldom
from .plants import place_of_load

NO_TIME = -1
"""Of an edge, a capture or a passing that has not been."""

EDGE_WAITS = 1
SENSORS_FITTED = 2
COMPARISONS_ARMED = 4
"""Bits of `trigger_work`: why the samples of a unit have to be looked between."""

TIMING_STEP_NS = 100_000
"""Steps in which the unit tells the time of an edge for whatever it does not latch in hardware: half of one is the 50
us of the guide. That it is a clock with such steps is assumed."""


@dataclass(frozen=True, slots=True)
class MarkSensor:
    """A sensor at a trigger input that sees marks on a moving axis: registration marks on a web, a slot in a disk.

    Marks begin at `at_rev` and, unless `every_rev` is 0, again and again in both directions at that spacing; each is
    `width_rev` wide. Positions are true positions of the load, or of what else turns the axis' encoder. Over a mark
    the contact is closed.
    """

    axis_index: int
    at_rev: float
    every_rev: float = 0.0
    width_rev: float = 0.01

    def __post_init__(self) -> None:
        if not math.isfinite(self.at_rev):
            raise ValueError(f"at_rev must be a position, not {self.at_rev}")
        if not 0.0 < self.width_rev < math.inf:
            raise ValueError(f"width_rev must be above 0, not {self.width_rev}")
        if self.every_rev != 0.0 and not self.width_rev < self.every_rev < math.inf:
            raise ValueError(
                f"every_rev must be 0 (one mark) or above width_rev, {self.width_rev}, not {self.every_rev}"
            )

    def fields(self) -> dict[str, float]:
        """Fields of the axis record of the trigger."""
        return {
            "sensor_fitted": 1,
            "sensor_axis": self.axis_index,
            "mark_at_rev": self.at_rev,
            "mark_every_rev": self.every_rev,
            "mark_width_rev": self.width_rev,
        }


# Where things were at an instant between two samples.


@kernel
def place_of_marks(axis: Record) -> float:
    """Where what carries an axis's marks is, rev: its load, or what else turns its encoder."""
    if axis["encoder_driven"] != 0:
        return float(axis["driven_counts"] / axis["counts_per_rev"])
    return place_of_load(axis)


@seldom
def note_before(unit: Record, axes: Records) -> None:
    """Keep how things stood at the last sample, before this one moves them."""
    for axis_index in range(unit["axis_count"]):
        axis = axes[axis_index]
        axis["before_rev"] = axis["true_position"]
        axis["before_load_rev"] = place_of_marks(axis)
        axis["before_rev_s"] = axis["true_velocity"]
        axis["before_reading"] = axis["encoder_reading"]
        axis["before_encoder_counts"] = axis["encoder_counts"]
        axis["before_feedback_counts"] = axis["feedback_counts"]
        axis["before_commanded_counts"] = axis["commanded_counts"]
        axis["before_ani_counts"] = axis["ani_counts"]


@kernel
def place_between(axis: Record, of_load: int, fraction: float, period_s: float) -> float:
    """Position of the shaft or the load, or of what else turns the encoder, at a fraction of the sample just past, rev.

    A load that is apart, and what else turns an encoder, are taken to move evenly within a sample.
    """
    if axis["encoder_driven"] != 0 or (of_load != 0 and axis["load_apart"] != 0):
        before = axis["before_load_rev"]
        return float(before + fraction * (place_of_marks(axis) - before))
    before = axis["before_rev"]
    moved = axis["true_position"] - before
    early = axis["before_rev_s"] * period_s - moved
    late = moved - axis["true_velocity"] * period_s
    bend = (1.0 - fraction) * early + fraction * late
    return float(before + fraction * (moved + (1.0 - fraction) * bend))


@kernel
def fraction_at(axis: Record, of_load: int, place: float, period_s: float) -> float:
    """The fraction of the sample just past at which a position was passed, 0 to 1."""
    begin = place_between(axis, of_load, 0.0, period_s)
    moved = place_between(axis, of_load, 1.0, period_s) - begin
    if moved == 0.0:
        return 1.0
    fraction = (place - begin) / moved
    for _ in range(3):
        fraction -= (place_between(axis, of_load, fraction, period_s) - place) / moved
    return min(max(fraction, 0.0), 1.0)


@kernel
def instant(unit: Record, now_ns: int, fraction: float) -> int:
    """The time of a fraction of the sample just past, ns."""
    period_ns = unit["servo_ns"]
    return int(now_ns - period_ns + math.floor(fraction * period_ns + 0.5))


@kernel
def encoder_between(axis: Record, fraction: float, period_s: float) -> int:
    """Encoder position as its counter stood at a fraction of the sample just past; never outside what was counted."""
    place = place_between(axis, axis["encoder_on_load"], fraction, period_s)
    reading = math.floor(place * axis["counts_per_rev"] + axis["encoder_phase"])
    before, after = axis["before_encoder_counts"], axis["encoder_counts"]
    counts = before + axis["encoder_sign"] * (reading - axis["before_reading"])
    return int(min(max(counts, min(before, after)), max(before, after)))


@kernel
def counts_between(before: int, after: int, fraction: float) -> int:
    """A sampled position at a time told in fractions of a sample, which may lie a little outside the sample."""
    return math.floor(before + (after - before) * fraction + 0.5)


# Trigger edges.


@kernel
def take_edge(unit: Record, trigger: Record, edge_ns: int) -> None:
    """An active edge at a trigger input; the sample after it completes the capture.

    Ignored while the trigger has no capture function, and within TRGLOT of the last capture.
    """
    if trigger["trigger_armed"] == 0 or trigger["trigger_edge_ns"] != NO_TIME:
        return
    if edge_ns < trigger["trigger_locked_until_ns"]:
        return
    trigger["trigger_edge_ns"] = edge_ns
    unit["trigger_work"] |= EDGE_WAITS


@kernel
def encoder_captured(axis: Record, dedicated: int, fraction: float, timed: float, period_s: float) -> int:
    """What a trigger latches of an encoder."""
    if dedicated != 0:
        return encoder_between(axis, fraction, period_s)
    if axis["feedback_source"] == ENCODER_SOURCE:
        return counts_between(axis["before_encoder_counts"], axis["encoder_counts"], timed)
    return int(axis["before_encoder_counts"])


@kernel
def ani_captured(axis: Record, timed: float) -> int:
    """What a trigger latches of an ANI feedback input."""
    if axis["feedback_source"] == ANI_SOURCE:
        return counts_between(axis["before_ani_counts"], axis["ani_counts"], timed)
    return int(axis["before_ani_counts"])


@seldom
def capture_axis(axis: Record, dedicated: int, fraction: float, timed: float, period_s: float) -> None:
    """Latch the positions of one axis."""
    encoder = encoder_captured(axis, dedicated, fraction, timed, period_s)
    ani = ani_captured(axis, timed)
    before = axis["before_feedback_counts"]
    moved = counts_between(before, axis["feedback_counts"], timed) - before
    commanded = axis["before_commanded_counts"] + moved
    if dedicated != 0:
        axis["own_encoder_capture"] = encoder
        axis["own_commanded_capture"] = commanded
        axis["own_ani_capture"] = ani
    else:
        axis["other_encoder_capture"] = encoder
        axis["other_commanded_capture"] = commanded
        axis["other_ani_capture"] = ani


@seldom
def capture_edge(unit: Record, axes: Records, trigger_index: int, now_ns: int) -> None:
    """Latch every axis at the edge of one trigger."""
    trigger = axes[trigger_index]
    edge_ns = trigger["trigger_edge_ns"]
    begin_ns = now_ns - unit["servo_ns"]
    told_ns = (edge_ns + TIMING_STEP_NS // 2) // TIMING_STEP_NS * TIMING_STEP_NS
    fraction = (edge_ns - begin_ns) / unit["servo_ns"]
    timed = (told_ns - begin_ns) / unit["servo_ns"]
    for axis_index in range(unit["axis_count"]):
        dedicated = 1 if axis_index == trigger_index else 0
        capture_axis(axes[axis_index], dedicated, fraction, timed, unit["servo_s"])
    trigger["trigger_edge_ns"] = NO_TIME
    trigger["captured_edge_ns"] = edge_ns
    trigger["trigger_locked_until_ns"] = edge_ns + trigger["trigger_lockout_ns"]
    trigger["captures"] += 1
    trigger["pending_events"] |= EVENT_TRIGGER


# Marks.


@seldom
def pass_marks(unit: Record, trigger: Record, axis: Record, now_ns: int) -> None:
    """Let the marks of an axis pass a trigger's sensor: the first active edge of the sample, and the contact."""
    before, after = axis["before_load_rev"], place_of_marks(axis)
    every, width = trigger["mark_every_rev"], trigger["mark_width_rev"]
    forwards = after > before
    edge = trigger["mark_at_rev"]
    if forwards != (trigger["trigger_active_level"] != 0):
        edge += width
    # One mark alone has one edge, between everything below it (-1) and everything above (0).
    from_mark, to_mark = -1 if before < edge else 0, -1 if after < edge else 0
    if every > 0.0:
        from_mark, to_mark = math.floor((before - edge) / every), math.floor((after - edge) / every)
    if from_mark != to_mark:
        place = edge + every * (from_mark + 1 if forwards else from_mark)
        take_edge(unit, trigger, instant(unit, now_ns, fraction_at(axis, 1, place, unit["servo_s"])))
    offset = after - trigger["mark_at_rev"]
    if every > 0.0:
        offset -= math.floor(offset / every) * every
    operated = trigger["trigger_mask"] if offset >= 0.0 and offset < width else 0
    if operated != trigger["sensor_operated"]:
        unit["inputs"] ^= trigger["trigger_mask"]
        trigger["sensor_operated"] = operated


# The encoder passing a position.


@seldom
def compare_position(unit: Record, axis: Record, now_ns: int) -> None:
    """Tell once when the encoder's counter comes to a position from the side that is waited for."""
    direction, wanted = axis["compare_direction"], axis["compare_counts"]
    if direction == 0 or (axis["encoder_counts"] - wanted) * direction < 0:
        return
    before = axis["before_encoder_counts"]
    reading = axis["before_reading"] + axis["encoder_sign"] * (wanted - before)
    if axis["encoder_sign"] * direction < 0:
        # Turning backwards a count is entered from its upper edge.
        reading += 1
    place = (reading - axis["encoder_phase"]) / axis["counts_per_rev"]
    fraction = fraction_at(axis, axis["encoder_on_load"], place, unit["servo_s"])
    axis["compare_passed_ns"] = instant(unit, now_ns, fraction)
    axis["compare_direction"] = 0
    axis["pending_events"] |= EVENT_VALUE


@seldom
def look_between(unit: Record, axes: Records, now_ns: int) -> None:
    """All that may have happened between the last sample and this one, which has been computed."""
    count = unit["axis_count"]
    work = unit["trigger_work"]
    if (work & SENSORS_FITTED) != 0:
        for index in range(count):
            if axes[index]["sensor_fitted"] != 0:
                pass_marks(unit, axes[index], axes[axes[index]["sensor_axis"]], now_ns)
    if (work & COMPARISONS_ARMED) != 0:
        for index in range(count):
            compare_position(unit, axes[index], now_ns)
    for index in range(count):
        if axes[index]["trigger_edge_ns"] != NO_TIME:
            capture_edge(unit, axes, index, now_ns)
    unit["trigger_work"] &= ~EDGE_WAITS

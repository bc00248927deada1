"""The servo cycle: every sample of every axis of one unit, until a given time or something Python must see.

Samples lie on a fixed grid, so that however a run is cut into slices the unit passes through the same states. Within
a sample an axis advances its plant over the period just past, moves its commanded position when a trajectory update
is due, reads its encoder, checks the position error, and computes the output it then holds for the next period. At a
system update follow limits, target zone, watches and wires; only there can a run end early.
"""

from __future__ import annotations

import math

from .arc import go_along_arc
from .control_law import closed_loop, dither, limited, open_loop
from .converter import convert_output
from .encoder import OPEN_LOOP, take_feedback
from .events import (
    EVENT_HARD_LIMIT,
    EVENT_MOVE_ENDED,
    EVENT_POSITION_ERROR,
    EVENT_ROWS_LOW,
    EVENT_SETTLE_TIMEOUT,
    EVENT_SETTLED,
    EVENT_SOFT_LIMIT,
    EVENT_STATUS,
    EVENT_WIRES,
)
from .following import follow_master, update_slaves
from .following_status import FOLLOWING, check_following_watch
from .kernels import Record, Records, kernel, seldom
from .plants import step_plant
from .scope import (
    NEVER_FULL,
    SCOPE_OFF,
    SCOPE_TRIGGERED,
    SCOPE_WAITING,
    ScopeArrays,
    refresh_status,
    triggers,
    write_row,
)
from .status import (
    NEGATIVE_HARD_LIMIT,
    NEGATIVE_SOFT_LIMIT,
    NOT_SETTLING,
    POSITION_ERROR_EXCEEDED,
    POSITIVE_HARD_LIMIT,
    POSITIVE_SOFT_LIMIT,
    SETTLED,
    SETTLING,
    TARGET_ZONE_TIMEOUT,
    ZONE_LEFT,
    axis_status,
    in_target_zone,
)
from .streaming import NO_REFILL
from .travel import CAPTURE_NONE, capture, operate_switches
from .trigger_capture import look_between, note_before
from .watches import check_watches

S_PER_NS = 1e-9

# Codes of LH and LS (commented 6K configurations; the 6000 taken as equal): bit 1 of the code watches the positive end.
POSITIVE_END = 2
NEGATIVE_END = 1


@kernel
def hold_still(axis: Record) -> None:
    """No profile any more: the commanded position stays where it is."""
    axis["profile_active"] = 0
    axis["shift_active"] = 0
    axis["ratio_now"] = 0.0
    axis["commanded_velocity"] = 0.0
    axis["commanded_acceleration"] = 0.0


@seldom
def end_move(axis: Record, now_ns: int) -> None:
    """The commanded position has arrived: start waiting for the target zone."""
    hold_still(axis)
    axis["pending_events"] |= EVENT_MOVE_ENDED
    axis["settling"] = axis["target_zone_enable"]
    axis["settle_start_ns"] = now_ns


@seldom
def end_profile(axis: Record, now_ns: int) -> None:
    """Arrive exactly at the profile's end."""
    axis["commanded_counts"] = axis["profile_origin_counts"] + math.floor(axis["profile_end_counts"] + 0.5)
    end_move(axis, now_ns)


@seldom
def follow_profile(axis: Record, segments: Records, now_ns: int) -> None:
    """Trajectory update: commanded position in whole counts, halves upwards, with the profile's velocity and
    acceleration. A profile takes effect at its start time and not before."""
    elapsed_s = (now_ns - axis["profile_start_ns"]) * S_PER_NS
    if elapsed_s >= axis["profile_end_s"]:
        end_profile(axis, now_ns)
        return
    index = axis["segment_index"]
    first = axis["first_segment"]
    while index + 1 < axis["segment_count"] and elapsed_s >= segments[first + index + 1]["start_s"]:
        index += 1
    axis["segment_index"] = index
    if index >= axis["refill_index"]:
        axis["refill_index"] = NO_REFILL
        axis["pending_events"] |= EVENT_ROWS_LOW
    segment = segments[first + index]
    t = elapsed_s - segment["start_s"]
    half_rate = 0.5 * segment["jerk"] * t
    velocity = segment["velocity"]
    acceleration = segment["acceleration"]
    position = segment["position"] + t * (velocity + t * (0.5 * acceleration + half_rate / 3.0))
    velocity += t * (acceleration + half_rate)
    acceleration += segment["jerk"] * t
    if segment["radius"] != 0.0:
        go_along_arc(axis, segment, position, velocity, acceleration)
        return
    axis["commanded_counts"] = axis["profile_origin_counts"] + math.floor(position + 0.5)
    axis["commanded_velocity"] = velocity
    axis["commanded_acceleration"] = acceleration


@seldom
def shut_down_on_error(axis: Record) -> None:
    """Position error above SMPER: drive off, profile given up, AS bit 23 until the drive is enabled again."""
    axis["enabled"] = 0
    axis["settling"] = 0
    axis["latched_status"] |= POSITION_ERROR_EXCEEDED
    axis["pending_events"] |= EVENT_POSITION_ERROR
    hold_still(axis)


@kernel
def check_position_error(axis: Record, feedback_counts: int) -> None:
    """Compare the position error with SMPER; 0 means not watched."""
    limit = axis["position_error_limit"]
    if limit > 0 and abs(axis["commanded_counts"] - feedback_counts) > limit:
        shut_down_on_error(axis)


@kernel
def servo_axis(unit: Record, axis: Record, feedback_counts: int) -> None:
    """Control law and output. With the drive off or the loop open the command follows the feedback: no error.

    Dither is part of the output of a drive that is on (assumed).
    """
    if axis["feedback_source"] != OPEN_LOOP and axis["enabled"] != 0:
        check_position_error(axis, feedback_counts)
    if axis["feedback_source"] != OPEN_LOOP and axis["enabled"] != 0:
        volts = closed_loop(unit, axis, feedback_counts)
    else:
        axis["commanded_counts"] = feedback_counts
        volts = open_loop(axis)
        if axis["enabled"] == 0 and unit["drive_off_to_zero"] != 0:
            volts = 0.0
    if axis["dither_samples"] != 0 and axis["enabled"] != 0:
        volts += dither(axis)
    volts = limited(axis, volts)
    axis["control_v"] = volts
    axis["previous_dac_v"] = axis["dac_v"]
    axis["dac_v"] = axis["stuck_v"] if axis["output_stuck"] != 0 else convert_output(unit, axis["output_sign"] * volts)


@kernel
def move_plant(axis: Record, before: Record, after: Record) -> None:
    """Advance the plant over the servo sample just past: up to the moment at which the last output reached the
    terminals with the output before it, from then on with the last one."""
    if before["period_s"] > 0.0:
        step_plant(axis, before, axis["previous_dac_v"])
    if after["period_s"] > 0.0:
        step_plant(axis, after, axis["dac_v"])


@kernel
def sample_axis(unit: Record, axis: Record, segments: Records, now_ns: int, trajectory_due: bool) -> None:
    """One servo sample of one axis, its plant having moved."""
    if trajectory_due and axis["profile_active"] != 0:
        if axis["profile_active"] != FOLLOWING:
            follow_profile(axis, segments, now_ns)
        elif follow_master(unit, axis, segments, now_ns):
            end_move(axis, now_ns)
    feedback_counts = take_feedback(axis, now_ns)
    if axis["switches_fitted"] != 0:
        operate_switches(unit, axis)
    if axis["capture_mode"] != CAPTURE_NONE:
        capture(unit, axis)
    servo_axis(unit, axis, feedback_counts)


@kernel
def limit_active(unit: Record, mask: int, active_level: int) -> bool:
    """Whether an end-of-travel input is at its active level."""
    grounded = 1 if (unit["wires"] & mask) != 0 else 0
    return bool(grounded == active_level)


@kernel
def hard_limit_bit(unit: Record, axis: Record) -> int:
    """AS bit of the active end-of-travel limit the commanded motion runs towards; 0 if none."""
    velocity = axis["commanded_velocity"]
    enable = axis["hard_limit_enable"]
    if velocity > 0.0 and (enable & POSITIVE_END) != 0:
        if limit_active(unit, axis["positive_limit_mask"], axis["positive_active_level"]):
            return POSITIVE_HARD_LIMIT
    elif (
        velocity < 0.0
        and (enable & NEGATIVE_END) != 0
        and limit_active(unit, axis["negative_limit_mask"], axis["negative_active_level"])
    ):
        return NEGATIVE_HARD_LIMIT
    return 0


@kernel
def soft_limit_bit(axis: Record) -> int:
    """AS bit of the soft limit the commanded position has passed and runs away from; equal limits are no limits."""
    if axis["positive_soft_limit"] == axis["negative_soft_limit"]:
        return 0
    commanded = axis["commanded_counts"] - axis["offset_counts"]
    velocity = axis["commanded_velocity"]
    enable = axis["soft_limit_enable"]
    if velocity > 0.0 and (enable & POSITIVE_END) != 0 and commanded > axis["positive_soft_limit"]:
        return POSITIVE_SOFT_LIMIT
    if velocity < 0.0 and (enable & NEGATIVE_END) != 0 and commanded < axis["negative_soft_limit"]:
        return NEGATIVE_SOFT_LIMIT
    return 0


@kernel
def latch_limits(unit: Record, axis: Record) -> None:
    """Latch the AS bit of a limit newly run into, and tell."""
    hard = hard_limit_bit(unit, axis)
    soft = soft_limit_bit(axis)
    if (hard & ~axis["latched_status"]) != 0:
        axis["pending_events"] |= EVENT_HARD_LIMIT
    if (soft & ~axis["latched_status"]) != 0:
        axis["pending_events"] |= EVENT_SOFT_LIMIT
    axis["latched_status"] |= hard | soft


@kernel
def await_zone(axis: Record, waited_ns: int, in_time: bool) -> None:
    """Wait for the target zone after a profile. Entering wins over the time-out at the same update."""
    if in_target_zone(axis):
        axis["settling"] = SETTLED
        axis["settling_ns"] = waited_ns
        axis["pending_events"] |= EVENT_SETTLED
    elif not in_time:
        axis["settling"] = NOT_SETTLING
        axis["latched_status"] |= TARGET_ZONE_TIMEOUT
        axis["pending_events"] |= EVENT_SETTLE_TIMEOUT


@kernel
def watch_zone(axis: Record, waited_ns: int) -> None:
    """An axis that leaves the zone again has not settled: its settling time is that of the last entry."""
    if not in_target_zone(axis):
        axis["settling"] = ZONE_LEFT
    elif axis["settling"] == ZONE_LEFT:
        axis["settling"] = SETTLED
        axis["settling_ns"] = waited_ns


@kernel
def settle(axis: Record, now_ns: int) -> None:
    """The target zone after a profile.

    The move is complete with the first entry, the settling time counts up to the last (definition: Aries User Guide
    p. 82); that entries are looked for as long as STRGTT runs is assumed.
    """
    waited_ns = now_ns - axis["settle_start_ns"]
    in_time = waited_ns <= axis["target_timeout_ns"]
    if axis["settling"] == SETTLING:
        await_zone(axis, waited_ns, in_time)
    elif in_time:
        watch_zone(axis, waited_ns)
    else:
        axis["settling"] = NOT_SETTLING


@seldom
def update_axis(unit: Record, axis: Record, now_ns: int) -> None:
    """System update of one axis, before the watches."""
    axis["actual_velocity"] = (axis["feedback_counts"] - axis["system_feedback_counts"]) * unit["system_hz"]
    axis["system_feedback_counts"] = axis["feedback_counts"]
    if axis["profile_active"] != 0:
        latch_limits(unit, axis)
    if axis["settling"] != 0:
        settle(axis, now_ns)


@kernel
def collect_events(axis: Record) -> int:
    """Compare the watched AS bits, hand the axis's new events over and return them."""
    if axis["watch_mask"] != 0:
        watched = axis_status(axis) & axis["watch_mask"]
        if watched != axis["watched_status"]:
            axis["watched_status"] = watched
            axis["pending_events"] |= EVENT_STATUS
    if axis["following_watch_mask"] != 0:
        check_following_watch(axis)
    fired = axis["pending_events"]
    axis["events"] |= fired
    axis["pending_events"] = 0
    return int(fired)


@seldom
def check_wires(unit: Record) -> int:
    """WIRES if any input differs from what was last reported."""
    if unit["wires"] == unit["reported_wires"] and unit["inputs"] == unit["reported_inputs"]:
        return 0
    unit["reported_wires"] = unit["wires"]
    unit["reported_inputs"] = unit["inputs"]
    return EVENT_WIRES


@seldom
def system_update(unit: Record, axes: Records, ratios: Records, watches: Records, now_ns: int) -> int:
    """Everything that happens once per system update; returns the events of all axes."""
    if unit["slaves"] != 0:
        update_slaves(unit, axes, ratios)
    for axis_index in range(unit["axis_count"]):
        update_axis(unit, axes[axis_index], now_ns)
    if unit["armed_watches"] != 0:
        check_watches(unit, axes, watches)
    fired = check_wires(unit)
    for axis_index in range(unit["axis_count"]):
        fired |= collect_events(axes[axis_index])
    return fired


@kernel
def trajectory_is_due(unit: Record) -> bool:
    """Count this sample; true if a trajectory update falls on it."""
    unit["samples_to_trajectory"] -= 1
    if unit["samples_to_trajectory"] != 0:
        return False
    unit["samples_to_trajectory"] = unit["samples_per_trajectory"]
    return True


@kernel
def system_is_due(unit: Record) -> bool:
    """Count this trajectory update; true if a system update falls on it."""
    unit["trajectories_to_system"] -= 1
    if unit["trajectories_to_system"] != 0:
        return False
    unit["trajectories_to_system"] = unit["trajectories_per_system"]
    return True


@kernel
def servo_sample(
    unit: Record, axes: Records, plants: Records, segments: Records, ratios: Records, watches: Records
) -> int:
    """One servo sample of all axes; returns the events of a system update that fell on it, else 0."""
    now_ns = unit["next_sample_ns"]
    trajectory_due = trajectory_is_due(unit)
    between = unit["trigger_work"] != 0
    if between:
        note_before(unit, axes)
    for axis_index in range(unit["axis_count"]):
        axis = axes[axis_index]
        move_plant(axis, plants[2 * axis_index], plants[2 * axis_index + 1])
        sample_axis(unit, axis, segments, now_ns, trajectory_due)
    if between:
        look_between(unit, axes, now_ns)
    unit["next_sample_ns"] = now_ns + unit["servo_ns"]
    if trajectory_due and system_is_due(unit):
        return system_update(unit, axes, ratios, watches, now_ns)
    return 0


@kernel
def run(
    unit: Record,
    axes: Records,
    plants: Records,
    segments: Records,
    ratios: Records,
    watches: Records,
    fired: int,
    until_ns: int,
) -> int:
    """Run samples up to `until_ns` or up to events, unless some have `fired` already; returns the events."""
    while fired == 0 and unit["next_sample_ns"] <= until_ns:
        fired = servo_sample(unit, axes, plants, segments, ratios, watches)
    return fired


@kernel
def run_recorded(
    unit: Record,
    axes: Records,
    plants: Records,
    segments: Records,
    ratios: Records,
    watches: Records,
    scope: ScopeArrays,
    until_ns: int,
) -> int:
    """As `run`, with the scope writing rows until it is full or the time is reached."""
    record, ring = scope.records[0], scope.ring
    channels, unit_channels = scope.channels, scope.unit_channels
    unit_words, axis_words = scope.unit_words, scope.axis_words
    # What changes with every row is kept in variables meanwhile: going through the record costs as much as the row.
    place, written, to_row = record["next_word"], record["rows_written"], record["samples_to_row"]
    every, width = record["every"], record["axis_channels"] + record["unit_channels"]
    waiting = record["state"] == SCOPE_WAITING
    last = NEVER_FULL if waiting else written + record["rows_to_go"]
    wants_status = record["wants_status"] != 0
    fired = 0
    while fired == 0 and written != last and unit["next_sample_ns"] <= until_ns:
        fired = servo_sample(unit, axes, plants, segments, ratios, watches)
        to_row -= 1
        if to_row != 0:
            continue
        to_row = every
        if wants_status:
            refresh_status(axes, unit["axis_count"])
        if waiting and triggers(scope, written):
            waiting = False
            last = written + record["rows_to_go"]
        write_row(place, channels, unit_channels, unit_words, axis_words, ring)
        place += width
        place = place if place < len(ring) else 0
        written += 1
    record["next_word"], record["rows_written"], record["samples_to_row"] = place, written, to_row
    if not waiting:
        record["rows_to_go"] = last - written
        record["state"] = SCOPE_OFF if written == last else SCOPE_TRIGGERED
    return run(unit, axes, plants, segments, ratios, watches, fired, until_ns)


@seldom
def advance(
    unit: Record,
    axes: Records,
    plants: Records,
    segments: Records,
    ratios: Records,
    watches: Records,
    scope: ScopeArrays,
    until_ns: int,
) -> int:
    """Run every sample up to `until_ns`, or up to a system update with events; returns the events.

    Also brings the axes' `status` up to date, which is all it does when no sample is due.
    """
    if scope.records[0]["state"] == SCOPE_OFF:
        fired = run(unit, axes, plants, segments, ratios, watches, 0, until_ns)
    else:
        fired = run_recorded(unit, axes, plants, segments, ratios, watches, scope, until_ns)
    if fired != 0:
        unit["time_ns"] = unit["next_sample_ns"] - unit["servo_ns"]
    elif until_ns > unit["time_ns"]:
        unit["time_ns"] = until_ns
    refresh_status(axes, unit["axis_count"])
    return fired

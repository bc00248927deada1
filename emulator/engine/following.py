"""Following in the servo cycle: the master is sampled, and the slave is where the ratio puts it, two samples later.

At every system update the master's counts are taken, low-pass filtered (`FFILT`), and extrapolated (`FPPEN`). From that
position the slave's is computed; in the system update after the next the slave goes there in a straight line, a step at
every trajectory update. So it lags by two sample periods without prediction and by none with it while the master's
velocity is constant (6000 Series Programmer's Guide p. 214, where "2 sample periods" are named; the straight line and
the estimate 2 m(k) - m(k-2) are inferred).

The filter is of first order (assumed), exact for a master held between samples: with a share d = exp(-Ts / tau) of its
lag left after a period Ts it lags a master of constant velocity v by v Ts d / (1 - d), which tends to v tau. Two stages
(`following.filter_order`) have the corner of each raised so that that of both is the one asked for.

Whole master counts go through the exact sums of `ratio_rows`, the fraction a filter leaves through a float.
"""

from __future__ import annotations

import math

from .events import EVENT_ROWS_LOW
from .following_status import (
    FOLLOWING,
    PHASE_CHANGING,
    PHASE_CONSTANT,
    PHASE_END,
    PHASE_HELD,
    PHASE_WAITING,
)
from .kernels import Record, Records, kernel, seldom
from .streaming import NO_REFILL

S_PER_NS = 1e-9

MASTER_NONE = 0
MASTER_ENCODER = 1
MASTER_ANI = 2
MASTER_COMMANDED = 4
"""Source digits of FOLMAS."""

ROW_HOLD = 1
ROW_ENDLESS = 2
ROW_END = 3

NEGLIGIBLE_LAG_COUNTS = 1e-9
"""A filter's lag this small is none (design choice): a master that rests has then come to rest behind it too."""

ONE_SAMPLE = 1
TWO_SAMPLES = 2
"""Samples over which FPPEN1 measures the master velocity."""

UPDATES_TO_ARRIVE = 2
"""System updates from computing a slave position to reaching it. Documented (Programmer's Guide p. 214)."""


@kernel
def raw_master(axis: Record, axes: Records) -> int:
    """What the source of an axis's master shows, whatever its PSET."""
    master = axes[axis["master_index"]]
    if axis["master_source"] == MASTER_ENCODER:
        return int(master["encoder_counts"])
    if axis["master_source"] == MASTER_ANI:
        return int(master["ani_counts"])
    return int(master["commanded_counts"])


@kernel
def count_cycle(axis: Record, moved: int) -> None:
    """Master cycle: rolls over going forwards; backing up counts down, below zero if need be (assumed)."""
    axis["cycle_counts"] += moved
    length = axis["cycle_length"]
    if length != 0 and axis["cycle_counts"] >= length:
        cycles = axis["cycle_counts"] // length
        axis["cycle_counts"] -= cycles * length
        axis["cycle_number"] += cycles


@kernel
def filter_lag(axis: Record, moved: int) -> float:
    """How far the filtered master is behind, after one more sample; stages of equal decay one behind the other."""
    decay = axis["master_decay"]
    before = axis["first_master_lag"]
    first = decay * (before + moved)
    if abs(first) < NEGLIGIBLE_LAG_COUNTS:
        first = 0.0
    axis["first_master_lag"] = first
    if axis["filter_stages"] == 1:
        return float(first)
    second = decay * (axis["master_lag"] - before + moved - (first - before))
    if abs(second) < NEGLIGIBLE_LAG_COUNTS:
        second = 0.0
    return float(first + second)


@kernel
def take_master(unit: Record, axis: Record, axes: Records) -> None:
    """Sample the master, filter it, predict it."""
    raw = raw_master(axis, axes)
    moved = axis["master_sign"] * (raw - axis["master_raw"])
    axis["master_raw"] = raw
    travel = moved + axis["master_moved"]
    lag = filter_lag(axis, moved)
    lag_change = lag - axis["previous_master_lag"]
    axis["previous_master_lag"] = axis["master_lag"]
    axis["master_lag"] = lag
    axis["master_moved"] = moved
    axis["master_counts"] += moved
    axis["master_velocity"] = 0.5 * (travel - lag_change) * unit["system_hz"]
    count_cycle(axis, moved)
    used = axis["master_counts"]
    part = -lag
    if axis["prediction"] == TWO_SAMPLES:
        used += travel
        part -= lag_change
    elif axis["prediction"] == ONE_SAMPLE:
        used += 2 * moved
        part -= 2.0 * (lag - axis["previous_master_lag"])
    carry = math.floor(part)
    axis["master_used"] = used + carry
    axis["master_used_part"] = part - carry


@kernel
def has_begun(row: Record, counts: int, part: float) -> bool:
    """Whether a master travel has reached a piece's beginning."""
    return bool((counts - row["master"]) + (part - row["master_part"]) >= 0.0)


@kernel
def find_piece(axis: Record, ratios: Records, counts: int, part: float) -> int:
    """The piece a master travel lies in; the endless last one and the end are never left again."""
    first = axis["first_ratio"]
    index = axis["ratio_index"]
    while index + 1 < axis["ratio_count"] and has_begun(ratios[first + index + 1], counts, part):
        index += 1
    while (
        index > 0 and ratios[first + index]["kind"] < ROW_ENDLESS and not has_begun(ratios[first + index], counts, part)
    ):
        index -= 1
    axis["ratio_index"] = index
    return int(index)


@kernel
def add_up(axis: Record, row: Record, master: int) -> None:
    """Bring the exact sum to a whole master count, forwards or backwards, no product leaving 64 bits."""
    most = row["most_master"]
    denominator = row["denominator"]
    left = master - axis["sum_master"]
    while left != 0:
        step = min(max(left, -most), most)
        part = axis["sum_part"] + row["ratio_part"] * step
        # A floating-point quotient is right but for its rounding, and several times as fast as an integer one.
        carry = math.floor(part / denominator)
        rest = part - carry * denominator
        if rest < 0 or rest >= denominator:
            carry = part // denominator
            rest = part - carry * denominator
        axis["sum_part"] = rest
        axis["sum_counts"] += row["ratio_counts"] * step + carry
        left -= step
    axis["sum_master"] = master


@kernel
def begin_sum(axis: Record, row: Record, index: int) -> None:
    """Start the exact sum at a piece's first whole master count."""
    axis["sum_piece"] = index
    axis["sum_master"] = row["master"]
    axis["sum_counts"] = row["slave"]
    axis["sum_part"] = row["slave_part"]


@kernel
def set_phase(axis: Record, row: Record) -> None:
    """What the ratio does in a piece, for the status word."""
    if row["kind"] == ROW_HOLD:
        axis["ratio_phase"] = PHASE_HELD if axis["ratio_held"] != 0 else PHASE_WAITING
    elif row["kind"] == ROW_END:
        axis["ratio_phase"] = PHASE_END
        axis["ratio_updates_left"] = UPDATES_TO_ARRIVE
    elif row["slope"] != 0.0:
        axis["ratio_phase"] = PHASE_CHANGING
    else:
        axis["ratio_phase"] = PHASE_CONSTANT
    if row["kind"] == ROW_ENDLESS:
        axis["ratio_mirrored"] = 0


@kernel
def put_slave(axis: Record, row: Record, counts: int, part: float) -> None:
    """The slave's position at a master travel within a piece."""
    if row["slope"] == 0.0:
        add_up(axis, row, counts)
        beyond = row["ratio"] * part
        axis["ratio_now"] = row["ratio"]
    else:
        t = (counts - row["master"]) + (part - row["master_part"])
        beyond = t * (row["ratio"] + 0.5 * row["slope"] * t)
        axis["ratio_now"] = row["ratio"] + row["slope"] * t
    direction = axis["ratio_direction"]
    fraction = (row["base_part"] + direction * axis["sum_part"]) / row["denominator"] + direction * beyond
    carry = math.floor(fraction)
    axis["slave_next"] = axis["ratio_base"] + direction * axis["sum_counts"] + carry
    axis["slave_next_part"] = fraction - carry


@kernel
def begin_where_master_is(axis: Record) -> None:
    """A preset move that has not begun: its beginning goes with the master, filtered but not predicted."""
    carry = math.floor(-axis["master_lag"])
    axis["ratio_master"] = axis["master_counts"] + carry
    axis["ratio_master_part"] = -axis["master_lag"] - carry


@kernel
def place_slave(axis: Record, ratios: Records) -> None:
    """Where the slave belongs for the master position of this system update.

    A preset move waits until the master moves forwards; a prediction that swings back is no such move.
    """
    if axis["ratio_waiting"] != 0:
        if axis["master_moved"] <= 0:
            begin_where_master_is(axis)
            return
        axis["ratio_waiting"] = 0
    counts = axis["master_used"] - axis["ratio_master"]
    part = axis["master_used_part"] - axis["ratio_master_part"]
    if part < 0.0:
        counts -= 1
        part += 1.0
    if axis["ratio_mirrored"] != 0:
        axis["ratio_direction"] = -1 if counts < 0 else 1
    if axis["ratio_direction"] < 0:
        counts = -counts
        if part > 0.0:
            counts -= 1
            part = 1.0 - part
    index = find_piece(axis, ratios, counts, part)
    if index >= axis["ratio_told_index"]:
        axis["ratio_told_index"] = NO_REFILL
        axis["pending_events"] |= EVENT_ROWS_LOW
    row = ratios[axis["first_ratio"] + index]
    if index != axis["sum_piece"]:
        begin_sum(axis, row, index)
    set_phase(axis, row)
    put_slave(axis, row, counts, part)


@kernel
def step_slave(unit: Record, axis: Record, ratios: Records) -> None:
    """System update of a slave: go on to the position computed at the last one, and compute the next."""
    axis["slave_from"] = axis["slave_target"]
    axis["slave_from_part"] = axis["slave_target_part"]
    axis["slave_target"] = axis["slave_next"]
    axis["slave_target_part"] = axis["slave_next_part"]
    if axis["ratio_updates_left"] == 0:
        place_slave(axis, ratios)
    elif axis["ratio_updates_left"] > 1:
        axis["ratio_updates_left"] -= 1
    travel = (axis["slave_target"] - axis["slave_from"]) + (axis["slave_target_part"] - axis["slave_from_part"])
    velocity = travel * unit["system_hz"]
    axis["slave_step"] = velocity * (unit["samples_per_trajectory"] * unit["servo_s"])
    axis["slave_acceleration"] = (velocity - axis["slave_velocity"]) * unit["system_hz"]
    axis["slave_velocity"] = velocity


@seldom
def update_slaves(unit: Record, axes: Records, ratios: Records) -> None:
    """System update of every axis that has a master. All axes have been sampled: what they show is of one instant."""
    for axis_index in range(unit["axis_count"]):
        axis = axes[axis_index]
        if axis["master_source"] != MASTER_NONE:
            take_master(unit, axis, axes)
            if axis["profile_active"] == FOLLOWING:
                step_slave(unit, axis, ratios)


@kernel
def end_shift(axis: Record) -> None:
    """A shift is over: exactly where it was to end."""
    axis["shift_active"] = 0
    axis["shift_counts"] = axis["shift_end_counts"]
    axis["shift_velocity"] = 0.0
    axis["shift_acceleration"] = 0.0


@seldom
def take_shift(axis: Record, segments: Records, now_ns: int) -> None:
    """Trajectory update of a phase shift, a profile in time as any other."""
    elapsed_s = (now_ns - axis["shift_start_ns"]) * S_PER_NS
    if elapsed_s >= axis["shift_end_s"]:
        end_shift(axis)
        return
    index = axis["shift_index"]
    first = axis["first_shift_segment"]
    while index + 1 < axis["shift_count"] and elapsed_s >= segments[first + index + 1]["start_s"]:
        index += 1
    axis["shift_index"] = index
    segment = segments[first + index]
    t = elapsed_s - segment["start_s"]
    half_rate = 0.5 * segment["jerk"] * t
    acceleration = segment["acceleration"]
    axis["shift_counts"] = segment["position"] + t * (segment["velocity"] + t * (0.5 * acceleration + half_rate / 3.0))
    axis["shift_velocity"] = segment["velocity"] + t * (acceleration + half_rate)
    axis["shift_acceleration"] = acceleration + segment["jerk"] * t


@seldom
def follow_master(unit: Record, axis: Record, segments: Records, now_ns: int) -> bool:
    """Trajectory update of a slave: a step on the straight line to its target, and the shift; true if the move is over.

    The commanded position is in whole counts, halves upwards; at a system update it is the target's own.
    """
    if axis["shift_active"] != 0:
        take_shift(axis, segments, now_ns)
    to_go = unit["trajectories_to_system"]
    if to_go == 1:
        whole = axis["slave_target"]
        part = axis["slave_target_part"]
    else:
        whole = axis["slave_from"]
        part = axis["slave_from_part"] + axis["slave_step"] * (unit["trajectories_per_system"] - to_go + 1)
    axis["commanded_counts"] = whole + math.floor(part + axis["shift_counts"] + 0.5)
    axis["commanded_velocity"] = axis["slave_velocity"] + axis["shift_velocity"]
    axis["commanded_acceleration"] = axis["slave_acceleration"] + axis["shift_acceleration"]
    return bool(to_go == 1 and axis["ratio_updates_left"] == 1 and axis["shift_active"] == 0)

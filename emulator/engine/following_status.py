"""The Following status word of a slave, bit n of the manual being 1 << (n - 1).

Bits 1 to 4 and 10 to 12 describe the slave, 7 and 8 its master, 13 to 16 the master cycle (Gemini Command Reference
p. 292, Gemini Programmer's Guide p. 180 and 188). Bits 6, 9 and 13 are a matter of the command language and are not
made here. An axis without a master reads all zero.
"""

from __future__ import annotations

from .events import EVENT_STATUS
from .kernels import Record, kernel, seldom

FOLLOWING = 2
"""State of `profile_active` while the axis is a slave in motion, or at the disposal of its master."""

PHASE_NONE = 0
PHASE_HELD = 1
PHASE_WAITING = 2
PHASE_CHANGING = 3
PHASE_CONSTANT = 4
PHASE_END = 5
"""States of `ratio_phase`."""

IN_RATIO_MOVE = 1 << 0
RATIO_NEGATIVE = 1 << 1
RATIO_CHANGING = 1 << 2
AT_RATIO = 1 << 3
MASTER_ASSIGNED = 1 << 4
MASTER_MOVING = 1 << 6
MASTER_NEGATIVE = 1 << 7
SHIFTING = 1 << 9
SHIFT_CONTINUOUS = 1 << 10
SHIFT_NEGATIVE = 1 << 11
CYCLE_LENGTH_GIVEN = 1 << 13
CYCLE_POSITION_NEGATIVE = 1 << 14
CYCLE_NUMBER_POSITIVE = 1 << 15
PREDICTION_ON = 1 << 16
FILTER_ON = 1 << 17

HELD = 1 << 31
"""Not of the manual: a move waits for the master position it is to begin at. No label is known for bit 32."""


@kernel
def ratio_bits(axis: Record) -> int:
    """Bits 1 to 4: what the ratio does. A move that is held is none until it begins, the one before it going on."""
    phase = axis["ratio_phase"]
    ratio = axis["ratio_now"]
    bits = HELD if phase == PHASE_HELD else 0
    if phase >= PHASE_WAITING or ratio != 0.0:
        bits |= IN_RATIO_MOVE
    if ratio < 0.0:
        bits |= RATIO_NEGATIVE
    if phase == PHASE_CHANGING:
        bits |= RATIO_CHANGING
    elif ratio != 0.0:
        bits |= AT_RATIO
    return bits


@kernel
def shift_bits(axis: Record) -> int:
    """Bits 10 to 12: the shift under way."""
    if axis["shift_active"] == 0:
        return 0
    bits = SHIFTING
    if axis["shift_continuous"] != 0:
        bits |= SHIFT_CONTINUOUS
    if axis["shift_velocity"] < 0.0 or (axis["shift_velocity"] == 0.0 and axis["shift_acceleration"] < 0.0):
        bits |= SHIFT_NEGATIVE
    return bits


@kernel
def master_bits(axis: Record) -> int:
    """Bits 5, 7, 8 and 14 to 18: the master. It moves if it has in the last system update period."""
    bits = MASTER_ASSIGNED
    moved = axis["master_moved"]
    if moved != 0:
        bits |= MASTER_MOVING
    if moved < 0:
        bits |= MASTER_NEGATIVE
    if axis["cycle_length"] != 0:
        bits |= CYCLE_LENGTH_GIVEN
    if axis["cycle_counts"] < 0:
        bits |= CYCLE_POSITION_NEGATIVE
    if axis["cycle_number"] > 0:
        bits |= CYCLE_NUMBER_POSITIVE
    if axis["prediction"] != 0:
        bits |= PREDICTION_ON
    if axis["master_decay"] > 0.0:
        bits |= FILTER_ON
    return bits


@seldom
def following_status(axis: Record) -> int:
    """The whole FS word of an axis."""
    if axis["master_source"] == 0:
        return 0
    bits = master_bits(axis)
    if axis["profile_active"] == FOLLOWING:
        bits |= ratio_bits(axis) | shift_bits(axis)
    return int(bits)


@seldom
def check_following_watch(axis: Record) -> None:
    """STATUS if a watched FS bit has changed since the last report."""
    watched = following_status(axis) & axis["following_watch_mask"]
    if watched != axis["watched_following"]:
        axis["watched_following"] = watched
        axis["pending_events"] |= EVENT_STATUS


@kernel
def slave_in_motion(axis: Record) -> bool:
    """Whether a slave moves or is about to: at velocity, in a ramp, arriving at an end, or shifting.

    A slave at a constant ratio whose master rests, or at ratio 0, is at rest (assumed).
    """
    if axis["commanded_velocity"] != 0.0 or axis["shift_active"] != 0 or axis["ratio_phase"] == PHASE_CHANGING:
        return True
    return bool(axis["ratio_phase"] == PHASE_END)

"""The axis status word, bit n of the manual being 1 << (n - 1).

One function makes the word, for the kernel's watches and for every read from Python, so the two can never differ.
Bits that are a matter of the command language (5 home successful, 6 absolute, 7 continuous, 14 drive fault and so on)
reach the word through the axis's `extra_status`.

Bit numbers: two independent host drivers agree (mp49, EPICS PC6K). That bit 24 is live and independent of `STRGTE`,
that bit 2 reads 0 at rest, and that actual velocity is measured over one system update, is assumed.
"""

from __future__ import annotations

from .following_status import FOLLOWING, PHASE_CONSTANT, slave_in_motion
from .kernels import Record, kernel

MOVING = 1 << 0
NEGATIVE_DIRECTION = 1 << 1
ACCELERATING = 1 << 2
AT_VELOCITY = 1 << 3
SHUT_DOWN = 1 << 12
DRIVE_FAULT = 1 << 13
POSITIVE_HARD_LIMIT = 1 << 14
NEGATIVE_HARD_LIMIT = 1 << 15
POSITIVE_SOFT_LIMIT = 1 << 16
NEGATIVE_SOFT_LIMIT = 1 << 17
POSITION_ERROR_EXCEEDED = 1 << 22
IN_TARGET_ZONE = 1 << 23
TARGET_ZONE_TIMEOUT = 1 << 24

NOT_SETTLING = 0
SETTLING = 1
SETTLED = 2
ZONE_LEFT = 3
"""States of `settling`."""

CLEARED_BY_ENABLE = SHUT_DOWN | DRIVE_FAULT | POSITION_ERROR_EXCEEDED


@kernel
def in_target_zone(axis: Record) -> bool:
    """Whether error and actual velocity are within STRGTD and STRGTV with no profile running."""
    if axis["profile_active"] != 0:
        return False
    if abs(axis["commanded_counts"] - axis["feedback_counts"]) > axis["target_distance"]:
        return False
    return bool(abs(axis["actual_velocity"]) <= axis["target_velocity"])


@kernel
def motion_bits(axis: Record) -> int:
    """AS bits 1 to 4 from the profile at the last trajectory update.

    A slave at a constant ratio is at velocity, however unevenly its master moves (assumed).
    """
    if axis["profile_active"] == 0 or (axis["profile_active"] == FOLLOWING and not slave_in_motion(axis)):
        return 0
    velocity = axis["commanded_velocity"]
    acceleration = axis["commanded_acceleration"]
    bits = MOVING
    if velocity < 0.0 or (velocity == 0.0 and acceleration < 0.0):
        bits |= NEGATIVE_DIRECTION
    at_ratio = axis["profile_active"] == FOLLOWING and axis["ratio_phase"] == PHASE_CONSTANT
    if acceleration == 0.0 or (at_ratio and axis["shift_active"] == 0):
        if velocity != 0.0:
            bits |= AT_VELOCITY
    elif acceleration * velocity > 0.0 or velocity == 0.0:
        bits |= ACCELERATING
    return bits


@kernel
def axis_status(axis: Record) -> int:
    """The whole AS word of an axis."""
    bits = axis["latched_status"] | axis["extra_status"] | motion_bits(axis)
    if axis["enabled"] == 0:
        bits |= SHUT_DOWN
    if in_target_zone(axis):
        bits |= IN_TARGET_ZONE
    return int(bits)

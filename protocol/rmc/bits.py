"""Status bits, error bits, control modes and levels of AutoStops."""

from __future__ import annotations

from enum import IntEnum, IntFlag
from typing import Final


class StatusBits(IntFlag):
    """Status register 0 of an axis. Page numbers: M864-M1018, H Status_Bits."""

    IN_POSITION = 1 << 0
    AT_VELOCITY = 1 << 1
    OPEN_LOOP = 1 << 2
    FAULT_INPUT = 1 << 3
    POSITIVE_LIMIT_INPUT = 1 << 4
    NEGATIVE_LIMIT_INPUT = 1 << 5
    STOPPED = 1 << 6
    INPUT_ESTIMATED = 1 << 7
    ENABLE_OUTPUT = 1 << 8
    TARGET_DONE = 1 << 9
    TARGET_STATE_A = 1 << 10
    TARGET_STATE_B = 1 << 11
    DIRECT_OUTPUT = 1 << 12
    ENABLED = 1 << 13
    EXTERNAL_HALT = 1 << 14
    HALTED = 1 << 15
    FEEDBACK_OK = 1 << 26
    ACKNOWLEDGE = 1 << 31


class ErrorBits(IntFlag):
    """Status register 1 of an axis; bits 8 to 14 are those of a public host program."""

    FOLLOWING = 1 << 0
    OUTPUT_SATURATED = 1 << 2
    FAULT_INPUT = 1 << 3
    POSITIVE_LIMIT_INPUT = 1 << 4
    NEGATIVE_LIMIT_INPUT = 1 << 5
    NO_TRANSDUCER = 1 << 6
    TRANSDUCER_OVERFLOW = 1 << 7
    NOISE = 1 << 8
    POSITIVE_OVERTRAVEL = 1 << 9
    NEGATIVE_OVERTRAVEL = 1 << 10
    COMMAND = 1 << 11
    COMMAND_MODIFIED = 1 << 12
    CONFIGURATION = 1 << 13
    RUN_TIME = 1 << 14


class ControlMode(IntEnum):
    """Current Control Mode, status register 6 (older help)."""

    NONE = 0
    DIRECT_OUTPUT = 1
    OPEN_LOOP = 2
    POSITION_PID = 3
    POSITION_I_PD = 4
    VELOCITY_PID = 5
    VELOCITY_I_PD = 6

    @property
    def closed_loop(self) -> bool:
        """A loop is closed in it."""
        return self >= ControlMode.POSITION_PID

    @property
    def velocity(self) -> bool:
        """It is the velocity that is controlled."""
        return self >= ControlMode.VELOCITY_PID


NEXT_MODE_CODES: Final = {
    0: ControlMode.POSITION_PID,
    1: ControlMode.POSITION_I_PD,
    4: ControlMode.VELOCITY_PID,
    5: ControlMode.VELOCITY_I_PD,
}
"""Codes of Set Pos/Vel Ctrl Mode (68) and of status register 7: codes M840, names inferred."""


class AutoStop(IntEnum):
    """What happens when an error bit rises; three bits for each error bit in AutoStopCfg1 to 3 (codes inferred)."""

    STATUS_ONLY = 0
    EXTERNAL_HALT = 1
    CLOSED_LOOP_HALT = 2
    OPEN_LOOP_HALT = 3
    DIRECT_OUTPUT_HALT = 4


AUTOSTOP_FIELDS: Final = 10
AUTOSTOP_BITS: Final = 3
AUTOSTOP_DEFAULT: Final = sum(AutoStop.DIRECT_OUTPUT_HALT << AUTOSTOP_BITS * field for field in range(AUTOSTOP_FIELDS))

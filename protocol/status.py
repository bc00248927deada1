"""Status words as enumerations: the member's value is the bit number as the manuals count it, 1 first.

Labels of the full-text reports and the provenance of each bit are in ``catalogue_data/status_words.toml``.
"""

from __future__ import annotations

from enum import IntEnum


class StatusBit(IntEnum):
    """A bit number of a status word; ``mask`` is its weight in the word."""

    @property
    def mask(self) -> int:
        """The bit as a power of two (bit 1 is 1)."""
        return 1 << (self.value - 1)


class AxisStatus(StatusBit):
    """AS, reported by TAS: one 32-bit word an axis."""

    MOVING = 1
    DIRECTION_NEGATIVE = 2
    ACCELERATING = 3
    AT_VELOCITY = 4
    HOME_SUCCESSFUL = 5
    MODE_ABSOLUTE = 6
    MODE_CONTINUOUS = 7
    JOG_MODE = 8
    JOYSTICK_MODE = 9
    ENCODER_STEP_MODE = 10
    POSITION_MAINTENANCE_ON = 11
    STALL_DETECTED = 12
    DRIVE_SHUTDOWN = 13
    DRIVE_FAULTED = 14
    POSITIVE_HARD_LIMIT_HIT = 15
    NEGATIVE_HARD_LIMIT_HIT = 16
    POSITIVE_SOFT_LIMIT_HIT = 17
    NEGATIVE_SOFT_LIMIT_HIT = 18
    WITHIN_DEADBAND = 19
    IN_POSITION = 20
    DISTANCE_STREAMING = 21
    VELOCITY_STREAMING = 22
    POSITION_ERROR_EXCEEDED = 23
    IN_TARGET_ZONE = 24
    TARGET_ZONE_TIMEOUT = 25
    GOWHEN_PENDING = 26
    LDT_READ_ERROR = 27
    REGISTRATION_MOVE_COMMANDED = 28
    PRESET_MOVE_OVERSHOT = 30


class ExtendedAxisStatus(StatusBit):
    """ASX, reported by TASX: one 32-bit word an axis."""

    MOTOR_FAULT = 1
    LOW_VOLTAGE_FAULT = 2
    OVER_TEMPERATURE_FAULT = 3
    DRIVE_FAULT_INPUT = 4
    ENCODER_FAILURE = 5
    Z_CHANNEL = 6


class SystemStatus(StatusBit):
    """SS, reported by TSS: one 32-bit word for the unit."""

    SYSTEM_READY = 1
    EXECUTING_PROGRAM = 3
    IMMEDIATE_COMMAND = 4
    ASCII_MODE = 5
    ECHO_MODE = 6
    DEFINING_PROGRAM = 7
    TRACE_MODE = 8
    STEP_MODE = 9
    TRANSLATION_MODE = 10
    COMMAND_ERROR = 11
    BREAK_POINT_ACTIVE = 12
    PAUSE_ACTIVE = 13
    WAIT_ACTIVE = 14
    MONITORING_ON_CONDITION = 15
    WAITING_FOR_DATA = 16
    LOADING_THUMBWHEEL_DATA = 17
    EXTERNAL_PROGRAM_SELECT = 18
    DWELL_IN_PROGRESS = 19
    WAITING_FOR_RP240 = 20
    RP240_CONNECTED = 21
    NONVOLATILE_MEMORY_ERROR = 22
    GATHERING_SERVO_DATA = 23
    TRIGGER_A_CAPTURED = 25
    TRIGGER_B_CAPTURED = 26
    TRIGGER_C_CAPTURED = 27
    TRIGGER_D_CAPTURED = 28
    COMPILED_MEMORY_75_PERCENT_FULL = 29
    COMPILED_MEMORY_FULL = 30
    COMPILE_FAILED = 31


class ErrorStatus(StatusBit):
    """ER, reported by TER: one 32-bit word for the unit; a bit sets only while its ERROR bit is 1."""

    STALL_DETECTED = 1
    HARD_LIMIT_HIT = 2
    SOFT_LIMIT_HIT = 3
    DRIVE_FAULT = 4
    STOP_OR_KILL_ISSUED = 5
    KILL_INPUT_ACTIVE = 6
    USER_FAULT_INPUT = 7
    STOP_INPUT_ACTIVE = 8
    ENABLE_INPUT_OPEN = 9
    PRESET_MOVE_OVERSHOT = 10
    TARGET_ZONE_TIMEOUT = 11
    POSITION_ERROR_EXCEEDED = 12
    GOWHEN_ALREADY_TRUE = 14
    LDT_READ_ERROR = 15
    BAD_COMMAND = 16
    ENCODER_FAILURE = 17


class FollowingStatus(StatusBit):
    """FS, reported by TFS: one 32-bit word an axis."""

    SLAVE_IN_RATIO_MOVE = 1
    RATIO_NEGATIVE = 2
    RATIO_CHANGING = 3
    AT_RATIO = 4
    FOLMAS_ACTIVE = 5
    FOLEN_ACTIVE = 6
    MASTER_MOVING = 7
    MASTER_DIRECTION_NEGATIVE = 8
    OK_TO_SHIFT = 9
    SHIFTING = 10
    SHIFT_CONTINUOUS = 11
    SHIFT_DIRECTION_NEGATIVE = 12
    MASTER_CYCLE_TRIGGER_PENDING = 13
    MASTER_CYCLE_LENGTH_GIVEN = 14
    MASTER_CYCLE_POSITION_NEGATIVE = 15
    MASTER_CYCLE_NUMBER_ABOVE_ZERO = 16
    POSITION_PREDICTION_ON = 17
    MASTER_FILTERING_ON = 18
    OK_FOR_GEARED_ADVANCE = 23
    GEARED_ADVANCE_UNDER_WAY = 24


class OtherInputs(StatusBit):
    """INO, reported by TINO: eight bits for the unit."""

    JOYSTICK_AUXILIARY = 1
    JOYSTICK_TRIGGER = 2
    JOYSTICK_AXES_SELECT = 3
    JOYSTICK_VELOCITY_SELECT = 4
    JOYSTICK_RELEASE = 5
    ENABLE = 6

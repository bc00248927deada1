"""Status words as flags. Written by `python -m clients.generate`; do not edit."""

# ruff: noqa
# fmt: off

from __future__ import annotations

from enum import IntFlag


class AxisFlags(IntFlag):
    """AS, reported by TAS; bit 1 weighs 1."""

    MOVING = 1 << 0
    DIRECTION_NEGATIVE = 1 << 1
    ACCELERATING = 1 << 2
    AT_VELOCITY = 1 << 3
    HOME_SUCCESSFUL = 1 << 4
    MODE_ABSOLUTE = 1 << 5
    MODE_CONTINUOUS = 1 << 6
    JOG_MODE = 1 << 7
    JOYSTICK_MODE = 1 << 8
    ENCODER_STEP_MODE = 1 << 9
    POSITION_MAINTENANCE_ON = 1 << 10
    STALL_DETECTED = 1 << 11
    DRIVE_SHUTDOWN = 1 << 12
    DRIVE_FAULTED = 1 << 13
    POSITIVE_HARD_LIMIT_HIT = 1 << 14
    NEGATIVE_HARD_LIMIT_HIT = 1 << 15
    POSITIVE_SOFT_LIMIT_HIT = 1 << 16
    NEGATIVE_SOFT_LIMIT_HIT = 1 << 17
    WITHIN_DEADBAND = 1 << 18
    IN_POSITION = 1 << 19
    DISTANCE_STREAMING = 1 << 20
    VELOCITY_STREAMING = 1 << 21
    POSITION_ERROR_EXCEEDED = 1 << 22
    IN_TARGET_ZONE = 1 << 23
    TARGET_ZONE_TIMEOUT = 1 << 24
    GOWHEN_PENDING = 1 << 25
    LDT_READ_ERROR = 1 << 26
    REGISTRATION_MOVE_COMMANDED = 1 << 27
    PRESET_MOVE_OVERSHOT = 1 << 29


class ExtendedAxisFlags(IntFlag):
    """ASX, reported by TASX; bit 1 weighs 1."""

    MOTOR_FAULT = 1 << 0
    LOW_VOLTAGE_FAULT = 1 << 1
    OVER_TEMPERATURE_FAULT = 1 << 2
    DRIVE_FAULT_INPUT = 1 << 3
    ENCODER_FAILURE = 1 << 4
    Z_CHANNEL = 1 << 5


class SystemFlags(IntFlag):
    """SS, reported by TSS; bit 1 weighs 1."""

    SYSTEM_READY = 1 << 0
    EXECUTING_PROGRAM = 1 << 2
    IMMEDIATE_COMMAND = 1 << 3
    ASCII_MODE = 1 << 4
    ECHO_MODE = 1 << 5
    DEFINING_PROGRAM = 1 << 6
    TRACE_MODE = 1 << 7
    STEP_MODE = 1 << 8
    TRANSLATION_MODE = 1 << 9
    COMMAND_ERROR = 1 << 10
    BREAK_POINT_ACTIVE = 1 << 11
    PAUSE_ACTIVE = 1 << 12
    WAIT_ACTIVE = 1 << 13
    MONITORING_ON_CONDITION = 1 << 14
    WAITING_FOR_DATA = 1 << 15
    LOADING_THUMBWHEEL_DATA = 1 << 16
    EXTERNAL_PROGRAM_SELECT = 1 << 17
    DWELL_IN_PROGRESS = 1 << 18
    WAITING_FOR_RP240 = 1 << 19
    RP240_CONNECTED = 1 << 20
    NONVOLATILE_MEMORY_ERROR = 1 << 21
    GATHERING_SERVO_DATA = 1 << 22
    TRIGGER_A_CAPTURED = 1 << 24
    TRIGGER_B_CAPTURED = 1 << 25
    TRIGGER_C_CAPTURED = 1 << 26
    TRIGGER_D_CAPTURED = 1 << 27
    COMPILED_MEMORY_75_PERCENT_FULL = 1 << 28
    COMPILED_MEMORY_FULL = 1 << 29
    COMPILE_FAILED = 1 << 30


class ErrorFlags(IntFlag):
    """ER, reported by TER; bit 1 weighs 1."""

    STALL_DETECTED = 1 << 0
    HARD_LIMIT_HIT = 1 << 1
    SOFT_LIMIT_HIT = 1 << 2
    DRIVE_FAULT = 1 << 3
    STOP_OR_KILL_ISSUED = 1 << 4
    KILL_INPUT_ACTIVE = 1 << 5
    USER_FAULT_INPUT = 1 << 6
    STOP_INPUT_ACTIVE = 1 << 7
    ENABLE_INPUT_OPEN = 1 << 8
    PRESET_MOVE_OVERSHOT = 1 << 9
    TARGET_ZONE_TIMEOUT = 1 << 10
    POSITION_ERROR_EXCEEDED = 1 << 11
    GOWHEN_ALREADY_TRUE = 1 << 13
    LDT_READ_ERROR = 1 << 14
    BAD_COMMAND = 1 << 15
    ENCODER_FAILURE = 1 << 16


class FollowingFlags(IntFlag):
    """FS, reported by TFS; bit 1 weighs 1."""

    SLAVE_IN_RATIO_MOVE = 1 << 0
    RATIO_NEGATIVE = 1 << 1
    RATIO_CHANGING = 1 << 2
    AT_RATIO = 1 << 3
    FOLMAS_ACTIVE = 1 << 4
    FOLEN_ACTIVE = 1 << 5
    MASTER_MOVING = 1 << 6
    MASTER_DIRECTION_NEGATIVE = 1 << 7
    OK_TO_SHIFT = 1 << 8
    SHIFTING = 1 << 9
    SHIFT_CONTINUOUS = 1 << 10
    SHIFT_DIRECTION_NEGATIVE = 1 << 11
    MASTER_CYCLE_TRIGGER_PENDING = 1 << 12
    MASTER_CYCLE_LENGTH_GIVEN = 1 << 13
    MASTER_CYCLE_POSITION_NEGATIVE = 1 << 14
    MASTER_CYCLE_NUMBER_ABOVE_ZERO = 1 << 15
    POSITION_PREDICTION_ON = 1 << 16
    MASTER_FILTERING_ON = 1 << 17
    OK_FOR_GEARED_ADVANCE = 1 << 22
    GEARED_ADVANCE_UNDER_WAY = 1 << 23


class OtherInputFlags(IntFlag):
    """INO, reported by TINO; bit 1 weighs 1."""

    JOYSTICK_AUXILIARY = 1 << 0
    JOYSTICK_TRIGGER = 1 << 1
    JOYSTICK_AXES_SELECT = 1 << 2
    JOYSTICK_VELOCITY_SELECT = 1 << 3
    JOYSTICK_RELEASE = 1 << 4
    ENABLE = 1 << 5

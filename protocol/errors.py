"""The two kinds of error: the unit's own answer to a bad command, and a caller's misuse of this package.

A bad byte from the wire and a bug in our caller are never the same thing: ``CommandError`` carries the text the unit
sends after the asterisk, everything else Python raises is a fault of ours.
"""

from __future__ import annotations


class ProtocolError(Exception):
    """Anything this package raises on purpose."""


class CommandError(ProtocolError):
    """A command the unit refuses; ``text`` is what it sends, without the leading asterisk."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.text = text


class ReplyError(ProtocolError):
    """A reply that does not have the shape its command calls for (a client's finding, never the unit's)."""


UNDEFINED_LABEL = "UNDEFINED LABEL"
INVALID_COMMAND = "INVALID COMMAND"
COMMAND_NOT_IMPLEMENTED = "COMMAND NOT IMPLEMENTED"
COMMAND_NOT_ALLOWED_IN_PROGRAM = "COMMAND NOT ALLOWED IN PROGRAM"
INVALID_DATA = "INVALID DATA"
INCORRECT_DATA = "INCORRECT DATA"
INCORRECT_AXIS = "INCORRECT AXIS"
INVALID_CONDITIONS = "INVALID CONDITIONS FOR COMMAND"
MOTION_IN_PROGRESS = "MOTION IN PROGRESS"
DRIVE_SHUTDOWN = "DRIVE SHUTDOWN"
ENABLE_INPUT_INACTIVE = "WARNING: ENABLE INPUT INACTIVE"
NOT_ALLOWED_IF_SFB0 = "NOT ALLOWED IF SFB0"
NO_PROGRAM_BEING_DEFINED = "NO PROGRAM BEING DEFINED"
STRING_ALREADY_DEFINED = "STRING ALREADY DEFINED"
STRING_IS_A_COMMAND = "STRING IS A COMMAND"
STRING_IS_TOO_LONG = "STRING IS TOO LONG"
LABEL_ALREADY_DEFINED = "LABEL ALREADY DEFINED"
INSUFFICIENT_MEMORY = "INSUFFICIENT MEMORY"
MAXIMUM_COMMAND_LENGTH_EXCEEDED = "MAXIMUM COMMAND LENGTH EXCEEDED"
NEST_LEVEL_TOO_DEEP = "NEST LEVEL TOO DEEP"
OUTPUT_BIT_USED_AS_OUTFNC = "OUTPUT BIT USED AS OUTFNC"
ALREADY_DEFINED_FOR_THUMBWHEELS = "ALREADY DEFINED FOR THUMBWHEELS"
AXES_NOT_READY = "AXES NOT READY"
NO_PATH_SEGMENTS_DEFINED = "NO PATH SEGMENTS DEFINED"
NOT_DEFINING_A_PATH = "NOT DEFINING A PATH"
NOT_ALLOWED_IN_PATH = "NOT ALLOWED IN PATH"
PATH_ALREADY_MOVING = "PATH ALREADY MOVING"
EXCESSIVE_PATH_RADIUS_DIFFERENCE = "EXCESSIVE PATH RADIUS DIFFERENCE"
PATH_RADIUS_TOO_SMALL = "PATH RADIUS TOO SMALL"
PATH_RADIUS_ZERO = "PATH RADIUS ZERO"
PATH_VELOCITY_ZERO = "PATH VELOCITY ZERO"
DEFINED_WITH_ANOTHER_TW = "WARNING: DEFINED WITH ANOTHER TW"
NO_PATH_SEGMENTS_DEFINED = "NO PATH SEGMENTS DEFINED"
NOT_DEFINING_A_PATH = "NOT DEFINING A PATH"
NOT_ALLOWED_IN_PATH = "NOT ALLOWED IN PATH"
PATH_NOT_COMPILED = "PATH NOT COMPILED"
PATH_ALREADY_MOVING = "PATH ALREADY MOVING"
AXES_NOT_READY = "AXES NOT READY"
MASTER_SLAVE_DISTANCE_MISMATCH = "MASTER SLAVE DISTANCE MISMATCH"
INVALID_RATIO = "INVALID RATIO"
FOLMAS_NOT_SPECIFIED = "FOLMAS NOT SPECIFIED"
INVALID_FOLMAS_SPECIFIED = "INVALID FOLMAS SPECIFIED"
NOT_VALID_DURING_FOLLOWING_MOTION = "NOT VALID DURING FOLLOWING MOTION"
NOT_VALID_DURING_RAMP = "NOT VALID DURING RAMP"


def invalid_data_field(number: int) -> CommandError:
    """A field out of range; ``number`` counts comma fields from 1 (the axis number with an axis prefix)."""
    return CommandError(f"{INVALID_DATA}-FIELD {number}")


def invalid_conditions(axis: int) -> CommandError:
    """What one axis is to do does not fit its state, or what it did before."""
    return CommandError(f"{INVALID_CONDITIONS}-AXIS {axis}")


def ends_moving(axis: int) -> CommandError:
    """PCOMP of a profile whose last preset segment does not end at rest."""
    return CommandError(f"ERROR:  MOTION ENDS IN NON-ZERO VELOCITY-AXIS {axis}")


def s_curve_acceleration(axis: int) -> CommandError:
    """A and AA do not make an S-curve (checked at GO)."""
    return CommandError(f"INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD {axis}")


def s_curve_deceleration(axis: int) -> CommandError:
    """AD and ADA do not make an S-curve (checked at GO)."""
    return CommandError(f"INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD {axis}")

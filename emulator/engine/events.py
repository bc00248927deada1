"""What the servo can tell the controller: events, the signals a watch may compare, and the wire layout.

The numeric codes are part of the kernel's records; the enums give them names on the Python side, the plain integer
constants are what the kernel itself uses.
"""

from __future__ import annotations

from enum import IntEnum, IntFlag

EVENT_MOVE_ENDED = 1
EVENT_HARD_LIMIT = 2
EVENT_SOFT_LIMIT = 4
EVENT_POSITION_ERROR = 8
EVENT_SETTLED = 16
EVENT_SETTLE_TIMEOUT = 32
EVENT_STATUS = 64
EVENT_VALUE = 128
EVENT_WIRES = 256
EVENT_HOME_EDGE = 512
EVENT_INDEX = 1024
EVENT_TRIGGER = 1 << 16
EVENT_ROWS_LOW = 1 << 20


class Event(IntFlag):
    """Why `Engine.run` came back before its time, all events of that system update together."""

    NONE = 0
    MOVE_ENDED = EVENT_MOVE_ENDED
    """A profile reached its end (not told for one that was cancelled)."""
    HARD_LIMIT = EVENT_HARD_LIMIT
    """Moving onto an end-of-travel limit; AS bit 15 or 16 latched. The axis goes on until told to stop."""
    SOFT_LIMIT = EVENT_SOFT_LIMIT
    """Commanded position passed a soft limit; AS bit 17 or 18 latched. The axis goes on until told to stop."""
    POSITION_ERROR = EVENT_POSITION_ERROR
    """Position error above SMPER: drive shut down, profile cancelled, AS bit 23 latched."""
    SETTLED = EVENT_SETTLED
    """In the target zone after a profile (target zone enabled)."""
    SETTLE_TIMEOUT = EVENT_SETTLE_TIMEOUT
    """Not in the target zone within STRGTT; AS bit 25 latched."""
    STATUS = EVENT_STATUS
    """A watched AS bit changed."""
    VALUE = EVENT_VALUE
    """A value watch came true, or the encoder passed a position waited for."""
    WIRES = EVENT_WIRES
    """`wires` or `inputs` differ from what was last reported, or a report was asked for."""
    HOME_EDGE = EVENT_HOME_EDGE
    """The home input changed as an armed capture waited for."""
    INDEX = EVENT_INDEX
    """The encoder passed an index pulse as an armed capture waited for."""
    TRIGGER = EVENT_TRIGGER
    """The axis's trigger has latched positions."""
    ROWS_LOW = EVENT_ROWS_LOW
    """More of a streamed profile was taken from its iterator, marks and all."""


class Signal(IntEnum):
    """Signals a value watch can compare; positions in reported counts."""

    PC = 0
    """Commanded position, counts."""
    PE = 1
    """Encoder position, counts."""
    FB = 2
    """Position of the selected feedback, counts."""
    PER = 3
    """Position error, counts."""
    VEL = 4
    """Commanded velocity, counts/s."""
    VELA = 5
    """Actual velocity, counts/s."""
    DAC = 6
    """Voltage at the analogue output, V."""
    ANI = 7
    """Voltage at the ANI feedback input as converted, V."""
    PANI = 8
    """Position of the ANI feedback input, counts."""
    PMAS = 9
    """Position in the master cycle, counts."""
    NMCY = 10
    """Number of the master cycle."""
    VMAS = 11
    """Master velocity, counts/s."""
    PSLV = 12
    """Commanded position of the slave, counts."""
    PSHF = 13
    """Net shift, counts."""
    MASTER = 14
    """Master travel since it was assigned, whatever its cycles, counts."""


class Relation(IntEnum):
    """Relations of a value watch, written `signal relation threshold`."""

    EQUAL = 0
    NOT_EQUAL = 1
    LESS = 2
    GREATER = 3
    LESS_EQUAL = 4
    GREATER_EQUAL = 5

    @classmethod
    def of(cls, sign: str) -> Relation:
        """The relation written `=`, `<>`, `<`, `>`, `<=` or `>=`; ValueError for anything else."""
        try:
            return _RELATION_SIGNS[sign]
        except KeyError:
            raise ValueError(f"unknown relation {sign!r}") from None


_RELATION_SIGNS = {
    "=": Relation.EQUAL,
    "<>": Relation.NOT_EQUAL,
    "<": Relation.LESS,
    ">": Relation.GREATER,
    "<=": Relation.LESS_EQUAL,
    ">=": Relation.GREATER_EQUAL,
}

ENABLE_MASK = 1
"""Bit of the ENABLE input in `Engine.wires`; 1 = grounded, motion allowed."""

FIRST_AXIS_BIT = 4
WIRES_PER_AXIS = 4
MAX_AXES = (63 - FIRST_AXIS_BIT) // WIRES_PER_AXIS


class Wire(IntEnum):
    """Inputs each axis has; see `wire_mask` for the bit in `Engine.wires`. A bit is 1 while the input is grounded."""

    POSITIVE_LIMIT = 0
    NEGATIVE_LIMIT = 1
    HOME = 2
    DRIVE_FAULT = 3


def wire_mask(wire: Wire, axis_index: int) -> int:
    """The bit of an axis's input in `Engine.wires`: bit 4 + 4 * axis_index + wire. ENABLE is bit 0."""
    return 1 << (FIRST_AXIS_BIT + WIRES_PER_AXIS * axis_index + wire)

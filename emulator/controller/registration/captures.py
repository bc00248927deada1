"""Positions latched by the triggers: INFNCi-H, TRGLOT, TPCE TPCC TPCA, and the operands PCE PCC PCA.

The servo latches (``emulator.engine.trigger_capture``); here is when a trigger may, and who has read what it latched.
A trigger latches while its input has function H and INFEN1 and INEN let it act, at the edge that INLVL calls active,
not filtered by INDEB.  SS bits 25 and 26 say that a position has been latched which nobody has read yet; the value
stays readable (6000 PG p. 128).  Of a trigger's letter left out the reference says nothing; assumed: each axis' own.
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from emulator.controller.readings import reading_in_user_units, reading_text
from emulator.controller.variables.operands import UNPREFIXED_AXIS, reads
from emulator.controller.wires.input_functions import TRIGGER_CAPTURE
from emulator.controller.wires.wiring import TRIGGERS
from protocol.command import Command
from protocol.condition import Operand
from protocol.errors import INCORRECT_AXIS, CommandError
from protocol.fields import axis_indexes
from protocol.reply import ReplyLine
from protocol.reply_shapes import label
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

LETTERS = "AB"
"""TRG-A and TRG-B; the first belongs to axis 1, the second to axis 2."""

NS_PER_MS = 1_000_000
REAL = "E"
"""INEN digit of an input that is not overridden."""

STATUS_BITS = (SystemStatus.TRIGGER_A_CAPTURED, SystemStatus.TRIGGER_B_CAPTURED)


class Captures:
    """Which triggers of one unit latch positions, and which of those have been read."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._armed: list[tuple[bool, int] | None] = [None] * TRIGGERS
        self.unread = [False] * TRIGGERS
        """SS bits 25, 26."""

    def power_up(self) -> None:
        """Nothing is latched and nothing armed."""
        self._armed = [None] * TRIGGERS
        self.unread = [False] * TRIGGERS

    def is_trigger_capture(self, trigger_index: int) -> bool:
        """The trigger's input has function H."""
        number = self._controller.wiring.inputs + 1 + trigger_index
        return self._controller.input_functions.of(number).letter == TRIGGER_CAPTURE

    def arm(self) -> None:
        """Functions, INFEN, INLVL or INEN may have changed: tell the servo which triggers latch, and at which edge."""
        settings, first = self._controller.settings, self._controller.wiring.inputs
        for trigger_index in range(TRIGGERS):
            acts = settings.flag("INFEN") and settings.bits("INEN")[first + trigger_index] == REAL
            level = int(settings.bits("INLVL")[first + trigger_index] == "0")
            wanted = (acts and self.is_trigger_capture(trigger_index), level)
            if wanted != self._armed[trigger_index]:
                self._armed[trigger_index] = wanted
                self._controller.engine.arm_trigger(trigger_index, armed=wanted[0], active_level=level)

    def note(self, trigger_index: int) -> None:
        """The servo has told of a capture."""
        self.unread[trigger_index] = True
        self._controller.registration.capture(trigger_index)
        self._controller.trigger_functions.capture(trigger_index)

    def read(self, trigger_index: int) -> None:
        """What a trigger latched is transferred, assigned or compared."""
        self.unread[trigger_index] = False

    @property
    def status(self) -> dict[SystemStatus, bool]:
        """The SS bits."""
        return dict(zip(STATUS_BITS, self.unread, strict=True))


@handles("TPCE", "TPCC", "TPCA")
def report_captured(controller: Controller, command: Command) -> Lines:
    """TPCEA: ``*TPCEA+0,+0``, the positions of the axes when trigger A came."""
    row = command.row
    assert row is not None
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    values = []
    for axis_index in indexes:
        trigger_index = LETTERS.index(command.argument) if command.argument else axis_index
        controller.captures.read(trigger_index)
        values.append(reading_text(controller, row, row.name[1:] + LETTERS[trigger_index], axis_index))
    return [ReplyLine(label(row, command.axis) + command.argument, ",".join(values))]


@reads("PCE", "PCC", "PCA")
def read_captured(controller: Controller, operand: Operand) -> Decimal:
    """1PCEA: the position of axis 1 when trigger A came.

    Raises:
        CommandError: INCORRECT AXIS.
    """
    axis_index = (operand.axis or UNPREFIXED_AXIS) - 1
    if not 0 <= axis_index < controller.settings.axes_in_use:
        raise CommandError(INCORRECT_AXIS)
    trigger_index = axis_index if operand.index is None else operand.index - 1
    controller.captures.read(trigger_index)
    return reading_in_user_units(controller, operand.name + LETTERS[trigger_index], axis_index)


@applies("TRGLOT")
def apply_lockout(controller: Controller, command: Command, changed: list[int]) -> None:
    """TRGLOT: after a capture no other for so many milliseconds."""
    for trigger_index in range(TRIGGERS):
        lockout_ns = controller.settings.integer("TRGLOT") * NS_PER_MS
        controller.engine.arm_trigger(trigger_index, lockout_ns=lockout_ns)

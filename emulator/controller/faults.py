"""What went wrong: the error word ER, the last bad command, and what clears each.

A bit of ER can be set only while its ERROR bit is 1; setting the ERROR bit to 0 clears it.  The axis side of a fault
(AS bits) is the engine's; here is the unit's side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from protocol.command import Command
from protocol.reply import ReplyLine, bits_word
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

CLEARED_BY_GO = (
    ErrorStatus.STOP_OR_KILL_ISSUED.mask | ErrorStatus.PRESET_MOVE_OVERSHOT.mask | ErrorStatus.GOWHEN_ALREADY_TRUE.mask
)
"""ER bits the next GO clears (assumed H/M)."""

CAUSES = {
    ErrorStatus.HARD_LIMIT_HIT: AxisStatus.POSITIVE_HARD_LIMIT_HIT.mask | AxisStatus.NEGATIVE_HARD_LIMIT_HIT.mask,
    ErrorStatus.SOFT_LIMIT_HIT: AxisStatus.POSITIVE_SOFT_LIMIT_HIT.mask | AxisStatus.NEGATIVE_SOFT_LIMIT_HIT.mask,
    ErrorStatus.DRIVE_FAULT: AxisStatus.DRIVE_FAULTED.mask,
    ErrorStatus.TARGET_ZONE_TIMEOUT: AxisStatus.TARGET_ZONE_TIMEOUT.mask,
    ErrorStatus.POSITION_ERROR_EXCEEDED: AxisStatus.POSITION_ERROR_EXCEEDED.mask,
}
"""The AS bits behind an ER bit: ER is one word for the unit and keeps a bit while any axis has its cause
(inferred)."""


class Faults:
    """The error state of one unit."""

    def __init__(self) -> None:
        self.enabled = 0
        self.word = 0
        self.command_text: str | None = None

    def latch(self, bit: ErrorStatus) -> None:
        """A condition has come up; it shows in ER only if ERROR enables it."""
        self.word |= bit.mask & self.enabled

    def clear(self, mask: int) -> None:
        """What caused these bits has been put right."""
        self.word &= ~mask

    def bad_command(self, text: str) -> None:
        """Remember a refused command for TCMDER and SS bit 11."""
        self.command_text = text

    def enable(self, mask: int) -> None:
        """ERROR: which conditions are watched; bits switched off are cleared."""
        self.enabled = mask
        self.word &= mask


def clear_without_cause(controller: Controller, *bits: ErrorStatus) -> None:
    """Clear those ER bits whose cause no axis shows any longer."""
    shown = 0
    for axis_index in range(controller.settings.axes):
        shown |= controller.engine.status(axis_index)
    for bit in bits:
        if not shown & CAUSES[bit]:
            controller.faults.clear(bit.mask)


@applies("ERROR")
def apply_error_enable(controller: Controller, command: Command, changed: list[int]) -> None:
    """ERROR changed."""
    controller.faults.enable(bits_word(controller.settings.bits("ERROR")))


@handles("TCMDER")
def report_command_error(controller: Controller, command: Command) -> Lines:
    """TCMDER: the text of the last bad command; clears SS bit 11 and ER bit 16."""
    faults = controller.faults
    text, faults.command_text = faults.command_text or "", None
    faults.clear(ErrorStatus.BAD_COMMAND.mask)
    return [ReplyLine("", text)]

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

ALWAYS_GOTO = (
    ErrorStatus.DRIVE_FAULT.mask
    | ErrorStatus.KILL_INPUT_ACTIVE.mask
    | ErrorStatus.USER_FAULT_INPUT.mask
    | ErrorStatus.ENABLE_INPUT_OPEN.mask
)
"""ER bits that abandon what was under way when they call ERRORP (assumed H)."""

LIMIT_HITS = (ErrorStatus.HARD_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT)
"""ER bits that abandon unless COMEXL keeps the program of that axis (assumed H)."""


class Faults:
    """The error state of one unit."""

    def __init__(self) -> None:
        self.enabled = 0
        self.word = 0
        self.pending = 0
        """Bits that have not had their ERRORP branch yet."""
        self.command_text: str | None = None
        self._abandoning = 0

    def latch(self, bit: ErrorStatus, *, abandons: bool = False) -> None:
        """A condition has come up; it shows in ER, and branches to ERRORP, only if ERROR enables it.

        ``abandons``: the branch is a GOTO whatever the bit, what was under way does not go on.
        """
        mask = bit.mask & self.enabled
        self.word |= mask
        self.pending |= mask
        if abandons:
            self._abandoning |= mask

    def clear(self, mask: int) -> None:
        """What caused these bits has been put right."""
        self.word &= ~mask
        self.pending &= ~mask

    def take_pending(self) -> tuple[int, bool]:
        """The bits whose branch is due, and whether one of them is a GOTO by its own cause."""
        pending, abandoning = self.pending, self._abandoning & self.pending
        self.pending = self._abandoning = 0
        return pending, bool(abandoning)

    def branch_again(self) -> None:
        """The error program has come to its end: it is called again for every bit that is still set."""
        self.pending = self.word

    def bad_command(self, text: str) -> None:
        """Remember a refused command for TCMDER and SS bit 11."""
        self.command_text = text

    def enable(self, mask: int) -> None:
        """ERROR: which conditions are watched; bits switched off are cleared."""
        self.enabled = mask
        self.word &= mask
        self.pending &= mask


def clear_without_cause(controller: Controller, *bits: ErrorStatus) -> None:
    """Clear those ER bits whose cause no axis shows any longer."""
    shown = 0
    for axis_index in range(controller.settings.axes):
        shown |= controller.engine.status(axis_index)
    for bit in bits:
        if not shown & CAUSES[bit]:
            controller.faults.clear(bit.mask)


def branch_abandons(controller: Controller, bits: int) -> bool:
    """Whether the ERRORP branch for these ER bits is a GOTO; a Stop or Kill has said so itself (``latch``)."""
    if bits & ALWAYS_GOTO:
        return True
    causes = sum(CAUSES[bit] for bit in LIMIT_HITS if bits & bit.mask)
    settings = controller.settings
    return any(
        controller.engine.status(axis_index) & causes and not settings.flag("COMEXL", axis_index)
        for axis_index in range(settings.axes)
    )


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

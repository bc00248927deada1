"""TRGFN: a trigger that lets the next start of an axis go, or begins a new master cycle.

``1TRGFNA10`` arms trigger A for axis 1: the first digit is for GO, the second for FMCNEW, and each is cleared once the
trigger has come.  The trigger needs function H.  Form and use are assumed (M, L); assumed too: without an axis digit
all axes are meant, and a digit X leaves that function as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.following.assignment import has_master
from emulator.controller.motion.following.ratio import master_counts
from emulator.controller.registration.captures import LETTERS
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, CommandError
from protocol.fields import axis_indexes
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NAME = "TRGFN"
FUNCTIONS = 2


@dataclass(frozen=True, slots=True)
class TriggerAwaited:
    """A trigger that has to come after the start was commanded."""

    def holds(self, controller: Controller) -> bool:
        """Never by itself: the trigger fulfils it."""
        return False

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """Captures are told."""


class TriggerFunctions:
    """What the triggers of one unit are armed for; the starts that wait for them are kept with the others."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._new_cycle: set[tuple[int, int]] = set()

    def reset(self) -> None:
        """Power-up: armed for nothing."""
        self._new_cycle.clear()

    def digits(self, trigger_index: int, axis_index: int) -> str:
        """GO and FMCNEW of one axis, 1 = armed."""
        starts = self._controller.held_starts.has_condition(axis_index, _command(trigger_index))
        return f"{int(starts)}{int(self.awaits_new_cycle(trigger_index, axis_index))}"

    def awaits_new_cycle(self, trigger_index: int, axis_index: int) -> bool:
        """A trigger will begin a new master cycle of an axis."""
        return (trigger_index, axis_index) in self._new_cycle

    def awaits_cycle(self, axis_index: int) -> bool:
        """Some trigger will (FS bit 13)."""
        return any(axis_index == waiting for _, waiting in self._new_cycle)

    def arm(self, trigger_index: int, axis_index: int, digits: str) -> None:
        """Arm (1), disarm (0) or leave (X) each function."""
        start, cycle = digits[0], digits[1:]
        held_starts, command = self._controller.held_starts, _command(trigger_index)
        if start == "1":
            held_starts.set_condition(axis_index, command, TriggerAwaited())
        elif start == "0":
            held_starts.remove_condition(axis_index, command)
        if cycle == "1":
            self._new_cycle.add((trigger_index, axis_index))
        elif cycle == "0":
            self._new_cycle.discard((trigger_index, axis_index))

    def capture(self, trigger_index: int) -> None:
        """A trigger has come."""
        for axis_index in range(self._controller.settings.axes_in_use):
            self._controller.held_starts.fulfil(axis_index, _command(trigger_index))
            if (trigger_index, axis_index) in self._new_cycle:
                self._new_cycle.remove((trigger_index, axis_index))
                new_cycle(self._controller, trigger_index, axis_index)


def new_cycle(controller: Controller, trigger_index: int, axis_index: int) -> None:
    """As FMCNEW, at the edge: the master position was FMCP where the master was then; nothing without a master."""
    if has_master(controller, axis_index):
        at = controller.engine.master_at_capture(trigger_index, axis_index)
        position = master_counts(controller.settings, "FMCP", axis_index)
        controller.engine.restart_master_cycle(axis_index, position, at=at)


def _command(trigger_index: int) -> str:
    return NAME + LETTERS[trigger_index]


@handles(NAME)
def trigger_function(controller: Controller, command: Command) -> Lines:
    """TRGFN: a letter, then up to two digits; without digits a report, one line an axis."""
    if command.argument[1:].strip(","):
        trigger_index, digits, axes = armed_by(controller, command)
        for axis_index in axes:
            controller.trigger_functions.arm(trigger_index, axis_index, digits)
        return None
    trigger_index = LETTERS.index(command.argument[0])
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    name, functions = _command(trigger_index), controller.trigger_functions
    return [ReplyLine(f"{index + 1}{name}", functions.digits(trigger_index, index)) for index in indexes]


def armed_by(controller: Controller, command: Command) -> tuple[int, str, Sequence[int]]:
    """The trigger a TRGFN with digits speaks of, its digits, and the axes.

    Raises:
        CommandError: INCORRECT DATA for no or too many digits, INVALID CONDITIONS FOR COMMAND while the trigger does
            not have function H.
    """
    trigger_index = LETTERS.index(command.argument[0])
    digits = command.argument[1:].replace(",", "")
    if not 0 < len(digits) <= FUNCTIONS:
        raise CommandError(INCORRECT_DATA)
    if not controller.captures.is_trigger_capture(trigger_index):
        raise CommandError(INVALID_CONDITIONS)
    return trigger_index, digits, axis_indexes(command, controller.settings.axes_in_use)

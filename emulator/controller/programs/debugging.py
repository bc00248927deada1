"""Debugging aids: TRACE shows each program command, STEP holds before each, BP stops at a mark."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, CommandError
from protocol.fields import as_decimal, checked_number, range_of
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class Debugging:
    """TRACE and STEP as they stand."""

    def __init__(self) -> None:
        self.trace = False
        self.step = False
        self.steps_allowed = 0
        """Commands ``#`` still lets through."""

    def holds(self) -> bool:
        """STEP mode, and no step left."""
        return self.step and self.steps_allowed == 0

    def took_step(self) -> None:
        """A program command is being carried out."""
        if self.step:
            self.steps_allowed -= 1


def trace_line(name: str, command: Command) -> ReplyLine:
    """What TRACE1 sends for each program command (form assumed L)."""
    return ReplyLine("", f"PROGRAM={name} COMMAND={command.text}")


@applies("TRACE", "STEP")
def apply_modes(controller: Controller, command: Command, changed: list[int]) -> None:
    """TRACE, STEP changed; leaving STEP mode lets the program run on."""
    debugging = controller.debugging
    debugging.trace = controller.settings.flag("TRACE")
    debugging.step = controller.settings.flag("STEP")
    debugging.steps_allowed = 0


@handles("#")
def step(controller: Controller, command: Command) -> Lines:
    """!#n: the next n commands of the program.

    Raises:
        CommandError: not immediate, STEP0, or n outside 1 to 200.
    """
    if not command.immediate or not controller.debugging.step:
        raise CommandError(INVALID_CONDITIONS)
    row = command.row
    assert row is not None
    if command.argument and not command.argument.isdecimal():
        raise CommandError(INCORRECT_DATA)
    count = checked_number(as_decimal(command.argument or "1"), range_of(row), field=1, fields=1)
    controller.debugging.steps_allowed += int(count)
    return None


@handles("BP")
def break_point(controller: Controller, command: Command) -> Lines:
    """BPn in a program: says where it is and waits for !C (SS bit 12).

    Raises:
        CommandError: outside a program, or n outside 1 to 32.
    """
    row, values = command.row, controller.substitute(command).values
    if row is None or len(values) != 1 or values[0] is None:
        raise CommandError(INCORRECT_DATA)
    number = checked_number(values[0], range_of(row), field=1, fields=1)
    if not controller.programs.running or controller.interpreter.immediate_now:
        raise CommandError(INVALID_CONDITIONS)
    controller.interpreter.pause(break_point=True)
    return [ReplyLine("", f"BREAKPOINT NUMBER {number}")]

"""User status: sixteen bits gathered from other status words with INDUST, shown by TUS and US while INDUSE1."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from emulator.controller import words
from emulator.controller.dispatch import Lines, handles
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

SOURCES: dict[str, Callable[[Controller], str]] = {
    "A": lambda controller: words.axis_status(controller, 0),
    "B": lambda controller: words.axis_status(controller, 1),
    "I": words.system_status,
    "J": words.inputs,
}
"""Status words by their letter (assumed L; the letters between are those of axes this unit does not have)."""

_DEFINITION = re.compile(r"(\d+)(?:-(\d+)([A-Z]))?", re.ASCII)


class UserBit(NamedTuple):
    """One bit of a status word."""

    number: int
    letter: str


class UserStatus:
    """What the sixteen bits of one unit are made of."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._bits: list[UserBit] = []
        self.power_up()

    def power_up(self) -> None:
        """User bit n shows bit n of axis 1 until it is defined (assumed L)."""
        self._bits = [UserBit(number, "A") for number in range(1, words.USER_BITS + 1)]

    def define(self, number: int, bit: UserBit) -> None:
        """INDUST: make a user bit (from 1) show another bit."""
        self._bits[number - 1] = bit

    def report(self, number: int) -> ReplyLine:
        """``*INDUST1-1A``."""
        bit = self._bits[number - 1]
        return ReplyLine("INDUST", f"{number}-{bit.number}{bit.letter}")

    @property
    def word(self) -> str:
        """US, bit 1 first; all 0 while INDUSE0."""
        if not self._controller.settings.flag("INDUSE"):
            return "0" * words.USER_BITS
        sources = {letter: SOURCES[letter](self._controller) for letter in {bit.letter for bit in self._bits}}
        return "".join(sources[bit.letter][bit.number - 1 : bit.number] or "0" for bit in self._bits)


@handles("INDUST")
def define_user_status(controller: Controller, command: Command) -> Lines:
    """INDUST lists all bits, INDUSTn one, INDUSTn-<bit><letter> defines."""
    status = controller.user_status
    if not command.argument:
        return [status.report(number) for number in range(1, words.USER_BITS + 1)]
    found = _DEFINITION.fullmatch(command.argument)
    if found is None:
        raise CommandError(INCORRECT_DATA)
    number = int(found[1])
    if not 1 <= number <= words.USER_BITS:
        raise CommandError(INVALID_DATA)
    if found[2] is None:
        return [status.report(number)]
    letter = found[3]
    if letter not in SOURCES or not 1 <= int(found[2]) <= words.WORD:
        raise CommandError(INVALID_DATA)
    if letter == "B" and controller.settings.axes < 2:
        raise CommandError(INVALID_DATA)
    status.define(number, UserBit(int(found[2]), letter))
    return None

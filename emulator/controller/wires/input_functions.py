"""INFNC: which function each programmable input has, and who acts when it comes or goes.

A function acts only with INFEN1.  What a letter does is registered with ``acts_on``; it is called when the first input
with that assignment becomes active and when it is released, never in between.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from protocol.catalogue import io_functions
from protocol.command import Command
from protocol.errors import (
    ALREADY_DEFINED_FOR_THUMBWHEELS,
    COMMAND_NOT_IMPLEMENTED,
    INCORRECT_AXIS,
    INCORRECT_DATA,
    INVALID_DATA,
    CommandError,
)
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NO_FUNCTION = "A"
PROGRAM_SELECT = "P"
TRIGGER_CAPTURE = "H"
RESERVED = "G"
AXIS_REQUIRED = frozenset("JKL")
AXIS_ALLOWED = AXIS_REQUIRED | {"D"}

FUNCTION_NAMES = {
    "A": "NO FUNCTION",
    "B": "BCD PROGRAM SELECT",
    "C": "KILL",
    "D": "STOP",
    "E": "PAUSE/CONTINUE",
    "F": "USER FAULT",
    "H": "TRIGGER INTERRUPT",
    "J": "JOG POSITIVE",
    "K": "JOG NEGATIVE",
    "L": "JOG SPEED SELECT",
    "M": "JOYSTICK RELEASE",
    "N": "JOYSTICK AXIS SELECT",
    "O": "JOYSTICK VELOCITY SELECT",
    "P": "PROGRAM SELECT",
    "Q": "PROGRAM SECURITY",
}
"""What INFNC prints of each letter; the wording of A is the reference's, the rest assumed L after its meanings."""

_ASSIGNMENT = re.compile(r"(\d)?([A-Z])([A-Z0-9]*)", re.ASCII)


@dataclass(frozen=True, slots=True)
class InputFunction:
    """One assignment: ``axis_index`` None means no axis, ``program`` a name or TDIR number for letter P."""

    letter: str
    axis_index: int | None = None
    program: str = ""

    @property
    def code(self) -> str:
        """As INFNC takes and prints it."""
        axis = "" if self.axis_index is None else str(self.axis_index + 1)
        return f"{axis}{self.letter}{self.program}"


Effect = Callable[["Controller", InputFunction, bool], None]

_effects: dict[str, Effect] = {}


def acts_on(*letters: str) -> Callable[[Effect], Effect]:
    """Register what happens when an input with one of these letters becomes active (True) or is released (False)."""

    def register(effect: Effect) -> Effect:
        for letter in letters:
            _effects[letter] = effect
        return effect

    return register


class InputFunctions:
    """The functions of one unit's inputs."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._assigned: list[InputFunction] = []
        self._active: frozenset[InputFunction] = frozenset()
        self.power_up()

    def power_up(self) -> None:
        """No input has a function."""
        self._assigned = [InputFunction(NO_FUNCTION)] * self._controller.wiring.input_count
        self._active = frozenset()

    def of(self, number: int) -> InputFunction:
        """The function of an input (from 1)."""
        return self._assigned[number - 1]

    def numbers(self, letter: str) -> list[int]:
        """The inputs that have a letter, lowest first."""
        return [number for number, function in enumerate(self._assigned, start=1) if function.letter == letter]

    def assign(self, number: int, function: InputFunction) -> None:
        """Give an input a function; what its state means under the new one shows at once."""
        self._assigned[number - 1] = function
        self.refresh()

    def active(self, letter: str, axis_index: int | None = None) -> bool:
        """Whether an input with this letter is active; with an axis given, one for this axis or for all."""
        return any(
            function.letter == letter and (axis_index is None or function.axis_index in (None, axis_index))
            for function in self._active
        )

    def refresh(self) -> None:
        """Compare what is active with what was and have the difference acted on, in the order of the letters."""
        self._controller.captures.arm()
        before, self._active = self._active, self._now_active()
        if before == self._active:
            return
        for function in sorted(before ^ self._active, key=lambda function: (function.letter, function.code)):
            effect = _effects.get(function.letter)
            if effect is not None:
                effect(self._controller, function, function in self._active)

    def _now_active(self) -> frozenset[InputFunction]:
        if not self._controller.settings.flag("INFEN"):
            return frozenset()
        bits = self._controller.inputs.bits
        return frozenset(
            function
            for bit, function in zip(bits, self._assigned, strict=True)
            if bit == "1" and function.letter != NO_FUNCTION
        )

    def report(self, number: int) -> ReplyLine:
        """``*INFNC1-A NO FUNCTION - STATUS OFF``; the status is the input's, whatever INFEN says."""
        function = self.of(number)
        state = "ON" if self._controller.inputs.active(number) else "OFF"
        return ReplyLine("INFNC", f"{number}-{function.code} {FUNCTION_NAMES[function.letter]} - STATUS {state}")


@handles("INFNC")
def input_function(controller: Controller, command: Command) -> Lines:
    """INFNC lists all inputs, INFNCi one, INFNCi-<a>c assigns."""
    functions, count = controller.input_functions, controller.wiring.input_count
    if not command.argument:
        return [functions.report(number) for number in range(1, count + 1)]
    digits, _, code = command.argument.partition("-")
    number = int(digits)
    if not 1 <= number <= count:
        raise CommandError(INVALID_DATA)
    if not code:
        return [functions.report(number)]
    function = read_function(controller, number, code)
    if function.letter != NO_FUNCTION and number in controller.thumbwheels.input_numbers:
        raise CommandError(ALREADY_DEFINED_FOR_THUMBWHEELS)
    functions.assign(number, function)
    return None


def read_function(controller: Controller, number: int, code: str) -> InputFunction:
    """A function code as typed after the dash.

    Raises:
        CommandError: an unknown letter, one of another product, a missing or surplus axis or program.
    """
    found = _ASSIGNMENT.fullmatch(code)
    if found is None:
        raise CommandError(INCORRECT_DATA)
    digit, letter, program = found.groups()
    check_letter(letter, "infnc", reserved=RESERVED)
    if letter == PROGRAM_SELECT:
        program = program or digit or ""
        if not program:
            raise CommandError(INCORRECT_DATA)
        return InputFunction(letter, program=program)
    if letter == TRIGGER_CAPTURE and number <= controller.wiring.inputs:
        raise CommandError(INVALID_DATA)
    if program or (letter in AXIS_REQUIRED and digit is None):
        raise CommandError(INCORRECT_DATA)
    return InputFunction(letter, axis_of(controller, digit, allowed=letter in AXIS_ALLOWED))


def check_letter(letter: str, kind: str, *, reserved: str = "") -> None:
    """Refuse a function letter this unit does not have.

    Raises:
        CommandError: INVALID DATA for one that means nothing, COMMAND NOT IMPLEMENTED for one of another product.
    """
    row = io_functions("infnc" if kind == "infnc" else "outfnc").get(letter)
    if row is None or letter == reserved:
        raise CommandError(INVALID_DATA)
    if row.applies != "OEM6250":
        raise CommandError(COMMAND_NOT_IMPLEMENTED)


def axis_of(controller: Controller, digit: str | None, *, allowed: bool) -> int | None:
    """The axis a function code names.

    Raises:
        CommandError: INCORRECT DATA where no axis belongs, INCORRECT AXIS for one the unit does not have.
    """
    if digit is None:
        return None
    if not allowed:
        raise CommandError(INCORRECT_DATA)
    if not 1 <= int(digit) <= controller.settings.axes:
        raise CommandError(INCORRECT_AXIS)
    return int(digit) - 1

"""ON conditions: inputs, user status or a variable that call the ONP program wherever the unit is.

Nothing is polled: the conditions are looked at after every command and every engine event while ONCOND enables one.
A condition that has called must go false before it calls again (Gem6K PG p.39).
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller import words
from emulator.controller.dispatch import Lines, applies, handles
from protocol.command import Command
from protocol.condition import Operand
from protocol.errors import INCORRECT_DATA, CommandError, invalid_data_field
from protocol.fields import as_decimal
from protocol.numbers import format_variable
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

VARIABLES = {"ONVARA": 1, "ONVARB": 2}
"""The variable each test looks at (6000 PG p.29)."""

LARGEST = Decimal("999999999.99999999")
"""Limit values lie where variables do (6250 UG p.74)."""


class OnConditions:
    """ONCOND and the limits of the variable tests, with what has called already."""

    def __init__(self) -> None:
        self.enabled = [False] * 4
        self.active = False
        """Some condition is enabled (SS bit 15)."""
        self.limits = {name: (Decimal(0), Decimal(0)) for name in VARIABLES}
        self._called = [False] * 4

    def enable(self, digits: str) -> None:
        """ONCOND: ONIN, ONUS, ONVARA, ONVARB; a condition switched off may call again when it is back on."""
        self.enabled = [digit == "1" for digit in digits]
        self.active = any(self.enabled)
        self._called = [called and on for called, on in zip(self._called, self.enabled, strict=True)]

    def take_due(self, controller: Controller, *, may_call: bool) -> bool:
        """Look at the enabled conditions: whether one calls now.

        With ``may_call`` off (the program is under way) only what has become false is noted.
        """
        due = False
        for index, on in enumerate(self.enabled):
            if not on:
                continue
            if not _TESTS[index](controller):
                self._called[index] = False
            elif may_call and not self._called[index]:
                self._called[index] = due = True
        return due


def _inputs_match(controller: Controller) -> bool:
    return _matches(controller.settings.bits("ONIN"), words.inputs(controller))


def _user_status_matches(controller: Controller) -> bool:
    pattern = controller.settings.bits("ONUS")
    if not pattern.strip("X"):
        return False
    return _matches(pattern, str(controller.operands.read(Operand("US"))))


def _matches(pattern: str, bits: str) -> bool:
    """X matches anything; a pattern of X alone says nothing and never calls (assumed)."""
    wanted = [(digit, bit) for digit, bit in zip(pattern, bits, strict=False) if digit != "X"]
    return bool(wanted) and all(digit == bit for digit, bit in wanted)


def _outside(name: str, controller: Controller) -> bool:
    """At or below the low value, or at or above the high one."""
    low, high = controller.on_conditions.limits[name]
    try:
        value = controller.operands.read(Operand("VAR", index=VARIABLES[name]))
    except CommandError:
        return False
    return not low < Decimal(value) < high


_TESTS = (
    _inputs_match,
    _user_status_matches,
    lambda controller: _outside("ONVARA", controller),
    lambda controller: _outside("ONVARB", controller),
)
"""The tests in the order of ONCOND's digits."""


@applies("ONCOND")
def apply_enable(controller: Controller, command: Command, changed: list[int]) -> None:
    """ONCOND changed."""
    controller.on_conditions.enable(controller.settings.bits("ONCOND"))


@handles(*VARIABLES)
def variable_limits(controller: Controller, command: Command) -> Lines:
    """ONVARA, ONVARB: low and high value; an empty field keeps its value.

    Raises:
        CommandError: INCORRECT DATA for what is no pair of numbers, INVALID DATA-FIELD n out of range.
    """
    limits = controller.on_conditions.limits
    if not command.argument:
        low, high = limits[command.name]
        return [ReplyLine(command.name, f"{format_variable(low)},{format_variable(high)}")]
    fields = command.argument.split(",")
    if len(fields) > len(limits[command.name]):
        raise CommandError(INCORRECT_DATA)
    values = list(limits[command.name])
    for index, text in enumerate(fields):
        if text:
            values[index] = _number(text, field=index + 1)
    limits[command.name] = (values[0], values[1])
    return None


def _number(text: str, *, field: int) -> Decimal:
    try:
        number = as_decimal(text)
    except (ArithmeticError, ValueError):
        raise CommandError(INCORRECT_DATA) from None
    if abs(number) > LARGEST:
        raise invalid_data_field(field)
    return number

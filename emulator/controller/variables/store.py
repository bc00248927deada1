"""The three kinds of variables, VAR, VARB and VARS, and the commands that assign and report them.

They are separate memories, kept over RESET and power-off.  What stands right of the equals sign is read once and kept
as a function; a loop that says ``VAR1=VAR1+1`` pays for the addition only.  A few sources (``READ``, ``DREAD``) have to
be waited for: they register with ``supplies`` and store the value when it comes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from emulator.controller.changes import Changes
from emulator.controller.dispatch import Lines, handles, require_no_fields
from emulator.controller.settings import bit_of
from protocol import bitwise
from protocol.command import Command
from protocol.errors import COMMAND_NOT_IMPLEMENTED, INCORRECT_DATA, INVALID_CONDITIONS, INVALID_DATA, CommandError
from protocol.expression import Evaluator, Operand, evaluator
from protocol.expression_text import parse_bits_expression, parse_number_expression
from protocol.numbers import format_variable
from protocol.reply import ReplyLine, group_bits
from protocol.reply_shapes import bit_line
from protocol.strings import quoted, unquoted

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_Kept = TypeVar("_Kept")

Store = Callable[[Decimal], None]
Supplier = Callable[["Controller", Operand, Store], None]

WAITED_FOR = frozenset({"READ", "DREAD", "DREADF", "TW"})
"""Sources that give their value later; they stand alone right of the equals sign."""

_suppliers: dict[str, Supplier] = {}


def supplies(name: str) -> Callable[[Supplier], Supplier]:
    """Register what has a value fetched that must be waited for: it holds the buffer and calls ``store`` in the end."""

    def register(function: Supplier) -> Supplier:
        _suppliers[name] = function
        return function

    return register


class Snapshot(NamedTuple):
    """The contents of all variables, for non-volatile memory."""

    numbers: tuple[Decimal, ...]
    bits: tuple[str, ...]
    texts: tuple[str, ...]


class Variables:
    """The variables of one unit, numbered from 1."""

    def __init__(self, *, numbers: int, patterns: int, texts: int, text_length: int, changes: Changes) -> None:
        self._changes = changes
        self._counts = (numbers, patterns, texts)
        self.text_length = text_length
        self.clear()

    def clear(self) -> None:
        """VARCLR: numbers 0, every bit X, texts empty (a VARB never set reads as X: inferred)."""
        numbers, patterns, texts = self._counts
        self._numbers = [Decimal(0)] * numbers
        self._bits = ["X" * bitwise.WORD] * patterns
        self._texts = [""] * texts
        self._changes.note()

    def number(self, index: int) -> Decimal:
        """A VAR.

        Raises:
            CommandError: INVALID DATA for a number the unit does not have.
        """
        if not 0 < index <= len(self._numbers):
            raise CommandError(INVALID_DATA)
        return self._numbers[index - 1]

    def set_number(self, index: int, value: Decimal) -> None:
        """Assign a VAR; errors as ``number``."""
        if not 0 < index <= len(self._numbers):
            raise CommandError(INVALID_DATA)
        self._numbers[index - 1] = value
        self._changes.count += 1

    def bits(self, index: int) -> str:
        """A VARB, 32 characters of 0, 1, X; errors as ``number``."""
        return self._bits[_place(index, self._bits)]

    def set_bits(self, index: int, bits: str) -> None:
        """Assign a VARB; bits not given become X, also where they had a value (knowledge base, VARB page)."""
        self._bits[_place(index, self._bits)] = bitwise.padded(bits)
        self._changes.note()

    def text(self, index: int) -> str:
        """A VARS; errors as ``number``."""
        return self._texts[_place(index, self._texts)]

    def set_text(self, index: int, text: str) -> None:
        """Assign a VARS.

        Raises:
            CommandError: INVALID DATA for a number the unit does not have or a text that is too long.
        """
        if len(text) > self.text_length:
            raise CommandError(INVALID_DATA)
        self._texts[_place(index, self._texts)] = text
        self._changes.note()

    def snapshot(self) -> Snapshot:
        """Everything, for ``restore``."""
        return Snapshot(tuple(self._numbers), tuple(self._bits), tuple(self._texts))

    def restore(self, snapshot: Snapshot) -> None:
        """Put back what ``snapshot`` gave; variables this unit has beyond it are cleared."""
        self.clear()
        self._numbers = _replaced(self._numbers, snapshot.numbers)
        self._bits = _replaced(self._bits, snapshot.bits)
        self._texts = _replaced(self._texts, snapshot.texts)


def _replaced(present: list[_Kept], kept: Sequence[_Kept]) -> list[_Kept]:
    return [*kept, *present[len(kept) :]][: len(present)]


def _place(index: int, values: list[str]) -> int:
    if not 0 < index <= len(values):
        raise CommandError(INVALID_DATA)
    return index - 1


# Reading assignments.


@dataclass(frozen=True, slots=True)
class Target:
    """Left of the equals sign: a number, or the number of the VAR that holds it."""

    index: int
    indirect: bool

    def resolved(self, variables: Variables) -> int:
        """Which variable is meant now."""
        if not self.indirect:
            return self.index
        number = variables.number(self.index)
        if number != int(number):
            raise CommandError(INVALID_DATA)
        return int(number)


class Assignment(NamedTuple):
    """A VAR or VARB command taken apart: without ``value`` and ``waited_for`` it is a query."""

    target: Target
    value: Evaluator | None
    waited_for: Operand | None = None


def target_of(text: str) -> Target:
    """``3`` or ``(VAR3)``."""
    indirect = text.startswith("(")
    return Target(int(text[4:-1] if indirect else text), indirect)


@lru_cache(maxsize=4096)
def numeric_assignment(argument: str) -> Assignment:
    """The fields of a VAR command.

    Raises:
        CommandError: as ``parse_number_expression``.
    """
    left, equals, right = argument.partition("=")
    if not equals:
        return Assignment(target_of(left), None)
    expression = parse_number_expression(right)
    if isinstance(expression, Operand) and expression.name in WAITED_FOR:
        return Assignment(target_of(left), None, expression)
    return Assignment(target_of(left), evaluator(expression))


@lru_cache(maxsize=1024)
def binary_assignment(argument: str) -> Assignment:
    """The fields of a VARB command that has an equals sign.

    Raises:
        CommandError: as ``parse_bits_expression``.
    """
    left, _, right = argument.partition("=")
    return Assignment(target_of(left), evaluator(parse_bits_expression(right)))


# Commands.


@handles("VAR")
def numeric_variable(controller: Controller, command: Command) -> Lines:
    """VARi=expression; VARi reports."""
    _require_index(command)
    target, value, waited_for = numeric_assignment(command.argument)
    variables = controller.variables
    index = target.index if not target.indirect else target.resolved(variables)
    if value is not None:
        number = value(controller.operands.read)
        variables.set_number(index, number)  # type: ignore[arg-type]  # the text was read as a number
        return None
    if waited_for is not None:
        _fetch(controller, waited_for, index)
        return None
    return [ReplyLine(f"VAR{index}=", format_variable(variables.number(index)))]


def _fetch(controller: Controller, source: Operand, index: int) -> None:
    variables = controller.variables
    variables.number(index)
    supplier = _suppliers.get(source.name)
    if supplier is None:
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    if controller.interpreter.immediate_now:
        raise CommandError(INVALID_CONDITIONS)
    supplier(controller, source, lambda value: variables.set_number(index, value))


@handles("VARB")
def binary_variable(controller: Controller, command: Command) -> Lines:
    """VARBi=bits; VARBi.n-v sets one bit; VARBi and VARBi.n report."""
    _require_index(command)
    variables = controller.variables
    if "=" in command.argument:
        target, value, _ = binary_assignment(command.argument)
        assert value is not None
        variables.set_bits(target.resolved(variables), str(value(controller.operands.read)))
        return None
    left, dot, selected = command.argument.partition(".")
    index = target_of(left).resolved(variables)
    bits = variables.bits(index)
    if not dot:
        return [ReplyLine(f"VARB{index}=", group_bits(bits))]
    number, dash, state = selected.partition("-")
    digit = bit_of(bits, int(number))
    if not dash:
        return [bit_line(digit)]
    place = int(number)
    variables.set_bits(index, bits[: place - 1] + state + bits[place:])
    return None


@handles("VARS")
def string_variable(controller: Controller, command: Command) -> Lines:
    """VARSi="text", VARSi=VARSj; VARSi reports."""
    _require_index(command)
    variables = controller.variables
    left, equals, right = command.argument.partition("=")
    index = target_of(left).resolved(variables)
    if equals:
        variables.set_text(index, _text_of(variables, right))
        return None
    return [ReplyLine(f"VARS{index}=", quoted(variables.text(index)))]


def _text_of(variables: Variables, source: str) -> str:
    if source.startswith("VARS"):
        number = source.removeprefix("VARS")
        inside = number[4:-1] if number.startswith("(VAR") and number.endswith(")") else number
        if not (inside.isascii() and inside.isdigit()):
            raise CommandError(INCORRECT_DATA)
        return variables.text(target_of(number).resolved(variables))
    return unquoted(source)


@handles("VARCLR")
def clear_variables(controller: Controller, command: Command) -> Lines:
    """VARCLR."""
    require_no_fields(command)
    controller.variables.clear()
    return None


def _require_index(command: Command) -> None:
    if not command.argument:
        raise CommandError(INCORRECT_DATA)

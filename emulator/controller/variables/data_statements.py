"""DATA statements as text: what may stand in a data program, and its numbers.

A data program is a stored program named DATP1 to DATP50 that holds nothing but ``DATA=`` statements of up to four
numbers, each statement taking the same memory whatever it holds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from decimal import Decimal

from protocol.arithmetic import ENTERED_PLACES, LARGEST
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, INVALID_DATA, CommandError
from protocol.numbers import format_variable, truncate

BYTES_PER_STATEMENT = 43
"""Program memory of one DATA statement (Gem6K PG p.22)."""

NUMBERS_PER_STATEMENT = 4
MAX_DATA_PROGRAMS = 50

_DATA_PROGRAM = re.compile(r"DATP([1-9]\d?)", re.ASCII)
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)", re.ASCII)
_PREFIX = "DATA="


def is_data_program(name: str) -> bool:
    """Whether a program of this name holds data."""
    match = _DATA_PROGRAM.fullmatch(name)
    return match is not None and int(match[1]) <= MAX_DATA_PROGRAMS


def program_name(number: int) -> str:
    """``DATP3``."""
    return f"DATP{number}"


def check_place(program: str, command: Command) -> None:
    """Whether a command may be stored in this program: DATA and only DATA in data programs.

    Raises:
        CommandError: INVALID CONDITIONS FOR COMMAND in the wrong program (text assumed M), and as ``numbers_of``.
    """
    if is_data_program(program) != (command.name == "DATA"):
        raise CommandError(INVALID_CONDITIONS)
    if command.name == "DATA":
        numbers_of(command.text)


def numbers_of(statement: str) -> tuple[Decimal, ...]:
    """The numbers of ``DATA=1,2.5,-3``.

    Raises:
        CommandError: INCORRECT DATA for none, more than four or what is no number; INVALID DATA out of a VAR's range.
    """
    fields = statement.removeprefix(_PREFIX).split(",")
    if len(fields) > NUMBERS_PER_STATEMENT or not all(_NUMBER.fullmatch(field) for field in fields):
        raise CommandError(INCORRECT_DATA)
    numbers = tuple(truncate(Decimal(field), ENTERED_PLACES) for field in fields)
    if any(abs(number) > LARGEST for number in numbers):
        raise CommandError(INVALID_DATA)
    return numbers


def statement_of(numbers: Sequence[Decimal]) -> str:
    """A statement with these numbers: ``DATA=+1.0,-2.5``."""
    return _PREFIX + ",".join(format_variable(number) for number in numbers)


def statements_of(numbers: Sequence[Decimal]) -> list[str]:
    """As many statements as the numbers need."""
    step = NUMBERS_PER_STATEMENT
    return [statement_of(numbers[start : start + step]) for start in range(0, len(numbers), step)]

"""WRITE, WRVAR, WRVARB, WRVARS: programs talk to the host in words of their own, without asterisk or name.

Host protocols are built on this, so nothing is added to the text of WRITE; the variables end with EOT (assumed M)."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError, invalid_data_field
from protocol.numbers import format_columns, format_variable
from protocol.reply import group_bits
from protocol.strings import unquoted

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

FORMAT_FIELDS = 4
MOST_WHOLE_DIGITS = 9
MOST_DECIMALS = 8
"""A variable has nine whole digits and eight decimals (6250 UG p.74)."""


@handles("WRITE")
def write(controller: Controller, command: Command) -> Lines:
    """WRITE"text": exactly the text, codes like \\13 made characters."""
    assert command.row is not None
    text = unquoted(command.argument)
    if len(text) > command.row.fields.max_length:
        raise CommandError(INVALID_DATA)
    _send(controller, text)
    return None


@handles("WRVAR")
def write_number(controller: Controller, command: Command) -> Lines:
    """WRVARi[,whole digits,decimals,sign]."""
    _send_variable(controller, formatted_variable(controller, command))
    return None


@handles("WRVARB")
def write_bits(controller: Controller, command: Command) -> Lines:
    """WRVARBi: 32 digits in groups of four."""
    _send_variable(controller, group_bits(controller.variables.bits(_single_index(command))))
    return None


@handles("WRVARS")
def write_text(controller: Controller, command: Command) -> Lines:
    """WRVARSi."""
    _send_variable(controller, controller.variables.text(_single_index(command)))
    return None


def formatted_variable(controller: Controller, command: Command) -> str:
    """The VAR that WRVAR or DVAR names, in the form its fields ask for; without them as VAR reports it (assumed L).

    Raises:
        CommandError: a field is missing, malformed or out of range.
    """
    fields = [value for value in command.values if isinstance(value, Decimal)]
    if len(fields) != len(command.values) or len(fields) not in (1, FORMAT_FIELDS):
        raise CommandError(INCORRECT_DATA)
    value = controller.variables.number(int(fields[0]))
    if len(fields) == 1:
        return format_variable(value)
    limits = (MOST_WHOLE_DIGITS, MOST_DECIMALS, 1)
    for number, (field, most) in enumerate(zip(fields[1:], limits, strict=True), start=2):
        if not 0 <= field <= most:
            raise invalid_data_field(number)
    whole, decimals, sign = (int(field) for field in fields[1:])
    return format_columns(value, whole_digits=whole, decimals=decimals, signed=bool(sign))


def _single_index(command: Command) -> int:
    if len(command.values) != 1 or not isinstance(command.values[0], Decimal):
        raise CommandError(INCORRECT_DATA)
    return int(command.values[0])


def _send_variable(controller: Controller, text: str) -> None:
    _send(controller, text)
    controller.send(controller.framing.eot, controller.interpreter.channel)


def _send(controller: Controller, text: str) -> None:
    controller.send(text.encode("latin-1"), controller.interpreter.channel)

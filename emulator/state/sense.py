"""Whether what is kept makes sense to a unit: settings in their ranges, programs a unit can read.

A file that an emulator wrote always does; one made from text that a person changed may not.
"""

from __future__ import annotations

from decimal import Decimal

from emulator.state.contents import KEPT_SETTINGS, PASSWORD, Rows
from protocol.catalogue import commands
from protocol.command import check_program_name, is_command_name, parse_command
from protocol.errors import INCORRECT_DATA, STRING_IS_A_COMMAND, CommandError
from protocol.fields import checked_number, range_of

PASSWORD_DIGITS = 4
"""DPASS takes one to four digits."""


def read_setting(key: str, text: str) -> str | list[Decimal]:
    """The fields of a kept setting: its numbers, or its bits or program name as they are.

    Raises:
        CommandError: not a kept setting, or fields it does not take.
    """
    row = commands()[key.partition("@")[0]] if key in KEPT_SETTINGS else None
    if row is None:
        raise CommandError(INCORRECT_DATA)
    if row.reply == "name":
        return check_program_name(text) if text else ""
    count = row.fields.count
    if row.reply in ("mask", "word"):
        if len(text) != count or set(text) - {"0", "1"}:
            raise CommandError(INCORRECT_DATA)
        return text
    values = parse_command(f"{row.name}{text}").values
    if len(values) != count:
        raise CommandError(INCORRECT_DATA)
    return [
        checked_number(value, range_of(row), field=number, fields=count) for number, value in enumerate(values, start=1)
    ]


def nonsense(rows: Rows) -> str:
    """What no unit could have kept, in words; empty when all makes sense. Rows are readable (`contents_of`)."""
    for key, text in rows.items():
        try:
            if key.kind == "setting":
                _check_setting(key.name, text)
            elif key.kind == "directory":
                _check_names(text.split(" "))
            elif key.kind == "program":
                parse_command(text)
        except CommandError as error:
            return f"{key.kind} {key.name} {key.place or ''}".rstrip() + f": {text!r}: {error.text}"
    return ""


def _check_setting(name: str, text: str) -> None:
    if name != PASSWORD:
        read_setting(name, text)
    elif not (text.isascii() and text.isdigit() and len(text) <= PASSWORD_DIGITS):
        raise CommandError(INCORRECT_DATA)


def _check_names(names: list[str]) -> None:
    for name in names:
        if is_command_name(check_program_name(name)):
            raise CommandError(STRING_IS_A_COMMAND)

"""The shape of each reply, both ways: what the unit prints a client reads back with the same row.

A row of the catalogue names its shape (``reply``) and its number format; here are the few shapes there are.  Formatting
takes user units, so scaling happens before; parsing gives back exact decimals and bit texts.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from protocol.catalogue import CommandRow, NumberFormat
from protocol.errors import ReplyError
from protocol.numbers import GAIN_PLACES, format_fixed, format_shortest, format_signed, parse_number
from protocol.reply import ReplyLine, group_bits, ungroup_bits

LIMITS_PER_AXIS = 3
NO_PROGRAM_DEFINED = "NO PROGRAM DEFINED"

_AXIS = re.compile(r"\d*", re.ASCII)
_TRIGGER_LETTERS = ("A", "B")
_UNSCALED_COUNTS = ("distance", "master", "path_distance")


@dataclass(frozen=True, slots=True)
class ParsedReply:
    """A reply line taken apart: ``numbers`` for numeric shapes, ``bits`` for masks and words, else ``text``.

    Beside numbers or a mask ``text`` holds the trigger letter of ``TPCA A``, ``TRGFN B`` and their like.
    """

    axis: int | None
    name: str
    numbers: tuple[Decimal, ...] = ()
    bits: str = ""
    text: str = ""


def format_number(value: Decimal, number_format: NumberFormat | None, places: int) -> str:
    """One number as its command prints it."""
    if number_format == "signed":
        return format_signed(value, places)
    if number_format == "shortest":
        return format_shortest(value, places)
    return format_fixed(value, places)


def places_of(row: CommandRow) -> int:
    """The decimals a row prints unscaled: none for settings in counts, whatever SCALE1 would let a host type."""
    fields = row.fields
    if row.kind == "setting" and fields.scale in _UNSCALED_COUNTS and fields.number_format != "shortest":
        return 0
    if fields.decimals is not None:
        return fields.decimals
    return GAIN_PLACES if fields.number_format == "shortest" else 0


def label(row: CommandRow, axis: int | None) -> str:
    """The head of a reply: axis number, when one was asked for, and command name."""
    return f"{'' if axis is None else axis}{row.name}"


def numbers_line(row: CommandRow, axis: int | None, values: Sequence[Decimal], places: Sequence[int]) -> ReplyLine:
    """``1V`` + ``5.0000`` or ``TPE`` + ``+0,+0``: one number a field, ``places`` decimals each."""
    texts = [
        format_number(value, row.fields.number_format, digits) for value, digits in zip(values, places, strict=True)
    ]
    return ReplyLine(label(row, axis), ",".join(texts))


def mask_line(row: CommandRow, axis: int | None, bits: str) -> ReplyLine:
    """``DRIVE`` + ``00``: packed digits without separators."""
    return ReplyLine(label(row, axis), bits)


def word_line(row: CommandRow, axis: int | None, bits: str) -> ReplyLine:
    """``1TAS`` + ``0000_0000_...``: bit 1 first, groups of four (of three for TLIM)."""
    return ReplyLine(label(row, axis), group_bits(bits, LIMITS_PER_AXIS if row.reply == "limits" else 4))


def bit_line(value: str) -> ReplyLine:
    """The answer to ``.n``: the digit alone, without a name."""
    return ReplyLine("", value)


def name_line(row: CommandRow, program: str) -> ReplyLine:
    """``STARTP`` + `` MAIN`` or `` NO PROGRAM DEFINED``."""
    return ReplyLine(row.name, f" {program or NO_PROGRAM_DEFINED}")


def parse_reply_line(line: str, row: CommandRow) -> ParsedReply:
    """Read one line of a reply to ``row`` back (with or without ``*``, name and axis number: ERRLVL 0 to 4).

    Raises:
        ReplyError: the line does not have the shape the row calls for.
    """
    axis, name, rest = _split(line.removeprefix("*"), row.name)
    if row.reply == "numbers":
        letter, rest = _split_letter(rest)
        return ParsedReply(axis, name, numbers=tuple(parse_number(field) for field in rest.split(",")), text=letter)
    if row.reply == "mask":
        letter, rest = _split_letter(rest)
        if not rest or set(rest) - set("01X"):
            raise ReplyError(f"not a mask: {line!r}")
        return ParsedReply(axis, name, bits=rest, text=letter)
    if row.reply in ("word", "limits"):
        return ParsedReply(axis, name, bits=ungroup_bits(rest, LIMITS_PER_AXIS if row.reply == "limits" else 4))
    if row.reply == "name":
        program = rest.strip()
        return ParsedReply(axis, name, text="" if program == NO_PROGRAM_DEFINED else program)
    return ParsedReply(axis, name, text=rest)


def reply_value(line: str, row: CommandRow) -> str:
    """A line of a reply to ``row`` without asterisk, axis number and name."""
    return _split(line.removeprefix("*"), row.name)[2]


def _split(line: str, name: str) -> tuple[int | None, str, str]:
    """Axis number, name and value; a line without the name (ERRLVL 1 and 0) is all value."""
    digits = _AXIS.match(line)
    start = digits.end() if digits else 0
    if not line.startswith(name, start):
        return None, "", line
    return (int(line[:start]) if start else None), name, line[start + len(name) :]


def _split_letter(value: str) -> tuple[str, str]:
    return (value[0], value[1:]) if value.startswith(_TRIGGER_LETTERS) else ("", value)

"""Replies in words: status words bit by bit, error messages with what draws them.

Everything comes from the catalogue. A reply without its name (ERRLVL 1 and 0, or a single bit) is read by what was
last asked.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Literal

from protocol.catalogue import CommandRow, ErrorRow, StatusWordRow, error_rows, lookup, status_words
from protocol.command import Command, parse_command
from protocol.errors import CommandError
from protocol.status_report import bit_labels

Detail = Literal["off", "set", "all"]
"""Which bits are shown: none, those that are set, all that mean something."""

_NAMED = re.compile(r"\*?(?P<axis>\d?)(?P<name>[A-Z]+)(?P<bits>[01XE]{2,}(?:_[01XE]+)*)")
_NAMELESS = re.compile(r"\*?(?P<bits>[01XE]{2,}(?:_[01XE]+)*)")
_ONE_BIT = re.compile(r"\*?(?P<bits>[01])")
_NO_LABEL = "RESERVED"


def command_of(line: str) -> Command | None:
    """The last command of a typed line, if it can be read: what a reply without a name belongs to."""
    for text in reversed(line.split(":")):
        try:
            return parse_command(re.sub(r"^\s*\d{1,2}_", "", text))
        except CommandError:
            continue
    return None


def decode(line: str, *, detail: Detail = "set", asked: Command | None = None) -> list[str]:
    """A line of the unit in words, a line or more; nothing for what needs none."""
    if detail == "off":
        return []
    if match := _NAMED.fullmatch(line.strip()):
        word = _word(match["name"])
        return [] if word is None else _in_words(word, match["axis"], match["bits"], detail)
    word = None if asked is None or asked.row is None else _word(asked.row.name)
    if word is None or asked is None:
        return []
    axis = str(asked.axis or "")
    if asked.bit is not None and (match := _ONE_BIT.fullmatch(line.strip())):
        return [f"{_place(axis)}bit {asked.bit}, {_names(word)[asked.bit - 1]}: {_switch(match['bits'])}"]
    if match := _NAMELESS.fullmatch(line.strip()):
        return _in_words(word, axis, match["bits"], detail)
    return []


def _in_words(word: StatusWordRow, axis: str, bits: str, detail: Detail) -> list[str]:
    bits = bits.replace("_", "")
    names = _names(word, len(bits))
    place = _place(axis)
    numbered = list(enumerate(zip(bits, names, strict=True), start=1))
    if detail == "all":
        return [f"{place}{number:2} {bit} {name}" for number, (bit, name) in numbered if name or bit == "1"]
    told = "; ".join(f"{number} {name or 'reserved'}" for number, (bit, name) in numbered if bit == "1")
    return [f"{place}{told or 'no bit set'}"]


def _word(name: str) -> StatusWordRow | None:
    return next((word for word in status_words().values() if name == word.report and word.bit), None)


def _place(axis: str) -> str:
    return f"axis {axis}: " if axis else ""


@cache
def _names_of(name: str, count: int) -> tuple[str, ...]:
    """What each bit is called: its label, or its meaning where the table has no label; "" for reserved ones."""
    word = status_words()[name]
    names = [label if label != _NO_LABEL else "" for label in bit_labels(_within(word, count), count)]
    for row in word.bit:
        for number in range(row.number, min(row.last_number or row.number, count) + 1):
            if not names[number - 1] and "reserved" not in row.meaning.lower():
                alone = row.last_number is None
                names[number - 1] = row.meaning if alone else _one_of(row.meaning, number - row.number)
    return tuple(names)


def _one_of(meaning: str, index: int) -> str:
    """`programmable inputs 1-24` for one of them, index from 0."""
    return f"{re.sub(r's? [0-9]+-[0-9]+$', '', meaning)} {index + 1}"


def _within(word: StatusWordRow, count: int) -> StatusWordRow:
    """The word with the bits a short report has."""
    from msgspec.structs import replace

    kept = [replace(row, last_number=min(row.last_number or row.number, count)) for row in word.bit]
    return replace(word, bit=[row for row in kept if row.number <= count])


def _names(word: StatusWordRow, count: int = 32) -> tuple[str, ...]:
    return _names_of(word.name, count)


def _switch(bit: str) -> str:
    return "on" if bit == "1" else "off"


def error_row(text: str) -> ErrorRow | None:
    """The error a message is, `-FIELD 1` and `-AXIS 2` included; None for what is no error message of the catalogue."""
    said = _numberless(text.strip().removeprefix("*"))
    known = {_numberless(row.text): row for row in error_rows()}
    return known.get(said) or known.get(re.sub(r"-(?:AXIS|FIELD) n$", "", said))


def _numberless(text: str) -> str:
    """`INVALID DATA-FIELD 1` as the table has it, with n; Gemini drives have underscores for blanks."""
    return re.sub(r"\d+$", "n", text.replace("_", " "))


def hint(text: str, command: Command | None) -> str | None:
    """What usually draws an error message, and what the refused command takes; None for what is no message."""
    row = error_row(text)
    if row is None:
        return None
    takes = _takes(command.row) if command is not None and command.row is not None else ""
    return f"{row.trigger}{f' | {takes}' if takes else ''}"


def _takes(row: CommandRow) -> str:
    fields = row.fields
    found = [row.syntax]
    if fields.min is not None and fields.max is not None:
        found.append(f"{fields.min} to {fields.max}{f' {fields.units}' if fields.units else ''}")
    found += [text for text in (fields.values, f"needs {row.needs}" if row.needs else "") if text]
    return "; ".join(found)


def summary(name: str) -> str | None:
    """A command in one line, for the toolbar: syntax, title, what it takes, default; None for no such word."""
    row = lookup(name)
    if row is None:
        return None
    default = "" if row.fields.default is None else f"; default {row.fields.default}"
    return f"{row.title}: {_takes(row)}{default}"

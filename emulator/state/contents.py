"""What a unit keeps over power-off, as plain values, and the same as rows of text, one thing a row.

A snapshot (`Contents`) is cheap to take, because the engine thread takes it; making rows of it is the writer's work,
and only for the parts that have changed. Rows are what the file and its readable form hold. Things at their power-up
value have no row, so a file says only what a host has said. Text is exact: a number is written with all its digits.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal, InvalidOperation
from functools import partial
from typing import Any, NamedTuple

Number = tuple[Decimal, int]
"""A value in the user units it was entered in, and the counts per unit then in force (0: the encoder's revolution)."""

KEPT_SETTINGS = ("STARTP", "ADDR", "CMDDIR", "ENCPOL", "DRPCHK@1", "DRPCHK@2", "MEMORY")
"""Settings that survive RESET and power-off, DRPCHK for each serial port (6K list of the knowledge base, assumed M for
the 6000). The serial rate is on that list too; this unit has no command for it."""

PASSWORD = "DPASS"
"""The operator panel's password is kept with the settings."""

ScaledLine = tuple[int, tuple[tuple[int, Number], ...]]
"""A line (from 0) whose command was scaled when it was stored, and its values by field (from 0)."""

UNSET_BITS = "X" * 32
"""A VARB that was never set."""

_PATTERN = re.compile("[01X]{32}")
_GAIN = re.compile(r"SGSET(\d+) axis(\d+) SFB(\d+) ([A-Z][A-Z0-9]*)")
_NUMBER = re.compile(r"([^*]+)(?:\*(\d+))?")


class Key(NamedTuple):
    """Which thing of a unit a row is about: kind, name, and place within the name (line, number of a variable)."""

    kind: str
    name: str
    place: int


Rows = dict[Key, str]


class ProgramText(NamedTuple):
    """One program: its commands, and for lines with scaled values those values by field index."""

    name: str
    lines: tuple[str, ...]
    scaled: tuple[ScaledLine, ...] = ()


class GainValue(NamedTuple):
    """One value of a gain set; axis and feedback source as the host counts them (axis 1, SFB1)."""

    set_number: int
    axis: int
    feedback: int
    command: str
    value: Number


class Contents(NamedTuple):
    """Everything one unit keeps. Variables are numbered from 1: the first of ``numbers`` is VAR1."""

    settings: tuple[tuple[str, str], ...] = ()
    """``STARTP``, ``ADDR``, ``DRPCHK@2`` ... and the text of their fields."""
    numbers: tuple[Decimal, ...] = ()
    bits: tuple[str, ...] = ()
    texts: tuple[str, ...] = ()
    programs: tuple[ProgramText, ...] = ()
    """In the order they were defined, data programs among them."""
    gains: tuple[GainValue, ...] = ()
    profiles: tuple[tuple[str, str], ...] = ()
    """Compiled profiles by program name. A unit forgets what is compiled at power-off and asks for PCOMP again (assumed
    M), so it leaves this empty; the place is for files of units that keep them, as later products do."""


# Parts: sequences of things, a row each, compared place by place.

PartName = tuple[str, str]
Row = tuple[Key, str]
Part = tuple[Sequence[Any], Callable[[int, Any], Row | None]]
"""Things, and what makes the row of one from its place (from 0) and itself; None: it needs none."""

_NO_PART: Part = ((), lambda index, value: None)


def parts(contents: Contents) -> dict[PartName, Part]:
    """The contents cut into parts that change independently."""
    cut: dict[PartName, Part] = {
        ("settings", ""): (contents.settings, lambda index, named: (Key("setting", named[0], 0), named[1])),
        ("VAR", ""): (contents.numbers, _number_row),
        ("VARB", ""): (contents.bits, partial(_text_row, "VARB", UNSET_BITS)),
        ("VARS", ""): (contents.texts, partial(_text_row, "VARS", "")),
        ("gains", ""): (contents.gains, _gain_row),
        ("profiles", ""): (contents.profiles, lambda index, named: (Key("profile", named[0], 0), named[1])),
        ("directory", ""): ([" ".join(program.name for program in contents.programs)], _directory_row),
    }
    for program in contents.programs:
        cut["program", program.name] = (program.lines, partial(_line_row, program.name))
        cut["scaled", program.name] = (program.scaled, partial(_scaled_row, program.name))
    return cut


def difference(before: Part | None, after: Part | None) -> tuple[Rows, Rows]:
    """The rows of the places at which two snapshots of a part differ: as they were, and as they are.

    Compared by identity, which is quick, and since equal numbers may be written differently.
    """
    (old, old_row), (new, new_row) = before or _NO_PART, after or _NO_PART
    common = min(len(old), len(new))
    places = [place for place, (one, other) in enumerate(zip(old, new, strict=False)) if one is not other]
    was = (old_row(place, old[place]) for place in (*places, *range(common, len(old))))
    now = (new_row(place, new[place]) for place in (*places, *range(common, len(new))))
    return dict(row for row in was if row), dict(row for row in now if row)


def rows_of(contents: Contents) -> Rows:
    """All rows of a unit."""
    rows: Rows = {}
    for part in parts(contents).values():
        rows |= difference(None, part)[1]
    return rows


def _number_row(index: int, number: Decimal) -> Row | None:
    return _text_row("VAR", "0", index, str(number))


def _text_row(kind: str, cleared: str, index: int, text: str) -> Row | None:
    return None if text == cleared else (Key(kind, "", index + 1), text)


def _gain_row(index: int, gain: GainValue) -> Row:
    name = f"SGSET{gain.set_number} axis{gain.axis} SFB{gain.feedback} {gain.command}"
    return Key("gain", name, 0), number_text(gain.value)


def _directory_row(index: int, names: str) -> Row | None:
    return (Key("directory", "", 0), names) if names else None


def _line_row(program: str, index: int, line: str) -> Row:
    return Key("program", program, index + 1), line


def _scaled_row(program: str, index: int, scaled: ScaledLine) -> Row:
    line, values = scaled
    return Key("scaled", program, line + 1), scaled_text(values)


def number_text(number: Number) -> str:
    """``5``, or ``5*25000`` with its scale factor."""
    value, factor = number
    return str(value) if factor == 1 else f"{value}*{factor}"


def scaled_text(values: Iterable[tuple[int, Number]]) -> str:
    """``1=5*25000 2=7*25000``: fields from 1."""
    return " ".join(f"{index + 1}={number_text(number)}" for index, number in values)


# Back from rows.


def contents_of(rows: Mapping[Key, str]) -> Contents:
    """What rows say: variables without a row are at their power-up value; programs the directory does not list (they
    did not fit the machine that wrote it) come last.

    Raises:
        ValueError: a row that says nothing a unit could keep; the text names it.
    """
    reading = _Reading()
    for key, text in sorted(rows.items()):
        reading.take(key, text)
    return reading.contents()


class _Reading:
    """Rows taken one after another, sorted."""

    def __init__(self) -> None:
        self._settings: list[tuple[str, str]] = []
        self._numbers: dict[int, Decimal] = {}
        self._bits: dict[int, str] = {}
        self._texts: dict[int, str] = {}
        self._lines: dict[str, list[str]] = {}
        self._scaled: dict[str, list[ScaledLine]] = {}
        self._names: list[str] = []
        self._gains: list[GainValue] = []
        self._profiles: list[tuple[str, str]] = []

    def take(self, key: Key, text: str) -> None:
        try:
            self._take(key, text)
        except (ValueError, InvalidOperation):
            words = " ".join(str(word) for word in key if word != "")
            raise ValueError(f"{words}: {text!r} cannot be read") from None

    def _take(self, key: Key, text: str) -> None:
        match key.kind:
            case "setting":
                self._settings.append((key.name, text))
            case "VAR":
                self._numbers[_place(key)] = _decimal(text)
            case "VARB":
                self._bits[_place(key)] = _matched(_PATTERN, text)[0]
            case "VARS":
                self._texts[_place(key)] = text
            case "directory":
                self._names = text.split(" ")
            case "program":
                self._take_line(key, text)
            case "scaled":
                values = tuple(_field(word) for word in text.split(" "))
                self._scaled.setdefault(key.name, []).append((_place(key) - 1, values))
            case "gain":
                number, axis, feedback, command = _matched(_GAIN, key.name).groups()
                self._gains.append(GainValue(int(number), int(axis), int(feedback), command, number_of(text)))
            case "profile":
                self._profiles.append((key.name, text))
            case _:
                raise ValueError

    def _take_line(self, key: Key, text: str) -> None:
        lines = self._lines.setdefault(key.name, [])
        lines.append(text)
        if key.place != len(lines):
            raise ValueError

    def contents(self) -> Contents:
        if len(set(self._names)) != len(self._names):
            raise ValueError("the directory names a program twice")
        unlisted = (self._lines.keys() | self._scaled.keys()) - set(self._names)
        programs = [self._program(name) for name in [*self._names, *sorted(unlisted)]]
        return Contents(
            settings=tuple(self._settings),
            numbers=_filled(self._numbers, Decimal(0)),
            bits=_filled(self._bits, UNSET_BITS),
            texts=_filled(self._texts, ""),
            programs=tuple(programs),
            gains=tuple(self._gains),
            profiles=tuple(self._profiles),
        )

    def _program(self, name: str) -> ProgramText:
        lines, scaled = self._lines.get(name, []), self._scaled.get(name, [])
        if any(index >= len(lines) for index, _ in scaled):
            raise ValueError(f"program {name}: scaled values of a line it does not have")
        return ProgramText(name, tuple(lines), tuple(scaled))


def _place(key: Key) -> int:
    if key.place < 1:
        raise ValueError
    return key.place


def _filled(values: Mapping[int, Any], cleared: Any) -> tuple[Any, ...]:
    return tuple(values.get(number, cleared) for number in range(1, max(values, default=0) + 1))


def _matched(pattern: re.Pattern[str], text: str) -> re.Match[str]:
    match = pattern.fullmatch(text)
    if match is None:
        raise ValueError
    return match


def _decimal(text: str) -> Decimal:
    value = Decimal(text)
    if not value.is_finite():
        raise ValueError
    return value


def number_of(text: str) -> Number:
    """What `number_text` wrote.

    Raises:
        ValueError, InvalidOperation: it is none.
    """
    value, factor = _matched(_NUMBER, text).groups()
    return _decimal(value), 1 if factor is None else int(factor)


def _field(word: str) -> tuple[int, Number]:
    field, equals, number = word.partition("=")
    if not equals or int(field) < 1:
        raise ValueError
    return int(field) - 1, number_of(number)

"""The readable form of a state file: TOML, so that a person can read, compare and change it and a parser reads it back.

    format = 1

    [unit.1.settings]
    STARTP = "MAIN"

    [unit.1.VAR]
    3 = "12.50"

    [unit.1.program.MAIN]
    lines = [
      'D4000',
      'GO1',
    ]
    scaled = { 1 = "1=5*25000" }

Units count from 1. Every value is a string, because what is kept is text and has to come back digit for digit; one
that holds nothing but printable characters stands between single quotes as it is. `scaled` gives the values of a line
whose command was scaled when it was stored: field = value * scale factor.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

from emulator.state.contents import Key, Rows, contents_of
from emulator.state.errors import StateError
from emulator.state.sense import nonsense

FORMAT = 1
_SIMPLE = {"setting": "settings", "gain": "gains", "profile": "profiles"}
_NUMBERED = ("VAR", "VARB", "VARS")
_HEADING = "# OEM6250 non-volatile memory; see docs/state.md"


def export(units: Mapping[int, Rows]) -> str:
    """The rows of all units (by index from 0) as text."""
    lines = [_HEADING, f"format = {FORMAT}"]
    for unit in sorted(units):
        lines += _unit_lines(f"unit.{unit + 1}", units[unit])
    return "\n".join(lines) + "\n"


def _unit_lines(unit: str, rows: Rows) -> Iterator[str]:
    yield f"\n[{unit}]"
    for kind, table in _SIMPLE.items():
        named = sorted((key.name, text) for key, text in rows.items() if key.kind == kind)
        yield from _table(f"{unit}.{table}", {_bare(name): text for name, text in named})
    for kind in _NUMBERED:
        numbered = sorted((key.place, text) for key, text in rows.items() if key.kind == kind)
        yield from _table(f"{unit}.{kind}", {str(number): text for number, text in numbered})
    for program in contents_of(rows).programs:
        yield f"\n[{unit}.program.{_bare(program.name)}]"
        yield "lines = ["
        yield from (f"  {_quoted(line)}," for line in program.lines)
        yield "]"
        scaled = [(index + 1, rows[Key("scaled", program.name, index + 1)]) for index, _ in program.scaled]
        if scaled:
            yield f"scaled = {{ {', '.join(f'{line} = {_quoted(text)}' for line, text in scaled)} }}"


def _table(name: str, values: Mapping[str, str]) -> Iterator[str]:
    if values:
        yield f"\n[{name}]"
        yield from (f"{key} = {_quoted(text)}" for key, text in values.items())


def _bare(key: str) -> str:
    plain = key.isascii() and key.replace("_", "").replace("-", "").isalnum()
    return key if plain else _quoted(key)


def _quoted(text: str) -> str:
    if "'" not in text and text.isprintable():
        return f"'{text}'" if '"' in text or "\\" in text else f'"{text}"'
    return '"' + "".join(_escaped(character) for character in text) + '"'


def _escaped(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if character.isprintable() else f"\\u{ord(character):04X}"


# Reading.


def read(text: str, *, name: str) -> dict[int, Rows]:
    """The rows of all units, from text; ``name`` stands for its file in errors.

    Raises:
        StateError: it is not what `export` writes, or says what no unit keeps.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise StateError(f"{name}: {error}") from None
    version = document.pop("format", None)
    if version != FORMAT:
        found = "does not say format = 1" if version is None else f"is of format {version!r}"
        raise StateError(f"{name}: {found}; this oem6250 reads format {FORMAT}")
    return _Reader(name).units(document)


class _Reader:
    """Walks the document, saying where it is when something is wrong."""

    def __init__(self, name: str) -> None:
        self._name = name

    def units(self, document: dict[str, Any]) -> dict[int, Rows]:
        tables = self._only(document, "", "unit")
        units = {}
        for number, table in self._items(tables.get("unit", {}), "unit"):
            place = f"unit.{number}"
            index = self._number(number, place) - 1
            units[index] = self._unit(table, place)
            self._check(units[index], place)
        return units

    def _unit(self, table: Any, place: str) -> Rows:
        known = (*_SIMPLE.values(), *_NUMBERED, "program")
        table = self._only(table, place, *known)
        rows: Rows = {}
        for kind, tables in _SIMPLE.items():
            for name, text in self._items(table.get(tables, {}), f"{place}.{tables}"):
                rows[Key(kind, name, 0)] = self._text(text, f"{place}.{tables}.{name}")
        for kind in _NUMBERED:
            for number, text in self._items(table.get(kind, {}), f"{place}.{kind}"):
                key = f"{place}.{kind}.{number}"
                rows[Key(kind, "", self._number(number, key))] = self._text(text, key)
        programs = dict(self._items(table.get("program", {}), f"{place}.program"))
        for name, program in programs.items():
            rows |= self._program(name, program, f"{place}.program.{name}")
        if programs:
            rows[Key("directory", "", 0)] = " ".join(programs)
        return rows

    def _program(self, name: str, table: Any, place: str) -> Rows:
        if not name or " " in name:
            raise self._wrong(place, "is no name of a program")
        table = self._only(table, place, "lines", "scaled")
        lines = table.get("lines", [])
        if not isinstance(lines, list):
            raise self._wrong(f"{place}.lines", "must be a list of commands")
        rows = {
            Key("program", name, number): self._text(line, f"{place}.lines, line {number}")
            for number, line in enumerate(lines, start=1)
        }
        for number, text in self._items(table.get("scaled", {}), f"{place}.scaled"):
            key = f"{place}.scaled.{number}"
            rows[Key("scaled", name, self._number(number, key))] = self._text(text, key)
        return rows

    def _check(self, rows: Rows, place: str) -> None:
        for check in (_unreadable, nonsense):
            wrong = check(rows)
            if wrong:
                raise self._wrong(place, wrong)

    # Pieces.

    def _only(self, table: Any, place: str, *known: str) -> dict[str, Any]:
        for key, _ in self._items(table, place or "the file"):
            if key not in known:
                raise self._wrong(f"{place}.{key}".lstrip("."), f"is not known here; there are {', '.join(known)}")
        return dict(table)

    def _items(self, table: Any, place: str) -> Iterator[tuple[str, Any]]:
        if not isinstance(table, dict):
            raise self._wrong(place, "must be a table")
        return iter(table.items())

    def _text(self, value: Any, place: str) -> str:
        if not isinstance(value, str):
            raise self._wrong(place, f"must be a string, not {value!r}")
        return value

    def _number(self, text: str, place: str) -> int:
        if not (text.isascii() and text.isdigit() and 0 < int(text) < 1_000_000 and text == str(int(text))):
            raise self._wrong(place, f"{text!r} is not a number from 1")
        return int(text)

    def _wrong(self, place: str, what: str) -> StateError:
        return StateError(f"{self._name}: {place}: {what}")


def _unreadable(rows: Rows) -> str:
    try:
        contents_of(rows)
    except ValueError as error:
        return str(error)
    return ""

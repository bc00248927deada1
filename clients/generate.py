"""`python -m clients.generate`: writes the typed commands (clients/typed/*.py) from the catalogue.

The files are committed, so that editors see them; a test compares them with what this module makes.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from clients.names import readable_name
from protocol import status as words
from protocol.catalogue import CommandRow, rows, status_words
from protocol.status import StatusBit

FOLDER = Path(__file__).parent / "typed"
WIDTH = 120

CHOICES = {"LH": "EndOfTravel", "LS": "EndOfTravel", "SFB": "FeedbackSource", "ERRLVL": "ErrorLevel"}
SINGLE = frozenset({"TSEG", "TTIM"})
"""Unit-wide reports of one number; the others give a tuple."""

TRIGGERED = frozenset({"TPCA", "TPCC", "TPCE"})
"""Reports that take the letter of a trigger."""

LEFT_OUT = frozenset({"VAR", "VARB", "VARS", "TAS", "TASX", "TFS", "TSS", "TER", "TINO", "TPROG", "TSGSET", "TRGFN"})
"""They have faces of their own: variables, status, programs, gains; TRGFN takes a letter before its mask."""

FLAGS = {
    "AxisFlags": (words.AxisStatus, "AS"),
    "ExtendedAxisFlags": (words.ExtendedAxisStatus, "ASX"),
    "SystemFlags": (words.SystemStatus, "SS"),
    "ErrorFlags": (words.ErrorStatus, "ER"),
    "FollowingFlags": (words.FollowingStatus, "FS"),
    "OtherInputFlags": (words.OtherInputs, "INO"),
}
_DECIMAL_SCALES = (
    *("acceleration", "velocity", "distance", "master"),
    *("path_acceleration", "path_velocity", "path_distance"),
)


@dataclass(frozen=True)
class Value:
    """How a setting or report is typed: `reads` and `kind` name a function of `clients.values` and its type."""

    reads: str
    kind: str
    takes: str
    extra: str = ""
    spread: bool = False


def value_of(row: CommandRow, *, axis: bool) -> Value:
    """The Python type of a row's value."""
    fields = row.fields
    if row.name in CHOICES:
        kind = CHOICES[row.name]
        return Value("choice", kind, kind, f", {kind}")
    if row.reply == "numbers":
        is_real = fields.type == "real" or fields.scale in _DECIMAL_SCALES or (fields.decimals or 0) > 0
        single = axis or row.name in SINGLE or (row.kind == "setting" and fields.count == 1)
        base = ("real", "float") if is_real else ("whole", "int")
        takes = "Number" if is_real else "int"
        return (
            Value(base[0], base[1], takes)
            if single
            else Value(f"{base[0]}s", f"tuple[{base[1]}, ...]", f"Sequence[{takes}]", spread=True)
        )
    if row.reply == "mask" and (axis or fields.count == 1):
        return Value("flag", "bool", "bool")
    if row.reply in ("mask", "word", "limits"):
        return Value("bits", "str", "str")
    if row.reply in ("name", "text"):
        return Value("text_of", "str", "str")
    return Value("lines_of", "tuple[str, ...]", "str")


def docstring(row: CommandRow, indent: str, *, fact: str = "") -> list[str]:
    """Title, command name, units, range, default, source."""
    fields = row.fields
    parts = [f"{row.title.rstrip('.')} (`{row.name}`)."]
    if fields.units:
        parts.append(f"Units: {fields.units}.")
    if fields.min is not None and fields.max is not None:
        parts.append(f"Range {fields.min} to {fields.max}.")
    if fields.default is not None and row.kind == "setting":
        parts.append(f"Default {fields.default}.")
    if fields.values:
        parts.append(f"Values: {' '.join(fields.values.split())}.")
    if fact:
        parts.append(fact)
    text = " ".join(parts).replace("\\", "\\\\").replace('"', "'")
    lines = textwrap.wrap(f'"""{text}"""', WIDTH - len(indent), break_on_hyphens=False)
    return [indent + line for line in lines]


class Face:
    """Writes the members of one class; `is_async` chooses between properties and awaitable methods."""

    def __init__(self, *, is_async: bool) -> None:
        self.is_async = is_async
        self._def = "    async def" if is_async else "    def"
        self._go = "await self._run" if is_async else "self._run"

    def member(self, row: CommandRow, *, axis: bool) -> list[str]:
        """The property or method of a row."""
        if row.kind == "action":
            return self._action(row, axis=axis)
        if row.name in TRIGGERED:
            return self._triggered(row)
        if row.kind == "setting" and row.reply == "text":
            return self._indexed(row)
        return self._value(row, axis=axis)

    def _value(self, row: CommandRow, *, axis: bool) -> list[str]:
        name, value = readable_name(row), value_of(row, axis=axis)
        call = f'{self._go}(values.{value.reads}(self._session, "{row.name}", self._axis{value.extra}))'
        given = "*value" if value.spread else "value"
        put = f'{self._go}(values.write(self._session, "{row.name}", self._axis, {given}))'
        doc = docstring(row, " " * 8)
        settable = row.kind == "setting"
        if self.is_async:
            lines = [f"{self._def} get_{name}(self) -> {value.kind}:", *doc, f"        return {call}", ""]
            if settable:
                lines += [f"{self._def} set_{name}(self, value: {value.takes}) -> None:", *doc, f"        {put}", ""]
            return lines
        lines = ["    @property", f"    def {name}(self) -> {value.kind}:", *doc, f"        return {call}", ""]
        if settable:
            setter = [f"    @{name}.setter", f"    def {name}(self, value: {value.takes}) -> None:", f"        {put}"]
            lines += [*setter, ""]
        return lines

    def _triggered(self, row: CommandRow) -> list[str]:
        """A captured position by the letter of its trigger."""
        head = f'{self._def} {readable_name(row)}(self, trigger: Literal["A", "B"] = "A") -> float:'
        call = f'{self._go}(values.real(self._session, "{row.name}", self._axis, trigger))'
        return [head, *docstring(row, " " * 8), f"        return {call}", ""]

    def _indexed(self, row: CommandRow) -> list[str]:
        """A setting with its own syntax: asked with an index, set as text."""
        name = readable_name(row)
        ask = f'{self._go}(values.lines_of(self._session, "{row.name}", self._axis, str(index or "")))'
        put = f'{self._go}(values.write(self._session, "{row.name}", self._axis, text))'
        doc = docstring(row, " " * 8, fact=f"Syntax: {row.syntax}.")
        return [
            f"{self._def} get_{name}(self, index: int | None = None) -> tuple[str, ...]:",
            *doc,
            f"        return {ask}",
            "",
            f"{self._def} set_{name}(self, text: str) -> None:",
            *doc,
            f"        {put}",
            "",
        ]

    def _action(self, row: CommandRow, *, axis: bool) -> list[str]:
        parameters, given = _parameters(row, axis=axis)
        head = f"{self._def} {readable_name(row)}(self{parameters}) -> None:"
        call = f'        {self._go}(values.write(self._session, "{row.name}", self._axis{given}))'
        return [head, *docstring(row, " " * 8), call, ""]


def _parameters(row: CommandRow, *, axis: bool) -> tuple[str, str]:
    """The parameters of an action's method and what is passed on."""
    kind, count = row.fields.type, row.fields.count
    if count == 0:
        return "", ""
    if row.name == "HOM":
        return ", *, negative: bool", ', "1" if negative else "0"'
    if axis and kind == "binary":
        return "", ""
    if kind == "string":
        return ", text: str", ", values.quoted(text)"
    if kind == "name":
        return ", name: str", ', " " + name'
    if kind in ("expression", "bit-pattern") or (kind == "binary" and count > 1):
        return ", text: str", ", text"
    if axis or count == 1:
        return ", value: Number", ", value"
    return ", *fields: Number", ", *fields"


def members(*, axis: bool, kinds: tuple[str, ...]) -> Iterator[CommandRow]:
    """The rows of a class, by readable name."""
    chosen = [
        row
        for row in rows()
        if row.applies_to_oem6250 and row.kind in kinds and row.fields.per_axis == axis and row.name not in LEFT_OUT
    ]
    yield from sorted(chosen, key=readable_name)


CLASSES = (
    ("AxisCommands", "The settings, reports and actions of one axis.", True, ("setting", "report", "action")),
    ("UnitSettings", "The settings of the whole unit.", False, ("setting",)),
    ("UnitReports", "The reports of the whole unit.", False, ("report",)),
    ("UnitActions", "The actions of the whole unit.", False, ("action",)),
)
_HEAD = '''"""{title} Written by `python -m clients.generate`; do not edit."""

# ruff: noqa
# fmt: off

from __future__ import annotations

'''


def commands_module(*, is_async: bool) -> str:
    """One of clients/typed/blocking.py and awaitable.py."""
    title = "Typed commands, awaitable." if is_async else "Typed commands, blocking."
    base = "AwaitableFace" if is_async else "BlockingFace"
    choices = ", ".join(sorted(set(CHOICES.values())))
    lines = [
        _HEAD.format(title=title) + "from collections.abc import Sequence",
        "from typing import Literal",
        "",
        "from clients import values",
        f"from clients.choices import {choices}",
        f"from clients.faces import {base}",
        "from clients.values import Number",
    ]
    for name, doc, axis, kinds in CLASSES:
        lines += ["", "", f"class {name}({base}):", f'    """{doc}"""', ""]
        for row in members(axis=axis, kinds=kinds):
            lines += Face(is_async=is_async).member(row, axis=axis)
        lines.pop()
    return "\n".join(lines) + "\n"


def flags_module() -> str:
    """clients/typed/flags.py: the status words as IntFlags."""
    lines = [_HEAD.format(title="Status words as flags.") + "from enum import IntFlag"]
    for name, (bits, word) in FLAGS.items():
        report = status_words()[word].report
        lines += ["", "", f"class {name}(IntFlag):", f'    """{word}, reported by {report}; bit 1 weighs 1."""', ""]
        lines += [f"    {bit.name} = 1 << {bit.value - 1}" for bit in bits]
    return "\n".join(lines) + "\n"


def words_module() -> str:
    """clients/typed/words.py: the status words with a property a bit."""
    names = ", ".join(sorted(FLAGS))
    lines = [
        _HEAD.format(title="Status words with a property a bit.") + f"from clients.status import {names}, StatusWord"
    ]
    for flags, (bits, word) in FLAGS.items():
        lines += ["", "", f"class {flags.removesuffix('Flags')}Word(StatusWord[{flags}]):"]
        lines += [f'    """{word}, reported by {status_words()[word].report}."""', "", "    __slots__ = ()", ""]
        for bit in bits:
            lines += ["    @property", f"    def {bit.name.lower()}(self) -> bool:"]
            doc = f'        """{_meaning(word, bit)} (bit {bit.value})."""'
            lines += [doc, f"        return self.bit({bit.value})", ""]
        lines.pop()
    return "\n".join(lines) + "\n"


def _meaning(word: str, bit: StatusBit) -> str:
    for row in status_words()[word].bit:
        if row.number <= bit.value <= (row.last_number or row.number):
            return row.meaning[:1].upper() + row.meaning[1:]
    return bit.name.replace("_", " ").capitalize()


def modules() -> dict[str, str]:
    """Every generated file by name."""
    return {
        "blocking.py": commands_module(is_async=False),
        "awaitable.py": commands_module(is_async=True),
        "flags.py": flags_module(),
        "words.py": words_module(),
    }


def main() -> int:
    """Write the files that differ."""
    for name, text in modules().items():
        path = FOLDER / name
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")
            print(f"written: {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

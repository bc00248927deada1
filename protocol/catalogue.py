"""The command catalogue: what the 6000 language of the OEM6250 consists of, as data.

One row a command, kept as TOML under ``catalogue_data/`` (a file a group), packed by ``protocol.pack`` and read once
into frozen structures.
Parsing, validation, report formats, help and the fidelity ledger are all made from these rows, so a command that
only stores and reports a setting needs a row here and no code anywhere.  Each row carries its provenance:
``source`` names the manual and page or the host software it was seen in, or says "assumed".
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Literal

import msgspec

Kind = Literal["setting", "report", "action", "flow", "operator", "operand"]
FieldType = Literal[
    "real", "int", "binary", "bit-pattern", "name", "string", "mixed", "expression", "operand", "operator", "none"
]
Scale = Literal["acceleration", "velocity", "distance", "master", "path_acceleration", "path_velocity", "path_distance"]
NumberFormat = Literal["fixed", "signed", "shortest"]
Prefixable = Literal["either", "buffered", "immediate"]
ReplyShape = Literal["numbers", "mask", "word", "limits", "name", "assignment", "text", "table", "lines", "none"]


class Fields(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The data fields a command takes; ``count`` 0 means none.

    ``min``, ``max`` and ``default`` are in user units; a text default lists one value a field ("13,10,0").
    ``scale`` says which scale factor applies to the values, ``number_format`` how a report prints them.
    """

    count: int
    type: FieldType = "none"
    per_axis: bool = False
    units: str = ""
    min: float | int | str | None = None
    max: float | int | str | None = None
    decimals: int | None = None
    default: float | int | str | None = None
    max_scaled: str = ""
    scale: Scale | None = None
    number_format: NumberFormat | None = None
    values: str = ""
    parts: str = ""
    order: str = ""
    index: str = ""
    bits: int = 0
    also: str = ""
    clear: str = ""
    operators: str = ""
    source_digit: str = ""
    resulting_range: str = ""
    max_length: int = 0
    decimals_by_factor: dict[str, int] = {}


class CommandRow(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One command of the language: what it is called, what it takes, what it answers, where that is known from."""

    name: str
    title: str
    kind: Kind
    syntax: str
    immediate: Prefixable
    fields: Fields
    source: str
    confidence: Literal["high", "medium", "low"]
    aliases: list[str] = []
    reply: ReplyShape = "none"
    query_response: str = ""
    needs: str = ""
    notes: str = ""
    at_rest: bool = False
    applies_to_oem6250: bool = True
    group: str = ""


class OtherProductNames(msgspec.Struct, frozen=True, kw_only=True):
    """Names known only on other products, and the error this unit answers to them."""

    commands: list[str]
    reason: str
    error: str
    confidence: str


class ErrorRow(msgspec.Struct, frozen=True, kw_only=True):
    """One error text of the unit and what draws it."""

    text: str
    trigger: str
    confidence: str


class IoFunctionRow(msgspec.Struct, frozen=True, kw_only=True):
    """One letter of INFNC or OUTFNC."""

    letter: str
    meaning: str
    applies: str
    confidence: str
    notes: str = ""


class BitRow(msgspec.Struct, frozen=True, kw_only=True):
    """One bit (or run of like bits) of a status word; bit 1 is printed first, at the left."""

    number: int
    meaning: str
    last_number: int | None = None
    label: str = "RESERVED"
    branch: str = ""
    notes: str = ""
    confidence: str = ""


class StatusWordRow(msgspec.Struct, frozen=True, kw_only=True):
    """One status word: the report that shows it, whether it is per axis, its bits."""

    name: str
    report: str
    scope: str
    source: str
    note: str = ""
    format: str = ""
    polarity: str = ""
    confidence: str = ""
    bit: list[BitRow] = []


class _OtherProducts(msgspec.Struct):
    names: list[OtherProductNames]


class _ErrorMessages(msgspec.Struct):
    error: list[ErrorRow]


class _StatusWords(msgspec.Struct):
    word: list[StatusWordRow]


class _Packed(msgspec.Struct):
    """The file made by ``protocol.pack``."""

    commands: list[CommandRow]
    other_products: _OtherProducts
    error_messages: _ErrorMessages
    status_words: _StatusWords
    io_functions: dict[str, list[IoFunctionRow]]


@cache
def _packed() -> _Packed:
    data = files(__package__).joinpath("catalogue_data", "packed.json").read_bytes()
    return msgspec.json.decode(data, type=_Packed)


@cache
def rows() -> tuple[CommandRow, ...]:
    """Every row of the catalogue, by group and in file order (about 380)."""
    return tuple(_packed().commands)


@cache
def commands() -> Mapping[str, CommandRow]:
    """The executable commands by name, aliases included; operands and operators are left out (see ``operands``)."""
    table: dict[str, CommandRow] = {}
    for row in rows():
        if row.kind in ("operator", "operand") or row.name.startswith("<"):
            continue
        for name in (row.name, *row.aliases):
            table[name] = row
    return MappingProxyType(table)


@cache
def operands() -> Mapping[str, CommandRow]:
    """The data-assignment operands (PE, AS, IN ...) by name."""
    return MappingProxyType({row.name: row for row in rows() if row.kind == "operand"})


def lookup(name: str) -> CommandRow | None:
    """The row of a command or operand by its name (any case), or None."""
    upper = name.upper()
    return commands().get(upper) or operands().get(upper)


@cache
def other_product_names() -> Mapping[str, str]:
    """Names of other products -> the error text this unit answers."""
    groups = _packed().other_products.names
    table = {name: group.error for group in groups for name in group.commands}
    table.update(
        {row.name: "COMMAND NOT IMPLEMENTED" for row in rows() if not row.applies_to_oem6250 and row.name not in table}
    )
    return MappingProxyType(table)


@cache
def error_rows() -> tuple[ErrorRow, ...]:
    """The unit's error texts."""
    return tuple(_packed().error_messages.error)


@cache
def status_words() -> Mapping[str, StatusWordRow]:
    """The status words by operand name (AS, SS, ER, ...)."""
    return MappingProxyType({word.name: word for word in _packed().status_words.word})


@cache
def io_functions(kind: Literal["infnc", "outfnc"]) -> Mapping[str, IoFunctionRow]:
    """The function letters of INFNC or OUTFNC."""
    return MappingProxyType({row.letter: row for row in _packed().io_functions[kind]})

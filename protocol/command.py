"""One command as the host wrote it, read into its parts.

Reading a word follows one rule: the longest command name whose remainder is a legal field text for it wins; a word that
no command claims is the name of a stored program, and whether such a program exists only the unit knows.  So ``SETUP``
is a program although ``S`` is a command, and ``GOX1`` is ``GO`` with a mask.  Prefixes come in the order
``n_`` unit address, ``!`` immediate, axis digit or ``@``; ``!`` is taken after the axis digit too.

``parse_command`` is pure and remembers what it has read: hosts send the same few texts over and over.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from enum import Enum
from functools import lru_cache
from string import ascii_lowercase, ascii_uppercase

from protocol import catalogue
from protocol.catalogue import CommandRow
from protocol.errors import INCORRECT_DATA, INVALID_COMMAND, STRING_IS_TOO_LONG, UNDEFINED_LABEL, CommandError

MAX_PROGRAM_NAME = 6


class Direction(Enum):
    """A distance field that sets the direction only: ``D+``, ``D-``, ``D~`` (toggle)."""

    POSITIVE = "+"
    NEGATIVE = "-"
    TOGGLE = "~"


@dataclass(frozen=True, slots=True)
class VariableReference:
    """A field given as ``(VARn)`` or ``(VARBn)``."""

    kind: str
    number: int


FieldValue = Decimal | Direction | VariableReference | None


@dataclass(frozen=True, slots=True)
class Command:
    """A command that can be executed: ``row`` None means a program name (``name``).

    ``text`` is the normalised form without unit address and ``!`` (what a program stores, TPROG and TRACE show), with a
    blank in front of a name;
    ``argument`` the field text; ``values`` the comma fields of numeric commands; ``mask`` the digits of packed binary
    fields; ``substituted`` says that a variable stands for one of these; ``bit`` and ``bit_value`` the parts of ``.n``
    and ``.n-v``; ``spelled`` the name as written, which differs from ``name`` for an alias.
    """

    text: str
    name: str
    row: CommandRow | None
    argument: str = ""
    address: int | None = None
    immediate: bool = False
    all_axes: bool = False
    axis: int | None = None
    values: tuple[FieldValue, ...] = ()
    mask: str = ""
    variable: VariableReference | None = None
    bit: int | None = None
    bit_value: str = ""
    spelled: str = ""
    substituted: bool = False

    @property
    def is_query(self) -> bool:
        """A parameter command without any field asks for its setting."""
        return not self.argument or (self.bit is not None and not self.bit_value)


_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)"
_COUNT = r"\d{1,9}"
_FIELD = rf"(?:{_NUMBER}|\(VAR{_COUNT}\))?"
_NUMBERS = rf"{_FIELD}(?:,{_FIELD})*"
_DISTANCES = rf"(?:{_FIELD}|[+\-~])(?:,(?:{_FIELD}|[+\-~]))*"
_BIT = rf"\.{_COUNT}(?:-[01XE])?"
_MASK = rf"(?:[01X,_]*|{_BIT}|\(VARB{_COUNT}\))"
_OVERRIDE_MASK = rf"(?:[01XE_]*|{_BIT})"
_NAME = r"[A-Z][A-Z0-9]*"
_OPTIONAL_BIT = rf"(?:\.{_COUNT})?"
_INDEX = r"(?:\d+|\(VAR\d+\))"
_ANYTHING = r".*"

_SYNTAX_BY_NAME = {
    "D": _DISTANCES,
    "VAR": rf"{_INDEX}(?:=.*)?",
    "VARB": rf"{_INDEX}(?:=.*|\.{_COUNT}(?:-[01X])?)?",
    "VARS": rf"{_INDEX}(?:=.*)?",
    "INFNC": r"(?:\d+(?:-\d?[A-Z][A-Z0-9]*)?)?",
    "OUTFNC": r"(?:\d+(?:-\d?[A-Z])?)?",
    "INDUST": r"(?:\d+(?:-\d+[A-Z])?)?",
    "TRGFN": r"[AB][01X,]*",
    "TPCA": r"[AB]?",
    "TPCC": r"[AB]?",
    "TPCE": r"[AB]?",
    "INEN": _OVERRIDE_MASK,
    "OUTEN": _OVERRIDE_MASK,
    "WRITE": r'".*"?',
    "DWRITE": r'".*"?',
    "DATA": r"=.*",
    # Which comma parts two axes needs the parentheses counted; a pattern that did it would take exponential time.
    "GOWHEN": r",*\(.*\),*",
    "$": _NAME,
    "'": _ANYTHING,
    "#": r"\d*",
}

_SYNTAX_BY_TYPE = {
    "none": "",
    "real": _NUMBERS,
    "int": _NUMBERS,
    "binary": _MASK,
    "bit-pattern": _MASK,
    "name": rf"(?:\$?{_NAME})?",
    "expression": r"\(.*\)",
    "mixed": r"[0-9.,+\-]*",
    "string": _ANYTHING,
}

_BIT_REPORTS = frozenset({"TAS", "TASX", "TSS", "TER", "TUS", "TFS", "TIN", "TINO", "TOUT", "TLIM", "TSC"})
_LABEL_COMMANDS = ("$", "'", "#")
_MASK_TYPES = frozenset({"binary", "bit-pattern"})
_NUMBER_TYPES = frozenset({"real", "int"})

_UPPER = str.maketrans(ascii_lowercase, ascii_uppercase)
_PREFIX = re.compile(r"(?:(\d{1,9})_)?([!@\[\]]*)(\d{0,9})([!@\[\]]*)", re.ASCII)
_PROGRAM_WORD = re.compile(rf"\$?{_NAME}")


def _syntax_of(row: CommandRow) -> re.Pattern[str]:
    if row.name in _BIT_REPORTS:
        return re.compile(_OPTIONAL_BIT, re.ASCII)
    return re.compile(_SYNTAX_BY_NAME.get(row.name) or _SYNTAX_BY_TYPE[row.fields.type], re.ASCII)


@lru_cache(maxsize=1)
def _command_syntax() -> dict[str, tuple[CommandRow, re.Pattern[str]]]:
    return {name: (row, _syntax_of(row)) for name, row in catalogue.commands().items()}


@lru_cache(maxsize=1)
def _longest_name() -> int:
    names = [*_command_syntax(), *catalogue.other_product_names()]
    return max(len(name) for name in names)


def normalise(text: str) -> str:
    """Blanks out and letters up, except inside double quotes."""
    if '"' not in text:
        return _compact(text)
    parts = text.split('"')
    parts[0::2] = [_compact(part) for part in parts[0::2]]
    return '"'.join(parts)


def _compact(text: str) -> str:
    blankless = text.replace(" ", "").replace("\t", "")
    # Beyond ASCII upper() leaves the character set of the wire: one sharp s becomes two letters, a letter of commands.
    return blankless.upper() if blankless.isascii() else blankless.translate(_UPPER)


@lru_cache(maxsize=4096)
def parse_command(text: str) -> Command:
    """Read one command (no delimiter, no comment).

    Raises:
        CommandError: nothing the unit could execute or run as a program; the texts are the unit's own.
    """
    whole = normalise(text)
    prefix = _PREFIX.match(whole)
    assert prefix is not None  # the pattern matches the empty string
    marks = prefix[2] + prefix[4]
    word = whole[prefix.end() :]
    axis = int(prefix[3]) if prefix[3] else None
    found = _read_word(word)
    return _build(
        word,
        found,
        text=("@" if "@" in marks else "") + (prefix[3] or "") + word,
        address=int(prefix[1]) if prefix[1] else None,
        immediate="!" in marks,
        all_axes="@" in marks,
        axis=axis,
    )


def _read_word(word: str) -> tuple[str, CommandRow | None]:
    """The command name a word starts with and its row, or the word itself and None for a program name."""
    syntax = _command_syntax()
    if word[:1] in _LABEL_COMMANDS and word[:1]:
        return word[:1], syntax[word[:1]][0]
    malformed = False
    for length in range(min(len(word), _longest_name()), 0, -1):
        name = word[:length]
        entry = syntax.get(name)
        remainder = word[length:]
        if entry is None or not entry[0].applies_to_oem6250:
            _refuse_other_product(name, remainder)
            continue
        if entry[1].fullmatch(remainder):
            return name, entry[0]
        malformed = malformed or not remainder[:1].isalpha()
    if _PROGRAM_WORD.fullmatch(word):
        return word, None
    if malformed:
        raise CommandError(INCORRECT_DATA)
    raise CommandError(UNDEFINED_LABEL if word[:1].isalpha() and word.isascii() else INVALID_COMMAND)


def _refuse_other_product(name: str, remainder: str) -> None:
    """A name of another product with fields behind it (a plain word goes on to be a program name)."""
    error = catalogue.other_product_names().get(name)
    if error is not None and error != UNDEFINED_LABEL and not remainder[:1].isalpha():
        raise CommandError(error)


def _build(
    word: str,
    found: tuple[str, CommandRow | None],
    *,
    text: str,
    address: int | None,
    immediate: bool,
    all_axes: bool,
    axis: int | None,
) -> Command:
    spelled, row = found
    argument = word[len(spelled) :] if row is not None else ""
    field_type = row.fields.type if row is not None else "none"
    values: tuple[FieldValue, ...] = ()
    mask, variable, bit, bit_value = "", None, None, ""
    if argument.startswith(".") and (field_type in _MASK_TYPES or spelled in _BIT_REPORTS):
        number, _, bit_value = argument[1:].partition("-")
        bit = int(number)
    elif field_type in _MASK_TYPES and row is not None and row.name not in _SYNTAX_BY_NAME:
        mask, variable = _read_mask(argument)
    elif field_type in _NUMBER_TYPES and row is not None and (row.name == "D" or row.name not in _SYNTAX_BY_NAME):
        values = tuple(_read_field(field) for field in argument.split(",")) if argument else ()
    elif row is not None and row.name in ("INEN", "OUTEN"):
        mask = argument.replace("_", "")
    if field_type == "name" and argument and spelled not in _LABEL_COMMANDS:
        text = f"{text.removesuffix(argument)} {argument}"
    return Command(
        text=text,
        name=row.name if row is not None else spelled,
        row=row,
        argument=argument,
        address=address,
        immediate=immediate,
        all_axes=all_axes,
        axis=axis,
        values=values,
        mask=mask,
        variable=variable,
        bit=bit,
        bit_value=bit_value,
        spelled=spelled,
        substituted=variable is not None or any(isinstance(value, VariableReference) for value in values),
    )


def _read_mask(argument: str) -> tuple[str, VariableReference | None]:
    if argument.startswith("("):
        return "", VariableReference("VARB", int(argument[5:-1]))
    return argument.replace(",", "").replace("_", ""), None


def _read_field(field: str) -> FieldValue:
    if not field:
        return None
    if field in ("+", "-", "~"):
        return Direction(field)
    if field.startswith("("):
        return VariableReference("VAR", int(field[4:-1]))
    return Decimal(field)


def addressed_unit(text: str) -> int | None:
    """The unit address in front of a command text, readable or not; None when it has none."""
    prefix = _PREFIX.match(normalise(text))
    return int(prefix[1]) if prefix is not None and prefix[1] else None


def is_immediate_text(text: str) -> bool:
    """Whether ``!`` is among the prefixes of a command text, readable or not."""
    prefix = _PREFIX.match(normalise(text))
    return prefix is not None and "!" in prefix[2] + prefix[4]


def check_program_name(name: str) -> str:
    """A name for DEF or ``$``: one to six characters, first a letter, not a command.

    Raises:
        CommandError: STRING IS TOO LONG, INCORRECT DATA; the caller checks for STRING IS A COMMAND.
    """
    if not re.fullmatch(_NAME, name):
        raise CommandError(INCORRECT_DATA)
    if len(name) > MAX_PROGRAM_NAME:
        raise CommandError(STRING_IS_TOO_LONG)
    return name


def is_command_name(name: str) -> bool:
    """Whether a word is the exact name of a command or operand and so cannot name a program."""
    return name in catalogue.commands() or name in catalogue.operands()

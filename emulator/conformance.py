"""The conformance table: what of the language this unit does, how that is known, and which transcripts show it.

Nothing in the table is written by hand but the reasons for what is absent.  Whether a command is implemented is asked
of the dispatcher, whether an operator or operand is, of a unit to which an example is sent; which transcripts exercise
a row is read from the transcripts.  So the table cannot promise what the code does not do.

    oem6250 commands --table
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Literal

from protocol import catalogue
from protocol.catalogue import CommandRow
from protocol.command import Command, parse_command
from protocol.errors import CommandError

State = Literal["implemented", "stored", "absent"]
"""``stored``: set and reported like the unit's, without the effect that needs a part not built yet."""

TRANSCRIPTS: Final = Path(__file__).parents[1] / "tests" / "transcripts"
"""Where the transcripts are in a source tree; an installed package has none."""

_OTHER_PRODUCT: Final = "not a command of the OEM6250; COMMAND NOT IMPLEMENTED is what the unit itself answers"

ABSENT_ROWS: Final[Mapping[str, str]] = {
    "TRANS": "translation mode needs the computer bus of other products; only its default is accepted",
}
"""Absent rows, each with its reason."""

_LINE: Final = "acts with a second port"

STORED_ROWS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("LOCK", "DRPCHK"), _LINE),
    **dict.fromkeys(("COMEXK", "FOLK"), "stores only: its existence is not confirmed"),
    "TIMINT": "its alarm goes to the computer bus of other products",
}
"""Settings that only store and report, each with the reason."""

_REFUSED: Final = re.compile(rb"COMMAND NOT IMPLEMENTED|UNDEFINED LABEL|INVALID COMMAND|INCORRECT DATA")

EXAMPLES: Final[Mapping[str, str]] = {
    "!": "!1TPE",
    "@": "@V1",
    "<a>": "1TPE",
    "<a_>": "0_1TPE",
    ";": "1TPE ; comment",
    ":": "V1:V1",
    ".": "1TAS.1",
    '"': 'VARS1="A"',
    "\\": 'VARS1="A\\13"',
    "[": "[1TPE",
    "]": "]1TPE",
    "=": "VAR1=1",
    "( )": "VAR1=(1)",
    "AND": "WAIT(1AS.1=b0 AND 1AS.1=b0)",
    "OR": "WAIT(1AS.1=b0 OR 1AS.1=b0)",
    "NOT": "WAIT(NOT 1AS.1=b1)",
    "~": "VARB1=~(b1)",
    "<<": "VARB1=b1<<b1",
    ">>": "VARB1=b1>>b1",
    "SIN": "VAR1=SIN(1)",
    "COS": "VAR1=COS(1)",
    "TAN": "VAR1=TAN(1)",
    "ATAN": "VAR1=ATAN(1)",
    "SQRT": "VAR1=SQRT(1)",
    "PI": "VAR1=PI",
    "VCVT": "VARB1=VCVT(VAR1)",
    "DAT": "DATSIZ1,10:VAR1=DAT1",
}
"""A command that uses each operator; relations, the other arithmetic and most operands follow a pattern."""

_RELATIONS: Final = (">", ">=", "<", "<=", "<>")
_WORD_OPERANDS: Final = frozenset({"AS", "ASX", "SS", "ER", "US", "FS", "IN", "INO", "LIM", "OUT", "MOV", "SC"})
_INDEXED_OPERANDS: Final = frozenset({"TW", "READ"})
_UNIT_OPERANDS: Final = frozenset({"TIM", "DKEY", "DREAD", "DREADF", "SEG", "DPTR"})


@dataclass(frozen=True, slots=True)
class Conformance:
    """One row of the table."""

    row: CommandRow
    state: State
    reason: str
    transcripts: tuple[str, ...]


def table(transcripts: Path = TRANSCRIPTS) -> list[Conformance]:
    """Every row of the catalogue, in its order."""
    shown = exercised(transcripts)
    return [Conformance(row, *_state(row), tuple(sorted(shown.get(row.name, ())))) for row in catalogue.rows()]


def find(name: str, transcripts: Path = TRANSCRIPTS) -> Conformance | None:
    """The row of one command or operand (any case, aliases too), or None."""
    wanted = catalogue.lookup(name)
    title = name.upper() if wanted is None else wanted.name
    return next((each for each in table(transcripts) if each.row.name == title), None)


# What is implemented.


def _state(row: CommandRow) -> tuple[State, str]:
    if not row.applies_to_oem6250:
        return "absent", _OTHER_PRODUCT
    in_expressions = row.kind in ("operator", "operand")
    there = example_of(row) not in refused_examples() if in_expressions else _carried_out(row)
    if not there:
        return "absent", ABSENT_ROWS.get(row.name, "")
    if row.name in STORED_ROWS:
        return "stored", STORED_ROWS[row.name]
    return "implemented", ""


def _carried_out(row: CommandRow) -> bool:
    from emulator.controller import dispatch

    if row.name == "<name>":
        return True
    if row.name in dispatch.handled_names():
        return True
    plain = row.kind == "setting" and row.reply in dispatch.SETTING_REPLIES
    return plain and row.name not in dispatch.SWITCHES_WITHOUT_FUNCTION


def example_of(row: CommandRow) -> str:
    """A command that uses an operator or operand."""
    name = row.name
    if name in EXAMPLES:
        return EXAMPLES[name]
    if name in _RELATIONS:
        return f"WAIT(1PC{name}0 OR 1AS.1=b0)"
    if row.kind == "operator":
        return f"VARB1=b1{name}b1" if name in "&|^" else f"VAR1=1{name}1"
    return _operand_example(name)


def _operand_example(name: str) -> str:
    if name in _INDEXED_OPERANDS:
        return f"VAR1={name}1"
    prefix = "" if name in _UNIT_OPERANDS else "1"
    if name in _WORD_OPERANDS:
        axis = "1" if name in ("AS", "ASX", "FS") else ""
        return f"VARB1={axis}{name}"
    return f"VAR1={prefix}{name}"


@cache
def refused_examples() -> frozenset[str]:
    """The examples that a default unit does not know."""
    from emulator.emulator import Emulator

    rows = [row for row in catalogue.rows() if row.kind in ("operator", "operand") and row.applies_to_oem6250]
    unit = Emulator().unit(0)
    unit.send(b"ECHO0\r")
    refused = set()
    for text in map(example_of, rows):
        unit.send(b"!K\r")
        unit.read()
        unit.send(text.encode() + b"\r")
        if _REFUSED.search(unit.read()):
            refused.add(text)
    return frozenset(refused)


# What the transcripts exercise.


def exercised(folder: Path = TRANSCRIPTS) -> Mapping[str, set[str]]:
    """Row name -> the transcripts that use it; empty where there are no transcripts."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for path in sorted(folder.glob("*.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("> "):
                for name in names_in(line[2:]):
                    found[name].add(path.stem)
    return found


_SENT: Final = re.compile(r"\\r|\\n|:(?=[^\"]*(?:\"[^\"]*\"[^\"]*)*$)")
_QUOTED: Final = re.compile(r'"[^"]*"?')
_WORD: Final = re.compile(r"(?<![A-Z])[A-Z]+")
_SIGNS: Final = re.compile(r"<<|>>|<=|>=|<>|[=<>+\-*/&|^~]")
_PREFIXED: Final = re.compile(r"(\d+_)?([!@\[\]]*)(\d*)([!@\[\]]*)")


def names_in(line: str) -> Iterator[str]:
    """The rows that one ``>`` line of a transcript uses."""
    if _SENT.search(line) and ":" in line:
        yield ":"
    if ";" in line:
        yield ";"
    line = line.partition(";")[0]
    for text in _SENT.split(line):
        yield from _names_in_command(text.strip())


def _names_in_command(text: str) -> Iterator[str]:
    try:
        command = parse_command(text)
    except CommandError:
        yield from _names_at_head(text)
        return
    yield from _prefixes(text)
    yield _name_meant(command)
    yield from _names_in_argument(command.row, _after_name(text, command.spelled or command.name))


def _name_meant(command: Command) -> str:
    """The row of a command; of the names of other products too, which the unit takes for program names."""
    if command.row is not None:
        return command.row.name
    word = re.match(r"[A-Z]*", command.name)
    return word[0] if word and word[0] in _FOREIGN else "<name>"


def _after_name(text: str, name: str) -> str:
    """What follows the name, as typed."""
    found = _PREFIXED.match(text)
    assert found is not None
    typed = r"\s*".join(map(re.escape, name))
    return re.sub(rf"^\s*{typed}", "", text[found.end() :], count=1, flags=re.IGNORECASE)


def _names_at_head(text: str) -> Iterator[str]:
    """The command meant by a text that cannot be read: refusals are behaviour too."""
    head = re.match(r"[!@0-9_]*([A-Za-z]+)", text)
    row = catalogue.lookup(head[1]) if head else None
    if row is not None:
        yield row.name


def _prefixes(text: str) -> Iterator[str]:
    found = _PREFIXED.match(text)
    assert found is not None
    if found[1]:
        yield "<a_>"
    yield from found[2] + found[4]
    if found[3]:
        yield "<a>"


def _names_in_argument(row: CommandRow | None, argument: str) -> Iterator[str]:
    if '"' in argument:
        yield '"'
    if "\\\\" in argument:
        yield "\\"
    plain = _QUOTED.sub("", argument).upper()
    if re.match(r"\.\d|.*[A-Z]\.\d", plain):
        yield "."
    if row is None or row.name not in _WITH_EXPRESSIONS:
        return
    if "(" in plain:
        yield "( )"
    yield from _SIGNS.findall(plain)
    words = set(_WORD.findall(plain))
    yield from words & _EXPRESSION_WORDS


_WITH_EXPRESSIONS: Final = frozenset(
    {"VAR", "VARB", "VARS", "WAIT", "IF", "WHILE", "UNTIL", "WRITE", "GOWHEN", "NIF", "NWHILE"}
)
_FOREIGN: Final = frozenset(row.name for row in catalogue.rows() if not row.applies_to_oem6250)
_EXPRESSION_WORDS: Final = frozenset(
    row.name for row in catalogue.rows() if row.kind in ("operator", "operand") and row.name.isalpha()
)


# For people.

SHOWN: Final = 4
"""Transcripts named in a line of the table."""


def render(rows: Iterable[Conformance]) -> str:
    """The table as Markdown."""
    listed = list(rows)
    count = Counter(each.state for each in listed)
    lines = [
        "# Conformance",
        "",
        "Made by `oem6250 commands --table > docs/conformance.md`; do not edit.",
        "",
        f"{len(listed)} rows of the command catalogue: {count['implemented']} implemented, {count['stored']} stored "
        f"and reported without effect, {count['absent']} answered as absent.",
        "",
        "| command | what | state | source | confidence | transcripts |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    return "\n".join([*lines, *map(_line, listed)]) + "\n"


def _line(each: Conformance) -> str:
    row = each.row
    state = each.state if not each.reason else f"{each.state}: {each.reason}"
    more = len(each.transcripts) - SHOWN
    shown = ", ".join(each.transcripts[:SHOWN]) + (f" and {more} more" if more > 0 else "")
    cells = (f"`{row.name}`", row.title, state, row.source, row.confidence, shown)
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |"


def overview(rows: Iterable[Conformance]) -> str:
    """One line a row."""
    return "".join(f"{each.row.name:<8} {each.state:<12} {each.row.title}\n" for each in rows)


def describe(each: Conformance) -> str:
    """One row in full: help, state, transcripts."""
    from protocol.help import describe as help_text

    lines = [help_text(each.row.name) or f"{each.row.name}  {each.row.title}", f"  state    {each.state}"]
    if each.reason:
        lines.append(f"           {each.reason}")
    lines += [f"  shown in tests/transcripts/{name}.txt" for name in each.transcripts]
    return "\n".join(lines)

"""Completion of what is typed, from the catalogue: commands after any prefix and delimiter, operands in expressions.

`1_!2V` is unit, `!`, axis and the beginning of a name; after `:` the next command begins; within quotes and after `;`
there is nothing to complete.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Final, NamedTuple

from clients.terminal.decoding import summary
from protocol.catalogue import CommandRow, lookup, operands
from protocol.help import matching

_COMMAND = re.compile(r"\s*(?:\d{1,2}_)?!?@?\d{0,2}\s*(?P<name>[A-Za-z]*)")
_OPERAND = re.compile(r"[=(<>+\-*/,&|^~\s]\d?(?P<name>[A-Za-z]+)$")
_LONGEST_NAME: Final = 8
_PROGRAM_COMMANDS = frozenset(
    ("RUN", "GOSUB", "GOTO", "JUMP", "DEL", "TPROG", "DEF", "STARTP", "ERRORP", "ONP", "PCOMP")
)


class Candidate(NamedTuple):
    """`text` in place of the last `replaces` characters; `title` and `syntax` to show beside it."""

    text: str
    replaces: int
    title: str
    syntax: str


def candidates(before_cursor: str, *, programs: Iterable[str] = (), asked: bool = False) -> list[Candidate]:
    """What may stand where the cursor is; an empty word is completed only where that was `asked` for (Tab).

    `programs`: names of stored programs, offered where one belongs.
    """
    text = _current(before_cursor)
    if text is None:
        return []
    match = _COMMAND.fullmatch(text)
    if match is not None:
        name = match["name"]
        if not name and not asked:
            return []
        names = [_candidate(row, name) for row in matching(name) if row.applies_to_oem6250]
        return names + (_program_names(programs, name) if name else [])
    head, _, rest = text.strip().lstrip("!").partition(" ")
    if head.upper() in _PROGRAM_COMMANDS:
        return _program_names(programs, rest.lstrip())
    operand = _OPERAND.search(text)
    if operand is None:
        return []
    typed = operand["name"]
    rows = [row for name, row in sorted(operands().items()) if name.startswith(typed.upper())]
    return [_candidate(row, typed) for row in rows if row.applies_to_oem6250]


def _candidate(row: CommandRow, typed: str) -> Candidate:
    return Candidate(row.name, len(typed), row.title, row.syntax)


def _program_names(programs: Iterable[str], typed: str) -> list[Candidate]:
    found = sorted(name for name in programs if name.startswith(typed.upper()))
    return [Candidate(name, len(typed), "stored program", "") for name in found]


def _current(before_cursor: str) -> str | None:
    """The command under way; None within quotes and comments. A colon ends a command within quotes, too."""
    command = before_cursor.rpartition(":")[2]
    return None if ";" in before_cursor or command.count('"') % 2 else command


def command_under(before_cursor: str) -> str | None:
    """The name of the command that is being typed, once it is one: `V` of `1V5`, but none of `VA`."""
    text = _current(before_cursor) or ""
    match = _COMMAND.match(text)
    letters = match["name"] if match else ""
    if match is not None and match.end() == len(text):
        row = lookup(letters)
        return None if row is None else row.name
    lengths = range(min(len(letters), _LONGEST_NAME), 0, -1)
    return next((row.name for length in lengths if (row := lookup(letters[:length]))), None)


def syntax_under(before_cursor: str) -> str:
    """One line about the command that is being typed, for the toolbar; "" if there is none yet."""
    name = command_under(before_cursor)
    return (summary(name) or "") if name else ""


class OwnCommand(NamedTuple):
    """One of the terminal's own commands, which begin with a slash."""

    name: str
    syntax: str
    sentence: str
    takes_file: bool = False


def own_candidates(
    before_cursor: str, own: Iterable[OwnCommand], files: Callable[[str], Iterable[str]]
) -> list[Candidate]:
    """Completion of a line that begins with a slash: its name, then `files` (those that begin so) if it takes one."""
    name, blank, rest = before_cursor.partition(" ")
    if not blank:
        fitting = [each for each in own if each.name.startswith(name)]
        return [Candidate(each.name, len(name), each.sentence, each.syntax) for each in fitting]
    if any(each.name == name and each.takes_file for each in own) and " " not in rest:
        return [Candidate(file, len(rest), "", "") for file in files(rest)]
    if name == "/help":
        return candidates(rest)
    return []

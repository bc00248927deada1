"""Program files: text as a person keeps it, with DEF and END and commands around them, and back.

A file may hold any number of programs. What stands outside DEF ... END is sent as it is, in its place; a DEL of a
program the file defines is left out, because storing a program replaces it anyway.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePath

from clients.programs import commands_of
from protocol.command import check_program_name
from protocol.errors import CommandError

_DEF = re.compile(r"\s*DEF\s+(\w+)\s*", re.IGNORECASE)
_END = re.compile(r"\s*END\s*", re.IGNORECASE)


class ProgramFileError(ValueError):
    """A program file cannot be used; the text says which line and why."""


@dataclass(frozen=True)
class Program:
    """One program of a file: its name and its commands, DEF and END left out."""

    name: str
    commands: tuple[str, ...]


@dataclass(frozen=True)
class Outside:
    """Commands between programs."""

    commands: tuple[str, ...]


def read_programs(text: str, *, name: str) -> list[Program | Outside]:
    """What a file holds, in its order; without any DEF the whole of it is one program called `name`.

    Raises:
        ProgramFileError: DEF without END, END without DEF, DEF within DEF, or a name that cannot be one.
    """
    numbered = [(number, command) for number, line in enumerate(text.splitlines(), 1) for command in _commands(line)]
    if not any(_DEF.fullmatch(command) or _END.fullmatch(command) for _, command in numbered):
        return [Program(_checked(name, 1), tuple(command for _, command in numbered))]
    return _split(numbered)


def _commands(line: str) -> list[str]:
    """The commands of a line, DEF and END included, which commands_of would take away from a whole file."""
    return ["END"] if _END.fullmatch(line) else ["DEF " + found[1]] if (found := _DEF.fullmatch(line)) else _inner(line)


def _inner(line: str) -> list[str]:
    return commands_of(["DEF X", line, "END"])


def _split(numbered: list[tuple[int, str]]) -> list[Program | Outside]:
    found: list[Program | Outside] = []
    name, began, kept = "", 0, list[str]()
    for number, command in numbered:
        if match := _DEF.fullmatch(command):
            if name:
                raise ProgramFileError(f"line {number}: DEF within the definition of {name} (line {began})")
            _leave(found, kept)
            name, began, kept = _checked(match[1], number), number, []
        elif _END.fullmatch(command):
            if not name:
                raise ProgramFileError(f"line {number}: END without DEF")
            found.append(Program(name, tuple(kept)))
            name, kept = "", []
        else:
            kept.append(command)
    if name:
        raise ProgramFileError(f"line {began}: DEF {name} without END")
    _leave(found, kept)
    names = {part.name for part in found if isinstance(part, Program)}
    return [part for part in (_without_deletions(part, names) for part in found) if part.commands or _is_program(part)]


def _leave(found: list[Program | Outside], kept: list[str]) -> None:
    if kept:
        found.append(Outside(tuple(kept)))


def _without_deletions(part: Program | Outside, names: set[str]) -> Program | Outside:
    if isinstance(part, Program):
        return part
    deletions = {f"DEL{name}" for name in names}
    return Outside(tuple(each for each in part.commands if each.replace(" ", "").upper() not in deletions))


def _is_program(part: Program | Outside) -> bool:
    return isinstance(part, Program)


def _checked(name: str, number: int) -> str:
    try:
        return check_program_name(name.upper())
    except CommandError:
        raise ProgramFileError(
            f"line {number}: {name!r} is no program name (1 to 6 letters and digits, a letter first)"
        ) from None


def name_from_path(path: str) -> str:
    """The program name a file without DEF has: `cycle.prg` is CYCLE."""
    return PurePath(path).stem.upper()


def format_programs(programs: Mapping[str, Iterable[str]]) -> str:
    """A program file: DEL, DEF, the commands, END for each."""
    blocks = ["\n".join([f"DEL {name}", f"DEF {name}", *commands, "END"]) for name, commands in programs.items()]
    return "\n\n".join(blocks) + "\n"

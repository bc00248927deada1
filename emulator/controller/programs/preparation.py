"""Programs made ready to run: every command read once, every loop and IF joined to its end.

A stored program keeps its commands as text, because that is what TPROG prints and what survives power-off.  Before it
runs the text is read into instructions; flow commands get the index where control goes next, so that a loop costs no
search.  Commands whose partner is missing keep ``NO_PARTNER``; what happens then is decided when they are reached.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from emulator.controller.settings import Quantities
from protocol.command import Command, parse_command
from protocol.condition import Condition, parse_condition
from protocol.errors import CommandError

OPENERS = {"IF": "NIF", "WHILE": "NWHILE", "REPEAT": "UNTIL", "L": "LN"}
"""The flow commands that open a level, and what closes each."""

CLOSERS = {close: opener for opener, close in OPENERS.items()}

FLOW_COMMANDS = frozenset({*OPENERS, *CLOSERS, "ELSE", "LX", "GOTO", "GOSUB", "JUMP", "BREAK", "$"})
"""Commands that move the place of execution rather than do something."""

CONDITIONAL = frozenset({"IF", "WHILE", "UNTIL", "WAIT"})
"""Commands whose field is a condition in parentheses."""

NO_PARTNER = -1


@dataclass(slots=True)
class Instruction:
    """One command of a program.

    ``flow`` is the name of a flow command, else empty.  ``target`` is where an IF or a WHILE goes when its condition
    does not hold and an ELSE at the end of the true branch; the closing commands keep their opener there.
    ``quantities`` are the values of a scaled setting as they were when the command was stored.
    """

    command: Command
    flow: str
    condition: Condition | None = None
    target: int = NO_PARTNER
    quantities: Quantities | None = None


Code = tuple[Instruction, ...]


@dataclass(frozen=True, slots=True)
class Prepared:
    """A program ready to run: its instructions and where its labels are."""

    code: Code
    labels: dict[str, int]


def prepare(texts: Iterable[str], quantities: Mapping[int, Quantities] = MappingProxyType({})) -> Prepared:
    """Read the commands of a program, one text each, and join what belongs together.

    ``quantities`` holds the values of scaled settings by line.
    """
    code = tuple(_instruction(parse_command(text)) for text in texts)
    for line, values in quantities.items():
        code[line].quantities = values
    _join(code)
    labels = {entry.command.argument: index for index, entry in enumerate(code) if entry.flow == "$"}
    return Prepared(code, labels)


def condition_of(command: Command) -> Condition | None:
    """The condition of IF, WHILE, UNTIL or WAIT; None for other commands.

    Raises:
        CommandError: what stands between the parentheses is no condition.
    """
    return parse_condition(command.argument[1:-1]) if command.name in CONDITIONAL else None


def _instruction(command: Command) -> Instruction:
    if command.name not in FLOW_COMMANDS:
        return Instruction(command, "")
    try:
        condition = condition_of(command)
    except CommandError:
        condition = None
    return Instruction(command, command.name, condition)


def _join(code: Code) -> None:
    """Give every opener, ELSE and closer its target; openers that are never closed lead to the end of the program."""
    open_at: list[int] = []
    for index, instruction in enumerate(code):
        name = instruction.flow
        if name in OPENERS:
            instruction.target = len(code)
            open_at.append(index)
        elif name == "ELSE" and open_at and code[open_at[-1]].flow == "IF":
            _join_else(code, open_at[-1], index)
        elif name in CLOSERS and open_at and code[open_at[-1]].flow == CLOSERS[name]:
            _join_close(code, open_at.pop(), index)


def _join_else(code: Code, opener: int, index: int) -> None:
    code[opener].target = index + 1
    code[index].target = len(code)


def _join_close(code: Code, opener: int, index: int) -> None:
    code[index].target = opener
    false_branch = code[opener].target
    if false_branch == len(code):
        code[opener].target = index if code[index].flow == "NIF" else index + 1
    elif code[index].flow == "NIF":
        code[false_branch - 1].target = index

"""Sessions in the 6000 language as a terminal shows them, played to a fresh unit.

    > 1TPE              a line typed behind the prompt `>`; the unit must have shown just that prompt
    *1TPE+0             what the unit says before its next prompt; blank lines do not count, `...` is anything
    ? V1                typed behind the prompt of an error
    - GO1               typed behind the prompt within a definition
      !S1               typed (behind two blanks) while no prompt had come; half a second after the line before

A block without any such line is a list of commands, a program or a set-up, and is sent line by line; the unit must
refuse none of it.
"""

from __future__ import annotations

import doctest
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import zip_longest

from emulator import Emulator, Machine

PATIENCE_S = 120.0
PAUSE_S = 0.5
_TYPED = re.compile(r"([>?-]| ) (.*)")


class WrongScreen(AssertionError):
    """The unit shows something else."""


@dataclass
class Exchange:
    """A typed line with the prompt it stands behind (a blank: none) and what the unit then shows."""

    prompt: str
    typed: str
    shown: list[str] = field(default_factory=list)


def exchanges(text: str) -> list[Exchange]:
    """The session in a block; a plain list of commands expects nothing but prompts."""
    lines = text.splitlines()
    if not any(_TYPED.fullmatch(line) for line in lines):
        return [Exchange("", line) for line in lines if line.strip()]
    return list(_exchanges(lines))


def _exchanges(lines: list[str]) -> Iterator[Exchange]:
    current: Exchange | None = None
    for line in lines:
        if typed := _TYPED.fullmatch(line):
            if current is not None:
                yield current
            current = Exchange(typed[1], typed[2])
        elif current is not None and line.strip():
            current.shown.append(line.rstrip())
    if current is not None:
        yield current


def play(text: str, machine: str = "") -> None:
    """Play a session; WrongScreen where the unit shows something else."""
    terminal = _Terminal(machine)
    session = exchanges(text)
    for exchange, following in zip_longest(session, session[1:]):
        terminal.type_in(exchange, waits=following is None or following.prompt != " ")


class _Terminal:
    def __init__(self, machine: str) -> None:
        self._emulator = Emulator(Machine.parse(machine, name="block"))
        self._unit = self._emulator.unit()
        self._unit.send(b"ECHO0\r")
        self._emulator.advance(0.1)
        self._unit.read()
        self._prompt = ">"

    def type_in(self, exchange: Exchange, *, waits: bool) -> None:
        """Type a line; wait for the prompt unless the next line is typed without one."""
        if exchange.prompt not in ("", " ", self._prompt):
            raise WrongScreen(f"{exchange.typed!r} stands behind {exchange.prompt!r}; the prompt was {self._prompt!r}")
        self._unit.send(exchange.typed.encode("latin-1") + b"\r")
        shown = self._answer(PATIENCE_S if waits else PAUSE_S)
        if exchange.prompt:
            self._compare(exchange, shown)
        elif self._prompt == "?":
            raise WrongScreen(f"{exchange.typed!r} is refused: {' '.join(shown)}")

    def _answer(self, patience_s: float) -> list[str]:
        """The lines until the next prompt, or what has come by then."""
        data = self._unit.read()
        for _ in range(round(patience_s / PAUSE_S)):
            if re.search(rb"\r\n[>?-] $", data):
                break
            self._emulator.advance(PAUSE_S)
            data += self._unit.read()
        text = data.decode("latin-1")
        prompts = re.findall(r"(?:^|\n)([>?-]) ", text)
        self._prompt = prompts[-1] if prompts else " "
        lines = [re.sub(r"^([>?-] )+", "", line).rstrip() for line in re.split(r"[\r\n]+", text)]
        return [line for line in lines if line]

    def _compare(self, exchange: Exchange, shown: list[str]) -> None:
        wanted, got = "\n".join(exchange.shown) + "\n", "\n".join(shown) + "\n"
        if not doctest.OutputChecker().check_output(wanted, got, doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE):
            raise WrongScreen(f"after {exchange.typed!r} the block shows\n{wanted}the unit\n{got}")

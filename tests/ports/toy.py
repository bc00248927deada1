"""A controller simple enough to test ports with: it answers each line, and can be busy, talk by itself and fail.

`python -m tests.ports.toy serve ...` is the whole server around it.

| line        | does                                                                |
|-------------|---------------------------------------------------------------------|
| anything    | replies `*` + the line + CR LF `> `                                 |
| `WAIT n`    | busy for n virtual ms, then says `*DONE` to everybody               |
| `HOLD n`    | busy for n virtual ms; the reply to the sender comes at the end     |
| `FILL n`    | replies with n bytes                                                |
| `TIME`      | replies with the virtual time in ns                                 |
| `SEEN`      | replies with the number of lines executed before                    |
| `BOOM`      | raises                                                              |
"""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from emulator.cli import main
from emulator.options import ServeOptions

MAX_LINE = 100
TERMINATOR = re.compile(rb"[\r\n]")


class Output(NamedTuple):
    """What the engine thread takes from a controller."""

    at_ns: int
    data: bytes
    channel: int | None


class Boom(Exception):
    """What the toy raises when told to."""


class ToyController:
    """One line in, one reply out, in virtual time."""

    def __init__(self) -> None:
        self.now_ns = 0
        self.executed = 0
        self.detached: list[int] = []
        self.received: list[tuple[int, bytes]] = []
        self.fail_on_advance = False
        self._half: dict[int, bytes] = defaultdict(bytes)
        self._later: list[Output] = []
        self._output: list[Output] = []

    @property
    def busy(self) -> bool:
        return bool(self._later)

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        assert at_ns >= self.now_ns, "time must not run backwards"
        self.advance(at_ns)
        self.received.append((at_ns, data[:20]))
        del self.received[:-100]
        *lines, half = TERMINATOR.split(self._half[channel] + data)
        self._half[channel] = half[:MAX_LINE]
        for line in lines:
            if line:
                self._execute(line, channel)

    def advance(self, until_ns: int) -> None:
        if self.fail_on_advance:
            raise Boom
        self._output += sorted(output for output in self._later if output.at_ns <= until_ns)
        self._later = [output for output in self._later if output.at_ns > until_ns]
        self.now_ns = max(self.now_ns, until_ns)

    def take_output(self) -> list[Output]:
        output, self._output = self._output, []
        return output

    def input_full(self, channel: int) -> bool:
        return False

    def detach(self, channel: int) -> None:
        self.detached.append(channel)
        del self.detached[:-100]
        self._half.pop(channel, None)

    def _execute(self, line: bytes, channel: int) -> None:
        word, _, argument = line.partition(b" ")
        if word == b"BOOM":
            raise Boom
        if word == b"WAIT":
            self._later.append(Output(self.now_ns + int(argument) * 1_000_000, b"*DONE\r\n> ", None))
        elif word == b"HOLD":
            self._later.append(Output(self.now_ns + int(argument) * 1_000_000, b"*HELD\r\n> ", channel))
        else:
            self._reply(self._text(word, argument, line), channel)
        self.executed += 1

    def _text(self, word: bytes, argument: bytes, line: bytes) -> bytes:
        if word == b"FILL":
            return b"x" * int(argument)
        if word == b"TIME":
            return str(self.now_ns).encode()
        return str(self.executed).encode() if word == b"SEEN" else line

    def _reply(self, text: bytes, channel: int) -> None:
        self._output.append(Output(self.now_ns, b"*" + text + b"\r\n> ", channel))


def build_toy(options: ServeOptions) -> Sequence[ToyController]:
    return [ToyController()]


if __name__ == "__main__":
    sys.exit(main(build=build_toy))

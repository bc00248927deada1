"""Lines for tests, all on a time of their own: an emulated unit, a small unit of another make, any bytes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from emulator.emulator import Emulator

STEP_S = 0.002


class EmulatedLine:
    """A unit of an emulator in this process; waiting lets virtual time pass."""

    name = "virtual"

    def __init__(self, emulator: Emulator | None = None) -> None:
        self.emulator = emulator or Emulator()
        self.unit = self.emulator.unit()
        self.sent: list[bytes] = []
        self.closed = False

    def write(self, data: bytes) -> None:
        self.sent.append(data)
        self.unit.send(data)

    def clock(self) -> float:
        return self.emulator.time_s

    def read(self, timeout_s: float) -> bytes:
        end = self.clock() + timeout_s
        while not (data := self.unit.read()) and self.clock() < end:
            self.emulator.advance(max(1e-6, min(STEP_S, end - self.clock())))
        return data

    def close(self) -> None:
        self.closed = True


Answers = Iterable[tuple[float, bytes]]
"""Bytes and how long after the host's line they come."""


class ScriptedLine:
    """A peer that is a function from what the host sends to what comes back, and when."""

    name = "scripted"

    def __init__(self, answer: Callable[[bytes], Answers], greeting: bytes = b"") -> None:
        self._answer = answer
        self._now = 0.0
        self._coming: list[tuple[float, bytes]] = [(0.0, greeting)] if greeting else []
        self.sent: list[bytes] = []
        self.reads = 0

    def write(self, data: bytes) -> None:
        self.sent.append(data)
        self._coming += [(self._now + after_s, part) for after_s, part in self._answer(data)]
        self._coming.sort(key=lambda each: each[0])

    def clock(self) -> float:
        return self._now

    def read(self, timeout_s: float) -> bytes:
        self.reads += 1
        end = self._now + max(0.0, timeout_s)
        if not self._coming or self._coming[0][0] > end:
            self._now = end
            return b""
        self._now = max(self._now, self._coming[0][0])
        arrived = [part for at, part in self._coming if at <= self._now]
        del self._coming[: len(arrived)]
        return b"".join(arrived)

    def close(self) -> None:
        pass


@dataclass
class FamilyUnit:
    """A unit of the family as host programs describe it, written without this project's protocol package.

    `echo_end` is what the CR comes back as; `lead` what precedes an error message; `values` the replies by name.
    """

    level: int = 4
    echo: bool = True
    echo_end: bytes = b"\r\n"
    bot: bytes = b""
    eol: bytes = b"\r\n"
    eot: bytes = b"\r"
    good: bytes = b"\r\n> "
    bad: bytes = b"\r\n? "
    defining: bytes = b"\r\n- "
    lead: bytes = b"\r\n"
    values: dict[str, str] = field(default_factory=dict)
    latency_s: float = 0.004
    cut: int = 0
    in_definition: bool = False

    def line(self, greeting: bytes = b"") -> ScriptedLine:
        return ScriptedLine(self.answer, greeting)

    def answer(self, data: bytes) -> Answers:
        out = b"".join(self._one(text) for text in data.split(b"\r")[:-1])
        cut = self.cut or len(out) or 1
        return [(self.latency_s + 0.001 * n, out[n : n + cut]) for n in range(0, len(out), cut)]

    def _codes(self, data: bytes, count: int) -> str:
        return ",".join(map(str, [*data, 0, 0, 0, 0][:count]))

    def _value(self, name: str) -> str | None:
        framing = {
            "ECHO": str(int(self.echo)),
            "ERRLVL": str(self.level),
            "EOT": self._codes(self.eot, 3),
            "EOL": self._codes(self.eol, 3),
            "BOT": self._codes(self.bot, 3),
            "ERROK": self._codes(self.good, 4),
            "ERRBAD": self._codes(self.bad, 4),
            "ERRDEF": self._codes(self.defining, 4),
            "TSS": f"1001_11{int(self.in_definition)}0_" + "_".join(["0000"] * 6),
        }
        return self.values.get(name, framing.get(name))

    def _one(self, text: bytes) -> bytes:
        echo = text + self.echo_end if self.echo else b""
        word = text.lstrip(b"\x08").decode("ascii").upper()
        word = re.sub(r"^\d+_", "", word).removeprefix("!")
        prompt = self.defining if self.in_definition else self.good
        if (value := self._value(word)) is not None:
            return echo + self._reply(word, value) + (prompt if self.level >= 3 else b"")
        if word.startswith("BAD"):
            message = self.lead + b"*UNDEFINED LABEL" + self.eot if self.level == 4 else b""
            return echo + message + (self.bad if self.level >= 2 else b"")
        return echo + (prompt if self.level >= 3 else b"")

    def _reply(self, word: str, value: str) -> bytes:
        name = "" if word.endswith(".1") or self.level < 2 else word
        star = "*" if self.level >= 1 else ""
        return self.bot + f"{star}{name}{value}".encode() + self.eot

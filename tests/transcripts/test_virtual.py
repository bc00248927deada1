"""Every transcript against the whole unit in virtual time: bytes, order and the moment they leave it."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator import Emulator, Machine
from tests.transcripts.format import Expect, Match, Pass, Send, Step, Timing, Transcript, load, parse

HERE = Path(__file__).parent
FILES = sorted(HERE.glob("*.txt"))

AT_ONCE_S = 0.02
"""How long an answer may take that the transcript gives no time for: some system updates."""

SLICE_S = 0.001
"""Virtual time moves on by this while something is awaited; what left the unit carries its own exact time."""


class Mismatch(AssertionError):
    """What the unit did is not what the transcript says; begins with file and line."""


class VirtualSession:
    """One transcript being played to one unit."""

    def __init__(self, transcript: Transcript) -> None:
        self._transcript = transcript
        self._emulator = Emulator(Machine.parse(transcript.machine, name=transcript.path.name))
        self._unit = self._emulator.unit(0)
        self._pending = b""
        self._times_ns: list[int] = []
        self._now_s = 0.0
        self._sent_s = 0.0
        self._pass(0.0)
        if not transcript.sign_on_shown:
            self._take(len(self._pending))

    def run(self) -> None:
        """Play every step; Mismatch where the unit does something else."""
        for step in self._transcript.steps:
            self._play(step)
        self._pass(AT_ONCE_S)
        self._refuse_surplus(self._transcript.steps[-1], "at the end")

    def _play(self, step: Step) -> None:
        match step:
            case Send():
                self._send(step)
            case Pass():
                self._pass(step.seconds)
            case Expect() | Match():
                self._expect(step)

    def _send(self, step: Send) -> None:
        self._refuse_surplus(step, "before the next command")
        self._sent_s = self._now_s
        self._unit.send(step.data, channel=0)
        self._pass(0.0)

    def _pass(self, seconds: float) -> None:
        self._emulator.advance(seconds)
        self._now_s += seconds
        self._collect()

    def _collect(self) -> None:
        for output in self._unit.take_output():
            self._pending += output.data
            self._times_ns += [output.at_ns] * len(output.data)

    def _expect(self, step: Expect | Match) -> None:
        limit = self._sent_s + step.timing.at_s + step.timing.within_s if step.timing else 0.0
        deadline_s = max(self._now_s, limit) + AT_ONCE_S
        while (length := matched(step, self._pending)) == 0 and self._now_s < deadline_s:
            self._pass(SLICE_S)
        if length == 0:
            raise Mismatch(f"{self._where(step)}: expected {wanted(step)}, received {self._pending!r}")
        at_ns = self._take(length)
        if step.timing:
            self._check_time(step, step.timing, at_ns)

    def _check_time(self, step: Step, timing: Timing, at_ns: int) -> None:
        at_s = at_ns * 1e-9 - self._sent_s
        if abs(at_s - timing.at_s) > timing.within_s:
            said = f"{timing.at_s} s +-{timing.within_s} s"
            raise Mismatch(f"{self._where(step)}: left the unit at {at_s:.6f} s, expected {said}")

    def _take(self, length: int) -> int:
        last_ns = self._times_ns[length - 1] if length else 0
        self._pending, self._times_ns = self._pending[length:], self._times_ns[length:]
        return last_ns

    def _refuse_surplus(self, step: Step, when: str) -> None:
        if self._pending:
            raise Mismatch(f"{self._where(step)}: {when} the unit also sent {self._pending!r}")

    def _where(self, step: Step) -> str:
        return f"{self._transcript.path.name}:{step.line}"


def matched(step: Expect | Match, pending: bytes) -> int:
    """How many bytes at the head of `pending` are what `step` wants; 0 if they are not (yet)."""
    if isinstance(step, Expect):
        return len(step.data) if pending.startswith(step.data) else 0
    found = step.pattern.match(pending)
    return found.end() if found else 0


def wanted(step: Expect | Match) -> str:
    """What a step expects, for a message."""
    return repr(step.data) if isinstance(step, Expect) else f"a match of {step.pattern.pattern!r}"


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_transcript(path: Path) -> None:
    VirtualSession(load(path)).run()


def test_ten_thousand_commands_nobody_reads() -> None:
    """None is lost, nothing stalls, commands still act (several hosts never read)."""
    emulator = Emulator(Machine.parse("[defaults]\nECHO = 0"))
    unit = emulator.unit(0)
    for number in range(10_000):
        unit.send(b"1D%d\n" % number, channel=0)
    emulator.advance(0.1)
    data = b"".join(output.data for output in unit.take_output())
    assert data.count(b"\r\n> ") >= 10_000
    unit.send(b"1D\n", channel=0)
    emulator.advance(0.1)
    assert b"".join(output.data for output in unit.take_output()) == b"*1D+9999\r\r\n> "


def test_a_wrong_transcript_is_noticed() -> None:
    """The runner itself can fail: wrong bytes, surplus bytes, wrong time."""
    head = "title: t\nsource: s\nmachine:\n    [defaults]\n    ECHO = 0\n"
    for steps, said in (
        ("> 1TPE\\r\n< *1TPE+1\\r{ok}\n", "expected"),
        ("> 1TPE\\r\n< *1TPE+0\\r\n", "also sent"),
        ("> 1TPE\\r\n> 1TPE\\r\n", "also sent"),
        ("> 1TPE\\r\n< *1TPE+0\\r{ok}\nat 0.5s +-0.01s\n", "left the unit at"),
        ("> A5\\r\n~ \\r\\n\\?\n", "expected a match"),
    ):
        with pytest.raises(Mismatch, match=said):
            VirtualSession(parse(head + steps, path=Path("wrong.txt"))).run()

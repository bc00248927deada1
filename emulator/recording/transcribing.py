r"""A recording as a test transcript: the plain text of `tests/transcripts/`, which pytest plays to the unit.

A transcript knows one host that sends and waits. What it cannot say is refused: several connections at a time, a
daisy chain, actions. Times are exact: `@` brings the session to the recorded moment of the next packet, `at` says
when something that came by itself left the unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from emulator.machine import Machine, MachineError
from emulator.recording.format import (
    Attached,
    Detached,
    Done,
    End,
    Entry,
    Received,
    RecordingError,
    Sent,
    seconds,
)
from emulator.recording.header import Header
from emulator.recording.machine_text import machine_text

WITHIN_S = "0.000002"
"""How exact the times of a transcript are: the runner adds them up in floating point."""
LINE_WITHIN_S = "0.1"
"""How exact they are in a recording of a real unit's line."""
AT_ONCE_NS = 15_000_000
"""What a real unit sends within this time of a packet counts as said at once (design choice)."""
WIDTH = 100
_PROMPTS = (("\\r\\n> ", "{ok}"), ("\\r\\n? ", "{bad}"), ("\\r\\n- ", "{def}"))
_ESCAPED = {code: f"\\x{code:02x}" for code in (*range(0x20), *range(0x7F, 0x100))} | {
    0x0D: "\\r",
    0x0A: "\\n",
    0x09: "\\t",
    0x5C: "\\\\",
    0x7B: "\\{",
}


def transcript(header: Header, entries: Iterable[Entry], *, title: str, machine: str | None = None) -> str:
    """The text of a transcript.

    Args:
        header: the recording's.
        entries: the recording's, in order.
        title: one line, what the session shows.
        machine: the machine file; None takes the recorded one.

    Raises:
        RecordingError: the session has what a transcript cannot say.
    """
    if header.number("units", 1) > 1 or header.number("chain", 1) > 1:
        raise RecordingError("a transcript has one unit, this recording more")
    text = header.texts.get("machine u0", "") if machine is None else machine
    lines = [f"title: {' '.join(title.split())}", f"source: {_source(header)}", *_machine(text), ""]
    lines += _Writer(from_line=header.from_line).lines(entries)
    return "\n".join(lines) + "\n"


def _source(header: Header) -> str:
    what = "a unit's line" if header.from_line else f"this program, version {header.fields.get('program', 'unknown')}"
    return f"a recording of {what}, {header.fields.get('date', 'without a date')}"


def _machine(text: str) -> list[str]:
    """The machine file indented; rewritten where its own layout would not survive that."""
    try:
        machine = Machine.parse(text)
        plain = "\n".join(line.strip() for line in text.splitlines() if line.strip() and not line.startswith("#"))
        if not _reads_as(plain, machine):
            plain = machine_text(machine)
    except (MachineError, ValueError) as error:
        raise RecordingError(f"its machine file cannot be used: {error}") from None
    return ["machine:", *(f"    {line}" for line in plain.splitlines())] if plain else []


def _reads_as(text: str, machine: Machine) -> bool:
    try:
        return Machine.parse(text) == machine
    except MachineError:
        return False


class _Writer:
    """Entries to lines; knows what the runner's clock shows."""

    def __init__(self, *, from_line: bool) -> None:
        self._from_line = from_line
        self._now_ns: int | None = None if from_line else 0
        self._sent_ns = 0
        self._begun = False
        self._attached: set[int] = set()
        self._waiting: list[Sent] = []

    def lines(self, entries: Iterable[Entry]) -> Iterator[str]:
        for entry in entries:
            if self._now_ns is None:
                self._now_ns = self._sent_ns = entry.at_ns
            match entry:
                case Sent():
                    self._waiting.append(entry)
                case Received():
                    yield from self._packet(entry)
                case Attached() | Detached():
                    self._connection(entry)
                case Done():
                    raise RecordingError(f"line {entry.line}: a transcript has no actions ({entry.action})")
                case End():
                    yield from self._until(entry.at_ns)
        yield from self._until(self._waiting[-1].at_ns if self._waiting else self._now_ns or 0)

    def _connection(self, entry: Attached | Detached) -> None:
        (self._attached.add if isinstance(entry, Attached) else self._attached.discard)(entry.channel)

    def _packet(self, received: Received) -> Iterator[str]:
        others = self._attached - {received.channel}
        self._attached.add(received.channel)
        if others:
            names = ", ".join(f"c{channel}" for channel in sorted(self._attached))
            raise RecordingError(f"line {received.line}: a transcript has one connection at a time, not {names}")
        yield from self._until(received.at_ns)
        yield f"> {_text(received.data)}"
        self._sent_ns = received.at_ns
        self._begun = True

    def _until(self, at_ns: int) -> Iterator[str]:
        """What was said up to a time, and that time."""
        pieces, self._waiting = _joined(self._waiting), []
        if not self._begun:
            # What a unit says when it is switched on is not part of a transcript.
            pieces = [piece for piece in pieces if piece.at_ns > (self._now_ns or 0) or self._from_line]
        at_once_ns = self._sent_ns + (AT_ONCE_NS if self._from_line else 0)
        for piece in pieces:
            if piece.at_ns <= at_once_ns:
                yield from _expected(piece.data)
        now_ns = self._now_ns or 0
        if at_ns > now_ns:
            yield f"@ {seconds(at_ns - now_ns)}s"
            self._now_ns = at_ns
        within = LINE_WITHIN_S if self._from_line else WITHIN_S
        for piece in pieces:
            if piece.at_ns > at_once_ns:
                yield from _expected(piece.data)
                yield f"at {seconds(piece.at_ns - self._sent_ns)}s +-{within}s"


def _joined(pieces: Iterable[Sent]) -> list[Sent]:
    """Neighbours that left together as one."""
    joined: list[Sent] = []
    for piece in pieces:
        if joined and joined[-1].at_ns == piece.at_ns:
            piece = Sent(piece.at_ns, piece.unit, piece.channel, joined.pop().data + piece.data)
        joined.append(piece)
    return joined


def _expected(data: bytes) -> Iterator[str]:
    """`<` lines; long pieces go on on the next line."""
    for start in range(0, len(data), WIDTH):
        yield f"< {_text(data[start : start + WIDTH])}"


def _text(data: bytes) -> str:
    text = data.decode("latin-1").translate(_ESCAPED)
    for said, name in _PROMPTS:
        text = text.replace(said, name)
    inner = text.strip(" ")
    before = len(text) - len(text.lstrip(" ")) if inner else len(text)
    after = len(text) - before - len(inner)
    return "\\s" * before + inner + "\\s" * after

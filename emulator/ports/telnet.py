"""The telnet protocol (RFC 854) as a pair of functions on bytes: no socket, no clock.

`Recognizer` watches a raw stream for the first sign of a telnet client, `Decoder` takes a telnet stream apart, `encode`
makes one, `Options` answers negotiation. What each option means to us is decided in `ports.conversation`.

Why recognition is cautious: a raw host must never see a byte it did not ask for, and noise on a line holds 0xFF. So
only an IAC followed by a negotiation or a plain command counts. A subnegotiation does not: no client begins with one,
and taking noise for the beginning of one would swallow everything after it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

IAC, DONT, DO, WONT, WILL, SB, SE = 255, 254, 253, 252, 251, 250, 240
NOP, DATA_MARK, BREAK, INTERRUPT, ABORT_OUTPUT, ARE_YOU_THERE, ERASE_CHARACTER, ERASE_LINE, GO_AHEAD = range(241, 250)
BINARY, ECHO, SUPPRESS_GO_AHEAD, TIMING_MARK, COM_PORT = 0, 1, 3, 6, 44

SUBNEGOTIATION_BYTES = 512
"""What is kept of one subnegotiation; one that is longer is dropped whole (design choice, RFC 855 sets no limit)."""

_IAC = b"\xff"
_VERBS = frozenset((WILL, WONT, DO, DONT))
_COMMANDS = frozenset(range(236, 250)) - {SE}
"""Commands of one byte: end of file, suspend, abort and end of record (RFC 1184, RFC 885), and those of RFC 854."""


@dataclass(frozen=True, slots=True)
class Negotiate:
    """WILL, WONT, DO or DONT an option."""

    verb: int
    option: int


@dataclass(frozen=True, slots=True)
class Subnegotiation:
    """What stood between IAC SB and IAC SE, option first, doubled IACs undone."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Command:
    """A command of one byte, such as ARE_YOU_THERE."""

    code: int


Event = bytes | Negotiate | Subnegotiation | Command


class Recognizer:
    """Looks for the first telnet command of a stream; an IAC at the very end waits for the byte after it."""

    def __init__(self) -> None:
        self._held = b""

    @property
    def undecided(self) -> bool:
        """An IAC is held back."""
        return bool(self._held)

    def feed(self, data: bytes) -> tuple[bytes, bytes]:
        """Raw bytes, unchanged, and from the first telnet command on the rest (empty: none was found)."""
        data, self._held = self._held + data, b""
        at = data.find(_IAC)
        while 0 <= at < len(data) - 1:
            if data[at + 1] in _VERBS or data[at + 1] in _COMMANDS:
                return data[:at], data[at:]
            at = data.find(_IAC, at + 2)
        if at >= 0:
            data, self._held = data[:at], _IAC
        return data, b""

    def flush(self) -> bytes:
        """What is held back, when nothing more will come."""
        held, self._held = self._held, b""
        return held


class Decoder:
    """Takes a telnet stream apart, however it is cut into packets.

    `binary` (RFC 856): CR NUL stands for itself; otherwise for CR alone. CR LF is left as it is, because the unit takes
    it for one end of line, as it would on a serial line.
    """

    def __init__(self) -> None:
        self.binary = False
        self._after_cr = False
        self._in_command = False
        self._verb: int | None = None
        self._inside: bytearray | None = None

    def feed(self, data: bytes) -> Iterator[Event]:
        """The events of `data` in order; act on each before taking the next, as it may change `binary`."""
        position = 0
        while position < len(data):
            if self._in_command or self._verb is not None:
                yield from self._step(data[position])
                position += 1
                continue
            at = data.find(_IAC, position)
            end = len(data) if at < 0 else at
            yield from self._plain(data[position:end])
            self._in_command = at >= 0
            position = end + 1

    def _step(self, byte: int) -> Iterator[Event]:
        """One byte after an IAC."""
        self._in_command = False
        if self._verb is not None:
            verb, self._verb = self._verb, None
            yield Negotiate(verb, byte)
        elif byte == IAC:
            yield from self._plain(_IAC)
        elif byte == SE:
            yield from self._end_of_subnegotiation()
        else:
            yield from self._command(byte)

    def _command(self, byte: int) -> Iterator[Event]:
        """Any command ends a subnegotiation that was never closed; RFC 855 allows none inside."""
        self._inside = bytearray() if byte == SB else None
        if byte in _VERBS:
            self._verb = byte
        elif byte in _COMMANDS:
            yield Command(byte)

    def _end_of_subnegotiation(self) -> Iterator[Event]:
        inside, self._inside = self._inside, None
        if inside is not None and 0 < len(inside) <= SUBNEGOTIATION_BYTES:
            yield Subnegotiation(bytes(inside))

    def _plain(self, data: bytes) -> Iterator[Event]:
        if self._inside is not None:
            self._inside += data[: SUBNEGOTIATION_BYTES + 1 - len(self._inside)]
        elif data:
            text = self._without_nul(data)
            if text:
                yield text

    def _without_nul(self, data: bytes) -> bytes:
        if self.binary:
            self._after_cr = False
            return data
        if self._after_cr and data[0] == 0:
            self._after_cr = False
            return self._without_nul(data[1:]) if len(data) > 1 else b""
        self._after_cr = data.endswith(b"\r")
        return data.replace(b"\r\0", b"\r")


def encode(data: bytes, *, binary: bool = False) -> bytes:
    """`data` as it goes over a telnet connection: IAC doubled; unless `binary`, CR not before LF becomes CR NUL.

    Pieces may be encoded apart: a CR that ends one becomes CR NUL, and CR NUL LF means the same as CR LF.
    """
    if _IAC in data:
        data = data.replace(_IAC, b"\xff\xff")
    if binary or b"\r" not in data:
        return data
    return data.replace(b"\r", b"\r\0").replace(b"\r\0\n", b"\r\n")


class Options:
    """Who does which option, and what to answer (after RFC 1143, without its queue: we never withdraw an offer).

    Only changes are acknowledged, so two sides that follow the rule cannot answer each other for ever.
    """

    def __init__(self, *, ours: frozenset[int], theirs: frozenset[int]) -> None:
        self._allowed = {DO: ours, WILL: theirs}
        self._active: dict[int, set[int]] = {DO: set(), WILL: set()}
        self._offered: dict[int, set[int]] = {DO: set(), WILL: set()}

    def we_do(self, option: int) -> bool:
        """The other side agreed that we do it."""
        return option in self._active[DO]

    def they_do(self, option: int) -> bool:
        """The other side does it."""
        return option in self._active[WILL]

    def offer(self, option: int) -> bytes:
        """Say that we will, unless that is said or agreed already."""
        return self._open(DO, WILL, option)

    def ask(self, option: int) -> bytes:
        """Ask them to, unless that is asked or agreed already."""
        return self._open(WILL, DO, option)

    def answer(self, verb: int, option: int) -> bytes:
        """What to send for a received negotiation; empty if nothing."""
        agreed = DO if verb in (DO, DONT) else WILL
        yes, no = (WILL, WONT) if agreed == DO else (DO, DONT)
        if verb == agreed:
            return self._answer_yes(agreed, option, yes, no)
        was_active = option in self._active[agreed]
        self._active[agreed].discard(option)
        self._offered[agreed].discard(option)
        return bytes((IAC, no, option)) if was_active else b""

    def _answer_yes(self, agreed: int, option: int, yes: int, no: int) -> bytes:
        if option not in self._allowed[agreed]:
            return bytes((IAC, no, option))
        if option in self._active[agreed]:
            return b""
        self._active[agreed].add(option)
        if option in self._offered[agreed]:
            self._offered[agreed].discard(option)
            return b""
        return bytes((IAC, yes, option))

    def _open(self, agreed: int, verb: int, option: int) -> bytes:
        if option in self._active[agreed] or option in self._offered[agreed]:
            return b""
        self._offered[agreed].add(option)
        return bytes((IAC, verb, option))

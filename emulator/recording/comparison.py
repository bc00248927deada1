"""What a unit sent against what it is recorded to have sent: the first difference, and how to read it.

Two streams of pieces, each with its time and its connection, are compared byte by byte; how they are cut into pieces
does not matter. Without a tolerance times are exact, and whatever one side has before an input the other must have
before it too. With one, a piece may come earlier or later by that much, also beyond an input.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from emulator.recording.format import Sent, escaped, seconds

Kind = Literal["bytes", "time", "connection", "missing", "surplus"]
SHOWN = 72
"""Characters of a piece that are shown around a difference."""
NS_PER_MS = 1_000_000


@dataclass(frozen=True, slots=True)
class Cause:
    """The latest command a unit was sent before a piece."""

    at_ns: int
    channel: int
    command: bytes
    line: int


@dataclass(frozen=True, slots=True)
class Difference:
    """The first piece that is not as recorded; `offset` is the first byte of it that differs."""

    kind: Kind
    unit: int
    expected: Sent | None
    actual: Sent | None
    offset: int
    cause: Cause | None
    before: tuple[str, ...]

    @property
    def at_ns(self) -> int:
        """When it was, by the recording if that has anything there."""
        piece = self.expected or self.actual
        return piece.at_ns if piece else 0


@dataclass(slots=True)
class _Piece:
    sent: Sent
    cause: Cause | None
    used: int = 0

    @property
    def left(self) -> bytes:
        return self.sent.data[self.used :]


class Comparison:
    """The two streams of one unit. `tolerance_ns`: 0 is exact; None compares bytes and order only."""

    def __init__(self, *, tolerance_ns: int | None = 0) -> None:
        self._tolerance_ns = tolerance_ns
        self._expected: deque[_Piece] = deque()
        self._actual: deque[_Piece] = deque()
        self.difference: tuple[Kind, Sent | None, Sent | None, int, Cause | None] | None = None

    def expect(self, sent: Sent, cause: Cause | None) -> None:
        """The recording's next piece."""
        if sent.data:
            self._expected.append(_Piece(sent, cause))

    def came(self, pieces: Iterable[Sent], cause: Cause | None) -> None:
        """What the unit has sent; `cause` is the latest command it had by then."""
        self._actual.extend(_Piece(piece, cause) for piece in pieces if piece.data)

    def settle(self, now_ns: int) -> bool:
        """Compare what both sides have up to now; False once they differ."""
        self._match()
        if self.difference is None and self._tolerance_ns is not None:
            self._refuse_rest(now_ns - self._tolerance_ns if self._tolerance_ns else None)
        return self.difference is None

    def end(self, *, may_go_on_from_ns: int | None) -> bool:
        """Compare what is left; of the unit's bytes those from a time on may go unrecorded. False if they differ."""
        self._match()
        if self.difference is None:
            self._refuse_rest(None, may_go_on_from_ns=may_go_on_from_ns)
        return self.difference is None

    def _match(self) -> None:
        while self._expected and self._actual and self.difference is None:
            expected, actual = self._expected[0], self._actual[0]
            wanted, came = expected.left, actual.left
            length = min(len(wanted), len(came))
            kind = self._unlike(expected.sent, actual.sent, wanted[:length], came[:length])
            if kind is not None:
                self._differ(kind, expected, actual, _common(wanted, came) if kind == "bytes" else 0)
                return
            for queue, piece in ((self._expected, expected), (self._actual, actual)):
                piece.used += length
                if not piece.left:
                    queue.popleft()

    def _unlike(self, expected: Sent, actual: Sent, wanted: bytes, came: bytes) -> Kind | None:
        if wanted != came:
            return "bytes"
        if expected.channel != actual.channel:
            return "connection"
        tolerance_ns = self._tolerance_ns
        if tolerance_ns is not None and abs(expected.at_ns - actual.at_ns) > tolerance_ns:
            return "time"
        return None

    def _refuse_rest(self, before_ns: int | None, *, may_go_on_from_ns: int | None = None) -> None:
        """What only one side has is a difference; with `before_ns` only if it is older than that."""
        if self._expected and (before_ns is None or self._expected[0].sent.at_ns < before_ns):
            self._differ("missing", self._expected[0], None, 0)
        elif self._actual:
            at_ns = self._actual[0].sent.at_ns
            goes_on = may_go_on_from_ns is not None and at_ns >= may_go_on_from_ns
            if not goes_on and (before_ns is None or at_ns < before_ns):
                self._differ("surplus", None, self._actual[0], 0)

    def _differ(self, kind: Kind, expected: _Piece | None, actual: _Piece | None, common: int) -> None:
        piece = expected or actual
        wanted, came = (None if side is None else _rest(side) for side in (expected, actual))
        self.difference = (kind, wanted, came, common, piece.cause if piece else None)


def _rest(piece: _Piece) -> Sent:
    sent = piece.sent
    return Sent(sent.at_ns, sent.unit, sent.channel, piece.left, sent.line)


def _common(first: bytes, second: bytes) -> int:
    length = min(len(first), len(second))
    return next((index for index in range(length) if first[index] != second[index]), length)


def render(difference: Difference, *, path: str) -> str:
    """The difference as a person reads it, several lines."""
    return "\n".join([_headline(difference, path), *_before(difference), *_sides(difference)])


def _headline(difference: Difference, path: str) -> str:
    piece = difference.expected or difference.actual
    place = f"{path}:{difference.expected.line}" if difference.expected else path
    connection = "" if piece is None or piece.channel is None else f", connection {piece.channel}"
    said = {
        "bytes": "other bytes",
        "time": f"another time ({_lateness(difference)})",
        "connection": "another connection",
        "missing": "nothing where something was sent",
        "surplus": "something where nothing was sent",
    }[difference.kind]
    return (
        f"{place}: at {seconds(difference.at_ns)} s, unit {difference.unit}{connection}: {said}{_because(difference)}"
    )


def _because(difference: Difference) -> str:
    cause = difference.cause
    if cause is None:
        return ", before any command"
    return f', after "{escaped(cause.command)}" (line {cause.line}, {seconds(cause.at_ns)} s)'


def _lateness(difference: Difference) -> str:
    if difference.expected is None or difference.actual is None:
        return ""
    late_ns = difference.actual.at_ns - difference.expected.at_ns
    return f"{abs(late_ns) / NS_PER_MS:.6f} ms {'later' if late_ns > 0 else 'earlier'}"


def _before(difference: Difference) -> list[str]:
    return [f"            {line}" for line in difference.before]


def _sides(difference: Difference) -> list[str]:
    start = _window(difference)
    expected = _side("  expected  ", difference.expected, start)
    actual = _side("  actual    ", difference.actual, start)
    column = _caret(difference, start)
    return [expected, actual, " " * column + "^"]


def _window(difference: Difference) -> int:
    """The first byte shown: long pieces are shown around the difference only."""
    return max(0, difference.offset - SHOWN // 2)


def _side(label: str, sent: Sent | None, start: int) -> str:
    if sent is None:
        return f"{label}nothing"
    data = sent.data[start : start + SHOWN]
    more = " ..." if len(sent.data) > start + SHOWN else ""
    return f'{label}{_place(sent)} {"... " if start else ""}"{escaped(data)}"{more}'


def _place(sent: Sent) -> str:
    return f"{seconds(sent.at_ns)} u{sent.unit} c{'*' if sent.channel is None else sent.channel} <"


def _caret(difference: Difference, start: int) -> int:
    """The column of the first character that differs."""
    label = 12
    sent = difference.expected or difference.actual
    if sent is None or difference.kind in ("missing", "surplus"):
        return label
    place = _place(sent)
    if difference.kind == "time" and difference.actual is not None:
        return label + _common(place.encode(), _place(difference.actual).encode())
    if difference.kind == "connection":
        return label + place.rindex(" c") + 2
    quote = len('... "') if start else len('"')
    return label + len(place) + 1 + quote + len(escaped(sent.data[start : difference.offset]))

"""Profiles of any length: segments that come from an iterator and reach the kernel in portions.

A profile of a thousand million loops, or of endless ones, neither fits the segment table nor may it drift. So a stream
keeps where every segment begins, in time and in position, as whole numbers of very small units, and each portion of
rows it hands over counts from a moment (whole ns) and a position (whole counts) of its own, near its first row: what
the kernel reckons in floats are always short times and distances. The kernel tells well before the rows run out.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from math import inf, isinf
from typing import NamedTuple

from .profile import Segment
from .rates import NS_PER_S

TICKS_PER_S = 1 << 60
"""Resolution of the time at which a segment begins: below 1e-18 s."""

PARTS_PER_COUNT = 1 << 32
"""Resolution of the position at which a segment begins."""

ROWS_IN_PORTION = 64
"""Rows a portion has at least, if there are so many segments left."""

ENDLESS = -1
"""Duration of a segment that goes on at constant velocity until the stream is resumed or replaced."""

NO_REFILL = 1 << 62
"""Row that is never reached."""


class StreamedSegment(NamedTuple):
    """A piece of a profile that does not say where it begins.

    `segment` has its position relative to the piece's own beginning; its duration is not looked at. `duration` is in
    1/TICKS_PER_S s or ENDLESS, `displacement` in 1/PARTS_PER_COUNT counts. `mark` is told, with the time at which the
    piece begins, when the piece is handed to the kernel.
    """

    segment: Segment
    duration: int
    displacement: int
    mark: object | None = None


OnMark = Callable[[int, object], None]
"""Gets the virtual time, ns, at which a marked piece begins, and its mark."""


class Portion(NamedTuple):
    """Rows for the kernel.

    Positions count from `origin_counts` (raw), times from `base_ns`; the first row begins `lead_s` after that. At row
    `refill_index` more rows should be had. `end_s` is the profile's end, infinite if it does not lie in this portion,
    and `end_counts` the position there.
    """

    base_ns: int
    origin_counts: int
    lead_s: float
    segments: tuple[Segment, ...]
    end_s: float
    end_counts: float
    refill_index: int


class _Row(NamedTuple):
    start: int
    position: int
    piece: StreamedSegment


class Stream:
    """The segments of one axis still to come, and the exact place of those the kernel has."""

    def __init__(self, pieces: Iterator[StreamedSegment], *, margin_s: float, on_mark: OnMark | None = None) -> None:
        """`margin_s` is the time the rows must still last when the kernel asks for more."""
        self._pieces = pieces
        self._margin = round(margin_s * TICKS_PER_S)
        self._on_mark = on_mark
        self._rows: deque[_Row] = deque()
        self._begin_ns = 0
        self._time = 0
        self._position = 0
        self._exhausted = False
        self._held = False

    def begin(self, *, at_ns: int, position_counts: float) -> Portion:
        """The first portion, or the first after an endless segment: time and raw position to begin at."""
        whole = int(position_counts // 1)
        self._rows.clear()
        self._begin_ns, self._time, self._held = at_ns, 0, False
        self._position = whole * PARTS_PER_COUNT + round((position_counts - whole) * PARTS_PER_COUNT)
        return self._portion()

    def go_on(self, segment_index: int) -> Portion:
        """The next portion, the kernel being in row `segment_index` of the last one."""
        for _ in range(segment_index):
            self._rows.popleft()
        return self._portion()

    def _portion(self) -> Portion:
        self._fill()
        rows = self._rows
        start, position = (rows[0].start, rows[0].position) if rows else (self._time, self._position)
        base_ns = start * NS_PER_S // TICKS_PER_S
        lead = start * NS_PER_S - base_ns * TICKS_PER_S
        origin = position // PARTS_PER_COUNT
        segments = [_placed(row, origin) for row in rows]
        end_s, end_counts = inf, 0.0
        if self._exhausted and not self._held:
            end_counts = _counts_from(self._position, origin)
            segments.append(Segment(0.0, end_counts, 0.0, 0.0, 0.0))
            end_s = (self._time * NS_PER_S - base_ns * TICKS_PER_S) / (TICKS_PER_S * NS_PER_S)
        lead_s = lead / (TICKS_PER_S * NS_PER_S)
        base_ns += self._begin_ns
        return Portion(base_ns, origin, lead_s, tuple(segments), end_s, end_counts, self._refill_index())

    def _fill(self) -> None:
        """Take pieces until there are rows enough, and those after the first last twice the margin."""
        while not self._exhausted and not self._held:
            lasts = self._time - self._rows[1].start if len(self._rows) > 1 else 0
            if len(self._rows) >= ROWS_IN_PORTION and lasts > 2 * self._margin:
                return
            piece = next(self._pieces, None)
            if piece is None:
                self._exhausted = True
            else:
                self._take(piece)

    def _take(self, piece: StreamedSegment) -> None:
        self._rows.append(_Row(self._time, self._position, piece))
        if piece.mark is not None and self._on_mark is not None:
            self._on_mark(self._begin_ns + self._time * NS_PER_S // TICKS_PER_S, piece.mark)
        if piece.duration == ENDLESS:
            self._held = True
        else:
            self._time += piece.duration
            self._position += piece.displacement

    def _refill_index(self) -> int:
        """The last row that begins early enough for the rest to last the margin."""
        if self._exhausted or self._held:
            return NO_REFILL
        latest = self._time - self._margin
        return max(index for index, row in enumerate(self._rows) if index == 0 or row.start <= latest)


def _placed(row: _Row, origin: int) -> Segment:
    """A piece as a row whose position counts from `origin`."""
    piece = row.piece
    duration_s = inf if piece.duration == ENDLESS else piece.duration / TICKS_PER_S
    position = piece.segment.position + _counts_from(row.position, origin)
    return piece.segment._replace(duration_s=duration_s, position=position)


def _counts_from(position: int, origin: int) -> float:
    return (position - origin * PARTS_PER_COUNT) / PARTS_PER_COUNT


def streamed(segment: Segment, *, displacement: float | None = None) -> StreamedSegment:
    """A piece from a segment that begins at position 0; `displacement` in counts where it is known exactly.

    An endless segment becomes an endless piece.
    """
    if isinf(segment.duration_s):
        return StreamedSegment(segment, ENDLESS, 0)
    travel = _travel(segment) if displacement is None else displacement
    return StreamedSegment(segment, round(segment.duration_s * TICKS_PER_S), round(travel * PARTS_PER_COUNT))


def _travel(segment: Segment) -> float:
    t = segment.duration_s
    return t * (segment.velocity + t * (segment.acceleration / 2 + t * segment.jerk / 6))

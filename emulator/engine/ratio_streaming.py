"""Ratio profiles of any length: pieces that come from an iterator and reach the kernel in portions.

Most profiles are short and go to the kernel whole. Of a longer one the kernel has the pieces around the master's
position and asks for more when it enters one on the way; where the kept pieces begin is known as an exact rational of
the whole profile, so nothing drifts. A master that backs up retraces the pieces that are kept (at least
`ROWS_BEHIND`, assumed enough).

Marks cannot be told ahead of their piece, since nobody knows when a master gets there; they are told at the system
update at which the master is there, and the slave follows two updates later.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from .following_axes import FollowingAxes, RatioMove
from .ratio_profile import ZERO, RatioSegment
from .readings import axis_word
from .streaming import NO_REFILL, OnMark

ROWS_IN_PORTION = 256
ROWS_BEHIND = 64

_INDEX, _DIRECTION = axis_word("ratio_index"), axis_word("ratio_direction")
_START, _START_PART = axis_word("ratio_master"), axis_word("ratio_master_part")


class StreamedRatio(NamedTuple):
    """A piece of a ratio profile; `mark` is told when the master enters it."""

    segment: RatioSegment
    mark: object | None = None


class RatioStream:
    """The pieces of one slave's profile: those the kernel has, and those still to come."""

    def __init__(self, pieces: Iterator[StreamedRatio], *, preset: bool, on_mark: OnMark | None) -> None:
        """`preset`: the profile runs in the positive master direction only."""
        self._pieces = pieces
        self.preset = preset
        self.on_mark = on_mark
        self.rows: list[StreamedRatio] = []
        self.more = True
        self.move: RatioMove | None = None
        self.hold_rows = 0
        self._told = 0

    def fill(self) -> None:
        """Take pieces until the portion is full, the profile ends, or an endless piece stands last."""
        while self.more and len(self.rows) < ROWS_IN_PORTION:
            piece = next(self._pieces, None)
            if piece is None:
                self.more = False
                return
            self.rows.append(piece)
            if piece.segment.master is None:
                return

    def drop(self, count: int) -> tuple[Fraction, Fraction]:
        """Forget the first pieces; master and slave travel over them."""
        dropped, self.rows = self.rows[:count], self.rows[count:]
        self._told = max(0, self._told - count)
        master = sum((piece.segment.master or ZERO for piece in dropped), ZERO)
        return master, sum((piece.segment.slave for piece in dropped), ZERO)

    def clear(self) -> None:
        """Forget every piece the kernel has."""
        self.rows.clear()
        self._told = 0

    def segments(self) -> tuple[RatioSegment, ...]:
        """The pieces, closed by an endless one where more are to come: the kernel must not take that for the end."""
        segments = tuple(piece.segment for piece in self.rows)
        if self.more and segments and segments[-1].master is not None:
            last = segments[-1].end_ratio
            return (*segments, RatioSegment(None, last, last))
        return segments

    @property
    def waits(self) -> bool:
        """The last piece the kernel has is an endless one of the profile's own."""
        return bool(self.rows) and self.rows[-1].segment.master is None

    def entered(self, index: int) -> list[object]:
        """The marks of the pieces up to and including `index` that have not been told."""
        marks = [piece.mark for piece in self.rows[self._told : index + 1] if piece.mark is not None]
        self._told = max(self._told, index + 1)
        return marks

    def look_at(self) -> int:
        """The piece at which the kernel shall tell: the next one with a mark, or the one to have more rows at."""
        refill = ROWS_IN_PORTION - ROWS_BEHIND if self.more and not self.waits else NO_REFILL
        marked = (index for index in range(self._told, len(self.rows)) if self.rows[index].mark is not None)
        return min(refill, next(marked, NO_REFILL))


class RatioStreams(FollowingAxes, ABC):
    """The streamed half of Following in `Engine`."""

    @property
    @abstractmethod
    def next_system_update_ns(self) -> int:
        """Time of the first system update to come."""

    def _init_ratio_streams(self, axis_count: int) -> None:
        self._ratio_streams: list[RatioStream | None] = [None] * axis_count
        for axis_index in range(axis_count):
            self._write(axis_index, ratio_told_index=NO_REFILL)

    def _forget_streams(self, axis_index: int) -> None:
        self._ratio_streams[axis_index] = None
        self._write(axis_index, ratio_told_index=NO_REFILL)
        super()._forget_streams(axis_index)

    def stream_following(
        self, axis_index: int, pieces: Iterator[StreamedRatio], *, preset: bool, on_mark: OnMark | None = None
    ) -> RatioStream:
        """Start a ratio profile of any length, as `start_following` does; `on_mark` is called with the time of the
        system update at which the master is in a marked piece, before `run` returns ROWS_LOW."""
        stream = RatioStream(pieces, preset=preset, on_mark=on_mark)
        self._begin_stream(axis_index, stream)
        return stream

    def resume_following(self, axis_index: int) -> None:
        """Leave the endless piece a streamed ratio profile is in: the next one begins where the master is."""
        stream = self._ratio_streams[axis_index]
        if stream is None or not self.streams_ratio(axis_index, stream):
            raise ValueError(f"axis {axis_index + 1} has no streamed ratio profile")
        stream.clear()
        self._begin_stream(axis_index, stream)

    def streams_ratio(self, axis_index: int, stream: RatioStream) -> bool:
        """Whether this profile moves the axis: it has neither ended nor been replaced."""
        return self._moves[axis_index] is stream.move and self.is_following(axis_index)

    def _begin_stream(self, axis_index: int, stream: RatioStream) -> None:
        stream.fill()
        self.start_following(axis_index, stream.segments(), preset=stream.preset)
        stream.move = self._moves[axis_index]
        stream.hold_rows = 0 if stream.move is None or stream.move.hold is None else 1
        self._ratio_streams[axis_index] = stream
        self._tell_at(axis_index, stream)

    def _tell_at(self, axis_index: int, stream: RatioStream) -> None:
        self._write(axis_index, ratio_told_index=min(NO_REFILL, stream.look_at() + stream.hold_rows))

    def _feed_ratios(self, axis_index: int) -> None:
        """The kernel has entered a piece it was to tell of: tell its mark, hand it more."""
        stream = self._ratio_streams[axis_index]
        if stream is None or not self.streams_ratio(axis_index, stream):
            return
        index = self._ints[axis_index][_INDEX] - stream.hold_rows
        for mark in stream.entered(index):
            if stream.on_mark is not None:
                stream.on_mark(self.next_system_update_ns, mark)
        if stream.more and not stream.waits and index >= ROWS_IN_PORTION - ROWS_BEHIND:
            self._shift_portion(axis_index, stream, min(index, len(stream.rows)) - ROWS_BEHIND)
        self._tell_at(axis_index, stream)

    def _shift_portion(self, axis_index: int, stream: RatioStream, count: int) -> None:
        """Drop the first pieces and append others; the profile's beginning moves on with them."""
        assert stream.move is not None
        ints, direction = self._ints[axis_index], self._ints[axis_index][_DIRECTION]
        index = ints[_INDEX] - stream.hold_rows - count
        begin = ints[_START] + Fraction(self._floats[axis_index][_START_PART])
        master, slave = stream.drop(count)
        stream.fill()
        whole, part = divmod(begin + direction * master, 1)
        move = RatioMove(stream.segments(), stream.move.base + direction * slave, None)
        self._begin_move(axis_index, move)
        stream.move, stream.hold_rows = move, 0
        self._write(axis_index, ratio_master=whole, ratio_master_part=float(part), ratio_index=index, ratio_mirrored=0)

"""Profiles in time as the kernel has them: whole ones, and the portions of those that come from an iterator.

A new motion of an axis takes the place of every other; `_forget_streams` is the one place where both kinds of stream
are forgotten then.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterator

from .events import EVENT_ROWS_LOW
from .profile import Segments, State, evaluate
from .rates import NS_PER_S
from .ratio_streaming import RatioStreams
from .readings import ACTIVE, COMMANDED, ENABLED, OFFSET, DriveShutDown, axis_word
from .streaming import OnMark, Portion, Stream, StreamedSegment

STREAM_MARGIN_UPDATES = 4
"""System updates for which the rows of a streamed profile still last when the kernel asks for more."""

TIMED = 1
"""Code of `profile_active` for a profile in time."""

_START, _ORIGIN = axis_word("profile_start_ns"), axis_word("profile_origin_counts")
_SEGMENT_INDEX, _EVENTS = axis_word("segment_index"), axis_word("events")


class ProfileStreams(RatioStreams, ABC):
    """The half of `Engine` that hands profiles in time to the kernel."""

    def _init_profile_streams(self, axis_count: int) -> None:
        self._profiles: list[Segments] = [()] * axis_count
        self._leads_s = [0.0] * axis_count
        self._streams: list[Stream | None] = [None] * axis_count

    def _forget_streams(self, axis_index: int) -> None:
        self._streams[axis_index] = None
        super()._forget_streams(axis_index)

    def _load(self, axis_index: int, portion: Portion) -> None:
        """Put rows into force at the next trajectory update."""
        segments = portion.segments
        if self._memory.reserve_segments(len(segments)):
            self._bind()
        self._memory.store_segments(axis_index, segments, start_s=portion.lead_s)
        self._profiles[axis_index], self._leads_s[axis_index] = segments, portion.lead_s
        self._write(
            axis_index,
            profile_start_ns=portion.base_ns,
            profile_end_s=portion.end_s,
            profile_end_counts=portion.end_counts,
            profile_origin_counts=portion.origin_counts,
            segment_count=len(segments),
            segment_index=0,
            refill_index=portion.refill_index,
        )

    def stream_profile(
        self, axis_index: int, pieces: Iterator[StreamedSegment], on_mark: OnMark | None = None
    ) -> Stream:
        """Start a profile of any length from where the axis is commanded to be, at the next trajectory update.

        Pieces are taken from the iterator as they are needed, at least four system updates ahead; `on_mark` is called
        with the marks of those taken, the first ones before this returns, the others before `run` returns ROWS_LOW.
        Returns what `streams` knows the profile by. DriveShutDown if the drive is off.
        """
        if not self._ints[axis_index][ENABLED]:
            raise DriveShutDown(f"the drive of axis {axis_index + 1} is off")
        state = self._raw_state(axis_index)
        stream = Stream(pieces, margin_s=STREAM_MARGIN_UPDATES * self.rates.system_ns / NS_PER_S, on_mark=on_mark)
        self._give_up_motion(axis_index)
        self._load(axis_index, stream.begin(at_ns=self.next_trajectory_ns, position_counts=state.position))
        self._streams[axis_index] = stream
        self._write(axis_index, profile_active=TIMED, settling=0)
        return stream

    def resume_stream(self, axis_index: int) -> None:
        """Leave the endless piece a streamed profile is in: the next one begins at the next trajectory update."""
        stream = self._streams[axis_index]
        if stream is None:
            raise ValueError(f"axis {axis_index + 1} has no streamed profile")
        state = self._raw_state(axis_index)
        self._load(axis_index, stream.begin(at_ns=self.next_trajectory_ns, position_counts=state.position))

    def streams(self, axis_index: int, stream: Stream) -> bool:
        """Whether this streamed profile moves the axis: it has neither ended nor been replaced."""
        return self._streams[axis_index] is stream and self._ints[axis_index][ACTIVE] == TIMED

    def _feed_streams(self) -> None:
        """Hand more rows to the axes that have asked."""
        for axis_index, stream in enumerate(self._streams):
            events = self._ints[axis_index][_EVENTS]
            if events & EVENT_ROWS_LOW:
                self._ints[axis_index][_EVENTS] = events & ~EVENT_ROWS_LOW
                self._feed_ratios(axis_index)
                if stream is not None and self.streams(axis_index, stream):
                    self._load(axis_index, stream.go_on(self._ints[axis_index][_SEGMENT_INDEX]))

    def _raw_state(self, axis_index: int) -> State:
        ints = self._ints[axis_index]
        if not ints[ACTIVE]:
            return State(float(ints[COMMANDED]), 0.0, 0.0)
        if self.is_following(axis_index):
            position, velocity, acceleration = self._slave_state(axis_index)
            return State(position + ints[OFFSET], velocity, acceleration)
        elapsed_s = (self.next_trajectory_ns - ints[_START]) / NS_PER_S - self._leads_s[axis_index]
        position, velocity, acceleration = evaluate(self._profiles[axis_index], elapsed_s)
        return State(position + ints[_ORIGIN], velocity, acceleration)

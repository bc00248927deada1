"""One unit's servo state in memory: the arrays the kernel works on and cheap windows on their single words.

Reading a field of a structured array through numpy costs a microsecond; through a memory view of its words it costs
a tenth of that and gives a plain Python number, which matters where a host polls positions tens of thousands of times
a second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from .kernels import Records
from .layout import AXIS, SEGMENT, UNIT, WATCH, WORD_BYTES, places_of
from .profile import Segment
from .watches import WATCH_SLOTS

SEGMENTS_AT_START = 16


class Words(NamedTuple):
    """The words of one record, seen as integers and as floats."""

    ints: memoryview[int]
    floats: memoryview[float]


def words_of(records: Records, index: int) -> Words:
    """Windows on the words of `records[index]`, valid as long as the array lives."""
    count = records.dtype.itemsize // WORD_BYTES
    raw = records.view(np.uint8).data[index * count * WORD_BYTES : (index + 1) * count * WORD_BYTES]
    return Words(raw.cast("q"), raw.cast("d"))


def write_fields(words: Words, dtype: np.dtype, fields: Mapping[str, float]) -> None:
    """Set several fields of the record of type `dtype` seen through `words`; KeyError for an unknown name."""
    places = places_of(dtype)
    for name, value in fields.items():
        word, is_int = places[name]
        if is_int:
            words.ints[word] = int(value)
        else:
            words.floats[word] = value


class Memory:
    """The arrays of one unit with `axis_count` axes."""

    def __init__(self, axis_count: int) -> None:
        self.units: Records = np.zeros(1, UNIT)
        self.axes: Records = np.zeros(axis_count, AXIS)
        self.watches: Records = np.zeros(WATCH_SLOTS, WATCH)
        self.segments: Records = np.zeros(0, SEGMENT)
        self.capacity = 0
        self.unit = words_of(self.units, 0)
        self.axis = [words_of(self.axes, index) for index in range(axis_count)]
        self.reserve_segments(SEGMENTS_AT_START)

    def reserve_segments(self, count: int) -> bool:
        """Make room for `count` segments per axis, keeping those present; True if the table moved."""
        if count <= self.capacity:
            return False
        capacity = max(count, 2 * self.capacity)
        axis_count = len(self.axes)
        table = np.zeros((axis_count, capacity), SEGMENT)
        table[:, : self.capacity] = self.segments.reshape(axis_count, self.capacity)
        self.segments, self.capacity = table.reshape(-1), capacity
        self.axes["first_segment"] = np.arange(axis_count) * capacity
        self.units["segment_capacity"] = capacity
        return True

    def store_segments(self, axis_index: int, segments: Sequence[Segment]) -> None:
        """Write an axis's profile into the segment table; there must be room for it."""
        start_s = 0.0
        first = axis_index * self.capacity
        for row, segment in enumerate(segments, start=first):
            self.segments[row] = (start_s, *segment[1:])
            start_s += segment.duration_s

    def snapshot(self) -> bytes:
        """Every byte of the state, equal for equal states."""
        return b"".join(array.tobytes() for array in (self.units, self.axes, self.watches, self.segments))

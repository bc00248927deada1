"""One unit's servo state in memory: the arrays the kernel works on and cheap windows on their single words.

Reading a field of a structured array through numpy costs a microsecond; through a memory view of its words it costs
a tenth of that and gives a plain Python number, which matters where a host polls positions tens of thousands of times
a second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .kernels import Records
from .layout import AXIS, PLANT, RATIO, SCOPE, SEGMENT, UNIT, WATCH, WORD_BYTES, places_of
from .profile import Segment
from .ratio_rows import RatioRow
from .scope import NO_WORD, SCOPE_OFF, ScopeArrays
from .watches import WATCH_SLOTS

SEGMENTS_AT_START = 16
RATIOS_AT_START = 8

SEGMENT_BANKS = 2
"""Rows of segments an axis has: those of its profile, and those of its phase shift."""


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


def _widened(table: Records, groups: int, capacity: int) -> Records:
    """A table of `groups` times `capacity` rows with the rows of a narrower one in their places."""
    wide = np.zeros((groups, capacity), table.dtype)
    narrow = table.reshape(groups, -1)
    wide[:, : narrow.shape[1]] = narrow
    return wide.reshape(-1)


class Memory:
    """The arrays of one unit with `axis_count` axes.

    Of each axis there are two plant records: for the part of a servo sample before the output computed at its beginning
    reaches the terminals, and for the rest.
    """

    def __init__(self, axis_count: int) -> None:
        self.units: Records = np.zeros(1, UNIT)
        self.axes: Records = np.zeros(axis_count, AXIS)
        self.plants: Records = np.zeros(2 * axis_count, PLANT)
        self.watches: Records = np.zeros(WATCH_SLOTS, WATCH)
        self.segments: Records = np.zeros(0, SEGMENT)
        self.ratios: Records = np.zeros(0, RATIO)
        self.scopes: Records = np.zeros(1, SCOPE)
        self.channels = np.array([NO_WORD], np.int64)
        self.unit_channels = np.array([NO_WORD], np.int64)
        self.ring = np.zeros(0, np.int64)
        self.capacity = self.ratio_capacity = 0
        self.unit = words_of(self.units, 0)
        self.axis = [words_of(self.axes, index) for index in range(axis_count)]
        self.plant = [words_of(self.plants, index) for index in range(2 * axis_count)]
        self.scope = words_of(self.scopes, 0)
        self.reserve_segments(SEGMENTS_AT_START)
        self.reserve_ratios(RATIOS_AT_START)

    def reserve_segments(self, count: int) -> bool:
        """Make room for `count` segments per axis and bank, keeping those present; True if the table moved."""
        if count <= self.capacity:
            return False
        capacity = max(count, 2 * self.capacity)
        axis_count = len(self.axes)
        self.segments = _widened(self.segments, SEGMENT_BANKS * axis_count, capacity)
        self.capacity = capacity
        first = np.arange(SEGMENT_BANKS * axis_count) * capacity
        self.axes["first_segment"], self.axes["first_shift_segment"] = first[:axis_count], first[axis_count:]
        self.units["segment_capacity"] = capacity
        return True

    def store_segments(
        self, axis_index: int, segments: Sequence[Segment], *, start_s: float = 0.0, shift: bool = False
    ) -> None:
        """Write an axis's profile, or its phase shift, into the segment table, the first row beginning at `start_s`;
        there must be room for it."""
        first = int(self.axes["first_shift_segment" if shift else "first_segment"][axis_index])
        for row, segment in enumerate(segments, start=first):
            self.segments[row] = (start_s, *segment[1:])
            start_s += segment.duration_s

    def reserve_ratios(self, count: int) -> bool:
        """Make room for `count` pieces of a ratio profile per axis, keeping those present; True if the table moved."""
        if count <= self.ratio_capacity:
            return False
        capacity = max(count, 2 * self.ratio_capacity)
        axis_count = len(self.axes)
        self.ratios = _widened(self.ratios, axis_count, capacity)
        self.ratio_capacity = capacity
        self.axes["first_ratio"] = np.arange(axis_count) * capacity
        self.units["ratio_capacity"] = capacity
        return True

    def store_ratios(self, axis_index: int, rows: Sequence[RatioRow]) -> None:
        """Write an axis's ratio profile into its table; there must be room for it."""
        first = axis_index * self.ratio_capacity
        for place, row in enumerate(rows, start=first):
            self.ratios[place] = tuple(row)

    def reserve_scope(self, channels: Sequence[int], unit_channels: Sequence[int], rows: int) -> None:
        """A ring of `rows` rows for these words of the axis records and of the unit's, in place of the old one."""
        self.channels = np.array([*channels, NO_WORD], np.int64)
        self.unit_channels = np.array([*unit_channels, NO_WORD], np.int64)
        self.ring = np.zeros(rows * (len(channels) + len(unit_channels)), np.int64)
        fields = {"axis_channels": len(channels), "unit_channels": len(unit_channels), "rows": rows, "next_word": 0}
        write_fields(self.scope, SCOPE, {"state": SCOPE_OFF, **fields})

    def scope_arrays(self) -> ScopeArrays:
        """What the scope works on, as the interpreted kernel takes it."""
        return ScopeArrays(
            self.scopes,
            self.channels,
            self.unit_channels,
            self.units.view(np.int64),
            self.units.view(np.float64),
            self.axes.view(np.int64),
            self.axes.view(np.float64),
            self.ring,
        )

    def addresses(self) -> npt.NDArray[np.uintp]:
        """Where the arrays lie, in the order in which the compiled kernel expects them."""
        arrays = (
            self.units,
            self.axes,
            self.plants,
            self.segments,
            self.watches,
            self.scopes,
            self.channels,
            self.unit_channels,
            self.ring,
            self.ratios,
        )
        return np.array([array.ctypes.data for array in arrays], np.uintp)

    def replicate(self, count: int) -> Memory:
        """Memory of `count` units, each in this one's state, with one set of profiles and one of watches."""
        copy = Memory(len(self.axes))
        copy.units, copy.axes = np.tile(self.units, count), np.tile(self.axes, count)
        copy.plants, copy.scopes = np.tile(self.plants, count), np.tile(self.scopes, count)
        copy.ring = np.tile(self.ring, count)
        copy.segments, copy.watches, copy.channels = self.segments.copy(), self.watches.copy(), self.channels.copy()
        copy.unit_channels = self.unit_channels.copy()
        copy.ratios = self.ratios.copy()
        copy.capacity, copy.ratio_capacity = self.capacity, self.ratio_capacity
        return copy

    def snapshot(self) -> bytes:
        """Every byte of the servo's state, equal for equal states; the scope only looks on and does not count."""
        arrays = (self.units, self.axes, self.plants, self.watches, self.segments, self.ratios)
        return b"".join(array.tobytes() for array in arrays)

"""The scope as Python sees it: which signals it is to record, when, and the recording as arrays.

A signal is made of the words of a record: one field, a field less another (a reported position is raw less offset), or
some bits of a field. The ring keeps the words as they are; the arithmetic is done on whole columns afterwards.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .events import Relation
from .layout import AXIS, SCOPE, UNIT, WORD_BYTES, places_of, word_of
from .memory import Memory, write_fields
from .scope import NO_WORD, SCOPE_OFF, SCOPE_WAITING

MAX_RING_WORDS = 1 << 25
"""Largest ring, 8-byte words (256 MB; design choice): at two axes' servo rate a channel for two and a half hours."""

AXIS_WORDS = AXIS.itemsize // WORD_BYTES
_NEXT_SAMPLE, _SERVO = word_of(UNIT, "next_sample_ns"), word_of(UNIT, "servo_ns")
_TO_ROW, _ROWS_WRITTEN = word_of(SCOPE, "samples_to_row"), word_of(SCOPE, "rows_written")

Column = npt.NDArray[np.int64] | npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Source:
    """What a signal is made of: `field`, less `minus` if given; with a `mask`, whether any of its bits is set.

    `axis_index` is None for a field of the unit's record. Only integer fields have a `minus` or a `mask`.
    """

    field: str
    axis_index: int | None = None
    minus: str | None = None
    mask: int = 0

    @property
    def is_float(self) -> bool:
        """The field is a float."""
        return not self._places[self.field][1]

    @property
    def _places(self) -> dict[str, tuple[int, bool]]:
        return places_of(UNIT if self.axis_index is None else AXIS)

    def words(self) -> tuple[int, ...]:
        """The numbers of its words, in the unit's record or counted through the axes'; KeyError for an unknown field,
        ValueError for arithmetic on a float."""
        if self.is_float and (self.minus is not None or self.mask):
            raise ValueError(f"{self.field} is a float: neither minus nor mask")
        first = 0 if self.axis_index is None else self.axis_index * AXIS_WORDS
        return tuple(first + self._places[name][0] for name in (self.field, self.minus) if name is not None)


@dataclass(frozen=True, slots=True)
class Trigger:
    """When to trigger: as soon as `source relation threshold` comes to hold."""

    source: Source
    relation: Relation
    threshold: float

    def fields(self) -> dict[str, float]:
        """Fields of the scope's record."""
        word, *minus = self.source.words()
        return {
            "trigger_on": 1,
            "trigger_unit": self.source.axis_index is None,
            "trigger_word": word,
            "trigger_minus": minus[0] if minus else NO_WORD,
            "trigger_mask": self.source.mask,
            "trigger_is_float": self.source.is_float,
            "trigger_relation": self.relation,
            "trigger_threshold": self.threshold,
            "trigger_held": 0,
        }


@dataclass(frozen=True, slots=True)
class Trace:
    """A recording: the times of its rows (ns), a column a source, and the row of the trigger (None: not triggered)."""

    times_ns: npt.NDArray[np.int64]
    columns: tuple[Column, ...]
    trigger_row: int | None
    complete: bool


class Layout(NamedTuple):
    """Which words a row of the ring holds."""

    sources: tuple[Source, ...]
    axis_words: tuple[int, ...]
    unit_words: tuple[int, ...]

    @classmethod
    def of(cls, sources: Sequence[Source]) -> Layout:
        """Each word once, however many sources are made of it."""
        axis = {word for source in sources if source.axis_index is not None for word in source.words()}
        unit = {word for source in sources if source.axis_index is None for word in source.words()}
        return cls(tuple(sources), tuple(sorted(axis)), tuple(sorted(unit)))

    @property
    def width(self) -> int:
        """Words in a row."""
        return len(self.axis_words) + len(self.unit_words)

    def column(self, source: Source, table: npt.NDArray[np.int64]) -> Column:
        """A source's values over the rows of `table`: floats, integers, or 0 and 1 for a mask."""
        words = [table[:, self._place(source, word)] for word in source.words()]
        if source.mask:
            return ((words[0] & source.mask) != 0).astype(np.int64)
        if source.is_float:
            return np.ascontiguousarray(words[0]).view(np.float64)
        return words[0] - words[1] if len(words) > 1 else words[0].copy()

    def _place(self, source: Source, word: int) -> int:
        if source.axis_index is None:
            return len(self.axis_words) + self.unit_words.index(word)
        return self.axis_words.index(word)


class _Span(NamedTuple):
    """Rows written at one rate: the count of rows before it, the time of its first row, the time between rows."""

    first_row: int
    first_ns: int
    period_ns: int


class Scope:
    """The scope of one unit. Off until armed."""

    def __init__(self, memory: Memory, rebind: Callable[[], None]) -> None:
        self._memory = memory
        self._rebind = rebind
        self._every = 1
        self._spans: list[_Span] = []
        self.layout: Layout | None = None
        """What is recorded; None before the first arming."""

    def arm(
        self,
        sources: Sequence[Source],
        *,
        rows: int,
        pre_trigger_rows: int = 0,
        every: int = 1,
        trigger: Trigger | None = None,
    ) -> None:
        """Record `sources` into a ring of `rows` rows, one row every `every` servo samples.

        Without a trigger recording begins at once and ends with the ring full; with one, `pre_trigger_rows` of the rows
        lie before it. ValueError for numbers that cannot be, KeyError for an unknown field.
        """
        layout = Layout.of(sources)
        _check(rows, max(1, layout.width), pre_trigger_rows, every)
        self.layout, self._every = layout, every
        self._memory.reserve_scope(layout.axis_words, layout.unit_words, rows)
        self._rebind()
        fields = {
            "rows_written": 0,
            "rows_to_go": rows - pre_trigger_rows,
            "pre_trigger_rows": pre_trigger_rows,
            "trigger_row": 0,
            "every": every,
            "samples_to_row": every,
            "wants_status": any(
                source.field in ("status", "following_status")
                for source in (*sources, *([trigger.source] if trigger else []))
            ),
            "trigger_on": 0,
            **(trigger.fields() if trigger is not None else {}),
            "state": SCOPE_WAITING,
        }
        write_fields(self._memory.scope, SCOPE, fields)
        self._spans = []
        self.note_rates()

    def stop(self) -> None:
        """Record no more; what has been recorded stays."""
        write_fields(self._memory.scope, SCOPE, {"state": SCOPE_OFF})

    def note_rates(self) -> None:
        """The servo rate, or the grid of samples, has changed: rows to come have other times."""
        if self.layout is None:
            return
        unit, scope = self._memory.unit.ints, self._memory.scope.ints
        first_ns = unit[_NEXT_SAMPLE] + (scope[_TO_ROW] - 1) * unit[_SERVO]
        self._spans.append(_Span(scope[_ROWS_WRITTEN], first_ns, self._every * unit[_SERVO]))

    @property
    def running(self) -> bool:
        """Armed and not yet full."""
        return bool(self._memory.scopes["state"][0] != SCOPE_OFF)

    @property
    def triggered(self) -> bool:
        """The trigger has acted."""
        return _has_triggered(self._memory.scopes[0])

    def read(self) -> Trace:
        """What has been recorded, oldest row first; ValueError if the scope was never armed."""
        if self.layout is None:
            raise ValueError("the scope has not been armed")
        record = self._memory.scopes[0]
        rows, written = int(record["rows"]), int(record["rows_written"])
        lost = max(0, written - rows)
        table = self._memory.ring.reshape(rows, -1)
        if lost:
            table = np.roll(table, -(written % rows), axis=0)
        columns = tuple(self.layout.column(source, table[:written]) for source in self.layout.sources)
        trigger_row = int(record["trigger_row"]) - lost if _has_triggered(record) else None
        return Trace(self.times_ns(written)[lost:], columns, trigger_row, int(record["rows_to_go"]) == 0)

    def times_ns(self, rows: int) -> npt.NDArray[np.int64]:
        """The times of the first `rows` rows written since arming, those that the ring has lost included."""
        ends = [span.first_row for span in self._spans[1:]] + [rows]
        parts: list[Any] = [
            span.first_ns + span.period_ns * np.arange(max(0, end - span.first_row), dtype=np.int64)
            for span, end in zip(self._spans, ends, strict=True)
        ]
        return np.concatenate(parts)


def most_rows(sources: Sequence[Source]) -> int:
    """Rows of the largest ring for these sources; memory is taken up only as they are written."""
    return MAX_RING_WORDS // max(1, Layout.of(sources).width)


def _check(rows: int, width: int, pre_trigger_rows: int, every: int) -> None:
    if every < 1:
        raise ValueError(f"one row every {every} samples is not possible")
    if not 1 <= rows <= MAX_RING_WORDS // width:
        raise ValueError(f"{rows} rows of {width} words: 1 to {MAX_RING_WORDS // width} are possible")
    if not 0 <= pre_trigger_rows < rows:
        raise ValueError(f"{pre_trigger_rows} rows before the trigger: 0 to {rows - 1} are possible")


def _has_triggered(record: np.void) -> bool:
    return bool(record["rows_to_go"] < record["rows"] - record["pre_trigger_rows"])

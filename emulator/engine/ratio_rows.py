"""A ratio profile as the kernel takes it: exact rationals cut into 64-bit integers.

A piece of constant ratio is added up in whole master counts, in units of one over its denominator, from the first whole
master count it holds; nothing is rounded and nothing drifts, however far the master goes and however often it turns. A
ramp is evaluated in floating point from its exact beginning, so that its rounding ends with it.

The denominator of a piece is the common one of its ratio, its place, and the place the slave began from. Where that
grows beyond `FINEST` the places are rounded to the nearest multiple of what still fits, the ratio never: an error below
2**-51 counts where a move begins, which does not grow as the master goes on.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from enum import IntEnum
from fractions import Fraction
from typing import NamedTuple

from .ratio_profile import ZERO, RatioSegment

FINEST = 1 << 52
"""Largest denominator of a piece (design choice): its parts of a count are whole floating-point numbers."""

LARGEST_SUM = 1 << 62


class RowKind(IntEnum):
    """What a row of the kernel's table is."""

    PIECE = 0
    HOLD = 1
    ENDLESS = 2
    END = 3


class RatioRow(NamedTuple):
    """One row of the kernel's table of ratios, in the order of `layout.RATIO_FIELDS`."""

    kind: int
    master: int
    master_part: float
    slave: int
    slave_part: int
    base_part: int
    denominator: int
    most_master: int
    ratio_counts: int
    ratio_part: int
    ratio: float
    slope: float


def rows_of(
    segments: Sequence[RatioSegment], *, base_part: Fraction, hold_ratio: Fraction | None
) -> tuple[RatioRow, ...]:
    """The rows of a profile that begins with the slave at a whole count and `base_part` of one (0 to 1).

    `hold_ratio` is the ratio kept before the beginning; None for a profile that runs from there in either direction.
    """
    before = [] if hold_ratio is None else [_constant(RowKind.HOLD, hold_ratio, ZERO, ZERO, base_part)]
    return (*before, *_rows(segments, base_part))


def _rows(segments: Sequence[RatioSegment], base_part: Fraction) -> Iterator[RatioRow]:
    master = slave = ZERO
    for segment in segments:
        if segment.master is None:
            yield _constant(RowKind.ENDLESS, segment.end_ratio, master, slave, base_part)
            return
        if segment.start_ratio == segment.end_ratio:
            yield _constant(RowKind.PIECE, segment.start_ratio, master, slave, base_part)
        else:
            yield _ramp(segment, segment.master, master, slave, base_part)
        master += segment.master
        slave += segment.slave
    yield _constant(RowKind.END, ZERO, master, slave, base_part)


def _constant(kind: RowKind, ratio: Fraction, master: Fraction, slave: Fraction, base: Fraction) -> RatioRow:
    """A piece of constant ratio, its slave travel given at its first whole master count."""
    first = math.ceil(master)
    return _row(kind, ratio, ratio, first, master, slave + ratio * (first - master), base, 0.0)


def _ramp(segment: RatioSegment, length: Fraction, master: Fraction, slave: Fraction, base: Fraction) -> RatioRow:
    slope = float((segment.end_ratio - segment.start_ratio) / length)
    return _row(RowKind.PIECE, ZERO, segment.start_ratio, math.ceil(master), master, slave, base, slope)


def _row(
    kind: RowKind,
    step: Fraction,
    ratio: Fraction,
    first: int,
    master: Fraction,
    slave: Fraction,
    base: Fraction,
    slope: float,
) -> RatioRow:
    if step.denominator > FINEST:
        step = step.limit_denominator(FINEST)
    denominator = _denominator(step, slave, base)
    counts, part = divmod(round(slave * denominator), denominator)
    ratio_counts, ratio_part = divmod(int(step * denominator), denominator)
    return RatioRow(
        kind,
        first,
        float(master - first),
        counts,
        part,
        round(base * denominator),
        denominator,
        LARGEST_SUM // denominator,
        ratio_counts,
        ratio_part,
        float(ratio),
        slope,
    )


def _denominator(ratio: Fraction, *places: Fraction) -> int:
    """Common denominator of a ratio and of places; within FINEST that of the ratio, as fine as fits."""
    common = math.lcm(ratio.denominator, *(place.denominator for place in places))
    return common if common <= FINEST else FINEST // ratio.denominator * ratio.denominator

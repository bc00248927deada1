"""Ratio profiles cut into 64-bit integers: exact where they fit, and the bound where they do not."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from emulator.engine.ratio_profile import RatioSegment, plan_ratio_change
from emulator.engine.ratio_rows import FINEST, RatioRow, RowKind, rows_of

ratios = st.builds(Fraction, st.integers(-(10**15), 10**15), st.integers(1, 10**15)).filter(lambda r: 0 < abs(r) <= 127)
parts = st.builds(Fraction, st.integers(0, 10**12), st.just(10**12 + 39))


def ratio_of(row: RatioRow) -> Fraction:
    return row.ratio_counts + Fraction(row.ratio_part, row.denominator)


def start_of(row: RatioRow) -> Fraction:
    return row.slave + Fraction(row.slave_part, row.denominator)


@given(ratios, parts)
def test_ratios_are_never_rounded_and_places_below_the_bound(ratio: Fraction, base: Fraction) -> None:
    hold, ramp, endless = rows_of(plan_ratio_change(Fraction(0), ratio, 1000), base_part=base, hold_ratio=Fraction(0))
    assert [row.kind for row in (hold, ramp, endless)] == [RowKind.HOLD, RowKind.PIECE, RowKind.ENDLESS]
    assert ratio_of(endless) == ratio
    assert endless.master == 1000
    bound = Fraction(1, 2**51)
    assert abs(start_of(endless) - 500 * ratio) <= bound
    assert abs(Fraction(endless.base_part, endless.denominator) - base) <= bound
    for row in (hold, ramp, endless):
        assert row.denominator <= FINEST
        assert row.most_master * row.denominator < 2**63


def test_small_denominators_are_kept_whole() -> None:
    third = Fraction(1, 3)
    first, second = rows_of((RatioSegment(Fraction(10, 7), third, third),), base_part=Fraction(1, 4), hold_ratio=None)
    assert (first.kind, second.kind) == (RowKind.PIECE, RowKind.END)
    assert start_of(second) == Fraction(10, 21)
    assert second.master == 2
    assert Fraction(second.base_part, second.denominator) == Fraction(1, 4)

"""Ratios and master distances in counts, and the ratio a geared advance makes."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.controller.motion.following.advance import plan_advance
from emulator.controller.motion.following.ratio import ratio_counts, whole_counts
from emulator.controller.scaling import Quantity
from emulator.engine import plan_ratio_preset, ratio_at, slave_at
from tests.controller.session import Session


@pytest.mark.parametrize(
    ("value", "factor", "counts"), [("5", 25_000, 125_000), ("0.3", 25, 7), ("-0.3", 25, -7), ("1.2345", 800, 987)]
)
def test_scaled_distances_are_cut_to_whole_counts(value: str, factor: int, counts: int) -> None:
    assert whole_counts(Quantity(Decimal(value), factor)) == counts
    assert ratio_counts(Quantity(Decimal(value), factor)) == counts


def test_an_unscaled_side_of_a_ratio_is_kept() -> None:
    assert ratio_counts(Quantity(Decimal("2.5"), 1)) == Fraction(5, 2)


def test_a_side_never_entered_is_one_unit() -> None:
    """FOLRD is 1 if it was never given, whatever SCLMAS is by then."""
    session = Session("", SCLMAS="4000,4000", SCLD="4000,4000")
    session.ok("SCALE1")
    assert session.query("FOLRD") == "FOLRD1,1"
    session.ok("FOLRN2")
    assert session.query("FOLRN") == "FOLRN2,1"
    session.ok("SCALE0")
    assert session.query("FOLRN") == "FOLRN8000,1"


def test_unscaled_distances_have_the_range_of_the_reference() -> None:
    session = Session()
    session.ok("FOLMD999999999", "FOLRN999999999.99999", "FMCLEN999999999")
    assert session.error("FOLMD1000000000") == "INVALID DATA-FIELD 1"
    assert session.error("FOLRD0.5") == "INVALID DATA-FIELD 1"


@given(
    base=st.fractions(-10, 10, max_denominator=50),
    distance=st.integers(-500, 500),
    master=st.integers(500, 2000),
)
def test_an_advance_adds_its_distance_and_leaves_the_ratio(base: Fraction, distance: int, master: int) -> None:
    segments = plan_advance(base, plan_ratio_preset(distance, master, Fraction(1)))
    assert slave_at(segments, master) == base * master + distance
    assert slave_at(segments, master + 1000) == base * (master + 1000) + distance
    assert ratio_at(segments, master) == base

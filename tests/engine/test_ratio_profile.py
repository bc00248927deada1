"""The planner of Following against the equations of ramp geometry, in exact rationals."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.engine.ratio_profile import (
    DistanceMismatch,
    RatioSegment,
    master_travel,
    plan_ratio_change,
    plan_ratio_preset,
    ratio_at,
    slave_at,
)

ratios = st.builds(Fraction, st.integers(1, 500_000), st.integers(1, 99_999))
distances = st.integers(1, 10**9)


@pytest.mark.parametrize(
    ("distance", "master_distance", "ratio", "pieces"),
    [
        (8000, 10_000, 1, [(2000, 1000), (6000, 6000), (2000, 1000)]),
        (25_000, 10_000, 3, [(Fraction(5000, 3), 2500), (Fraction(20_000, 3), 20_000), (Fraction(5000, 3), 2500)]),
        (5000, 10_000, 1, [(5000, 2500), (5000, 2500)]),
        (3000, 10_000, 1, [(5000, 1500), (5000, 1500)]),
        (10_000, 10_000, 1, [(10_000, 10_000)]),
    ],
    ids=["trapezoid", "steep trapezoid", "limit case", "triangle", "rectangle"],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_geometry_of_preset_moves(
    distance: int, master_distance: int, ratio: int, pieces: list[tuple[Fraction, int]], sign: int
) -> None:
    plan = plan_ratio_preset(sign * distance, master_distance, Fraction(ratio))
    assert [(segment.master, sign * segment.slave) for segment in plan] == pieces


def test_a_triangle_peaks_at_twice_the_mean_ratio() -> None:
    assert plan_ratio_preset(3000, 10_000, Fraction(1))[0].end_ratio == Fraction(6, 10)


def test_more_than_the_ratio_allows_is_a_mismatch() -> None:
    with pytest.raises(DistanceMismatch, match="12000 slave counts over 10000 master counts"):
        plan_ratio_preset(12_000, 10_000, Fraction(1))
    with pytest.raises(DistanceMismatch):
        plan_ratio_preset(-1, 0, Fraction(127))


@pytest.mark.parametrize(
    ("start", "goal", "master_distance", "slave"),
    [(0, 1, 4000, 2000), (1, 3, 10_000, 20_000), (2, Fraction(1, 2), 8000, 10_000), (3, 0, 5000, 7500)],
)
def test_slave_travel_in_a_ramp(start: Fraction, goal: Fraction, master_distance: int, slave: int) -> None:
    plan = plan_ratio_change(Fraction(start), Fraction(goal), master_distance)
    assert slave_at(plan, master_distance) == slave
    assert ratio_at(plan, master_distance // 2) == Fraction(start + goal) / 2
    assert ratio_at(plan, master_distance) == goal


def test_a_ramp_to_zero_ends_and_one_to_a_ratio_does_not() -> None:
    assert master_travel(plan_ratio_change(Fraction(3), Fraction(0), 5000)) == 5000
    assert master_travel(plan_ratio_change(Fraction(0), Fraction(3), 5000)) is None


def test_no_master_distance_steps_the_ratio() -> None:
    ratio = Fraction(125, 12)
    assert plan_ratio_change(Fraction(0), ratio, 0) == (RatioSegment(None, ratio, ratio),)
    assert plan_ratio_change(ratio, Fraction(0), 0) == ()


def test_nothing_to_cover_needs_no_segments() -> None:
    assert plan_ratio_preset(0, 1000, Fraction(1)) == ()


def test_an_endless_segment_has_no_whole_travel() -> None:
    with pytest.raises(ValueError, match="endless"):
        _ = RatioSegment(None, Fraction(1), Fraction(1)).slave


@given(distances, distances, ratios, st.sampled_from([1, -1]))
def test_preset_moves_are_exact_and_symmetric(travel: int, master_distance: int, ratio: Fraction, sign: int) -> None:
    if travel > master_distance * ratio:
        with pytest.raises(DistanceMismatch):
            plan_ratio_preset(sign * travel, master_distance, ratio)
        return
    plan = plan_ratio_preset(sign * travel, master_distance, ratio)
    assert master_travel(plan) == master_distance
    assert slave_at(plan, master_distance) == sign * travel
    assert slave_at(plan, Fraction(master_distance, 2)) == Fraction(sign * travel, 2)
    assert all(abs(segment.end_ratio) <= ratio and abs(segment.start_ratio) <= ratio for segment in plan)
    assert slave_at(plan, master_distance + 1) == sign * travel
    assert slave_at(plan, -1) == 0


@given(ratios, ratios, distances, st.integers(0, 10**9))
def test_ramps_join_without_a_gap(start: Fraction, goal: Fraction, master_distance: int, beyond: int) -> None:
    plan = plan_ratio_change(start, goal, master_distance)
    assert slave_at(plan, master_distance + beyond) == master_distance * (start + goal) / 2 + beyond * goal

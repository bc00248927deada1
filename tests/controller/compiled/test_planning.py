"""The pure planning of compiled segments: ratios over master travel, and loops planned pass by pass."""

from __future__ import annotations

from fractions import Fraction
from itertools import islice, pairwise

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from emulator.controller.compiled.blending import Blended, CannotBlend, TimedMove, blend
from emulator.controller.compiled.loops import Loop, Unsteady, pieces_of, plan_loop
from emulator.controller.compiled.ratio_blending import RatioMove, blend_ratio
from emulator.engine.ratio_profile import DistanceMismatch
from emulator.engine.streaming import PARTS_PER_COUNT, TICKS_PER_S

SYSTEM_S = 2.24e-3
ratios = st.fractions(0, 127, max_denominator=1000)


@settings(deadline=None)
@given(ratios, ratios, st.fractions(0, 1), st.integers(1, 100_000), st.sampled_from([1, -1]))
def test_a_preset_segment_covers_its_distance_between_its_ratios(
    start: Fraction, goal: Fraction, share: Fraction, length: int, sign: int
) -> None:
    assume(0 < share < 1)
    distance = (start + share * (goal - start)) * length
    segments, leaving = blend_ratio(RatioMove(sign * distance, sign * goal, length), sign * start)
    assert sum(segment.slave for segment in segments) == sign * distance
    assert sum(segment.master or 0 for segment in segments) == length
    assert leaving == sign * goal
    assert segments[0].start_ratio == sign * start
    assert segments[-1].end_ratio == sign * goal
    for before, after in pairwise(segments):
        assert before.end_ratio == after.start_ratio


@given(ratios, ratios, st.integers(1, 1000), st.fractions(0, 10).filter(bool), st.booleans())
def test_a_distance_outside_is_refused(
    start: Fraction, goal: Fraction, length: int, beyond: Fraction, above: bool
) -> None:
    low, high = sorted((start * length, goal * length))
    distance = high + beyond if above else low - beyond
    with pytest.raises(DistanceMismatch):
        blend_ratio(RatioMove(distance, goal, length), start)


velocities = st.floats(1000.0, 500_000.0)
rates = st.floats(1000.0, 5e6)


@given(velocities, velocities, rates, rates, st.integers(1, 5_000_000), st.booleans(), st.sampled_from([1, -1]))
def test_a_segment_in_time_covers_its_distance(
    entry: float, velocity: float, up: float, down: float, distance: int, rests: bool, sign: int
) -> None:
    move = TimedMove(float(sign * distance), sign * velocity, up, down, up, down, rests)
    try:
        pieces, leaving = blend(move, sign * entry, system_s=SYSTEM_S)
    except CannotBlend:
        assert rests
        assert entry**2 / (2 * down) > distance * 0.999
        return
    assert sum(piece.displacement for piece in pieces) == sign * distance * PARTS_PER_COUNT
    assert leaving == 0.0 if rests else leaving * sign > 0
    assert sign * leaving <= max(entry, velocity) * (1 + 1e-12)
    mean = distance / (sum(piece.duration for piece in pieces) / TICKS_PER_S)
    assert mean <= max(entry, velocity) * (1 + 1e-6)


def test_a_continuous_segment_is_its_ramp_alone() -> None:
    blended = blend(TimedMove(None, 4000.0, 40_000.0, 40_000.0, 40_000.0, 40_000.0), 0.0, system_s=SYSTEM_S)
    (ramp,) = blended.pieces
    assert ramp.duration == pytest.approx(0.1 * TICKS_PER_S)
    assert ramp.displacement == pytest.approx(200 * PARTS_PER_COUNT)
    assert blended.exit_velocity == 4000.0
    assert blend(TimedMove(None, 4000.0, 1.0, 1.0, 1.0, 1.0), 4000.0, system_s=SYSTEM_S) == Blended((), 4000.0)


class Adder:
    """A planner of toy segments: a segment adds to the speed, up to ten, and its piece is the pair of speeds."""

    def plan(self, move: int, entry: float) -> tuple[tuple[tuple[float, float], ...], float]:
        leaving = min(10.0, entry + move)
        return ((entry, leaving),), leaving

    def travel(self, pieces: tuple[tuple[float, float], ...]) -> Fraction:
        return Fraction(sum(after for _, after in pieces))

    def lasts(self, piece: tuple[float, float]) -> bool:
        return True


@given(st.integers(3, 12), st.integers(1, 9))
def test_a_loop_is_what_its_passes_are_one_by_one(step: int, passes: int) -> None:
    assume(10 / step <= 4)
    planned, leaving = plan_loop(Adder(), Loop(passes, [step]), 0.0)
    speed, expected = 0.0, []
    for _ in range(passes):
        expected.append((speed, min(10.0, speed + step)))
        speed = min(10.0, speed + step)
    assert list(pieces_of([planned])) == expected
    assert leaving == speed
    assert planned.travel == sum(after for _, after in expected)


def test_a_thousand_million_passes_are_not_unrolled() -> None:
    planned, leaving = plan_loop(Adder(), Loop(10**9, [10, Loop(2, [10])]), 0.0)
    assert leaving == 10.0
    assert planned.travel == 30 * 10**9
    assert list(islice(pieces_of([planned]), 4)) == [(0.0, 10.0), *[(10.0, 10.0)] * 3]


def test_an_endless_loop_inside_another_never_comes_back() -> None:
    planned, _ = plan_loop(Adder(), Loop(3, [10, Loop(None, [0]), 5]), 0.0)
    assert planned.endless
    assert list(islice(pieces_of([planned]), 3)) == [(0.0, 10.0), (10.0, 10.0), (10.0, 10.0)]


def test_a_loop_that_never_repeats_itself_is_refused() -> None:
    with pytest.raises(Unsteady):
        plan_loop(Adder(), Loop(100, [1]), 0.0)

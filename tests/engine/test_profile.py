"""The planner against the equations of motion; vectors in revolutions at 4000 counts/rev."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from emulator.engine import (
    InvalidSCurve,
    Segments,
    TargetOvershot,
    evaluate,
    plan_continuous,
    plan_preset,
    plan_stop,
    profile_duration,
)
from emulator.engine.profile import segment_state

COUNTS = 4000.0

positions = st.integers(-10_000_000, 10_000_000).map(float)
velocities = st.floats(1.0, 800_000.0)
accelerations = st.floats(10.0, 1e8)
shares = st.floats(0.5, 1.0)


def peak_velocity(segments: Segments) -> float:
    return max(abs(segment_state(s, t).velocity) for s in segments for t in (0.0, s.duration_s) if math.isfinite(t))


def check_continuous(segments: Segments, scale: float) -> None:
    """Position and velocity join from one segment to the next."""
    for before, after in pairwise(segments):
        end = segment_state(before, before.duration_s)
        assert end.position == pytest.approx(after.position, rel=1e-9, abs=1e-6 * max(1.0, scale))
        assert end.velocity == pytest.approx(after.velocity, rel=1e-6, abs=1e-6 * max(1.0, peak_velocity(segments)))


def check_limits(segments: Segments, velocity: float, up: float, down: float) -> None:
    """Nowhere faster than allowed, nowhere steeper; cubic pieces have their extremes at their ends."""
    for segment in segments:
        for t in (0.0, segment.duration_s if math.isfinite(segment.duration_s) else 0.0):
            state = segment_state(segment, t)
            limit = up if state.acceleration * (state.velocity or segment.velocity) > 0 else down
            assert abs(state.velocity) <= velocity * (1 + 1e-9) + 1e-6
            assert abs(state.acceleration) <= max(up, down) * (1 + 1e-9)
            if state.velocity != 0.0 and abs(state.velocity) > 1e-3 * velocity:
                assert abs(state.acceleration) <= limit * (1 + 1e-6)


@pytest.mark.parametrize(
    ("distance", "velocity", "acceleration", "deceleration", "peak", "duration_s"),
    [
        (25, 1, 10, 10, 1, 25.1),
        (6.25, 1, 10, 10, 1, 6.35),
        (1, 10, 10, 10, math.sqrt(10), 0.4 * math.sqrt(2.5)),
        (10, 5, 25, 20, 5, 2.225),
        (8, 10, 100, 50, 10, 0.95),
        (1, 2, 10, 5, 2, 0.8),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_trapezoid_and_triangle_vectors(
    distance: float,
    velocity: float,
    acceleration: float,
    deceleration: float,
    peak: float,
    duration_s: float,
    sign: int,
) -> None:
    segments = plan_preset(
        0.0, 0.0, sign * distance * COUNTS, velocity * COUNTS, acceleration * COUNTS, deceleration * COUNTS
    )
    assert profile_duration(segments) == pytest.approx(duration_s, rel=1e-12)
    assert peak_velocity(segments) == pytest.approx(peak * COUNTS, rel=1e-12)
    assert evaluate(segments, math.inf) == (sign * distance * COUNTS, 0.0, 0.0)


@pytest.mark.parametrize(
    ("velocity", "maximum", "average", "ramp_s", "jerk_s", "constant_s", "jerk", "distance"),
    [
        (5, 10, 5, 1.0, 0.5, 0.0, 20, 2.5),
        (5, 10, 7.5, 2 / 3, 1 / 6, 1 / 3, 60, 5 / 3),
        (1, 10, 5, 0.2, 0.1, 0.0, 100, 0.1),
        (10, 100, 75, 2 / 15, 1 / 30, 1 / 15, 3000, 2 / 3),
        (20, 40, 30, 2 / 3, 1 / 6, 1 / 3, 240, 20 / 3),
    ],
)
def test_s_curve_ramp_vectors(
    velocity: float,
    maximum: float,
    average: float,
    ramp_s: float,
    jerk_s: float,
    constant_s: float,
    jerk: float,
    distance: float,
) -> None:
    *ramp, cruise = plan_continuous(0.0, 0.0, velocity, maximum, maximum, average)
    assert sum(piece.duration_s for piece in ramp) == pytest.approx(ramp_s, rel=1e-12)
    assert ramp[0].duration_s == ramp[-1].duration_s == pytest.approx(jerk_s, rel=1e-12)
    assert sum(piece.duration_s for piece in ramp[1:-1]) == pytest.approx(constant_s, abs=1e-12)
    assert (ramp[0].jerk, ramp[-1].jerk) == pytest.approx((jerk, -jerk), rel=1e-12)
    assert cruise.position == pytest.approx(distance, rel=1e-12)
    assert (cruise.velocity, cruise.duration_s) == (pytest.approx(velocity), math.inf)


def test_a_short_s_curve_move_keeps_its_accelerations_and_lowers_its_velocity() -> None:
    segments = plan_preset(0.0, 0.0, 1.0, 10.0, 10.0, 10.0, 7.5, 7.5)
    assert peak_velocity(segments) == pytest.approx(math.sqrt(7.5), rel=1e-12)
    assert max(abs(s.acceleration) for s in segments) == pytest.approx(10.0)
    assert profile_duration(segments) == pytest.approx(2 * math.sqrt(7.5) / 7.5, rel=1e-12)


@given(positions, positions, velocities, accelerations, accelerations, shares, shares)
def test_presets_end_where_and_when_the_equations_say(
    start: float, target: float, velocity: float, up: float, down: float, share_up: float, share_down: float
) -> None:
    assume(start != target)
    average_up, average_down = up * share_up, down * share_down
    segments = plan_preset(start, 0.0, target, velocity, up, down, average_up, average_down)
    distance = abs(target - start)
    needed = velocity**2 / (2 * average_up) + velocity**2 / (2 * average_down)
    if needed <= distance:
        expected_s = velocity / average_up + velocity / average_down + (distance - needed) / velocity
    else:
        peak = math.sqrt(2 * distance * average_up * average_down / (average_up + average_down))
        expected_s = peak / average_up + peak / average_down
    assert profile_duration(segments) == pytest.approx(expected_s, rel=1e-9)
    assert evaluate(segments, expected_s + 1.0).position == target
    check_continuous(segments, max(abs(start), abs(target)))
    check_limits(segments, velocity, up, down)


@given(positions, st.floats(-500_000, 500_000), positions, velocities, accelerations, accelerations, shares)
def test_a_new_target_in_motion_is_reached_or_refused(
    start: float, entry: float, target: float, velocity: float, up: float, down: float, share: float
) -> None:
    towards = entry * (target - start) >= 0.0 and (target != start or entry == 0.0)
    braking = entry**2 / (2 * down * share)
    assume(abs(braking - abs(target - start)) > 1e-3)
    if not towards or braking > abs(target - start):
        with pytest.raises(TargetOvershot):
            plan_preset(start, entry, target, velocity, up, down, up * share, down * share)
        return
    segments = plan_preset(start, entry, target, velocity, up, down, up * share, down * share)
    assert evaluate(segments, 0.0)[:2] == pytest.approx((start, entry), rel=1e-12, abs=1e-9)
    assert evaluate(segments, math.inf).position == target
    check_continuous(segments, max(abs(start), abs(target)))
    check_limits(segments, max(velocity, abs(entry)), up, down)


@given(positions, st.floats(-500_000, 500_000), st.floats(-500_000, 500_000), accelerations, accelerations, shares)
def test_continuous_moves_reach_their_velocity(
    start: float, entry: float, velocity: float, up: float, down: float, share: float
) -> None:
    segments = plan_continuous(start, entry, velocity, up, down, up * share, down * share)
    check_continuous(segments, abs(start))
    check_limits(segments, max(abs(velocity), abs(entry)), up, down)
    if velocity == 0.0:
        assert evaluate(segments, math.inf).velocity == 0.0
    else:
        assert (segments[-1].duration_s, segments[-1].acceleration) == (math.inf, 0.0)
        assert segments[-1].velocity == velocity


@given(positions, st.floats(-500_000, 500_000), accelerations, shares)
def test_a_stop_takes_the_braking_distance(start: float, entry: float, down: float, share: float) -> None:
    segments = plan_stop(start, entry, down, down * share)
    distance = math.copysign(entry**2 / (2 * down * share), entry)
    assert segments[-1].position - start == pytest.approx(distance, rel=1e-6, abs=1e-5)
    assert profile_duration(segments) == pytest.approx(abs(entry) / (down * share), rel=1e-9)


def test_a_lower_velocity_on_the_fly_slows_down_first() -> None:
    segments = plan_preset(0.0, 8000.0, 40000.0, 4000.0, 40000.0, 20000.0)
    assert segments[0].acceleration == -20000.0
    assert profile_duration(segments) == pytest.approx(0.2 + (40000 - 1200 - 400) / 4000 + 0.2)


def test_no_distance_is_a_profile_of_no_duration() -> None:
    segments = plan_preset(5.0, 0.0, 5.0, 1.0, 1.0, 1.0)
    assert profile_duration(segments) == 0.0
    assert evaluate(segments, 0.0) == (5.0, 0.0, 0.0)


@pytest.mark.parametrize("average", [4.9, 10.1])
def test_averages_outside_the_rule_are_refused(average: float) -> None:
    with pytest.raises(InvalidSCurve):
        plan_preset(0.0, 0.0, 1.0, 1.0, 10.0, 10.0, average)


@pytest.mark.parametrize("average", [None, 0.0, 10.0])
def test_averages_that_mean_no_s_curve(average: float | None) -> None:
    segments = plan_preset(0.0, 0.0, 10.0, 1.0, 10.0, 10.0, average, average)
    assert all(segment.jerk == 0.0 for segment in segments)


@pytest.mark.parametrize("bad", [0.0, -1.0, math.inf, math.nan])
def test_values_that_are_no_velocity_or_acceleration(bad: float) -> None:
    with pytest.raises(ValueError, match="above 0"):
        plan_preset(0.0, 0.0, 10.0, bad, 10.0, 10.0)
    with pytest.raises(ValueError, match="above 0"):
        plan_preset(0.0, 0.0, 10.0, 10.0, bad, 10.0)
    with pytest.raises(ValueError, match="above 0"):
        plan_stop(0.0, 10.0, bad)

"""The profile of a path's length: nowhere faster than allowed, nowhere steeper, as quick as that leaves it."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.controller.paths.speed import Stretch, plan_brake, plan_speed
from emulator.engine import Segment, Segments
from emulator.engine.profile import segment_state

stretches = st.lists(
    st.builds(Stretch, st.floats(0.5, 1e6), st.floats(10.0, 1e6), st.floats(100.0, 1e7), st.floats(100.0, 1e7)),
    min_size=1,
    max_size=8,
)


def end_of(segment: Segment) -> tuple[float, float]:
    position, velocity, _ = segment_state(segment, segment.duration_s)
    return position, velocity


def seconds(rows: tuple[Segments, ...]) -> float:
    return math.fsum(segment.duration_s for row in rows for segment in row)


@pytest.mark.parametrize(
    ("length", "velocity", "up", "down", "duration_s"),
    [
        # following-and-profiles 5.2 and 6.1: a path of one piece is a plain move of its length
        (5.0, 5, 50, 50, 1.1),
        (11.18034, 5, 25, 20, 2.461068),
        (15.811388, 5, 25, 20, 3.387278),
        (1.0, 10, 10, 10, 0.632456),
        (8.0, 10, 100, 50, 0.95),
    ],
)
def test_one_stretch(length: float, velocity: float, up: float, down: float, duration_s: float) -> None:
    rows = plan_speed([Stretch(length, velocity, up, down)])
    assert seconds(rows) == pytest.approx(duration_s, abs=1e-6)


def test_the_lower_velocity_holds_where_it_applies() -> None:
    """100 at speed 10, 100 at speed 20, 100 at speed 5: up after the first border, down before the second."""
    rows = plan_speed([Stretch(100, 10, 10, 10), Stretch(100, 20, 10, 5), Stretch(100, 5, 10, 5)])
    first, second, third = ([(*segment[1:4], segment.duration_s) for segment in row] for row in rows)
    assert first == [(0, 0, 10, 1.0), (5, 10, 0, 9.5)]
    assert second[0] == pytest.approx((0, 10, 10, 1.0))
    assert second[1] == pytest.approx((15, 20, 0, (85 - 37.5) / 20))
    assert second[2] == pytest.approx((62.5, 20, -5, 3.0))
    assert third[0] == pytest.approx((0, 5, 0, 97.5 / 5))
    assert third[1] == pytest.approx((97.5, 5, -5, 1.0))


def test_braking_reaches_back_over_short_stretches() -> None:
    """A fast path that ends in many short stretches slows down in good time."""
    rows = plan_speed([Stretch(1000, 100, 50, 50)] + [Stretch(1, 100, 50, 50)] * 50)
    whole = plan_speed([Stretch(1050, 100, 50, 50)])
    assert seconds(rows) == pytest.approx(seconds(whole))


@given(stretches)
def test_every_plan_keeps_its_limits(path: list[Stretch]) -> None:
    rows = plan_speed(path)
    assert rows[0][0].velocity == 0.0
    assert end_of(rows[-1][-1])[1] == pytest.approx(0.0, abs=1e-6)
    for stretch, row in zip(path, rows, strict=True):
        assert row[0].position == pytest.approx(0.0, abs=1e-4)
        assert end_of(row[-1])[0] == pytest.approx(stretch.length, abs=1e-4)
        for segment in row:
            assert segment.duration_s > 0.0
            assert -stretch.deceleration <= segment.acceleration <= stretch.acceleration
            for velocity in (segment.velocity, end_of(segment)[1]):
                assert -1e-6 <= velocity <= stretch.velocity * (1 + 1e-9)
    for one, other in pairwise(segment for row in rows for segment in row):
        assert end_of(one)[1] == pytest.approx(other.velocity, rel=1e-6, abs=1e-4)


@given(stretches)
def test_no_plan_is_slower_than_it_must_be(path: list[Stretch]) -> None:
    """Everywhere it is at the velocity allowed, or on a ramp."""
    for stretch, row in zip(path, plan_speed(path), strict=True):
        for segment in row:
            if segment.acceleration == 0.0:
                assert segment.velocity == pytest.approx(stretch.velocity)
            else:
                assert segment.acceleration in (stretch.acceleration, -stretch.deceleration)


@given(st.lists(st.floats(0.5, 1e5), min_size=1, max_size=8), st.floats(0.0, 1e6), st.floats(1.0, 1e7))
def test_a_brake_takes_its_distance(lengths: list[float], velocity: float, deceleration: float) -> None:
    start = 0.25 * lengths[0]
    distance = velocity**2 / (2 * deceleration)
    rows = plan_brake(lengths, start, velocity, deceleration)
    room = math.fsum(lengths) - start
    if rows is None:
        assert distance > room * (1 - 1e-9)
        return
    assert distance <= room * (1 + 1e-9)
    travelled = math.fsum(lengths[: len(rows) - 1]) + end_of(rows[-1][-1])[0] - start
    assert travelled == pytest.approx(distance, rel=1e-6, abs=1e-6)
    assert seconds(rows) == pytest.approx(velocity / deceleration)

"""Arcs in the kernel: the cosine it works out for itself, and an axis that goes along its share of a circle."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.engine import Engine, Segment, State, VelocityDrive, evaluate
from emulator.engine.arc import SINE, cosine
from emulator.engine.machine_code import MODE_VARIABLE
from tests.engine.conftest import build_engine

MakeEngine = Callable[..., Engine]

RADIUS = 20_000.0
SPEED = 40_000.0
CENTRES = (5_000.0, -3_000.0)


@given(st.floats(-100.0, 100.0))
def test_the_kernels_own_cosine_and_sine(angle: float) -> None:
    assert cosine(angle, 0) == pytest.approx(math.cos(angle), abs=3e-16)
    assert cosine(angle, SINE) == pytest.approx(math.sin(angle), abs=3e-16)


def circle(direction: int) -> list[tuple[Segment, ...]]:
    """Both axes' shares of a full turn at constant speed, from the point on the right."""
    duration_s = 2 * math.pi * RADIUS / SPEED
    turn = direction / RADIUS
    shares = [Segment(duration_s, 0.0, SPEED, 0.0, 0.0, RADIUS, CENTRES[0], 0.0, turn)]
    shares.append(Segment(duration_s, 0.0, SPEED, 0.0, 0.0, RADIUS, CENTRES[1], -math.pi / 2, turn))
    ends = (CENTRES[0] + RADIUS, CENTRES[1])
    return [(share, Segment(0.0, end, 0.0, 0.0, 0.0)) for share, end in zip(shares, ends, strict=True)]


@pytest.mark.parametrize("direction", [1, -1])
def test_both_axes_on_a_circle(make_engine: MakeEngine, direction: int) -> None:
    engine = make_engine(VelocityDrive(), VelocityDrive())
    for axis_index, share in enumerate(circle(direction)):
        engine.set_position_error_limit(axis_index, 0)
        engine.start_profile(axis_index, share)
    start_ns = engine.next_trajectory_ns
    engine.run(start_ns)
    while engine.is_moving(0):
        angle = direction * SPEED * (engine.time_ns - start_ns) * 1e-9 / RADIUS
        x, y = (engine.commanded_position(axis) - CENTRES[axis] for axis in range(2))
        assert abs(x - RADIUS * math.cos(angle)) <= 0.51
        assert abs(y - RADIUS * math.sin(angle)) <= 0.51
        speeds = [engine.commanded_velocity(axis) for axis in range(2)]
        assert math.hypot(*speeds) == pytest.approx(SPEED)
        assert speeds[0] * x + speeds[1] * y == pytest.approx(0, abs=SPEED)
        inwards = [engine.commanded_acceleration(axis) for axis in range(2)]
        assert inwards[0] == pytest.approx(-math.cos(angle) * SPEED**2 / RADIUS, abs=1e-6)
        assert inwards[1] == pytest.approx(-math.sin(angle) * SPEED**2 / RADIUS, abs=1e-6)
        engine.run(engine.next_trajectory_ns)
    assert [engine.commanded_position(axis) for axis in range(2)] == [CENTRES[0] + RADIUS, CENTRES[1]]
    assert not engine.is_moving(1)


def test_an_arc_with_an_offset_between_raw_and_reported_counts(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_position_error_limit(0, 0)
    engine.set_position(0, 1000)
    engine.start_profile(0, circle(1)[0])
    assert engine.profile_state(0).position == CENTRES[0] + RADIUS
    engine.run(engine.next_trajectory_ns)
    assert engine.commanded_position(0) == CENTRES[0] + RADIUS
    assert engine.profile_target(0) == CENTRES[0] + RADIUS


@given(
    st.floats(1.0, 1e6),
    st.floats(-7.0, 7.0),
    st.sampled_from([1, -1]),
    st.floats(0.0, 1e5),
    st.floats(-1e6, 1e6),
    st.floats(0.01, 1.0),
)
def test_velocity_and_acceleration_are_the_slopes_of_position_and_velocity(
    radius: float, phase: float, direction: int, speed: float, acceleration: float, t: float
) -> None:
    share = (Segment(2.0, 7.0, speed, acceleration, 0.0, radius, 100.0, phase, direction / radius),)
    h = 1e-7
    before, at, after = (evaluate(share, t + step) for step in (-h, 0.0, h))
    assert isinstance(at, State)
    turn = (speed + abs(acceleration) * t) / radius
    scale = radius * (1.0 + turn**3 + turn * abs(acceleration) / radius)
    assert (after.position - before.position) / (2 * h) == pytest.approx(at.velocity, abs=1e-7 * scale + 1e-3, rel=1e-4)
    assert (after.velocity - before.velocity) / (2 * h) == pytest.approx(
        at.acceleration, abs=1e-6 * scale * (1 + turn) + 1e-2, rel=1e-3
    )


def test_interpreted_and_compiled_agree_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    def played() -> bytes:
        engine = build_engine(VelocityDrive(), VelocityDrive())
        for axis_index, share in enumerate(circle(-1)):
            engine.set_position(axis_index, round(share[0].centre + share[0].radius * math.cos(share[0].phase)))
            engine.start_profile(axis_index, share)
        engine.run(engine.time_ns + 150_000_000)
        return engine.snapshot()

    compiled = played()
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    assert played() == compiled

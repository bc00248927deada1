"""Plans of the target as closed forms and integrals say they must be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.rmc import ramps
from emulator.rmc.ramps import LINEAR, S_CURVE, plan_distance, plan_duration, plan_move, plan_timed, plan_velocity

RATES = st.floats(0.1, 1000.0)


def test_the_s_curve_is_what_its_integrals_say() -> None:
    """Share, way and slope are integrals of one another, and the slope is a smoothstep, 1.5, and back."""
    u = np.linspace(0.0, 1.0, 30_001)
    share = np.array([ramps.s_share(x) for x in u])
    way = np.array([ramps.s_way(x) for x in u])
    slope = np.array([ramps.s_slope(x) for x in u])
    bend = np.array([ramps.s_bend(x) for x in u])
    width = u[1] - u[0]
    for function, derivative in ((way, share), (share, slope), (slope, bend)):
        integral = np.concatenate(([0.0], np.cumsum(0.5 * (derivative[1:] + derivative[:-1]) * width)))
        assert function == pytest.approx(integral, abs=1e-6)
    assert share[-1] == pytest.approx(1.0)
    assert way[-1] == pytest.approx(0.5)
    assert slope.max() == 1.5
    third = u < 1.0 / 3.0
    w = 3.0 * u[third]
    assert slope[third] == pytest.approx(1.5 * (3.0 * w**2 - 2.0 * w**3))


def test_peak_jerk_is_one_and_a_half_times_its_average() -> None:
    """The acceleration rises to its peak within a third: on average by 1.5 / (1/3), at most by half as much more."""
    u = np.linspace(0.0, 1.0 / 3.0, 10_001)[1:-1]
    assert max(ramps.s_bend(x) for x in u) == pytest.approx(1.5 * 1.5 * 3.0, rel=1e-6)


@given(
    distance=st.floats(-100.0, 100.0),
    velocity=st.floats(-50.0, 50.0),
    speed=RATES,
    accel=RATES,
    decel=RATES,
)
def test_a_move_ends_at_rest_where_it_should(
    distance: float, velocity: float, speed: float, accel: float, decel: float
) -> None:
    plan = plan_move(distance, velocity, speed=speed, accel=accel, decel=decel, shape=LINEAR)
    assert plan_distance(plan) == pytest.approx(distance, abs=1e-6 * (1.0 + abs(velocity) ** 2 / decel))
    at = velocity
    for ramp in plan:
        assert ramp.velocity == pytest.approx(at, abs=1e-6)
        at = ramp.velocity + ramp.change
        assert abs(at) <= max(speed, abs(velocity)) * (1.0 + 1e-9)
        assert ramp.duration_s >= 0.0
    if plan:
        assert at == pytest.approx(0.0, abs=1e-6)
    assert len(plan) <= 8


def test_the_shape_does_not_change_the_time() -> None:
    times = [
        plan_duration(plan_move(10.0, 0.0, speed=5.0, accel=50.0, decel=20.0, shape=shape))
        for shape in (LINEAR, S_CURVE)
    ]
    assert times[0] == times[1] == pytest.approx(0.1 + 0.25 + (10.0 - 0.25 - 0.625) / 5.0)


def test_a_velocity_through_zero_brakes_with_decel_and_starts_with_accel() -> None:
    plan = plan_velocity(3.0, -2.0, accel=1.0, decel=6.0, shape=LINEAR)
    assert [(ramp.duration_s, ramp.change) for ramp in plan] == [(0.5, -3.0), (2.0, -2.0), (math.inf, 0.0)]


@given(
    distance=st.floats(-10.0, 10.0),
    velocity=st.floats(-5.0, 5.0),
    acceleration=st.floats(-5.0, 5.0),
    time_s=st.floats(0.05, 20.0),
    to_velocity=st.floats(-5.0, 5.0),
    to_acceleration=st.floats(-5.0, 5.0),
)
def test_a_timed_move_has_both_ends_as_given(
    distance: float, velocity: float, acceleration: float, time_s: float, to_velocity: float, to_acceleration: float
) -> None:
    ramp = plan_timed(
        distance,
        velocity,
        acceleration,
        time_s=time_s,
        to_velocity=to_velocity,
        to_acceleration=to_acceleration,
    )[0]
    place = np.polynomial.Polynomial([0.0, ramp.velocity, *ramp.higher])
    scale = 1.0 + abs(distance) + time_s * (abs(velocity) + abs(to_velocity)) + 5.0 * time_s**2
    assert place(time_s) == pytest.approx(distance, abs=1e-9 * scale)
    assert place.deriv()(time_s) == pytest.approx(to_velocity, abs=1e-8 * scale / time_s)
    assert place.deriv(2)(time_s) == pytest.approx(to_acceleration, abs=1e-7 * scale / time_s**2)
    assert place.deriv(2)(0.0) == pytest.approx(acceleration)

"""Profiles as the running kernel carries them out."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import (
    RATES,
    AxisHardware,
    DriveShutDown,
    Engine,
    Event,
    Gains,
    plan_continuous,
    plan_preset,
    plan_stop,
    profile_duration,
    rates_for,
)

MakeEngine = Callable[..., Engine]

COUNTS = 4000.0


def time_of_end(engine: Engine, start_ns: int) -> float:
    """Run until the profile of axis 1 is over, trajectory update by trajectory update; seconds since `start_ns`."""
    while engine.is_moving(0):
        engine.run(engine.next_trajectory_ns)
    return (engine.time_ns - start_ns) / 1e9


@pytest.mark.parametrize(
    ("distance", "velocity", "acceleration", "deceleration", "average", "duration_s"),
    [
        (25, 1, 10, 10, None, 25.1),
        (6.25, 1, 10, 10, None, 6.35),
        (1, 10, 10, 10, None, 0.632456),
        (10, 5, 25, 20, None, 2.225),
        (8, 10, 100, 50, None, 0.95),
        (1, 2, 10, 5, None, 0.8),
        (10, 5, 10, 10, 5, 3.0),
        (10, 5, 10, 10, 7.5, 2 + 2 / 3),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_moves_end_exactly_and_within_one_trajectory_update(
    make_engine: MakeEngine,
    distance: float,
    velocity: float,
    acceleration: float,
    deceleration: float,
    average: float | None,
    duration_s: float,
    sign: int,
) -> None:
    engine = make_engine()
    scaled = None if average is None else average * COUNTS
    plan = plan_preset(
        0.0,
        0.0,
        sign * distance * COUNTS,
        velocity * COUNTS,
        acceleration * COUNTS,
        deceleration * COUNTS,
        scaled,
        scaled,
    )
    engine.set_position_error_limit(0, 0)
    start_ns = engine.next_trajectory_ns
    engine.start_profile(0, plan)
    ended_s = time_of_end(engine, start_ns)
    assert engine.commanded_position(0) == sign * distance * COUNTS
    assert -1e-6 <= ended_s - duration_s <= engine.rates.trajectory_ns / 1e9
    assert (engine.commanded_velocity(0), engine.commanded_acceleration(0)) == (0.0, 0.0)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(-200_000, 200_000),
    st.floats(100.0, 400_000.0),
    st.floats(1000.0, 1e7),
    st.floats(1000.0, 1e7),
    st.sampled_from(sorted(RATES)),
)
def test_any_move_ends_where_and_when_planned(
    target: int, velocity: float, up: float, down: float, row: tuple[int, int]
) -> None:
    engine = Engine([AxisHardware()], rates=rates_for(*row))
    engine.enable(0)
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)
    plan = plan_preset(0.0, 0.0, float(target), velocity, up, down)
    duration_ns = profile_duration(plan) * 1e9
    start_ns = engine.next_trajectory_ns
    engine.start_profile(0, plan)
    event = engine.run(start_ns + math.ceil(duration_ns) + engine.rates.system_ns)
    assert event == Event.MOVE_ENDED
    late_ns = engine.time_ns - start_ns - duration_ns
    assert -1 <= late_ns < engine.rates.trajectory_ns + engine.rates.system_ns
    assert engine.commanded_position(0) == target


def test_a_profile_begins_at_the_next_trajectory_update_and_moves_in_steps(make_engine: MakeEngine) -> None:
    engine = make_engine()
    plan = plan_continuous(0.0, 0.0, 40_000.0, 4_000_000.0, 4_000_000.0)
    start_ns = engine.next_trajectory_ns
    engine.start_profile(0, plan)
    seen = []
    for k in range(13):
        engine.run(start_ns + k * engine.rates.servo_ns)
        seen.append(engine.commanded_position(0))
    t = 1120e-6
    exact = [math.floor(0.5 * 4e6 * (n * t) ** 2 + 0.5) for n in range(4)]
    assert seen == [exact[k // 4] for k in range(13)]


def test_the_command_is_continuous_through_a_change_in_motion(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_position_error_limit(0, 0)
    engine.start_profile(0, plan_continuous(0.0, 0.0, 8000.0, 40_000.0, 40_000.0))
    engine.run(engine.time_ns + 500_000_000)
    engine.run(engine.time_ns + 333_333)
    position, velocity, _ = engine.profile_state(0)
    assert velocity == 8000.0
    engine.start_profile(0, plan_preset(position, velocity, 9000.0, 4000.0, 40_000.0, 40_000.0))
    last = engine.commanded_position(0)
    while engine.is_moving(0):
        engine.run(engine.next_trajectory_ns)
        here = engine.commanded_position(0)
        assert 0 <= here - last <= 8000 * 1120e-6 + 1
        last = here
    assert last == 9000


def test_profile_state_is_what_the_next_trajectory_update_shows(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_position(0, -700)
    engine.start_profile(0, plan_preset(-700.0, 0.0, 3300.0, 4000.0, 40_000.0, 40_000.0))
    while engine.is_moving(0):
        position, velocity, acceleration = engine.profile_state(0)
        engine.run(engine.next_trajectory_ns)
        assert engine.commanded_position(0) == math.floor(position + 0.5)
        if engine.is_moving(0):
            assert engine.commanded_velocity(0) == pytest.approx(velocity)
            assert engine.commanded_acceleration(0) == pytest.approx(acceleration)
    assert engine.profile_state(0) == (3300.0, 0.0, 0.0)


def test_a_stop_ends_on_a_whole_count(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.start_profile(0, plan_continuous(0.0, 0.0, 4000.0, 40_000.0, 40_000.0))
    engine.run(engine.time_ns + 400_000_000)
    position, velocity, _ = engine.profile_state(0)
    engine.start_profile(0, plan_stop(position, velocity, 40_000.0))
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.MOVE_ENDED
    assert engine.commanded_position(0) == math.floor(position + 4000.0**2 / 80_000.0 + 0.5)


def test_cancelling_stops_the_command_where_it_is(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.start_profile(0, plan_continuous(0.0, 0.0, 4000.0, 40_000.0, 40_000.0))
    engine.run(engine.time_ns + 400_000_000)
    here = engine.commanded_position(0)
    engine.cancel_profile(0)
    assert engine.run(engine.time_ns + 500_000_000) == Event.NONE
    assert engine.commanded_position(0) == here
    assert not engine.is_moving(0)


def test_a_profile_of_many_segments_outgrows_the_table_and_spares_its_neighbour(make_engine: MakeEngine) -> None:
    engine = make_engine(AxisHardware().plant, AxisHardware().plant)
    engine.start_profile(1, plan_preset(0.0, 0.0, 2000.0, 4000.0, 40_000.0, 40_000.0, 20_000.0, 20_000.0))
    staircase, position = [], 0.0
    for k in range(100):
        move = plan_preset(position, 0.0, 40.0 * (k + 1), 4000.0, 1e6, 1e6)[:-1]
        staircase += move
        position = 40.0 * (k + 1)
    engine.start_profile(0, (*staircase, plan_stop(position, 0.0, 1.0)[-1]))
    while engine.is_moving(0) or engine.is_moving(1):
        engine.run(engine.time_ns + 10_000_000_000)
    assert (engine.commanded_position(0), engine.commanded_position(1)) == (4000, 2000)


def test_a_drive_that_is_off_takes_no_profile(make_engine: MakeEngine) -> None:
    engine = make_engine(enabled=False)
    with pytest.raises(DriveShutDown):
        engine.start_profile(0, plan_stop(0.0, 0.0, 1.0))
    engine.enable(0)
    with pytest.raises(ValueError, match="segment"):
        engine.start_profile(0, ())


def test_drive_off_follows_the_feedback_and_drive_on_does_not_jump(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.2)
    engine.set_gains(0, Gains(0.0))
    engine.run(engine.time_ns + 200_000_000)
    engine.disable(0)
    assert engine.position_error(0) == 0, "at once, not only at the next sample"
    engine.set_gains(0, Gains())
    engine.set_output(0, offset_v=0.0)
    for _ in range(20):
        engine.run(engine.next_system_update_ns)
        assert engine.position_error(0) == 0
        assert engine.dac_volts(0) == 0.0
    engine.run(engine.time_ns + 1_000_000_000)
    assert abs(engine.true_velocity_rev_s(0)) < 1e-3, "the motor has coasted to rest"
    rest = engine.encoder_position(0)
    assert rest > 400
    engine.enable(0)
    engine.run(engine.time_ns + 500_000_000)
    assert engine.commanded_position(0) == rest
    assert engine.encoder_position(0) == pytest.approx(rest, abs=2)


def test_open_loop_feedback_leaves_only_the_offset(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_feedback(0, 0)
    engine.set_output(0, offset_v=0.5)
    engine.run(engine.time_ns + 100_000_000)
    assert engine.dac_volts(0) == pytest.approx(0.5, abs=20 / 65536)
    assert engine.position_error(0) == 0
    with pytest.raises(ValueError, match="not fitted"):
        engine.set_feedback(0, 2)


def test_setting_the_position_keeps_the_standing_error(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.1)
    engine.run(engine.time_ns + 1_000_000_000)
    error, true = engine.position_error(0), engine.true_position_rev(0)
    engine.set_position(0, 123_456)
    assert engine.commanded_position(0) == 123_456
    assert engine.encoder_position(0) == engine.feedback_position(0) == 123_456 - error
    engine.run(engine.time_ns + 500_000_000)
    assert engine.commanded_position(0) == 123_456
    assert engine.true_position_rev(0) == pytest.approx(true, abs=1e-3)


def test_setting_the_position_in_motion_moves_the_numbers_not_the_axis(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.start_profile(0, plan_preset(0.0, 0.0, 8000.0, 4000.0, 40_000.0, 40_000.0))
    engine.run(engine.time_ns + 500_000_000)
    shift = 1_000_000 - engine.commanded_position(0)
    engine.set_position(0, 1_000_000)
    while engine.is_moving(0):
        engine.run(engine.time_ns + 1_000_000_000)
    assert engine.commanded_position(0) == 8000 + shift


def test_an_encoder_that_does_not_start_at_zero(make_engine: MakeEngine) -> None:
    engine = make_engine(enabled=False, start_position_rev=0.7, encoder_phase=0.5)
    assert engine.encoder_position(0) == 0
    assert engine.true_position_rev(0) == 0.7

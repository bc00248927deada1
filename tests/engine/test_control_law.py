"""The PIV&F law: each term by itself, then the loop it closes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import expm

from emulator.engine import Engine, Gains, VelocityDrive, plan_continuous, plan_preset, rates_for

MakeEngine = Callable[..., Engine]

K = 40_000.0
"""Speed of the default plant per volt, counts/s per V."""

STEP_V = 20 / 65536
SERVO_S, SAMPLES = 280e-6, 4


def cruise(engine: Engine, velocity: float, *, settle_s: float = 3.0) -> None:
    """Bring axis 1 to constant velocity and stop at a system update, where the command is newest."""
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)
    engine.start_profile(0, plan_continuous(0.0, 0.0, velocity, 4e5, 4e5))
    engine.run(engine.time_ns + int(settle_s * 1e9))
    engine.run(engine.next_system_update_ns)


def staircase(velocity: float) -> float:
    """How far the command at a trajectory update lies above its mean: it is held while the axis moves on."""
    return velocity * SERVO_S * (SAMPLES - 1) / 2


@pytest.mark.parametrize("velocity", [4000.0, 20_000.0, -20_000.0, 60_000.0])
def test_following_error_at_constant_velocity(make_engine: MakeEngine, velocity: float) -> None:
    engine = make_engine()
    cruise(engine, velocity)
    expected = velocity / K / 0.5e-3 + staircase(velocity)
    assert engine.position_error(0) == pytest.approx(expected, abs=2)
    assert engine.commanded_velocity(0) == velocity


@pytest.mark.parametrize("velocity", [4000.0, 40_000.0, -40_000.0])
def test_velocity_feedforward_matched_to_the_plant_cancels_it(make_engine: MakeEngine, velocity: float) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(velocity_feedforward_uv_per_count_s=1e6 / K))
    cruise(engine, velocity)
    assert engine.position_error(0) == pytest.approx(staircase(velocity), abs=2)


def test_velocity_feedback_drags(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(proportional_mv_per_count=2.0, velocity_uv_per_count_s=10.0))
    cruise(engine, 20_000.0)
    expected = 20_000.0 * (1 / K + 10e-6) / 2e-3 + staircase(20_000.0)
    assert engine.position_error(0) == pytest.approx(expected, abs=2)


def test_acceleration_feedforward_adds_volts_while_accelerating(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(acceleration_feedforward_uv_per_count_s2=2.0))
    engine.start_profile(0, plan_continuous(0.0, 0.0, 40_000.0, 40_000.0, 40_000.0))
    engine.run(engine.time_ns + 500_000_000)
    assert engine.terms(0)["AF"] == pytest.approx(2e-6 * 40_000.0)
    engine.run(engine.time_ns + 1_000_000_000)
    assert engine.terms(0)["AF"] == 0.0


def test_an_offset_leaves_a_standing_error_and_the_integral_removes_it(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.1)
    engine.run(engine.time_ns + 2_000_000_000)
    assert engine.position_error(0) == pytest.approx(-200, abs=1)
    engine.set_gains(0, Gains(integral_mv_per_count_s=2.0))
    engine.run(engine.time_ns + 5_000_000_000)
    assert abs(engine.position_error(0)) <= 1
    assert engine.terms(0)["I"] == pytest.approx(-0.1, abs=1e-3)


def test_the_integrator_stops_at_its_limit_and_leaves_it_at_once(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=1.0)
    engine.set_gains(0, Gains(integral_mv_per_count_s=50.0, integral_limit_v=0.25))
    engine.run(engine.time_ns + 5_000_000_000)
    assert engine.terms(0)["I"] == -0.25
    error = engine.position_error(0)
    assert error == pytest.approx(-(1.0 - 0.25) / 0.5e-3, abs=1)
    engine.set_output(0, offset_v=-1.0)
    # Unwound: the first samples of the other sign move it, as a wound-up state would not.
    engine.run(engine.time_ns + 1_000_000_000)
    assert engine.terms(0)["I"] == 0.25


def test_integral_gain_zero_clears_the_integrator(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.1)
    engine.set_gains(0, Gains(integral_mv_per_count_s=2.0))
    engine.run(engine.time_ns + 5_000_000_000)
    assert engine.terms(0)["I"] != 0.0
    engine.set_gains(0, Gains())
    engine.run(engine.time_ns + 1_000_000)
    assert engine.terms(0)["I"] == 0.0


def test_the_output_stays_within_ten_volts_and_within_daclim(make_engine: MakeEngine) -> None:
    engine = make_engine(VelocityDrive(max_acceleration_rev_s2=1.0))
    engine.set_position_error_limit(0, 0)
    engine.set_gains(0, Gains(proportional_mv_per_count=100.0))
    engine.start_profile(0, plan_preset(0.0, 0.0, 100_000.0, 1e6, 1e9, 1e9))
    engine.run(engine.time_ns + 200_000_000)
    assert engine.terms(0)["output"] == 10.0
    assert engine.dac_volts(0) == pytest.approx(10.0, abs=STEP_V)
    engine.set_output(0, limit_v=12.0)
    engine.run(engine.time_ns + 1_000_000)
    assert engine.terms(0)["output"] == 10.0, "a limit beyond the range does not widen it"
    engine.set_output(0, limit_v=2.5)
    engine.run(engine.time_ns + 1_000_000)
    assert engine.dac_volts(0) == 2.5


def test_all_gains_zero_leave_the_offset_alone(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(0.0))
    engine.set_output(0, offset_v=1.0)
    engine.run(engine.time_ns + 100_000_000)
    assert engine.dac_volts(0) == pytest.approx(1.0, abs=STEP_V)
    assert {name: engine.terms(0)[name] for name in ("P", "I", "V", "VF", "AF")} == dict.fromkeys(
        ("P", "I", "V", "VF", "AF"), 0.0
    )
    assert engine.true_velocity_rev_s(0) == pytest.approx(10.0, rel=1e-3)


def test_a_reversed_command_with_a_reversed_encoder_holds_and_with_one_alone_runs_away(
    make_engine: MakeEngine,
) -> None:
    for encoder, runs_away in ((0, False), (1, True)):
        engine = make_engine()
        engine.set_polarity(0, command=1, encoder=encoder)
        engine.start_profile(0, plan_preset(0.0, 0.0, 4000.0, 4000.0, 40_000.0, 40_000.0))
        engine.run(engine.time_ns + 2_000_000_000)
        engine.run(engine.time_ns + 2_000_000_000)
        assert engine.is_enabled(0) is not runs_away
        if not runs_away:
            assert engine.encoder_position(0) == pytest.approx(4000, abs=2)
            assert engine.true_position_rev(0) == pytest.approx(-1.0, abs=1e-3)


def reference_step(target: int, samples: int, gains: Gains) -> list[float]:
    """The closed loop simulated apart from the engine: matrix exponential for the plant, quantisers, one step."""
    plant = VelocityDrive(max_acceleration_rev_s2=math.inf)
    tau, lag = plant.loop_time_constant_s, plant.command_lag_s
    system = np.zeros((4, 4))
    system[0, 1], system[1, 1], system[1, 2] = 1.0, -1 / tau, 1 / tau
    system[2, 2], system[2, 3] = -1 / lag, plant.speed_per_volt_rev_s / lag
    advance = expm(system * SERVO_S)
    state, last, integral, trace = np.zeros(4), 0, 0.0, []
    for _ in range(samples):
        state = advance @ state
        trace.append(float(state[0]))
        counts = math.floor(state[0] * 4000)
        error = target - counts
        integral += 1e-3 * gains.integral_mv_per_count_s * error * SERVO_S
        velocity = (counts - last) / SERVO_S
        volts = 1e-3 * gains.proportional_mv_per_count * error + integral
        volts -= 1e-6 * gains.velocity_uv_per_count_s * velocity
        last = counts
        state[3] = math.floor(min(10.0, max(-10.0, volts)) / STEP_V + 0.5) * STEP_V
    return trace


@pytest.mark.parametrize("gains", [Gains(0.5), Gains(5.0, 3.0, 2.0), Gains(15.0, 0.0, 2.0)])
def test_a_step_of_the_closed_loop_is_that_of_an_independent_simulation(make_engine: MakeEngine, gains: Gains) -> None:
    engine = make_engine(VelocityDrive(max_acceleration_rev_s2=math.inf))
    engine.set_gains(0, gains)
    engine.start_profile(0, plan_preset(0.0, 0.0, 401.0, 1e9, 1e15, 1e15))
    # The profile begins at the next trajectory update at rest and is over at the one after it: a step.
    engine.run(engine.next_trajectory_ns)
    start_ns = engine.next_trajectory_ns
    actual = []
    for k in range(1500):
        engine.run(start_ns + k * 280_000)
        engine.run(start_ns + k * 280_000)
        actual.append(engine.true_position_rev(0))
    assert actual == pytest.approx(reference_step(401, 1500, gains), rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("indax", [1, 2])
@pytest.mark.parametrize("ssfr", [1, 2, 4, 8])
def test_one_revolution_with_power_up_gains_at_every_rate(make_engine: MakeEngine, indax: int, ssfr: int) -> None:
    engine = make_engine(rates=rates_for(indax, ssfr))
    engine.start_profile(0, plan_preset(0.0, 0.0, 4000.0, 4000.0, 40_000.0, 40_000.0))
    for _ in range(3):
        engine.run(engine.time_ns + 1_000_000_000)
    assert engine.commanded_position(0) == 4000
    assert engine.encoder_position(0) == pytest.approx(4000, abs=2)
    assert abs(engine.true_velocity_rev_s(0)) < 1e-3

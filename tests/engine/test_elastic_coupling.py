"""Motor and load on a springy shaft against scipy's solutions of the two equations of motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import find_peaks

from emulator.engine import ElasticCoupling, EncoderTraits, PlantError
from tests.engine.rig import PERIODS_S, TURN, Rig, exact_linear, volts_sequence

STATES = ["true_position", "twist", "true_velocity", "load_velocity"]
PERIOD_S = 280e-6


def free_system(plant: ElasticCoupling, motor_loss: float = 0.0) -> np.ndarray:
    """d/dt of motor position, twist, motor speed, load speed, in rev and rev/s."""
    jm, jl = plant.motor_inertia_kg_m2, plant.load_inertia_kg_m2
    k, d = plant.stiffness_nm_per_rad, plant.damping_nm_s_per_rad
    bm, bl = (plant.motor_viscous_nm_s_per_rev + motor_loss) / TURN, plant.load_viscous_nm_s_per_rev / TURN
    return np.array(
        [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0, -1.0],
            [0.0, -k / jm, -(d + bm) / jm, d / jm],
            [0.0, k / jl, d / jl, -(d + bl) / jl],
        ]
    )


@pytest.mark.parametrize("period_s", PERIODS_S)
@pytest.mark.parametrize("stiffness", [0.5, 30.0, 20_000.0])
def test_torque_mode_is_exact_under_zero_order_hold(period_s: float, stiffness: float) -> None:
    plant = ElasticCoupling(stiffness_nm_per_rad=stiffness)
    volts = volts_sequence(80)
    rows = Rig(plant, period_s).record(STATES, volts)
    inputs = np.array([0.0, 0.0, plant.torque_per_volt_nm / (TURN * plant.motor_inertia_kg_m2), 0.0])
    expected = exact_linear(free_system(plant), inputs, volts, period_s)
    scale = np.abs(expected).max(axis=0)
    assert (np.abs(rows - expected) / scale).max() < 1e-9


@pytest.mark.parametrize("period_s", PERIODS_S)
def test_velocity_mode_is_exact_under_zero_order_hold(period_s: float) -> None:
    plant = ElasticCoupling(drive="velocity", loop_time_constant_s=0.002)
    gain = TURN * 3e-4 / 0.002
    volts = volts_sequence(80)
    rows = Rig(plant, period_s).record(STATES, volts)
    inputs = np.array([0.0, 0.0, gain * plant.speed_per_volt_rev_s / (TURN * plant.motor_inertia_kg_m2), 0.0])
    expected = exact_linear(free_system(plant, gain), inputs, volts, period_s)
    assert (np.abs(rows - expected) / np.abs(expected).max(axis=0)).max() < 1e-9


def test_resonance_frequency_and_damping() -> None:
    plant = ElasticCoupling(motor_viscous_nm_s_per_rev=0.0, load_viscous_nm_s_per_rev=0.0)
    rig = Rig(plant, 150e-6, enabled=0, twist=0.01)
    twist = rig.record(["twist"], [0.0] * 4000)[:, 0]
    peaks, _ = find_peaks(twist)
    reduced = 1.0 / (1.0 / plant.motor_inertia_kg_m2 + 1.0 / plant.load_inertia_kg_m2)
    natural, ratio = math.sqrt(30.0 / reduced), 0.005 / 2.0 / math.sqrt(30.0 * reduced)
    damped_hz = natural * math.sqrt(1.0 - ratio**2) / TURN
    cycles = len(peaks) - 1
    assert cycles > 20
    assert cycles / ((peaks[-1] - peaks[0]) * 150e-6) == pytest.approx(damped_hz, rel=5e-3)
    decrement = math.log(twist[peaks[0]] / twist[peaks[10]]) / 10
    assert decrement == pytest.approx(TURN * ratio / math.sqrt(1.0 - ratio**2), rel=0.02)
    assert plant.resonance_hz == pytest.approx(natural / TURN)
    assert plant.damping_ratio == pytest.approx(ratio)


def test_the_load_alone_swings_at_the_antiresonance() -> None:
    """A motor driven at the antiresonance hardly moves: its own motion has a zero there."""
    plant = ElasticCoupling(damping_nm_s_per_rad=0.0, load_viscous_nm_s_per_rev=0.0, motor_viscous_nm_s_per_rev=0.1)
    assert plant.antiresonance_hz == pytest.approx(math.sqrt(30.0 / 2e-4) / TURN)
    swings = []
    for hz in (plant.antiresonance_hz, 0.8 * plant.antiresonance_hz):
        volts = [0.1 * math.sin(TURN * hz * k * 150e-6) for k in range(25_000)]
        rows = Rig(plant, 150e-6).record(["true_velocity"], volts)[-5000:, 0]
        swings.append(np.ptp(rows))
    assert swings[0] < 0.1 * swings[1]


def test_dry_friction_stops_the_load_where_the_energy_is_spent() -> None:
    plant = ElasticCoupling(
        stiffness_nm_per_rad=2000.0,
        damping_nm_s_per_rad=0.05,
        motor_viscous_nm_s_per_rev=0.0,
        load_viscous_nm_s_per_rev=0.0,
        load_coulomb_nm=0.2,
        motor_coulomb_nm=0.1,
    )
    rig = Rig(plant, PERIOD_S, enabled=0, true_velocity=20.0, load_velocity=20.0)
    rows = rig.record(["true_position", "true_velocity", "load_velocity"], [0.0] * 2000)
    deceleration = 0.3 / (TURN * 3e-4)
    assert rows[-1, 0] == pytest.approx(20.0**2 / (2 * deceleration), rel=2e-3)
    assert abs(rows[-1, 1:]).max() < 1e-9
    assert np.ptp(rows[-500:, 0]) < 1e-9, "at rest it stays"


def test_friction_holds_a_load_torque_and_no_more() -> None:
    for torque, holds in ((0.19, True), (0.21, False)):
        rig = Rig(ElasticCoupling(load_coulomb_nm=0.2, load_torque_nm=torque), PERIOD_S, enabled=0)
        rows = rig.record(["load_position"], [0.0] * 3000)[:, 0]
        assert (abs(rows[-1]) < 1e-9) == holds
        assert rows[-1] <= 1e-9, "a positive load torque pushes backwards"


def test_friction_agrees_with_a_fine_numerical_solution() -> None:
    plant = ElasticCoupling(load_coulomb_nm=0.05, motor_coulomb_nm=0.02)
    system = free_system(plant)

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        torque = np.array([0.3 * 2.0 - 0.02 * math.tanh(state[2] / 1e-4), -0.05 * math.tanh(state[3] / 1e-4)])
        push = np.array([0.0, 0.0, torque[0] / (TURN * 1e-4), torque[1] / (TURN * 2e-4)])
        return np.asarray(system @ state + push)

    steps = 150
    rows = Rig(plant, 150e-6).record(STATES, [2.0] * steps)
    fine: Any = solve_ivp(slope, (0.0, steps * 150e-6), np.zeros(4), method="Radau", rtol=1e-8, atol=1e-10)
    assert rows[-1] == pytest.approx(fine.y[:, -1], rel=0.01, abs=1e-4)


def test_peak_torque_limits_a_velocity_drive_too() -> None:
    plant = ElasticCoupling(
        drive="velocity", peak_torque_nm=1.0, motor_viscous_nm_s_per_rev=0.0, load_viscous_nm_s_per_rev=0.0
    )
    rows = Rig(plant, PERIOD_S).record(["true_velocity", "load_velocity"], [10.0] * 100)
    momentum = TURN * (1e-4 * rows[:, 0] + 2e-4 * rows[:, 1])
    assert np.diff(momentum) == pytest.approx(np.full(99, 1.0 * PERIOD_S), rel=1e-9)


@pytest.mark.parametrize("on_load", [False, True])
def test_the_encoder_sits_where_it_is_said_to(on_load: bool) -> None:
    plant = ElasticCoupling(stiffness_nm_per_rad=1.0, backlash_rev=0.01)
    rig = Rig(plant, PERIOD_S, EncoderTraits(on_load=on_load))
    differ = False
    for volts in volts_sequence(300):
        rig.step(volts)
        place = rig["load_position" if on_load else "true_position"]
        assert rig["encoder_counts"] == math.floor(place * 4000)
        differ = differ or abs(rig["load_position"] - rig["true_position"]) > 0.004
    assert differ


@pytest.mark.parametrize(
    ("values", "parameter"),
    [
        ({"motor_inertia_kg_m2": -1e-4}, "motor_inertia_kg_m2"),
        ({"load_inertia_kg_m2": 0.0}, "load_inertia_kg_m2"),
        ({"stiffness_nm_per_rad": 0.0}, "stiffness_nm_per_rad"),
        ({"stiffness_nm_per_rad": math.inf}, "stiffness_nm_per_rad"),
        ({"stiffness_nm_per_rad": 1e9}, "stiffness_nm_per_rad"),
        ({"stiffness_nm_per_rad": 1e-9}, "stiffness_nm_per_rad"),
        ({"damping_nm_s_per_rad": 1e6}, "damping_nm_s_per_rad"),
        ({"load_viscous_nm_s_per_rev": 1e6}, "load_viscous_nm_s_per_rev"),
        ({"drive": "velocity", "loop_time_constant_s": 1e-9}, "loop_time_constant_s"),
        ({"drive": "position"}, "drive"),
        ({"load_torque_nm": math.nan}, "load_torque_nm"),
        ({"load_coulomb_nm": math.inf}, "load_coulomb_nm"),
    ],
)
def test_impossible_couplings_are_named(values: dict[str, Any], parameter: str) -> None:
    with pytest.raises(PlantError) as failure:
        ElasticCoupling(**values)
    assert failure.value.parameter == parameter

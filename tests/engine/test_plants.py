"""Drives and loads against independent solutions of their differential equations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from emulator.engine import RATES, Plant, TorqueDrive, VelocityDrive
from emulator.engine.layout import AXIS, PLANT
from emulator.engine.plants import step_plant

PERIODS_S = [rates.servo_ns * 1e-9 for rates in RATES.values()]
TURN = 2.0 * math.pi


class Rig:
    """A plant by itself: the state it has in an axis, its coefficients for one period, and a hand on its voltage."""

    def __init__(self, plant: Plant, period_s: float, **state: float) -> None:
        self._axis, self._plant = np.zeros(1, AXIS)[0], np.zeros(1, PLANT)[0]
        self._axis["enabled"] = 1
        for name, value in {"period_s": period_s, **plant.fields(period_s)}.items():
            self._plant[name] = value
        for name, value in state.items():
            self._axis[name] = value

    def __getitem__(self, name: str) -> Any:
        return self._axis[name]

    def __setitem__(self, name: str, value: float) -> None:
        self._axis[name] = value

    def step(self, volts: float) -> None:
        step_plant(self._axis, self._plant, volts)


def volts_sequence(count: int) -> list[float]:
    return [3.0 * math.sin(0.7 * k) + (k % 5) - 2.0 for k in range(count)]


def exact_linear(system: np.ndarray, inputs: np.ndarray, volts: list[float], period_s: float) -> np.ndarray:
    """State after holding each voltage for a period, by the matrix exponential of the augmented system."""
    n = len(system)
    augmented = np.zeros((n + 1, n + 1))
    augmented[:n, :n], augmented[:n, n] = system, inputs
    step = expm(augmented * period_s)
    state = np.zeros(n + 1)
    for u in volts:
        state[n] = u
        state = step @ state
    return state[:n]


@pytest.mark.parametrize("period_s", PERIODS_S)
@pytest.mark.parametrize("lag_s", [0.0003, 0.002, 0.00200000001, 0.005])
def test_velocity_drive_is_exact_under_zero_order_hold(period_s: float, lag_s: float) -> None:
    plant = VelocityDrive(command_lag_s=lag_s, max_acceleration_rev_s2=math.inf)
    rig, volts = Rig(plant, period_s), volts_sequence(60)
    for u in volts:
        rig.step(u)
    tau = plant.loop_time_constant_s
    system = np.array([[0.0, 1.0, 0.0], [0.0, -1 / tau, 1 / tau], [0.0, 0.0, -1 / lag_s]])
    expected = exact_linear(system, np.array([0.0, 0.0, plant.speed_per_volt_rev_s / lag_s]), volts, period_s)
    actual = [rig["true_position"], rig["true_velocity"], rig["lagged_command"]]
    assert actual == pytest.approx(expected.tolist(), rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("period_s", PERIODS_S)
def test_velocity_drive_without_input_lag(period_s: float) -> None:
    plant = VelocityDrive(command_lag_s=0.0, max_acceleration_rev_s2=math.inf)
    rig = Rig(plant, period_s)
    for _ in range(20):
        rig.step(2.0)
    t, tau = 20 * period_s, plant.loop_time_constant_s
    # The lag's state starts at 0 and, without a lag, plays no part even in the first sample.
    assert rig["true_velocity"] == pytest.approx(20.0 * (1 - math.exp(-t / tau)), rel=1e-12)
    assert rig["true_position"] == pytest.approx(20.0 * (t - tau * (1 - math.exp(-t / tau))), rel=1e-12)


def test_peak_torque_limits_acceleration_and_never_overshoots_the_speed() -> None:
    period_s = 280e-6
    rig = Rig(VelocityDrive(max_acceleration_rev_s2=1000.0), period_s)
    speeds = []
    for _ in range(600):
        rig.step(5.0)
        speeds.append(float(rig["true_velocity"]))
    assert np.diff(speeds).max() <= 1000.0 * period_s * (1 + 1e-9)
    assert speeds[100] == pytest.approx(101 * 1000.0 * period_s, rel=0.02)
    assert max(speeds) <= 50.0 + 1e-9
    assert speeds[-1] == pytest.approx(50.0, rel=1e-6)


def test_a_drive_shut_down_coasts() -> None:
    period_s = 280e-6
    rig = Rig(VelocityDrive(coast_time_constant_s=0.05), period_s, true_velocity=10.0, enabled=0)
    for _ in range(1000):
        rig.step(0.0)
    assert rig["true_velocity"] == pytest.approx(10.0 * math.exp(-0.28 / 0.05), rel=1e-9)
    assert rig["true_position"] == pytest.approx(10.0 * 0.05 * (1 - math.exp(-0.28 / 0.05)), rel=1e-9)


@pytest.mark.parametrize("period_s", PERIODS_S)
@pytest.mark.parametrize("viscous", [0.0, 1e-9, 2e-3, 0.5])
def test_torque_drive_without_dry_friction_is_exact(period_s: float, viscous: float) -> None:
    plant = TorqueDrive(viscous_nm_s_per_rev=viscous, coulomb_nm=0.0)
    rig, volts = Rig(plant, period_s), volts_sequence(60)
    rig["true_velocity"] = 0.0
    system = np.array([[0.0, 1.0], [0.0, -viscous / (TURN * plant.inertia_kg_m2)]])
    inputs = np.array([0.0, plant.torque_per_volt_nm / (TURN * plant.inertia_kg_m2)])
    steady = [abs(u) + 0.1 for u in volts]
    for u in steady:
        rig.step(u)
    expected = exact_linear(system, inputs, steady, period_s)
    assert [rig["true_position"], rig["true_velocity"]] == pytest.approx(expected.tolist(), rel=1e-9)


@pytest.mark.parametrize("period_s", PERIODS_S)
def test_dry_friction_stops_the_shaft_where_the_energy_is_spent_and_holds_it(period_s: float) -> None:
    plant = TorqueDrive(viscous_nm_s_per_rev=0.0, coulomb_nm=0.05)
    rig = Rig(plant, period_s, true_velocity=20.0)
    speeds = []
    for _ in range(int(2.0 / period_s)):
        rig.step(0.1)
        speeds.append(float(rig["true_velocity"]))
    deceleration = (0.05 - 0.03) / (TURN * plant.inertia_kg_m2)
    assert rig["true_position"] == pytest.approx(20.0**2 / (2 * deceleration), rel=1e-6)
    assert speeds[-1] == 0.0
    assert min(speeds) >= 0.0, "the shaft never turns back"


def test_torque_beyond_friction_reverses_the_shaft() -> None:
    period_s, plant = 280e-6, TorqueDrive(viscous_nm_s_per_rev=0.0, coulomb_nm=0.05)
    rig = Rig(plant, period_s, true_velocity=5.0)
    inertia = TURN * plant.inertia_kg_m2
    stop_s = 5.0 * inertia / 0.35
    while rig["true_velocity"] >= 0.0:
        rig.step(-1.0)
        stop_s -= period_s
    steps = 1000
    for _ in range(steps):
        rig.step(-1.0)
    assert rig["true_velocity"] == pytest.approx(-0.25 / inertia * (steps * period_s - stop_s), rel=1e-3)


def test_peak_torque_and_load_torque() -> None:
    period_s = 280e-6
    plant = TorqueDrive(viscous_nm_s_per_rev=0.0, coulomb_nm=0.0, peak_torque_nm=1.0, load_torque_nm=0.4)
    inertia = TURN * plant.inertia_kg_m2
    for volts, enabled, torque in ((10.0, 1, 0.6), (-10.0, 1, -1.4), (10.0, 0, -0.4)):
        rig = Rig(plant, period_s, enabled=enabled)
        rig.step(volts)
        assert rig["true_velocity"] == pytest.approx(torque / inertia * period_s, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "parameter", "value"),
    [
        (VelocityDrive, "loop_time_constant_s", 0.0),
        (VelocityDrive, "command_lag_s", -1.0),
        (TorqueDrive, "inertia_kg_m2", 0.0),
        (TorqueDrive, "coulomb_nm", math.nan),
    ],
)
def test_impossible_parameters_are_named(kind: type, parameter: str, value: float) -> None:
    with pytest.raises(ValueError, match=parameter):
        kind(**{parameter: value})

"""Drives and loads against independent solutions of their differential equations."""

from __future__ import annotations

import math

import numpy as np
import pytest

from emulator.engine import EncoderTraits, TorqueDrive, VelocityDrive
from tests.engine.rig import PERIODS_S, TURN, Rig, exact_linear, volts_sequence


@pytest.mark.parametrize("period_s", PERIODS_S)
@pytest.mark.parametrize("lag_s", [0.0003, 0.002, 0.00200000001, 0.005])
def test_velocity_drive_is_exact_under_zero_order_hold(period_s: float, lag_s: float) -> None:
    plant = VelocityDrive(command_lag_s=lag_s, max_acceleration_rev_s2=math.inf)
    rig, volts = Rig(plant, period_s), volts_sequence(60)
    for u in volts:
        rig.step(u)
    tau = plant.loop_time_constant_s
    system = np.array([[0.0, 1.0, 0.0], [0.0, -1 / tau, 1 / tau], [0.0, 0.0, -1 / lag_s]])
    expected = exact_linear(system, np.array([0.0, 0.0, plant.speed_per_volt_rev_s / lag_s]), volts, period_s)[-1]
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
    expected = exact_linear(system, inputs, steady, period_s)[-1]
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
        (TorqueDrive, "inertia_kg_m2", -1e-4),
        (TorqueDrive, "torque_per_volt_nm", math.inf),
        (TorqueDrive, "load_torque_nm", math.nan),
        (TorqueDrive, "backlash_rev", -1.0),
        (VelocityDrive, "speed_per_volt_rev_s", math.inf),
        (VelocityDrive, "load_torque_nm", 1.0),
    ],
)
def test_impossible_parameters_are_named(kind: type, parameter: str, value: float) -> None:
    with pytest.raises(ValueError, match=parameter):
        kind(**{parameter: value})


def test_a_load_makes_a_drive_without_integrator_droop() -> None:
    """J w' = Kv (command - w) - T settles Kv's share below the command, with the loop's own time constant."""
    period_s = 280e-6
    rig = Rig(
        VelocityDrive(droop_rev_s_per_nm=0.5, load_torque_nm=2.0, command_lag_s=0.0), period_s, true_velocity=10.0
    )
    speeds = rig.record(["true_velocity"], [1.0] * 100)[:, 0]
    t = period_s * np.arange(1, 101)
    assert speeds == pytest.approx(9.0 + np.exp(-t / 0.002), rel=1e-12)


@pytest.mark.parametrize("plant", [VelocityDrive(backlash_rev=0.01), TorqueDrive(backlash_rev=0.01, coulomb_nm=0.0)])
def test_backlash_is_hysteresis_of_exactly_the_width_set(plant: VelocityDrive | TorqueDrive) -> None:
    rig = Rig(plant, 280e-6, EncoderTraits(on_load=True))
    rows = rig.record(["true_position", "load_position"], [0.1 * math.cos(0.01 * k) for k in range(3000)])
    gap = rows[:, 0] - rows[:, 1]
    assert gap.max() == pytest.approx(0.005, abs=1e-12)
    assert gap.min() == pytest.approx(-0.005, abs=1e-12)
    moved, inside = np.diff(rows[:, 1]) != 0.0, np.abs(gap[1:]) < 0.005 - 1e-9
    assert inside.any() and moved.any()
    assert not (moved & inside).any(), "the load moves only where the play is used up"
    assert rig["encoder_counts"] == math.floor(rows[-1, 1] * 4000)

"""What the control modes are good for, on plants: the claims of the manual's pages."""

from __future__ import annotations

import numpy as np
import pytest

from emulator.rmc.device import RmcDevice
from tests.rmc.rig import CYLINDER, command, device, run, trace

POSITION_PID, POSITION_I_PD, VELOCITY_PID, VELOCITY_I_PD = 0.0, 1.0, 4.0, 5.0

SPINDLE = """
[rmc]
axes = 1
enabled_at_start = true
[axis1]
plant = { preset = "drooping_spindle" }
encoder = { counts_per_rev = 10_000 }
[axis1.rmc.parameters]
PosScale = 0.0001
VelocityErrorTolerance = 1000.0
"""


def steady_error(rig: RmcDevice, velocity: float) -> float:
    """Position error while the target moves on at a constant velocity, averaged over the counts' edges."""
    command(rig, 37.0, velocity, 100.0, 100.0, 4.0)
    run(rig, 1.0)
    error = float(trace(rig, 0.2, "position_error")["position_error"].mean())
    command(rig, 6.0, 100.0)
    run(rig, 1.0)
    return error


def peak_error(rig: RmcDevice, velocity: float) -> float:
    """Largest position error from rest up to a constant velocity, with its sign."""
    command(rig, 37.0, velocity, 100.0, 100.0, 4.0)
    errors = trace(rig, 0.5, "position_error")["position_error"]
    command(rig, 6.0, 100.0)
    run(rig, 1.0)
    return float(errors[np.abs(errors).argmax()])


def test_ratioed_gains_track_equally_both_ways() -> None:
    """The manual's cylinder with its rounded feed forwards, ratioed: moves out and in are mirror images."""
    rig = device(ProportionalGain=40.0, VelocityFF=3.33, VelocityFFNegative=4.35)
    out, back = steady_error(rig, 3.0), steady_error(rig, -3.0)
    assert abs(out) < 0.003
    assert abs(back) < 0.003
    assert peak_error(rig, 3.0) == pytest.approx(-peak_error(rig, -3.0), rel=0.03)


def test_symmetrical_gains_do_not() -> None:
    """One feed forward fits one direction; the other lags, or leads, by what the gain must make up."""
    rig = device(ProportionalGain=40.0, VelocityFF=3.33, PriControlBits=0x11)
    out, back = steady_error(rig, 3.0), steady_error(rig, -3.0)
    missing = (10.0 / 2.3 - 3.33) * 3.0
    assert abs(out) < 0.003
    assert back == pytest.approx(-missing / 40.0, rel=0.02)


def test_unratioed_loop_gains_differ() -> None:
    """Without feed forward a lag is velocity over loop gain, and the two loop gains are those of the cylinder."""
    rig = device(ProportionalGain=40.0, PriControlBits=0x11)
    out, back = steady_error(rig, 3.0), steady_error(rig, -3.0)
    assert out == pytest.approx(3.0 / (4.0 * 3.0), rel=0.01)
    assert back == pytest.approx(-3.0 / (4.0 * 2.3), rel=0.01)


def test_velocity_pid_holds_a_velocity_through_a_load_step() -> None:
    rig = device(SPINDLE, ProportionalGain=2.0, IntegralGain=40.0, VelocityFF=10.0 / 6.0)
    command(rig, 68.0, VELOCITY_PID)
    command(rig, 37.0, 20.0, 100.0, 100.0, 1.0)
    run(rig, 2.0)
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(20.0, rel=1e-3)
    rig.change_machine(0, load_torque_nm=5.0)
    speeds = []
    for _ in range(1000):
        run(rig, 0.001)
        speeds.append(float(rig.memory.bodies[0]["true_velocity"]))
    assert 19.2 < min(speeds) < 19.98, "the load is felt"
    assert speeds[-1] == pytest.approx(20.0, rel=1e-3), "and made up for: the droop alone would cost 1 rev/s"
    lost = rig.axes[0]["target_position"] - 20.0 * rig.now_ns * 1e-9
    assert lost < 0.0, "velocity control does not catch up the position it has lost"


def test_without_the_integrator_the_droop_stays() -> None:
    """Proportional control leaves droop / (1 + loop gain)."""
    rig = device(SPINDLE, ProportionalGain=2.0, VelocityFF=10.0 / 6.0)
    command(rig, 68.0, VELOCITY_PID)
    command(rig, 37.0, 20.0, 100.0, 100.0, 1.0)
    rig.change_machine(0, load_torque_nm=5.0)
    run(rig, 3.0)
    loop_gain = 2.0 * 0.1 * 6.0
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(20.0 - 1.0 / (1.0 + loop_gain), abs=2e-3)


def step(mode: float, *, limit: float = 10.0, **gains: float) -> np.ndarray:
    """Actual position after a step of the target by 1, in pu."""
    text = CYLINDER.replace("axes = 1", f'axes = 1\noutput_limit_v = {limit}\nautostop = "external_halt"')
    rig = device(text, **gains)
    command(rig, 68.0, mode)
    command(rig, 23.0, 1.0, 0.0)
    return trace(rig, 3.0, "actual_position")["actual_position"]


GAINS = {"ProportionalGain": 60.0, "IntegralGain": 300.0, "PriControlBits": 0x11}


def test_a_step_overshoots_under_pid_and_not_under_i_pd() -> None:
    """The same gains. A PID must overshoot: its integrator has wound up by the whole area of the error on the way."""
    assert step(POSITION_PID, **GAINS).max() > 1.1
    quiet = step(POSITION_I_PD, **GAINS)
    assert quiet.max() < 1.0005
    assert quiet[-1] == pytest.approx(1.0, abs=1e-3)


def test_saturation_disturbs_pid_and_not_i_pd() -> None:
    """With a tenth of the output the axis needs ten times as long; only the PID pays for it by overshoot."""
    assert step(POSITION_PID, limit=0.5, **GAINS).max() > 1.01
    slow = step(POSITION_I_PD, limit=0.5, **GAINS)
    assert slow.max() < 1.002
    assert slow[-1] == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize(("proportional", "integral"), [(50.0, 200.0), (50.0, 100.0), (100.0, 500.0)])
def test_lag_of_position_i_pd(proportional: float, integral: float) -> None:
    """A target at constant velocity is followed Kp v / Ki behind."""
    rig = device(ProportionalGain=proportional, IntegralGain=integral, PriControlBits=0x11, RequestedJerk=0.0)
    command(rig, 68.0, POSITION_I_PD)
    command(rig, 37.0, 0.5, 5.0, 5.0, 4.0)
    run(rig, 5.0)
    error = trace(rig, 0.1, "position_error")["position_error"].mean()
    assert error == pytest.approx(proportional * 0.5 / integral, rel=2e-3)
    assert not rig.axes[0].integer("errors"), "the following error is not used in I-PD"


def test_speed_limit_of_an_i_pd_move() -> None:
    rig = device(ProportionalGain=50.0, IntegralGain=200.0, PriControlBits=0x11)
    command(rig, 28.0, 5.0, 2.0)
    speeds = []
    for _ in range(1500):
        run(rig, 0.001)
        speeds.append(float(rig.memory.bodies[0]["true_velocity"]))
    assert max(speeds) == pytest.approx(2.0, rel=0.01)
    run(rig, 4.0)
    assert rig.axes[0]["actual_position"] == pytest.approx(5.0, abs=1e-3)


def test_integrator_does_not_grow_in_saturation() -> None:
    """Against a stop in the way the integral term ends where the output saturates and stays there."""
    text = CYLINDER.replace("valve_hz = 200.0", "valve_hz = 200.0, extended_stop_units = 0.5")
    rig = device(
        text, ProportionalGain=20.0, IntegralGain=500.0, AutoStopCfg1=0o1111111111, PositionErrorTolerance=100.0
    )
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(rig, 3.0)
    axis = rig.axes[0]
    held = axis["term_i"]
    assert axis.integer("saturated") == 1
    assert held == pytest.approx(100.0 - 20.0 * 0.5, abs=1.0), "the sum is at the limit, not the integrator"
    run(rig, 1.0)
    assert axis["term_i"] == held


def test_deadband_of_a_valve_with_overlap_is_made_up_for() -> None:
    """With half a volt of overlap in the valve, the Output Deadband gives the accuracy back."""
    text = CYLINDER.replace("valve_hz = 200.0", "valve_hz = 200.0, overlap_v = 0.5")
    errors = []
    for deadband in (0.0, 0.48):
        rig = device(text, ProportionalGain=40.0, OutputDeadband=deadband, DeadbandTolerance=0.001)
        command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
        run(rig, 5.0)
        errors.append(abs(rig.axes[0]["position_error"]))
    assert errors[0] == pytest.approx(5.0 / 40.0, rel=0.05), "5 % of error output stay inside the overlap"
    assert errors[1] < errors[0] / 20.0


def test_output_bias_takes_the_drift_out_of_a_valve() -> None:
    rig = device(OutputBias=-0.2)
    command(rig, 10.0, 0.2, 100.0)
    run(rig, 1.0)
    assert rig.axes[0]["pins_v"] == pytest.approx(0.0, abs=1e-8)
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(0.0, abs=1e-6)


def test_velocity_i_pd_reaches_a_step_without_overshoot() -> None:
    rig = device(SPINDLE, ProportionalGain=1.0, IntegralGain=20.0)
    command(rig, 38.0, 10.0)
    speeds = []
    for _ in range(3000):
        run(rig, 0.001)
        speeds.append(float(rig.memory.bodies[0]["true_velocity"]))
    assert max(speeds) < 10.05
    assert speeds[-1] == pytest.approx(10.0, abs=0.02)


def test_feed_forward_is_learnt_from_a_move_each_way() -> None:
    """Feed Forward Adjust after constant velocity gives what the cylinder's speeds say: 10/3 and 10/2.3."""
    rig = device(ProportionalGain=60.0, IntegralGain=100.0)
    for velocity, element, truth in ((3.0, 65, 10.0 / 3.0), (-3.0, 68, 10.0 / 2.3)):
        command(rig, 37.0, velocity, 100.0, 100.0, 4.0)
        run(rig, 2.0)
        command(rig, 69.0)
        assert rig.parameters[0][element] == pytest.approx(truth, rel=0.02)
        command(rig, 6.0, 100.0)
        run(rig, 1.0)
    command(rig, 71.0, 2.0)
    assert abs(steady_error(rig, 3.0)) < 0.004, "without integrator"

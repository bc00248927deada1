"""The target generator in the running kernel: moves, gears, tracking, open loop, quick moves."""

from __future__ import annotations

import numpy as np
import pytest

from emulator.rmc.device import RmcDevice
from protocol.rmc.bits import ControlMode, ErrorBits, StatusBits
from protocol.rmc.maps import Place
from tests.rmc.rig import command, device, run, set_parameters, trace

TWO_AXES = """
[rmc]
axes = 2
enabled_at_start = true
[axis1.rmc]
simulate = "first_order"
[axis1.rmc.parameters]
PosScale = 0.00001
NaturalFrequency = 0.005
VelocityFF = 10.0
ProportionalGain = 100.0
PositionErrorTolerance = 100.0
RequestedJerk = 0.0
[axis2.rmc]
simulate = "first_order"
[axis2.rmc.parameters]
PosScale = 0.00001
NaturalFrequency = 0.005
VelocityFF = 10.0
ProportionalGain = 100.0
PositionErrorTolerance = 100.0
RequestedJerk = 0.0
"""

EXTERNAL_HALTS = 0o1111111111
"""AutoStops that only tell."""

TARGET_OF_0, TARGET_OF_1 = float(Place(8, 53).number), float(Place(9, 53).number)
VARIABLE_0 = float(Place(56, 0).number)


@pytest.fixture
def pair() -> RmcDevice:
    """Two simulated axes in closed loop at 0."""
    rig = device(TWO_AXES)
    for axis in (0, 1):
        command(rig, 5.0, 0.0, axis=axis)
    run(rig, 0.01)
    return rig


def state(rig: RmcDevice, axis: int = 0) -> int:
    """Target generator state, B and A."""
    return rig.axes[axis].integer("status") >> 10 & 3


def test_phases_of_a_move(pair: RmcDevice) -> None:
    command(pair, 20.0, 1.0, 1.0, 10.0, 10.0)
    phases = [(run(pair, 0.02), state(pair))[1] for _ in range(56)]
    assert phases[0] == 1
    assert phases[20] == 2
    assert phases[53] == 3
    assert phases[-1] == 0
    running = phases[: phases.index(0)]
    assert running == sorted(running)


def test_a_new_target_in_motion(pair: RmcDevice) -> None:
    """Sent back in full run: the target brakes, turns and arrives; nothing jumps."""
    command(pair, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(pair, 0.5)
    command(pair, 20.0, 0.0, 1.0, 10.0, 10.0)
    seen = trace(pair, 1.2, "target_position", "target_velocity")
    assert np.abs(np.diff(seen["target_velocity"])).max() == pytest.approx(0.01, rel=1e-6)
    assert seen["target_position"].max() == pytest.approx(0.45 + 0.05, abs=1e-3)
    assert seen["target_position"][-1] == 0.0


def test_the_same_command_again_changes_nothing(pair: RmcDevice) -> None:
    set_parameters(pair, RequestedJerk=1000.0)
    set_parameters(pair, 1, RequestedJerk=1000.0)
    for axis in (0, 1):
        command(pair, 20.0, 1.0, 1.0, 10.0, 10.0, axis=axis)
    run(pair, 0.05)
    command(pair, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(pair, 0.02)
    assert pair.axes[0]["target_position"] == pair.axes[1]["target_position"]
    command(pair, 20.0, 1.0, 1.0, 10.0, 9.0)
    run(pair, 0.01)
    assert pair.axes[0]["target_position"] != pair.axes[1]["target_position"], "another command resets acceleration"


def test_relative_moves_count_from_what_was_asked(pair: RmcDevice) -> None:
    command(pair, 20.0, 2.0, 1.0, 10.0, 10.0)
    run(pair, 0.5)
    target = pair.axes[0]["target_position"]
    for base, start in ((0.0, 2.0), (2.0, None)):
        command(pair, 21.0, 1.0, 1.0, 10.0, 10.0, base)
        expected = (target if start is None else start) + 1.0
        assert pair.axes[0]["command_position"] == pytest.approx(expected)


def test_time_moves(pair: RmcDevice) -> None:
    command(pair, 23.0, 1.0, 0.5)
    seen = trace(pair, 0.51, "target_position", "target_done")
    assert np.argmax(seen["target_done"]) == 499
    assert seen["target_position"][249] == pytest.approx(0.5), "symmetrical about the middle"
    command(pair, 24.0, 0.25, 0.0, 0.0)
    run(pair, 0.001)
    assert pair.axes[0]["target_position"] == 1.25, "no time is a step"


def test_an_advanced_time_move_goes_on_with_its_velocity(pair: RmcDevice) -> None:
    command(pair, 26.0, 1.0, 0.5, 0.0, 1.0)
    seen = trace(pair, 2.0, "target_position", "target_velocity")
    assert seen["target_position"][999] == pytest.approx(1.0)
    assert seen["target_velocity"][999] == pytest.approx(0.5)
    assert seen["target_position"][-1] == pytest.approx(1.5)


def test_speed_at_position(pair: RmcDevice) -> None:
    command(pair, 36.0, 1.0, 2.0)
    seen = trace(pair, 1.5, "target_position", "target_velocity")
    reached = int(np.argmax(seen["target_velocity"] >= 2.0 - 1e-9))
    assert seen["target_position"][reached] == pytest.approx(1.0, abs=2e-3)
    assert seen["target_position"][-1] == pytest.approx(1.0 + 2.0 * 0.5, abs=2e-3)


def test_jerk_of_an_s_curve_feeds_forward(pair: RmcDevice) -> None:
    set_parameters(pair, RequestedJerk=1000.0, JerkFF=0.001)
    command(pair, 20.0, 1.0, 1.0, 10.0, 10.0)
    seen = trace(pair, 0.1, "target_acceleration", "target_jerk", "term_jff")
    middle = 0.5 * (seen["target_jerk"][1:] + seen["target_jerk"][:-1])
    assert np.diff(seen["target_acceleration"]) == pytest.approx(0.001 * middle, abs=0.02)
    assert seen["term_jff"] == pytest.approx(0.001 * seen["target_jerk"])
    assert seen["target_acceleration"].max() == pytest.approx(15.0)


def test_a_gear_by_time_closes_its_clutch_and_then_never_drifts(pair: RmcDevice) -> None:
    command(pair, 30.0, 3.0, 7.0, TARGET_OF_0, 0.2, axis=1)
    command(pair, 37.0, 1.0, 10.0, 10.0, 4.0)
    run(pair, 0.15)
    assert state(pair, 1) == 1
    run(pair, 0.5)
    assert state(pair, 1) == 2
    start = [axis["target_position"] for axis in pair.axes]
    run(pair, 10.0)
    moved = [axis["target_position"] - was for axis, was in zip(pair.axes, start, strict=True)]
    assert moved[1] / moved[0] == pytest.approx(3.0 / 7.0, rel=1e-12)
    assert pair.axes[1]["target_velocity"] == pytest.approx(3.0 / 7.0)


def test_a_gear_by_rate_accelerates_to_its_master(pair: RmcDevice) -> None:
    command(pair, 37.0, 1.0, 100.0, 100.0, 4.0)
    run(pair, 0.1)
    command(pair, 39.0, 2.0, 1.0, TARGET_OF_0, 10.0, axis=1)
    seen = trace(pair, 0.5, "target_velocity", "gear_locked", axis=1)
    locked = int(np.argmax(seen["gear_locked"]))
    assert locked == pytest.approx(200, abs=2), "2 pu/s at 10 pu/s2"
    assert np.diff(seen["target_velocity"][:locked]) == pytest.approx(0.01)
    assert seen["target_velocity"][-1] == pytest.approx(2.0)


def test_a_gear_by_distance_meets_its_master(pair: RmcDevice) -> None:
    """Flying shear: from rest, at the master's 1.0 the slave is at 0.3 with half its velocity."""
    command(pair, 32.0, 0.5, TARGET_OF_0, 1.0, 0.3, 0.4, 1.0, 0.0, axis=1)
    command(pair, 37.0, 1.0, 10.0, 10.0, 4.0)
    masters, slaves = [], []
    for _ in range(2000):
        run(pair, 0.001)
        masters.append(pair.axes[0]["target_position"])
        slaves.append(pair.axes[1]["target_position"])
    slave = np.interp([0.5, 0.6, 0.8, 1.0, 1.4], masters, slaves)
    assert slave[[0, 1, 3, 4]] == pytest.approx([0.0, 0.0, 0.3, 0.5], abs=2e-3)
    assert 0.0 < slave[2] < 0.3
    assert np.abs(np.diff(slaves)).max() < 0.002, "it never jumps"


@pytest.mark.parametrize(("end_point", "beyond"), [(0, 2.0), (1, 2.0), (2, 4.0)])
def test_a_gear_map_and_its_ends(pair: RmcDevice, end_point: int, beyond: float) -> None:
    set_parameters(pair, 1, ProportionalGain=10.0, VelocityFF=0.0, AutoStopCfg2=EXTERNAL_HALTS)
    command(pair, 25.0, VARIABLE_0, 0.0, 10.0, 0.0, 2.0, float(end_point), axis=1)
    for master, slave in ((5.0, 1.0), (10.0, 2.0), (20.0, beyond)):
        pair.memory.variables[0] = master
        run(pair, 0.002)
        assert pair.axes[1]["target_position"] == pytest.approx(slave)
    fault = ErrorBits.RUN_TIME if end_point == 0 else 0
    assert pair.axes[1].integer("errors") & ErrorBits.RUN_TIME == fault


def test_a_gear_map_does_not_start_with_a_jump(pair: RmcDevice) -> None:
    set_parameters(pair, 1, PositionErrorTolerance=0.25)
    pair.memory.variables[0] = 5.0
    command(pair, 25.0, VARIABLE_0, 0.0, 10.0, 0.0, 2.0, 1.0, axis=1)
    assert pair.axes[1].integer("errors") == ErrorBits.COMMAND
    assert pair.axes[1]["target_position"] == 0.0


def test_tracking_keeps_its_limits_and_does_not_overshoot(pair: RmcDevice) -> None:
    command(pair, 57.0, VARIABLE_0, 2.0, 20.0, 1000.0, 0.0)
    run(pair, 0.1)
    pair.memory.variables[0] = 5.0
    seen = trace(pair, 6.0, "target_position", "target_velocity", "target_acceleration")
    assert seen["target_velocity"].max() <= 2.0 + 1e-9
    assert np.abs(seen["target_acceleration"]).max() <= 20.0 + 1e-9
    assert np.abs(np.diff(seen["target_acceleration"])).max() <= 1.0 + 1e-9
    assert seen["target_position"].max() < 5.001
    assert seen["target_position"][-1] == pytest.approx(5.0, abs=1e-3)


def test_tracking_a_moving_master_has_no_lag_in_the_end(pair: RmcDevice) -> None:
    command(pair, 57.0, TARGET_OF_0, 5.0, 50.0, 2500.0, 0.0, axis=1)
    command(pair, 37.0, 1.0, 10.0, 10.0, 4.0)
    run(pair, 5.0)
    assert pair.axes[1]["target_position"] == pytest.approx(pair.axes[0]["target_position"], abs=5e-3)


def test_the_deadband_of_tracking(pair: RmcDevice) -> None:
    command(pair, 57.0, VARIABLE_0, 2.0, 20.0, 1000.0, 0.1)
    pair.memory.variables[0] = 0.09
    run(pair, 1.0)
    assert pair.axes[0]["target_position"] == 0.0
    pair.memory.variables[0] = 0.11
    run(pair, 3.0)
    assert pair.axes[0]["target_position"] == pytest.approx(0.11, abs=1e-3)


def test_tracking_in_i_pd_takes_the_master_as_it_is(pair: RmcDevice) -> None:
    set_parameters(pair, IntegralGain=500.0)
    command(pair, 58.0, VARIABLE_0, 1.0)
    pair.memory.variables[0] = 0.5
    run(pair, 0.002)
    assert pair.axes[0]["target_position"] == 0.5
    assert pair.axes[0].mode == ControlMode.POSITION_I_PD
    run(pair, 3.0)
    assert pair.axes[0]["actual_position"] == pytest.approx(0.5, abs=1e-3)


def test_open_loop_ramps_and_its_phases(pair: RmcDevice) -> None:
    command(pair, 10.0, 2.0, 10.0)
    run(pair, 0.1)
    assert (pair.axes[0]["control_v"], state(pair)) == (pytest.approx(1.0), 1)
    run(pair, 0.2)
    assert (pair.axes[0]["control_v"], state(pair)) == (2.0, 2)
    command(pair, 22.0, 10.0)
    run(pair, 0.1)
    assert (pair.axes[0]["control_v"], state(pair)) == (pytest.approx(1.0), 3)
    run(pair, 0.2)
    assert (pair.axes[0]["control_v"], state(pair)) == (0.0, 0)
    assert StatusBits.OPEN_LOOP & pair.axes[0].integer("status")


def test_a_stop_from_open_loop_ends_in_closed_loop(pair: RmcDevice) -> None:
    command(pair, 10.0, 2.0, 100.0)
    run(pair, 0.5)
    command(pair, 6.0, 10.0)
    run(pair, 0.1)
    assert pair.axes[0].mode == ControlMode.OPEN_LOOP
    run(pair, 0.5)
    assert pair.axes[0].mode == ControlMode.POSITION_PID
    assert pair.axes[0]["actual_position"] == pytest.approx(pair.axes[0]["target_position"], abs=0.01)


@pytest.mark.parametrize("goal", [3.0, -3.0])
def test_a_quick_move(pair: RmcDevice, goal: float) -> None:
    """Open loop at 5 V on the way, closed loop for the stop; at the goal within the usual."""
    command(pair, 15.0, goal, 5.0, 100.0, 50.0)
    volts = trace(pair, 0.3, "control_v", "mode")
    assert np.abs(volts["control_v"]).max() == 5.0
    assert volts["mode"][-1] == ControlMode.OPEN_LOOP
    run(pair, 2.0)
    axis = pair.axes[0]
    assert axis.mode == ControlMode.POSITION_PID
    assert axis["target_position"] == goal
    assert axis["actual_position"] == pytest.approx(goal, abs=0.01)
    assert axis.integer("status") & StatusBits.IN_POSITION


def test_stop_in_i_pd_brings_the_target_back(pair: RmcDevice) -> None:
    set_parameters(pair, IntegralGain=500.0)
    command(pair, 28.0, 10.0, 2.0)
    run(pair, 1.0)
    assert pair.axes[0]["target_position"] == 10.0
    command(pair, 6.0, 20.0)
    run(pair, 2.0)
    axis = pair.axes[0]
    assert 1.0 < axis["target_position"] < 3.0
    assert axis["actual_position"] == pytest.approx(axis["target_position"], abs=1e-3)


def test_hold_keeps_a_moving_axis_where_it_is(pair: RmcDevice) -> None:
    command(pair, 37.0, 1.0, 10.0, 10.0, 4.0)
    run(pair, 1.0)
    where = pair.axes[0]["actual_position"]
    command(pair, 5.0, 1.0)
    assert pair.axes[0]["command_position"] == where
    run(pair, 1.0)
    assert pair.axes[0]["actual_position"] == pytest.approx(where, abs=0.01)


@pytest.mark.parametrize(("direction", "velocity"), [(1.0, 2.0), (-1.0, -2.0), (2.0, 2.0), (4.0, -2.0)])
def test_directions_of_move_velocity(pair: RmcDevice, direction: float, velocity: float) -> None:
    command(pair, 37.0, -2.0 if direction == 4.0 else 2.0, 100.0, 100.0, direction)
    run(pair, 0.5)
    assert pair.axes[0]["target_velocity"] == velocity
    assert pair.axes[0].integer("status") & StatusBits.TARGET_DONE


def test_origin_shifts_with_everything_on_it(pair: RmcDevice) -> None:
    command(pair, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(pair, 0.5)
    before = [pair.axes[0][name] for name in ("actual_position", "target_position", "command_position")]
    command(pair, 47.0, 100.0)
    after = [pair.axes[0][name] for name in ("actual_position", "target_position", "command_position")]
    assert np.subtract(after, before) == pytest.approx([100.0] * 3)
    run(pair, 2.0)
    assert pair.axes[0]["actual_position"] == pytest.approx(101.0, abs=1e-3)
    assert pair.parameters[0][1] == pytest.approx(100.0)
    command(pair, 49.0, 0.0)
    run(pair, 0.01)
    assert pair.axes[0]["actual_position"] == pytest.approx(0.0, abs=1e-3)


def test_sync_moves_of_one_write_arrive_together(pair: RmcDevice) -> None:
    """Three units and one, at the same speed: the shorter way is stretched, within its limits."""
    pair.execute({0: [13.0, 3.0, 2.0, 20.0, 20.0, 1.0], 1: [14.0, 1.0, 2.0, 20.0, 20.0, 0.0, 1.0]})
    speeds = trace(pair, 1.599, "target_velocity", axis=1)["target_velocity"]
    assert speeds.max() == pytest.approx(2.0 * 0.6 / 1.6)
    assert [axis.integer("target_done") for axis in pair.axes] == [0, 0]
    run(pair, 0.001)
    assert [axis.integer("target_done") for axis in pair.axes] == [1, 1]
    assert [axis["target_position"] for axis in pair.axes] == [3.0, 1.0]


def test_sync_moves_of_different_groups_do_not_wait(pair: RmcDevice) -> None:
    pair.execute({0: [13.0, 3.0, 2.0, 20.0, 20.0, 1.0], 1: [13.0, 1.0, 2.0, 20.0, 20.0, 2.0]})
    run(pair, 0.61)
    assert [axis.integer("target_done") for axis in pair.axes] == [0, 1]


def test_sync_stop_stops_its_group(pair: RmcDevice) -> None:
    pair.execute({0: [13.0, 3.0, 2.0, 20.0, 20.0, 1.0], 1: [13.0, 3.0, 2.0, 20.0, 20.0, 1.0]})
    run(pair, 0.5)
    command(pair, 17.0, 20.0, 1.0)
    run(pair, 0.2)
    assert [axis["target_velocity"] for axis in pair.axes] == [0.0, 0.0]
    assert all(0.9 < axis["target_position"] < 1.2 for axis in pair.axes)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_a_master_that_is_no_number_is_not_followed(pair: RmcDevice, value: float) -> None:
    set_parameters(pair, VelocityFF=0.0)
    command(pair, 30.0, 1.0, 1.0, VARIABLE_0, 0.0)
    run(pair, 0.01)
    pair.memory.variables[0] = 0.01
    run(pair, 0.1)
    pair.memory.variables[0] = value
    run(pair, 1.0)
    assert pair.axes[0]["target_position"] == pytest.approx(0.01)
    assert pair.axes[0]["actual_position"] == pytest.approx(0.01, abs=1e-3)


def test_a_plan_beyond_all_numbers_moves_nothing(pair: RmcDevice) -> None:
    """Factors of the host's that come to more than a number can be."""
    set_parameters(pair, JerkFF=3e38, AccelerationFF=3e38, DifferentialGain=3e38)
    command(pair, 27.0, 3e38, 3e38, 3e38, 1e-45, 0.0)
    run(pair, 0.1)
    assert abs(pair.axes[0]["control_v"]) <= 10.0
    command(pair, 3.0)
    run(pair, 0.2)
    assert pair.axes[0]["control_v"] == 0.0


@pytest.mark.parametrize(("number", "relative"), [(11, False), (12, True)])
def test_an_open_loop_output_over_distance(number: int, relative: bool) -> None:
    """The output is linear in the way made, and stays at its goal from the place on (M111, M128)."""
    built = device()
    command(built, 10, 1.0, 100.0)
    run(built, 0.5)
    begun = built.axes[0]["actual_position"]
    command(built, number, 0.2, 6.0 if relative else begun + 6.0)
    rows = trace(built, 6.0, "open_loop_v", "actual_position")
    way = np.clip((rows["actual_position"] - begun) / 6.0, 0.0, 1.0)
    assert np.abs(rows["open_loop_v"] - (1.0 - 0.8 * way)).max() == pytest.approx(0.0, abs=1e-9)
    assert 0.0 < way[100] < 0.5 and way[-1] == 1.0
    assert rows["open_loop_v"][-1] == 0.2
    assert built.axes[0]["target_done"] == 1


def test_an_output_over_distance_does_not_set_out_from_none() -> None:
    """In proportion to a way that is not made the output stays 0, wherever it is to go."""
    built = device()
    command(built, 11, 5.0, 10.0)
    run(built, 1.0)
    assert built.axes[0]["open_loop_v"] == 0.0
    assert built.axes[0]["target_done"] == 0

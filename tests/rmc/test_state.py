"""Axis state: enabling, halts and AutoStops, error bits, modes, filters, Simulate mode."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from emulator.rmc.axis import Complaint
from emulator.rmc.device import RmcDevice
from emulator.rmc.filters import sections
from emulator.rmc.layout import BODIES_PER_AXIS
from protocol.rmc.bits import AutoStop, ControlMode, ErrorBits, StatusBits
from protocol.rmc.words import bits_of
from tests.rmc.rig import CYLINDER, command, device, run, set_parameters, trace

FAULTY = CYLINDER.replace("enabled_at_start = true", 'enabled_at_start = true\nautostop = "LEVEL"')
LEVELS = {
    AutoStop.STATUS_ONLY: "status_only",
    AutoStop.EXTERNAL_HALT: "external_halt",
    AutoStop.CLOSED_LOOP_HALT: "closed_loop_halt",
    AutoStop.OPEN_LOOP_HALT: "open_loop_halt",
    AutoStop.DIRECT_OUTPUT_HALT: "direct_output_halt",
}


def moving(level: AutoStop = AutoStop.DIRECT_OUTPUT_HALT, **parameters: float) -> RmcDevice:
    """The cylinder at 3 units/s in closed loop."""
    rig = device(FAULTY.replace("LEVEL", LEVELS[level]))
    set_parameters(
        rig, ProportionalGain=40.0, VelocityFF=3.33, VelocityFFNegative=4.35, PositionErrorTolerance=0.5, **parameters
    )
    command(rig, 37.0, 3.0, 30.0, 30.0, 4.0)
    run(rig, 0.5)
    return rig


def status(rig: RmcDevice, axis: int = 0) -> StatusBits:
    return StatusBits(rig.axes[axis].integer("status"))


def errors(rig: RmcDevice, axis: int = 0) -> ErrorBits:
    return ErrorBits(rig.axes[axis].integer("errors"))


def lose_the_way(rig: RmcDevice) -> None:
    """A following error: the transducer slips by a whole unit."""
    rig.memory.bodies[0]["encoder_counts"] -= 100_000


# Enabling


def test_a_disabled_axis_refuses_motion_except_direct_output() -> None:
    rig = device(CYLINDER.replace("enabled_at_start = true", ""))
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    assert errors(rig) == ErrorBits.COMMAND
    assert StatusBits.ENABLED not in status(rig)
    command(rig, 67.0, 1.0)
    command(rig, 9.0, 1.0, 100.0)
    run(rig, 0.5)
    assert rig.axes[0].mode == ControlMode.DIRECT_OUTPUT
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(3.0, rel=1e-3)


def test_a_disabled_valve_is_shut() -> None:
    rig = moving()
    command(rig, 97.0, 0.0)
    run(rig, 0.5)
    assert status(rig) & (StatusBits.ENABLED | StatusBits.ENABLE_OUTPUT) == 0
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(0.0, abs=1e-6)


def test_command_7_enables_all_and_8_faults_all() -> None:
    rig = device("[rmc]\naxes = 3")
    command(rig, 7.0)
    assert all(StatusBits.ENABLED | StatusBits.ENABLE_OUTPUT in status(rig, axis) for axis in range(3))
    command(rig, 8.0)
    run(rig, 0.01)
    assert all(StatusBits.HALTED in status(rig, axis) for axis in range(3))
    assert not any(StatusBits.ENABLE_OUTPUT in status(rig, axis) for axis in range(3))


# Halts


def test_a_closed_loop_halt_ramps_the_target() -> None:
    rig = moving()
    set_parameters(rig, RequestedJerk=0.0)
    before = rig.axes[0]["target_position"]
    command(rig, 1.0)
    seen = trace(rig, 0.2, "target_velocity", "mode")
    assert seen["mode"].min() == ControlMode.POSITION_PID
    assert np.argmax(seen["target_velocity"] == 0.0) == pytest.approx(30, abs=1), "3 pu/s at 100 pu/s2"
    assert rig.axes[0]["target_position"] - before == pytest.approx(0.5 * 3.0 * 0.03 + 3.0 * 0.001), (
        "after the loop of the halt"
    )
    assert status(rig) & StatusBits.HALTED
    assert not status(rig) & StatusBits.IN_POSITION, "not set after a halt"


def test_an_open_loop_halt_ramps_the_output_and_never_turns_it() -> None:
    rig = moving()
    command(rig, 2.0)
    volts = trace(rig, 0.1, "control_v")["control_v"]
    assert volts[0] == pytest.approx(1.0, abs=0.01)
    assert np.diff(volts[:9]) == pytest.approx(-0.1, abs=1e-9), "100 V/s"
    assert volts.min() == 0.0
    assert rig.axes[0].mode == ControlMode.OPEN_LOOP
    assert status(rig) & StatusBits.ENABLE_OUTPUT


def test_a_direct_output_halt_ends_with_the_enable_output_off() -> None:
    rig = moving()
    command(rig, 3.0)
    run(rig, 0.1)
    assert rig.axes[0].mode == ControlMode.DIRECT_OUTPUT
    assert not status(rig) & StatusBits.ENABLE_OUTPUT
    assert rig.axes[0]["control_v"] == 0.0


@pytest.mark.parametrize("level", list(AutoStop))
def test_levels_of_an_autostop(level: AutoStop) -> None:
    rig = moving(level)
    lose_the_way(rig)
    run(rig, 0.1)
    assert ErrorBits.FOLLOWING in errors(rig)
    mode = {
        AutoStop.OPEN_LOOP_HALT: ControlMode.OPEN_LOOP,
        AutoStop.DIRECT_OUTPUT_HALT: ControlMode.DIRECT_OUTPUT,
    }.get(level, ControlMode.POSITION_PID)
    assert rig.axes[0].mode == mode
    assert bool(status(rig) & StatusBits.HALTED) == (level >= AutoStop.CLOSED_LOOP_HALT)
    assert bool(status(rig) & StatusBits.EXTERNAL_HALT) == (level == AutoStop.EXTERNAL_HALT)
    assert (rig.axes[0]["target_velocity"] == 0.0) == (level >= AutoStop.CLOSED_LOOP_HALT)


def test_each_error_bit_has_a_level_of_its_own() -> None:
    """Following error: status only; saturation: open loop halt."""
    rig = moving()
    word = sum((3 if bit == 2 else 0) << 3 * bit for bit in range(10)) | 4 << 18
    assert rig.parameters[0].write(106, word)
    set_parameters(rig, ProportionalGain=200.0)
    lose_the_way(rig)
    run(rig, 0.02)
    assert ErrorBits.FOLLOWING in errors(rig)
    assert rig.axes[0].mode == ControlMode.OPEN_LOOP, "200 %/pu on a whole unit saturate"


def test_no_autostop_fires_in_direct_output() -> None:
    rig = moving()
    command(rig, 9.0, 1.0, 1000.0)
    rig.axes[0].complain(ErrorBits.CONFIGURATION, Complaint.VALUE_OUT_OF_RANGE)
    run(rig, 0.1)
    assert rig.axes[0]["control_v"] == 1.0
    assert not status(rig) & StatusBits.HALTED


def test_halts_spread_through_a_group() -> None:
    group = "[axis{0}.rmc]\nhalt_group = {1}\n"
    text = "[rmc]\naxes = 3\nenabled_at_start = true\n" + group.format(1, 1) + group.format(2, 1) + group.format(3, 2)
    rig = device(text)
    for axis in range(3):
        command(rig, 5.0, 0.0, axis=axis)
    rig.axes[0].complain(ErrorBits.CONFIGURATION, Complaint.VALUE_OUT_OF_RANGE)
    run(rig, 0.01)
    assert [rig.axes[axis].mode for axis in range(3)] == [1, 1, 3]
    assert errors(rig, 1) == ErrorBits(0), "the cause is not copied"


def test_errors_stay_until_their_cause_has_gone_and_they_are_cleared() -> None:
    rig = moving()
    lose_the_way(rig)
    run(rig, 0.5)
    assert ErrorBits.FOLLOWING in errors(rig)
    command(rig, 4.0)
    assert errors(rig) == ErrorBits(0)
    assert not status(rig) & StatusBits.HALTED
    rig.memory.bodies[0]["encoder_sign"] = 0
    run(rig, 0.01)
    command(rig, 4.0)
    assert errors(rig) == ErrorBits.NO_TRANSDUCER, "still lost"


def test_a_motion_command_clears_them_too() -> None:
    rig = moving()
    lose_the_way(rig)
    run(rig, 0.5)
    command(rig, 97.0, 1.0)
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    assert errors(rig) == ErrorBits(0)
    run(rig, 3.0)
    assert status(rig) & StatusBits.IN_POSITION


# Error bits


def test_the_transducer_is_lost_after_three_loops_and_back_after_three() -> None:
    rig = moving(AutoStop.EXTERNAL_HALT)
    rig.memory.bodies[0]["encoder_sign"] = 0
    seen = [(run(rig, 0.001), bool(errors(rig) & ErrorBits.NO_TRANSDUCER))[1] for _ in range(3)]
    assert seen == [False, False, True]
    rig.memory.bodies[0]["encoder_sign"] = 1
    run(rig, 0.002)
    command(rig, 4.0)
    assert ErrorBits.NO_TRANSDUCER in errors(rig)
    run(rig, 0.001)
    command(rig, 4.0)
    assert ErrorBits.NO_TRANSDUCER not in errors(rig)


def test_a_magnetostrictive_transducer_has_an_end() -> None:
    text = CYLINDER.replace("[axis1.rmc.parameters]", '[axis1.rmc]\ntransducer = "mdt"\n[axis1.rmc.parameters]')
    rig = device(text)
    command(rig, 9.0, -1.0, 100.0)
    run(rig, 0.5)
    assert errors(rig) == ErrorBits.TRANSDUCER_OVERFLOW, "counts below 0; Direct Output may leave"
    command(rig, 9.0, 1.0, 100.0)
    run(rig, 1.0)
    command(rig, 4.0)
    assert errors(rig) == ErrorBits(0)


def test_travel_limits_hold_the_target_and_say_so() -> None:
    rig = moving(AutoStop.EXTERNAL_HALT)
    set_parameters(rig, PositiveTravelLimit=5.0, NegativeTravelLimit=-5.0)
    command(rig, 20.0, 8.0, 3.0, 30.0, 30.0)
    assert rig.axes[0]["command_position"] == 5.0
    assert errors(rig) == ErrorBits.COMMAND_MODIFIED
    command(rig, 37.0, 3.0, 30.0, 30.0, 4.0)
    run(rig, 3.0)
    assert ErrorBits.POSITIVE_OVERTRAVEL in errors(rig)
    command(rig, 20.0, 4.0, 3.0, 30.0, 30.0)
    run(rig, 3.0)
    assert rig.axes[0]["actual_position"] == pytest.approx(4.0, abs=0.01), "back again is allowed"


@pytest.mark.parametrize(
    ("bit", "said"),
    [
        (ErrorBits.FAULT_INPUT, StatusBits.FAULT_INPUT),
        (ErrorBits.POSITIVE_LIMIT_INPUT, StatusBits.POSITIVE_LIMIT_INPUT),
        (ErrorBits.NEGATIVE_LIMIT_INPUT, StatusBits.NEGATIVE_LIMIT_INPUT),
    ],
)
def test_inputs_show_live_and_as_errors(bit: ErrorBits, said: StatusBits) -> None:
    rig = moving()
    rig.set_input(0, bit, active=True)
    run(rig, 0.01)
    assert said in status(rig)
    assert StatusBits.HALTED in status(rig)
    rig.set_input(0, bit, active=False)
    run(rig, 0.01)
    assert said not in status(rig)
    assert bit in errors(rig), "latched"
    command(rig, 4.0)
    assert errors(rig) == ErrorBits(0)


def test_a_limit_switch_along_the_travel_stops_the_axis() -> None:
    rig = device(CYLINDER + "[axis1.travel]\npositive_limit_rev = 1.0", VelocityFF=3.33, VelocityFFNegative=4.35)
    set_parameters(rig, ProportionalGain=40.0)
    command(rig, 37.0, 1.0, 10.0, 10.0, 4.0)
    run(rig, 2.0)
    assert errors(rig) == ErrorBits.POSITIVE_LIMIT_INPUT
    assert 1.0 <= rig.true_position(0) < 1.1


def test_wires_of_the_machine_file() -> None:
    rig = device('bare = true\n[axis1.wires]\nnegative_limit = "closed"')
    run(rig, 0.01)
    assert errors(rig) == ErrorBits.POSITIVE_LIMIT_INPUT


def test_an_encoder_turned_by_something_else() -> None:
    """A conveyor's: half an axis, which another can follow (design choice, as on the OEM6250)."""
    rig = device(
        """
        [axis1.encoder_motion]
        kind = "constant"
        velocity_counts_s = 2500.0
        """
    )
    run(rig, 2.0)
    assert rig.axes[0]["actual_position"] == pytest.approx(5000.0, abs=3.0)  # of one loop
    assert rig.axes[0]["actual_velocity"] == pytest.approx(2500.0, abs=1000.0)  # of whole counts a loop


def test_saturation_is_an_error_bit() -> None:
    rig = moving(AutoStop.EXTERNAL_HALT)
    set_parameters(rig, PositionErrorTolerance=100.0)
    command(rig, 23.0, 10.0, 0.0)
    run(rig, 0.005)
    assert errors(rig) == ErrorBits.OUTPUT_SATURATED
    assert rig.axes[0]["control_v"] == 10.0


def test_velocity_control_watches_the_velocity_error_and_i_pd_nothing() -> None:
    rig = device(FAULTY.replace("LEVEL", "external_halt"), ProportionalGain=0.0)
    set_parameters(rig, PositionErrorTolerance=0.01, VelocityErrorTolerance=0.5)
    command(rig, 68.0, 4.0)
    command(rig, 37.0, 3.0, 30.0, 30.0, 4.0)
    run(rig, 0.5)
    assert errors(rig) == ErrorBits.FOLLOWING
    for code in (5.0, 1.0):
        command(rig, 10.0, 0.0, 100.0)
        run(rig, 0.5)
        command(rig, 68.0, code)
        command(rig, 37.0, 3.0, 30.0, 30.0, 4.0)
        run(rig, 0.5)
        assert errors(rig) == ErrorBits(0)


# Modes


def test_the_next_mode_waits_for_a_motion_command() -> None:
    rig = moving()
    command(rig, 68.0, 4.0)
    assert (rig.axes[0].mode, rig.axes[0].next_mode) == (ControlMode.POSITION_PID, ControlMode.VELOCITY_PID)
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    assert errors(rig) == ErrorBits.COMMAND, "a move to a position needs position control"


def test_modes_change_in_motion_without_a_step_of_the_output() -> None:
    rig = moving()
    set_parameters(rig, IntegralGain=200.0, VelocityErrorTolerance=100.0)
    run(rig, 1.0)
    for code in (1.0, 0.0, 1.0):
        before = rig.axes[0]["control_v"]
        command(rig, 68.0, code)
        command(rig, 37.0, 3.0, 30.0, 30.0, 4.0)
        run(rig, 0.001)
        assert rig.axes[0]["control_v"] == pytest.approx(before, abs=0.25)
        run(rig, 1.0)


# Filters


@pytest.mark.parametrize("cutoff_hz", [0.5, 25.0, 100.0, 400.0])
def test_filters_are_butterworth_of_fourth_order(cutoff_hz: float) -> None:
    rows = [[s["b0"], 2.0 * s["b0"], s["b0"], 1.0, s["a1"], s["a2"]] for s in sections(cutoff_hz, 0.001)]
    frequencies = np.array([0.1, 0.7, 1.0, 1.3, 3.0]) * min(cutoff_hz, 150.0)
    _, ours = signal.sosfreqz(np.array(rows), worN=frequencies, fs=1000.0)
    _, true = signal.sosfreqz(signal.butter(4, cutoff_hz, fs=1000.0, output="sos"), worN=frequencies, fs=1000.0)
    assert np.abs(ours) == pytest.approx(np.abs(true), rel=1e-6)


def test_the_filter_is_for_the_eye_unless_it_is_low_pass() -> None:
    rig = moving()
    seen = trace(rig, 0.2, "law_velocity", "shown_velocity", "actual_velocity")
    assert np.array_equal(seen["law_velocity"], seen["actual_velocity"])
    command(rig, 97.0, 0.0)
    assert rig.parameters[0].write(9, 1 << 4)
    seen = trace(rig, 0.2, "law_velocity", "shown_velocity")
    assert np.array_equal(seen["law_velocity"], seen["shown_velocity"])


# Simulate mode


def test_simulate_mode_leaves_the_machine_alone() -> None:
    text = CYLINDER.replace("[axis1.rmc.parameters]", '[axis1.rmc]\nsimulate = "second_order"\n[axis1.rmc.parameters]')
    rig = device(text, ProportionalGain=20.0, VelocityFF=10.0)
    command(rig, 20.0, 1.0, 1.0, 10.0, 10.0)
    run(rig, 3.0)
    assert rig.axes[0]["actual_position"] == pytest.approx(1.0, abs=1e-3)
    assert rig.true_position(0) == 0.0
    assert rig.memory.bodies[BODIES_PER_AXIS - 1]["true_position"] == pytest.approx(1.0, abs=1e-3)


def test_the_model_is_suspended_until_its_last_parameter() -> None:
    text = '[rmc]\naxes = 1\nenabled_at_start = true\n[axis1.rmc]\nsimulate = "first_order"\n'
    rig = device(text + "[axis1.rmc.parameters]\nPosScale = 0.0001\nNaturalFrequency = 0.01")
    command(rig, 9.0, 1.0, 1000.0)
    run(rig, 0.5)
    rig.write_parameter(0, 117, bits_of(2.0))
    frozen = rig.axes[0]["actual_position"]
    run(rig, 0.5)
    assert rig.axes[0]["actual_position"] == frozen
    rig.write_parameter(0, 118, bits_of(0.02))
    run(rig, 0.5)
    assert rig.axes[0]["actual_position"] == frozen
    rig.write_parameter(0, 127, bits_of(0.0))
    run(rig, 0.5)
    assert rig.memory.bodies[1]["true_velocity"] == pytest.approx(2.0)


# The whole


@pytest.mark.parametrize(("loop_us", "axes"), [(250, 1), (500, 2), (1000, 8), (2000, 4), (4000, 8)])
def test_loop_times_and_axes(loop_us: int, axes: int) -> None:
    rig = device(f"[rmc]\naxes = {axes}\nloop_us = {loop_us}\nenabled_at_start = true")
    for axis in range(axes):
        set_parameters(rig, axis, PositionErrorTolerance=1e6, PosScale=0.00025, ProportionalGain=50.0, VelocityFF=1.0)
        command(rig, 20.0, 1.0, 1.0, 10.0, 10.0, axis=axis)
    run(rig, 3.0)
    assert [rig.axes[axis]["actual_position"] for axis in range(axes)] == pytest.approx([1.0] * axes, abs=0.01)


def test_slices_of_time_make_no_difference() -> None:
    def story(slice_s: float) -> bytes:
        rig = moving()
        for _ in range(round(0.4 / slice_s)):
            run(rig, slice_s)
        return rig.snapshot()

    assert story(0.4) == story(0.001) == story(0.0125)


def test_compiled_and_interpreted_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    def story() -> bytes:
        rig = moving()
        command(rig, 30.0, 1.0, 2.0, float(56 * 4096), 0.1)
        run(rig, 0.1)
        command(rig, 57.0, float(56 * 4096), 2.0, 20.0, 1000.0, 0.0)
        run(rig, 0.1)
        lose_the_way(rig)
        run(rig, 0.1)
        return rig.snapshot()

    compiled = story()
    monkeypatch.setenv("OEM6250_KERNEL", "interpreted")
    assert story() == compiled


def test_advancing_to_a_change_stops_in_its_loop() -> None:
    rig = moving()
    command(rig, 20.0, 5.0, 3.0, 30.0, 30.0)
    assert rig.advance_to_change(rig.now_ns + 10_000_000_000, StatusBits.TARGET_DONE)
    assert status(rig) & StatusBits.TARGET_DONE
    assert rig.axes[0]["target_position"] == 5.0
    assert not rig.advance_to_change(rig.now_ns + 1_000_000_000, StatusBits.HALTED)

"""The worked numbers of the RMC's pages and of the formulas on them, one test a vector."""

from __future__ import annotations

import math

import numpy as np
import pytest

from emulator.rmc import laws
from emulator.rmc.output_stage import put_out_percent
from protocol.rmc.maps import MAPS, Place, address_of, place_at
from protocol.rmc.words import bits_of, from_words, halves, reals, to_words, value_of
from tests.rmc.rig import axis_record, command, device, run, set_parameters, trace

T = 0.001
FF = {"velocity_ff_positive": 3.33, "velocity_ff_negative": 4.35}


@pytest.mark.parametrize(
    ("positive", "negative", "velocity", "ratio"),
    [
        (3.33, 4.35, 1.0, 0.766),
        (3.33, 4.35, -1.0, 1.0),
        (0.0, 4.35, 1.0, 1.0),
        (0.0, 4.35, -1.0, 1.0),
        (3, 3, 1.0, 1.0),
    ],
)
def test_ratio_of_the_gains(positive: float, negative: float, velocity: float, ratio: float) -> None:
    """The page prints 0.766 for gains rounded to 3.33 and 4.35."""
    axis = axis_record(velocity_ff_positive=positive, velocity_ff_negative=negative, target_velocity=velocity)
    laws.feed_forward_of(axis, 0.0)
    assert axis["gain_ratio"] == pytest.approx(ratio, abs=0.001)


def test_at_rest_the_error_chooses_the_direction() -> None:
    axis = axis_record(**FF)
    assert laws.feed_forward_of(axis, 1.0) == 3.33
    assert laws.feed_forward_of(axis, -1.0) == 4.35


VELOCITY_GAINS = {"proportional": 2.0, "integral": 5.0, "differential": 0.1, "acceleration_ff": 0.02, **FF}


@pytest.mark.parametrize(
    ("symmetrical", "sign", "percent", "volts"),
    [(1, 1.0, 21.9825, 2.19825), (0, 1.0, 21.51295, 2.151295), (0, -1.0, -28.1025, -2.81025)],
)
def test_velocity_pid(symmetrical: int, sign: float, percent: float, volts: float) -> None:
    axis = axis_record(
        mode=laws.VELOCITY_PID,
        symmetrical=symmetrical,
        term_i=0.4 * sign,
        target_velocity=6.0 * sign,
        law_velocity=5.5 * sign,
        velocity_error=0.5 * sign,
        target_acceleration=20.0 * sign,
        law_acceleration=18.0 * sign,
        **VELOCITY_GAINS,
    )
    result = laws.closed_loop(axis, T)
    assert result == pytest.approx(percent, abs=1e-5)
    assert [axis["term_p"], axis["term_i"], axis["term_d"], axis["term_aff"]] == pytest.approx(
        [1.0 * sign, 0.4025 * sign, 0.2 * sign, 0.4 * sign]
    )
    put_out_percent(axis, result)
    assert axis["control_v"] == pytest.approx(volts, abs=1e-6)


def test_position_pid() -> None:
    axis = axis_record(
        symmetrical=1,
        proportional=20.0,
        integral=40.0,
        differential=0.5,
        velocity_ff_positive=3.33,
        term_i=1.0,
        position_error=0.05,
        command_position=20.0,
        target_velocity=5.0,
        law_velocity=4.8,
    )
    assert laws.closed_loop(axis, T) == pytest.approx(18.752)
    assert [axis["term_p"], axis["term_i"], axis["term_d"], axis["term_vff"]] == pytest.approx([1.0, 1.002, 0.1, 16.65])


def test_position_i_pd() -> None:
    """Three samples of a step's start; the velocity is that of the differences."""
    axis = axis_record(mode=laws.POSITION_I_PD, symmetrical=1, proportional=10.0, integral=100.0, differential=0.2)
    outputs = []
    for actual in (0.0, 0.0, 0.001, 0.003, 0.006):
        axis["previous_position"] = axis["actual_position"]
        axis["previous_velocity"] = axis["law_velocity"]
        axis["law_velocity"] = (actual - axis["actual_position"]) / T
        axis["actual_position"] = actual
        axis["position_error"] = 1.0 - actual
        outputs.append(laws.closed_loop(axis, T))
    assert outputs == pytest.approx([0.1, 0.2, 0.0899, -0.0304, -0.1610])


def test_velocity_i_pd() -> None:
    axis = axis_record(mode=laws.VELOCITY_I_PD, symmetrical=1, proportional=2.0, integral=50.0)
    outputs = []
    for actual in (0.0, 0.1, 0.25, 0.45):
        axis["previous_velocity"], axis["law_velocity"] = axis["law_velocity"], actual
        axis["velocity_error"] = 5.0 - actual
        outputs.append(laws.closed_loop(axis, T))
    assert outputs == pytest.approx([0.25, 0.295, 0.2325, 0.06])


@pytest.mark.parametrize(
    ("percent", "scale", "deadband", "limit", "bias", "invert", "saturated", "register", "pins"),
    [
        (95.0, 10.0, 0.3, 10.0, 0.5, 0, 0, 10.0, 10.0),
        (98.0, 10.0, 0.3, 10.0, 0.5, 0, 1, 10.0, 10.0),
        (50.0, 5.0, 0.0, 5.0, 0.0, 0, 0, 2.5, 2.5),
        (110.0, 5.0, 0.0, 5.0, 0.0, 0, 1, 5.0, 5.0),
        (-20.0, 10.0, 0.3, 10.0, 0.1, 1, 0, -2.2, 2.2),
    ],
)
def test_output_chain(
    percent: float,
    scale: float,
    deadband: float,
    limit: float,
    bias: float,
    invert: int,
    saturated: int,
    register: float,
    pins: float,
) -> None:
    axis = axis_record(
        output_scale=scale, output_deadband=deadband, output_limit=limit, output_bias=bias, invert_output=invert
    )
    put_out_percent(axis, percent)
    assert (axis["saturated"], axis["control_v"], axis["pins_v"]) == pytest.approx((saturated, register, pins))


def test_measured_velocity() -> None:
    """Five counts of 0.001 pu in a loop of 1 ms are 5 pu/s."""
    rig = device()
    set_parameters(rig, PosScale=0.001)
    run(rig, 0.01)
    body = rig.memory.bodies[0]
    body["encoder_counts"] += 5
    run(rig, 0.001)
    assert rig.axes[0]["actual_velocity"] == pytest.approx(5.0)


@pytest.mark.parametrize(("velocity", "gain"), [(6.0, 3.33), (-6.0, 0.0)])
def test_feed_forward_adjust(velocity: float, gain: float) -> None:
    rig = device()
    rig.axes[0].write(captured_pfid=19.98, captured_velocity=velocity)
    command(rig, 69.0)
    assert rig.parameters[0][65] == pytest.approx(gain)
    assert rig.parameters[0][68] == 0.0


@pytest.mark.parametrize(("actual", "there"), [(9.969, 0), (9.971, 1), (10.0, 1), (10.029, 1), (10.031, 0)])
def test_in_position(actual: float, there: int) -> None:
    from emulator.rmc.halts import arrived

    axis = axis_record(
        moves_to_position=1,
        target_position=10.0,
        command_position=10.0,
        actual_position=actual,
        in_position_tolerance=0.03,
    )
    assert arrived(axis) == there


@pytest.mark.parametrize(("jerk", "peak"), [(0.0, 50.0), (100_000.0, 75.0)])
def test_trapezoid_and_s_curve(jerk: float, peak: float) -> None:
    """0.1 s of acceleration over 0.25 pu, 1.9 s of cruise, 2.1 s in all, for both shapes."""
    rig = device(RequestedJerk=jerk)
    command(rig, 20.0, 10.0, 5.0, 50.0, 50.0)
    seen = trace(rig, 2.2, "target_position", "target_velocity", "target_acceleration", "target_done")
    assert seen["target_position"][99] == pytest.approx(0.25)
    assert seen["target_velocity"][99:1999] == pytest.approx(5.0)
    assert np.argmax(seen["target_done"]) == 2099
    assert seen["target_position"][-1] == 10.0
    assert np.abs(seen["target_acceleration"]).max() == pytest.approx(peak)


def test_addresses() -> None:
    old, new = MAPS["rmc75"], MAPS["rmc150"]
    printed = {
        Place(8, 0): 4097,
        Place(8, 8): 4113,
        Place(8, 33): 4163,
        Place(8, 53): 4203,
        new.status(1, 0): 4609,
        Place(9, 8): 4625,
        old.parameter(0, 61): 6267,
        old.parameter(0, 65): 6275,
        Place(15, 61): 7803,
        new.parameter(0, 60): 12409,
        new.parameter(0, 61): 12411,
        Place(24, 65): 12419,
        Place(24, 68): 12425,
        Place(24, 94): 12477,
        Place(24, 106): 12501,
        Place(24, 117): 12523,
        Place(31, 61): 15995,
        old.command(0): 12801,
        old.command(1): 12821,
        new.command(0): 20481,
        new.command(1): 20501,
        Place(16, 6): 8205,
        Place(56, 0): 28673,
        Place(57, 30): 29245,
        Place(12, 3): 6151,
        Place(9, 56): 4721,
    }
    for place, address in printed.items():
        assert address_of(place) == address
        assert place_at(address - 1) == (place, 0)
        assert place_at(address) == (place, 1)


@pytest.mark.parametrize(
    ("value", "low", "high"),
    [
        (20.0, 0x0000, 0x41A0),
        (276.0, 0x0000, 0x438A),
        (293.0, 0x8000, 0x4392),
        (97.0, 0x0000, 0x42C2),
        (-2.3, 0x3333, 0xC013),
        (3.33, 0x1EB8, 0x4055),
        (4.35, 0x3333, 0x408B),
    ],
)
def test_words_of_reals(value: float, low: int, high: int) -> None:
    assert halves(bits_of(value)) == (low, high)
    assert halves(bits_of(value), "high_first") == (high, low)
    assert value_of(bits_of(value)) == pytest.approx(value, rel=1e-7)


FRAME = "00 01 00 00 00 1f 00 10 50 00 00 0c 18 00 00 43 8a 00 00 41 20 00 00 40 a0 00 00 42 48 00 00 42 48 00 00 00 00"


def test_frame_of_a_move() -> None:
    """Move Absolute with REQ: address and words; test_wire sends the same bytes to a server."""
    data = bytes.fromhex(FRAME)
    address, words = int.from_bytes(data[8:10]), [int.from_bytes(data[i : i + 2]) for i in range(13, 37, 2)]
    assert place_at(address) == (MAPS["rmc150"].command(0), 0)
    assert words == to_words(reals(276.0, 10.0, 5.0, 50.0, 50.0, 0.0))
    assert [value_of(bits) for bits in from_words(words)] == [276.0, 10.0, 5.0, 50.0, 50.0, 0.0]


SIMULATED = """
[rmc]
axes = 1
enabled_at_start = true
autostop = "external_halt"
[axis1.rmc]
simulate = "{order}"
[axis1.rmc.parameters]
PosScale = 0.000001
{parameters}
"""


def test_simulator_of_first_order() -> None:
    rig = device(SIMULATED.format(order="first_order", parameters="NaturalFrequency = 0.75"))
    command(rig, 9.0, 1.0, 100_000.0)
    run(rig, 0.001)
    body = rig.memory.bodies[1]
    run(rig, 0.001)
    assert body["true_velocity"] == pytest.approx(0.00133244, rel=1e-5)
    for at, velocity in ((0.1, 0.12483), (0.75, 0.63212), (1.5, 0.86466), (3.0, 0.98168)):
        run(rig, at - (rig.now_ns / 1e9 - 0.001))
        assert body["true_velocity"] == pytest.approx(velocity, abs=2e-5)
        if at != 0.1:
            assert body["true_position"] == pytest.approx({0.75: 0.27591, 1.5: 0.85150, 3.0: 2.26374}[at], abs=2e-5)


def test_simulator_of_second_order() -> None:
    rig = device(SIMULATED.format(order="second_order", parameters="DampingFactor = 0.5"))
    command(rig, 9.0, 1.0, 100_000.0)
    run(rig, 0.001)
    body = rig.memory.bodies[1]
    speeds = []
    for _ in range(50):
        run(rig, 0.001)
        speeds.append(float(body["true_velocity"]))
    assert [speeds[at - 1] for at in (5, 10, 20, 30, 50)] == pytest.approx(
        [0.15678, 0.47961, 1.02697, 1.16146, 0.98982], abs=2e-5
    )
    assert max(speeds) == pytest.approx(1.16303, abs=1e-3)
    assert abs(np.argmax(speeds) + 1 - 28.87) < 1.0


@pytest.mark.parametrize(("velocity", "volts", "reached"), [(6.0, 1.998, 5.994), (-6.0, -2.61, -6.003)])
def test_perfect_feed_forward_on_the_cylinder(velocity: float, volts: float, reached: float) -> None:
    rig = device(ProportionalGain=0.0, VelocityFF=3.33, VelocityFFNegative=4.35)
    command(rig, 37.0, velocity, 1000.0, 1000.0, 4.0)
    run(rig, 1.0)
    assert rig.axes[0]["control_v"] == pytest.approx(volts)
    assert rig.memory.bodies[0]["true_velocity"] == pytest.approx(reached, rel=1e-6)


def test_loop_gain_is_equal_both_ways() -> None:
    """r Kp K: 0.7655 x 2 V/pu x 3 and 1 x 2 V/pu x 2.3."""
    gains = []
    for error, speed_per_v in ((1.0, 3.0), (-1.0, 2.3)):
        axis = axis_record(proportional=20.0, position_error=error, **FF)
        put_out_percent(axis, laws.closed_loop(axis, T))
        gains.append(axis["control_v"] / error * speed_per_v)
    assert gains == pytest.approx([4.593, 4.6], abs=0.001)


def test_gains_of_an_rmc100_are_carried_over() -> None:
    from protocol.rmc.conversion import Rmc100Gains, from_rmc100

    new = from_rmc100(
        Rmc100Gains(proportional=100.0, velocity_ff=333.0), counts=1000.0, length=10.0, loops_per_s=1000.0
    )
    assert (new.proportional, new.velocity_ff) == pytest.approx((100.0, 3.33))


def test_a_register_as_a_parameter() -> None:
    assert Place(8, 33).number == 32801
    assert Place.of_number(32801) == Place(8, 33)


def test_no_number_is_a_real_beyond_single_precision() -> None:
    assert value_of(bits_of(1e300)) == pytest.approx(3.4028235e38)
    assert math.isnan(value_of(bits_of(math.nan)))

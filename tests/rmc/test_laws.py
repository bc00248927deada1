"""Terms of higher order, the integrator's rules, and the deadband, on records alone."""

from __future__ import annotations

import pytest

from emulator.rmc import laws
from emulator.rmc.output_stage import deadband_share
from tests.rmc.rig import axis_record

T = 0.001

MEASURED = {
    "target_acceleration": 10.0,
    "law_acceleration": 4.0,
    "previous_law_acceleration": 1.0,
    "target_jerk": 300.0,
    "law_jerk": 100.0,
    "previous_jerk": 40.0,
    "target_velocity": 1.0,
    "law_velocity": 1.0,
    "previous_velocity": 1.0,
}
HIGH = {"double_differential": 0.5, "triple_differential": 0.01, "differential": 0.1, "symmetrical": 1}


@pytest.mark.parametrize(
    ("mode", "high_order", "differential", "double", "triple"),
    [
        (laws.POSITION_PID, laws.NO_HIGH_ORDER, 0.0, 0.0, 0.0),
        (laws.POSITION_PID, laws.ACCELERATION_CONTROL, 0.0, 0.5 * 6.0, 0.01 * 200.0),
        (laws.POSITION_PID, laws.ACTIVE_DAMPING, 0.0, -0.5 * 4.0, 0.0),
        (laws.VELOCITY_PID, laws.NO_HIGH_ORDER, 0.1 * 6.0, 0.0, 0.0),
        (laws.VELOCITY_PID, laws.ACCELERATION_CONTROL, 0.1 * 6.0, 0.5 * 200.0, 0.0),
        (laws.VELOCITY_PID, laws.ACTIVE_DAMPING, 0.0, -0.5 * 4.0, 0.0),
        (laws.POSITION_I_PD, laws.NO_HIGH_ORDER, 0.0, 0.0, 0.0),
        (laws.POSITION_I_PD, laws.ACCELERATION_CONTROL, 0.0, -0.5 * 3.0, -0.01 * 60.0),
        (laws.POSITION_I_PD, laws.ACTIVE_DAMPING, 0.0, -0.5 * 3.0, 0.0),
        (laws.VELOCITY_I_PD, laws.NO_HIGH_ORDER, -0.1 * 3.0, 0.0, 0.0),
        (laws.VELOCITY_I_PD, laws.ACCELERATION_CONTROL, -0.1 * 3.0, -0.5 * 60.0, 0.0),
        (laws.VELOCITY_I_PD, laws.ACTIVE_DAMPING, 0.0, -0.5 * 3.0, 0.0),
    ],
)
def test_terms_of_higher_order(mode: int, high_order: int, differential: float, double: float, triple: float) -> None:
    """Active damping takes the place of the double differential, and in velocity control of the differential (M986)."""
    axis = axis_record(mode=mode, high_order=high_order, **MEASURED, **HIGH)
    result = laws.closed_loop(axis, T)
    assert [axis["term_d"], axis["term_double"], axis["term_triple"]] == pytest.approx([differential, double, triple])
    assert result == pytest.approx(differential + double + triple)


def test_feed_forwards_are_outside_the_ratio_where_they_are_directional() -> None:
    """Velocity feed forward is that of its direction; acceleration and jerk feed forward are ratioed with the gains."""
    axis = axis_record(
        velocity_ff_positive=2.0,
        velocity_ff_negative=4.0,
        acceleration_ff=0.1,
        jerk_ff=0.001,
        target_velocity=3.0,
        target_acceleration=20.0,
        target_jerk=1000.0,
    )
    assert laws.closed_loop(axis, T) == pytest.approx(2.0 * 3.0 + 0.5 * (0.1 * 20.0 + 0.001 * 1000.0))


@pytest.mark.parametrize("mode", [laws.POSITION_I_PD, laws.VELOCITY_I_PD])
def test_feed_forwards_do_nothing_in_i_pd(mode: int) -> None:
    axis = axis_record(
        mode=mode, velocity_ff_positive=2.0, acceleration_ff=1.0, jerk_ff=1.0, target_velocity=3.0, target_jerk=5.0
    )
    assert laws.closed_loop(axis, T) == 0.0


def integrated(**fields: float) -> float:
    """The integral term one loop after 2 %, with 0.1 % to be added or taken away."""
    values = {"integral": 100.0, "term_i": 2.0, "position_error": 1.0, "command_position": 50.0, **fields}
    axis = axis_record(symmetrical=1, **values)
    laws.closed_loop(axis, T)
    return float(axis["term_i"])


@pytest.mark.parametrize(
    ("fields", "term"),
    [
        ({}, 2.1),
        ({"integrator_mode": laws.HELD}, 2.0),
        ({"integrator_mode": laws.ZERO}, 0.0),
        ({"saturated": 1}, 2.0),
        ({"saturated": -1}, 2.1),
        ({"saturated": -1, "position_error": -1.0}, 1.9),
        ({"deadband_tolerance": 1.5}, 2.0),
        ({"deadband_tolerance": 1.5, "position_error": -1.0}, 1.9),
        ({"deadband_tolerance": 1.5, "position_error": -1.0, "term_i": 0.04}, 0.0),
        ({"deadband_tolerance": 1.5, "target_velocity": 1.0}, 2.1),
        ({"command_position": 0.0, "half_count": 0.5}, 2.0),
        ({"term_i": 99.95}, 100.0),
    ],
    ids=str,
)
def test_rules_of_the_integrator(fields: dict[str, float], term: float) -> None:
    """Inside the tolerance at rest, within half a count, and in saturation it may only wind down (M977, M1001)."""
    assert integrated(**fields) == pytest.approx(term)


@pytest.mark.parametrize(
    ("fields", "share"),
    [
        ({"position_error": 0.5}, 1.0),
        ({"position_error": 0.5, "deadband_tolerance": 2.0}, 0.25),
        ({"position_error": -3.0, "deadband_tolerance": 2.0}, 1.0),
        ({"mode": laws.VELOCITY_PID, "deadband_tolerance": 2.0}, 0.0),
        ({"mode": laws.VELOCITY_PID, "deadband_tolerance": 2.0, "target_velocity": 1.0}, 1.0),
        ({"mode": laws.VELOCITY_PID}, 1.0),
    ],
    ids=str,
)
def test_share_of_the_deadband(fields: dict[str, float], share: float) -> None:
    assert deadband_share(axis_record(**fields)) == share

"""Switches that follow the shaft, home edges and index pulses caught by the servo sample."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import (
    AxisHardware,
    Engine,
    Event,
    Travel,
    VelocityDrive,
    Wire,
    plan_continuous,
    rates_for,
    wire_mask,
)

COUNTS = 4000
HOME, POSITIVE, NEGATIVE = (wire_mask(wire, 0) for wire in (Wire.HOME, Wire.POSITIVE_LIMIT, Wire.NEGATIVE_LIMIT))
LIMITS_CLOSED = POSITIVE | NEGATIVE | 1


def engine_with(travel: Travel, *, wires: int = LIMITS_CLOSED, index_phase_rev: float = 0.0) -> Engine:
    hardware = AxisHardware(VelocityDrive(), travel=travel, index_phase_rev=index_phase_rev)
    engine = Engine([hardware], rates=rates_for(2, 4))
    engine.set_wires(wires)
    engine.set_hard_limits(0, enable=0)
    engine.run(engine.next_system_update_ns)
    engine.enable(0)
    return engine


def run_at(engine: Engine, revolutions_s: float) -> None:
    state = engine.profile_state(0)
    engine.start_profile(0, plan_continuous(state.position, state.velocity, revolutions_s * COUNTS, 4e5, 4e5))


def until(engine: Engine, wanted: Event, timeout_s: float = 20.0) -> None:
    end_ns = engine.time_ns + round(timeout_s * 1e9)
    while engine.time_ns < end_ns:
        engine.run(end_ns)
        if engine.axis_events(0) & wanted:
            return
    raise AssertionError(f"no {wanted!r} within {timeout_s} s")


def events_within(engine: Engine, seconds: float) -> Event:
    """Every event of a stretch of time."""
    end_ns, seen = engine.time_ns + round(seconds * 1e9), Event.NONE
    while engine.time_ns < end_ns:
        engine.run(end_ns)
        seen |= engine.axis_events(0)
    return seen


def test_an_operated_switch_changes_its_contact_over() -> None:
    engine = engine_with(Travel(positive_limit_rev=1.0, negative_limit_rev=-1.0, home_from_rev=0.5, home_to_rev=0.75))
    assert engine.wires == LIMITS_CLOSED
    run_at(engine, 1.0)
    seen: list[tuple[float, int]] = []
    while engine.true_position_rev(0) < 1.1:
        engine.run(engine.next_system_update_ns)
        if not seen or seen[-1][1] != engine.wires:
            seen.append((engine.true_position_rev(0), engine.wires))
    assert [wires for _, wires in seen] == [
        LIMITS_CLOSED,
        LIMITS_CLOSED | HOME,
        LIMITS_CLOSED,
        LIMITS_CLOSED & ~POSITIVE,
    ]
    for (position, _), switch in zip(seen[1:], (0.5, 0.75, 1.0), strict=True):
        assert 0 <= position - switch < 1.0 * 2.24e-3 + 1e-6
    assert engine.resting_wires == LIMITS_CLOSED


def test_a_wire_set_while_its_switch_is_operated_is_that_of_the_switch_at_rest() -> None:
    engine = engine_with(Travel(home_from_rev=-0.1, home_to_rev=0.1))
    assert engine.wires & HOME
    engine.set_wires(engine.resting_wires | HOME)
    assert not engine.wires & HOME
    assert engine.resting_wires & HOME


def test_a_switch_operated_at_start_is_so_before_the_first_sample() -> None:
    hardware = AxisHardware(VelocityDrive(), travel=Travel(home_from_rev=-0.1, home_to_rev=0.1))
    engine = Engine([hardware], rates=rates_for(1, 4))
    assert engine.wires == HOME


@pytest.mark.parametrize(
    "positions",
    (
        {"positive_limit_rev": -1.0, "negative_limit_rev": 1.0},
        {"home_from_rev": 1.0, "home_to_rev": 1.0},
        {"home_from_rev": 1.0},
    ),
)
def test_switches_in_the_wrong_order_are_refused(positions: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="switch"):
        Travel(**positions)


@settings(max_examples=30, deadline=None)
@given(
    edge_rev=st.floats(0.2, 2.0),
    speed=st.floats(0.05, 5.0),
    direction=st.sampled_from((1, -1)),
)
def test_a_home_edge_is_caught_within_one_servo_sample(edge_rev: float, speed: float, direction: int) -> None:
    near, far = direction * edge_rev, direction * (edge_rev + 0.5)
    engine = engine_with(Travel(home_from_rev=min(near, far), home_to_rev=max(near, far)))
    engine.capture_home(0, active=True, direction=direction)
    run_at(engine, direction * speed)
    until(engine, Event.HOME_EDGE, timeout_s=60)
    past = (engine.captured_position(0) - near * COUNTS) * direction
    assert -1.01 <= past <= speed * COUNTS * 280e-6 + 1.01


def test_an_edge_crossed_the_wrong_way_does_not_count() -> None:
    engine = engine_with(Travel(home_from_rev=0.5, home_to_rev=1.0))
    engine.capture_home(0, active=True, direction=-1)
    run_at(engine, 1.0)
    assert not events_within(engine, 2.0) & Event.HOME_EDGE
    assert engine.true_position_rev(0) > 1.0


def test_a_cancelled_capture_tells_nothing() -> None:
    engine = engine_with(Travel(home_from_rev=0.5, home_to_rev=1.0))
    engine.capture_home(0, active=True, direction=1)
    engine.cancel_capture(0)
    run_at(engine, 1.0)
    assert not events_within(engine, 1.5) & Event.HOME_EDGE


def test_the_home_level_turns_the_input_round() -> None:
    engine = engine_with(Travel())
    assert not engine.home_active(0)
    engine.set_home_level(0, 0)
    assert engine.home_active(0)


@settings(max_examples=30, deadline=None)
@given(phase=st.floats(0.05, 0.95), speed=st.floats(0.1, 20.0), direction=st.sampled_from((1, -1)))
def test_an_index_pulse_is_captured_to_the_count(phase: float, speed: float, direction: int) -> None:
    engine = engine_with(Travel(), wires=LIMITS_CLOSED | HOME, index_phase_rev=phase)
    engine.capture_index(0)
    run_at(engine, direction * speed)
    until(engine, Event.INDEX)
    pulse = math.floor(phase * COUNTS)
    assert engine.captured_position(0) == (pulse if direction > 0 else pulse - COUNTS)


def test_an_index_pulse_outside_the_home_switch_is_passed_over() -> None:
    engine = engine_with(Travel(home_from_rev=1.1, home_to_rev=1.6), index_phase_rev=0.5)
    engine.capture_index(0)
    run_at(engine, 1.0)
    until(engine, Event.INDEX)
    assert engine.captured_position(0) == int(1.5 * COUNTS)


def test_encoder_polarity_turns_the_captured_count() -> None:
    engine = engine_with(Travel(), wires=LIMITS_CLOSED | HOME, index_phase_rev=0.25)
    engine.set_polarity(0, command=1)
    engine.capture_index(0)
    run_at(engine, -1.0)
    until(engine, Event.INDEX)
    assert engine.captured_position(0) == -1000


def test_report_wires_tells_once() -> None:
    engine = engine_with(Travel())
    engine.report_wires()
    assert engine.run(engine.time_ns + 100_000_000) & Event.WIRES
    assert engine.run(engine.time_ns + 100_000_000) == Event.NONE

"""Position error, end-of-travel limits, soft limits."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from emulator.engine import Engine, Event, Gains, Wire, plan_continuous, plan_preset, plan_stop, wire_mask

MakeEngine = Callable[..., Engine]

ALL_CLOSED = 0xFFF


def bit(number: int) -> int:
    return 1 << (number - 1)


def open_wire(engine: Engine, wire: Wire) -> None:
    engine.set_wires(engine.wires & ~wire_mask(wire, 0))


def move(engine: Engine, velocity: float) -> None:
    position, present, _ = engine.profile_state(0)
    engine.start_profile(0, plan_continuous(position, present, velocity, 40_000.0, 40_000.0))


@pytest.mark.parametrize("sign", [1, -1])
def test_too_large_a_position_error_shuts_the_drive_down(make_engine: MakeEngine, sign: int) -> None:
    engine = make_engine()
    engine.set_position_error_limit(0, 100)
    engine.set_output(0, offset_v=0.05)
    move(engine, sign * 4000.0)
    assert engine.run(engine.time_ns + 5_000_000_000) == Event.POSITION_ERROR
    assert engine.axis_events(0) == Event.POSITION_ERROR
    assert engine.axis_events(0) == Event.NONE
    assert engine.status(0) & (bit(1) | bit(13) | bit(23)) == bit(13) | bit(23)
    assert not engine.is_enabled(0)
    assert engine.position_error(0) == 0
    assert engine.terms(0)["output"] == 0.05
    engine.run(engine.time_ns + 1_000_000_000)
    engine.enable(0)
    assert engine.status(0) & (bit(13) | bit(23)) == 0
    engine.run(engine.time_ns + 500_000_000)
    assert engine.is_enabled(0)


def test_the_limit_itself_is_still_allowed_and_zero_does_not_watch(make_engine: MakeEngine) -> None:
    # 4000 counts/s makes an error of 200 counts, 201 to 203 as sampled.
    for limit, trips in ((190, True), (210, False), (0, False)):
        engine = make_engine()
        engine.set_position_error_limit(0, limit)
        move(engine, 4000.0)
        event = engine.run(engine.time_ns + 3_000_000_000)
        assert event == (Event.POSITION_ERROR if trips else Event.NONE)


def test_lost_feedback_is_caught(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(0.0))
    engine.start_profile(0, plan_preset(0.0, 0.0, 8000.0, 8000.0, 40_000.0, 40_000.0))
    event = engine.run(engine.time_ns + 5_000_000_000)
    assert event == Event.POSITION_ERROR
    assert engine.commanded_position(0) == engine.encoder_position(0) == 0


@pytest.mark.parametrize(
    ("velocity", "wire", "number"), [(4000.0, Wire.POSITIVE_LIMIT, 15), (-4000.0, Wire.NEGATIVE_LIMIT, 16)]
)
def test_a_hard_limit_met_in_motion_is_latched_and_told_once(
    make_engine: MakeEngine, velocity: float, wire: Wire, number: int
) -> None:
    engine = make_engine()
    move(engine, velocity)
    engine.run(engine.time_ns + 300_000_000)
    open_wire(engine, wire)
    due_ns = engine.next_system_update_ns
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.HARD_LIMIT | Event.WIRES
    assert engine.time_ns == due_ns
    assert engine.status(0) & (bit(15) | bit(16)) == bit(number)
    assert engine.is_moving(0), "the stop is the controller's to plan"
    position, present, _ = engine.profile_state(0)
    engine.start_profile(0, plan_stop(position, present, 40_000.0))
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.MOVE_ENDED
    engine.set_wires(ALL_CLOSED)
    engine.run(engine.next_system_update_ns)
    assert engine.status(0) & bit(number), "stays until cleared"
    engine.clear_status(0, bit(number))
    assert not engine.status(0) & bit(number)


@pytest.mark.parametrize("enable", [0, 1, 2, 3])
@pytest.mark.parametrize("velocity", [4000.0, -4000.0])
def test_limit_enable_codes(make_engine: MakeEngine, enable: int, velocity: float) -> None:
    watched = enable in ((2, 3) if velocity > 0 else (1, 3))
    engine = make_engine()
    engine.set_hard_limits(0, enable=enable)
    open_wire(engine, Wire.POSITIVE_LIMIT)
    open_wire(engine, Wire.NEGATIVE_LIMIT)
    engine.run(engine.next_system_update_ns)
    move(engine, velocity)
    assert engine.run(engine.time_ns + 500_000_000) == (Event.HARD_LIMIT if watched else Event.NONE)


def test_moving_away_from_a_limit_is_free(make_engine: MakeEngine) -> None:
    engine = make_engine()
    open_wire(engine, Wire.POSITIVE_LIMIT)
    engine.run(engine.next_system_update_ns)
    move(engine, -4000.0)
    assert engine.run(engine.time_ns + 500_000_000) == Event.NONE


def test_active_level_one_makes_a_grounded_input_the_limit(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_hard_limits(0, positive_active_level=1)
    move(engine, 4000.0)
    assert engine.run(engine.time_ns + 500_000_000) == Event.HARD_LIMIT
    assert engine.status(0) & bit(15)


@pytest.mark.parametrize(("velocity", "limit", "number"), [(4000.0, 1000, 17), (-4000.0, -1000, 18)])
def test_soft_limits_stand_in_reported_counts(
    make_engine: MakeEngine, velocity: float, limit: int, number: int
) -> None:
    engine = make_engine()
    engine.set_position(0, 500)
    engine.set_soft_limits(0, enable=3, positive=1000, negative=-1000)
    move(engine, velocity)
    assert engine.run(engine.time_ns + 2_000_000_000) == Event.SOFT_LIMIT
    assert engine.status(0) & (bit(17) | bit(18)) == bit(number)
    beyond = abs(engine.commanded_position(0)) - abs(limit)
    assert 0 < beyond <= 4000 * engine.rates.system_ns / 1e9 + 1


def test_a_move_onto_the_soft_limit_is_allowed_and_equal_limits_are_none(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_soft_limits(0, enable=3, positive=1000, negative=-1000)
    engine.start_profile(0, plan_preset(0.0, 0.0, 1000.0, 4000.0, 40_000.0, 40_000.0))
    assert engine.run(engine.time_ns + 2_000_000_000) == Event.MOVE_ENDED
    engine.set_soft_limits(0, positive=0, negative=0)
    move(engine, 4000.0)
    assert engine.run(engine.time_ns + 500_000_000) == Event.NONE


def test_soft_limits_are_off_unless_enabled(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_soft_limits(0, enable=0, positive=10, negative=-10)
    move(engine, 4000.0)
    assert engine.run(engine.time_ns + 500_000_000) == Event.NONE

"""Status bits, target zone, watches and wires: what the controller is told, and when."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from emulator.engine import (
    ENABLE_MASK,
    Engine,
    Event,
    Gains,
    Relation,
    Signal,
    VelocityDrive,
    Wire,
    plan_continuous,
    plan_preset,
    wire_mask,
)
from emulator.engine.watches import WATCH_SLOTS

MakeEngine = Callable[..., Engine]


def bit(number: int) -> int:
    return 1 << (number - 1)


def one_revolution(engine: Engine, sign: int = 1) -> None:
    engine.start_profile(0, plan_preset(0.0, 0.0, sign * 4000.0, 4000.0, 40_000.0, 40_000.0))


def test_an_idle_axis_shows_shut_down_and_in_zone(make_engine: MakeEngine) -> None:
    assert make_engine(enabled=False).status(0) == bit(13) | bit(24)
    assert make_engine().status(0) == bit(24)


@pytest.mark.parametrize(("sign", "direction"), [(1, 0), (-1, bit(2))])
def test_motion_bits_through_a_trapezoid(make_engine: MakeEngine, sign: int, direction: int) -> None:
    engine = make_engine()
    start_ns = engine.next_trajectory_ns
    one_revolution(engine, sign)
    assert engine.status(0) & 0xF == bit(1), "moving at once, before the first trajectory update"
    for at_s, bits in (
        (0.0, bit(1) | bit(3)),
        (0.05, bit(1) | bit(3)),
        (0.5, bit(1) | bit(4)),
        (1.05, bit(1)),
    ):
        engine.run(start_ns + int(at_s * 1e9))
        assert engine.status(0) & 0xF == bits | direction, at_s
    engine.run(start_ns + 2_000_000_000)
    assert engine.status(0) & 0xF == 0


def test_slowing_down_to_a_lower_velocity_is_not_accelerating(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.start_profile(0, plan_continuous(0.0, 8000.0, 4000.0, 40_000.0, 10_000.0))
    engine.run(engine.time_ns + 200_000_000)
    assert engine.status(0) & 0xF == bit(1)


def test_bits_of_the_controller_are_ored_in_and_latched_ones_stay(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_extra_status(0, bit(6) | bit(28))
    engine.latch_status(0, bit(25))
    assert engine.status(0) == bit(6) | bit(24) | bit(25) | bit(28)
    engine.set_extra_status(0, 0)
    engine.clear_status(0, bit(25))
    assert engine.status(0) == bit(24)


def test_the_target_zone_is_reached_after_the_move(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_target_zone(0, enable=True, distance_counts=10, velocity_counts_s=400.0, timeout_ms=1000)
    one_revolution(engine)
    assert engine.run(engine.time_ns + 3_000_000_000) == Event.MOVE_ENDED
    ended_ns = engine.time_ns
    assert not engine.status(0) & (bit(1) | bit(24))
    assert engine.is_settling(0)
    assert engine.run(engine.time_ns + 3_000_000_000) == Event.SETTLED
    assert not engine.is_settling(0)
    assert engine.status(0) & bit(24)
    # The error left at the end, 2000/s^2 * 20 counts lag, decays at 20 1/s: some tens of milliseconds to 10 counts.
    waited_ms = (engine.time_ns - ended_ns) / 1e6
    assert 50 < waited_ms < 200
    assert engine.settling_time_ms(0) == pytest.approx(waited_ms, abs=3)
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.NONE


def test_an_axis_that_does_not_settle_times_out(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.1)
    engine.set_target_zone(0, enable=True, distance_counts=50, velocity_counts_s=4000.0, timeout_ms=250)
    one_revolution(engine)
    engine.run(engine.time_ns + 3_000_000_000)
    ended_ns = engine.time_ns
    assert engine.run(engine.time_ns + 3_000_000_000) == Event.SETTLE_TIMEOUT
    assert engine.time_ns - ended_ns == pytest.approx(250e6, abs=2 * engine.rates.system_ns)
    assert engine.status(0) & (bit(24) | bit(25)) == bit(25)


def test_without_the_zone_enabled_nothing_waits(make_engine: MakeEngine) -> None:
    engine = make_engine()
    one_revolution(engine)
    assert engine.run(engine.time_ns + 3_000_000_000) == Event.MOVE_ENDED
    assert engine.run(engine.time_ns + 3_000_000_000) == Event.NONE


def test_in_zone_asks_for_low_velocity_too(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_gains(0, Gains(0.0))
    engine.set_position_error_limit(0, 0)
    engine.set_target_zone(0, distance_counts=1e9, velocity_counts_s=1000.0)
    engine.set_output(0, offset_v=0.05)
    engine.run(engine.time_ns + 500_000_000)
    assert engine.actual_velocity(0) == pytest.approx(2000.0, rel=0.3)
    assert not engine.status(0) & bit(24)
    engine.set_target_zone(0, velocity_counts_s=5000.0)
    assert engine.status(0) & bit(24)


def test_actual_velocity_is_the_difference_over_a_system_update(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.start_profile(0, plan_continuous(0.0, 0.0, 20_000.0, 400_000.0, 400_000.0))
    engine.run(engine.time_ns + 1_000_000_000)
    engine.run(engine.next_system_update_ns)
    before = engine.encoder_position(0)
    engine.run(engine.next_system_update_ns)
    period_s = engine.rates.system_ns / 1e9
    assert engine.actual_velocity(0) == pytest.approx((engine.encoder_position(0) - before) / period_s, rel=1e-12)


def test_a_status_watch_tells_each_change_once(make_engine: MakeEngine) -> None:
    engine = make_engine()
    one_revolution(engine)
    engine.watch_status(0, bit(1) | bit(4))
    start_ns = engine.time_ns
    assert engine.run(start_ns + 5_000_000_000) == Event.STATUS
    assert engine.status(0) & bit(4)
    assert (engine.time_ns - start_ns) / 1e9 == pytest.approx(0.1, abs=0.005)
    assert engine.run(start_ns + 5_000_000_000) == Event.STATUS
    assert engine.status(0) & (bit(1) | bit(4)) == bit(1)
    assert engine.run(start_ns + 5_000_000_000) == Event.STATUS | Event.MOVE_ENDED
    assert engine.run(start_ns + 5_000_000_000) == Event.NONE


def test_a_status_watch_sees_what_python_changed_and_can_be_taken_back(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.watch_status(0, bit(6))
    engine.set_extra_status(0, bit(6))
    assert engine.run(engine.time_ns + 10_000_000) == Event.STATUS
    engine.watch_status(0, 0)
    engine.set_extra_status(0, 0)
    assert engine.run(engine.time_ns + 10_000_000) == Event.NONE


@pytest.mark.parametrize(
    ("signal", "relation", "threshold", "at_s"),
    [
        ("PC", ">=", 2000, 0.55),
        ("PE", ">", 2000, 0.60),
        ("FB", ">", 2000, 0.60),
        ("PER", ">=", 150, 0.13),
        ("VEL", ">=", 2000, 0.05),
        ("VELA", ">=", 3000, 0.127),
        ("DAC", ">", 0.05, 0.08),
        ("PC", "<>", 0, 0.01),
        ("PC", "=", 4000, 1.1),
        ("PER", "<", 1000, 0.0),
        ("PER", "<=", 1000, 0.0),
    ],
)
def test_a_value_watch_fires_once_when_the_relation_first_holds(
    make_engine: MakeEngine, signal: str, relation: str, threshold: float, at_s: float
) -> None:
    engine = make_engine()
    start_ns = engine.next_trajectory_ns
    one_revolution(engine)
    engine.watch_value(5, 0, signal, relation, threshold)
    assert Event.VALUE in engine.run(start_ns + 2_000_000_000)
    assert (engine.time_ns - start_ns) / 1e9 == pytest.approx(at_s, abs=0.03)
    assert engine.fired_watches() == 1 << 5
    assert engine.fired_watches() == 0
    assert Event.VALUE not in engine.run(start_ns + 3_000_000_000)


def test_watches_live_side_by_side_on_two_axes_and_can_be_cleared(make_engine: MakeEngine) -> None:
    engine = make_engine(VelocityDrive(), VelocityDrive())
    for axis_index in (0, 1):
        engine.start_profile(axis_index, plan_continuous(0.0, 0.0, 4000.0 * (axis_index + 1), 1e6, 1e6))
    engine.watch_value(0, 0, Signal.PC, Relation.GREATER, 2000)
    engine.watch_value(1, 1, Signal.PC, Relation.GREATER, 2000)
    engine.watch_value(2, 0, Signal.PC, Relation.GREATER, 3000)
    assert engine.run(engine.time_ns + 5_000_000_000) == Event.VALUE
    assert (engine.fired_watches(), engine.axis_events(1), engine.axis_events(0)) == (2, Event.VALUE, Event.NONE)
    assert engine.run(engine.time_ns + 5_000_000_000) == Event.VALUE
    assert engine.fired_watches() == 1
    engine.clear_watches()
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.NONE


def test_watches_that_cannot_be(make_engine: MakeEngine) -> None:
    engine = make_engine()
    with pytest.raises(ValueError, match="slots"):
        engine.watch_value(WATCH_SLOTS, 0, "PC", "=", 0)
    with pytest.raises(ValueError, match="relation"):
        engine.watch_value(0, 0, "PC", "==", 0)
    with pytest.raises(KeyError):
        engine.watch_value(0, 0, "PX", "=", 0)


def test_wires_and_inputs_are_reported_at_the_next_system_update(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_wires(engine.wires & ~ENABLE_MASK)
    due_ns = engine.next_system_update_ns
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.WIRES
    assert engine.time_ns == due_ns
    engine.set_inputs(0b101)
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.WIRES
    assert engine.inputs == 0b101
    assert engine.run(engine.time_ns + 1_000_000_000) == Event.NONE


def test_a_wire_that_returns_before_the_update_was_never_seen(make_engine: MakeEngine) -> None:
    engine = make_engine()
    before = engine.wires
    engine.set_wires(0)
    engine.run(engine.time_ns + 300_000)
    engine.set_wires(before)
    assert engine.run(engine.time_ns + 100_000_000) == Event.NONE


def test_every_wire_has_a_bit_of_its_own() -> None:
    masks = [ENABLE_MASK, *(wire_mask(wire, axis_index) for wire in Wire for axis_index in range(14))]
    assert len(set(masks)) == len(masks)
    assert all(mask.bit_count() == 1 and mask < 1 << 63 for mask in masks)

"""The face: time, the grid of samples, settings that leave others alone."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from emulator.engine import AxisHardware, Engine, Event, Gains, UnitFactors, plan_preset, rates_for
from emulator.engine.layout import AXIS_FIELDS, RATIO_FIELDS, SEGMENT_FIELDS, UNIT_FIELDS, WATCH_FIELDS, description
from emulator.engine.status import DRIVE_FAULT

MakeEngine = Callable[..., Engine]


def test_time_goes_where_it_is_told_and_never_back() -> None:
    engine = Engine([AxisHardware()], rates=rates_for(2, 4))
    assert engine.time_ns == 0
    for until_ns in (1, 279_999, 280_000, 123_456_789):
        assert engine.run(until_ns) == Event.NONE
        assert engine.time_ns == until_ns
    before = engine.snapshot()
    assert engine.run(5) == Event.NONE
    assert engine.snapshot() == before


def test_updates_lie_on_the_grid() -> None:
    engine = Engine([AxisHardware()], rates=rates_for(2, 4))
    assert (engine.next_trajectory_ns, engine.next_system_update_ns) == (1_120_000, 2_240_000)
    engine.run(1_120_000)
    assert (engine.next_trajectory_ns, engine.next_system_update_ns) == (2_240_000, 2_240_000)
    engine.run(2_239_999)
    assert engine.next_system_update_ns == 2_240_000
    engine.run(2_240_000)
    assert engine.next_system_update_ns == 4_480_000


def test_a_change_of_rates_begins_the_grid_anew() -> None:
    engine = Engine([AxisHardware()], rates=rates_for(2, 4))
    engine.run(10_000_000)
    engine.set_rates(rates_for(1, 8))
    assert engine.rates == rates_for(1, 8)
    assert engine.next_trajectory_ns == 10_000_000 + 1_200_000
    assert engine.next_system_update_ns == 10_000_000 + 2_400_000


def test_a_move_goes_on_through_a_change_of_rates(make_engine: MakeEngine) -> None:
    engine = make_engine()
    start_ns = engine.next_trajectory_ns
    engine.start_profile(0, plan_preset(0.0, 0.0, 4000.0, 4000.0, 40_000.0, 40_000.0))
    engine.run(start_ns + 500_000_000)
    engine.set_rates(rates_for(2, 1))
    assert engine.run(start_ns + 3_000_000_000) == Event.MOVE_ENDED
    assert (engine.time_ns - start_ns) / 1e9 == pytest.approx(1.1, abs=0.004)
    engine.run(start_ns + 3_000_000_000)
    assert engine.encoder_position(0) == pytest.approx(4000, abs=2)


def test_gains_are_kept_and_scaled_by_the_factors() -> None:
    factors = UnitFactors(sgp=2e-3)
    engine = Engine([AxisHardware()], rates=rates_for(2, 4), unit_factors=factors)
    gains = Gains(1.5, integral_limit_v=3.0)
    engine.set_gains(0, gains)
    assert engine.gains(0) == gains
    engine.enable(0)
    engine.set_output(0, offset_v=0.3)
    engine.run(2_000_000_000)
    assert engine.position_error(0) == pytest.approx(-0.3 / 3e-3, abs=1)


def test_power_up_gains() -> None:
    engine = Engine([AxisHardware()], rates=rates_for(2, 4))
    assert engine.gains(0) == Gains(0.5, 0.0, 0.0, 0.0, 0.0, 200.0)
    assert not engine.is_enabled(0)


def test_settings_not_named_stay(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.5)
    engine.set_output(0, limit_v=0.25)
    engine.disable(0)
    engine.run(engine.time_ns + 10_000_000)
    assert engine.dac_volts(0) == pytest.approx(0.25, abs=20 / 65536)
    assert engine.terms(0)["offset"] == 0.5


def test_enabling_clears_a_latched_drive_fault(make_engine: MakeEngine) -> None:
    engine = make_engine(enabled=False)
    engine.latch_status(0, DRIVE_FAULT)
    assert engine.status(0) & DRIVE_FAULT
    engine.enable(0)
    assert not engine.status(0) & DRIVE_FAULT


def test_enabling_an_enabled_drive_changes_nothing_else(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_output(0, offset_v=0.1)
    engine.run(engine.time_ns + 1_000_000_000)
    error = engine.position_error(0)
    engine.enable(0)
    assert engine.position_error(0) == error != 0


def test_power_up_puts_counters_to_zero_and_leaves_shaft_wires_and_time(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_position(0, 777)
    engine.start_profile(0, plan_preset(777.0, 0.0, 4777.0, 4000.0, 40_000.0, 40_000.0))
    engine.watch_value(0, 0, "PC", ">", 3000)
    engine.run(engine.time_ns + 500_000_000)
    engine.latch_status(0, DRIVE_FAULT)
    time_ns, wires, shaft = engine.time_ns, engine.wires, engine.true_position_rev(0)
    engine.power_up()
    assert (engine.time_ns, engine.wires, engine.true_position_rev(0)) == (time_ns, wires, shaft)
    assert (engine.commanded_position(0), engine.encoder_position(0)) == (0, 0)
    assert not engine.is_moving(0)
    assert not engine.is_enabled(0)
    assert not engine.status(0) & DRIVE_FAULT
    assert engine.run(engine.time_ns + 2_000_000_000) == Event.NONE


@pytest.mark.parametrize("count", [0, 15])
def test_units_of_no_or_too_many_axes_are_refused(count: int) -> None:
    with pytest.raises(ValueError, match="axes"):
        Engine([AxisHardware()] * count, rates=rates_for(2, 4))


def test_fourteen_axes_move_apart() -> None:
    engine = Engine([AxisHardware()] * 14, rates=rates_for(2, 4))
    engine.set_wires((1 << 62) - 1)
    for axis_index in range(14):
        engine.enable(axis_index)
        target = 100.0 * (axis_index + 1)
        engine.start_profile(axis_index, plan_preset(0.0, 0.0, target, 4000.0, 40_000.0, 40_000.0))
    while engine.time_ns < 2_000_000_000:
        engine.run(2_000_000_000)
    assert [engine.commanded_position(i) for i in range(14)] == [100 * (i + 1) for i in range(14)]


@pytest.mark.parametrize("fields", [UNIT_FIELDS, AXIS_FIELDS, SEGMENT_FIELDS, RATIO_FIELDS, WATCH_FIELDS])
def test_every_field_of_the_records_is_explained(fields: tuple) -> None:
    texts = description(fields)
    assert len(texts) == len(fields)
    assert all(len(text) > 5 for text in texts.values())

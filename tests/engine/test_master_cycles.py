"""Masters: their cycles, velocity and status, and watches on all of it."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import AnalogSensor, AxisHardware, Engine, Event, MasterSource, plan_ratio_change, rates_for
from emulator.engine.batch import Batch
from emulator.engine.machine_code import MODE_VARIABLE
from emulator.engine.trace import Source
from tests.engine.following_rig import ALL_CLOSED, MASTER, SLAVE, Gearing

LENGTH_GIVEN, POSITION_NEGATIVE, NUMBER_POSITIVE = 1 << 13, 1 << 14, 1 << 15


@given(st.integers(1, 5000), st.lists(st.integers(0, 3000), max_size=12))
@settings(max_examples=60, deadline=None)
def test_hours_and_minutes(length: int, steps: list[int]) -> None:
    gearing = Gearing()
    gearing.engine.set_master_cycle(SLAVE, length)
    gearing.turn(*steps)
    number, position = divmod(sum(steps), length)
    assert gearing.engine.master_position(SLAVE) == position
    assert gearing.engine.master_cycle_number(SLAVE) == number


def test_backing_up_counts_down_below_zero_and_leaves_the_number() -> None:
    gearing = Gearing()
    engine = gearing.engine
    engine.set_master_cycle(SLAVE, 1000)
    gearing.turn(2100, -400)
    assert (engine.master_position(SLAVE), engine.master_cycle_number(SLAVE)) == (-300, 2)
    bits = LENGTH_GIVEN | POSITION_NEGATIVE | NUMBER_POSITIVE
    assert engine.following_status(SLAVE) & bits == bits
    gearing.turn(400)
    assert engine.master_position(SLAVE) == 100


def test_without_a_length_the_cycle_is_endless() -> None:
    gearing = Gearing()
    gearing.turn(2_000_000_000)
    assert (gearing.engine.master_position(SLAVE), gearing.engine.master_cycle_number(SLAVE)) == (2_000_000_000, 0)


def test_a_restart_begins_where_it_is_told() -> None:
    gearing = Gearing()
    engine = gearing.engine
    engine.set_master_cycle(SLAVE, 1000)
    gearing.turn(1500)
    engine.restart_master_cycle(SLAVE, -200)
    assert (engine.master_position(SLAVE), engine.master_cycle_number(SLAVE)) == (-200, 0)
    gearing.turn(1300)
    assert (engine.master_position(SLAVE), engine.master_cycle_number(SLAVE)) == (100, 1)
    engine.restart_master_cycle(SLAVE, 0, at=engine.master_counts(SLAVE) - 30)
    assert engine.master_position(SLAVE) == 30


def test_master_velocity_and_direction() -> None:
    gearing = Gearing()
    engine = gearing.engine
    moving, negative = 1 << 6, 1 << 7
    gearing.turn(*[56] * 3)
    assert engine.master_velocity(SLAVE) == pytest.approx(25_000)
    assert engine.following_status(SLAVE) & (moving | negative) == moving
    gearing.turn(*[-56] * 3)
    assert engine.master_velocity(SLAVE) == pytest.approx(-25_000)
    assert engine.following_status(SLAVE) & (moving | negative) == moving | negative
    gearing.turn(0, 0)
    assert engine.master_velocity(SLAVE) == 0.0
    assert engine.following_status(SLAVE) & (moving | negative) == 0


@pytest.mark.parametrize(
    ("signal", "threshold", "update"),
    [("PMAS", 50, 6), ("NMCY", 1, 10), ("MASTER", 130, 13), ("VMAS", 4000.0, 2), ("PSLV", 30, 5), ("PSHF", 0.0, 1)],
)
def test_watches_on_the_signals(signal: str, threshold: float, update: int) -> None:
    """The master goes 10 counts an update; the cycle is 100 counts long."""
    gearing = Gearing(prediction=False)
    engine = gearing.engine
    engine.set_master_cycle(SLAVE, 100)
    gearing.at_ratio(1)
    engine.watch_value(0, SLAVE, signal, ">=" if signal != "PMAS" else ">", threshold)
    events, updates = Event.NONE, 0
    while not events & Event.VALUE and updates < 30:
        engine.slip_encoder(MASTER, 10)
        events = engine.run(engine.next_system_update_ns)
        updates += 1
    assert updates == update


def test_watches_on_status_bits() -> None:
    gearing = Gearing(prediction=False)
    engine = gearing.engine
    gearing.follow(plan_ratio_change(Fraction(0), Fraction(1), 100))
    engine.watch_following(SLAVE, 0b1111)
    told = []
    for _ in range(8):
        engine.slip_encoder(MASTER, 30)
        if engine.run(engine.next_system_update_ns) & Event.STATUS:
            told.append((gearing.master, engine.following_status(SLAVE) & 0b1111))
    assert told == [(30, 0b0101), (120, 0b1001)]


def test_an_axis_without_a_master_reads_zero() -> None:
    gearing = Gearing()
    assert gearing.engine.following_status(MASTER) == 0
    assert gearing.engine.following_ratio(MASTER) == 0
    assert not gearing.engine.is_following(MASTER)


def test_power_takes_the_master_away() -> None:
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.engine.power_up()
    assert gearing.engine.master_source(SLAVE) == MasterSource.NONE
    assert gearing.engine.following_status(SLAVE) == 0


def analog_master() -> Engine:
    """Axis 1 follows the ANI input of axis 2, whose sensor shows 1 V per revolution."""
    hardware = [AxisHardware(), AxisHardware(ani=AnalogSensor(0.5, 1.0))]
    engine = Engine(hardware, rates=rates_for(2, 4))
    engine.set_wires(ALL_CLOSED)
    engine.set_position_error_limit(SLAVE, 0)
    engine.run(engine.next_system_update_ns)
    engine.enable(SLAVE)
    engine.set_master(SLAVE, source=MasterSource.ANI, master_index=MASTER)
    return engine


def test_an_analog_master_is_followed_in_converter_counts() -> None:
    engine = analog_master()
    engine.start_following(SLAVE, plan_ratio_change(Fraction(0), Fraction(3), 0), preset=False)
    before = engine.ani_position(MASTER)
    engine.set_analog_sensor(MASTER, AnalogSensor(1.5, 1.0))
    engine.run(engine.time_ns + 10 * engine.rates.system_ns)
    assert engine.ani_position(MASTER) - before == pytest.approx(819.2, abs=1)
    assert engine.commanded_position(SLAVE) == 3 * (engine.ani_position(MASTER) - before)


def test_turning_the_analog_input_round_moves_no_slave() -> None:
    engine = analog_master()
    engine.start_following(SLAVE, plan_ratio_change(Fraction(0), Fraction(3), 0), preset=False)
    engine.set_polarity(MASTER, ani=1)
    engine.run(engine.time_ns + 10 * engine.rates.system_ns)
    assert engine.commanded_position(SLAVE) == 0


def test_one_axis_units_have_no_use_for_it() -> None:
    engine = Engine([AxisHardware()], rates=rates_for(1, 4))
    engine.set_master(0, source=MasterSource.NONE)
    engine.run(10**8)
    assert engine.following_status(0) == 0


def test_a_change_of_rates_in_motion_moves_nothing_backwards() -> None:
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.turn(*[56] * 10)
    engine = gearing.engine
    engine.run(engine.next_trajectory_ns)
    before = gearing.slave
    engine.set_rates(rates_for(2, 1))
    for _ in range(8):
        engine.run(engine.next_trajectory_ns)
        assert gearing.slave >= before
        before = gearing.slave
    gearing.settle()
    assert gearing.slave == gearing.master


def test_the_scope_records_ratio_and_status() -> None:
    gearing = Gearing(prediction=False)
    sources = [
        Source("ratio_now", SLAVE),
        Source("following_status", SLAVE, mask=1 << 3),
        Source("cycle_counts", SLAVE),
    ]
    gearing.engine.scope.arm(sources, rows=80)
    gearing.follow(plan_ratio_change(Fraction(0), Fraction(1), 100))
    gearing.turn(*[50] * 10)
    ratio, at_ratio, cycle = gearing.engine.scope.read().columns
    assert (ratio[7], ratio[-1]) == (0.5, 1.0)
    assert (at_ratio[0], at_ratio[-1]) == (0, 1)
    assert cycle[-1] == 500


def test_interpreted_and_compiled_agree_to_the_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    def snapshot() -> bytes:
        gearing = Gearing(corner_hz=50.0)
        gearing.engine.set_master_cycle(SLAVE, 333)
        gearing.follow(plan_ratio_change(Fraction(0), Fraction(7, 3), 500))
        gearing.turn(40, 80, -30, 200, 300, -500, 17)
        return gearing.engine.snapshot()

    compiled = snapshot()
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    assert snapshot() == compiled


def test_lanes_follow_as_a_unit_by_itself() -> None:
    gearing = Gearing()
    gearing.at_ratio(Fraction(7, 3))
    gearing.turn(40, 80)
    batch = Batch(gearing.engine, 3)
    until_ns = gearing.engine.time_ns + 20 * gearing.engine.rates.system_ns
    batch.run(until_ns)
    gearing.engine.run(until_ns)
    assert batch.axes["commanded_counts"][:, SLAVE].tolist() == [gearing.slave] * 3 == [280] * 3

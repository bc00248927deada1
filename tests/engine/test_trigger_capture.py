"""What a trigger latches, against where the machine truly was at the edge: any speed, any instant between samples."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from emulator.engine import (
    AnalogSensor,
    AxisHardware,
    EncoderTraits,
    Engine,
    Event,
    MarkSensor,
    Plant,
    TorqueDrive,
    VelocityDrive,
    plan_continuous,
    rates_for,
)
from emulator.engine.encoder_motion import EncoderMotion
from emulator.engine.layout import PLANT
from emulator.engine.machine_code import MODE_VARIABLE
from emulator.engine.plants import plant_fields, step_plant

COUNTS = 4000
TRIGGER = 1 << 24
OTHER_TRIGGER = 1 << 25
FASTEST_COUNTS_S = 1.6e6
"""The encoder input's greatest rate."""


def engine_with(
    plant: Plant | None = None, *, counts_per_rev: int = COUNTS, encoder: EncoderTraits | None = None
) -> Engine:
    """Two axes with drives on, trigger 0 armed on a contact that closes."""
    plant = plant or VelocityDrive()
    axes = [
        AxisHardware(
            plant, counts_per_rev=counts_per_rev, encoder=encoder or EncoderTraits(), ani=AnalogSensor(0.0, 0.5)
        )
        for _ in range(2)
    ]
    engine = Engine(axes, rates=rates_for(2, 4))
    for index, mask in enumerate((TRIGGER, OTHER_TRIGGER)):
        engine.connect_trigger(index, mask)
        engine.arm_trigger(index, armed=True, active_level=1, lockout_ns=0)
    for axis_index in range(2):
        engine.set_hard_limits(axis_index, enable=0)
        engine.set_position_error_limit(axis_index, 0)
        engine.enable(axis_index)
    return engine


def run_at(engine: Engine, counts_s: float, axis_index: int = 0, rate: float = 4e6) -> None:
    state = engine.profile_state(axis_index)
    engine.start_profile(axis_index, plan_continuous(state.position, state.velocity, counts_s, rate, rate))


def run_to(engine: Engine, until_ns: int) -> None:
    """Every sample up to a time, whatever is told on the way."""
    while engine.time_ns < until_ns:
        engine.run(until_ns)


def press(engine: Engine, mask: int = TRIGGER) -> int:
    """Close a contact now; the time."""
    engine.set_inputs(engine.resting_inputs | mask)
    return engine.time_ns


def true_position_at(engine: Engine, axis_index: int, at_ns: int) -> float:
    """Where the shaft of a rigid machine is at a time after its last sample and before the next: its plant's own
    equations over that part of the sample, with the voltage that stands at its input."""
    axis = engine.memory.axes[axis_index].copy()
    part = (at_ns - (int(engine.memory.units[0]["next_sample_ns"]) - engine.rates.servo_ns)) * 1e-9
    assert 0.0 <= part <= engine.rates.servo_ns * 1e-9
    if part > 0.0:
        record = engine.memory.plants[:1].copy()
        for name, value in plant_fields(engine.plant(axis_index), part).items():
            record[name][0] = value
        assert record.dtype == PLANT
        step_plant(axis, record[0], float(axis["dac_v"]))
    return float(axis["true_position"])


speeds = st.floats(-1.0, 1.0).map(lambda part: part * FASTEST_COUNTS_S)


@settings(max_examples=150, deadline=None)
@given(speed=speeds, after_ns=st.integers(0, 60_000_000), phase=st.integers(0, 279_999))
@example(speed=FASTEST_COUNTS_S, after_ns=1_000_000, phase=139_999)
@example(speed=-FASTEST_COUNTS_S, after_ns=0, phase=1)
def test_the_hardware_latch_holds_the_count_at_the_edge(speed: float, after_ns: int, phase: int) -> None:
    """While the drive speeds up as hard as it can, and at the encoder's greatest rate."""
    engine = engine_with(VelocityDrive(speed_per_volt_rev_s=100.0, max_acceleration_rev_s2=1e5), counts_per_rev=8000)
    run_at(engine, speed, rate=1e8)
    run_to(engine, after_ns + phase)
    place = true_position_at(engine, 0, engine.time_ns)
    press(engine)
    run_to(engine, engine.time_ns + 10_000_000)
    assert abs(engine.captured_positions(0, 0).encoder - math.floor(place * 8000)) <= 1


def test_an_edge_on_a_sample_latches_that_sample() -> None:
    engine = engine_with()
    run_at(engine, 40_000.0)
    run_to(engine, engine.rates.servo_ns * 500)
    here = engine.encoder_position(0)
    press(engine)
    run_to(engine, engine.time_ns + 5_000_000)
    assert engine.captured_positions(0, 0).encoder == here


def test_capture_at_rest_and_on_a_torque_drive() -> None:
    engine = engine_with(TorqueDrive())
    engine.set_inputs(TRIGGER)
    run_to(engine, 5_000_000)
    assert engine.captured_positions(0, 0).encoder == engine.encoder_position(0)


@settings(max_examples=60, deadline=None)
@given(speed=st.floats(-2e5, 2e5), wait_ns=st.integers(200_000_000, 230_000_000))
def test_what_is_not_latched_in_hardware(speed: float, wait_ns: int) -> None:
    """The other axis' encoder, selected: within 50 us of the edge (and a count of rounding); its ANI input, not
    selected: the last sample; the commanded position: as far on from its last sample as the feedback."""
    engine = engine_with()
    run_at(engine, speed, axis_index=1)
    run_to(engine, wait_ns)
    place = true_position_at(engine, 1, wait_ns)
    last_ani, error = engine.ani_position(1), engine.position_error(1)
    press(engine)
    run_to(engine, wait_ns + 3_000_000)
    captured = engine.captured_positions(0, 1)
    assert abs(captured.encoder - place * COUNTS) <= 50e-6 * abs(engine.actual_velocity(1)) * 1.01 + 1.5
    assert captured.ani == last_ani
    assert abs(captured.commanded - captured.encoder - error) <= 1


def test_the_selected_source_may_be_ani() -> None:
    """With SFB2 the ANI position is told by the clock; the axis' own encoder is latched in hardware all the same."""
    engine = engine_with()
    engine.set_feedback(0, 2)
    run_at(engine, 20_000.0)
    run_to(engine, 150_000_111)
    place = true_position_at(engine, 0, engine.time_ns)
    before = engine.ani_position(0)
    press(engine)
    run_to(engine, 155_000_000)
    captured = engine.captured_positions(0, 0)
    assert abs(captured.encoder - math.floor(place * COUNTS)) <= 1
    assert abs(captured.ani - before) <= 0.5 * 819.2 * abs(engine.true_velocity_rev_s(0)) * 400e-6 + 1


def test_in_open_loop_the_own_encoder_is_latched_and_the_other_is_as_last_sampled() -> None:
    engine = engine_with()
    for axis_index in range(2):
        run_at(engine, 40_000.0, axis_index)
    run_to(engine, 200_000_000)
    for axis_index in range(2):
        engine.set_feedback(axis_index, 0)
    run_to(engine, 200_100_000)
    last, place = engine.encoder_position(1), true_position_at(engine, 0, 200_100_000)
    press(engine)
    run_to(engine, 205_000_000)
    assert engine.captured_positions(0, 1).encoder == last
    assert abs(engine.captured_positions(0, 0).encoder - math.floor(place * COUNTS)) <= 1


def test_both_triggers_in_one_sample() -> None:
    engine = engine_with()
    run_at(engine, 80_000.0)
    run_to(engine, 100_000_000)
    begin_ns = engine.time_ns
    press(engine)
    run_to(engine, begin_ns + 90_000)
    press(engine, OTHER_TRIGGER)
    run_to(engine, begin_ns + 5_000_000)
    assert (engine.captured_at_ns(0), engine.captured_at_ns(1)) == (begin_ns, begin_ns + 90_000)


def test_the_other_edge_an_unarmed_trigger_and_the_lockout_latch_nothing() -> None:
    engine = engine_with()
    engine.arm_trigger(0, active_level=0)
    press(engine)
    run_to(engine, 5_000_000)
    assert engine.capture_count(0) == 0
    engine.set_inputs(0)
    run_to(engine, 10_000_000)
    assert (engine.capture_count(0), engine.captured_at_ns(0)) == (1, 5_000_000)
    engine.arm_trigger(0, active_level=1, lockout_ns=24_000_000)
    press(engine)
    run_to(engine, 12_000_000)
    assert engine.capture_count(0) == 2
    for at_ns, count in ((20_000_000, 2), (33_999_999, 2), (34_000_000, 3)):
        run_to(engine, at_ns - 1)
        engine.set_inputs(0)
        run_to(engine, at_ns)
        press(engine)
        run_to(engine, at_ns + 300_000 if at_ns != 33_999_999 else at_ns)
        assert engine.capture_count(0) == count, at_ns
    engine.arm_trigger(0, armed=False)
    run_to(engine, 100_000_000)
    engine.set_inputs(0)
    press(engine)
    run_to(engine, 110_000_000)
    assert engine.capture_count(0) == 3


def test_a_capture_is_told_at_the_next_system_update() -> None:
    engine = engine_with()
    run_to(engine, 50_000_123)
    press(engine)
    due_ns = engine.next_system_update_ns
    assert engine.run(10**9) & Event.TRIGGER
    assert engine.time_ns == due_ns
    assert engine.axis_events(0) & Event.TRIGGER


def test_pset_moves_what_was_latched() -> None:
    engine = engine_with()
    run_at(engine, 30_000.0)
    run_to(engine, 100_000_000)
    press(engine)
    run_to(engine, 105_000_000)
    before, shown = engine.captured_positions(0, 0), engine.encoder_position(0)
    engine.set_position(0, 0)
    moved = engine.encoder_position(0) - shown
    assert engine.captured_positions(0, 0) == (before.encoder + moved, before.commanded + moved, before.ani)


def test_a_lossy_encoder_input_never_latches_what_was_not_counted() -> None:
    engine = engine_with(encoder=EncoderTraits(max_rate_counts_s=50_000.0, noise_counts_rms=2.0))
    run_at(engine, 150_000.0)
    run_to(engine, 150_000_050)
    before = engine.encoder_position(0)
    press(engine)
    run_to(engine, engine.time_ns + engine.rates.servo_ns)
    low, high = sorted((before, engine.encoder_position(0)))
    assert low <= engine.captured_positions(0, 0).encoder <= high


# Marks.


@settings(max_examples=60, deadline=None)
@given(
    speed=st.floats(2e3, 6e5).flatmap(lambda each: st.sampled_from([each, -each])),
    at_rev=st.floats(-1.0, 1.0),
    every=st.floats(0.3, 3.0),
    opening=st.booleans(),
)
def test_marks_are_latched_where_they_are(speed: float, at_rev: float, every: float, opening: bool) -> None:
    """The first edge of the wanted kind lies on a mark's edge, seen from the side the axis comes from."""
    engine = engine_with(VelocityDrive(speed_per_volt_rev_s=40.0))
    engine.arm_trigger(0, active_level=0 if opening else 1)
    engine.fit_mark_sensor(0, MarkSensor(axis_index=0, at_rev=at_rev, every_rev=every, width_rev=0.02))
    run_at(engine, speed)
    run_to(engine, 1_500_000_000)
    assert engine.capture_count(0) >= (1 if abs(engine.true_position_rev(0)) > 2 * every else 0)
    if engine.capture_count(0):
        edge = at_rev if (speed > 0) != opening else at_rev + 0.02
        marks = (engine.captured_positions(0, 0).encoder / COUNTS - edge) / every
        assert abs(marks - round(marks)) * every * COUNTS <= 1.5


def test_every_mark_is_latched_once_and_the_contact_is_seen() -> None:
    engine = engine_with()
    engine.fit_mark_sensor(1, MarkSensor(axis_index=0, at_rev=0.25, every_rev=0.5, width_rev=0.1))
    run_at(engine, 4000.0)
    run_to(engine, 3_000_000_000)
    assert engine.capture_count(1) == math.floor((engine.true_position_rev(0) - 0.25) / 0.5) + 1
    inside = (engine.true_position_rev(0) - 0.25) % 0.5 < 0.1
    assert bool(engine.inputs & OTHER_TRIGGER) == inside
    engine.fit_mark_sensor(1, None)
    assert not engine.inputs & OTHER_TRIGGER


def test_a_mark_alone_is_passed_once() -> None:
    engine = engine_with()
    engine.fit_mark_sensor(0, MarkSensor(axis_index=0, at_rev=-0.5))
    run_at(engine, -4000.0)
    run_to(engine, 2_000_000_000)
    assert engine.capture_count(0) == 1
    assert abs(engine.captured_positions(0, 0).encoder - (-0.49 * COUNTS)) <= 1


@pytest.mark.parametrize(
    ("fields", "word"),
    [
        ({"at_rev": math.nan}, "at_rev"),
        ({"at_rev": 0.0, "width_rev": 0.0}, "width_rev"),
        ({"at_rev": 0.0, "every_rev": 0.01, "width_rev": 0.01}, "every_rev"),
    ],
)
def test_sensors_that_cannot_be(fields: dict[str, float], word: str) -> None:
    with pytest.raises(ValueError, match=word):
        MarkSensor(axis_index=0, **fields)


def test_a_sensor_on_an_axis_that_is_not_there() -> None:
    with pytest.raises(ValueError, match="no axis 3"):
        engine_with().fit_mark_sensor(0, MarkSensor(axis_index=2, at_rev=0.0))


# Positions.


@pytest.mark.parametrize("sign", [1, -1])
def test_the_time_at_which_a_position_was_passed_is_exact(sign: int) -> None:
    """At constant velocity the time between two positions is their distance over the velocity."""
    engine = engine_with()
    run_at(engine, sign * 50_000.0)
    run_to(engine, 1_000_000_000)
    passed = []
    for _ in range(2):
        engine.compare_position(0, engine.encoder_position(0) + sign * 997, upwards=sign > 0)
        run_to(engine, engine.time_ns + 40_000_000)
        passed.append((engine.passed_position_ns(0), engine.memory.axes[0]["compare_counts"]))
    (first_ns, first), (second_ns, second) = passed
    assert first_ns is not None
    assert second_ns is not None
    assert (second_ns - first_ns) * 1e-9 == pytest.approx(abs(second - first) / 50_000.0, abs=2e-6)


def test_a_position_already_passed_and_one_given_up() -> None:
    engine = engine_with()
    engine.compare_position(0, -5, upwards=True)
    run_to(engine, 1_000_000)
    assert engine.passed_position_ns(0) is not None
    engine.compare_position(0, 100, upwards=True)
    engine.compare_no_position(0)
    run_at(engine, 40_000.0)
    run_to(engine, 100_000_000)
    assert engine.passed_position_ns(0) is None


def played() -> tuple[str, bytes]:
    """Marks, edges, a comparison and both axes moving, in whatever mode the environment asks for."""
    engine = engine_with()
    engine.fit_mark_sensor(0, MarkSensor(axis_index=1, at_rev=0.1, every_rev=0.37, width_rev=0.02))
    for axis_index in range(2):
        run_at(engine, 60_000.0, axis_index)
    engine.compare_position(1, 5000, upwards=True)
    for at_ns in (20_000_001, 33_333_333, 80_000_000):
        run_to(engine, at_ns)
        engine.set_inputs(engine.resting_inputs ^ OTHER_TRIGGER)
    run_to(engine, 150_000_000)
    assert engine.capture_count(0) > 1
    assert engine.capture_count(1) == 2
    return engine.kernel_origin, engine.snapshot()


def test_interpreted_and_compiled_agree_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    _, compiled = played()
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    assert played() == ("interpreted", compiled)


@settings(max_examples=25, deadline=None)
@given(speed=st.floats(4e3, 1e6).flatmap(lambda each: st.sampled_from([each, -each])), after_ns=st.integers(1, 10**8))
def test_an_encoder_that_something_else_turns(speed: float, after_ns: int) -> None:
    """A conveyor at constant velocity: the count at the edge, and marks that lie on the conveyor."""
    engine = engine_with()
    engine.move_encoder(0, EncoderMotion(velocity_counts_s=speed))
    engine.fit_mark_sensor(1, MarkSensor(axis_index=0, at_rev=0.0625 if speed > 0 else -0.0725))
    run_to(engine, after_ns)
    press(engine)
    run_to(engine, after_ns + 10**8)
    assert abs(engine.captured_positions(0, 0).encoder - math.floor(speed * after_ns * 1e-9)) <= 1
    edge = 250 if speed > 0 else -250
    assert engine.captured_at_ns(1) == pytest.approx(edge / speed * 1e9, abs=5)

"""The scope in the kernel: what it copies, when it begins and ends, and that it only looks on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import Engine, Gains, Relation, VelocityDrive, plan_preset, rates_for
from emulator.engine.batch import Batch
from emulator.engine.machine_code import MODE_VARIABLE
from emulator.engine.trace import MAX_RING_WORDS, Source, Trace, Trigger
from tests.engine.conftest import MakeEngine, build_engine

MS = 1_000_000
COMMANDED = Source("commanded_counts", 0, "offset_counts")
FEEDBACK = Source("feedback_counts", 0, "offset_counts")
DAC = Source("dac_v", 0)
MOVING = Source("status", 0, mask=1)
SERVO_NS = rates_for(2, 4).servo_ns


def run_to(engine: Engine, until_ns: int) -> None:
    while engine.time_ns < until_ns:
        engine.run(until_ns)


def move(engine: Engine, counts: float = 1000.0) -> None:
    engine.start_profile(0, plan_preset(0.0, 0.0, counts, 20_000.0, 400_000.0, 400_000.0))


def record(engine: Engine, *sources: Source, span_ns: int = 300 * MS, **how: object) -> Trace:
    engine.scope.arm(sources, rows=1000, **how)  # type: ignore[arg-type]
    move(engine)
    run_to(engine, engine.time_ns + span_ns)
    return engine.scope.read()


def test_rows_are_what_single_samples_show(make_engine: MakeEngine) -> None:
    recorded, stepped = make_engine(), make_engine()
    trace = record(recorded, COMMANDED, FEEDBACK, DAC, MOVING)
    move(stepped)
    for row in range(1000):
        run_to(stepped, int(trace.times_ns[row]))
        shown = (
            stepped.commanded_position(0),
            stepped.feedback_position(0),
            stepped.dac_volts(0),
            stepped.status(0) & 1,
        )
        assert tuple(column[row] for column in trace.columns) == shown


def test_rows_lie_on_the_grid_of_samples(make_engine: MakeEngine) -> None:
    engine = make_engine()
    begin_ns = engine.time_ns
    trace = record(engine, DAC)
    assert trace.times_ns[0] == begin_ns + SERVO_NS
    assert set(np.diff(trace.times_ns).tolist()) == {SERVO_NS}
    assert trace.complete


@pytest.mark.parametrize("every", [2, 4, 7])
def test_every_nth_sample(make_engine: MakeEngine, every: int) -> None:
    all_rows = record(make_engine(), FEEDBACK)
    some_rows = record(make_engine(), FEEDBACK, every=every)
    count = len(all_rows.times_ns) // every
    assert some_rows.times_ns[:count].tolist() == all_rows.times_ns[every - 1 :: every].tolist()
    assert some_rows.columns[0][:count].tolist() == all_rows.columns[0][every - 1 :: every].tolist()


def test_the_trigger_has_its_rows_before_it(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.scope.arm([COMMANDED], rows=600, pre_trigger_rows=200, trigger=Trigger(COMMANDED, Relation.GREATER, 500))
    run_to(engine, engine.time_ns + 200 * MS)
    assert engine.scope.running
    assert not engine.scope.triggered
    move(engine)
    run_to(engine, engine.time_ns + 300 * MS)
    trace = engine.scope.read()
    assert (trace.trigger_row, trace.complete, len(trace.times_ns)) == (200, True, 600)
    assert trace.columns[0][199] <= 500 < trace.columns[0][200]
    assert np.all(np.diff(trace.times_ns) == SERVO_NS)


def test_a_trigger_waits_for_the_rows_before_it_and_for_a_change(make_engine: MakeEngine) -> None:
    engine = make_engine()
    trigger = Trigger(COMMANDED, Relation.LESS, 1)
    engine.scope.arm([COMMANDED], rows=600, pre_trigger_rows=200, trigger=trigger)
    run_to(engine, engine.time_ns + 100 * MS)
    assert not engine.scope.triggered, "it came to hold with the first row, when too few lay before it"
    move(engine, 100.0)
    run_to(engine, engine.time_ns + 100 * MS)
    engine.start_profile(0, plan_preset(100.0, 0.0, 0.0, 20_000.0, 400_000.0, 400_000.0))
    run_to(engine, engine.time_ns + 200 * MS)
    trace = engine.scope.read()
    assert trace.trigger_row == 200
    assert (trace.columns[0][199], trace.columns[0][200]) == (1, 0)


@pytest.mark.parametrize(
    "trigger",
    [
        Trigger(DAC, Relation.GREATER, 0.05),
        Trigger(MOVING, Relation.EQUAL, 1.0),
        Trigger(Source("wires", mask=1), Relation.EQUAL, 0.0),
    ],
)
def test_triggers_on_floats_bits_and_wires(make_engine: MakeEngine, trigger: Trigger) -> None:
    engine = make_engine()
    engine.scope.arm([trigger.source], rows=400, pre_trigger_rows=10, trigger=trigger)
    run_to(engine, engine.time_ns + 50 * MS)
    move(engine)
    engine.set_wires(0xFFE)
    run_to(engine, engine.time_ns + 200 * MS)
    trace = engine.scope.read()
    assert trace.trigger_row == 10
    equal = trigger.relation is Relation.EQUAL
    held = [v == trigger.threshold if equal else v > trigger.threshold for v in trace.columns[0]]
    assert held[9:11] == [False, True]


def test_recording_changes_nothing(make_engine: MakeEngine) -> None:
    plain, recorded = make_engine(), make_engine()
    move(plain)
    run_to(plain, plain.time_ns + 300 * MS)
    record(recorded, COMMANDED, DAC, MOVING)
    assert recorded.snapshot() == plain.snapshot()


@settings(max_examples=20, deadline=None)
@given(st.lists(st.integers(1, 40 * MS), min_size=1, max_size=30), st.integers(1, 5))
def test_however_the_time_is_cut_the_rows_are_the_same(cuts: list[int], every: int) -> None:
    whole, parts = build_engine(), build_engine()
    for engine in (whole, parts):
        engine.scope.arm([FEEDBACK, DAC], rows=500, every=every)
        move(engine)
    end_ns = whole.time_ns + sum(cuts)
    run_to(whole, end_ns)
    for cut in cuts:
        run_to(parts, parts.time_ns + cut)
    one, other = whole.scope.read(), parts.scope.read()
    assert one.times_ns.tolist() == other.times_ns.tolist()
    assert [c.tolist() for c in one.columns] == [c.tolist() for c in other.columns]


def test_compiled_and_interpreted_record_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    trigger = Trigger(FEEDBACK, Relation.GREATER, 20)
    how = {"pre_trigger_rows": 50, "trigger": trigger, "every": 2}
    compiled = record(build_engine(), FEEDBACK, DAC, MOVING, span_ns=60 * MS, **how)
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    interpreted = record(build_engine(), FEEDBACK, DAC, MOVING, span_ns=60 * MS, **how)
    assert compiled.trigger_row == interpreted.trigger_row
    assert [c.tolist() for c in compiled.columns] == [c.tolist() for c in interpreted.columns]


def test_a_change_of_the_rates_shows_in_the_times(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.scope.arm([DAC], rows=100)
    run_to(engine, engine.time_ns + 10 * SERVO_NS)
    engine.set_rates(rates_for(2, 1))
    run_to(engine, engine.time_ns + 10 * rates_for(2, 1).servo_ns)
    steps = np.diff(engine.scope.read().times_ns).tolist()
    assert steps == [SERVO_NS] * 9 + [rates_for(2, 1).servo_ns] * 10


def test_a_ring_gone_round_keeps_the_latest_rows(make_engine: MakeEngine) -> None:
    engine = make_engine()
    trigger = Trigger(MOVING, Relation.EQUAL, 1.0)
    engine.scope.arm([COMMANDED], rows=100, pre_trigger_rows=0, trigger=trigger)
    run_to(engine, engine.time_ns + 350 * SERVO_NS)
    trace = engine.scope.read()
    assert len(trace.times_ns) == 100
    assert trace.times_ns[-1] == engine.time_ns - engine.time_ns % SERVO_NS
    assert trace.trigger_row is None


@pytest.mark.parametrize(
    ("how", "wrong"),
    [
        ({"rows": 0}, "0 rows"),
        ({"rows": MAX_RING_WORDS + 1}, "rows of 1 words"),
        ({"rows": 10, "pre_trigger_rows": 10}, "before the trigger"),
        ({"rows": 10, "every": 0}, "every 0 samples"),
    ],
)
def test_impossible_recordings_are_refused(make_engine: MakeEngine, how: dict[str, int], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        make_engine().scope.arm([DAC], **how)


def test_arithmetic_on_a_float_is_refused(make_engine: MakeEngine) -> None:
    with pytest.raises(ValueError, match="dac_v is a float"):
        make_engine().scope.arm([Source("dac_v", 0, "term_p")], rows=10)


class TestBatch:
    """Lanes are engines: each does what an engine with its gains does."""

    GAINS = (0.5, 2.0, 8.0, 15.0)

    def alone(self, gain: float) -> Trace:
        engine = build_engine()
        engine.set_gains(0, Gains(proportional_mv_per_count=gain))
        return record(engine, FEEDBACK, DAC)

    def batch(self) -> Batch:
        engine = build_engine()
        engine.scope.arm([FEEDBACK, DAC], rows=1000)
        move(engine)
        batch = Batch(engine, len(self.GAINS))
        batch.axes["proportional_v"][:, 0] = [gain * 1e-3 for gain in self.GAINS]
        batch.run(engine.time_ns + 300 * MS)
        return batch

    def test_a_lane_is_an_engine(self) -> None:
        times_ns, columns = self.batch().traces()
        for lane, gain in enumerate(self.GAINS):
            trace = self.alone(gain)
            assert times_ns.tolist() == trace.times_ns.tolist()
            assert columns[FEEDBACK][lane].tolist() == trace.columns[0].tolist()
            assert columns[DAC][lane].tolist() == trace.columns[1].tolist()

    def test_interpreted_lanes_are_the_same(self, monkeypatch: pytest.MonkeyPatch) -> None:
        _, compiled = self.batch().traces()
        monkeypatch.setenv(MODE_VARIABLE, "interpreted")
        _, interpreted = self.batch().traces()
        assert all((compiled[source] == interpreted[source]).all() for source in (FEEDBACK, DAC))

    def test_a_plant_of_its_own(self) -> None:
        engine = build_engine()
        engine.scope.arm([FEEDBACK], rows=1000)
        move(engine)
        batch = Batch(engine, 3)
        batch.set_plant(1, 0, VelocityDrive(speed_per_volt_rev_s=20.0))
        batch.copy_plant(0, source=1, lanes=slice(2, 3))
        batch.run(engine.time_ns + 300 * MS)
        feedback = batch.traces()[1][FEEDBACK]
        assert (feedback[1] == feedback[2]).all()
        assert (feedback[0] < feedback[1]).any()

    def test_a_batch_needs_lanes_and_full_rings(self) -> None:
        with pytest.raises(ValueError, match="at least one lane"):
            Batch(build_engine(), 0)
        engine = build_engine()
        with pytest.raises(ValueError, match="not armed"):
            Batch(engine, 2).traces()
        engine.scope.arm([DAC], rows=10)
        with pytest.raises(ValueError, match="rows recorded: 0 to 0, of 10"):
            Batch(engine, 2).traces()

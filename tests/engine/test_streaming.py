"""Streamed profiles in the kernel: exact over any length, told ahead, replaced and resumed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import count, repeat
from math import inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import (
    AxisHardware,
    Engine,
    Event,
    MasterSource,
    RatioSegment,
    Segment,
    plan_preset,
    plan_stop,
    rates_for,
)
from emulator.engine.ratio_streaming import StreamedRatio
from emulator.engine.streaming import ENDLESS, PARTS_PER_COUNT, TICKS_PER_S, Stream, StreamedSegment

ALL_CLOSED = 0xFFF
COUNTS = 4000.0


def engine_with_drive_on() -> Engine:
    engine = Engine([AxisHardware()] * 2, rates=rates_for(2, 4))
    engine.set_wires(ALL_CLOSED)
    engine.set_position_error_limit(0, 0)
    engine.run(engine.next_system_update_ns)
    engine.enable(0)
    return engine


def move(distance: int, velocity: float = COUNTS, acceleration: float = 10 * COUNTS) -> list[StreamedSegment]:
    """A preset move from rest to rest in pieces."""
    *planned, end = plan_preset(0.0, 0.0, distance, velocity, acceleration, acceleration)
    places = [round(segment.position * PARTS_PER_COUNT) for segment in (*planned, end)]
    return [
        StreamedSegment(
            segment._replace(position=0.0), round(segment.duration_s * TICKS_PER_S), places[index + 1] - places[index]
        )
        for index, segment in enumerate(planned)
    ]


def steady(counts_s: float, duration_s: float, mark: object | None = None) -> StreamedSegment:
    segment = Segment(duration_s, 0.0, counts_s, 0.0, 0.0)
    return StreamedSegment(
        segment, round(duration_s * TICKS_PER_S), round(counts_s * duration_s * PARTS_PER_COUNT), mark
    )


@given(st.lists(st.integers(-30_000, 30_000).filter(bool), min_size=1, max_size=60))
@settings(deadline=None, max_examples=15)
def test_moves_in_a_row_end_where_their_sum_is(distances: list[int]) -> None:
    engine = engine_with_drive_on()
    pieces = [piece for distance in distances for piece in move(distance)]
    begin_ns = engine.next_trajectory_ns
    stream = engine.stream_profile(0, iter(pieces))
    end_ns = begin_ns + sum(piece.duration for piece in pieces) * 10**9 // TICKS_PER_S
    while engine.streams(0, stream):
        engine.run(engine.next_trajectory_ns)
    assert engine.commanded_position(0) == sum(distances)
    assert 0 <= engine.time_ns - end_ns <= engine.rates.trajectory_ns


@given(st.integers(1, 10**9), st.sampled_from([-1, 1]))
@settings(deadline=None, max_examples=20)
def test_a_portion_knows_its_place_after_any_number_of_segments(passes: int, sign: int) -> None:
    """As if so many passes had gone: the place of a portion is exact."""
    stream = Stream(repeat(steady(sign * 1001.0, 1e-3)), margin_s=0.01)
    portion = stream.begin(at_ns=10**6, position_counts=0.0)
    each = round(1e-3 * TICKS_PER_S)
    travel = round(sign * 1.001 * PARTS_PER_COUNT)
    rows = stream._rows
    skipped = [row._replace(start=row.start + passes * each, position=row.position + passes * travel) for row in rows]
    stream._rows.clear()
    stream._rows.extend(skipped)
    stream._time += passes * each
    stream._position += passes * travel
    later = stream.go_on(1)
    exact_ns, exact_counts = (passes + 1) * each * 10**9 / TICKS_PER_S, (passes + 1) * travel / PARTS_PER_COUNT
    assert later.base_ns + later.lead_s * 1e9 == pytest.approx(10**6 + exact_ns, abs=1e-3)
    assert later.origin_counts + later.segments[0].position == pytest.approx(exact_counts, rel=1e-15)
    assert 0.0 <= later.segments[0].position < 1.0
    assert portion.base_ns == 10**6


def test_a_million_short_segments_keep_step() -> None:
    engine = engine_with_drive_on()
    piece = steady(3 * COUNTS + 1.0, 1e-3)
    begin_ns = engine.next_trajectory_ns
    engine.stream_profile(0, repeat(piece))
    at_ns = begin_ns + 40 * 10**9
    while engine.time_ns < at_ns:
        engine.run(at_ns)
    elapsed_s = (at_ns - begin_ns) / 1e9
    exact = piece.displacement / PARTS_PER_COUNT / 1e-3 * elapsed_s
    assert engine.commanded_position(0) == pytest.approx(exact, abs=(3 * COUNTS) * 1.12e-3 + 1)


def test_marks_are_told_ahead_of_their_time() -> None:
    engine = engine_with_drive_on()
    told: list[tuple[int, int, object]] = []
    pieces = (steady(COUNTS, 0.01, mark=number) for number in count())
    begin_ns = engine.next_trajectory_ns
    engine.stream_profile(0, pieces, lambda at_ns, mark: told.append((engine.time_ns, at_ns, mark)))
    fed = 0
    end_ns = begin_ns + 5 * 10**9
    while engine.time_ns < end_ns:
        fed += bool(engine.run(end_ns) & Event.ROWS_LOW)
    assert [mark for _, _, mark in told] == list(range(len(told)))
    assert all(at_ns == begin_ns + number * 10_000_000 for number, (_, at_ns, _) in enumerate(told))
    later = [at_ns - now_ns for now_ns, at_ns, mark in told if now_ns > begin_ns]
    assert later and min(later) > 2 * engine.rates.system_ns
    assert fed < 15, "not once a segment"


def test_segments_much_shorter_than_an_update() -> None:
    engine = engine_with_drive_on()
    pieces = [steady(50 * COUNTS, 5e-6)] * 3000 + [steady(COUNTS, 0.5)] + [steady(50 * COUNTS, 5e-6)] * 3000
    stream = engine.stream_profile(0, iter(pieces))
    while engine.streams(0, stream):
        engine.run(engine.time_ns + 10**9)
    assert engine.commanded_position(0) == 6000 + 2000


def endless_between() -> Iterator[StreamedSegment]:
    yield from move(4000)
    yield StreamedSegment(Segment(inf, 0.0, 0.0, 0.0, 0.0), ENDLESS, 0)
    yield from move(-1000)


def test_a_stream_waits_in_an_endless_segment_until_it_is_resumed() -> None:
    engine = engine_with_drive_on()
    stream = engine.stream_profile(0, endless_between())
    engine.run(engine.time_ns + 10**10)
    assert engine.streams(0, stream)
    assert engine.commanded_position(0) == 4000
    engine.resume_stream(0)
    while engine.streams(0, stream):
        engine.run(engine.time_ns + 10**9)
    assert engine.commanded_position(0) == 3000
    with pytest.raises(ValueError, match="streamed"):
        engine.resume_stream(1)


def replace_with_stop(engine: Engine) -> None:
    state = engine.profile_state(0)
    engine.start_profile(0, plan_stop(state.position, state.velocity, 10 * COUNTS))


@pytest.mark.parametrize("replace", [replace_with_stop, lambda engine: engine.disable(0)])
def test_whatever_replaces_a_stream_ends_it(replace: Callable[[Engine], None]) -> None:
    engine = engine_with_drive_on()
    stream = engine.stream_profile(0, repeat(steady(COUNTS, 0.01)))
    engine.run(engine.time_ns + 10**9)
    replace(engine)
    assert not engine.streams(0, stream)
    engine.run(engine.time_ns + 10**10)
    here = engine.commanded_position(0)
    engine.run(engine.time_ns + 10**9)
    assert abs(engine.commanded_position(0) - here) <= 1


def test_where_calls_are_cut_changes_nothing() -> None:
    def run(step_ns: int) -> bytes:
        engine = engine_with_drive_on()
        begin_ns = engine.time_ns
        engine.stream_profile(0, repeat(steady(COUNTS + 0.3, 0.003)))
        while engine.time_ns < begin_ns + 2 * 10**9:
            engine.run(min(engine.time_ns + step_ns, begin_ns + 2 * 10**9))
        return engine.snapshot()

    assert run(10**12) == run(777_777)


def endless_steps(ratio: int) -> Iterator[StreamedRatio]:
    """Pieces of 100 master counts without end."""
    return repeat(StreamedRatio(RatioSegment(Fraction(100), Fraction(ratio), Fraction(ratio))))


def replace_by(engine: Engine, what: str) -> None:
    """Put another motion in place of that of axis 1."""
    if what == "profile":
        engine.start_profile(0, plan_stop(*engine.profile_state(0)[:2], 40 * COUNTS))
    elif what == "stream":
        engine.stream_profile(0, repeat(steady(COUNTS, 0.01)))
    elif what == "following":
        engine.start_following(0, (RatioSegment(None, Fraction(1), Fraction(1)),), preset=False)
    elif what == "following stream":
        engine.stream_following(0, endless_steps(1), preset=False)
    else:
        engine.cancel_profile(0)


MOTIONS = ("profile", "stream", "following", "following stream")


@pytest.mark.parametrize("first", MOTIONS)
@pytest.mark.parametrize("then", (*MOTIONS, "nothing"))
def test_whatever_moves_an_axis_takes_the_place_of_every_stream(first: str, then: str) -> None:
    engine = engine_with_drive_on()
    engine.set_master(0, source=MasterSource.ENCODER, master_index=1)
    replace_by(engine, first)
    timed = engine.stream_profile(0, repeat(steady(COUNTS, 0.01))) if first == "stream" else None
    ratio = engine.stream_following(0, endless_steps(2), preset=False) if first == "following stream" else None
    engine.run(engine.time_ns + 10**8)
    replace_by(engine, then)
    assert timed is None or not engine.streams(0, timed)
    assert ratio is None or not engine.streams_ratio(0, ratio)
    if "stream" not in then:
        for resume in (engine.resume_stream, engine.resume_following):
            with pytest.raises(ValueError, match="no streamed"):
                resume(0)
        engine.slip_encoder(1, 100_000)
        end_ns = engine.time_ns + 10**9
        while engine.time_ns < end_ns:
            assert not engine.run(end_ns) & Event.ROWS_LOW, "nothing is asked for on behalf of a stream that is gone"

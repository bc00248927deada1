"""Ratio moves: where the slave is for every master position, in either direction, exactly."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import (
    DriveShutDown,
    Event,
    MasterSource,
    NoMaster,
    RatioSegment,
    master_travel,
    plan_continuous,
    plan_ratio_change,
    plan_ratio_preset,
    plan_stop,
    slave_at,
)
from tests.engine.following_rig import MASTER, SLAVE, Gearing, rounded

ZERO = Fraction(0)
ratios = st.builds(Fraction, st.integers(-500_000, 500_000), st.integers(1, 99_999)).filter(lambda r: abs(r) <= 127)
steps = st.lists(st.integers(-20_000, 20_000), min_size=1, max_size=12)


@given(ratios, steps, st.booleans())
@settings(max_examples=150, deadline=None)
def test_at_constant_ratio_the_slave_is_the_exact_function_of_the_master(
    ratio: Fraction, steps: list[int], prediction: bool
) -> None:
    gearing = Gearing(prediction=prediction)
    gearing.at_ratio(ratio)
    for step in steps:
        gearing.turn(step)
        if step % 3 == 0:
            gearing.settle()
            assert gearing.slave == rounded(ratio * gearing.master)
    gearing.settle()
    assert gearing.slave == rounded(ratio * gearing.master)


@pytest.mark.parametrize("ratio", [Fraction(125, 12), Fraction(-1, 3), Fraction(999_999_937, 99_999_989)])
def test_a_billion_counts_and_back_do_not_drift(ratio: Fraction) -> None:
    gearing = Gearing()
    gearing.at_ratio(ratio)
    for direction in (1, 1, -1, -1, -1):
        gearing.turn(*[direction * 99_999_989] * 10)
        gearing.settle()
        assert gearing.slave == rounded(ratio * gearing.master)
    assert gearing.master == -999_999_890


@given(
    st.integers(1, 30_000), st.integers(1, 40_000), st.builds(Fraction, st.integers(1, 400), st.integers(1, 97)), steps
)
@settings(max_examples=120, deadline=None)
def test_a_preset_move_lands_exactly_whatever_its_master_does(
    distance: int, master_distance: int, ratio: Fraction, steps: list[int]
) -> None:
    ratio = max(ratio, Fraction(distance, master_distance))
    plan = plan_ratio_preset(-distance, master_distance, ratio)
    gearing = Gearing(prediction=False)
    gearing.follow(plan, preset=True)
    start, furthest = 0, 0
    for step in steps:
        gearing.turn(step)
        if furthest == 0:
            start = min(start, gearing.master)
        furthest = max(furthest, gearing.master - start)
        gearing.settle()
        here = gearing.master - start if furthest < master_distance else master_distance
        assert abs(gearing.slave - slave_at(plan, here)) <= Fraction(1, 2) + Fraction(1, 10**6)
    gearing.turn(start + master_distance - gearing.master + 1)
    gearing.settle()
    assert gearing.slave == -distance
    assert not gearing.engine.is_moving(SLAVE)
    gearing.turn(-5000)
    gearing.settle()
    assert gearing.slave == -distance, "at its end for good"


def test_the_transcript_of_a_ramp_a_constant_ratio_and_a_ramp_to_rest() -> None:
    """Ratio 1/2 over 4000, 10000 more, back to 0 over 4000: 1000, 5000 and 1000 slave counts."""
    gearing = Gearing()
    engine = gearing.engine
    gearing.follow(plan_ratio_change(ZERO, Fraction(1, 2), 4000))
    gearing.turn(*[400] * 5)
    assert engine.following_status(SLAVE) & 0b1111 == 0b0101
    gearing.turn(*[400] * 5)
    gearing.settle()
    assert (gearing.slave, engine.following_status(SLAVE) & 0b1111) == (1000, 0b1001)
    gearing.turn(*[500] * 20)
    gearing.settle()
    assert gearing.slave == 6000
    gearing.follow(plan_ratio_change(engine.following_ratio(SLAVE), ZERO, 4000))
    gearing.turn(*[400] * 10)
    gearing.settle()
    assert (gearing.slave, engine.following_status(SLAVE) & 0b1111) == (7000, 0)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_continuous_move_starts_either_way_and_keeps_its_ratio_once_it_has_it(direction: int) -> None:
    gearing = Gearing()
    gearing.follow(plan_ratio_change(ZERO, Fraction(2), 1000))
    gearing.turn(*[100 * direction] * 10)
    gearing.settle()
    assert gearing.slave == 1000 * direction
    gearing.turn(*[-500 * direction] * 10)
    gearing.settle()
    assert gearing.slave == 1000 * direction - 10_000 * direction


def test_a_ramp_is_retraced_by_a_master_that_backs_up_and_mirrored_beyond_its_beginning() -> None:
    gearing = Gearing(prediction=False)
    plan = plan_ratio_change(ZERO, Fraction(1), 1000)
    gearing.follow(plan)
    for place in (600, 200, -400, -900):
        gearing.turn_to([place])
        gearing.settle()
        expected = slave_at(plan, abs(place))
        assert gearing.slave == rounded(expected if place > 0 else -expected)


def test_the_ratio_is_changed_in_motion_without_a_jump() -> None:
    gearing = Gearing()
    engine = gearing.engine
    gearing.at_ratio(Fraction(1, 3))
    gearing.turn(*[100] * 10)
    gearing.follow(plan_ratio_change(engine.following_ratio(SLAVE), Fraction(5, 7), 700))
    before = gearing.slave
    for _ in range(40):
        gearing.turn(100)
        assert 0 <= gearing.slave - before <= 100
        before = gearing.slave
    gearing.settle()
    begun_at = 1200  # predicted two samples ahead of the 1000 at which the change was made
    ramp = Fraction(700) * (Fraction(1, 3) + Fraction(5, 7)) / 2
    expected = Fraction(begun_at, 3) + ramp + (gearing.master - begun_at - 700) * Fraction(5, 7)
    assert gearing.slave == rounded(expected)


def test_fractions_of_a_count_go_over_from_move_to_move() -> None:
    gearing = Gearing()
    for _ in range(300):
        gearing.follow(plan_ratio_change(ZERO, Fraction(1, 3), 100))
        gearing.turn(*[50] * 4)
        gearing.settle()
        gearing.follow(plan_ratio_change(Fraction(1, 3), ZERO, 100))
        gearing.turn(*[50] * 4)
        gearing.settle()
    each = Fraction(100, 6) + Fraction(100, 3) + Fraction(100, 6)
    assert gearing.slave == rounded(300 * each)


def test_a_preset_move_waits_for_the_positive_direction_and_does_not_mind_backing_up_before() -> None:
    gearing = Gearing()
    gearing.follow(plan_ratio_preset(500, 1000, Fraction(1)), preset=True)
    gearing.turn(-300, -300)
    gearing.settle()
    assert (gearing.slave, gearing.engine.is_moving(SLAVE)) == (0, True)
    assert gearing.engine.status(SLAVE) & 1 == 0, "nothing moves while it waits"
    gearing.turn(*[100] * 10)
    gearing.settle()
    assert (gearing.slave, gearing.engine.is_moving(SLAVE)) == (500, False)


@pytest.mark.parametrize("ratio", [ZERO, Fraction(2)])
def test_a_move_begins_at_the_master_position_it_is_given(ratio: Fraction) -> None:
    gearing = Gearing(prediction=False)
    if ratio:
        gearing.at_ratio(ratio)
    gearing.follow(plan_ratio_change(ratio, Fraction(3), 0), start_at=1234)
    assert gearing.engine.is_held(SLAVE)
    gearing.turn(1000, -500, 700)
    gearing.settle()
    assert gearing.slave == 1200 * ratio
    gearing.turn(1000)
    gearing.settle()
    assert gearing.slave == 1234 * ratio + 3 * (2200 - 1234)
    assert not gearing.engine.is_held(SLAVE)


def test_a_continuous_move_can_be_told_to_begin_further_back() -> None:
    gearing = Gearing(prediction=False)
    gearing.follow(plan_ratio_change(ZERO, Fraction(1), 0), start_at=-100)
    gearing.turn(50, -149)
    gearing.settle()
    assert gearing.slave == 0
    gearing.turn(-51)
    gearing.settle()
    assert gearing.slave == -50


@pytest.mark.parametrize("goal", [0, 1, 3])
@pytest.mark.parametrize("start_at", [1234, -1234])
@pytest.mark.parametrize("again_at", [None, 1500, -1500])
def test_a_move_in_place_of_one_that_waits_since_the_same_instant(
    goal: int, start_at: int, again_at: int | None
) -> None:
    """The slave at ratio 2 is where its master is, not where the move that is given up would have begun."""
    gearing = Gearing(prediction=False)
    gearing.at_ratio(2)
    gearing.turn(500)
    gearing.settle()
    gearing.follow(plan_ratio_change(Fraction(2), Fraction(3), 0), start_at=start_at)
    gearing.follow(plan_ratio_change(Fraction(2), Fraction(goal), 0), start_at=again_at)
    gearing.settle()
    assert gearing.slave == 1000
    gearing.turn(100)
    gearing.settle()
    assert gearing.slave == 1000 + 100 * (goal if again_at is None else 2)
    if again_at is not None:
        gearing.turn_to([again_at])
        gearing.turn(100 if again_at > 0 else -100)
        gearing.settle()
        assert gearing.slave == 2 * again_at + (100 if again_at > 0 else -100) * goal


def test_the_end_is_told_when_the_commanded_position_is_there() -> None:
    gearing = Gearing(prediction=False)
    engine = gearing.engine
    gearing.follow(plan_ratio_preset(300, 300, Fraction(1)), preset=True)
    gearing.turn(300)
    assert engine.is_moving(SLAVE)
    assert engine.run(engine.time_ns + 3 * engine.rates.system_ns) == Event.MOVE_ENDED
    assert (gearing.slave, engine.time_ns % engine.rates.system_ns) == (300, 0)
    assert engine.commanded_velocity(SLAVE) == 0.0


def test_a_stop_in_time_takes_over_at_the_velocity_the_slave_has() -> None:
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.turn(*[56] * 20)
    engine = gearing.engine
    position, velocity, _ = engine.profile_state(SLAVE)
    assert velocity == pytest.approx(25_000)
    engine.start_profile(SLAVE, plan_stop(position, velocity, 250_000.0))
    gearing.turn(*[56] * 100)
    assert gearing.slave == pytest.approx(position + velocity**2 / 500_000, abs=1)
    rest = gearing.slave
    gearing.at_ratio(1)
    gearing.turn(*[56] * 20)
    gearing.settle()
    assert gearing.slave - rest == 18 * 56, "it began at the position predicted when it was started"


def test_a_kill_stops_at_once() -> None:
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.turn(*[56] * 20)
    here = gearing.slave
    gearing.engine.cancel_profile(SLAVE)
    gearing.turn(*[56] * 20)
    assert (gearing.slave, gearing.engine.is_moving(SLAVE)) == (here, False)
    assert gearing.engine.following_status(SLAVE) & 0b1111 == 0


def test_pset_of_master_and_slave_moves_nothing() -> None:
    gearing = Gearing()
    gearing.at_ratio(2)
    gearing.turn(*[100] * 10)
    gearing.settle()
    gearing.engine.set_position(MASTER, 77)
    gearing.engine.set_position(SLAVE, 0)
    gearing.turn(*[100] * 10)
    gearing.settle()
    assert gearing.slave == 2000


def test_the_sign_of_the_assignment_turns_the_master_round() -> None:
    gearing = Gearing(sign=-1)
    gearing.at_ratio(2)
    gearing.turn(100)
    gearing.settle()
    assert (gearing.slave, gearing.engine.master_counts(SLAVE)) == (-200, -100)


def test_what_is_refused() -> None:
    gearing = Gearing()
    engine = gearing.engine
    with pytest.raises(ValueError, match="no axis 3"):
        engine.set_master(SLAVE, source=MasterSource.ENCODER, master_index=2)
    gearing.at_ratio(1)
    with pytest.raises(ValueError, match="axis 1 is following"):
        engine.set_master(SLAVE, source=MasterSource.NONE)
    engine.disable(SLAVE)
    with pytest.raises(DriveShutDown):
        gearing.at_ratio(1)
    engine.enable(MASTER)
    with pytest.raises(NoMaster):
        engine.start_following(MASTER, (), preset=False)


def test_no_segments_end_where_the_slave_is() -> None:
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.turn(*[56] * 10)
    gearing.follow(())
    gearing.settle()
    assert gearing.slave == 10 * 56 + 2 * 56
    assert not gearing.engine.is_moving(SLAVE)


@given(steps, st.integers(1, 5))
@settings(max_examples=40, deadline=None)
def test_a_slave_follows_the_commanded_position_of_another_axis(steps: list[int], ratio: int) -> None:
    gearing = Gearing(prediction=False)
    engine = gearing.engine
    engine.set_master(SLAVE, source=MasterSource.COMMANDED, master_index=MASTER)
    engine.enable(MASTER)
    engine.set_position_error_limit(MASTER, 0)
    gearing.at_ratio(ratio)
    velocity = 0.0
    for step in steps:
        velocity = float(step)
        engine.start_profile(MASTER, plan_continuous(*engine.profile_state(MASTER)[:2], velocity, 1e6, 1e6))
        gearing.pass_updates(20)
    engine.cancel_profile(MASTER)
    gearing.settle()
    assert gearing.slave == ratio * engine.commanded_position(MASTER)


def test_whole_segments_are_known_beforehand() -> None:
    gearing = Gearing()
    gearing.follow(plan_ratio_preset(500, 1000, Fraction(1)), preset=True)
    assert gearing.engine.profile_target(SLAVE) == 500
    assert master_travel(plan_ratio_preset(500, 1000, Fraction(1))) == 1000
    gearing.at_ratio(1)
    assert gearing.engine.profile_target(SLAVE) is None


def test_several_pieces_forwards_and_back() -> None:
    """A compiled profile: up, along at a third, down to a seventh, to rest."""
    third, seventh = Fraction(1, 3), Fraction(1, 7)
    plan = (
        RatioSegment(Fraction(100), ZERO, third),
        RatioSegment(Fraction(1000, 7), third, third),
        RatioSegment(Fraction(50, 3), third, seventh),
        RatioSegment(Fraction(900), seventh, seventh),
        RatioSegment(Fraction(60), seventh, ZERO),
    )
    gearing = Gearing(prediction=False)
    gearing.follow(plan, preset=True)
    for place in (50, 101, 243, 250, 300, 1100, 255, 120, 99, 10, 1150):
        gearing.turn_to([place])
        gearing.settle()
        assert gearing.slave == rounded(slave_at(plan, place)), place
    gearing.turn(200)
    gearing.settle()
    assert gearing.slave == rounded(slave_at(plan, 10_000))

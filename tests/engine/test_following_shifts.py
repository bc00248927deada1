"""Phase shifts: profiles in time on top of a ratio move, adding exactly what they say."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import Event, plan_continuous, plan_preset, plan_ratio_change, plan_stop
from tests.engine.following_rig import MASTER, SLAVE, Gearing, rounded

SHIFTING = 1 << 9
CONTINUOUS = 1 << 10
NEGATIVE = 1 << 11


def shift_by(gearing: Gearing, counts: int) -> None:
    here = gearing.engine.shift_state(SLAVE)
    target = here.position + counts
    gearing.engine.start_shift(SLAVE, plan_preset(here.position, here.velocity, target, 40_000.0, 2e6, 2e6))


@given(
    st.integers(-3000, 3000).filter(bool),
    st.integers(-200, 200),
    st.builds(Fraction, st.integers(-60, 60), st.integers(1, 9)),
)
@settings(max_examples=60, deadline=None)
def test_a_preset_shift_adds_exactly(counts: int, step: int, ratio: Fraction) -> None:
    gearing = Gearing(prediction=False)
    gearing.at_ratio(ratio)
    gearing.turn(*[step] * 5)
    shift_by(gearing, counts)
    assert gearing.engine.is_shifting(SLAVE)
    gearing.turn(*[step] * 60)
    gearing.settle()
    assert not gearing.engine.is_shifting(SLAVE)
    assert gearing.engine.shift_counts(SLAVE) == counts
    assert gearing.slave == rounded(ratio * gearing.master + counts)


def test_a_shift_is_part_of_the_position_at_the_next_ratio_move() -> None:
    gearing = Gearing()
    gearing.at_ratio(Fraction(1, 3))
    gearing.turn(*[100] * 10)
    shift_by(gearing, 250)
    gearing.pass_updates(60)
    before = gearing.slave
    gearing.at_ratio(Fraction(2, 3))
    gearing.pass_updates(1)
    assert (gearing.slave, gearing.engine.shift_counts(SLAVE)) == (before, 0)
    gearing.turn(*[100] * 10)
    gearing.settle()
    assert gearing.slave == rounded(Fraction(1000, 3) + 250 + Fraction(2000, 3))


def test_a_continuous_shift_goes_on_until_it_is_stopped_or_killed() -> None:
    gearing = Gearing()
    engine = gearing.engine
    gearing.at_ratio(1)
    gearing.pass_updates(2)
    engine.start_shift(SLAVE, plan_continuous(0.0, 0.0, -10_000.0, 1e6, 1e6), continuous=True)
    gearing.pass_updates(100)
    assert engine.following_status(SLAVE) & (SHIFTING | CONTINUOUS | NEGATIVE) == SHIFTING | CONTINUOUS | NEGATIVE
    assert engine.commanded_velocity(SLAVE) == -10_000.0
    position, velocity, _ = engine.shift_state(SLAVE)
    engine.start_shift(SLAVE, plan_stop(position, velocity, 1e6), continuous=True)
    gearing.pass_updates(60)
    assert engine.following_status(SLAVE) & SHIFTING == 0
    assert engine.shift_counts(SLAVE) == gearing.slave == pytest.approx(position - 50, abs=1)
    engine.start_shift(SLAVE, plan_continuous(*engine.shift_state(SLAVE)[:2], 10_000.0, 1e6, 1e6), continuous=True)
    gearing.pass_updates(20)
    engine.cancel_shift(SLAVE)
    here = gearing.slave
    gearing.pass_updates(20)
    assert gearing.slave == here == engine.shift_counts(SLAVE)


def test_an_axis_at_rest_is_shifted_and_is_at_rest_again() -> None:
    gearing = Gearing()
    engine = gearing.engine
    gearing.turn(500)
    shift_by(gearing, 321)
    assert engine.is_moving(SLAVE)
    assert engine.run(engine.time_ns + 10**9) == Event.MOVE_ENDED
    assert (gearing.slave, engine.is_moving(SLAVE), engine.shift_counts(SLAVE)) == (321, False, 321)
    shift_by(gearing, -21)
    assert engine.run(engine.time_ns + 10**9) == Event.MOVE_ENDED
    assert (gearing.slave, engine.shift_counts(SLAVE)) == (300, 300)


def test_no_shift_of_an_axis_that_moves_in_time() -> None:
    gearing = Gearing()
    gearing.engine.start_profile(SLAVE, plan_continuous(0.0, 0.0, 1000.0, 1e6, 1e6))
    with pytest.raises(ValueError, match="axis 1 is moving"):
        shift_by(gearing, 10)
    with pytest.raises(ValueError, match="at least one segment"):
        gearing.engine.start_shift(SLAVE, ())


def test_a_ratio_move_that_ends_waits_for_its_shift() -> None:
    gearing = Gearing()
    engine = gearing.engine
    gearing.at_ratio(1)
    gearing.turn(*[10] * 5)
    engine.start_shift(SLAVE, plan_preset(0.0, 0.0, 4000.0, 20_000.0, 2e6, 2e6))
    gearing.follow(plan_ratio_change(Fraction(1), Fraction(0), 0))
    gearing.turn(0, 0, 0, 0, 0, 0)
    assert engine.is_moving(SLAVE)
    gearing.pass_updates(100)
    assert not engine.is_moving(SLAVE)
    assert gearing.slave == engine.encoder_position(MASTER) + 2 * 10 + 4000

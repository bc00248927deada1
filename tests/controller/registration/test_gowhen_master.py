"""GOWHEN on PMAS: a slave begins at the very count of its master, whatever the update; cycles; other axes."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.following.rig import FollowingRig
from tests.controller.session import SYSTEM_NS, S

GEARED = ("FPPEN00", "FOLRN1", "FOLRD1", "FOLMD0", "MC1", "D+")


@settings(max_examples=20, deadline=None)
@given(begin=st.integers(1, 2000), step=st.integers(1, 90))
def test_a_slave_begins_exactly_there(begin: int, step: int) -> None:
    rig = FollowingRig(*GEARED, f"GOWHEN(1PMAS>={begin})", "GO1")
    assert rig.axis_bit(26)
    assert rig.travel(begin - 1, step=step) == 0
    assert rig.axis_bit(26)
    assert rig.travel(3001 - begin, step=step) == 3000 - begin
    assert not rig.axis_bit(26)


def test_beyond_and_at() -> None:
    assert FollowingRig(*GEARED, "GOWHEN(1PMAS>500)", "GO1").travel(1000) == 499
    assert FollowingRig(*GEARED, "GOWHEN(1PMAS=500)", "GO1").travel(1000) == 500


def test_a_preset_move() -> None:
    rig = FollowingRig("FOLRN1", "FOLMD1000", "MC0", "D800", "GOWHEN(1PMAS>=321)", "GO1")
    assert rig.travel(321) == 0
    assert rig.travel(1000) == 800
    assert not rig.signal("axis1.moving")


def test_a_change_of_ratio() -> None:
    rig = FollowingRig(*GEARED, "GO1")
    assert rig.travel(200) == 200
    rig.ok("FOLRN3", "GOWHEN(1PMAS>=777)", "GO1")
    assert rig.axis_bit(26)
    assert rig.travel(800) == 777 + 3 * 223


def test_an_argument_beyond_the_cycle_is_in_the_next() -> None:
    rig = FollowingRig(*GEARED, "FMCLEN1000")
    rig.travel(2700)
    rig.ok("GOWHEN(1PMAS>=1200)", "GO1")
    assert rig.axis_bit(26)
    assert rig.travel(1000) == 3700 - 3200


def test_a_position_missed_comes_again_in_the_next_cycle() -> None:
    rig = FollowingRig(*GEARED, "FMCLEN1000", "ERROR.14-1")
    rig.travel(700)
    rig.ok("GOWHEN(1PMAS=300)", "GO1")
    assert not rig.error_bit(14)
    assert rig.travel(1000) == 1700 - 1300


def test_already_there() -> None:
    rig = FollowingRig(*GEARED, "ERROR.14-1")
    rig.travel(700)
    rig.ok("GOWHEN(1PMAS>=300)", "GO1")
    assert rig.error_bit(14)
    assert rig.travel(100) == 100


def test_an_axis_that_does_not_follow_begins_at_the_update_after() -> None:
    """Axis 2 turns the master, and changes its own velocity at a master position."""
    rig = FollowingRig("DRIVE11", "SMPER0,0", "MC11", "A100,100", "V1,1", "GOX1", "V,2", "2GOWHEN(1PMAS>=4000)", "GOX1")
    before = 0.0
    while rig.axis_bit(26, 2):
        before = rig.number("axis2.position.encoder")
        rig.advance(SYSTEM_NS / S)
    assert before < 4000 <= rig.number("axis2.position.encoder")
    rig.advance(0.1)
    assert rig.number("axis2.velocity.commanded") == 8000


@pytest.mark.parametrize("ending", ["!1S", "!1K", "!K"])
def test_a_slave_that_waits_can_be_stopped(ending: str) -> None:
    rig = FollowingRig(*GEARED, "GOWHEN(1PMAS>=500)", "GO1", ending)
    assert not rig.axis_bit(26)
    assert rig.travel(1000) == 0


def test_a_new_go_takes_the_place_of_one_the_servo_holds_back() -> None:
    rig = FollowingRig(*GEARED, "GOWHEN(1PMAS>=500)", "GO1", "GO1")
    assert not rig.axis_bit(26)
    assert rig.travel(1000) == 1000


def test_the_net_shift_and_the_slave_position_are_operands() -> None:
    rig = FollowingRig(*GEARED, "GO1")
    rig.travel(100)
    rig.ok("DRIVE11", "2GOWHEN(1PSLV>=400)", "MC10", "D,100", "GOX1")
    assert rig.axis_bit(26, 2)
    rig.travel(350)
    assert not rig.axis_bit(26, 2)


def test_a_trigger_begins_a_master_cycle_once() -> None:
    rig = FollowingRig("INFNC25-H", "INFEN1", "FMCLEN1000", "FMCP-50", "1TRGFNAX1")
    rig.travel(321)
    assert rig.following_bit(13)
    rig.unit.do("press_trigger", trigger="A")
    rig.travel(0)
    assert rig.query("1TPMAS") == "1TPMAS-50"
    assert rig.query("1TRGFNA") == "1TRGFNA00"
    assert not rig.following_bit(13)


def test_the_cycle_begins_where_the_master_was_at_the_edge() -> None:
    rig = FollowingRig("INFNC26-H", "INFEN1", "FMCP10", "1TRGFNBX1")
    rig.travel(321)
    begin_s = rig.now_ns / S
    rig.unit.do("press_trigger", trigger="B", at=begin_s + 0.0007)
    rig.emulator.at(begin_s + 0.0012, lambda: rig.unit.do("slip_encoder", axis=2, counts=40))
    rig.advance(3 * SYSTEM_NS / S)
    assert rig.query("1TPMAS") == "1TPMAS+50"

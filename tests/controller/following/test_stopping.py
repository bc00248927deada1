"""What ends a slave's motion, and what is left of Following afterwards."""

from __future__ import annotations

import pytest

from tests.controller.following.rig import FollowingRig
from tests.controller.session import Session


def running(*commands: str, **defaults: str | int) -> FollowingRig:
    """A slave at ratio 1 whose master has made 50 counts in each of 20 updates: 22321 counts/s."""
    rig = FollowingRig("MC1", "FOLMD0", *commands, "1GO1", **defaults)
    for _ in rig.turn([50] * 20):
        pass
    return rig


def keep_turning(rig: FollowingRig, updates: int) -> list[int]:
    return list(rig.turn([50] * updates))


@pytest.mark.parametrize(("command", "ramp"), [("!1S", "AD"), ("!S", "AD"), ("!1K", "LHAD"), ("!K", "LHAD")])
def test_stop_and_kill_decelerate_in_time(command: str, ramp: str) -> None:
    """At 22321 counts/s and 10 rev/s2 it takes v^2 / 2a = 6228 counts, whatever the master does meanwhile."""
    rig = running(f"{ramp}10")
    began = rig.position()
    rig.ok(command)
    keep_turning(rig, 300)
    assert rig.position() - began == pytest.approx(22_321**2 / (2 * 40_000), abs=150)
    assert rig.following_bits()[:6] == "000011", "Following stays enabled, out of ratio"
    before = rig.position()
    assert rig.travel(1000) == before


def test_after_a_stop_go_starts_anew_from_there() -> None:
    rig = running()
    rig.ok("!1S")
    keep_turning(rig, 300)
    before = rig.travel(0)
    rig.ok("FOLMD1000", "1GO1")
    assert rig.travel(1000) == before + 500
    assert rig.travel(1000) == before + 1500


def test_a_stop_takes_the_shift_with_it() -> None:
    rig = running("V2")
    rig.ok("1FSHFC1", "!1S")
    keep_turning(rig, 300)
    assert rig.following_bits()[9] == "0"
    assert not rig.axis_bit(1)


def test_go_while_it_still_brakes_is_refused() -> None:
    rig = running("AD5")
    rig.ok("!1S")
    keep_turning(rig, 5)
    assert rig.error("1GO1") == "MOTION IN PROGRESS"


def test_a_hard_limit_stops_a_slave_at_lhad() -> None:
    rig = running("COMEXL1", "LHAD100")
    rig.unit.do("set_wire", name="axis1.positive_limit", closed=False)
    keep_turning(rig, 60)
    assert rig.axis_bit(15)
    assert not rig.axis_bit(1)
    assert rig.following_bits()[:6] == "000011"
    before = rig.position()
    assert keep_turning(rig, 5)[-1] == before


@pytest.mark.parametrize("step", [50, -50])
def test_a_soft_limit_stops_a_slave_at_lsad(step: int) -> None:
    rig = running("COMEXL1", "LSPOS8000", "LSNEG-8000", "LS3", "LSAD200")
    for _ in rig.turn([step] * 250):
        pass
    assert rig.axis_bit(17 if step > 0 else 18)
    assert 8000 <= abs(rig.position()) <= 8000 + 22_321**2 / (2 * 800_000) + 150
    assert not rig.axis_bit(1)


def test_a_go_into_a_limit_does_not_start() -> None:
    rig = FollowingRig("MC0", "FOLMD1000", "D500")
    rig.set_wire("axis1.positive_limit", closed=False)
    rig.ok("1GO1")
    assert rig.travel(2000) == 0
    assert rig.axis_bit(15)
    rig.ok("D-500", "1GO1")
    assert rig.travel(1000) == -500
    assert not rig.axis_bit(15)


def test_a_continuous_go_looks_where_its_master_goes() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "1FPPEN0")
    rig.set_wire("axis1.positive_limit", closed=False)
    list(rig.turn([10] * 5))
    rig.ok("1GO1")
    assert rig.axis_bit(15)
    assert rig.following_bits()[0] == "0"
    list(rig.turn([-10] * 5))
    rig.ok("1GO1")
    assert rig.travel(-100) < -90


def test_drive0_ends_the_move_and_keeps_the_assignment() -> None:
    rig = running()
    rig.ok("!1DRIVE0")
    assert rig.following_bits()[:6] == "000011"
    assert rig.following_bits()[8] == "0"
    rig.travel(500)
    rig.ok("1DRIVE1", "1PSET0", "1GO1")
    assert rig.travel(500) == 500


def test_reset_ends_following() -> None:
    rig = running("FMCLEN100", "FFILT2", "FPPEN0")
    rig.ask("!RESET")
    rig.advance(0.1)
    for name, default in {"FOLMAS": "+0,+0", "FOLEN": "00", "FMCLEN": "0,0", "FFILT": "0,0", "FPPEN": "11"}.items():
        assert rig.look(name) == name + default
    assert set(rig.following_bits()) == {"0"}
    rig.ok("1DRIVE1")
    assert rig.travel(1000) == rig.position()
    rig.ok("1FOLMAS+21", "1FOLEN1", "1MC1", "COMEXC1", "1GO1")
    before = rig.travel(0)
    assert rig.travel(700) == before + 700


def test_power_off_and_on_ends_following() -> None:
    rig = running()
    rig.unit.do("cut_power")
    rig.advance(0.1)
    rig.unit.do("restore_power")
    rig.advance(0.1)
    assert set(rig.following_bits()) == {"0"}


def test_homing_and_jogging_wait_for_the_end_of_a_ratio_move() -> None:
    rig = running()
    assert rig.error("1HOM0") == "MOTION IN PROGRESS"
    assert rig.error("1JOG1") == "MOTION IN PROGRESS"
    before = rig.position()
    assert rig.travel(500) == before + 500


def test_feedback_of_a_slave_changes_only_at_rest() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "1GO1", machine="[options]\nani = true")
    rig.travel(100)
    assert rig.error("1SFB2") == "MOTION IN PROGRESS"
    rig.ok("!1S")
    rig.advance(0.5)
    rig.ok("1SFB2", "1GO1")
    before = rig.position()
    assert rig.travel(100) == before + 100


def test_a_new_feedback_of_the_master_moves_no_slave() -> None:
    """The commanded position of axis 2 jumps to the ANI input's; its slave does not."""
    session = Session("[options]\nani = true", COMEXC=1)
    session.ok("DRIVE11", "1FOLMAS+24", "1FOLEN1", "1MC1", "1FOLMD0", "1GO1", "2D4000", "2GO", wait_s=0.01)
    session.until_rest(2)
    session.advance(0.1)
    assert session.position() == 4000
    session.unit.do("force_ani", axis=2, volts=5.0)
    session.advance(0.1)
    session.ok("2SFB2")
    session.advance(0.1)
    assert session.position(2) == pytest.approx(4095, abs=1)
    assert session.position() == 4000


def test_pause_motion_leaves_the_ratio() -> None:
    """COMEXR1: a slave that was paused waits for its next GO."""
    rig = running("COMEXR1", "INFNC1-E", "INFEN1")
    rig.set_wire("input.1", closed=True)
    rig.advance(0.5)
    assert rig.following_bits()[0] == "0"


def test_position_error_ends_the_move() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "FOLRN100", "1GO1")
    rig.travel(1000)
    assert rig.axis_bit(23)
    assert rig.following_bits()[:6] == "000011"
    rig.ok("1DRIVE1", "FOLRN1", "1GO1")
    before = rig.travel(0)
    assert rig.travel(100) == before + 100


def test_a_unit_may_come_up_as_a_slave() -> None:
    session = Session("", FOLMAS="+24,0", FOLEN="10", COMEXC=1)
    for _ in range(2):
        session.ok("DRIVE11", "1MC1", "COMEXC1", "1GO1", "2D4000", "2GO", wait_s=0.05)
        session.until_rest(2)
        session.advance(0.1)
        assert session.position() == 4000
        session.ask("!RESET")
        session.advance(0.1)
        session.read()
        session.ok("PSET0,0")


def mutual(*commands: str) -> Session:
    """Both axes follow each other's commanded position at ratio 2, disturbed by a shift of one: nothing holds them."""
    session = Session("", COMEXC=1)
    session.ok("DRIVE11", *commands, "FOLMAS+24,+14", "FOLEN11", "MC11", "FOLRN2,2", "FOLMD0,0", "A100,100", "GO11")
    session.advance(0.1)
    session.ok("1FSHFD100")
    session.advance(1.0)
    return session


def test_slaves_of_each_other_run_into_the_position_error_limit() -> None:
    session = mutual("LH0,0", "SMPER4000,4000")
    assert session.axis_bit(23, 1) or session.axis_bit(23, 2)
    assert not session.signal("axis1.moving") and not session.signal("axis2.moving")
    session.ok("!K", "FOLMAS0,0", "DRIVE11", "D4000,4000", "MC00", "PSET0,0", "GO11")
    session.until_rest()
    session.until_rest(2)
    assert (session.position(), session.position(2)) == (4000, 4000)


def test_slaves_of_each_other_leave_a_unit_that_obeys() -> None:
    """Without any limit the positions leave what a unit can show; a kill and a RESET end that."""
    session = mutual("LH0,0", "SMPER0,0")
    session.ask("!K", wait_s=1.0)
    session.ask("RESET", wait_s=1.0)
    session.ok("DRIVE11", "SMPER0,0", "LH0,0", "PSET0,0", "COMEXC1", "A100,100", "D4000,4000", "GO11", wait_s=0.0)
    session.until_rest()
    assert session.position() == 4000

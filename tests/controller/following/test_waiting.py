"""COMEXC0: what a GO of a slave holds the command buffer for (assumed)."""

from __future__ import annotations

from tests.controller.following.rig import FollowingRig
from tests.controller.session import OK, both_on


def turn(rig: FollowingRig, updates: int, step: int = 50) -> None:
    for _ in rig.turn([step] * updates):
        pass


def test_a_continuous_go_holds_the_buffer_while_its_ratio_changes() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", COMEXC=0)
    turn(rig, 5)
    assert rig.ask("1GO1") == ""
    turn(rig, 15)
    assert rig.read() == ""
    turn(rig, 10)
    assert rig.read() == OK
    assert rig.following_bits()[:4] == "1001"


def test_with_the_master_at_rest_a_continuous_go_holds_nothing() -> None:
    """The commands that come next may be what starts the master."""
    session = both_on("1FOLMAS+24", "1FOLEN1", "1MC1", "1FOLMD1000")
    session.ask("1GO:2D4000:2GO", wait_s=3.0)
    assert session.position(2) == 4000
    assert session.position(1) == 3500


def test_a_master_that_stops_lets_the_buffer_go() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", COMEXC=0)
    turn(rig, 5)
    assert rig.ask("1GO1") == ""
    turn(rig, 5)
    turn(rig, 5, step=0)
    assert rig.read() == OK


def test_a_preset_go_holds_the_buffer_to_its_end() -> None:
    rig = FollowingRig("MC0", "FOLMD1000", "D400", COMEXC=0)
    assert rig.ask("1GO1") == ""
    rig.travel(500)
    assert rig.read() == ""
    rig.travel(600)
    assert rig.read() == OK
    assert rig.position() == 400


def test_the_end_of_a_continuous_move_in_a_program() -> None:
    """The constructed session as a stored program, in COMEXC0."""
    rig = FollowingRig("MC1", "FOLRN1", "FOLRD2", "FOLMD4000", COMEXC=0)
    rig.ask("DEF FOLLOW:FOLRN1:1GO1:WAIT(1PMAS>=14000):FOLRN0:1GO1:WAIT(1FS.1=b0):OUT1:END")
    rig.ask("FOLLOW")
    turn(rig, 2)
    rig.travel(13_000)
    assert rig.look("!1TFS.4") == "1"
    rig.travel(8000)
    assert rig.look("!1TFS.1") == "0"
    assert rig.signal("output.1")


def test_a_kill_ends_the_wait() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", COMEXC=0)
    turn(rig, 5)
    assert rig.ask("1GO1") == ""
    turn(rig, 5)
    assert rig.ask("!K", wait_s=0.5).count("> ") == 2
    rig.ok("D100")

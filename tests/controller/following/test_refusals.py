"""Following commands that a unit refuses: the text, nothing moves, and the next command works."""

from __future__ import annotations

import pytest

from tests.controller.following.rig import FollowingRig
from tests.controller.session import Session, both_on

INVALID_FOLMAS = "INVALID FOLMAS SPECIFIED"
NO_MASTER = "FOLMAS NOT SPECIFIED"
IN_FOLLOWING = "NOT VALID DURING FOLLOWING MOTION"
IN_RAMP = "NOT VALID DURING RAMP"
MOVING = "MOTION IN PROGRESS"


@pytest.mark.parametrize(
    "fields", ["+14", "+11", "-14", ",+24", ",-21", "+31", "+41,0", "+23", "+25", "+22", "5", "+121"]
)
def test_masters_an_axis_cannot_have(fields: str) -> None:
    session = both_on()
    assert session.error(f"FOLMAS{fields}") == INVALID_FOLMAS
    assert session.query("FOLMAS") == "FOLMAS+0,+0"
    session.ok("FOLMAS+21,+14")
    assert session.query("FOLMAS") == "FOLMAS+21,+14"


def test_a_field_left_out_stays() -> None:
    session = both_on("FOLMAS-21")
    session.ok("FOLMAS,+11")
    assert session.query("FOLMAS") == "FOLMAS-21,+11"
    session.ok("FOLMAS0")
    assert session.query("FOLMAS") == "FOLMAS+0,+11"


def test_a_line_with_one_bad_master_changes_nothing() -> None:
    session = both_on()
    assert session.error("FOLMAS+21,+24") == INVALID_FOLMAS
    assert session.query("FOLMAS") == "FOLMAS+0,+0"


def test_two_slaves_of_one_axis_count_the_same_source() -> None:
    """Axis 1 may follow its own encoder while the ANI input is its feedback."""
    session = Session("[options]\nani = true", SFB="2,1")
    session.ok("FOLMAS+11")
    assert session.error("FOLMAS,+14") == INVALID_FOLMAS
    session.ok("FOLMAS,+11")


def test_feedback_that_is_ones_own_master_is_refused() -> None:
    session = Session("[options]\nani = true", SFB="2,1")
    session.ok("FOLMAS+11")
    assert session.error("1SFB1") == "INVALID CONDITIONS FOR COMMAND"
    assert session.query("SFB") == "SFB2,1"
    session.ok("FOLMAS0", "1SFB1")


def test_a_slave_in_motion_keeps_its_master() -> None:
    session = both_on("COMEXC1", "D100000", "1GO")
    assert session.error("1FOLMAS+21") == MOVING
    session.ok("2FOLMAS+14")
    assert session.error("FOLMAS0") == MOVING


class TestFolen:
    def test_needs_a_master(self) -> None:
        session = both_on("FOLMAS+21")
        assert session.error("FOLEN11") == NO_MASTER
        assert session.query("FOLEN") == "FOLEN00"
        session.ok("FOLEN1")
        assert session.query("FOLEN") == "FOLEN10"
        assert session.query("1FOLEN") == "1FOLEN1"

    def test_ends_with_the_master(self) -> None:
        session = both_on("FOLMAS+21", "FOLEN1", "FOLMAS0")
        assert session.query("FOLEN") == "FOLEN00"

    def test_does_not_change_in_motion(self) -> None:
        session = both_on("COMEXC1", "FOLMAS+21", "D100000", "1GO")
        assert session.error("1FOLEN1") == MOVING
        rig = FollowingRig("MC1", "FOLMD100", "1GO1")
        assert rig.error("1FOLEN0") == IN_FOLLOWING
        rig.ok("1FOLEN1", "2FOLEN0")
        assert rig.travel(100) == 50

    @pytest.mark.parametrize("text", ["FOLEN2", "FOLEN111", "3FOLEN1"])
    def test_bad_masks(self, text: str) -> None:
        session = both_on("FOLMAS+21")
        session.error(text)
        assert session.query("FOLEN") == "FOLEN00"
        session.ok("FOLEN1")


class TestGo:
    @pytest.mark.parametrize(("commands", "refused"), [(("FOLRN128",), True), (("FOLRN127",), False)])
    def test_more_than_127_slave_counts_a_master_count(self, commands: tuple[str, ...], refused: bool) -> None:
        rig = FollowingRig("MC1", "FOLMD100", "SMPER0", *commands)
        if refused:
            assert rig.error("1GO1") == "INVALID RATIO"
        else:
            rig.ok("1GO1")
        assert rig.travel(100) == (0 if refused else 6350)

    def test_the_limit_is_that_of_scaled_counts(self) -> None:
        rig = FollowingRig("SCLD4000", "SCLMAS1000", "SCALE1", "MC1", "FOLRN32", "FOLMD1")
        assert rig.error("1GO1") == "INVALID RATIO"
        rig.ok("FOLRN31.75", "1GO1")

    @pytest.mark.parametrize(("distance", "folmd"), [(12_000, 10_000), (-12_000, 10_000), (1, 0), (10_001, 10_000)])
    def test_a_distance_that_is_too_long_for_its_master(self, distance: int, folmd: int) -> None:
        rig = FollowingRig("MC0", f"FOLMD{folmd}", f"D{distance}")
        assert rig.error("1GO1") == "MASTER SLAVE DISTANCE MISMATCH"
        assert rig.travel(2000) == 0
        assert rig.following_bits()[:4] == "0000"
        rig.ok("FOLMD20000", "1GO1")
        assert rig.travel(21_000) == distance

    def test_nothing_starts_on_any_axis_if_one_is_refused(self) -> None:
        rig = FollowingRig("2DRIVE1", "2D4000", "1MC0", "1D4000", "1FOLMD10")
        assert rig.error("GO11") == "MASTER SLAVE DISTANCE MISMATCH"
        rig.advance(0.5)
        assert rig.position(2) == 0

    def test_during_a_ramp(self) -> None:
        rig = FollowingRig("MC1", "FOLMD1000", "1GO1")
        assert rig.error("1GO1") == IN_RAMP
        rig.travel(500)
        assert rig.error("1GO1") == IN_RAMP
        assert rig.error("!1GO1") == IN_RAMP
        assert rig.travel(500) == 500
        rig.ok("FOLRN2", "1GO1")
        assert rig.travel(1000) == 2000

    def test_during_a_preset_move(self) -> None:
        rig = FollowingRig("MC0", "FOLMD1000", "D900", "1GO1")
        assert rig.error("1GO1") == IN_FOLLOWING
        rig.travel(10)
        assert rig.error("1GO1") == IN_RAMP
        rig.travel(490)
        assert rig.error("1GO1") == IN_FOLLOWING
        assert rig.travel(500) == 900
        rig.ok("1GO1")
        assert rig.travel(1000) == 1800

    def test_a_preset_move_of_a_slave_at_ratio(self) -> None:
        rig = FollowingRig("MC1", "FOLMD0", "1GO1")
        rig.travel(100)
        rig.ok("MC0", "D100", "FOLMD1000")
        assert rig.error("1GO1") == IN_FOLLOWING
        assert rig.travel(100) == 200

    def test_with_the_drive_off(self) -> None:
        rig = FollowingRig("MC1", "FOLMD0", "1DRIVE0")
        assert rig.error("1GO1") == "DRIVE SHUTDOWN"
        rig.ok("1DRIVE1", "1GO1")

    def test_while_it_brakes_from_something_else(self) -> None:
        rig = FollowingRig("1FOLEN0", "1V5", "1A5", "1AD5", "1MC1", "1GO")
        rig.advance(2.0)
        rig.ok("!1S")
        assert rig.error("1FOLEN1") == MOVING
        rig.until_rest()
        rig.ok("1FOLEN1", "1FOLMD100", "1GO")


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("FOLRD0", "INVALID DATA-FIELD 1"),
        ("FOLRN-1", "INVALID DATA-FIELD 1"),
        ("FOLRN1000000000", "INVALID DATA-FIELD 1"),
        ("FOLMD,-1", "INVALID DATA-FIELD 2"),
        ("FFILT5", "INVALID DATA-FIELD 1"),
        ("FMCLEN-1", "INVALID DATA-FIELD 1"),
        ("FSHFC4", "INVALID DATA-FIELD 1"),
        ("FSHFC", "INCORRECT DATA"),
        ("FSHFD", "INCORRECT DATA"),
        ("FGADV", "INCORRECT DATA"),
        ("FMCNEW", "INCORRECT DATA"),
        ("FMCNEW01", NO_MASTER),
        ("2FSHFD100", "DRIVE SHUTDOWN"),
        ("1FGADV100", "INVALID CONDITIONS FOR COMMAND"),
        ("3FSHFD100", "INCORRECT AXIS"),
        ("FSHFD,,1", "INCORRECT AXIS"),
    ],
)
def test_bad_fields_change_nothing(text: str, error: str) -> None:
    rig = FollowingRig("MC1", "FOLMD0")
    assert rig.error(text) == error
    rig.ok("1GO1")
    assert rig.travel(500) == 500
    assert rig.error_bit(16) is False


class TestShifts:
    def test_without_following(self) -> None:
        session = both_on()
        for text in ("1FSHFD100", "1FSHFC1"):
            assert session.error(text) == "INVALID CONDITIONS FOR COMMAND"
        session.ok("1FSHFC0", "1FSHFC3", "D100", wait_s=0.1)

    def test_during_a_ramp(self) -> None:
        rig = FollowingRig("MC1", "FOLMD1000", "1GO1")
        rig.travel(500)
        assert not rig.following_bit(9)
        for text in ("1FSHFD100", "1FSHFC1", "1FGADV100"):
            assert rig.error(text) == IN_RAMP
        assert rig.travel(500) == 500
        assert rig.following_bit(9)

    def test_during_a_preset_move(self) -> None:
        rig = FollowingRig("MC0", "FOLMD1000", "D900", "1GO1")
        rig.travel(500)
        assert not rig.following_bit(9)
        for text in ("1FSHFD100", "1FSHFC1", "1FGADV100"):
            assert rig.error(text) == IN_FOLLOWING
        assert rig.travel(500) == 900

    def test_during_a_preset_shift(self) -> None:
        rig = FollowingRig("MC1", "FOLMD0", "1GO1")
        rig.travel(0)
        rig.ok("1FSHFD4000")
        rig.advance(0.1)
        assert not rig.following_bit(9)
        for text in ("1FSHFD100", "1FSHFC1", "1FGADV100", "1GO1"):
            assert rig.error(text) == IN_FOLLOWING
        rig.advance(3.0)
        assert rig.position() == 4000

    def test_an_s_curve_that_is_none(self) -> None:
        rig = FollowingRig("A10", "AA2")
        assert rig.error("1FSHFD100") == "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"
        rig.ok("AA0", "1FSHFD100")


def test_a_geared_advance_that_is_too_long() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "1GO1", "FOLMD100")
    rig.travel(100)
    assert rig.error("1FGADV101") == "MASTER SLAVE DISTANCE MISMATCH"
    assert rig.travel(100) == 200

"""Master cycles: position and number, restarts, and what WAIT and IF make of them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.controller.variables.operands import Operands
from tests.controller.following.rig import FollowingRig
from tests.controller.session import OK


def cycle(rig: FollowingRig) -> tuple[int, int]:
    """Position in the cycle and its number."""
    position, number = rig.look("1TPMAS").removeprefix("1TPMAS"), rig.look("1TNMCY").removeprefix("1TNMCY")
    return int(position), int(number)


def test_position_and_number_are_minutes_and_hours() -> None:
    rig = FollowingRig("FMCLEN60")
    for travel, expected in [(59, (59, 0)), (1, (0, 1)), (150, (30, 3))]:
        rig.travel(travel, step=7)
        assert cycle(rig) == expected
    assert rig.following_bits()[13:16] == "101"


def test_a_master_that_backs_up_counts_below_zero() -> None:
    rig = FollowingRig("FMCLEN60")
    rig.travel(-25)
    assert cycle(rig) == (-25, 0)
    assert rig.following_bit(15)
    rig.travel(90)
    assert cycle(rig) == (5, 1)


@settings(deadline=None, max_examples=20)
@given(length=st.integers(1, 400), steps=st.lists(st.integers(0, 900), min_size=1, max_size=12))
def test_forwards_nothing_is_lost_at_a_rollover(length: int, steps: list[int]) -> None:
    rig = FollowingRig(f"FMCLEN{length}")
    for _ in rig.turn([*steps, 0]):
        pass
    assert cycle(rig) == divmod(sum(steps), length)[::-1]


def test_without_a_length_the_cycle_is_endless() -> None:
    rig = FollowingRig()
    rig.travel(2_000_000, step=100_000)
    assert cycle(rig) == (2_000_000, 0)
    assert rig.following_bits()[12:16] == "0000"


def test_fmcnew_restarts_at_fmcp() -> None:
    rig = FollowingRig("FMCLEN1000", "FMCP-250")
    rig.travel(3100)
    rig.ok("1FMCNEW1")
    assert cycle(rig) == (-250, 0)
    rig.travel(300)
    assert cycle(rig) == (50, 0), "a negative FMCP delays cycle 0"
    rig.ok("FMCNEW0", "FMCNEWX")
    assert cycle(rig) == (50, 0)


def test_a_new_assignment_starts_counting_anew() -> None:
    rig = FollowingRig("FMCP40")
    rig.travel(100)
    rig.ok("1FOLMAS+21")
    assert cycle(rig) == (40, 0)


def test_scaled_by_sclmas() -> None:
    rig = FollowingRig("SCLMAS800", "SCALE1", "FMCLEN2.5")
    rig.travel(3000)
    assert rig.look("1TPMAS") == "1TPMAS+1.25"
    rig.ok("VAR1=1PMAS", "VAR2=1NMCY")
    assert (rig.look("VAR1"), rig.look("VAR2")) == ("VAR1=+1.25", "VAR2=+1.0")


def test_the_master_velocity_of_the_guide() -> None:
    """IF(VMAS>4.3) in user units, VAR14=VMAS."""
    rig = FollowingRig("SCLMAS4000", "SCALE1", "VAR14=0")
    for _ in rig.turn([50] * 10):
        pass
    rig.ask("IF(VMAS>4.3):VAR14=VMAS:NIF")
    for _ in rig.turn([50] * 2):
        pass
    assert rig.look("VAR14") == "VAR14=+5.58"


class TestWait:
    def test_a_position_of_this_cycle(self) -> None:
        rig = FollowingRig("FMCLEN1000")
        rig.travel(200)
        assert rig.ask("WAIT(1PMAS>=700)") == ""
        rig.travel(499)
        assert rig.read() == ""
        rig.travel(1)
        assert rig.read() == OK

    def test_one_cycle_length_more_is_the_next_cycle(self) -> None:
        """6000 Programmer's Guide p.223: add one FMCLEN."""
        rig = FollowingRig("FMCLEN1000")
        rig.travel(2600)
        assert rig.ask("WAIT(1PMAS>=1200)") == ""
        rig.travel(500)
        assert rig.read() == ""
        assert rig.look("!1TPMAS") == "1TPMAS+100"
        rig.travel(100)
        assert rig.read() == OK

    def test_the_end_of_the_cycle_is_never_missed(self) -> None:
        rig = FollowingRig("FMCLEN1000")
        rig.travel(990)
        assert rig.ask("WAIT(1PMAS>=1000)") == ""
        rig.travel(37, step=37)
        assert rig.read() == OK
        assert cycle(rig) == (27, 1)

    def test_a_position_that_is_past_is_true_at_once(self) -> None:
        rig = FollowingRig("FMCLEN1000")
        rig.travel(800)
        rig.ok("WAIT(1PMAS>700)")

    def test_a_restart_meanwhile_counts_from_there(self) -> None:
        rig = FollowingRig("FMCLEN1000")
        rig.travel(2800)
        assert rig.ask("WAIT(1PMAS>=900)") == ""
        rig.ok("!1FMCNEW1")
        rig.travel(200)
        assert rig.read() == ""
        rig.travel(700)
        assert rig.read() == OK

    def test_if_looks_at_the_position_there_is(self) -> None:
        rig = FollowingRig("FMCLEN1000", "VAR1=0")
        rig.travel(1200)
        rig.ask("IF(1PMAS>1000):VAR1=1:NIF", wait_s=0.1)
        rig.ask("IF(1PMAS<300):VAR1=VAR1+2:NIF", wait_s=0.1)
        assert rig.look("VAR1") == "VAR1=+2.0"

    @pytest.mark.parametrize(
        "condition", ["1PMAS>=50000", "1FS.4=b0", "1NMCY>=50", "1VMAS>90000", "1PSLV>50000", "1PSHF>10", "1FS.2=b1"]
    )
    def test_nobody_looks_while_nothing_happens(self, condition: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """The servo watches: Python looks at a condition some times, not at every system update."""
        rig = FollowingRig("FMCLEN1000", "MC1", "2DRIVE1", "2V5", "2A100", "2MC1")
        rig.ok("1FOLEN0", "1FOLMAS+24", "1FOLEN1", "1FOLMD0", "GO11")
        rig.advance(0.5)
        looks = 0
        arm_watches = Operands.arm_watches

        def counting(*arguments: object) -> None:
            nonlocal looks
            looks += 1
            arm_watches(*arguments)  # type: ignore[arg-type]

        monkeypatch.setattr(Operands, "arm_watches", counting)
        assert rig.ask(f"WAIT({condition})") == ""
        rig.advance(0.8)
        assert rig.read() == ""
        assert looks <= 3, "in 350 system updates"


def test_status_bits_wake_a_wait() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", "1GO1")
    assert rig.ask("WAIT(1FS.4=b1)") == ""
    rig.travel(800)
    assert rig.read() == ""
    rig.travel(300)
    assert rig.read() == OK


def test_a_wait_for_leave_to_shift_is_woken() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", "1GO1")
    rig.travel(10)
    assert rig.ask("WAIT(1FS.9=b1)") == ""
    rig.travel(1100)
    assert rig.read() == OK
    rig.ok("1FGADV1000")
    assert rig.ask("WAIT(1FS.24=b0)") == ""
    rig.travel(500)
    assert rig.read() == ""
    rig.travel(600)
    assert rig.read() == OK


def test_the_word_is_an_operand() -> None:
    rig = FollowingRig()
    rig.ok("VARB1=1FS", "VARB2=2FS")
    assert rig.look("VARB1") == "VARB1=0000_1100_1000_0000_1000_0000_0000_0000"
    assert rig.look("VARB2") == "VARB2=0000_0000_0000_0000_0000_0000_0000_0000"

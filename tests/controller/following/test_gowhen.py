"""GOWHEN and TRGFN on a slave: moves that begin at a place of the master, not at an update of the unit."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.following.rig import FollowingRig
from tests.controller.following.test_programs import CYCLES, MASTER_COUNTS_S, conveyor, run, store, variable
from tests.controller.session import OK, S

PENDING = 26


@settings(deadline=None, max_examples=25)
@given(place=st.integers(100, 3000), step=st.integers(1, 97), sign=st.sampled_from("+-"))
def test_a_continuous_move_begins_exactly_at_its_place(place: int, step: int, sign: str) -> None:
    """Whatever the master makes in a system update: the slave has gone half of FOLMD 1000 and then all of the rest."""
    rig = FollowingRig("MC1", "FOLMD1000", f"D{sign}", f"GOWHEN(PMAS>={place})", "1GO1")
    assert rig.axis_bit(PENDING)
    position = rig.travel(place + 2000, step=step)
    assert position == (1500 if sign == "+" else -1500)
    assert not rig.axis_bit(PENDING)


@pytest.mark.parametrize("sign", [">", ">=", "="])
def test_a_preset_move_begins_exactly_at_its_place(sign: str) -> None:
    rig = FollowingRig("MC0", "FOLMD1000", "D900", f"GOWHEN(PMAS{sign}777)", "1GO1")
    assert rig.travel(600) == 0
    assert rig.following_bits()[0] == "0"
    assert rig.travel(177 + 500) == pytest.approx(450, abs=int(sign == ">"))
    assert rig.travel(500) == 900


def test_the_ratio_is_kept_until_the_place_of_its_change() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "1GO1")
    rig.travel(100)
    rig.ok("FOLRN3", "FOLMD1000", "GOWHEN(PMAS>=1100)", "1GO1")
    assert rig.travel(1000) == 1100
    assert rig.travel(1000) == 1100 + 2000
    assert rig.travel(100) == 3100 + 300


def test_one_cycle_length_more_is_the_next_cycle() -> None:
    rig = FollowingRig("FMCLEN1000", "MC0", "FOLMD500", "D500", "FOLRN1")
    rig.travel(600)
    rig.ok("GOWHEN(PMAS>=1200)", "1GO1")
    assert rig.travel(400 + 200) == 0
    assert rig.travel(500) == 500


def test_a_place_that_is_past_starts_at_once_and_is_told() -> None:
    """ER bit 14 (assumed)."""
    rig = FollowingRig("ERROR.14-1", "MC0", "FOLMD500", "D500")
    rig.travel(600)
    rig.ok("GOWHEN(PMAS>=500)", "1GO1")
    assert rig.travel(500) == 500
    assert rig.error_bit(14)


@pytest.mark.parametrize("command", ["!1S", "!1K", "!1DRIVE0"])
def test_a_move_that_waits_is_given_up(command: str) -> None:
    rig = FollowingRig("MC0", "FOLMD500", "D500", "GOWHEN(PMAS>=1000)", "1GO1")
    rig.ok(command)
    assert not rig.axis_bit(PENDING)
    assert rig.travel(3000) == 0


def test_another_go_takes_the_place_of_one_that_waits() -> None:
    rig = FollowingRig("MC0", "FOLMD500", "D500", "GOWHEN(PMAS>=1000)", "1GO1", "D-400", "1GO1")
    assert not rig.axis_bit(PENDING)
    assert rig.travel(500) == -400
    assert rig.travel(3000) == -400


def test_with_comexc0_the_go_holds_the_buffer_and_gowhen_does_not() -> None:
    rig = FollowingRig("MC0", "FOLMD500", "D500", "GOWHEN(PMAS>=1000)", COMEXC=0)
    assert rig.ask("1GO1") == ""
    rig.travel(1200)
    assert rig.read() == ""
    rig.travel(400)
    assert rig.read() == OK
    assert rig.position() == 500


def test_a_shift_waits_for_its_place() -> None:
    rig = FollowingRig("MC1", "FOLMD0", "1GO1")
    rig.travel(100)
    rig.ok("GOWHEN(PMAS>=1000)", "1FSHFD300")
    rig.advance(0.5)
    assert rig.axis_bit(PENDING)
    assert rig.travel(500) == 600
    rig.travel(500)
    rig.advance(1.0)
    assert rig.position() == 1400


def test_another_axis_may_wait_for_the_master_of_a_slave() -> None:
    rig = FollowingRig("2DRIVE1", "2D-200", "GOWHEN,(1PMAS>=500)")
    rig.unit.do("release_encoder", axis=2)
    rig.ok("2GO")
    assert rig.axis_bit(PENDING, 2)
    assert rig.axis_bit(PENDING, 1) is False


class TestTriggers:
    def test_a_trigger_restarts_the_master_cycle_where_it_came(self) -> None:
        rig = FollowingRig("INFEN1", "INFNC25-H", "FMCLEN10000", "FMCP-50", "1TRGFNAX1")
        assert rig.following_bit(13)
        rig.travel(1000)
        rig.unit.do("set_wire", name="trigger.a", closed=True)
        rig.travel(300)
        assert not rig.following_bit(13)
        assert int(rig.look("1TPMAS").removeprefix("1TPMAS")) == pytest.approx(250, abs=51)

    def test_a_trigger_between_samples_is_exact(self) -> None:
        """The master turns at 25000 counts/s; the trigger comes 1.3 ms after an update."""
        rig = FollowingRig("INFEN1", "INFNC25-H", "1TRGFNAX1")
        rig.unit.do("drive_encoder", axis=2, velocity=25_000.0, ramp=0.0)
        rig.advance(0.1013)
        edge_ns = rig.now_ns
        rig.unit.do("set_wire", name="trigger.a", closed=True)
        rig.advance(0.05)
        position = int(rig.look("1TPMAS").removeprefix("1TPMAS"))
        updated_ns = rig.unit.controller.engine.next_system_update_ns - rig.update_ns
        assert position == pytest.approx(25_000 * (updated_ns - edge_ns) / S, abs=1)
        assert not rig.following_bit(13)

    def test_a_trigger_lets_a_slave_go(self) -> None:
        rig = FollowingRig("INFEN1", "INFNC25-H", "1TRGFNA1X", "MC0", "FOLMD500", "D500", "1GO1")
        assert rig.travel(2000) == 0
        rig.unit.do("set_wire", name="trigger.a", closed=True)
        rig.advance(0.1)
        assert rig.travel(600) == 500


CUT_LENGTH = 10_000

CUT_TO_LENGTH = f"""
DEF CUT
L{CYCLES}
1MC1:1FOLRN1:1FOLMD1000:1D+
1GOWHEN(1PMAS>={CUT_LENGTH})
1GO1
WAIT(1FS.4=b1)
OUT1
VAR1=1PSLV-1PMAS
IF(VAR1<VAR2):VAR2=VAR1:NIF
IF(VAR1>VAR3):VAR3=VAR1:NIF
1FOLRN0
1GOWHEN(1PMAS>=4000)
1GO1
WAIT(1FS.1=b0)
OUT0
IF(1PSLV<>4000):VAR6=VAR6+1:NIF
1MC0:1MA1:1D0:1FOLRN4:1FOLMD3000:1GO1
WAIT(1FS.1=b0)
IF(1PSLV<>0):VAR6=VAR6+1:NIF
VAR5=VAR5+1
LN
END
"""
"""With GOWHEN the ratio ramps lie exactly where they belong: each cut ends at 4000 and each return at 0."""


def test_cut_to_length_with_gowhen_hits_every_count() -> None:
    session = conveyor(f"FMCLEN{CUT_LENGTH}", "VAR2=999999", "VAR3=-999999", "VAR5=0", "VAR6=0")
    store(session, CUT_TO_LENGTH)
    run(session, "CUT", seconds=(CYCLES + 2) * CUT_LENGTH / MASTER_COUNTS_S)
    assert variable(session, 5) == CYCLES
    assert variable(session, 6) == 0, "no cut and no return misses its count"
    assert session.position() == 0
    assert variable(session, 3) - variable(session, 2) <= 4, "a count of the master, predicted either way"


CYCLIC = f"""
DEF INDEX
L{CYCLES}
1GOWHEN(1PMAS>=4500)
1GO1
WAIT(1AS.26=b0)
VAR1=1PMAS
WAIT(1FS.1=b0)
LN
END
"""


def test_an_index_a_cycle_with_gowhen() -> None:
    session = conveyor("FMCLEN4000", "1MC0", "1D1333", "1FOLRN3", "1FOLMD2900")
    store(session, CYCLIC)
    run(session, "INDEX", seconds=(CYCLES + 2) * 4000 / MASTER_COUNTS_S)
    assert session.position() == CYCLES * 1333


@pytest.mark.parametrize(
    ("start", "spoil"),
    [("1FSHFD100", ("AA1", "A100")), ("1GO1", ("FOLMD1",)), ("1GO1", ("FOLRN128",)), ("1FSHFC1", ("AA1", "A100"))],
)
def test_what_is_no_longer_legal_when_its_time_comes_does_not_start(start: str, spoil: tuple[str, ...]) -> None:
    """An input lets go what the settings no longer make; the unit goes on."""
    rig = FollowingRig("MC0", "FOLMD1000", "D900", "INFEN1", "GOWHEN(IN.1=b1)", start)
    assert rig.axis_bit(PENDING)
    rig.ok(*spoil)
    rig.set_wire("input.1", closed=True)
    assert rig.travel(2000) == 0
    rig.ok("AA0", "FOLRN1", "FOLMD1000", "1GO1")
    assert rig.travel(1000) == 900


def test_a_move_in_time_that_is_no_s_curve_when_its_time_comes_does_not_start() -> None:
    rig = FollowingRig("1FOLEN0", "INFEN1", "D500", "GOWHEN(IN.1=b1)", "1GO1", "A100", "AA1")
    rig.set_wire("input.1", closed=True)
    rig.advance(0.5)
    assert rig.position() == 0
    rig.ok("AA0", "1GO1")
    rig.advance(1.0)
    assert rig.position() == 500


@pytest.mark.parametrize("master_distance", [0, 1000])
def test_a_ratio_can_end_where_the_master_comes_to(master_distance: int) -> None:
    """FOLRN0 held by GOWHEN: the slave keeps its ratio until there, then comes to rest over FOLMD."""
    rig = FollowingRig("SMPER0", "MC1", "FOLRN2", "FOLMD0", "1FPPEN0", "1GO1")
    assert rig.travel(500) == 1000
    rig.ok("FOLRN0", f"FOLMD{master_distance}", "1GOWHEN(1PMAS>=1500)", "1GO1")
    assert rig.travel(900) == 2800
    assert rig.travel(2000) == 3000 + master_distance
    assert not rig.following_bit(1)

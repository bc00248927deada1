"""End-of-travel limits, ENABLE and drive faults: what refuses to start, what stops, what puts it right again."""

from __future__ import annotations

import pytest

from tests.controller.session import OK, SYSTEM_NS, S, Session

COUNTS_PER_REV = 4000
BARE = "bare = true"


def mover(*commands: str, machine: str = "") -> Session:
    session = Session(machine)
    session.ok("DRIVE10", "ERROR111111111111", *commands)
    return session


def running(*commands: str, velocity: float = 2.0) -> Session:
    """Axis 1 in continuous motion, positive, with COMEXC1."""
    session = mover("MC1", "COMEXC1", "A20", f"V{velocity}", "LHAD40", "LSAD25", *commands, "GO1")
    session.advance(0.5)
    return session


class TestHardLimitBeforeTheMove:
    @pytest.mark.parametrize(("wire", "distance", "bit"), [("positive", 4000, 15), ("negative", -4000, 16)])
    def test_go_into_it(self, wire: str, distance: int, bit: int) -> None:
        session = mover(f"D{distance}")
        session.set_wire(f"axis1.{wire}_limit", closed=False)
        assert session.ask("GO1", wait_s=0.1) == OK, "no error text"
        assert session.position() == 0
        assert session.number("axis1.velocity.commanded") == 0
        assert session.axis_bit(bit)
        assert not session.axis_bit(31 - bit)
        assert session.error_bit(2)

    def test_away_from_it_moves_and_clears(self) -> None:
        session = mover()
        session.set_wire("axis1.positive_limit", closed=False)
        session.ok("GO1", wait_s=0.1)
        session.ok("D-", "GO1", wait_s=1.5)
        assert session.position() == -4000
        assert not session.axis_bit(15)
        assert not session.error_bit(2)

    def test_absolute_target_on_the_other_side(self) -> None:
        """What counts is the way to go, not the sign of D."""
        session = mover("PSET10000", "MA1", "D4000")
        session.set_wire("axis1.positive_limit", closed=False)
        session.ok("GO1", wait_s=2.5)
        assert session.position() == 4000

    @pytest.mark.parametrize(
        ("code", "positive_moves", "negative_moves"),
        [(0, True, True), (1, True, False), (2, False, True), (3, False, False)],
    )
    def test_lh_codes(self, code: int, positive_moves: bool, negative_moves: bool) -> None:
        """0 none, 1 positive direction disabled, 2 negative direction disabled, 3 both enabled (language 8.1)."""
        for distance, moves in ((4000, positive_moves), (-4000, negative_moves)):
            session = mover(f"LH{code}", f"D{distance}")
            session.set_wire("axis1.positive_limit", closed=False)
            session.set_wire("axis1.negative_limit", closed=False)
            session.ask("GO1", wait_s=1.5)
            assert (session.position() == distance) is moves

    def test_lh0_clears(self) -> None:
        session = mover()
        session.set_wire("axis1.positive_limit", closed=False)
        session.ok("GO1", wait_s=0.1)
        session.ok("LH0")
        assert not session.axis_bit(15)
        assert not session.error_bit(2)
        session.ok("GO1", wait_s=1.5)
        assert session.position() == 4000

    def test_active_level(self) -> None:
        """LHLVL1: a grounded input is the limit; TLIM stays electrical."""
        session = mover("LHLVL1000")
        assert session.query("TLIM") == "TLIM110_110"
        session.ok("GO1", wait_s=0.1)
        assert session.position() == 0
        assert session.axis_bit(15)
        session.ok("D-", "GO1", wait_s=1.5)
        assert session.position() == -4000
        session.set_wire("axis1.positive_limit", closed=False)
        session.ok("D+", "GO1", wait_s=1.5)
        assert session.position() == 0

    def test_only_that_axis(self) -> None:
        session = Session()
        session.ok("DRIVE11")
        session.set_wire("axis2.positive_limit", closed=False)
        session.ok("GO11", wait_s=1.5)
        assert (session.position(1), session.position(2)) == (4000, 0)


class TestHardLimitInMotion:
    def test_decelerates_at_lhad(self) -> None:
        session = running()
        before, opened_ns = session.position(), session.now_ns
        session.unit.do("set_wire", name="axis1.positive_limit", closed=False)
        session.until_rest(timeout_s=1)
        braking_s = 2 / 40
        assert 0 <= session.now_ns - opened_ns - braking_s * S <= 3 * SYSTEM_NS
        braking_counts = 2**2 / (2 * 40) * COUNTS_PER_REV
        seen_late_counts = 2 * COUNTS_PER_REV * 2 * SYSTEM_NS / S
        assert braking_counts - 1 <= session.position() - before <= braking_counts + seen_late_counts
        assert session.axis_bit(15)
        assert session.error_bit(2)
        assert session.query("DRIVE") == "DRIVE10", "the drive holds"

    def test_the_other_end_is_not_in_the_way(self) -> None:
        session = running()
        session.set_wire("axis1.negative_limit", closed=False)
        session.advance(0.5)
        assert session.axis_bit(1)
        assert not session.axis_bit(16)

    def test_lh0_does_not_see_it(self) -> None:
        session = running("LH0")
        session.set_wire("axis1.positive_limit", closed=False)
        session.advance(0.5)
        assert session.axis_bit(1)

    @pytest.mark.parametrize(("comexl", "goes_on"), [("COMEXL0", False), ("COMEXL1", True), ("COMEXL01", False)])
    def test_comexl(self, comexl: str, goes_on: bool) -> None:
        """COMEXL0 ends the program and clears the buffer, COMEXL1 of that axis keeps both."""
        session = mover("V2", "A20", "D80000", comexl)
        session.ask("GO1")
        session.ask("A77")
        session.advance(0.5)
        session.set_wire("axis1.positive_limit", closed=False)
        session.advance(0.5)
        session.read()
        assert session.query("1A") == ("1A77.0000" if goes_on else "1A20.0000")

    @pytest.mark.parametrize(("comexl", "goes_on"), [("COMEXL0", False), ("COMEXL1", True)])
    def test_comexl_and_programs(self, comexl: str, goes_on: bool) -> None:
        session = mover("V2", "A20", "D80000", comexl)
        session.ask("DEF P:GO1:A77:END")
        session.read()
        session.ask("RUN P", wait_s=0.5)
        session.set_wire("axis1.positive_limit", closed=False)
        session.advance(0.5)
        assert not session.system_bit(3)
        session.read()
        assert session.query("1A") == ("1A77.0000" if goes_on else "1A20.0000")

    def test_closing_it_again_does_not_resume(self) -> None:
        session = running()
        session.set_wire("axis1.positive_limit", closed=False)
        session.advance(0.5)
        session.set_wire("axis1.positive_limit", closed=True)
        session.advance(0.5)
        assert not session.axis_bit(1)
        assert session.axis_bit(15), "latched until the next legal GO"
        session.ok("GO1")
        assert not session.axis_bit(15)


class TestSoftLimits:
    def test_stops_at_lsad(self) -> None:
        session = running("LSPOS8000", "LSNEG-8000", "LS3")
        assert session.emulator.run_until(lambda: session.position() >= 8000, timeout_s=5)
        session.until_rest(timeout_s=1)
        braking_counts = 2**2 / (2 * 25) * COUNTS_PER_REV
        assert (
            braking_counts - 1 <= session.position() - 8000 <= braking_counts + 2 * COUNTS_PER_REV * 2 * SYSTEM_NS / S
        )
        assert session.axis_bit(17)
        assert not session.axis_bit(15)
        assert session.error_bit(3)
        assert not session.error_bit(2)

    def test_go_into_it_and_away(self) -> None:
        session = mover("LSPOS0", "LSNEG-8000", "LS3", "D1000")
        session.ok("GO1", wait_s=0.1)
        assert session.position() == 0
        assert session.axis_bit(17)
        assert session.error_bit(3)
        session.ok("D-", "GO1", wait_s=1)
        assert session.position() == -1000
        assert not session.axis_bit(17)
        assert not session.error_bit(3)

    def test_off_by_default_and_with_equal_positions(self) -> None:
        for commands in (("LSPOS100", "LSNEG-100"), ("LS3",)):
            session = mover(*commands)
            session.ok("GO1", wait_s=1.5)
            assert session.position() == 4000

    @pytest.mark.parametrize(("code", "stops"), [(0, False), (1, False), (2, True), (3, True)])
    def test_codes(self, code: int, stops: bool) -> None:
        session = mover("LSPOS0", "LSNEG-8000", f"LS{code}")
        session.ask("GO1", wait_s=1.5)
        assert (session.position() == 0) is stops

    def test_ls0_clears(self) -> None:
        session = mover("LSPOS0", "LSNEG-8000", "LS3")
        session.ok("GO1", wait_s=0.1)
        session.ok("LS0")
        assert not session.axis_bit(17)
        assert not session.error_bit(3)

    def test_old_names(self) -> None:
        session = Session()
        session.ok("LSCW500,600", "LSCCW-500,-600")
        assert session.query("LSPOS") == "LSPOS+500,+600"
        assert session.query("LSNEG") == "LSNEG-500,-600"

    def test_in_user_units(self) -> None:
        session = mover("SCALE1", "SCLD4000", "LSPOS2.5", "LSNEG-2.5", "LS3", "V2", "SCLV4000", "MC1", "COMEXC1", "GO1")
        session.until_rest(timeout_s=5)
        assert session.axis_bit(17)
        assert session.number("axis1.position.commanded") >= 10000


class TestBareUnit:
    def test_refuses_to_move(self) -> None:
        session = Session(BARE)
        assert session.query("TLIM") == "TLIM000_000"
        assert session.query("TINO") == "TINO0000_0000"
        assert session.error("DRIVE11") == "WARNING: ENABLE INPUT INACTIVE"
        assert session.error("GO1") == "WARNING: ENABLE INPUT INACTIVE"
        assert session.query("DRIVE") == "DRIVE00"

    def test_wired_step_by_step(self) -> None:
        session = Session(BARE)
        session.set_wire("enable", closed=True)
        session.ok("@DRIVE1")
        session.ok("GO1", wait_s=0.1)
        assert session.axis_bit(15)
        session.ok("LH0,0")
        session.ok("GO1", wait_s=1.5)
        assert session.position() == 4000


class TestEnable:
    def test_opens_in_motion(self) -> None:
        session = running()
        session.set_wire("enable", closed=False)
        assert session.query("DRIVE") == "DRIVE00"
        assert session.axis_bit(13)
        assert session.axis_bit(13, axis=2)
        assert not session.axis_bit(1)
        assert session.error_bit(9)
        assert session.query("TINO") == "TINO0000_0000"
        for command in ("DRIVE1", "@DRIVE1", "GO1", "GO"):
            assert session.error(command) == "WARNING: ENABLE INPUT INACTIVE"

    def test_recovery(self) -> None:
        session = running()
        session.set_wire("enable", closed=False)
        session.advance(1.0)
        session.set_wire("enable", closed=True)
        assert session.query("TINO") == "TINO0000_0100"
        assert session.query("DRIVE") == "DRIVE00", "it stays off until told"
        assert session.error_bit(9), "released, but DRIVE1 is still to come"
        session.ok("@DRIVE1")
        assert not session.error_bit(9)
        assert not session.axis_bit(13)
        session.ok("MC0", "COMEXC0", "D1000")
        before = session.position()
        session.ok("GO1", wait_s=1)
        assert session.position() - before == 1000

    def test_ends_program_and_buffer(self) -> None:
        session = mover("D80000")
        session.ask("DEF P:GO1:A77:END")
        session.read()
        session.ask("RUN P", wait_s=0.5)
        session.ask("V7")
        session.set_wire("enable", closed=False)
        session.advance(0.1)
        assert not session.system_bit(3)
        session.read()
        assert session.query("1A") == "1A10.0000"
        assert session.query("1V") == "1V1.0000"

    def test_whatever_kdrive_says(self) -> None:
        session = running("KDRIVE0")
        session.set_wire("enable", closed=False)
        assert session.query("DRIVE") == "DRIVE00"

    def test_other_wires_do_not_count_while_it_is_open(self) -> None:
        """Only the opening ends what waits: a unit without ENABLE still runs its dwells and programs."""
        session = Session(BARE)
        session.ask("T1:V7")
        session.advance(0.5)
        session.set_wire("axis1.home", closed=True)
        session.advance(0.6)
        session.read()
        assert session.query("1V") == "1V7.0000"


class TestDriveFault:
    """Watched only with INFEN1; DRFLVL0: active low (settled, section 4)."""

    def test_shuts_the_drive_down(self) -> None:
        session = running("INFEN1")
        session.set_wire("axis1.drive_fault", closed=True)
        assert session.axis_bit(14)
        assert session.axis_bit(13)
        assert not session.axis_bit(1)
        assert session.error_bit(4)
        assert session.query("DRIVE") == "DRIVE00"

    def test_not_watched_without_infen(self) -> None:
        session = running()
        session.set_wire("axis1.drive_fault", closed=True)
        assert session.axis_bit(1)
        assert not session.axis_bit(14)

    def test_other_axis_goes_on(self) -> None:
        session = running("INFEN1")
        session.set_wire("axis2.drive_fault", closed=True)
        assert session.axis_bit(1)
        assert session.axis_bit(14, axis=2)

    def test_active_high(self) -> None:
        session = mover("DRFLVL1")
        session.set_wire("axis1.drive_fault", closed=True)
        session.ok("INFEN1")
        session.advance(0.01)
        assert not session.axis_bit(14)
        session.set_wire("axis1.drive_fault", closed=False)
        assert session.axis_bit(14)

    def test_infen_finds_a_fault_that_is_already_there(self) -> None:
        """The field problem of the 6250 guide: the program stops at INFEN1."""
        session = mover()
        session.set_wire("axis1.drive_fault", closed=True)
        session.ask("DEF P:INFEN1:A77:END")
        session.read()
        session.ask("RUN P", wait_s=0.1)
        assert session.axis_bit(14)
        assert session.query("DRIVE") == "DRIVE00"
        assert session.query("1A") == "1A10.0000"

    def test_recovery(self) -> None:
        session = running("INFEN1")
        session.set_wire("axis1.drive_fault", closed=True)
        session.ask("DRIVE1", wait_s=0.01)
        assert session.axis_bit(14), "the fault is still there"
        assert session.look("DRIVE") == "DRIVE00"
        assert session.error_bit(4)
        session.set_wire("axis1.drive_fault", closed=False)
        assert session.axis_bit(14), "latched until DRIVE1"
        session.ok("DRIVE1")
        assert not session.axis_bit(14)
        assert not session.axis_bit(13)
        assert not session.error_bit(4)

    def test_ends_the_program(self) -> None:
        session = mover("INFEN1", "D80000")
        session.ask("DEF P:GO1:A77:END")
        session.read()
        session.ask("RUN P", wait_s=0.5)
        session.set_wire("axis1.drive_fault", closed=True)
        session.advance(0.1)
        assert not session.system_bit(3)
        session.read()
        assert session.query("1A") == "1A10.0000"

"""SFB: encoder, ANI input and open loop, the settings each source has of its own, and polarity."""

from __future__ import annotations

import pytest

from tests.controller.session import Session

ANI_COUNTS_PER_VOLT = 819.2
VOLTS_PER_REV = 2.0

ANI_UNIT = f"[options]\nani = true\n[axis1.ani]\nvolts_at_zero = 1.0\nvolts_per_rev = {VOLTS_PER_REV}\n"
"""One revolution is 1638.4 counts of the ANI converter."""

COUNTS_PER_REV = ANI_COUNTS_PER_VOLT * VOLTS_PER_REV


def ani_unit(*commands: str, machine: str = ANI_UNIT) -> Session:
    session = Session(machine)
    session.ok("DRIVE10", "COMEXC1", *commands)
    return session


def value(session: Session, text: str) -> float:
    """The number a prefixed report ends in."""
    return float(session.look(text).removeprefix(text.removeprefix("!")))


class TestReadings:
    def test_position_and_voltage_follow_the_shaft(self) -> None:
        session = ani_unit("D4000", "GO1")
        session.advance(2)
        expected = (1.0 + VOLTS_PER_REV) * ANI_COUNTS_PER_VOLT
        assert value(session, "1TANI") == pytest.approx(expected, abs=3)
        assert session.look("1TPANI").removeprefix("1TPANI") == session.look("1TANI").removeprefix("1TANI")
        session.ok("VAR1=1ANI", "VAR2=1PANI")
        assert float(session.look("VAR1").removeprefix("VAR1=")) == pytest.approx(3.0, abs=0.005)
        assert float(session.look("VAR2").removeprefix("VAR2=")) == value(session, "1TANI")
        assert session.number("axis1.ani") == pytest.approx(3.0, abs=0.005)
        assert session.number("axis1.position.ani") == value(session, "1TANI")

    def test_scaled_by_scld(self) -> None:
        session = ani_unit("SCLD100", "SCALE1")
        assert session.query("1TANI") == "1TANI+8.19"

    def test_without_the_option_zero_and_no_sfb2(self) -> None:
        session = Session()
        assert session.query("TANI") == "TANI+0,+0"
        assert session.error("SFB2,1") == "INVALID DATA-FIELD 1"
        with pytest.raises(ValueError, match="no ANI"):
            session.unit.do("force_ani", axis=1, volts=1.0)

    def test_a_program_waits_for_the_input(self) -> None:
        """WAIT on the voltage, told by the servo when it comes true: 2 V half a revolution on, half a ramp of 10 ms and
        the axis's trailing by 1 / Kv = 50 ms later."""
        session = ani_unit("MC1", "V1", "A100", "GO1")
        stamps = session.timed("WAIT(1ANI>2)", wait_s=2)
        assert stamps[-1].at_ns / 1e9 == pytest.approx(0.5 + 0.005 + 0.05, abs=0.01)
        stamps = session.timed("WAIT(1PANI>=6000)", wait_s=5)
        reached_rev = (6000 / ANI_COUNTS_PER_VOLT - 1.0) / VOLTS_PER_REV
        assert stamps[-1].at_ns / 1e9 == pytest.approx(reached_rev + 0.055 - 2.0, abs=0.01)

    def test_the_range_ends_at_ten_volts(self) -> None:
        session = ani_unit("MC1", "V2", "GO1")
        session.advance(8)
        assert session.query("1TANI") == "1TANI+8191"


class TestClosedLoopOnAni:
    def test_a_move_in_its_counts(self) -> None:
        session = ani_unit("SFB2", "SGP2", "V1", "A10", "MA1", "D5000", "GO1")
        session.advance(8)
        assert value(session, "1TPC") == 5000
        assert value(session, "1TFB") == pytest.approx(5000, abs=2)
        assert session.number("axis1.position.true") == pytest.approx((5000 / ANI_COUNTS_PER_VOLT - 1) / 2, abs=0.01)
        assert value(session, "1TPE") == pytest.approx(4000 * session.number("axis1.position.true"), abs=2)

    def test_velocity_is_in_volts_a_second(self) -> None:
        """819 counts/s to 1 V/s (6000 PG p.211); back on the encoder it is revolutions again."""
        session = ani_unit("SFB2", "SGP2", "MC1", "V0.5", "A10", "GO1")
        session.advance(1)
        assert session.number("axis1.velocity.commanded") == pytest.approx(0.5 * 819)
        assert session.query("1TVEL") == "1TVEL+0.5000"
        session.ok("!S1")
        session.advance(1)
        session.ok("SFB1", "GO1")
        session.advance(1)
        assert session.number("axis1.velocity.commanded") == pytest.approx(0.5 * 4000)

    def test_a_lost_sensor_runs_away_and_smper_trips(self) -> None:
        """The voltage stays where it is: the axis goes on, the error grows, the drive is shut down."""
        session = ani_unit("SFB2", "SGP2", "SMPER500", "ERROR.12-1", "MC1", "V1", "GO1")
        session.advance(0.5)
        volts = session.number("axis1.ani")
        session.unit.do("force_ani", axis=1, volts=volts)
        session.advance(2)
        assert session.axis_bit(23)
        assert session.axis_bit(13)
        assert session.error_bit(12)
        session.unit.do("release_ani", axis=1)
        session.advance(0.01)
        assert session.number("axis1.ani") != pytest.approx(volts, abs=0.1)

    @pytest.mark.parametrize("axis", [0, 3])
    def test_no_such_input(self, axis: int) -> None:
        session = ani_unit()
        with pytest.raises(KeyError):
            session.unit.do("force_ani", axis=axis, volts=1.0)
        with pytest.raises(KeyError):
            session.unit.do("release_ani", axis=axis)
        with pytest.raises(ValueError, match="-10 to 10"):
            session.unit.do("force_ani", axis=1, volts=10.5)


KEPT = {
    "SGP": ("7", "9"),
    "SGI": ("1", "2"),
    "SGV": ("3", "4"),
    "SGVF": ("5", "6"),
    "SGAF": ("0.1", "0.2"),
    "SGILIM": ("8", "2.5"),
    "SOFFS": ("0.100", "0.200"),
    "SMPER": ("1234", "99"),
    "LSPOS": ("+5000", "+800"),
    "LSNEG": ("-5000", "-800"),
}
"""Settings of a source, as the encoder and as the ANI input get them here."""


class TestSettingsOfASource:
    def test_each_source_has_its_own(self) -> None:
        session = ani_unit(*(f"1{name}{encoder}" for name, (encoder, _) in KEPT.items()))
        session.ok("SFB2")
        defaults = Session()
        for name in KEPT:
            assert session.query(f"1{name}") == defaults.query(f"1{name}"), "never set for the ANI input"
        session.ok(*(f"1{name}{ani}" for name, (_, ani) in KEPT.items()))
        for sfb, place in (("SFB1", 0), ("SFB2", 1), ("SFB0", 0), ("SFB1", 0), ("SFB2", 1)):
            session.ok(sfb)
            for name, values in KEPT.items():
                assert session.query(f"1{name}") == f"1{name}{values[place]}", sfb
            terms = session.unit.controller.engine.gains(0)
            assert terms.proportional_mv_per_count == float(KEPT["SGP"][place])
            session.advance(0.01)

    def test_they_act(self) -> None:
        """SMPER of the ANI input is small, the encoder's is off: the same error trips on one source only."""
        for sfb, trips in (("SFB1", False), ("SFB2", True)):
            session = ani_unit("SGP0", "1SMPER0", "SFB2", "SGP0", "1SMPER50", sfb, "A100", "V1", "D400", "GO1")
            session.advance(1)
            assert session.axis_bit(23) is trips

    def test_soft_limits_act(self) -> None:
        session = ani_unit("LS3", "LSPOS2000", "LSNEG-2000", "SFB2", "SGP2", "PSET0", "D1000", "GO1")
        session.advance(4)
        assert session.position() == 1000, "the encoder's limits do not hold here"
        session.ok("LSPOS1200", "LSNEG-1200", "GO1")
        session.advance(4)
        assert 1200 <= session.position() < 1300
        assert session.axis_bit(17)

    def test_pset_is_kept_for_each(self) -> None:
        session = ani_unit("PSET100", "SFB2", "PSET-50")
        for sfb, position in (("SFB1", 100), ("SFB2", -50), ("SFB0", 100), ("SFB1", 100)):
            session.ok(sfb)
            session.advance(0.01)
            assert session.position() == pytest.approx(position, abs=1), sfb
        assert value(session, "1TANI") == pytest.approx(-50, abs=1)

    def test_the_other_axis_keeps_its_own(self) -> None:
        session = ani_unit("SGP3,4", "SFB2")
        assert session.query("SGP") == "SGP0.5,4"
        assert session.query("SFB") == "SFB2,1"

    @pytest.mark.parametrize("how", ["RESET", "power"])
    def test_power_up_forgets_both(self, how: str) -> None:
        session = ani_unit("SGP3", "SFB2", "SGP9")
        if how == "RESET":
            session.ask("RESET", wait_s=0.1)
        else:
            session.unit.do("cut_power")
            session.unit.do("restore_power")
            session.read()
        assert session.query("1SGP") == "1SGP0.5"
        session.ok("SFB2")
        assert session.query("1SGP") == "1SGP0.5"

    def test_a_machine_file_may_start_on_ani(self) -> None:
        session = Session(ANI_UNIT, SFB="2,1", SGP="3,4")
        assert session.query("SFB") == "SFB2,1"
        assert session.look("1TFB").removeprefix("1TFB") == session.look("1TANI").removeprefix("1TANI")
        session.ok("SFB1")
        assert session.query("1SGP") == "1SGP3"


class TestSelecting:
    def test_the_command_takes_over_and_nothing_moves(self) -> None:
        session = ani_unit("D4000", "GO1")
        session.advance(2)
        shaft = session.number("axis1.position.true")
        session.ok("SFB2")
        assert session.query("1TPER") == "1TPER+0"
        session.advance(1)
        assert session.number("axis1.position.true") == pytest.approx(shaft, abs=0.01)

    def test_not_in_motion(self) -> None:
        session = ani_unit("MC1", "GO1")
        session.advance(0.2)
        for sfb in ("SFB2", "SFB0", "!SFB2"):
            assert session.error(sfb) == "MOTION IN PROGRESS"
        assert session.query("1SFB") == "1SFB1"

    @pytest.mark.parametrize("command", ["GO1", "1GO", "HOM0", "JOY1"])
    def test_open_loop_refuses_motion(self, command: str) -> None:
        session = ani_unit("JOYAXL1", "SFB0", "SOFFS0.25")
        assert session.error(command) == "NOT ALLOWED IF SFB0"
        session.advance(0.01)
        assert session.query("1TDAC") == "1TDAC+0.250"
        assert not session.axis_bit(1)

    def test_open_loop_does_not_jog(self) -> None:
        session = ani_unit("INFNC1-1J", "INDEB1", "INFEN1", "SFB0", "JOG1")
        session.set_wire("input.1", closed=True)
        session.advance(0.2)
        assert not session.axis_bit(1)


class TestPolarity:
    @pytest.mark.parametrize(
        ("reversed_by", "runs_away"),
        [((), False), (("ENCPOL1",), True), (("CMDDIR1",), False), (("ENCPOL1", "CMDDIR1"), True)],
    )
    def test_reversed_feedback_runs_away_until_smper(self, reversed_by: tuple[str, ...], runs_away: bool) -> None:
        """ENCPOL alone turns one sign of the loop round, CMDDIR both, so the axis only turns the other way."""
        session = Session()
        session.ok(*reversed_by, "ERROR.12-1", "DRIVE10", "COMEXC1", "GO1")
        session.advance(3)
        assert session.axis_bit(23) is runs_away
        assert session.axis_bit(13) is runs_away
        assert session.error_bit(12) is runs_away
        assert session.query("1DRIVE") == ("1DRIVE0" if runs_away else "1DRIVE1")
        if not runs_away:
            assert session.query("1TPE") == "1TPE+4000"
            turned = -1 if reversed_by else 1
            assert session.number("axis1.position.true") == pytest.approx(turned, abs=0.001)

    def test_the_way_back(self) -> None:
        session = Session()
        session.ok("ENCPOL1", "ERROR.12-1", "DRIVE10", "COMEXC1", "GO1")
        session.advance(3)
        session.ok("ENCPOL0", "DRIVE1")
        assert not session.axis_bit(23)
        assert not session.error_bit(12)
        session.ok("PSET0", "GO1")
        session.advance(3)
        assert session.query("1TPE") == "1TPE+4000"

    @pytest.mark.parametrize(("reversed_by", "runs_away"), [("ANIPOL1", True), ("CMDDIR1", False), ("ENCPOL1", False)])
    def test_of_the_ani_input(self, reversed_by: str, runs_away: bool) -> None:
        session = ani_unit("DRIVE0", reversed_by, "SFB2", "SGP2", "SMPER800", "DRIVE1", "D1000", "GO1")
        session.advance(5)
        assert session.axis_bit(23) is runs_away

    def test_anipol_turns_the_sign_of_the_position_not_of_the_voltage(self) -> None:
        session = ani_unit("DRIVE0")
        assert session.query("1TANI") == "1TANI+819"
        session.ok("ANIPOL1")
        assert session.query("1TANI") == "1TANI-819"
        session.advance(0.01)
        assert session.query("1TANI") == "1TANI-819"
        assert session.number("axis1.ani") == pytest.approx(1.0, abs=0.002)

    @pytest.mark.parametrize("command", ["ENCPOL1", "CMDDIR1", "ANIPOL1"])
    def test_not_in_motion(self, command: str) -> None:
        session = ani_unit("MC1", "GO1")
        session.advance(0.2)
        assert session.error(command) == "MOTION IN PROGRESS"

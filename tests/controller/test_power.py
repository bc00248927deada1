"""Power-up, RESET and power cuts: what is kept, what is said, what runs."""

from __future__ import annotations

import pytest

from tests.controller.session import SIGN_ON, Session, both_on


class TestPowerAndReset:
    def test_power_up(self) -> None:
        assert Session().sign_on == SIGN_ON

    def test_reset_restores_defaults_and_signs_on(self) -> None:
        session = both_on("A77", "COMEXC1", "LH0,0")
        assert session.ask("RESET", wait_s=0.1) == SIGN_ON
        assert session.query("A") == "A10.0000,10.0000"
        assert session.query("DRIVE") == "DRIVE00"
        assert session.query("LH") == "LH3,3"

    @pytest.mark.parametrize("reset", ["RESET", "!RESET"])
    def test_reset_in_motion(self, reset: str) -> None:
        session = both_on("COMEXC1", "MC1", "GO1")
        session.advance(0.5)
        session.ask(reset)
        assert not session.axis_bit(1)
        assert session.axis_bit(13)

    def test_reset_forgets_what_waits(self) -> None:
        session = Session()
        session.ask("T5:V7")
        assert session.ask("!RESET", wait_s=6) == SIGN_ON
        assert session.query("1V") == "1V1.0000"

    @pytest.mark.parametrize("how", ["reset", "power"])
    def test_kept(self, how: str) -> None:
        """Settled section 8: programs, STARTP, ADDR, CMDDIR, ENCPOL, DRPCHK, gain sets; nothing else."""
        session = Session()
        session.ask("DEF P:V2:END")
        session.read()
        session.ok("SGP7,8", "SGSET3", "CMDDIR10", "ENCPOL01", "DRPCHK2", "STARTP P", "XONOFF0")
        self.restart(session, how)
        assert session.read() == SIGN_ON
        assert "1 - P USES" in session.ask("TDIR")
        assert session.query("STARTP") == "STARTP P"
        assert session.query("CMDDIR") == "CMDDIR10"
        assert session.query("ENCPOL") == "ENCPOL01"
        assert session.query("DRPCHK") == "DRPCHK2"
        assert session.query("SGP") == "SGP0.5,0.5"
        assert "SGP7,8" in session.ask("TSGSET3")

    @pytest.mark.parametrize("how", ["reset", "power"])
    def test_address_kept_and_silent(self, how: str) -> None:
        session = Session()
        session.ok("ADDR3")
        self.restart(session, how)
        assert session.read() == "", "a unit with an address does not sign on"
        assert session.query("ADDR") == "ADDR3"
        assert session.query("3_ADDR") == "ADDR3"

    @staticmethod
    def restart(session: Session, how: str) -> None:
        if how == "reset":
            session.unit.send(b"RESET\r")
        else:
            session.unit.do("cut_power")
            session.advance(0.5)
            session.unit.do("restore_power")
        session.advance(0.1)

    @pytest.mark.parametrize("how", ["RESET", "!RESET", "power"])
    def test_start_up_program(self, how: str) -> None:
        session = Session()
        session.ask("DEF BOOT:A33:1A:T0.2:V4:END:STARTP BOOT")
        session.read()
        if how != "power":
            answer = session.ask(how, wait_s=0.1)
            assert session.system_bit(19), "the program dwells"
            session.advance(0.5)
        else:
            session.unit.do("cut_power")
            session.unit.do("restore_power")
            session.advance(0.5)
            answer = session.read()
        assert answer == f"{SIGN_ON}*1A33.0000\r"
        session.read()
        assert session.query("1A") == "1A33.0000"
        assert session.query("1V") == "1V4.0000"

    def test_start_up_program_needs_enable(self) -> None:
        session = Session()
        session.ask("DEF BOOT:A33:END:STARTP BOOT")
        session.read()
        session.set_wire("enable", closed=False)
        session.ask("RESET", wait_s=0.5)
        assert session.query("1A") == "1A10.0000"

    def test_start_up_program_cleared(self) -> None:
        session = Session()
        session.ask("DEF BOOT:A33:END:STARTP BOOT:STARTP CLR")
        session.ask("RESET", wait_s=0.5)
        assert session.query("1A") == "1A10.0000"

    def test_power_cut_and_restored(self) -> None:
        session = both_on("COMEXC1", "MC1", "GO1")
        session.advance(0.5)
        session.unit.do("cut_power")
        assert session.ask("TREV", wait_s=0.5) == "", "nothing answers"
        session.unit.do("restore_power")
        assert session.read() == SIGN_ON
        assert session.query("TREV").startswith("TREV")
        assert session.query("DRIVE") == "DRIVE00"
        assert session.query("1TPE") == "1TPE+0"

    def test_power_cut_during_a_move_that_held_the_buffer(self) -> None:
        session = both_on("D400000")
        session.ask("GO1:V7")
        session.advance(0.5)
        session.unit.do("cut_power")
        session.advance(0.1)
        session.unit.do("restore_power")
        assert session.read() == SIGN_ON
        assert session.query("1V") == "1V1.0000"

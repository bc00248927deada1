"""The serial port: silence, addresses, framing, echo; and several connections to one unit at once."""

from __future__ import annotations

from tests.controller.session import ERROR, OK, SIGN_ON, Session, both_on


class TestCommunication:
    def test_e0_silences_until_e1(self) -> None:
        session = Session()
        session.ask("E0")
        for text in ("TREV", "V7", "", "XYZZY", "!K", "\x0b"):
            assert session.ask(text) == ""
        session.ask("E1")
        assert session.query("1V") == "1V1.0000"

    def test_e_by_address(self) -> None:
        session = Session(ADDR=2)
        session.ask("2_E0")
        session.ask("1_E1")
        assert session.ask("TREV") == ""
        session.ask("0_E1")
        assert session.query("2_TREV").startswith("TREV")

    def test_address(self) -> None:
        session = Session(ADDR=2)
        assert session.query("2_1V") == "1V1.0000", "no address in the reply"
        assert session.query("1V") == "1V1.0000"
        assert session.query("0_1V") == "1V1.0000"
        assert session.query("2_!1V") == "1V1.0000"
        for text in ("1_1V", "3_V7", "1_XYZZY", "12_!K"):
            assert session.ask(text) == "", "not for this unit: no reply, no prompt, no error"

    def test_port_chooses_the_settings_meant(self) -> None:
        session = Session()
        session.ok("PORT2", "ERRLVL1", "EOT13,10,0")
        assert session.query("ERRLVL") == "ERRLVL1"
        session.ok("PORT1")
        assert session.query("ERRLVL") == "ERRLVL4"
        assert session.query("EOT") == "EOT13,0,0"

    def test_framing_acts_from_the_next_answer_on(self) -> None:
        session = Session()
        assert session.ask("ERROK42,0,0,0") == "*"
        assert session.ask("BOT1,2,256") == "*"
        assert session.ask("1V") == "\x01\x02\x00*1V1.0000\r*"

    def test_echo(self) -> None:
        session = Session(ECHO=1)
        assert session.ask("tpe") == f"TPE\r\n*TPE+0,+0\r{OK}"
        session.unit.send(b"echo0:1v:")
        assert session.read() == f"ECHO0:{OK}*1V1.0000\r{OK}"


class TestTwoChannels:
    def test_replies_go_to_the_asker(self) -> None:
        session = Session()
        session.unit.send(b"1V", channel=1)
        session.unit.send(b"2A", channel=2)
        session.unit.send(b"\r", channel=1)
        session.unit.send(b"\r", channel=2)
        assert session.read(channel=1) == f"*1V1.0000\r{OK}"
        assert session.read(channel=2) == f"*2A10.0000\r{OK}"
        assert session.read() == ""

    def test_a_waiting_command_is_answered_to_its_asker(self) -> None:
        session = both_on()
        session.ask("GO1", channel=1)
        session.ask("1TPC", channel=2)
        assert session.query("!1TAS.1") == "1"
        session.advance(2)
        assert session.read(channel=1) == OK
        assert session.read(channel=2) == f"*1TPC+4000\r{OK}"

    def test_errors_go_to_their_maker(self) -> None:
        session = Session()
        assert ERROR.fullmatch(session.ask("XYZZY", channel=1))
        assert session.read(channel=2) == ""

    def test_one_line_is_not_cut_by_another(self) -> None:
        """Byte by byte from both at once: each command arrives whole."""
        session = Session()
        first, second = b"1V2.5:1V\r", b"2A7.25:2A\r"
        for one, other in zip(first.ljust(len(second), b" "), second, strict=True):
            session.unit.send(bytes((one,)), channel=1)
            session.unit.send(bytes((other,)), channel=2)
        assert session.read(channel=1) == f"{OK}*1V2.5000\r{OK}"
        assert session.read(channel=2) == f"{OK}*2A7.2500\r{OK}"

    def test_sign_on_reaches_everyone(self) -> None:
        session = Session()
        session.ask("V", channel=1)
        session.ask("V", channel=2)
        session.ask("!RESET", channel=1)
        assert session.read(channel=2) == SIGN_ON

    def test_detach_forgets_half_a_command_only(self) -> None:
        session = Session()
        session.unit.send(b"V7:A5:T0.1:1A", channel=1)
        session.unit.controller.detach(1)
        session.unit.send(b"\r", channel=1)
        session.advance(0.2)
        assert session.query("V") == "V7.0000,1.0000"
        assert session.query("1A") == "1A5.0000"
        assert "1A5" not in session.read(channel=1)

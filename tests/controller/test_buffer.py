"""The command buffer: what waits for what, what jumps the queue, when prompts leave, who hears the answers."""

from __future__ import annotations

import pytest

from tests.controller.session import OK, ONE_UPDATE_EACH_NS, SYSTEM_NS, S, Session, Stamped, both_on


def within_an_update(stamp: Stamped, seconds: float) -> bool:
    """Whether output left with the first system update at or after a time."""
    return 0 <= stamp.at_ns - round(seconds * S) <= SYSTEM_NS


class TestMotionInTheBuffer:
    """COMEXC0 holds the buffer behind motion, COMEXC1 does not (language section 3)."""

    def test_comexc0_answers_after_the_move(self) -> None:
        session = both_on()
        stamps = session.timed("GO1:1TPC:1AA", wait_s=2)
        assert "".join(stamp.text for stamp in stamps) == f"{OK}*1TPC+4000\r{OK}*1AA10.0000\r{OK}"
        assert all(0 < stamp.at_ns - 1.1 * S <= ONE_UPDATE_EACH_NS for stamp in stamps)

    def test_comexc1_answers_at_once(self) -> None:
        session = both_on("COMEXC1")
        stamps = session.timed("GO1:1TAS.1", wait_s=2)
        assert [stamp.at_ns for stamp in stamps] == [0]
        assert stamps[0].text == f"{OK}*1\r{OK}"

    def test_immediate_jumps_the_queue(self) -> None:
        session = both_on()
        session.ask("GO1:V7")
        session.advance(0.5)
        assert session.query("!1V") == "1V1.0000"
        assert session.query("!1TAS.1") == "1"
        session.advance(1.0)
        assert session.read() == OK + OK
        assert session.query("1V") == "1V7.0000"

    def test_two_moves_follow_each_other(self) -> None:
        session = both_on()
        stamps = session.timed("GO1:D-4000:GO1", wait_s=3)
        assert len(stamps) == 2
        assert 0 < stamps[1].at_ns - 2.2 * S <= 2 * ONE_UPDATE_EACH_NS
        assert session.position() == 0

    def test_a_refused_go_holds_nothing(self) -> None:
        session = both_on("DRIVE00")
        answer = session.ask("GO1:1TPC")
        assert answer == f"\r\n*DRIVE SHUTDOWN\r\r\n? *1TPC+0\r{OK}"

    def test_immediate_go_gets_its_prompt_at_once(self) -> None:
        session = both_on()
        assert session.timed("!GO1", wait_s=2) == [Stamped(0, OK)]
        assert session.position() == 4000

    def test_buffered_commands_wait_for_a_move_extended_by_an_immediate_go(self) -> None:
        session = both_on("MA1")
        session.ask("GO1")
        session.advance(0.5)
        session.ask("!D8000")
        session.ask("!GO1")
        session.ask("1TPC")
        session.advance(3)
        assert session.read().endswith(f"*1TPC+8000\r{OK}")


class TestDwell:
    @pytest.mark.parametrize("seconds", ["0.001", ".5", "2", "1.234"])
    def test_holds_the_buffer(self, seconds: str) -> None:
        session = Session()
        stamps = session.timed(f"T{seconds}:1TPC", wait_s=3)
        assert "".join(stamp.text for stamp in stamps) == f"{OK}*1TPC+0\r{OK}"
        assert within_an_update(stamps[0], float(seconds))
        assert stamps[0].at_ns % SYSTEM_NS == 0, "commands go on at system updates"

    def test_shows_in_the_system_status(self) -> None:
        session = Session()
        session.ask("T1")
        assert session.system_bit(19)
        session.advance(1.01)
        assert not session.system_bit(19)

    def test_immediate_goes_on_meanwhile(self) -> None:
        session = Session()
        session.ask("T1")
        assert session.query("!1TPC") == "1TPC+0"
        assert session.ask("1TPC") == ""

    @pytest.mark.parametrize("text", ["T0", "T1000", "T-1"])
    def test_range(self, text: str) -> None:
        assert Session().error(text) == "INVALID DATA"


class TestWait:
    def test_for_the_end_of_motion(self) -> None:
        session = both_on("COMEXC1")
        session.ask("GO1")
        stamps = session.timed("WAIT(1AS.1=b0):1TPC", wait_s=2)
        assert "".join(stamp.text for stamp in stamps) == f"{OK}*1TPC+4000\r{OK}"
        assert 0 < stamps[0].at_ns - 1.1 * S <= ONE_UPDATE_EACH_NS

    @pytest.mark.parametrize(
        "condition", ["AS.1=b0", "AS.1=0", "1AS=0XXX", "MOV=b00", "MOV=00", "MOV=0", "NOT(1AS.1=b1)"]
    )
    def test_spellings_of_hosts(self, condition: str) -> None:
        session = both_on("COMEXC1")
        session.ask("GO1")
        stamps = session.timed(f"WAIT({condition})", wait_s=2)
        assert [text for _, text in stamps] == [OK]
        assert 0 < stamps[0].at_ns - 1.1 * S <= ONE_UPDATE_EACH_NS

    def test_for_both_axes(self) -> None:
        session = both_on("COMEXC1", "D4000,8000")
        session.ask("GO11")
        stamps = session.timed("WAIT(1AS=0XXX AND 2AS=0XXX)", wait_s=3)
        assert 0 < stamps[0].at_ns - 2.1 * S <= ONE_UPDATE_EACH_NS

    @pytest.mark.parametrize(("condition", "counts"), [("1PC>1000", 1000), ("1PC>=1001", 1000), ("PC>1000", 1000)])
    def test_for_a_position(self, condition: str, counts: int) -> None:
        session = both_on("COMEXC1")
        session.ask("GO1")
        stamps = session.timed(f"WAIT({condition})", wait_s=2)
        reached_s = 0.1 + (counts - 200) / 4000
        assert 0 <= stamps[0].at_ns - reached_s * S <= ONE_UPDATE_EACH_NS + 0.001 * S

    def test_for_one_position_against_another(self) -> None:
        """The right side moves, the left one does not."""
        session = both_on("COMEXC1")
        session.ask("2PSET1000")
        session.read()
        session.ask("GO1")
        stamps = session.timed("WAIT(2PC<1PC)", wait_s=2)
        assert 0 <= stamps[0].at_ns - 0.3 * S <= ONE_UPDATE_EACH_NS + 0.001 * S

    def test_more_readings_than_the_engine_can_watch(self) -> None:
        session = both_on("COMEXC1")
        session.ask("GO1")
        never = "OR".join(f"2PC>{number}" for number in range(1, 10))
        stamps = session.timed(f"WAIT({never}OR1PC>999)", wait_s=2)
        assert 0 <= stamps[0].at_ns - 0.3 * S <= ONE_UPDATE_EACH_NS + 0.001 * S

    def test_in_user_units(self) -> None:
        session = both_on("SCALE1", "SCLD4000", "SCLV4000", "SCLA4000", "D2", "COMEXC1")
        session.ask("GO1")
        stamps = session.timed("WAIT(1PC>1.5)", wait_s=3)
        assert 0 <= stamps[0].at_ns - 1.55 * S <= ONE_UPDATE_EACH_NS + 0.001 * S

    @pytest.mark.parametrize("scale", [0, 1])
    def test_for_the_analogue_output(self, scale: int) -> None:
        session = both_on(f"SCALE{scale}", "COMEXC1", "SOFFS0.25")
        session.ask("WAIT(1DAC>1)")
        session.advance(0.1)
        assert session.read() == ""
        session.ok("!SOFFS1.5")
        session.advance(0.1)
        assert session.read() == OK

    def test_for_an_input(self) -> None:
        session = Session()
        session.ask("WAIT(IN.3=b1)")
        session.advance(1)
        assert session.read() == ""
        assert session.system_bit(14)
        session.read()
        session.set_wire("input.3", closed=True)
        session.advance(0.0045)  # the debounce time, in whole system updates
        assert session.read() == OK
        assert not session.system_bit(14)

    def test_for_an_output_an_immediate_command_sets(self) -> None:
        session = Session()
        session.ask("WAIT(OUT.2=b1)")
        session.advance(0.1)
        assert session.ask("!OUT.2-1") == OK + OK

    def test_already_true(self) -> None:
        session = Session()
        assert session.timed("WAIT(1AS.1=b0)", wait_s=1) == [Stamped(0, OK)]

    def test_holds_whatever_comexc_says(self) -> None:
        session = Session(COMEXC=1)
        session.ask("WAIT(IN.1=b1):1TPC", wait_s=1)
        assert session.read() == ""

    @pytest.mark.parametrize(
        ("text", "error"),
        [
            ("WAIT(1AS.33=b1)", "INVALID DATA"),
            ("WAIT(3PC>1)", "INCORRECT AXIS"),
            ("WAIT(1AS.1)", "INCORRECT DATA"),
            ("WAIT()", "INCORRECT DATA"),
            ("WAIT(1PC>)", "INCORRECT DATA"),
            ("WAIT(1PC>1 AND)", "INCORRECT DATA"),
        ],
    )
    def test_malformed(self, text: str, error: str) -> None:
        assert Session().error(text) == error

    def test_kill_ends_it(self) -> None:
        session = Session()
        session.ask("WAIT(IN.1=b1):V7")
        session.ask("!K")
        session.advance(0.1)
        assert not session.system_bit(14)
        session.read()
        assert session.query("1V") == "1V1.0000"


class TestPause:
    def test_ps_until_c(self) -> None:
        session = Session()
        session.ask("PS:V7")
        assert session.system_bit(13)
        session.advance(1)
        session.read()
        assert session.query("!1V") == "1V1.0000"
        session.ask("!C")
        assert not session.system_bit(13)
        session.read()
        assert session.query("1V") == "1V7.0000"

    @pytest.mark.parametrize("command", ["!S", "!K", "\x0b"])
    def test_stop_and_kill_end_it(self, command: str) -> None:
        """They end program execution and empty the buffer; nothing is left for C to resume."""
        session = Session()
        session.ask("PS:V7")
        session.ask(command)
        assert not session.system_bit(13)
        session.read()
        assert session.query("1V") == "1V1.0000"

    def test_comexs1_pauses_and_resumes(self) -> None:
        session = both_on("COMEXS1", "D40000")
        session.ask("GO1:V7")
        session.advance(0.5)
        session.ask("!S")
        session.until_rest(timeout_s=1)
        session.advance(0.5)
        assert session.system_bit(13)
        session.read()
        assert session.query("!1V") == "1V1.0000"
        session.ask("!C")
        session.read()
        assert session.query("1V") == "1V7.0000"

    def test_comexs1_and_kill(self) -> None:
        session = both_on("COMEXS1", "D40000")
        session.ask("GO1:V7")
        session.advance(0.5)
        session.ask("!K")
        session.until_rest(timeout_s=1)
        session.read()
        assert session.query("1V") == "1V1.0000"


class TestPrograms:
    def test_definition_and_run(self) -> None:
        session = both_on()
        assert session.ask("DEF MAIN") == "\r\n- "
        assert session.system_bit(7)
        for text in ("D1000", "GO1", "1TPC"):
            assert session.ask(text) == "\r\n- "
        assert session.ask("END") == OK
        stamps = session.timed("MAIN", wait_s=1)
        assert "".join(stamp.text for stamp in stamps) == f"*1TPC+1000\r{OK}"
        assert session.query("STARTP") == "STARTP NO PROGRAM DEFINED"

    def test_buffered_commands_wait_for_the_program(self) -> None:
        session = Session()
        session.ask("DEF P:T1:A77:END")
        session.read()
        session.ask("RUN P")
        session.ask("1A")
        session.advance(0.5)
        assert session.read() == ""
        session.advance(0.6)
        assert session.read() == f"{OK}*1A77.0000\r{OK}"

    def test_programs_call_programs(self) -> None:
        session = Session()
        session.ask("DEF SUB:V3:END:DEF MAIN:A5:GOSUB SUB:SUB:AD6:END")
        session.read()
        session.ok("MAIN", wait_s=0.1)
        assert (session.query("1A"), session.query("1V"), session.query("1AD")) == ("1A5.0000", "1V3.0000", "1AD6.0000")

    def test_nesting_is_bounded(self) -> None:
        session = Session()
        session.ask("DEF LOOP:LOOP:END")
        session.read()
        assert "NEST LEVEL TOO DEEP" in session.ask("LOOP", wait_s=1)
        session.ok("V2")

    def test_a_long_program_takes_time_but_not_all_of_it(self) -> None:
        """More commands than fit in one system update: immediate commands are answered in between."""
        session = Session()
        session.ask("DEF LONG:" + "V1:" * 30)
        session.ask("V2:" * 30)
        session.ask("END")
        session.read()
        session.ask("LONG")
        assert session.query("!TSS.3") == "1"
        session.advance(0.1)
        assert session.read() == OK
        assert session.query("1V") == "1V2.0000"

    def test_error_in_a_program_goes_on(self) -> None:
        session = Session()
        session.ask("DEF P:GO1:V9:END")
        session.read()
        assert "DRIVE SHUTDOWN" in session.ask("P", wait_s=0.1)
        assert session.query("1V") == "1V9.0000"

    def test_missing_program(self) -> None:
        session = Session()
        for text in ("RUN NONE", "NONE", "GOSUB NONE", "TPROG NONE"):
            assert session.error(text) == "UNDEFINED LABEL"
        session.ok("DEL NONE")

    def test_names(self) -> None:
        session = Session()
        assert session.error("DEF GO") == "STRING IS A COMMAND"
        assert session.error("END") == "NO PROGRAM BEING DEFINED"
        session.ask("DEF P")
        session.ask("END")
        assert session.error("DEF P") == "STRING ALREADY DEFINED"

    def test_halt_leaves_motion_alone(self) -> None:
        session = both_on("COMEXC1", "MC1")
        session.ask("DEF P:GO1:T5:END")
        session.read()
        session.ask("RUN P", wait_s=0.5)
        session.ask("!HALT", wait_s=0.01)
        assert not session.system_bit(3)
        assert session.axis_bit(1)

"""ERRORP: which causes keep the program and which give it up, and when the branch happens."""

from __future__ import annotations

import pytest

from tests.controller.session import OK, Session
from tests.controller.test_programs import define


def watching(bit: int, *main: str, fix: tuple[str, ...] = ("D9",)) -> Session:
    """A unit whose ERRORP notes the error in D and looks away; MAIN is ready to run."""
    session = Session()
    session.ok("DRIVE10")
    define(session, "FIX", *fix, f"ERROR.{bit}-0")
    define(session, "MAIN", *main)
    session.ok("ERRORP FIX", f"ERROR.{bit}-1")
    return session


@pytest.mark.parametrize(("comexl", "goes_on"), [(0, False), (1, True)])
def test_a_soft_limit_keeps_the_program_only_with_comexl(comexl: int, goes_on: bool) -> None:
    session = watching(3, "D100000", "V10", "A100", "GO1", "V7")
    session.ok(f"COMEXL{comexl}0", "LS3,0", "LSPOS1000", "LSNEG-1000", "LSAD100")
    assert session.ask("MAIN", wait_s=3) == OK
    assert session.query("1D") == "1D+9"
    assert session.query("1V") == ("1V7.0000" if goes_on else "1V10.0000")


def test_a_limit_in_the_way_of_go_branches_without_motion() -> None:
    session = watching(2, "GO1", "V7")
    session.set_wire("axis1.positive_limit", closed=False)
    assert session.ask("MAIN", wait_s=0.5) == OK
    assert session.query("1V") == "1V1.0000"
    assert session.query("1D") == "1D+9"


def test_enable_open_gives_the_program_up() -> None:
    session = watching(9, "T100", "V7")
    session.ask("MAIN")
    session.set_wire("enable", closed=False)
    session.advance(0.1)
    assert session.read() == OK
    assert session.query("1D") == "1D+9"
    assert session.query("1V") == "1V1.0000"


def test_position_error_keeps_the_program() -> None:
    session = watching(12, "T1", "V7")
    session.ok("SMPER1", "V50", "A5000", "D200000", "COMEXC1")
    session.ask("GO1")
    assert session.ask("MAIN", wait_s=2) == OK
    assert session.query("1D") == "1D+9"
    assert session.query("1V") == "1V7.0000"


def test_motion_under_comexc0_is_interrupted_and_waited_for_again() -> None:
    session = watching(16, "D4000", "V1", "A100", "GO1", "1TPC", fix=("VAR5=1", "TCMDER"))
    session.ask("MAIN", wait_s=0.3)
    heard = session.ask("!NOSUCH(", wait_s=0.2)
    assert "!NOSUCH(" in heard
    assert session.query("!VAR5") == "VAR5=+1.0"
    assert session.query("!TAS.1") == "1"
    session.advance(2)
    assert session.read().endswith("*1TPC+4000\r" + OK)


def test_commands_typed_while_the_error_program_runs_wait() -> None:
    session = watching(16, "V7", fix=("T1", "TCMDER"))
    session.error("NOSUCH")
    assert session.ask("1V", wait_s=0.5) == ""
    session.advance(0.6)
    assert session.read() == "*NOSUCH\r*1V1.0000\r" + OK


def test_an_input_calls_the_on_program_during_a_move() -> None:
    session = Session()
    session.ok("DRIVE10", "D4000", "V1", "A100")
    define(session, "ONPR", "VAR5=VAR5+1")
    session.ok("VAR5=0", "ONP ONPR", "ONINX1", "ONCOND1000")
    session.ask("GO1", wait_s=0.3)
    session.set_wire("input.2", closed=True)
    session.advance(0.2)
    assert session.query("!VAR5") == "VAR5=+1.0"
    assert session.query("!1TAS.1") == "1"
    session.advance(1)
    assert session.read() == OK, "the prompt of GO comes when the move is over"


def test_a_loop_refused_in_its_first_line_was_never_begun() -> None:
    """Its end then stands alone; commands between are carried out at once."""
    session = Session()
    assert "INCORRECT DATA" in session.ask("WHILE(1AS.27T=B1)")
    session.ok("D7")
    assert session.query("1D") == "1D+7"
    assert "INVALID CONDITIONS" in session.ask("NWHILE")

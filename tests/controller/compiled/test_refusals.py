"""PCOMP, PUCOMP and PRUN refused: the text, SS bit 31, nothing moves, and everything after it works."""

from __future__ import annotations

import pytest

from tests.controller.compiled.rig import compiled, define, refusal, unit_with
from tests.controller.session import both_on

CONDITIONS = "INVALID CONDITIONS FOR COMMAND-AXIS 1"
MOVE = ("A10", "AD10", "V1", "D4000", "VF0", "GOBUF1")


@pytest.mark.parametrize(
    ("program", "text"),
    [
        ((), "NO PATH SEGMENTS DEFINED"),
        (("V1", "D4000"), "NO PATH SEGMENTS DEFINED"),
        (("V1", "D4000", "GOBUF1"), "ERROR:  MOTION ENDS IN NON-ZERO VELOCITY-AXIS 1"),
        (("V1,1", "D4000,4000", "VF0", "GOBUF11"), "ERROR:  MOTION ENDS IN NON-ZERO VELOCITY-AXIS 2"),
        (("PLOOP2", "V1", "D4000", "GOBUF1", "PLN1"), "ERROR:  MOTION ENDS IN NON-ZERO VELOCITY-AXIS 1"),
        (("V1", "D4000", "GOBUF1", "D-4000", "VF0", "GOBUF1"), CONDITIONS),
        (("V1", "MC1", "GOBUF1", "D-", "GOBUF1"), CONDITIONS),
        (("V5", "AD1", "D4000000", "GOBUF1", "D4000", "VF0", "GOBUF1"), CONDITIONS),
        (("V0.0001", "D4000", "VF0", "GOBUF1"), CONDITIONS),
        (("V0", "D4000", "VF0", "GOBUF1"), CONDITIONS),
        (("A10", "AA11", *MOVE[1:]), "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
        (("AD10", "ADA4", *MOVE[2:]), "INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD 1"),
        ((*MOVE, "GO1"), "NOT ALLOWED IN PATH"),
        ((*MOVE, "T1"), "NOT ALLOWED IN PATH"),
        (("L2", *MOVE, "LN"), "NOT ALLOWED IN PATH"),
        ((*MOVE, "V"), "NOT ALLOWED IN PATH"),
        ((*MOVE, "OTHER"), "NOT ALLOWED IN PATH"),
        (("PLOOP1000000000", *MOVE, "PLN1"), "INVALID DATA-FIELD 1"),
        (("POUTA", *MOVE), "INCORRECT DATA"),
    ],
)
def test_pcomp_refuses(program: tuple[str, ...], text: str) -> None:
    assert refusal(*program) == text


def test_a_program_that_does_not_exist() -> None:
    session = both_on()
    for command in ("PCOMP NONE", "PUCOMP NONE", "PRUN NONE"):
        assert session.error(command) == "UNDEFINED LABEL"
    for command in ("PCOMP", "PUCOMP", "PRUN"):
        assert session.error(command) == "INCORRECT DATA"


def test_compiling_while_an_axis_moves() -> None:
    session = unit_with(*MOVE, COMEXC="1")
    session.ok("MC1", "1GO1")
    assert session.error("PCOMP P") == "MOTION IN PROGRESS"
    assert not session.system_bit(31)
    session.ok("!K")
    session.until_rest()
    session.ok("PCOMP P")


def test_a_failed_pcomp_leaves_the_program_uncompiled() -> None:
    session = unit_with("D(VAR1)", "V1", "VF0", "GOBUF1")
    session.ok("VAR1=4000", "PCOMP P", "VAR1=0")
    assert session.error("PCOMP P") == CONDITIONS
    assert session.error("PRUN P") == "PATH NOT COMPILED"
    session.ok("VAR1=4000", "PCOMP P")
    assert not session.system_bit(31)


@pytest.mark.parametrize("command", ["GOBUF1", "PLOOP3", "PLN1", "POUTA1", "POUTB1"])
def test_outside_a_definition(command: str) -> None:
    assert both_on().error(command) == "NOT DEFINING A PATH"


def test_axes_that_are_not_ready() -> None:
    session = compiled(*MOVE, COMEXC="1")
    session.ok("1DRIVE0")
    assert session.error("PRUN P") == "AXES NOT READY"
    session.ok("1DRIVE1", "MC1", "1GO1")
    assert session.error("PRUN P") == "AXES NOT READY"
    session.ok("!K")
    session.until_rest()
    session.ok("1JOG1")
    assert session.error("PRUN P") == "AXES NOT READY"
    session.ok("1JOG0")
    session.set_wire("enable", closed=False)
    assert session.error("PRUN P") == "WARNING: ENABLE INPUT INACTIVE"
    session.set_wire("enable", closed=True)
    session.ok("DRIVE11")
    start = session.position()
    session.ok("PRUN P")
    session.until_rest()
    assert session.position() == start + 4000


def test_running_twice_and_moving_otherwise() -> None:
    session = compiled(*MOVE, COMEXC="1")
    session.ok("PRUN P")
    assert session.error("PRUN P") == "PATH ALREADY MOVING"
    assert session.error("1GO1") == "MOTION IN PROGRESS"
    assert session.error("PCOMP P") == "MOTION IN PROGRESS"
    for command in ("PUCOMP P", "DEL P", "ERASE"):
        assert session.error(command) == "INVALID CONDITIONS FOR COMMAND", command
    session.until_rest()
    assert session.position() == 4000
    session.ok("PUCOMP P", "DEL P")


def test_a_limit_in_the_way_starts_nothing() -> None:
    session = compiled(*MOVE, COMEXC="1")
    session.set_wire("axis1.positive_limit", closed=False)
    session.ok("PRUN P")
    assert session.position() == 0
    assert session.axis_bit(15)
    session.set_wire("axis1.positive_limit", closed=True)
    session.ok("PRUN P")
    session.until_rest()
    assert session.position() == 4000


def test_memory_too_small() -> None:
    session = both_on()
    session.ok("MEMORY39000,1000")
    assert session.query("TSEG") == "TSEG13"
    define(session, "V1", "D1000", *["GOBUF1"] * 13, "VF0", "GOBUF1")
    assert session.error("PCOMP P") == "INSUFFICIENT MEMORY"
    assert session.system_bit(31)
    assert session.query("TSEG") == "TSEG13"


def test_memory_is_used_and_freed() -> None:
    session = both_on()
    session.ok("MEMORY39000,1000")
    for name, count in (("A1", 9), ("B1", 1), ("C1", 3)):
        define(session, "V1", "D1000", *["GOBUF1"] * (count - 1), "VF0", "GOBUF1", name=name)
    session.ok("PCOMP A1")
    assert (session.system_bit(29), session.system_bit(30)) == (False, False)
    session.ok("PCOMP B1")
    assert (session.system_bit(29), session.system_bit(30)) == (True, False)
    session.ok("PCOMP C1")
    assert (session.system_bit(29), session.system_bit(30)) == (True, True)
    session.ok("VAR1=SEG", "PUCOMP A1", "VAR2=SEG")
    assert session.query("VAR1") == "VAR1=+0.0"
    assert session.query("VAR2") == "VAR2=+9.0"
    session.ok("DEL B1")
    assert session.query("TSEG") == "TSEG10"
    session.ok("ERASE")
    assert session.query("TSEG") == "TSEG13"


def test_nothing_compiled_outlives_reset_or_a_new_program_of_the_name() -> None:
    session = compiled(*MOVE)
    session.ask("RESET", wait_s=0.1)
    session.ask("ECHO0")
    session.ok("DRIVE11")
    assert session.error("PRUN P") == "PATH NOT COMPILED"
    session.ok("PCOMP P", "DEL P")
    define(session, *MOVE)
    assert session.error("PRUN P") == "PATH NOT COMPILED"


@pytest.mark.parametrize("command", ["VF1", "FOLRNF1", "VF0.5"])
def test_zero_is_the_only_final_velocity_and_ratio(command: str) -> None:
    session = both_on()
    assert session.error(command) == "INVALID DATA-FIELD 1"
    session.ok("1VF0", "1FOLRNF0")
    assert session.query("VF") == "VF0.0000,0.0000"

"""A host that writes and runs compiled programs, for the tests of this folder."""

from __future__ import annotations

from tests.controller.session import TRAJECTORY_NS, S, Session, both_on

COUNTS = 4000
"""Counts in a revolution: the unit of V and A unscaled."""

WITHIN_S = TRAJECTORY_NS / S
"""A profile starts at the next trajectory update, and is seen to end at one."""


def unit_with(*program: str, name: str = "P", **defaults: str | int) -> Session:
    """A unit with drives on that has a program stored."""
    session = both_on("SMPER0,0", **defaults)
    define(session, *program, name=name)
    return session


def define(session: Session, *program: str, name: str = "P") -> None:
    """Store a program; every command draws the prompt of a definition."""
    for command in (f"DEF {name}", *program):
        answer = session.ask(command)
        assert answer == "\r\n- ", (command, answer)
    session.ok("END")


def compiled(*program: str, **defaults: str | int) -> Session:
    """A unit with drives on and program P compiled."""
    session = unit_with(*program, **defaults)
    session.ok("PCOMP P")
    return session


def refusal(*program: str) -> str:
    """What PCOMP answers to a program; the unit then still works."""
    session = unit_with(*program)
    text = session.error("PCOMP P")
    assert session.system_bit(31), "PCOMP failed"
    assert session.query("TSEG") == "TSEG244"
    assert session.error("PRUN P") == "PATH NOT COMPILED"
    assert session.position() == session.position(2) == 0
    define(session, "V1", "D4000", "VF0", "GOBUF1", name="Q")
    session.ok("PCOMP Q")
    assert not session.system_bit(31)
    session.ask("PRUN Q", wait_s=2.0)
    assert session.position() == 4000
    return text


def run_time(session: Session, axis: int = 1, *, timeout_s: float = 600.0) -> float:
    """PRUN P, seconds from the first trajectory update to the update at which the axis has come to rest."""
    start_ns = session.unit.controller.engine.next_trajectory_ns
    session.unit.send(b"PRUN P\r")
    session.until_rest(axis, timeout_s=timeout_s)
    return (session.now_ns - start_ns) / S

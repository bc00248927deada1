"""Registration moves: where they end, what they are made of, what keeps one from starting."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.session import S, Session

COUNTS_PER_REV = 4000
FAR = 400_000


def marked(at_rev: float, *commands: str, every_rev: float = 0.0, axis: int = 1, **defaults: str | int) -> Session:
    """A unit with axis 1 on, trigger A for registration, and marks."""
    table = f'[triggers.a]\nmarks_on = "axis{axis}"\nat_rev = {at_rev}\nevery_rev = {every_rev}\n'
    session = Session(table, **defaults)
    session.ok("INFNC25-H", "INFEN1", "DRIVE11", "COMEXC1", "ERROR.10-1", "SMPER0,0", "A100,100", "RE11", *commands)
    return session


def captured(session: Session) -> int:
    return int(session.look("!1TPCEA").removeprefix("1TPCEA"))


@settings(max_examples=25, deadline=None)
@given(
    at_rev=st.floats(1.0, 6.0),
    velocity=st.floats(0.5, 10.0).map(lambda v: round(v, 4)),
    distance=st.integers(6000, 60_000),
    backwards=st.booleans(),
)
def test_it_ends_at_the_captured_position_and_the_distance(
    at_rev: float, velocity: float, distance: int, backwards: bool
) -> None:
    sign = -1 if backwards else 1
    session = marked(sign * at_rev, f"V{velocity}", f"REGA{distance}", f"D{sign * FAR}", "GO1")
    session.advance(at_rev / velocity + velocity / 100 + 1.0)
    session.until_rest()
    edge = at_rev * COUNTS_PER_REV if not backwards else (-at_rev + 0.01) * COUNTS_PER_REV
    assert abs(captured(session) - edge) <= 1.01
    assert session.position() == captured(session) + sign * distance
    assert session.axis_bit(28)
    assert not session.axis_bit(30)


def test_it_is_made_of_what_was_in_force_when_the_distance_was_entered() -> None:
    session = marked(2.0, "V4", "A20", "REGA40000", "V1", "A100", f"D{FAR}", "GO1")
    session.advance(3.0)
    assert session.number("axis1.velocity.commanded") == pytest.approx(4 * COUNTS_PER_REV)
    session.until_rest()
    assert session.position() == captured(session) + 40_000


@pytest.mark.parametrize(("distance", "possible"), [(2100, True), (1990, False)])
def test_the_shortest_distance_is_the_braking_distance(distance: int, possible: bool) -> None:
    """V10 AD100: 0.5 rev = 2000 counts (following-and-profiles 4.2), what is travelled until the next update, and how
    far the command is ahead of the axis, which SGVF keeps small."""
    late = round(10 * COUNTS_PER_REV * 0.00336)
    session = marked(3.0, "SGVF25", "V10", f"REGA{distance + (late if possible else 0)}", f"D{FAR}", "GO1")
    session.until_rest()
    assert session.axis_bit(28) == possible
    assert session.axis_bit(30) != possible
    assert session.error_bit(10) != possible
    assert (session.position() == FAR) != possible


def test_the_next_go_clears_what_an_impossible_one_has_set() -> None:
    session = marked(3.0, "V10", "REGA100", "D40000", "GO1")
    session.until_rest()
    assert session.axis_bit(30)
    session.ok("D100", "GO1")
    assert not session.axis_bit(30)
    assert not session.error_bit(10)


OPEN_IS_ACTIVE = "INLVL" + "X" * 24 + "1"
"""The trigger then latches where a mark ends."""


@pytest.mark.parametrize(
    "commands",
    [
        ("RE00",),
        ("REGA0",),
        ("INFEN0",),
        ("INFNC25-A",),
        ("INEN" + "X" * 24 + "0",),
        ("REGLOD8002",),
        (OPEN_IS_ACTIVE, "REGLOD8042"),
    ],
)
def test_what_keeps_it_from_starting(commands: tuple[str, ...]) -> None:
    session = marked(2.0, "V4", "REGA4000", f"D{COUNTS_PER_REV * 5}", *commands, "GO1")
    session.until_rest()
    assert session.position() == COUNTS_PER_REV * 5
    assert not session.axis_bit(28)


def test_a_trigger_at_rest_and_one_after_a_stop_start_nothing() -> None:
    session = marked(50.0, "REGA4000", "V4", "D40000")
    session.unit.do("press_trigger", trigger="A")
    session.advance(0.1)
    assert session.system_bit(25)
    assert not session.signal("axis1.moving")
    session.ok("A10", "GO1")
    session.advance(0.5)
    session.ok("!1S")
    session.advance(0.05)
    session.unit.do("press_trigger", trigger="A")
    session.until_rest()
    assert not session.axis_bit(28)


def test_marks_of_one_axis_register_the_other() -> None:
    session = marked(2.0, "V4,2", "REGA,4000", "D0,100000", "RE01", "MC10", "GO11", axis=1)
    session.advance(2.0)
    session.until_rest(2)
    captured_2 = int(session.look("!2TPCEA").removeprefix("2TPCEA"))
    assert session.position(2) == captured_2 + 4000
    assert session.axis_bit(28, 2)
    assert session.signal("axis1.moving")


def test_single_shot_and_again() -> None:
    session = marked(1.0, "V2", "REGA6000", f"D{FAR}", "REGSS1", "GO1", every_rev=1.0)
    session.until_rest()
    assert abs(session.position() - 10_000) <= 1
    session.ok("REGSS0", "D-400000", "GO1")
    session.advance(20.0)
    assert session.signal("axis1.moving"), "every mark begins it anew"


def test_scaled_distances() -> None:
    session = marked(1.0, "SCALE1", "SCLD4000,4000", "SCLV4000,4000", "SCLA4000,4000", "V2", "REGA1.5", "D50", "GO1")
    session.until_rest()
    assert session.look("!1TPC") in ("1TPC+2.500", "1TPC+2.499")
    assert session.look("!1TPCEA") in ("1TPCEA+1.000", "1TPCEA+0.999")


def test_registration_again_and_again_does_not_drift() -> None:
    """A continuous web, cut 0.3 rev behind each mark: every stop lies there."""
    session = marked(0.5, "V3", "REGA1200", "D40000", "REGLOD400", every_rev=0.5)
    for mark in range(1, 60, 2):
        session.ok("GO1")
        session.until_rest()
        assert abs(session.position() - (mark * 2000 + 1200)) <= 1, mark
        session.ok("D800", "RE0", "GO1")
        session.until_rest()
        session.ok("D40000", "RE1")
        assert session.now_ns < 400 * S

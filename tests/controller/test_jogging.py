"""Jog mode: what the jog inputs make an axis do, and what it refuses meanwhile."""

from __future__ import annotations

import pytest

from tests.controller.session import Session

COUNTS = 4000
JOG_POSITIVE, JOG_NEGATIVE, JOG_FAST = "input.1", "input.2", "input.3"
INPUTS = ("INFNC1-1J", "INFNC2-1K", "INFNC3-1L", "INDEB1", "INFEN1")


def jog_unit(*commands: str, machine: str = "") -> Session:
    session = Session(machine)
    session.ok("DRIVE11", "COMEXC1", *INPUTS, "JOGVL0.5", "JOGVH2", "JOGA10", *commands, "JOG10")
    return session


def velocity(session: Session) -> float:
    """Commanded velocity of axis 1, rev/s."""
    return session.number("axis1.velocity.commanded") / COUNTS


def hold(session: Session, wire: str, *, closed: bool = True, for_s: float = 0.5) -> None:
    session.set_wire(wire, closed=closed)
    session.advance(for_s)


def test_inputs_move_the_axis_at_the_low_speed() -> None:
    session = jog_unit()
    assert session.axis_bit(8)
    hold(session, JOG_POSITIVE)
    assert velocity(session) == pytest.approx(0.5)
    hold(session, JOG_POSITIVE, closed=False)
    assert not session.signal("axis1.moving")
    hold(session, JOG_NEGATIVE)
    assert velocity(session) == pytest.approx(-0.5)


def test_the_speed_input_changes_speed_on_the_way() -> None:
    session = jog_unit()
    hold(session, JOG_POSITIVE)
    hold(session, JOG_FAST)
    assert velocity(session) == pytest.approx(2.0)
    hold(session, JOG_FAST, closed=False)
    assert velocity(session) == pytest.approx(0.5)


def test_distance_is_that_of_the_ramps() -> None:
    """Held for t at v with equal ramps: v t, and the ramp up misses what the ramp down adds."""
    session = jog_unit()
    start = session.position()
    hold(session, JOG_POSITIVE, for_s=0.5)
    hold(session, JOG_POSITIVE, closed=False, for_s=0.5)
    # set_wire lets two system updates pass; contacts are recognised alike at both changes
    held_s = 0.5 + 2 * 2.24e-3
    assert session.position() - start == pytest.approx(0.5 * COUNTS * held_s, abs=0.5 * COUNTS * 5e-3)


def test_both_inputs_mean_rest() -> None:
    session = jog_unit()
    hold(session, JOG_POSITIVE)
    hold(session, JOG_NEGATIVE)
    assert not session.signal("axis1.moving")


def test_functions_need_infen() -> None:
    session = jog_unit("INFEN0")
    hold(session, JOG_POSITIVE)
    assert not session.signal("axis1.moving")


def test_an_input_held_when_the_mode_begins_moves_at_once() -> None:
    session = jog_unit()
    session.ok("JOG0")
    hold(session, JOG_POSITIVE)
    assert not session.signal("axis1.moving")
    session.ok("JOG1")
    session.advance(0.5)
    assert velocity(session) == pytest.approx(0.5)


def test_go_and_hom_are_refused_in_jog_mode() -> None:
    session = jog_unit()
    for text in ("1GO", "1HOM0"):
        assert session.error(text) == "MOTION IN PROGRESS"
    session.ok("2GO")


def test_jog_needs_rest() -> None:
    session = Session("")
    session.ok("DRIVE11", "COMEXC1", "1GO")
    session.advance(0.1)
    assert session.error("1JOG1") == "MOTION IN PROGRESS"
    assert session.query("JOG") == "JOG00"


def test_an_immediate_jog0_ends_the_jog() -> None:
    session = jog_unit()
    hold(session, JOG_POSITIVE)
    session.ok("!JOG0")
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert not session.axis_bit(8)


def test_a_buffered_jog0_waits_for_the_end_of_the_jog() -> None:
    session = jog_unit()
    hold(session, JOG_POSITIVE)
    assert session.ask("1JOG0", wait_s=1.0) == ""
    assert velocity(session) == pytest.approx(0.5)
    hold(session, JOG_POSITIVE, closed=False)
    assert session.read() == "\r\n> "
    assert not session.axis_bit(8)


def test_after_a_stop_the_input_must_be_released_first() -> None:
    session = jog_unit()
    hold(session, JOG_POSITIVE)
    session.ask("!S")
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert session.axis_bit(8)
    hold(session, JOG_POSITIVE, closed=False)
    hold(session, JOG_POSITIVE)
    assert velocity(session) == pytest.approx(0.5)


def test_a_limit_stops_the_jog_and_only_the_way_back_is_free() -> None:
    session = jog_unit("JOGVL2", "ERROR.2-1", machine="[axis1.travel]\npositive_limit_rev = 1.0\n")
    hold(session, JOG_POSITIVE, for_s=1.5)
    assert not session.signal("axis1.moving")
    assert session.axis_bit(15)
    assert session.error_bit(2)
    hold(session, JOG_POSITIVE, closed=False, for_s=0.1)
    hold(session, JOG_POSITIVE, for_s=0.2)
    assert not session.signal("axis1.moving")
    hold(session, JOG_POSITIVE, closed=False, for_s=0.1)
    hold(session, JOG_NEGATIVE, for_s=0.3)
    assert velocity(session) == pytest.approx(-2.0)
    assert not session.axis_bit(15)


def test_an_s_curve_that_is_none_is_refused_and_never_crashes_later() -> None:
    session = jog_unit()
    session.ok("1JOG0", "JOGAA4")
    assert session.error("1JOG1") == "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"
    session.ok("JOGAA5", "1JOG1", "JOGAA1")
    hold(session, JOG_POSITIVE)
    assert velocity(session) == pytest.approx(0.5)


def test_power_goes_the_mode_goes() -> None:
    session = jog_unit()
    session.ask("RESET")
    assert session.look("JOG") == "JOG00"
    assert not session.axis_bit(8)

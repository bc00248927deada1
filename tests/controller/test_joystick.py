"""Joystick mode: the documented voltage bands, and an axis that follows the stick."""

from __future__ import annotations

from decimal import Decimal
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.controller.motion.joystick import deflection
from tests.controller.session import Session

COUNTS = 4000
SETTINGS = ("JOYCTR1,1", "JOYCDB.1,.1", "JOYEDB.2,.2")
"""The worked case of the 6250 User Guide p.67."""

FULL_POSITIVE_V, FULL_NEGATIVE_V, CENTRE_V = 2.4, 0.1, 1.0


def worked(code: int) -> float:
    return deflection(code, centre_v=Decimal("1"), centre_band_v=Decimal("0.1"), end_band_v=Decimal("0.2"))


def stick_unit(*commands: str, machine: str = "") -> Session:
    session = Session(f"[wires]\nanalog = [1.0, 1.0, 1.0]\n{machine}")
    session.ok("DRIVE11", "COMEXC1", *SETTINGS, "JOYAXL1,2", "JOYVL1,1", "JOYVH5,5", "JOYA20,20", *commands)
    return session


def push(session: Session, volts: float, channel: int = 1, for_s: float = 0.5) -> None:
    """Move the stick and wait for the ramp."""
    wanted = ",".join(str(volts) if number == channel else "" for number in (1, 2, 3)).rstrip(",")
    mask = "".join("1" if number == channel else "X" for number in (1, 2, 3))
    session.ok(f"!ANVO{wanted}", f"!ANVOEN{mask}")
    session.advance(for_s)


def velocity(session: Session, axis: int = 1) -> float:
    """Commanded velocity, rev/s."""
    return session.number(f"axis{axis}.velocity.commanded") / COUNTS


def test_the_code_bands_of_the_worked_case() -> None:
    codes = range(256)
    assert sum(worked(code) == -1.0 for code in codes) == 21 + 1
    assert [code for code in codes if worked(code) == 0.0] == list(range(93, 113))
    assert sum(-1.0 <= worked(code) < 0 for code in codes if code > 20) == 72
    assert sum(0 < worked(code) <= 1.0 for code in codes if code <= 234) == 122
    assert all(worked(code) == 1.0 for code in range(234, 256))


@pytest.mark.parametrize(
    ("speed", "positive", "negative"), ((5.0, 0.041, 0.069), (1.0, 0.008, 0.014)), ids=("JOYVH5", "JOYVL1")
)
def test_the_speed_per_count_of_the_worked_case(speed: float, positive: float, negative: float) -> None:
    assert round(worked(113) * speed, 3) == positive
    assert round(-worked(92) * speed, 3) == negative
    assert (worked(234) - worked(233)) * speed == pytest.approx(speed / 122)


@given(centre=st.integers(0, 250), centre_band=st.integers(0, 125), end_band=st.integers(0, 125))
def test_velocity_never_falls_as_the_stick_moves_up(centre: int, centre_band: int, end_band: int) -> None:
    shares = [
        deflection(
            code,
            centre_v=Decimal(centre) / 100,
            centre_band_v=Decimal(centre_band) / 100,
            end_band_v=Decimal(end_band) / 100,
        )
        for code in range(256)
    ]
    assert all(-1.0 <= share <= 1.0 for share in shares)
    assert all(low <= high for low, high in pairwise(shares))


def test_the_axis_follows_the_stick() -> None:
    session = stick_unit("JOY1")
    assert session.axis_bit(9)
    assert not session.signal("axis1.moving")
    push(session, FULL_POSITIVE_V)
    assert velocity(session) == pytest.approx(1.0)
    push(session, FULL_NEGATIVE_V)
    assert velocity(session) == pytest.approx(-1.0)
    push(session, CENTRE_V)
    assert not session.signal("axis1.moving")


def test_half_way_is_a_share_of_the_codes() -> None:
    session = stick_unit("JOY1")
    push(session, 1.7)
    code = int(1.7 * 102.4)
    assert velocity(session) == pytest.approx((code - 112) / 122)


def test_nothing_enters_python_while_the_stick_rests() -> None:
    session = stick_unit("JOY1")
    push(session, FULL_POSITIVE_V)
    entered: list[int] = []
    joystick = session.unit.controller.joystick
    refresh = joystick.refresh

    def noted_refresh() -> None:
        entered.append(session.now_ns)
        refresh()

    joystick.refresh = noted_refresh  # type: ignore[method-assign]
    session.advance(10.0)
    assert not entered
    push(session, CENTRE_V)
    assert entered


def test_two_axes_on_two_channels() -> None:
    session = stick_unit("JOY11")
    push(session, FULL_POSITIVE_V, channel=2)
    assert velocity(session, 2) == pytest.approx(1.0)
    assert not session.signal("axis1.moving")


def test_select_inputs_choose_speed_and_channel() -> None:
    session = stick_unit("JOYAXH3", "INFNC1-N", "INFNC2-O", "INDEB1", "INFEN1", "JOY1")
    push(session, FULL_POSITIVE_V, channel=3)
    assert not session.signal("axis1.moving")
    session.set_wire("input.1", closed=True)
    session.advance(0.5)
    assert velocity(session) == pytest.approx(1.0)
    session.set_wire("input.2", closed=True)
    session.advance(0.5)
    assert velocity(session) == pytest.approx(5.0)


def test_the_release_input_ends_the_mode() -> None:
    session = stick_unit("INFNC3-M", "INDEB1", "INFEN1", "JOY11")
    push(session, FULL_POSITIVE_V)
    session.set_wire("input.3", closed=True)
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert session.query("JOY") == "JOY00"
    assert not session.axis_bit(9)


def test_the_connectors_own_contacts_do_the_same() -> None:
    session = stick_unit("JOYAXH3", "INDEB1", "JOY1")
    push(session, FULL_POSITIVE_V, channel=3)
    assert not session.signal("axis1.moving")
    session.set_wire("joystick.axes_select", closed=True)
    session.advance(0.5)
    assert velocity(session) == pytest.approx(1.0)
    session.set_wire("joystick.velocity_select", closed=True)
    session.advance(0.5)
    assert velocity(session) == pytest.approx(5.0)
    assert session.query("TINO") == "TINO0011_0100"
    session.set_wire("joystick.release", closed=True)
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert session.query("JOY") == "JOY00"


@pytest.mark.parametrize("end", ("!JOY0", "!S", "!K", "!1S"))
def test_the_mode_ends_with_joy0_stop_and_kill(end: str) -> None:
    session = stick_unit("JOY1")
    push(session, FULL_POSITIVE_V)
    session.ask(end)
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert not session.axis_bit(9)


def test_a_limit_stops_the_axis_and_the_stick_leads_it_back() -> None:
    session = stick_unit("JOY1", machine="[axis1.travel]\npositive_limit_rev = 0.3\n")
    push(session, FULL_POSITIVE_V, for_s=1.0)
    assert not session.signal("axis1.moving")
    assert session.axis_bit(15) and session.axis_bit(9)
    push(session, FULL_NEGATIVE_V, for_s=0.2)
    assert velocity(session) == pytest.approx(-1.0)
    assert not session.axis_bit(15)


@pytest.mark.parametrize(
    ("before", "text"),
    (
        (("JOYAXL0,0",), "INPUT(S) NOT DEFINED AS JOYSTICK INPUT"),
        (("DRIVE00",), "DRIVE SHUTDOWN"),
        (("JOG1",), "INVALID CONDITIONS FOR COMMAND"),
        (("JOYAA4",), "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
    ),
)
def test_refusals(before: tuple[str, ...], text: str) -> None:
    session = stick_unit(*before)
    assert session.error("JOY1") == text
    assert session.query("JOY") == "JOY00"


def test_go_is_refused_with_the_joystick_on() -> None:
    session = stick_unit("JOY1")
    assert session.error("1GO") == "MOTION IN PROGRESS"
    session.ok("2GO")


def test_joyz_takes_the_present_voltage_as_the_centre() -> None:
    session = stick_unit("JOY1")
    push(session, 1.5)
    assert velocity(session) > 0
    session.ok("!JOYZ1")
    session.advance(0.5)
    assert not session.signal("axis1.moving")
    assert session.query("JOYCTR") == "JOYCTR1.49,1.00,1.25"

"""XOFF and XON of hosts on the instant line: what is said to a host that has stopped the unit waits for its XON."""

from __future__ import annotations

import pytest

from tests.controller.session import OK, Session

XON, XOFF = "\x11", "\x13"


def send(session: Session, text: str, *, channel: int = 0) -> str:
    session.unit.send(text.encode("latin-1"), channel=channel)
    return session.read(channel=channel)


def test_output_waits_for_xon() -> None:
    session = Session()
    assert send(session, XOFF + "1TPE\r") == ""
    assert session.signal("line.held")
    session.advance(1.0)
    assert session.read() == ""
    assert send(session, XON) == "*1TPE+0\r" + OK
    assert not session.signal("line.held")


def test_output_that_waited_is_stamped_with_the_time_of_the_xon() -> None:
    session = Session()
    session.unit.take_output()
    send(session, XOFF + "1TPE\r")
    session.advance(1.0)
    send(session, XON)
    assert [output.at_ns for output in session.unit.take_output()] == [session.now_ns]


@pytest.mark.parametrize("cut", range(1, 12))
def test_what_came_before_xoff_leaves_and_commands_are_never_torn(cut: int) -> None:
    session = Session()
    data = f"1TPE\r1T{XOFF}P{XON}E\r"
    assert send(session, data[:cut]) + send(session, data[cut:]) == ("*1TPE+0\r" + OK) * 2


def test_commands_are_carried_out_meanwhile() -> None:
    session = Session()
    send(session, XOFF + "VAR1=5\r")
    assert session.unit.controller.variables.number(1) == 5


def test_others_are_not_stopped() -> None:
    session = Session()
    assert send(session, XOFF + "1TPE\r", channel=1) == ""
    assert send(session, "1TPE\r", channel=2) == "*1TPE+0\r" + OK


def test_output_for_everyone_waits_while_anyone_has_stopped_it() -> None:
    session = Session()
    send(session, "\r", channel=2)
    send(session, XOFF, channel=1)
    send(session, "RESET\r", channel=2)
    assert "OEM6250" not in session.read(channel=2)
    assert "OEM6250" in send(session, XON, channel=1)
    assert "OEM6250" in session.read(channel=2)


def test_a_host_that_leaves_stops_nobody() -> None:
    session = Session()
    send(session, XOFF + "1TPE\r", channel=1)
    session.unit.controller.detach(1)
    assert not session.signal("line.held")
    assert session.read(channel=1) == "", "what was kept for it is gone with it"


def test_xonoff0_ignores_both_and_lets_go() -> None:
    session = Session()
    assert send(session, XOFF + "1TPE\r") == ""
    assert send(session, "XONOFF0\r") == "*1TPE+0\r" + OK + OK
    assert send(session, XOFF + "1T" + XON + "PE\r") == "*1TPE+0\r" + OK


def test_a_program_that_talks_waits_and_memory_stays_bounded() -> None:
    session = Session()
    for line in ("DEF P", "L", 'WRITE"ABCDEFGHIJ"', "VAR1=VAR1+1", "LN", "END"):
        session.ask(line)
    send(session, XOFF + "P\r")
    session.advance(5.0)
    said = session.unit.controller.variables.number(1)
    assert 90 <= said <= 101, "a thousand characters wait, then the program does"
    send(session, "1TPE\r", channel=1)
    session.advance(1.0)
    assert session.unit.controller.variables.number(1) == said
    send(session, XON)
    session.advance(1.0)
    assert session.unit.controller.variables.number(1) > said


def test_more_input_of_a_host_that_has_stopped_us_stays_on_the_wire() -> None:
    session = Session()
    send(session, XOFF)
    assert not session.unit.controller.input_full(0)
    send(session, "1TPE\r" * 100)
    assert session.unit.controller.input_full(0)
    assert not session.unit.controller.input_full(1)
    send(session, XON)
    assert not session.unit.controller.input_full(0)


def test_power_off_forgets_who_had_stopped_us() -> None:
    session = Session()
    send(session, XOFF + "1TPE\r")
    session.unit.do("cut_power")
    session.unit.do("restore_power")
    assert session.read() == session.sign_on
    assert not session.signal("line.held")


def test_characters_are_counted_both_ways() -> None:
    session = Session()
    received, sent = session.number("line.received"), session.number("line.sent")
    session.ask("1TPE")
    assert session.number("line.received") - received == 5
    assert session.number("line.sent") - sent == len("*1TPE+0\r" + OK)
    assert session.signal("line.overruns") == 0

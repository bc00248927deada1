"""The RP240: display, lamps and keys."""

from __future__ import annotations

from decimal import Decimal

import pytest

from emulator.controller.wires.panel_commands import field_text
from tests.controller.session import OK, Session


def fitted(**defaults: str | int) -> Session:
    return Session("[rp240]\nfitted = true\n", **defaults)


def lines(session: Session) -> list[str]:
    return str(session.signal("panel.display")).split("\n")


def press(session: Session, *keys: str) -> None:
    for key in keys:
        session.unit.do("press_key", key=key)


def test_text_is_written_at_the_cursor() -> None:
    session = fitted()
    session.ok("DCLEAR0", "DPCUR2,10", 'DWRITE"Hello"', "DPCUR1,38", 'DWRITE"abc"')
    assert lines(session) == [" " * 38 + "ab", " " * 10 + "Hello" + " " * 25]


def test_one_line_is_cleared() -> None:
    session = fitted()
    session.ok("DCLEAR0", 'DWRITE"one"', "DPCUR2,0", 'DWRITE"two"', "DCLEAR1")
    assert lines(session) == [" " * 40, "two".ljust(40)]


def test_variables_and_lamps() -> None:
    session = fitted()
    session.ok("VAR3=-12.345", "DCLEAR0", "DVAR3,4,2,1", "DLED1X1")
    assert lines(session)[0].rstrip() == "  -12.34"
    assert session.signal("panel.leds") == "10100000"


@pytest.mark.parametrize(
    ("value", "whole", "decimals", "signed", "text"),
    [
        ("5", 3, 0, False, "  5"),
        ("5", 3, 2, True, "  +5.00"),
        ("-5.999", 1, 1, True, "-5.9"),
        ("1234", 3, 0, False, "***"),
        ("0", 1, 0, False, "0"),
    ],
)
def test_number_fields(value: str, whole: int, decimals: int, signed: bool, text: str) -> None:
    assert field_text(Decimal(value), whole=whole, decimals=decimals, signed=signed) == text


def test_dread_takes_what_is_keyed_in() -> None:
    session = fitted()
    assert session.ask("VAR1=DREAD", wait_s=0.1) == ""
    press(session, "1", "2", ".", "5", "+/-")
    assert session.read() == ""
    press(session, "ENTER")
    assert session.read() == OK
    assert session.query("VAR1") == "VAR1=-12.5"
    assert not session.system_bit(20)


def test_clear_entry_begins_anew() -> None:
    session = fitted()
    session.ask("VAR1=DREAD")
    press(session, "9", "9", "C/E", "7", "ENTER")
    assert session.look("VAR1") == "VAR1=+7.0"


def test_function_keys_are_numbered() -> None:
    session = fitted()
    for number in range(1, 7):
        session.ask("VAR1=DREADF")
        press(session, f"F{number}")
        assert session.look("VAR1") == f"VAR1=+{number}.0"


def test_immediate_read_takes_the_last_entry() -> None:
    session = fitted()
    press(session, "4", "2", "ENTER", "F3")
    session.ok("DREADI1", "VAR1=DREAD", "VAR2=DREADF")
    assert session.query("VAR1") == "VAR1=+42.0"
    assert session.query("VAR2") == "VAR2=+3.0"


def test_an_entry_after_kill_goes_nowhere() -> None:
    session = fitted()
    session.ok("VAR1=5")
    session.ask("VAR1=DREAD")
    session.ask("!K")
    press(session, "8", "ENTER")
    assert session.look("VAR1") == "VAR1=+5.0"


@pytest.mark.parametrize(("allowed", "moves"), [(1, False), (0, True)])
def test_the_stop_key_can_be_taken_away(allowed: int, moves: bool) -> None:
    session = fitted(COMEXC=1, DSTP=allowed)
    session.ok("DRIVE1", "MC1", "GO1", wait_s=0.3)
    press(session, "STOP")
    session.advance(1)
    assert session.signal("axis1.moving") is moves


def test_pause_and_continue_keys() -> None:
    session = fitted()
    press(session, "PAUSE")
    assert session.ask("OUT1", wait_s=0.1) == ""
    press(session, "CONTINUE")
    assert session.read() == OK


@pytest.mark.parametrize(("key", "axis", "sign"), [("RIGHT", 1, 1), ("LEFT", 1, -1), ("UP", 2, 1), ("DOWN", 2, -1)])
def test_arrow_keys_jog_while_held(key: str, axis: int, sign: int) -> None:
    session = fitted()
    session.ok("DRIVE11", "JOGVL2,2", "JOG11", "DJOG1")
    press(session, key)
    session.advance(0.5)
    assert session.number(f"axis{axis}.velocity.commanded") == sign * 8000
    session.unit.do("release_key", key=key)
    session.advance(1)
    assert session.number(f"axis{axis}.velocity.commanded") == 0


def test_arrow_keys_rest_without_djog() -> None:
    session = fitted()
    session.ok("DRIVE1", "JOGVL2,2", "JOG1")
    press(session, "RIGHT")
    session.advance(0.5)
    assert session.number("axis1.velocity.commanded") == 0


def test_keys_there_are_not() -> None:
    with pytest.raises(KeyError, match="no operator panel"):
        press(Session(), "F1")
    with pytest.raises(KeyError, match="no key"):
        press(fitted(), "F9")


def test_the_menu_greets_at_power_up() -> None:
    session = fitted()
    assert "OEM6250" in lines(session)[0]
    assert all(word in lines(session)[1] for word in ("RUN", "JOG", "STATUS", "DRIVE", "DISPLAY", "ETC"))


@pytest.mark.parametrize("start", ["GO1", "GOL1"])
@pytest.mark.parametrize("after_s", [0.05, 1.0])
def test_a_second_pause_in_the_pause_loses_nothing(start: str, after_s: float) -> None:
    session = fitted(COMEXC=1, COMEXR=1)
    session.ok("DRIVE11", "SMPER0,0", "A10", "AD5", "PA10", "PAD5", "V2", "PV2", "D16000", start, wait_s=0.0)
    session.advance(0.5)
    press(session, "PAUSE")
    session.advance(after_s)
    press(session, "PAUSE")
    session.advance(1.0)
    assert not session.signal("axis1.moving")
    press(session, "CONTINUE")
    session.until_rest()
    assert session.position() == 16_000

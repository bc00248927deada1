"""Answers byte for byte as host programs of the family met or documented them, each from a peer that plays just that.

The hosts: EPICS parker6k and PC6K drivers, Diamond's GDA, a C host of ZETA6104 chains, RapidForm with a ZETA, the
GeminiMotorDrive package, a captured Aries session.
"""

from __future__ import annotations

import pytest

from clients import OEM6250, UnitError
from tests.clients.peers import Answers, FamilyUnit, ScriptedLine


def peer(unit: FamilyUnit, said: dict[bytes, bytes]) -> ScriptedLine:
    """A unit with these answers, and the family's for what else connecting asks."""

    def answer(data: bytes) -> Answers:
        return [(0.004, said[data])] if data in said else unit.answer(data)

    return ScriptedLine(answer)


IDLE = "0000_0000_0000_1000_0000_0001_0000_0000"
QUIET, ECHOING = FamilyUnit(echo=False), FamilyUnit()
NO_PROMPTS = FamilyUnit(eot=b"\n", eol=b"\r", good=b"", bad=b"", lead=b"", echo_end=b"\r")

REPLIES = [
    ("EPICS, encoder position", QUIET, "1TPE", b"*1TPE+0\r\r\n> ", "+0"),
    ("EPICS, commanded position", QUIET, "1TPC", b"*1TPC-1234\r\r\n> ", "-1234"),
    ("EPICS, axis status", QUIET, "1TAS", f"*1TAS{IDLE}\r\r\n> ".encode(), IDLE),
    ("EPICS, limits enabled", QUIET, "1LH", b"*1LH3\r\r\n> ", "3"),
    ("EPICS, soft limit", QUIET, "1LSPOS", b"*1LSPOS+0\r\r\n> ", "+0"),
    ("EPICS, encoder resolution", QUIET, "1ERES", b"*1ERES4000\r\r\n> ", "4000"),
    ("EPICS, echo", QUIET, "ECHO", b"*ECHO0\r\r\n> ", "0"),
    ("PC6K, a late blank of the prompt before", QUIET, "1TPE", b" *1TPE+7\r\r\n> ", "+7"),
    ("PC6K, a whole late prompt before", QUIET, "1TPE", b"\r\n> *1TPE+7\r\r\n> ", "+7"),
    ("ZETA6104, one bit", QUIET, "!tas.15", b"*0\r\r\n> ", "0"),
    ("echo after the prompt before", ECHOING, "TPE", b"\r\n> TPE\r\n*TPE+0,+0\r\r\n> ", "+0,+0"),
    ("Gemini, EOL13 and EOT10", NO_PROMPTS, "DRIVE", b"DRIVE\r*DRIVE1\n", "1"),
    ("Gemini, bare CR echoed", FamilyUnit(echo_end=b"\r"), "DRIVE", b"DRIVE\r*DRIVE1\r\r\n> ", "1"),
    ("lower case comes back in capitals", ECHOING, "1tpe", b"1TPE\r\n*1TPE+3\r\r\n> ", "+3"),
]


@pytest.mark.parametrize(
    ("unit", "query", "said", "value"), [row[1:] for row in REPLIES], ids=[row[0] for row in REPLIES]
)
def test_a_reply(unit: FamilyUnit, query: str, said: bytes, value: str) -> None:
    ctl = OEM6250(peer(unit, {query.encode() + b"\r": said}))
    assert ctl.query(query) == value


@pytest.mark.parametrize("query", ["1TPE", "!1TPE"])
def test_a_unit_s_address_is_not_in_its_reply(query: str) -> None:
    ctl = OEM6250(peer(QUIET, {f"0_{query}\r".encode(): b"*1TPE+0\r\r\n> "}), address=0)
    assert ctl.query(query) == "+0"


def test_the_captured_session_of_an_aries() -> None:
    ctl = OEM6250(peer(ECHOING, {b"TREV\r": b"TREV\r\n*TREV92-016740-01-5.0 OEM6250\r\r\n> "}))
    assert ctl.send("TREV").lines == ("TREV92-016740-01-5.0 OEM6250",)
    assert ctl.query("TREV") == "92-016740-01-5.0 OEM6250"


def test_a_reply_of_several_lines_is_left_as_it_came() -> None:
    ctl = OEM6250(peer(ECHOING, {b"TGAIN\r": b"TGAIN\r\n*SGP1,2\r\n*SGV3,4\r\r\n> "}))
    answer = ctl.send("TGAIN")
    assert (answer.value, answer.lines) == ("SGP1,2\r\n*SGV3,4", ("SGP1,2", "SGV3,4"))


REFUSALS = [
    ("GDA and EPICS, text after the echo", QUIET, "XXX", b"*UNDEFINED LABEL\r\r\n? ", "UNDEFINED LABEL"),
    ("Gem6K manual, CR LF before the text", QUIET, "XXX", b"\r\n*UNDEFINED LABEL\r\r\n? ", "UNDEFINED LABEL"),
    ("Gemini, underscores", ECHOING, "XXX", b"XXX\r\n*UNDEFINED_LABEL\r\r\n? ", "UNDEFINED_LABEL"),
    ("PC6K, an axis that is not there", QUIET, "3TPC", b"*INCORRECT AXIS\r\r\n? ", "INCORRECT AXIS"),
    ("EPICS, GO with the drive off", QUIET, "1GO", b"*DRIVE SHUTDOWN\r\r\n? ", "DRIVE SHUTDOWN"),
]


@pytest.mark.parametrize(
    ("unit", "line", "said", "text"), [row[1:] for row in REFUSALS], ids=[row[0] for row in REFUSALS]
)
def test_a_refusal(unit: FamilyUnit, line: str, said: bytes, text: str) -> None:
    ctl = OEM6250(peer(unit, {line.encode() + b"\r": said}))
    with pytest.raises(UnitError) as refusal:
        ctl.send(line)
    assert (refusal.value.text, refusal.value.command) == (text, line)


def test_a_setting_is_confirmed_by_the_prompt_alone() -> None:
    line = peer(QUIET, {b"1D5000\r": b"\r\n> ", b"\r": b"\r\n> "})
    ctl = OEM6250(line)
    assert ctl.send("1D5000").prompt == "good"
    assert ctl.send("").prompt == "good"


def test_four_settings_in_one_line_draw_four_prompts() -> None:
    """As RapidForm counts them."""
    ctl = OEM6250(peer(QUIET, {b"A8:V8:MA1:D100\r": b"\r\n> " * 4, b"1TPE\r": b"*1TPE+1\r\r\n> "}))
    ctl.send("A8:V8:MA1:D100")
    assert ctl.query("1TPE") == "+1"


def test_a_definition_has_a_prompt_of_its_own() -> None:
    said = {b"DEF A\r": b"\r\n- ", b"D5\r": b"\r\n- ", b"END\r": b"\r\n> "}
    ctl = OEM6250(peer(QUIET, said))
    assert [ctl.send(line).prompt for line in ("DEF A", "D5", "END")] == ["defining", "defining", "good"]

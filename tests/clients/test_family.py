"""The client against units of the family as other people's host programs saw them (their byte streams, not ours)."""

from __future__ import annotations

import pytest

from clients import OEM6250, Garbled, NoAnswer, UnitError
from tests.clients.peers import Answers, FamilyUnit, ScriptedLine

IDLE = "0000_0000_0000_1000_0000_0001_0000_0000"
VALUES = {"1TPE": "+0", "1TAS": IDLE, "TAS.1": "0", "1V": "1.0000", "1DRIVE": "1"}

ZETA = FamilyUnit(echo=False, values=VALUES)
ARIES = FamilyUnit(values=VALUES)
GEMINI_ECHO = FamilyUnit(values=VALUES, echo_end=b"\r", lead=b"")
GEMINI_DRIVE = FamilyUnit(values=VALUES, eot=b"\n", eol=b"\r", good=b"", bad=b"", lead=b"", echo_end=b"\r")
GONIOSTAT = FamilyUnit(values=VALUES, level=0, eot=b"\r\n")
MX = FamilyUnit(values=VALUES, level=1, echo=False)
NAMES_ONLY = FamilyUnit(values=VALUES, level=2)
NO_END = FamilyUnit(values=VALUES, eot=b"")
BEGINS = FamilyUnit(values=VALUES, bot=b"\x02", eot=b"\x03")
UNITS = {
    "zeta after ECHO0": ZETA,
    "echo with CR LF": ARIES,
    "echo with bare CR, error without lead": GEMINI_ECHO,
    "GeminiMotorDrive's framing, no prompts": GEMINI_DRIVE,
    "ERRLVL0 EOT13,10,0 ECHO1": GONIOSTAT,
    "ERRLVL1": MX,
    "ERRLVL2": NAMES_ONLY,
    "EOT0": NO_END,
    "BOT and EOT": BEGINS,
}


@pytest.mark.parametrize("cut", [0, 1, 3])
@pytest.mark.parametrize("name", UNITS)
def test_connects_asks_and_sets(name: str, cut: int) -> None:
    unit = UNITS[name]
    unit = FamilyUnit(**{**vars(unit), "cut": cut})
    ctl = OEM6250(unit.line())
    link = ctl.session.link
    assert (link.echo, link.level, link.framing.eot, link.framing.bot) == (unit.echo, unit.level, unit.eot, unit.bot)
    assert ctl.axis[1].position == 0
    assert ctl.axis[1].velocity == 1.0
    assert ctl.axis[1].drive_enabled
    assert ctl.status.axis(1).in_target_zone
    assert ctl.query("!TAS.1") == "0"
    ctl.axis[1].velocity = 5.0
    assert ctl.changed == ()


@pytest.mark.parametrize("name", [name for name, unit in UNITS.items() if unit.level == 4])
def test_a_refusal_carries_the_unit_s_words_and_the_command(name: str) -> None:
    ctl = OEM6250(UNITS[name].line())
    with pytest.raises(UnitError, match="UNDEFINED LABEL") as refusal:
        ctl.send("BADNAME")
    assert (refusal.value.text, refusal.value.command) == ("UNDEFINED LABEL", "BADNAME")
    assert ctl.axis[1].position == 0


def test_the_sign_on_and_stale_prompts_are_no_answers() -> None:
    line = ARIES.line(b"*PARKER OEM6250 MOTION CONTROLLER\r\n*NO REMOTE PANEL\r\r\n> \r\n> ")
    ctl = OEM6250(line)
    assert ctl.axis[1].position == 0
    assert "PARKER" in ctl.take_output()


def unit_saying(special: dict[bytes, bytes]) -> ScriptedLine:
    """A ZETA after ECHO0 with other words for some commands."""

    def answer(data: bytes) -> Answers:
        return [(0.004, special[data])] if data in special else ZETA.answer(data)

    return ScriptedLine(answer)


@pytest.mark.parametrize(
    "reply",
    [
        b"\r\n> *1TPE+1234\r\r\n> ",
        b"*1T\r\n> PE+1234\r\r\n> ",
        b"*1TPE+12\r\n> 34\r\r\n> ",
        b"*1TPE+1234\r\n> \r\r\n> ",
        b"*1TPE+1234\r\r\n> \r\n> ",
        b"HELLO*1TPE+1234\r\r\n> ",
    ],
)
def test_a_prompt_of_an_earlier_command_in_the_middle_of_a_reply(reply: bytes) -> None:
    ctl = OEM6250(unit_saying({b"!1TPE\r": reply}))
    assert ctl.axis[1].position == 1234
    assert ctl.axis[1].velocity == 1.0


def test_the_answer_to_another_question_is_none() -> None:
    ctl = OEM6250(unit_saying({b"!1TPE\r": b"*1TPC+7\r\r\n> "}), retries=0)
    with pytest.raises(Garbled, match=r"expected a reply \*1TPE"):
        ctl.axis[1].position  # noqa: B018


@pytest.mark.parametrize("garbage", [b"\x00\xff" * 40, b"*1TPE+1x\r\r\n> ", b"login: ", b"*" * 500])
def test_garbage_is_garbled_and_says_what_came(garbage: bytes) -> None:
    ctl = OEM6250(unit_saying({b"!1TPE\r": garbage}), retries=0)
    with pytest.raises(Garbled, match="baud rate") as failure:
        ctl.axis[1].position  # noqa: B018
    assert failure.value.received == garbage.replace(b"\x00", b"")


def test_no_answer_says_what_was_expected_and_what_to_try() -> None:
    ctl = OEM6250(unit_saying({b"!1TPE\r": b""}), timeout_s=0.5)
    with pytest.raises(NoAnswer, match=r"expected a reply \*1TPE.*came nothing.*baud rate"):
        ctl.axis[1].position  # noqa: B018
    assert ctl.axis[1].velocity == 1.0


def test_a_query_is_asked_again_a_setting_is_not() -> None:
    lost = {b"!1TPE\r", b"!1V3\r"}

    def answer(data: bytes) -> Answers:
        if data in lost:
            lost.discard(data)
            return []
        return ZETA.answer(data)

    line = ScriptedLine(answer)
    ctl = OEM6250(line)
    assert ctl.axis[1].position == 0
    with pytest.raises(NoAnswer):
        ctl.axis[1].velocity = 3
    assert line.sent.count(b"!1TPE\r") == 2
    assert line.sent.count(b"!1V3\r") == 1


def test_a_wrong_port_that_says_nothing() -> None:
    line = ScriptedLine(lambda data: [])
    with pytest.raises(NoAnswer, match="expected an answer to '!ERRLVL'; came nothing; is it the unit's port"):
        OEM6250(line)
    assert line.clock() < 5.0


def test_a_wrong_port_that_echoes_only() -> None:
    with pytest.raises(Garbled, match="only its echo came"):
        OEM6250(ScriptedLine(lambda data: [(0.0, data)]))


def test_a_wrong_port_that_never_stops_talking() -> None:
    def chatter(data: bytes) -> Answers:
        return [(0.01 * n, b"$GPGGA,123519,4807.038,N\r\n") for n in range(3000)]

    line = ScriptedLine(chatter)
    with pytest.raises(Garbled, match="6000 Series"):
        OEM6250(line)
    assert line.clock() < 12.0


def test_chained_units_have_each_their_own_settings() -> None:
    """As a C host of ZETA6104 chains talks: `1_TPE`, ERRLVL1, echo with its LF."""
    units = {b"1": FamilyUnit(level=1, values={"1TPE": "+11"}), b"2": FamilyUnit(level=1, values={"1TPE": "+22"})}

    def answer(data: bytes) -> Answers:
        return units[data.lstrip(b"\x08")[:1]].answer(data)

    line = ScriptedLine(answer)
    first = OEM6250(line, address=1)
    second = first.unit(2)
    assert (first.axis[1].position, second.axis[1].position, first.axis[1].position) == (11, 22, 11)
    assert line.sent[-1] == b"1_!1TPE\r"

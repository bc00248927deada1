"""Full-text status reports byte for byte, as settled section 5 lays them out."""

from __future__ import annotations

import pytest

from protocol.catalogue import status_words
from protocol.reply import LEVEL_RULES, Framing, ReplyLine
from protocol.status_report import LABEL_WIDTH, bit_labels, status_table

IDLE = "00000000000010000000000100000000"
MOVING_NEGATIVE = "11110000000000000000000000000000"

TASF_BOTH_AXES = """\
*TASF
*                       AXIS #
*                       1   2
*Moving                 NO  YES
*Direction NEG          NO  YES
*Accelerating           NO  YES
*At Velocity            NO  YES
*
*Home Successful        NO  NO
*Mode Absolute          NO  NO
*Mode Continuous        NO  NO
*Jog Mode               NO  NO
*
*Joystick Mode          NO  NO
*Encoder Step Mode      NO  NO
*Position Maint ON      NO  NO
*Stall Detected         NO  NO
*
*Drive Shutdown         YES NO
*Drive Faulted          NO  NO
*POS Hard Limit Hit     NO  NO
*NEG Hard Limit Hit     NO  NO
*
*POS Sftwr Limit Hit    NO  NO
*NEG Sftwr Limit Hit    NO  NO
*Within Deadband        NO  NO
*In Position            NO  NO
*
*Distance Streaming     NO  NO
*Velocity Streaming     NO  NO
*Pos Error Exceeded     NO  NO
*In Target Zone         YES NO
*
*Target Zone Timeout    NO  NO
*Gowhen is Pending      NO  NO
*LDT Read Error         NO  NO
*Reg Move Commanded     NO  NO
*
*RESERVED               NO  NO
*Preset Move Overshot   NO  NO
*RESERVED               NO  NO
*RESERVED               NO  NO"""

TINOF = """\
*TINOF
*Joystick Auxiliary     NO
*Joystick Trigger       NO
*Joystick Axes Select   NO
*Joystick Vel Select    NO
*
*Joystick Release       NO
*Enable Input           YES
*RESERVED               NO
*RESERVED               NO"""


def sent(lines: list[ReplyLine]) -> list[str]:
    return Framing().reply(lines).decode("ascii").removesuffix("\r").split("\r\n")


def labels(word: str, count: int = 32) -> list[str]:
    return bit_labels(status_words()[word], count)


def test_tasf_for_both_axes() -> None:
    lines = status_table("TASF", labels("AS"), [IDLE, MOVING_NEGATIVE], axes=(1, 2))
    assert sent(lines) == TASF_BOTH_AXES.split("\n")


def test_tasf_for_one_axis() -> None:
    lines = sent(status_table("1TASF", labels("AS"), [IDLE], axes=(1,)))
    assert lines[:5] == [
        "*1TASF",
        "*                       AXIS #",
        "*                       1",
        "*Moving                 NO",
        "*Direction NEG          NO",
    ]
    assert "*Drive Shutdown         YES" in lines
    assert len(lines) == 3 + 32 + 7


def test_a_word_of_the_whole_unit_has_no_header() -> None:
    lines = sent(status_table("TSSF", labels("SS"), ["1000110000000000" + "0" * 16], axes=None))
    assert lines[:6] == [
        "*TSSF",
        "*System Ready           YES",
        "*RESERVED               NO",
        "*Executing Program      NO",
        "*Immediate Command      NO",
        "*",
    ]
    assert len(lines) == 1 + 32 + 7


def test_tinof() -> None:
    assert sent(status_table("TINOF", labels("INO", 8), ["00000100"], axes=None)) == TINOF.split("\n")


@pytest.mark.parametrize(("word", "count"), [("AS", 32), ("ASX", 32), ("SS", 32), ("ER", 32), ("FS", 32), ("INO", 8)])
def test_every_label_leaves_room_for_the_values(word: str, count: int) -> None:
    texts = labels(word, count)
    assert len(texts) == count
    assert all(0 < len(text) < LABEL_WIDTH for text in texts)


def test_bits_without_an_entry_are_reserved() -> None:
    assert labels("ASX")[6:] == ["RESERVED"] * 26
    assert labels("US", 16) == ["RESERVED"] * 16


def test_no_bare_line_after_the_last_group_of_four() -> None:
    lines = status_table("T", ["A"] * 8, ["0" * 8], axes=None)
    assert [line.value for line in lines].count("") == 1
    assert lines[-1].value


@pytest.mark.parametrize("level", range(5))
def test_no_line_ends_in_a_blank_at_any_level(level: int) -> None:
    lines = status_table("TASF", labels("AS"), [IDLE, IDLE], axes=(1, 2))
    data = Framing(rules=LEVEL_RULES[level]).reply(lines)
    assert not any(line.endswith(b" ") for line in data.split(b"\r\n"))
    assert data.endswith(b"NO\r")

"""Replies, error texts and prompts byte for byte, at each error level and with the framing changed."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.catalogue import lookup
from protocol.errors import ReplyError
from protocol.fields import default_values
from protocol.reply import (
    LEVEL_RULES,
    NULL_CODE,
    Framing,
    ReplyLine,
    bits_word,
    character_codes,
    group_bits,
    ungroup_bits,
    word_bits,
)

POSITION = ReplyLine("1TPE", "+0")


def at_level(level: int) -> Framing:
    return Framing(rules=LEVEL_RULES[level])


@pytest.mark.parametrize(
    ("level", "reply", "error", "good", "bad", "defining"),
    [
        (4, b"*1TPE+0\r", b"\r\n*INVALID DATA\r", b"\r\n> ", b"\r\n? ", b"\r\n- "),
        (3, b"*1TPE+0\r", b"", b"\r\n> ", b"\r\n? ", b"\r\n- "),
        (2, b"*1TPE+0\r", b"", b"", b"\r\n? ", b""),
        (1, b"*+0\r", b"", b"", b"", b""),
        (0, b"+0\r", b"", b"", b"", b""),
    ],
)
def test_what_each_error_level_sends(
    level: int, reply: bytes, error: bytes, good: bytes, bad: bytes, defining: bytes
) -> None:
    framing = at_level(level)
    assert framing.reply([POSITION]) == reply
    assert framing.error("INVALID DATA") == error
    assert framing.prompt(good=True) == good
    assert framing.prompt(good=False) == bad
    assert framing.prompt(good=True, defining=True) == defining
    assert framing.prompt(good=False, defining=True) == bad


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (POSITION, b"*1TPE+0\r\r\n> "),
        (ReplyLine("1TPC", "+0"), b"*1TPC+0\r\r\n> "),
        (ReplyLine("", "0"), b"*0\r\r\n> "),
        (ReplyLine("DRIVE", "00"), b"*DRIVE00\r\r\n> "),
        (ReplyLine("EOT", "13,0,0"), b"*EOT13,0,0\r\r\n> "),
    ],
)
def test_a_whole_answer_with_the_defaults(line: ReplyLine, expected: bytes) -> None:
    framing = Framing()
    assert framing.reply([line]) + framing.prompt(good=True) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("INCORRECT AXIS", b"\r\n*INCORRECT AXIS\r\r\n? "),
        ("UNDEFINED LABEL", b"\r\n*UNDEFINED LABEL\r\r\n? "),
        ("INVALID DATA", b"\r\n*INVALID DATA\r\r\n? "),
    ],
)
def test_a_whole_refusal_with_the_defaults(text: str, expected: bytes) -> None:
    framing = Framing()
    assert framing.error(text) + framing.prompt(good=False) == expected


def test_level_one_with_carriage_return_line_feed_as_a_beam_line_driver_sets_it() -> None:
    framing = Framing(eot=character_codes((13, 10, 0)), rules=LEVEL_RULES[1])
    assert framing.reply([ReplyLine("1V", "1.0000")]) + framing.prompt(good=True) == b"*1.0000\r\n"
    assert framing.reply([ReplyLine("TSS", "0000_0000")]) == b"*0000_0000\r\n"
    assert framing.reply([ReplyLine("", "0")]) == b"*0\r\n"


def test_several_lines_have_eol_between_them_and_eot_after_the_last() -> None:
    lines = [ReplyLine("1TAS", "0000"), ReplyLine("2TAS", "1000"), ReplyLine("", "")]
    assert Framing().reply(lines) == b"*1TAS0000\r\n*2TAS1000\r\n*\r"
    assert at_level(1).reply(lines) == b"*0000\r\n*1000\r\n*\r"
    assert at_level(0).reply(lines) == b"0000\r\n1000\r\n\r"


def test_every_framing_character_is_programmable() -> None:
    framing = Framing(
        bot=b"<",
        eol=b"/",
        eot=b">",
        good_prompt=b"OK",
        bad_prompt=b"BAD",
        defining_prompt=b"DEF",
        error_lead=b"!",
    )
    assert framing.reply([ReplyLine("A", "1"), ReplyLine("B", "2")]) == b"<*A1/*B2>"
    assert framing.error("NO") == b"<!*NO>"
    assert framing.prompt(good=True) == b"OK"
    assert framing.prompt(good=False) == b"BAD"
    assert framing.prompt(good=True, defining=True) == b"DEF"


@pytest.mark.parametrize("level", range(5))
def test_the_frame_is_sent_at_every_level(level: int) -> None:
    framing = Framing(bot=b"<", eot=b">", rules=LEVEL_RULES[level])
    data = framing.reply([POSITION])
    assert data.startswith(b"<") and data.endswith(b"+0>")


@pytest.mark.parametrize(
    ("codes", "sent"),
    [
        ((13, 10, 0), b"\r\n"),
        ((13, 0, 0), b"\r"),
        ((0, 0, 0), b""),
        ((0, 10, 0), b"\n"),
        ((NULL_CODE, 0, 0), b"\0"),
        ((13, NULL_CODE, 10), b"\r\0\n"),
        ((13, 10, 62, 32), b"\r\n> "),
        ((255, 1, 128), b"\xff\x01\x80"),
    ],
)
def test_character_codes(codes: tuple[int, ...], sent: bytes) -> None:
    assert character_codes(codes) == sent


@pytest.mark.parametrize(
    ("name", "attribute"),
    [
        ("BOT", "bot"),
        ("EOL", "eol"),
        ("EOT", "eot"),
        ("ERROK", "good_prompt"),
        ("ERRBAD", "bad_prompt"),
        ("ERRDEF", "defining_prompt"),
    ],
)
def test_the_framing_at_power_up_is_what_the_catalogue_says(name: str, attribute: str) -> None:
    row = lookup(name)
    assert row is not None
    assert character_codes([int(value) for value in default_values(row)]) == getattr(Framing(), attribute)


@pytest.mark.parametrize(
    ("bits", "size", "text"),
    [
        ("00001000", 4, "0000_1000"),
        ("110110", 3, "110_110"),
        ("0" * 26, 4, "0000_0000_0000_0000_0000_0000_00"),
        ("1", 4, "1"),
        ("XXXXE", 4, "XXXX_E"),
    ],
)
def test_bits_in_groups(bits: str, size: int, text: str) -> None:
    assert group_bits(bits, size) == text
    assert ungroup_bits(text, size) == bits


@pytest.mark.parametrize(
    "text", ["", "_", "0000_", "_0000", "00_00", "0000__0000", "00000000", "0002", "0000 0000", "+0"]
)
def test_what_is_not_in_groups_is_a_reply_error(text: str) -> None:
    with pytest.raises(ReplyError):
        ungroup_bits(text)


@settings(deadline=None)
@given(bits=st.text("01XE", min_size=1, max_size=40), size=st.integers(1, 8))
def test_ungrouping_undoes_grouping(bits: str, size: int) -> None:
    assert ungroup_bits(group_bits(bits, size), size) == bits


@settings(deadline=None)
@given(text=st.text(max_size=30))
def test_any_text_is_a_pattern_or_a_reply_error(text: str) -> None:
    with suppress(ReplyError):
        assert group_bits(ungroup_bits(text)) == text


def test_bit_one_is_the_least_significant_and_printed_first() -> None:
    assert word_bits(0b1, 4) == "1000" and word_bits(1 << 31, 32) == "0" * 31 + "1"
    assert bits_word("1000") == 1 and bits_word("0XX1") == 8


@settings(deadline=None)
@given(word=st.integers(0, 2**32 - 1))
def test_words_and_bits(word: int) -> None:
    bits = word_bits(word, 32)
    assert len(bits) == 32 and bits_word(bits) == word
    assert all((bits[number - 1] == "1") == bool(word >> (number - 1) & 1) for number in range(1, 33))

"""Bytes to commands, against sections 1 and 2 of the language: delimiters, comments, control characters, the limit."""

from __future__ import annotations

import time
import tracemalloc
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.line import BLANKS_KEPT_PER_CHARACTER, DEFAULT_MAX_COMMAND, LineAssembler, Token, TokenKind
from tests.protocol.connection_pair import ConnectionPair, assembled

COMMAND, EMPTY_LINE, EMPTY = TokenKind.COMMAND, TokenKind.EMPTY_LINE, TokenKind.EMPTY
TOO_LONG, KILL, CHARACTERS = TokenKind.TOO_LONG, TokenKind.KILL, TokenKind.CHARACTERS
MAX_KEPT = DEFAULT_MAX_COMMAND * BLANKS_KEPT_PER_CHARACTER
MEGABYTE = 1 << 20

Seen = list[tuple[TokenKind, str]]


def seen(data: bytes, max_command: int = DEFAULT_MAX_COMMAND) -> Seen:
    return [(token.kind, token.text) for token in ConnectionPair(max_command=max_command).host_sends(data)]


def echoed(data: bytes) -> bytes:
    return b"".join(token.echo for token in ConnectionPair().host_sends(data))


@pytest.mark.parametrize("terminator", [b"\r", b"\n", b"\r\n", b"\r\x00", b"\r\x00\n", b"\r\x11\n", b"\r\x13\n"])
def test_one_terminator_ends_one_command(terminator: bytes) -> None:
    assert seen(b"A10" + terminator + b"V5" + terminator) == [(COMMAND, "A10"), (COMMAND, "V5")]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"\r", [(EMPTY_LINE, "")]),
        (b"\n", [(EMPTY_LINE, "")]),
        (b"\r\n", [(EMPTY_LINE, "")]),
        (b"\r\n\r\n", [(EMPTY_LINE, "")] * 2),
        (b"A10\r\n\r\n", [(COMMAND, "A10"), (EMPTY_LINE, "")]),
        (b"A10\n\r", [(COMMAND, "A10"), (EMPTY_LINE, "")]),
        (b"A10\n\n", [(COMMAND, "A10"), (EMPTY_LINE, "")]),
        (b"A10\r \n", [(COMMAND, "A10"), (EMPTY_LINE, "")]),
        (b" \t \r", [(EMPTY_LINE, "")]),
        (b"A10", []),
    ],
)
def test_empty_lines(data: bytes, expected: Seen) -> None:
    assert [pair for pair in seen(data) if pair[0] is not CHARACTERS] == expected


@pytest.mark.parametrize(
    ("data", "texts"),
    [
        (b"MA1: A20: V25: D25000: GO\r", ["MA1", "A20", "V25", "D25000", "GO"]),
        (b"!comexc1:\r", ["!comexc1"]),
        (b"MC000000:MA110000:COMEXC0:\r", ["MC000000", "MA110000", "COMEXC0"]),
        (b"::A10::\r", ["A10"]),
    ],
)
def test_colons_part_commands_and_empty_ones_between_them_say_nothing(data: bytes, texts: list[str]) -> None:
    kinds_and_texts = seen(data)
    assert [text for kind, text in kinds_and_texts if kind is COMMAND] == texts
    assert EMPTY_LINE not in [kind for kind, _ in kinds_and_texts]


def test_only_the_last_command_of_a_line_ends_it() -> None:
    tokens = ConnectionPair().host_sends(b"A10:V5\r")
    assert tokens == [Token(COMMAND, b"A10", False, "A10", b":"), Token(COMMAND, b"V5", True, "V5", b"\r")]


@pytest.mark.parametrize("delimiter", [b"\r", b"\n", b":"])
@pytest.mark.parametrize("command", [b"A10", b"", b"A" * 101], ids=["command", "nothing", "too long"])
def test_a_token_says_what_ended_it(command: bytes, delimiter: bytes) -> None:
    assert ConnectionPair().host_sends(command + delimiter)[0].delimiter == delimiter


def test_the_swallowed_line_feed_ends_nothing() -> None:
    assert [token.delimiter for token in ConnectionPair().host_sends(b"A10\r\nV5\r\n")] == [b"\r", b"\r"]


def test_a_line_after_a_colon_line_is_empty_again() -> None:
    assert seen(b"A10:\r\r") == [(COMMAND, "A10"), (EMPTY, ""), (EMPTY_LINE, "")]


@pytest.mark.parametrize(
    ("data", "texts"),
    [
        (b"A10;fast: V5; slow\rV5\r", ["A10", "V5"]),
        (b"A10 ;fast\nV5\n", ["A10", "V5"]),
        (b"A10:V5;both: set\r\nGO\r\n", ["A10", "V5", "GO"]),
        (b"A10;" + b"x" * 5000 + b"\rV5\r", ["A10", "V5"]),
        (b"A10;\x00\b\b\b\rV5\r", ["A10", "V5"]),
    ],
)
def test_a_comment_runs_to_the_end_of_the_line(data: bytes, texts: list[str]) -> None:
    assert seen(data) == [(COMMAND, text) for text in texts]


def test_a_line_with_nothing_but_a_comment_is_empty() -> None:
    assert seen(b"; set up: the axes\r") == [(EMPTY_LINE, "")]


def test_nul_is_ignored_and_not_echoed() -> None:
    assert ConnectionPair().host_sends(b"\0T\0PE\0\r") == [Token(COMMAND, b"TPE", True, "TPE", b"\r")]


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"TPX\bE\r", "TPE"),
        (b"\b\bTPE\r", "TPE"),
        (b"XY\b\b\b\bTPE\r", "TPE"),
        (b"T P\b\bPE\r", "TPE"),
        (b"A10:XX\b\b\bTPE\r", "TPE"),
    ],
)
def test_backspace_deletes_within_the_command_only(data: bytes, text: str) -> None:
    assert seen(data)[-1] == (COMMAND, text)


def test_backspace_is_echoed_even_with_nothing_to_delete() -> None:
    assert echoed(b"\b\bTPX\bE\r") == b"\b\bTPX\bE"


def test_flow_control_characters_never_belong_to_a_command() -> None:
    assert ConnectionPair().host_sends(b"T\x13P\x11E\r") == [Token(COMMAND, b"TPE", True, "TPE", b"\r")]


def test_kill_waits_for_no_delimiter_and_leaves_the_command_under_way() -> None:
    assert seen(b"GO\x0b1\r") == [(KILL, "!K"), (COMMAND, "GO1")]
    assert list(LineAssembler().feed(b"\x0b")) == [Token(KILL, b"", False, "!K")]


def test_kill_works_in_a_comment_and_in_a_line_too_long() -> None:
    assert seen(b"A10;text\x0b\r") == [(KILL, "!K"), (COMMAND, "A10")]
    assert seen(b"A" * 200 + b"\x0b\r") == [(KILL, "!K"), (TOO_LONG, "")]


def test_echo_is_upper_case_while_the_text_stays_as_typed() -> None:
    assert ConnectionPair().host_sends(b'write"Hi there"\r') == [
        Token(COMMAND, b'WRITE"HI THERE"', True, 'write"Hi there"', b"\r")
    ]


def test_echo_leaves_delimiters_of_commands_to_the_caller_but_not_those_in_comments() -> None:
    assert echoed(b"a1:b2\r\n") == b"A1B2"
    assert echoed(b"a1;b:c\r\n") == b"A1;B:C"


def test_bytes_beyond_ascii_are_kept_as_they_are() -> None:
    assert ConnectionPair().host_sends(b"\xe9\xff\r") == [Token(COMMAND, b"\xe9\xff", True, "\xe9\xff", b"\r")]


def test_blanks_inside_stay_for_strings_and_blanks_around_go() -> None:
    assert seen(b" \tGO 1\t1 \r") == [(COMMAND, "GO 1\t1")]


def test_the_limit_counts_characters_between_delimiters_without_blanks() -> None:
    longest = "A" * DEFAULT_MAX_COMMAND
    assert seen(longest.encode() + b"\r") == [(COMMAND, longest)]
    assert seen(" ".join(longest).encode() + b"\r") == [(COMMAND, " ".join(longest))]
    assert seen(longest.encode() + b"A\r") == [(TOO_LONG, "")]
    assert seen(longest.encode() + b":" + longest.encode() + b"\r") == [(COMMAND, longest)] * 2


@pytest.mark.parametrize("delimiter", [b"\r", b"\n", b"\r\n", b":"])
def test_a_command_too_long_is_reported_once_and_the_next_is_whole(delimiter: bytes) -> None:
    assert seen(b"X" * 5000 + delimiter + b"TPE\r") == [(TOO_LONG, ""), (COMMAND, "TPE")]


def test_backspace_does_not_save_a_command_already_too_long() -> None:
    assert seen(b"X" * 101 + b"\b" * 101 + b"TPE\rTPC\r") == [(TOO_LONG, ""), (COMMAND, "TPC")]


def test_the_limit_is_a_setting() -> None:
    assert seen(b"ABCDE\rABCDEF\r", max_command=5) == [(COMMAND, "ABCDE"), (TOO_LONG, "")]


def test_clear_forgets_the_half_typed_command() -> None:
    assembler = LineAssembler()
    list(assembler.feed(b"GO;x"))
    assert assembler.pending == 2
    assembler.clear()
    assert assembler.pending == 0
    assert [token.text for token in assembler.feed(b"TPE\r")] == ["TPE"]


def test_tokens_come_one_at_a_time_so_the_caller_can_act_between_them() -> None:
    tokens = LineAssembler().feed(b"ECHO0\rTPE\r")
    assert next(tokens).text == "ECHO0"
    assert next(tokens).text == "TPE"


_BUSY_BYTES = st.lists(
    st.sampled_from([b"A", b"go", b"1", b" ", b"\t", b"\r", b"\n", b":", b";", b"\0", b"\b", b"\x0b", b"\x11", b"\xe9"])
    | st.integers(1, 450).map(lambda count: b"z" * count)
    | st.integers(1, 450).map(lambda count: b" " * count)
    | st.binary(max_size=8),
    max_size=40,
).map(b"".join)


@settings(deadline=None, max_examples=300)
@given(data=_BUSY_BYTES, cuts=st.lists(st.integers(0, 2000), max_size=20))
def test_any_bytes_in_any_packets_give_the_same_tokens(data: bytes, cuts: list[int]) -> None:
    edges = [0, *sorted(min(cut, len(data)) for cut in cuts), len(data)]
    chunks = [data[start:end] for start, end in pairwise(edges)]
    assert assembled(chunks) == ConnectionPair().host_sends(data)


@settings(deadline=None, max_examples=300)
@given(data=_BUSY_BYTES)
def test_whatever_arrives_commands_are_clean_and_memory_is_bounded(data: bytes) -> None:
    assembler = LineAssembler()
    for byte in data:
        for token in assembler.feed(bytes([byte])):
            assert (token.kind is COMMAND) == (bool(token.text) and token.kind is not KILL)
            assert not set(token.text) & set("\r\n:;\0\b\x0b\x11\x13")
            assert len(token.text.replace(" ", "").replace("\t", "")) <= DEFAULT_MAX_COMMAND
        assert assembler.pending <= MAX_KEPT


@settings(deadline=None, max_examples=200)
@given(data=_BUSY_BYTES)
def test_after_anything_a_line_end_brings_the_next_command_through(data: bytes) -> None:
    assert assembled([data, b"\rTPE\r"])[-1] == Token(COMMAND, b"TPE", True, "TPE", b"\r")


@pytest.mark.parametrize("filler", [b"A", b" ", b";" + b"x" * 4095, b"A B\t"], ids=["A", "blank", "comment", "mixed"])
def test_sixteen_megabytes_without_a_terminator_stay_bounded(filler: bytes) -> None:
    chunk = filler * (65536 // len(filler))
    assembler = LineAssembler()
    tracemalloc.start()
    try:
        for _ in range(16 * MEGABYTE // len(chunk)):
            for _token in assembler.feed(chunk):
                pass
            assert assembler.pending <= MAX_KEPT
        assert tracemalloc.get_traced_memory()[1] < MEGABYTE
    finally:
        tracemalloc.stop()
    assert list(assembler.feed(b"\rTPE\r"))[-1].text == "TPE"


@pytest.mark.parametrize("filler", [b"A", b" ", b"\0", b"\b", b";"])
def test_the_work_is_linear_byte_by_byte(filler: bytes) -> None:
    """A quadratic assembler would copy 5 GB here; the bound is some twenty times what a linear one takes."""
    assembler = LineAssembler()
    started = time.process_time()
    for _ in range(100_000):
        for _token in assembler.feed(filler):
            pass
    assert time.process_time() - started < 5.0

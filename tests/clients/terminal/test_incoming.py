"""Bytes of a unit cut into lines and prompts; the bytes are those of host-seen and documented exchanges."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clients.terminal.incoming import LONGEST_LINE, Incoming, Piece, visible
from protocol.reply import Framing, character_codes

GOOD, BAD, DEFINING = Piece("", "good"), Piece("", "bad"), Piece("", "defining")


def after(typed: str, received: bytes) -> list[Piece]:
    incoming = Incoming()
    incoming.sent(typed)
    return incoming.feed(received)


@pytest.mark.parametrize(
    ("typed", "received", "shown"),
    [
        ("1TPE", b"1TPE\r\n*1TPE+0\r\r\n> ", [Piece("*1TPE+0"), GOOD]),
        ("1tpe", b"1TPE\r*1TPE+0\r\r\n> ", [Piece("*1TPE+0"), GOOD]),
        ("1TPE", b"*1TPE+0\r\r\n> ", [Piece("*1TPE+0"), GOOD]),
        ("XXX", b"XXX\r\n\r\n*UNDEFINED LABEL\r\r\n? ", [Piece("*UNDEFINED LABEL"), BAD]),
        ("V5:D5", b"V5:\r\n> D5\r\n\r\n> ", [GOOD, GOOD]),
        ("TPE:TPC", b"TPE:*TPE+0,+0\r\r\n> TPC\r\n*TPC+1,+0\r\r\n> ",
         [Piece("*TPE+0,+0"), GOOD, Piece("*TPC+1,+0"), GOOD]),
        ("DEF A", b"DEF A\r\n\r\n- ", [DEFINING]),
        ("", b"\r\n\r\n> ", [GOOD]),
    ],
)  # fmt: skip
def test_an_answer_without_its_echo(typed: str, received: bytes, shown: list[Piece]) -> None:
    assert after(typed, received) == shown


def test_what_comes_unasked_is_shown_and_echoes_of_lines_before_it_still_go() -> None:
    incoming = Incoming()
    incoming.sent("GO")
    incoming.sent("TAS.1")
    received = b"GO\r\nPART 7\r\nTAS.1\r\n\r\n> *1\r\r\n> "
    assert incoming.feed(received) == [Piece("PART 7"), GOOD, Piece("*1"), GOOD]


def test_an_echo_that_never_came_does_not_stand_in_the_way_of_the_next() -> None:
    incoming = Incoming()
    incoming.sent("V1")
    incoming.sent("V2")
    assert incoming.feed(b"V2\r\n\r\n> ") == [GOOD]


def test_half_a_line_is_shown_when_nothing_more_comes() -> None:
    incoming = Incoming()
    assert incoming.feed(b"PLACE PART, THEN") == []
    assert incoming.quiet() == [Piece("PLACE PART, THEN")]
    assert incoming.quiet() == []


def test_other_framings() -> None:
    incoming = Incoming()
    codes = character_codes([3, 0, 0]), character_codes([2, 0, 0]), character_codes([33, 0, 0, 0])
    incoming.use(Framing(eot=codes[0], bot=codes[1], good_prompt=codes[2]))
    assert incoming.feed(b"\x02*1TPE+0\x03!") == [Piece("*1TPE+0"), GOOD]
    assert incoming.feed(b"*1TPE+0\r\r\n> ") == [Piece("*1TPE+0"), GOOD]


def test_characters_that_would_move_the_cursor_are_spelled_out() -> None:
    assert after("", b"\x1b[2Jhello\xff\r\n") == [Piece("\\x1b[2Jhello\\xff")]
    assert visible(b"a\x07~") == "a\\x07~"


def test_nul_and_flow_control_are_not_shown() -> None:
    assert after("TPE", b"\x00TPE\r\n\x13*TPE+0,+0\r\x11\r\n> ") == [Piece("*TPE+0,+0"), GOOD]


def test_a_line_without_an_end_does_not_fill_memory() -> None:
    incoming = Incoming()
    pieces = incoming.feed(b"x" * (3 * LONGEST_LINE))
    assert sum(len(piece.text) for piece in pieces) == 3 * LONGEST_LINE


_PARTS = [b"*1TPE+0\r\r\n> ", b"\r\n> ", b"\r\n? ", b"TAS\r\n", b"V5:", b"*X Y\r", b"hello\r\n", b"\r\n- ", b"\x00"]
_SAID = st.lists(st.sampled_from(_PARTS))


@given(said=_SAID, data=st.data())
def test_however_the_bytes_are_cut(said: list[bytes], data: st.DataObject) -> None:
    whole = b"".join(said)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(whole)), max_size=6)))
    results = []
    for parts in ([whole], [whole[a:b] for a, b in zip([0, *cuts], [*cuts, len(whole)], strict=True)]):
        incoming = Incoming()
        incoming.sent("TAS:V5:V5")
        found = [piece for part in parts for piece in incoming.feed(part)] + incoming.quiet()
        results.append(found)
    assert results[0] == results[1]


@given(st.lists(st.binary(max_size=40), max_size=10))
def test_any_bytes_become_printable_lines(chunks: list[bytes]) -> None:
    incoming = Incoming()
    pieces = [piece for chunk in chunks for piece in incoming.feed(chunk)] + incoming.quiet()
    assert all(piece.text.isprintable() for piece in pieces)

"""The telnet codec and negotiation by themselves: RFC 854, 855, 856, 1143; whatever bytes, however cut."""

from __future__ import annotations

import time
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.ports.telnet import (
    ARE_YOU_THERE,
    BINARY,
    COM_PORT,
    DO,
    DONT,
    ECHO,
    IAC,
    SB,
    SE,
    SUBNEGOTIATION_BYTES,
    SUPPRESS_GO_AHEAD,
    WILL,
    WONT,
    Command,
    Decoder,
    Event,
    Negotiate,
    Options,
    Recognizer,
    Subnegotiation,
    encode,
)
from emulator.ports.telnet_session import HERE_I_AM, TelnetSession

OFFER = bytes((IAC, WILL, ECHO, IAC, WILL, SUPPRESS_GO_AHEAD, IAC, DO, SUPPRESS_GO_AHEAD))
NOISY = st.lists(
    st.one_of(
        st.sampled_from([255, 255, 250, 240, 251, 252, 253, 254, 44, 0, 1, 3, 6, 13, 10, 246, 244]), st.integers(0, 255)
    ),
    max_size=200,
).map(bytes)
"""Bytes among which those that mean something to telnet are frequent."""


def decode(*pieces: bytes, binary: bool = False) -> list[Event]:
    """The events of a stream in these pieces, text that follows text joined."""
    decoder = Decoder()
    decoder.binary = binary
    events: list[Event] = []
    for event in (event for piece in pieces for event in decoder.feed(piece)):
        if events and isinstance(event, bytes) and isinstance(events[-1], bytes):
            events[-1] += event
        else:
            events.append(event)
    return events


def cut(data: bytes, places: list[int]) -> list[bytes]:
    edges = [0, *sorted(place % (len(data) + 1) for place in places), len(data)]
    return [data[start:end] for start, end in pairwise(edges)]


def test_a_stream_is_taken_apart() -> None:
    stream = b"1T" + bytes((IAC, DO, ECHO)) + b"P" + bytes((IAC, IAC, IAC, ARE_YOU_THERE)) + b"E\r\0"
    expected = [b"1T", Negotiate(DO, ECHO), b"P\xff", Command(ARE_YOU_THERE), b"E\r"]
    assert decode(stream) == expected


@given(NOISY, st.lists(st.integers(0, 300), max_size=6), st.booleans())
def test_packets_make_no_difference(data: bytes, places: list[int], binary: bool) -> None:
    assert decode(*cut(data, places), binary=binary) == decode(data, binary=binary)
    assert decode(*(bytes([byte]) for byte in data), binary=binary) == decode(data, binary=binary)


@given(st.lists(NOISY, max_size=5), st.booleans())
def test_what_is_encoded_in_pieces_is_decoded_whole(pieces: list[bytes], binary: bool) -> None:
    whole = b"".join(pieces)
    stream = b"".join(encode(piece, binary=binary) for piece in pieces)
    assert decode(stream, binary=binary) == ([whole] if whole else [])


@pytest.mark.parametrize(
    ("data", "sent"),
    [
        (b"\r\n> ", b"\r\n> "),
        (b"A\r\r\n", b"A\r\0\r\n"),
        (b"A\r", b"A\r\0"),
        (b"\r\0", b"\r\0\0"),
        (b"\xff", b"\xff\xff"),
    ],
)
def test_ends_of_line_go_out_as_telnet_wants_them(data: bytes, sent: bytes) -> None:
    assert encode(data) == sent


def test_a_subnegotiation_keeps_its_doubled_iac_and_loses_nothing() -> None:
    stream = bytes((IAC, SB, COM_PORT, 1, IAC, IAC, 2, IAC, SE)) + b"A"
    assert decode(stream) == [Subnegotiation(bytes((COM_PORT, 1, IAC, 2))), b"A"]


@pytest.mark.parametrize("length", [SUBNEGOTIATION_BYTES + 1, 1_000_000])
def test_an_endless_subnegotiation_is_dropped_and_not_kept(length: int) -> None:
    decoder = Decoder()
    assert list(decoder.feed(bytes((IAC, SB)) + b"x" * length)) == []
    assert len(decoder._inside or b"") <= SUBNEGOTIATION_BYTES + 1
    assert list(decoder.feed(bytes((IAC, SE)) + b"1TPE\r")) == [b"1TPE\r"]


def test_a_command_ends_a_subnegotiation_that_was_not_closed() -> None:
    assert decode(bytes((IAC, SB, 24, 1, IAC, WILL, ECHO)) + b"A") == [Negotiate(WILL, ECHO), b"A"]


@pytest.mark.parametrize("data", [b"\xff", b"\xff1TPE\r", b"\xff\xff\r", b"\xff\xfa1TPE\r", b"\xff\xf0", b"a\xff\x80b"])
def test_noise_does_not_make_a_telnet_client(data: bytes) -> None:
    recognizer = Recognizer()
    raw, telnet = recognizer.feed(data)
    assert (raw + recognizer.flush(), telnet) == (data, b"")


def test_a_lone_iac_waits_for_the_next_byte_only() -> None:
    recognizer = Recognizer()
    assert recognizer.feed(b"A\xff") == (b"A", b"")
    assert recognizer.undecided
    assert recognizer.feed(b"B") == (b"\xffB", b"")
    assert not recognizer.undecided


@given(NOISY, st.lists(st.integers(0, 300), max_size=6))
def test_recognition_does_not_depend_on_packets(data: bytes, places: list[int]) -> None:
    def recognize(pieces: list[bytes]) -> tuple[bytes, bytes]:
        recognizer, raw, telnet = Recognizer(), b"", b""
        for piece in pieces:
            if telnet:
                telnet += piece
            else:
                plain, telnet = recognizer.feed(piece)
                raw += plain
        return raw + recognizer.flush(), telnet

    raw, telnet = recognize(cut(data, places))
    assert raw + telnet == data
    assert (raw, telnet) == recognize([data])


def options() -> Options:
    return Options(ours=frozenset((BINARY, ECHO, SUPPRESS_GO_AHEAD)), theirs=frozenset((BINARY, SUPPRESS_GO_AHEAD)))


@pytest.mark.parametrize(
    ("received", "sent"),
    [
        ([(DO, ECHO)], [(WILL, ECHO)]),
        ([(DO, ECHO), (DO, ECHO)], [(WILL, ECHO)]),
        ([(DO, ECHO), (DONT, ECHO)], [(WILL, ECHO), (WONT, ECHO)]),
        ([(DONT, ECHO)], []),
        ([(WILL, ECHO)], [(DONT, ECHO)]),
        ([(WILL, BINARY)], [(DO, BINARY)]),
        ([(WONT, BINARY)], []),
        ([(DO, 200), (WILL, 200)], [(WONT, 200), (DONT, 200)]),
        ([(DONT, 200), (WONT, 200)], []),
    ],
)
def test_negotiation(received: list[tuple[int, int]], sent: list[tuple[int, int]]) -> None:
    side = options()
    answers = b"".join(side.answer(verb, option) for verb, option in received)
    assert answers == b"".join(bytes((IAC, verb, option)) for verb, option in sent)


def test_an_offer_that_is_accepted_is_not_confirmed_again() -> None:
    side = options()
    assert side.offer(ECHO) == bytes((IAC, WILL, ECHO))
    assert side.offer(ECHO) == b""
    assert side.answer(DO, ECHO) == b""
    assert side.we_do(ECHO)


WISHES = st.lists(
    st.tuples(st.booleans(), st.booleans(), st.sampled_from([BINARY, ECHO, SUPPRESS_GO_AHEAD, 24, 200])), max_size=12
)
"""Which side wishes, whether to do it itself or have the other do it, and what."""


@given(WISHES)
def test_two_sides_that_follow_the_rule_agree_and_fall_silent(wishes: list[tuple[bool, bool, int]]) -> None:
    sides = (options(), options())
    under_way = [b"", b""]
    for second, itself, option in wishes:
        side = sides[second]
        under_way[second] += side.offer(option) if itself else side.ask(option)
    for _ in range(4):
        under_way = [answers(sides[number], under_way[1 - number]) for number in (0, 1)]
    assert under_way == [b"", b""]
    for option in (BINARY, ECHO, SUPPRESS_GO_AHEAD, 24, 200):
        assert sides[0].we_do(option) == sides[1].they_do(option)
        assert sides[1].we_do(option) == sides[0].they_do(option)


def answers(side: Options, received: bytes) -> bytes:
    """What a side answers to a stream of negotiations."""
    return b"".join(side.answer(received[at + 1], received[at + 2]) for at in range(0, len(received), 3))


class Peer:
    """A session whose writes are collected."""

    def __init__(self, strict_baud: int | None = None) -> None:
        self.sent = b""
        self.session = TelnetSession(self._write, name="test", strict_baud=strict_baud)

    def _write(self, data: bytes) -> None:
        self.sent += data

    def take(self) -> bytes:
        sent, self.sent = self.sent, b""
        return sent


def test_the_session_offers_echo_once() -> None:
    peer = Peer()
    peer.session.open()
    assert peer.take() == OFFER
    assert peer.session.receive(bytes((IAC, DO, ECHO, IAC, DO, SUPPRESS_GO_AHEAD, IAC, WILL, SUPPRESS_GO_AHEAD))) == b""
    assert peer.take() == b""


def test_are_you_there_is_answered_and_stays_out_of_the_command() -> None:
    peer = Peer()
    assert peer.session.receive(b"1T" + bytes((IAC, ARE_YOU_THERE)) + b"PE\r") == b"1TPE\r"
    assert peer.take() == HERE_I_AM


def test_timing_marks_are_answered_each_time() -> None:
    """Clients that interrupt throw away what they receive until the answer comes."""
    peer = Peer()
    peer.session.receive(bytes((IAC, 244, IAC, 242, IAC, DO, 6)) * 2)
    assert peer.take() == bytes((IAC, WILL, 6)) * 2


def test_erase_character_is_the_units_backspace() -> None:
    assert Peer().session.receive(b"1TPX" + bytes((IAC, 247)) + b"E\r") == b"1TPX\bE\r"


def test_binary_is_agreed_for_each_direction_by_itself() -> None:
    peer = Peer()
    peer.session.send(b"\r")
    assert peer.take() == b"\r\0"
    peer.session.receive(bytes((IAC, DO, BINARY)))
    assert peer.take() == bytes((IAC, WILL, BINARY))
    peer.session.send(b"\r\xff")
    assert peer.take() == b"\r\xff\xff"
    assert peer.session.receive(b"A\r\0") == b"A\r"
    assert peer.session.receive(bytes((IAC, WILL, BINARY)) + b"A\r\0") == b"A\r\0"


@given(NOISY, st.lists(st.integers(0, 300), max_size=6))
def test_noise_of_any_kind_never_raises_and_always_ends(data: bytes, places: list[int]) -> None:
    whole, pieces = Peer(), Peer()
    text = whole.session.receive(data)
    assert b"".join(map(pieces.session.receive, cut(data, places))) == text
    assert pieces.sent == whole.sent
    whole.session.receive(bytes((0, IAC, SE)))
    assert whole.session.receive(b"1TPE\r").endswith(b"1TPE\r")


def test_a_portion_of_nothing_but_negotiation_is_soon_done() -> None:
    """A portion is worked off between two ticks; requests of RFC 2217 are the dearest."""
    peer = Peer()
    peer.session.receive(bytes((IAC, WILL, COM_PORT)))
    portion = bytes((IAC, SB, COM_PORT, 7, IAC, SE)) * 85
    began_ns = time.thread_time_ns()
    peer.session.receive(portion)
    assert time.thread_time_ns() - began_ns < 20_000_000

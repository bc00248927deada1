"""Characters read at another baud rate than they were sent at: against waveforms drawn by hand."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.machine import Machine
from emulator.ports.baud import FACTORY_BAUD, garbled, unit_baud

RATES = st.sampled_from([110, 300, 1200, 2400, 4800, 9600, 19_200, 38_400, 57_600, 115_200, 921_600])


@given(st.binary(max_size=300), RATES)
def test_the_same_rate_reads_what_was_sent(data: bytes, rate: int) -> None:
    assert garbled(data, sent_at=rate, read_at=rate) == data


@given(st.binary(max_size=300), st.integers(10_000, 100_000), st.floats(-0.03, 0.03))
def test_rates_within_three_per_cent_read_what_was_sent(data: bytes, rate: int, off: float) -> None:
    assert garbled(data, sent_at=rate, read_at=round(rate * (1 + off))) == data


def test_ten_per_cent_off_garbles_a_pattern_of_alternate_bits() -> None:
    """The reader's samples lie at (k + 1.5) / 1.1 of the sender's bits: 1.4, 2.3, 3.2, 4.1, 5.0, 5.9, 6.8, 7.7.  Bit 4
    is read twice, so that 1010 1010 of 0x55 (lowest first) reads as 1010 1101 = 0xB5."""
    assert garbled(b"U", sent_at=9600, read_at=10_560) == b"\xb5"


@pytest.mark.parametrize(
    ("sent", "read"),
    [
        (b"\xff", b"\xfe"),
        (b"\x00", b"\x00"),
        (b"U", b"f"),
    ],
)
def test_at_twice_the_rate_every_bit_is_read_twice(sent: bytes, read: bytes) -> None:
    r"""0xFF is low for one bit of the sender: start and first data bit of the reader, then all high.  0x00 is low
    for nine: the reader sees start, eight data bits and stop low and waits for a high.  U = 0x55 alternates: start and
    bit 0 low, then two high and two low in turn, 0110 0110 = 0x66 (f) lowest first, and the stop bit is low."""
    assert garbled(sent, sent_at=4800, read_at=9600)[: len(read)] == read


def test_at_half_the_rate_bits_are_skipped() -> None:
    """The reader looks 1, 3, 5 ... bits of the sender after the edge: 0xFF of a lone character is high everywhere but
    in its start bit, which is over at the middle of the reader's: noise.  0x00 is nine bits low: start at 1, data at 3,
    5 and 7 low, the rest stop bit and idle."""
    assert garbled(b"\xff", sent_at=9600, read_at=4800) == b""
    assert garbled(b"\x00", sent_at=9600, read_at=4800) == b"\xf8"


@given(st.binary(max_size=200), RATES, RATES)
def test_the_result_is_bounded_by_the_edges_and_always_the_same(data: bytes, sent_at: int, read_at: int) -> None:
    read = garbled(data, sent_at=sent_at, read_at=read_at)
    assert len(read) <= 5 * len(data)
    assert read == garbled(data, sent_at=sent_at, read_at=read_at)


def test_a_command_at_the_wrong_rate_is_garbage() -> None:
    assert garbled(b"1TPE\r", sent_at=9600, read_at=19_200) != b"1TPE\r"
    assert garbled(b"1TPE\r", sent_at=19_200, read_at=9600) != b"1TPE\r"


@pytest.mark.parametrize(("sent_at", "read_at"), [(0, 9600), (9600, 0), (-1, 9600)])
def test_rates_must_be_positive(sent_at: int, read_at: int) -> None:
    with pytest.raises(ValueError, match="must be positive"):
        garbled(b"A", sent_at=sent_at, read_at=read_at)


def test_the_rate_of_a_unit_is_that_of_its_line_or_of_the_factory() -> None:
    assert unit_baud(Machine.default()) == FACTORY_BAUD
    assert unit_baud(Machine.parse("[serial]\nbaud = 19200")) == 19_200

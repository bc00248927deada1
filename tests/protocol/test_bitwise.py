"""Bit patterns: the three-valued tables, shifts, conversion between numbers and bits."""

from __future__ import annotations

from decimal import Decimal
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import bitwise
from protocol.errors import CommandError

PRINTED = """
    1 1 1 1 0
    1 0 0 1 1
    0 1 0 1 1
    0 0 0 0 0
    X X X X X
    1 X X 1 X
    X 1 X 1 X
    0 X 0 X X
    X 0 X X X
"""
"""a, b, a&b, a|b, a^b, as the knowledge base prints the table; its last row says X for X & 0."""

WORDS = st.text("01X", min_size=32, max_size=32)


@pytest.mark.parametrize("row", PRINTED.strip().splitlines())
def test_the_table_as_printed(row: str) -> None:
    a, b, conjunction, disjunction, exclusive = row.split()
    assert bitwise.both(a, b)[0] == conjunction
    assert bitwise.either(a, b)[0] == disjunction
    assert bitwise.one_of(a, b)[0] == exclusive


def test_the_table_is_complete() -> None:
    rows = {tuple(row.split()[:2]) for row in PRINTED.strip().splitlines()}
    assert rows == set(product("01X", repeat=2))


@given(word=WORDS, count=st.integers(0, 40))
def test_shifts_move_bits_and_fill_with_zeros(word: str, count: int) -> None:
    left, right = bitwise.shifted_left(word, Decimal(count)), bitwise.shifted_right(word, Decimal(count))
    for place in range(32):
        assert left[place] == (word[place + count] if place + count < 32 else "0")
        assert right[place] == (word[place - count] if place >= count else "0")


def test_a_negative_shift_is_refused() -> None:
    with pytest.raises(CommandError, match="INVALID DATA"):
        bitwise.shifted_left("1", Decimal(-1))


@given(value=st.integers(-(2**31), 2**31 - 1))
def test_numbers_convert_both_ways(value: int) -> None:
    bits = bitwise.bits_of(Decimal(value))
    weights = [1 << place for place in range(31)] + [-(1 << 31)]
    assert sum(weight for bit, weight in zip(bits, weights, strict=True) if bit == "1") == value
    assert bitwise.number_of(bits) == value


def test_x_counts_as_zero_and_fractions_are_cut_off() -> None:
    assert bitwise.number_of("1X1" + "X" * 29) == 5
    assert bitwise.bits_of(Decimal("-1.9")) == "1" * 32


@given(word=WORDS)
def test_complement_twice_is_the_word(word: str) -> None:
    assert bitwise.complement(bitwise.complement(word)) == word


def test_a_pattern_matches_what_it_reaches() -> None:
    assert bitwise.matches("1010", "1X1")
    assert not bitwise.matches("1010", "11")

"""Quoted text and its character codes."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol.errors import INCORRECT_DATA, CommandError
from protocol.numbers import format_columns, format_variable
from protocol.strings import quoted, unquoted


@pytest.mark.parametrize(
    ("text", "characters"),
    [
        ('""', ""),
        ('"HI MOM\\13"', "HI MOM\r"),
        ('"\\34\\58\\59\\92\\10"', '":;\\\n'),
        ('"\\0655"', "A5"),
        ('"a b"', "a b"),
    ],
)
def test_codes_stand_for_characters(text: str, characters: str) -> None:
    assert unquoted(text) == characters


@pytest.mark.parametrize("text", ["", "A", '"A', '"A"B', '"\\"', '"\\A"', '"\\256"'])
def test_what_is_no_quoted_text(text: str) -> None:
    with pytest.raises(CommandError) as caught:
        unquoted(text)
    assert caught.value.text == INCORRECT_DATA


@given(text=st.text(st.characters(max_codepoint=255), max_size=20))
def test_what_is_printed_reads_back(text: str) -> None:
    assert unquoted(quoted(text)) == text


@given(value=st.decimals(-999999999, 999999999, places=8))
def test_a_variable_printed_reads_back(value: Decimal) -> None:
    text = format_variable(value)
    assert Decimal(text) == value
    assert text[0] in "+-" and "." in text


@pytest.mark.parametrize(
    ("value", "whole_digits", "decimals", "signed", "text"),
    [
        ("12.5", 2, 3, True, "+12.500"),
        ("12.5", 4, 0, False, "0012"),
        ("-7.25", 1, 1, True, "-7.2"),
        ("123.5", 2, 1, False, "23.5"),
        ("0.75", 0, 2, False, ".75"),
    ],
)
def test_columns(value: str, whole_digits: int, decimals: int, signed: bool, text: str) -> None:
    assert format_columns(Decimal(value), whole_digits=whole_digits, decimals=decimals, signed=signed) == text

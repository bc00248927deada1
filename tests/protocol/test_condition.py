"""Conditions of WAIT, IF and their like: the forms the references show, read and evaluated."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.condition import (
    MAX_EXPRESSION,
    Joined,
    Not,
    Operand,
    Relation,
    Value,
    evaluate,
    hex_bits,
    parse_condition,
    relations,
)
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError

AXIS_STATUS = "10000000000000000000000100000000"
READINGS: dict[Operand, Value] = {
    Operand("AS", 1): AXIS_STATUS,
    Operand("AS", 5): "0" * 32,
    Operand("AS", 1, bit=1): "1",
    Operand("AS", 1, bit=24): "1",
    Operand("AS", bit=1): "1",
    Operand("ER", bit=12): "0",
    Operand("MOV"): "00",
    Operand("IN"): "1001" + "0" * 22,
    Operand("PE", 1): Decimal(4000),
    Operand("PE", 2): Decimal(-5),
    Operand("VAR", index=1): Decimal("3.5"),
    Operand("VAR", index=2): Decimal("10"),
}


def holds(text: str) -> bool:
    return evaluate(parse_condition(text), READINGS.__getitem__)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("AS.1=B0", False),
        ("AS.1=B1", True),
        ("AS.1=1", True),
        ("1AS.24=B1", True),
        ("ER.12=B1", False),
        ("ER.12<>B1", True),
        ("MOV=000000", True),
        ("IN=B1X01", True),
        ("IN=B1X11", False),
        ("IN=1X01", True),
        ("IN=H9", True),
        ("IN=H90", True),
        ("IN=H8", False),
        ("1AS=XXXX1", False),
        ("1AS=1", True),
        ("1PE>4000", False),
        ("1PE>=4000", True),
        ("2PE<0", True),
        ("2PE=-5", True),
        ("2PE<>-5", False),
        ("VAR1=3.5", True),
        ("VAR1<=3.499", False),
        ("VAR2=10", True),
        ("VAR1<VAR2", True),
        ("1PE=VAR1", False),
    ],
)
def test_relations_hold_or_not(text: str, expected: bool) -> None:
    assert holds(text) is expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1AS=1XXX0AND5AS=XXXX0", True),
        ("AS.1=B0ORVAR1>3", True),
        ("NOTAS.1=B1", False),
        ("NOT(AS.1=B1ANDER.12=B1)", True),
        ("AS.1=B1ORAS.1=B1ANDER.12=B1", False),
        ("AS.1=B1OR(AS.1=B1ANDER.12=B1)", True),
        ("NOTNOTAS.1=B1", True),
    ],
)
def test_words_join_from_left_to_right_and_parentheses_group(text: str, expected: bool) -> None:
    assert holds(text) is expected


def test_the_tree() -> None:
    moving = Relation(Operand("AS", 1, bit=1), "=", "0")
    above = Relation(Operand("VAR", index=1), ">", Decimal(3))
    condition = parse_condition("1AS.1=B0ANDNOTVAR1>3")
    assert condition == Joined(moving, "AND", Not(above))
    assert list(relations(condition)) == [moving, above]


@pytest.mark.parametrize(
    ("digits", "bits"),
    [("7FAD", "11101111010110110000000000000000"), ("15", "10001010" + "0" * 24), ("00000004", "0" * 28 + "0010")],
)
def test_hexadecimal_digits_have_their_bits_reversed(digits: str, bits: str) -> None:
    """``h15`` sets bits 1, 5 and 7."""
    assert hex_bits(digits) == bits


@pytest.mark.parametrize(
    "text", ["", "AS", "AS.1", "=1", "AS.1=", "(AS.1=B0", "AS.1=B0)", "AS.1=B0AND", "VAR1==5", "%", "1=1"]
)
def test_what_is_no_condition_is_incorrect_data(text: str) -> None:
    with pytest.raises(CommandError) as caught:
        parse_condition(text)
    assert caught.value.text == INCORRECT_DATA


def test_a_condition_longer_than_the_limit_is_invalid_data() -> None:
    with pytest.raises(CommandError) as caught:
        parse_condition("(" * (MAX_EXPRESSION + 1))
    assert caught.value.text == INVALID_DATA


def test_a_pattern_is_no_match_for_a_number() -> None:
    with pytest.raises(CommandError, match=INVALID_DATA):
        holds("1PE=B1X")


_PIECES = st.sampled_from(
    [
        "1",
        "AS",
        "PE",
        "VAR1",
        ".1",
        "=",
        "<",
        "<>",
        "B0",
        "B1X",
        "H7F",
        "AND",
        "OR",
        "NOT",
        "(",
        ")",
        "5",
        "-",
        "X",
        "1",
    ]
)


@settings(deadline=None, max_examples=400)
@given(text=st.lists(_PIECES, max_size=14).map("".join) | st.text(max_size=80))
def test_any_text_is_a_condition_or_refused(text: str) -> None:
    try:
        condition = parse_condition(text)
    except CommandError as error:
        assert error.text in (INCORRECT_DATA, INVALID_DATA)
    else:
        assert list(relations(condition))


@settings(deadline=None)
@given(depth=st.integers(1, 38))
def test_nesting_as_deep_as_the_limit_allows(depth: int) -> None:
    text = "(" * depth + "IN=1" + ")" * depth
    assert len(text) <= MAX_EXPRESSION
    assert holds(text)

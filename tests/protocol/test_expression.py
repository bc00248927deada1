"""Expressions: read, worked from left to right, refused where the kinds do not fit."""

from __future__ import annotations

from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.expression import Expression, Operand, Operation, Value, evaluator, is_bits, operands_in
from protocol.expression_text import parse_bits_expression, parse_condition, parse_number_expression

VALUES: dict[Operand, Value] = {
    Operand("VAR", index=1): Decimal("3.5"),
    Operand("VAR", index=2): Decimal(2),
    Operand("VAR", index=3): Decimal(1),
    Operand("VARB", index=1): "1010" + "X" * 28,
    Operand("PE", 2): Decimal(-40),
    Operand("RADIAN"): Decimal(0),
}


def number(text: str) -> Decimal:
    value = evaluator(parse_number_expression(text))(VALUES.__getitem__)
    assert isinstance(value, Decimal)
    return value


def bits(text: str) -> str:
    value = evaluator(parse_bits_expression(text))(VALUES.__getitem__)
    assert isinstance(value, str)
    return value


def refused(text: str) -> str:
    with pytest.raises(CommandError) as caught:
        number(text)
    return caught.value.text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0", "0"),
        ("+0", "0"),
        ("-0.5", "-0.5"),
        ("1.123456789", "1.12345678"),
        ("5+3*2", "16"),
        ("5+(3*2)", "11"),
        ("5--3", "8"),
        ("5*-3", "-15"),
        ("10/15.5", "0.64516"),
        ("1/3*3", "0.99999"),
        ("VAR1", "3.5"),
        ("VAR1+VAR2*2", "11"),
        ("VAR(VAR2)", "2"),
        ("VAR(VAR3)*2", "7"),
        ("2PE/VAR2", "-20"),
        ("SQRT(75)", "8.66025"),
        ("SQRT(VAR2+(7*2))", "4"),
        ("SIN(30)", "0.5"),
        ("ATAN(1)", "45"),
        ("PI", "3.14159265"),
        ("VCVT(VARB1)", "5"),
        ("VCVT(VARB1&b1)+1", "2"),
        ("~(VAR1)", "0"),
        ("1&1|0", "1"),
    ],
)
def test_numbers(text: str, expected: str) -> None:
    assert number(text.upper()) == Decimal(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("b1101XX1", "1101XX1"),
        ("h15", "10001010" + "0" * 24),
        ("1011", "1011"),
        ("VARB1&b0110", "0010" + "X" * 28),
        ("VARB1^1111", "0101" + "X" * 28),
        ("VARB1<<2", "10" + "X" * 28 + "00"),
        ("VARB1>>VAR2", "001010" + "X" * 26),
        ("~VARB1", "0101" + "X" * 28),
        ("VCVT(5)", "101" + "0" * 29),
        ("VCVT(VAR2-3)", "1" * 32),
    ],
)
def test_bit_patterns(text: str, expected: str) -> None:
    assert bits(text.upper()) == expected


@pytest.mark.parametrize(
    "text", ["", "5+", "(5", "5)", "5++", "VAR", "VAR1.2", "PE1", "FOO", "SIN()", "SIN(1", "1=1", "-VAR1"]
)
def test_what_is_no_expression_is_incorrect_data(text: str) -> None:
    assert refused(text) == INCORRECT_DATA


@pytest.mark.parametrize(
    "text",
    [
        *("1/0", "VAR1/(VAR2-2)", "SQRT(-1)", "TAN(90)", "TAN(270)", "999999999*2", "1000000000", "VCVT(H00000004)"),
        *("B101", "VARB1", "1+VARB1", "SIN(VARB1)", "VAR(VAR1)"),
    ],
)
def test_what_has_no_number_is_invalid_data(text: str) -> None:
    assert refused(text) == INVALID_DATA


def test_what_an_expression_depends_on() -> None:
    found = list(operands_in(parse_number_expression("SIN(VAR1+2PE)*3")))
    assert found == [Operand("VAR", index=1), Operand("PE", 2)]


def test_conditions_compare_expressions() -> None:
    assert parse_condition("VAR1+VAR2*2=11").test(VALUES.__getitem__)
    assert parse_condition("(VAR1+VAR2)*2>10AND(VAR1<4ORVAR2>9)").test(VALUES.__getitem__)
    assert not parse_condition("VARB1&B11=B11").test(VALUES.__getitem__)
    with pytest.raises(CommandError, match=INCORRECT_DATA):
        parse_condition("VARB1>B1")


# An independent evaluator: exact fractions, rounded after each operator.

Tree = Fraction | tuple["Tree", str, "Tree"]


def _five_places(value: Fraction) -> Fraction:
    scaled = abs(value) * 10**5
    whole = (scaled.numerator * 2 + scaled.denominator) // (scaled.denominator * 2)
    return Fraction(whole if value >= 0 else -whole, 10**5)


def _worked(tree: Tree) -> Fraction:
    if isinstance(tree, Fraction):
        return tree
    left, right = _worked(tree[0]), _worked(tree[2])
    result = {"+": left + right, "-": left - right, "*": left * right}.get(tree[1])
    if result is None:
        result = left / right
    result = _five_places(result)
    if abs(result) > Fraction("999999999.99999999"):
        raise OverflowError
    return result


def _text(tree: Tree) -> str:
    if isinstance(tree, Fraction):
        return f"{Decimal(tree.numerator) / Decimal(tree.denominator):f}"
    return f"({_text(tree[0])}){tree[1]}({_text(tree[2])})"


LEAVES = st.decimals(-99999, 99999, places=4).map(Fraction)
TREES = st.recursive(LEAVES, lambda tree: st.tuples(tree, st.sampled_from("+-*/"), tree), max_leaves=8)


@settings(deadline=None, max_examples=200)
@given(tree=TREES)
def test_random_expressions_agree_with_exact_fractions(tree: Tree) -> None:
    try:
        expected = _worked(tree)
    except (ZeroDivisionError, OverflowError):
        assert refused(_text(tree)) == INVALID_DATA
    else:
        assert Fraction(number(_text(tree))) == expected


@settings(deadline=None, max_examples=200)
@given(start=LEAVES, steps=st.lists(st.tuples(st.sampled_from("+-*"), st.integers(0, 99)), max_size=5))
def test_chains_run_from_left_to_right(start: Fraction, steps: list[tuple[str, int]]) -> None:
    tree: Tree = start
    text = _text(start)
    for sign, operand in steps:
        tree = (tree, sign, Fraction(operand))
        text += f"{sign}{operand}"
    try:
        expected = _worked(tree)
    except OverflowError:
        assert refused(text) == INVALID_DATA
    else:
        assert Fraction(number(text)) == expected


_PIECES = st.sampled_from(
    ["1", "VAR1", "VARB1", "2PE", "B01", "HF", "+", "-", "*", "/", "&", "<<", "~", "(", ")", "SIN(", "VCVT(", "PI", "X"]
)


@settings(deadline=None, max_examples=400)
@given(text=st.lists(_PIECES, max_size=12).map("".join) | st.text(max_size=40))
def test_any_text_is_an_expression_or_refused(text: str) -> None:
    for parse, yields_bits in ((parse_number_expression, False), (parse_bits_expression, True)):
        expression: Expression
        try:
            expression = parse(text)
        except CommandError as error:
            assert error.text in (INCORRECT_DATA, INVALID_DATA)
        else:
            assert is_bits(expression) is yields_bits


def test_rounding_is_half_away_from_zero() -> None:
    for text in ("0.000005", "-0.000005"):
        assert number(f"{text}+0") == Decimal(text).quantize(Decimal("0.00001"), ROUND_HALF_UP)


def test_the_tree() -> None:
    assert parse_number_expression("1+VAR2") == Operation(Decimal(1), "+", Operand("VAR", index=2))

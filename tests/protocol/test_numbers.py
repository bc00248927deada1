"""Numbers truncated and printed as the references show them."""

from __future__ import annotations

from contextlib import suppress
from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol.errors import ReplyError
from protocol.numbers import (
    decimals_of_factor,
    divide,
    format_fixed,
    format_shortest,
    format_signed,
    format_variable,
    parse_number,
    truncate,
)

VALUES = st.decimals(-(10**15), 10**15, allow_nan=False, allow_infinity=False, places=12)
PLACES = st.integers(0, 9)


@pytest.mark.parametrize(
    ("typed", "factor", "kept"),
    [
        ("9.9999", 10, "9.9"),
        ("105.2776", 4000, "105.277"),
        ("75", 10000, "75"),
        ("1.99999", 25000, "1.9999"),
        ("-9.9999", 10, "-9.9"),
    ],
)
def test_what_is_typed_is_truncated_to_the_decade_of_the_scale_factor(typed: str, factor: int, kept: str) -> None:
    """6250 UG p.47 and GemCR p.257; the sign does not matter."""
    assert truncate(Decimal(typed), decimals_of_factor(factor)) == Decimal(kept)


def test_a_scaled_distance_is_an_exact_count() -> None:
    assert truncate(Decimal("75"), decimals_of_factor(10000)) * 10000 == 750000


@pytest.mark.parametrize(
    ("factor", "places"),
    [
        *((1, 0), (9, 0), (10, 1), (99, 1), (100, 2), (999, 2), (1000, 3), (9999, 3)),
        *((10000, 4), (99999, 4), (100000, 5), (999999, 5)),
    ],
)
def test_decimals_of_each_decade(factor: int, places: int) -> None:
    assert decimals_of_factor(factor) == places


@pytest.mark.parametrize(
    ("value", "places", "text"),
    [
        ("1", 4, "1.0000"),
        ("10.00009", 4, "10.0000"),
        ("-0.5", 3, "-0.500"),
        ("-0.0004", 3, "0.000"),
        ("-0", 0, "0"),
        ("4000", 0, "4000"),
        ("24999975", 4, "24999975.0000"),
        ("1E+9", 0, "1000000000"),
    ],
)
def test_fixed(value: str, places: int, text: str) -> None:
    assert format_fixed(Decimal(value), places) == text


@pytest.mark.parametrize(
    ("value", "places", "text"),
    [("0", 0, "+0"), ("-0.9", 0, "+0"), ("-12", 0, "-12"), ("1.25", 4, "+1.2500"), ("4000", 0, "+4000")],
)
def test_signed(value: str, places: int, text: str) -> None:
    assert format_signed(Decimal(value), places) == text


@pytest.mark.parametrize(
    ("value", "places", "text"),
    [
        ("0.5", 8, "0.5"),
        ("0.10", 8, "0.1"),
        ("200", 8, "200"),
        ("0", 8, "0"),
        ("100.000", 5, "100"),
        ("0.000000001", 8, "0"),
        ("-0.000000001", 8, "0"),
        ("1.999999", 5, "1.99999"),
        ("20", 0, "20"),
    ],
)
def test_shortest(value: str, places: int, text: str) -> None:
    assert format_shortest(Decimal(value), places) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("35", "+35.0"),
        ("0", "+0.0"),
        ("-0.000000001", "+0.0"),
        ("0.64516", "+0.64516"),
        ("116.25023", "+116.25023"),
        ("-12.500", "-12.5"),
        ("999999999.99999999", "+999999999.99999999"),
        ("100", "+100.0"),
    ],
)
def test_variables(value: str, text: str) -> None:
    assert format_variable(Decimal(value)) == text


def test_division_keeps_more_digits_than_any_report_shows() -> None:
    assert format_fixed(divide(Decimal(2), 3), 8) == "0.66666666"
    assert divide(Decimal(1_999_999), 1_000_000) == Decimal("1.999999")


@pytest.mark.parametrize("value", ["9" * 98, "0." + "9" * 97, "-" + "9" * 50 + "." + "9" * 47])
def test_as_many_digits_as_a_command_can_hold_are_truncated_exactly(value: str) -> None:
    whole, _, fraction = value.partition(".")
    kept = Decimal(f"{whole}.{fraction[:5] or '0'}")
    assert truncate(Decimal(value), 5) == kept


@settings(deadline=None)
@given(value=VALUES, places=PLACES)
def test_parsing_undoes_formatting(value: Decimal, places: int) -> None:
    for text in (format_fixed(value, places), format_signed(value, places), format_shortest(value, places)):
        assert parse_number(text) == truncate(value, places)
    assert parse_number(format_variable(value)) == truncate(value, 8)


@settings(deadline=None)
@given(value=VALUES, places=PLACES)
def test_truncation_goes_towards_zero_and_is_done_once(value: Decimal, places: int) -> None:
    cut = truncate(value, places)
    assert abs(cut) <= abs(value) and abs(value - cut) < Decimal(1).scaleb(-places)
    assert truncate(cut, places) == cut


@settings(deadline=None)
@given(value=VALUES, places=PLACES)
def test_the_form_of_each_format(value: Decimal, places: int) -> None:
    fixed = format_fixed(value, places)
    assert not fixed.startswith("+") and len(fixed.partition(".")[2]) == places
    assert format_signed(value, places)[0] in "+-"
    shortest = format_shortest(value, places)
    assert "." not in shortest or shortest[-1] in "123456789"
    assert not {"-0", "-0.0"} & {shortest, format_variable(value)}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "+",
        "-",
        ".",
        "1.",
        "NaN",
        "sNaN",
        "Infinity",
        "1E5",
        "0000_0000",
        "1_000",
        " 1",
        "1 ",
        "--1",
        "1,2",
        "\u0663",
    ],
)
def test_what_no_unit_prints_is_not_a_number(text: str) -> None:
    with pytest.raises(ReplyError):
        parse_number(text)


@settings(deadline=None)
@given(text=st.text(max_size=20))
def test_any_text_is_a_number_or_a_reply_error(text: str) -> None:
    with suppress(ReplyError):
        assert parse_number(text).is_finite()

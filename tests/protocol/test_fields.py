"""Fields laid out one an axis, checked and truncated: the rules of settled sections 2 and 6."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol import catalogue
from protocol.command import Direction, FieldValue, VariableReference, parse_command
from protocol.errors import INCORRECT_AXIS, INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.fields import (
    Range,
    as_decimal,
    axis_indexes,
    check_axis,
    checked_number,
    default_values,
    in_range,
    place_bits,
    place_mask,
    place_values,
    range_of,
)

AXES = 2


def row_of(name: str) -> catalogue.CommandRow:
    row = catalogue.lookup(name)
    assert row is not None
    return row


def numbers(*texts: str) -> list[FieldValue]:
    return [Decimal(text) if text else None for text in texts]


@pytest.mark.parametrize(
    ("text", "placed"),
    [
        ("V5", numbers("5", "")),
        ("V5,6", numbers("5", "6")),
        ("V,5", numbers("", "5")),
        ("1V5", numbers("5", "")),
        ("2V5", numbers("", "5")),
        ("@V1", numbers("1", "1")),
        ("PSET0,,,", numbers("0", "")),
        ("ERES ,,,", numbers("", "")),
        ("2V5,,", numbers("", "5")),
        ("@V5,,,,", numbers("5", "5")),
    ],
)
def test_fields_go_to_their_axes(text: str, placed: list[FieldValue]) -> None:
    assert place_values(parse_command(text), AXES) == placed


@pytest.mark.parametrize("text", ["PSET,,,0", "V1,2,3", "SCLA 1,1,1,1", "1V5,6", "@V1,2", "3V5", "0V5", "9V5"])
def test_surplus_fields_and_absent_axes_are_refused(text: str) -> None:
    with pytest.raises(CommandError, match=INCORRECT_AXIS):
        place_values(parse_command(text), AXES)


def test_one_axis_in_use_has_one_field() -> None:
    assert place_values(parse_command("V5"), 1) == numbers("5")
    with pytest.raises(CommandError, match=INCORRECT_AXIS):
        place_values(parse_command("V5,5"), 1)
    with pytest.raises(CommandError, match=INCORRECT_AXIS):
        place_values(parse_command("2V5"), 1)


def test_directions_and_variables_are_placed_like_numbers() -> None:
    assert place_values(parse_command("D~,-"), AXES) == [Direction.TOGGLE, Direction.NEGATIVE]
    assert place_values(parse_command("V,(VAR3)"), AXES) == [None, VariableReference("VAR", 3)]


@pytest.mark.parametrize(
    ("text", "placed"),
    [
        ("GO1", ["1", "X"]),
        ("GO01", ["0", "1"]),
        ("GOX1XXXXXX", ["X", "1"]),
        ("S01000000", ["0", "1"]),
        ("MC000000", ["0", "0"]),
        ("MA110000", ["1", "1"]),
        ("DRIVE1,1", ["1", "1"]),
        ("1DRIVE1", ["1", "X"]),
        ("2DRIVE0", ["X", "0"]),
        ("2DRIVE0XX0", ["X", "0"]),
        ("@DRIVE1", ["1", "1"]),
        ("GO", ["X", "X"]),
    ],
)
def test_mask_digits_go_to_their_axes(text: str, placed: list[str]) -> None:
    assert place_mask(parse_command(text), AXES) == placed


@pytest.mark.parametrize("text", ["GO001", "GO11111111", "1DRIVE11", "@DRIVE11", "3DRIVE1", "0DRIVE1"])
def test_a_surplus_one_is_refused(text: str) -> None:
    with pytest.raises(CommandError, match=INCORRECT_AXIS):
        place_mask(parse_command(text), AXES)


@pytest.mark.parametrize("text", ["GOX1XXXXXX", "S01000000", "1DRIVE10"])
def test_strict_units_refuse_every_surplus_digit(text: str) -> None:
    with pytest.raises(CommandError, match=INCORRECT_AXIS):
        place_mask(parse_command(text), AXES, lenient=False)


@settings(deadline=None)
@given(mask=st.text("01X", min_size=1, max_size=8), axes=st.integers(1, 2))
def test_masks_are_refused_exactly_for_a_one_beyond_the_axes(mask: str, axes: int) -> None:
    command = parse_command(f"GO{mask}")
    if "1" in mask[axes:]:
        with pytest.raises(CommandError, match=INCORRECT_AXIS):
            place_mask(command, axes)
    else:
        assert "".join(place_mask(command, axes)) == mask[:axes].ljust(axes, "X")


@settings(deadline=None)
@given(values=st.lists(st.none() | st.integers(-9999, 9999), min_size=1, max_size=8), axes=st.integers(1, 2))
def test_values_are_refused_exactly_for_one_beyond_the_axes(values: list[int | None], axes: int) -> None:
    command = parse_command("D" + ",".join("" if value is None else str(value) for value in values))
    if any(value is not None for value in values[axes:]):
        with pytest.raises(CommandError, match=INCORRECT_AXIS):
            place_values(command, axes)
    elif command.values:
        assert place_values(command, axes) == (values[:axes] + [None] * axes)[:axes]


@pytest.mark.parametrize(
    ("mask", "count", "placed"),
    [("1", 4, "1XXX"), ("", 3, "XXX"), ("0101", 4, "0101"), ("01010X00", 4, "0101"), ("EE01", 5, "EE01X")],
)
def test_bit_patterns_are_padded_with_unchanged_bits(mask: str, count: int, placed: str) -> None:
    assert place_bits(mask, count) == placed


@pytest.mark.parametrize("surplus", ["1", "E", "0X1"])
def test_surplus_bits_that_say_something_are_refused(surplus: str) -> None:
    with pytest.raises(CommandError, match=INCORRECT_DATA):
        place_bits("0000" + surplus, 4)


@pytest.mark.parametrize(("text", "indexes"), [("TPE", [0, 1]), ("1TPE", [0]), ("2TPE", [1])])
def test_the_axes_a_query_speaks_of(text: str, indexes: list[int]) -> None:
    assert list(axis_indexes(parse_command(text), AXES)) == indexes


@pytest.mark.parametrize("text", ["3TPE", "0TPE", "8TPE"])
def test_a_prefix_the_unit_does_not_have_is_refused(text: str) -> None:
    for check in (check_axis, axis_indexes):
        with pytest.raises(CommandError, match=INCORRECT_AXIS):
            check(parse_command(text), AXES)


@pytest.mark.parametrize(
    ("name", "minimum", "maximum"),
    [
        ("A", "0.00025", "24999975"),
        ("V", "0", "200"),
        ("SGP", "0", "2800000"),
        ("LH", "0", "3"),
        ("SMPER", "0", "200000000"),
        ("EOT", "0", "256"),
        ("INDEB", "1", "250"),
        ("MEMORY", "1000", "39000"),
        ("SCLD", "1", "999999"),
        ("SOFFS", "-10", "10"),
        ("DACLIM", "0", "10"),
        ("ADDR", "0", "99"),
    ],
)
def test_ranges_end_where_the_references_say(name: str, minimum: str, maximum: str) -> None:
    allowed = range_of(row_of(name))
    assert (allowed.minimum, allowed.maximum) == (Decimal(minimum), Decimal(maximum))
    step = Decimal(1).scaleb(-allowed.places)
    assert in_range(Decimal(minimum), allowed) and in_range(Decimal(maximum), allowed)
    assert not in_range(Decimal(minimum) - step, allowed)
    assert not in_range(Decimal(maximum) + step, allowed)


@pytest.mark.parametrize(("name", "places"), [("A", 4), ("V", 4), ("SGP", 8), ("LH", 0), ("SOFFS", 3), ("EOT", 0)])
def test_places_kept_of_what_is_typed(name: str, places: int) -> None:
    assert range_of(row_of(name)).places == places


def test_an_open_range_takes_anything() -> None:
    assert in_range(Decimal(10) ** 30, Range(None, None, 0)) and in_range(-(Decimal(10) ** 30), Range(None, None, 0))


@pytest.mark.parametrize(
    ("name", "defaults"),
    [
        ("A", ["10", "10"]),
        ("V", ["1", "1"]),
        ("D", ["4000", "4000"]),
        ("LH", ["3", "3"]),
        ("SGP", ["0.5", "0.5"]),
        ("EOT", ["13", "0", "0"]),
        ("ERROK", ["13", "10", "62", "32"]),
        ("ERRLVL", ["4"]),
        ("INDEB", ["4", "24"]),
        ("SSFR", ["4"]),
        ("SMPER", ["4000", "4000"]),
        ("TIMINT", ["0", "0"]),
    ],
)
def test_default_values(name: str, defaults: list[str]) -> None:
    assert list(default_values(row_of(name))) == [Decimal(text) for text in defaults]


def test_catalogue_numbers_are_exact() -> None:
    assert as_decimal(0.00025) == Decimal("0.00025") and as_decimal("+0") == 0


VELOCITY = Range(Decimal(0), Decimal(200), 4)


def test_a_number_is_truncated_before_it_is_checked() -> None:
    assert checked_number(Decimal("9.99999"), VELOCITY, field=1, fields=2) == Decimal("9.9999")
    assert checked_number(Decimal("200.00009"), VELOCITY, field=1, fields=2) == 200
    assert checked_number(Decimal("-0.00009"), VELOCITY, field=1, fields=2) == 0


@pytest.mark.parametrize(
    ("value", "field", "fields", "text"),
    [
        ("200.0001", 1, 2, "INVALID DATA-FIELD 1"),
        ("-1", 2, 2, "INVALID DATA-FIELD 2"),
        ("201", 1, 1, INVALID_DATA),
        ("9" * 98, 2, 2, "INVALID DATA-FIELD 2"),
        ("0." + "9" * 96 + "9", 1, 2, ""),
    ],
)
def test_out_of_range_names_the_field_unless_there_is_but_one(value: str, field: int, fields: int, text: str) -> None:
    if not text:
        assert checked_number(Decimal(value), VELOCITY, field=field, fields=fields) == Decimal("0.9999")
        return
    with pytest.raises(CommandError) as caught:
        checked_number(Decimal(value), VELOCITY, field=field, fields=fields)
    assert caught.value.text == text


def test_a_direction_where_a_number_belongs_is_incorrect_data() -> None:
    with pytest.raises(CommandError, match=INCORRECT_DATA):
        checked_number(Direction.POSITIVE, VELOCITY, field=1, fields=2)


@pytest.mark.parametrize("value", [None, VariableReference("VAR", 1)])
def test_an_empty_or_unsubstituted_field_is_the_callers_mistake(value: FieldValue) -> None:
    with pytest.raises(TypeError):
        checked_number(value, VELOCITY, field=1, fields=2)


@settings(deadline=None)
@given(value=st.decimals(allow_nan=False, allow_infinity=False, min_value=-(10**12), max_value=10**12, places=9))
def test_a_checked_number_lies_in_the_range_and_below_what_was_typed(value: Decimal) -> None:
    try:
        number = checked_number(value, VELOCITY, field=1, fields=2)
    except CommandError:
        assert value <= Decimal("-0.0001") or value > 200
    else:
        assert 0 <= number <= 200
        assert abs(value) - abs(number) < Decimal("0.0001")
        assert abs(number) <= abs(value)

"""The catalogue as data: complete, consistent with itself, with the status enumerations and with the error texts."""

from __future__ import annotations

import re
from collections import Counter
from decimal import Decimal

import pytest

from protocol import catalogue, errors, status
from protocol.catalogue import CommandRow
from protocol.fields import default_values, in_range, range_of
from protocol.reply_shapes import mask_line, numbers_line, places_of, word_line

ROWS = catalogue.rows()
SETTINGS = [row for row in ROWS if row.kind == "setting"]
NUMERIC = [row for row in ROWS if row.fields.type in ("real", "int")]

GROUPS = {
    *("analog", "communications", "compiled", "contouring", "data", "display_rp240", "drive", "error", "following"),
    *("homing", "io", "jog_joystick", "limits", "memory", "motion", "operators", "program", "program_flow"),
    *("registration", "scaling", "servo", "status", "timer", "variables"),
}

DEFAULT_NOT_IN_EXAMPLE = {"TRGFN"}
"""Settings whose example is not that of all fields at power-up (TRGFN shows one axis and trigger)."""


def name_of(row: CommandRow) -> str:
    return row.name


def test_the_number_of_rows() -> None:
    """As many as the command list this catalogue was made from."""
    assert len(ROWS) == 382


def test_the_groups() -> None:
    assert {row.group for row in ROWS} == GROUPS


@pytest.mark.parametrize("names", [{"operand"}, {"operator"}, {"setting", "report", "action", "flow"}])
def test_names_are_unique_among_commands_operands_and_operators(names: set[str]) -> None:
    counts = Counter(name for row in ROWS if row.kind in names for name in (row.name, *row.aliases))
    assert [name for name, count in counts.items() if count > 1] == []


@pytest.mark.parametrize("row", ROWS, ids=name_of)
def test_every_row_is_complete(row: CommandRow) -> None:
    assert row.name == row.name.upper() or row.name.startswith("<")
    assert row.name
    assert row.title and row.syntax
    assert row.source, "every row says where it is known from"
    assert row.confidence in ("high", "medium", "low")
    assert row.fields.count >= 0
    assert (row.reply != "none") == (row.kind in ("setting", "report"))
    assert row.reply == "none" or row.query_response
    for text in (row.title, row.syntax, row.query_response, row.needs, row.notes, row.source):
        assert text == text.strip() and "\n" not in text


@pytest.mark.parametrize("row", NUMERIC, ids=name_of)
def test_ranges_and_defaults(row: CommandRow) -> None:
    allowed = range_of(row)
    if allowed.minimum is not None and allowed.maximum is not None:
        assert allowed.minimum < allowed.maximum
    if row.fields.default is None:
        return
    values = default_values(row)
    assert len(values) == row.fields.count
    assert all(in_range(value, allowed) for value in values)


@pytest.mark.parametrize("row", [row for row in ROWS if row.reply == "numbers"], ids=name_of)
def test_numeric_replies_say_how_they_print(row: CommandRow) -> None:
    assert row.fields.number_format in ("fixed", "signed", "shortest")
    assert 0 <= places_of(row) <= 8


@pytest.mark.parametrize("row", [row for row in ROWS if row.fields.per_axis and row.fields.count], ids=name_of)
def test_commands_with_a_field_an_axis_have_two(row: CommandRow) -> None:
    assert row.fields.count == 2
    assert "<a>" in row.syntax or row.name == "GOL", "only the interpolated GO takes no axis prefix"


_WITH_DEFAULT = [
    row for row in SETTINGS if row.reply in ("numbers", "mask", "word") and row.name not in DEFAULT_NOT_IN_EXAMPLE
]


@pytest.mark.parametrize("row", _WITH_DEFAULT, ids=name_of)
def test_the_example_of_a_setting_shows_its_default(row: CommandRow) -> None:
    shown = re.split(r" ; | \(", row.query_response)[0]
    if row.reply == "numbers":
        values = default_values(row)
        line = numbers_line(row, None, values, [places_of(row)] * len(values))
    else:
        bits = str(row.fields.default if row.fields.default is not None else 0) * row.fields.count
        line = mask_line(row, None, bits) if row.reply == "mask" else word_line(row, None, bits)
    assert f"*{line.label}{line.value}" == shown


def test_lookup() -> None:
    for name in ("V", "v", "TPE", "PE"):
        row = catalogue.lookup(name)
        assert row is not None and row.name == name.upper()
    alias = catalogue.lookup("lscw")
    assert alias is not None and alias.name == "LSPOS"
    assert catalogue.lookup("XYZZY") is None
    assert catalogue.lookup("") is None


def test_commands_operands_and_operators_are_apart() -> None:
    assert catalogue.commands()["OUT"].kind == "setting" and catalogue.operands()["OUT"].kind == "operand"
    assert not {row.kind for row in catalogue.commands().values()} & {"operator", "operand"}
    assert {row.kind for row in catalogue.operands().values()} == {"operand"}
    assert not any(name.startswith("<") for name in catalogue.commands())


def test_the_tables_cannot_be_changed_by_a_reader() -> None:
    for table in (catalogue.commands(), catalogue.operands(), catalogue.other_product_names()):
        with pytest.raises(TypeError):
            table["V"] = None  # type: ignore[index]
    with pytest.raises(AttributeError):
        ROWS[0].name = "X"  # type: ignore[misc]


def test_a_name_of_another_product_is_not_a_command_of_this_one() -> None:
    for name in catalogue.other_product_names():
        row = catalogue.commands().get(name)
        assert row is None or not row.applies_to_oem6250, name


def test_every_row_that_does_not_apply_has_an_error() -> None:
    absent = {row.name for row in ROWS if not row.applies_to_oem6250 and row.kind != "operand"}
    assert absent
    assert absent <= set(catalogue.other_product_names())


def error_texts() -> set[str]:
    return {row.text for row in catalogue.error_rows()}


def test_error_rows() -> None:
    rows = catalogue.error_rows()
    assert len(rows) == len(error_texts())
    assert all(row.text and row.trigger and row.confidence in ("high", "medium", "low") for row in rows)
    assert set(catalogue.other_product_names().values()) <= error_texts()


CONSTANTS = [name for name, value in vars(errors).items() if name.isupper() and isinstance(value, str)]


@pytest.mark.parametrize("name", CONSTANTS)
def test_every_error_constant_is_a_text_of_the_unit(name: str) -> None:
    assert getattr(errors, name) in error_texts()


@pytest.mark.parametrize(
    "error", [errors.invalid_data_field(2), errors.s_curve_acceleration(2), errors.s_curve_deceleration(2)]
)
def test_errors_with_a_number_follow_their_rows(error: errors.CommandError) -> None:
    assert error.text == str(error)
    assert re.sub(r"\d+$", "n", error.text) in error_texts()


ENUMERATIONS: dict[str, type[status.StatusBit]] = {
    "AS": status.AxisStatus,
    "ASX": status.ExtendedAxisStatus,
    "SS": status.SystemStatus,
    "ER": status.ErrorStatus,
    "FS": status.FollowingStatus,
    "INO": status.OtherInputs,
}


@pytest.mark.parametrize("word", ENUMERATIONS)
def test_the_enumeration_names_exactly_the_bits_in_use(word: str) -> None:
    row = catalogue.status_words()[word]
    in_use = {bit.number for bit in row.bit if bit.label != "RESERVED"}
    assert {int(bit) for bit in ENUMERATIONS[word]} == in_use


@pytest.mark.parametrize("word", catalogue.status_words())
def test_bits_are_listed_once_in_order(word: str) -> None:
    row = catalogue.status_words()[word]
    assert row.source and row.scope in ("per axis", "system")
    expected = 1
    for bit in row.bit:
        assert bit.number == expected
        expected = (bit.last_number or bit.number) + 1
    assert expected - 1 in (0, 2, 6, 8, 16, 26, 32)


@pytest.mark.parametrize(
    ("bit", "number"),
    [
        (status.AxisStatus.MOVING, 1),
        (status.AxisStatus.HOME_SUCCESSFUL, 5),
        (status.AxisStatus.DRIVE_SHUTDOWN, 13),
        (status.AxisStatus.DRIVE_FAULTED, 14),
        (status.AxisStatus.POSITIVE_HARD_LIMIT_HIT, 15),
        (status.AxisStatus.NEGATIVE_SOFT_LIMIT_HIT, 18),
        (status.AxisStatus.POSITION_ERROR_EXCEEDED, 23),
        (status.AxisStatus.IN_TARGET_ZONE, 24),
        (status.AxisStatus.TARGET_ZONE_TIMEOUT, 25),
        (status.AxisStatus.GOWHEN_PENDING, 26),
        (status.SystemStatus.EXECUTING_PROGRAM, 3),
        (status.SystemStatus.IMMEDIATE_COMMAND, 4),
        (status.SystemStatus.COMMAND_ERROR, 11),
        (status.SystemStatus.RP240_CONNECTED, 21),
        (status.SystemStatus.NONVOLATILE_MEMORY_ERROR, 22),
        (status.ErrorStatus.HARD_LIMIT_HIT, 2),
        (status.ErrorStatus.ENABLE_INPUT_OPEN, 9),
        (status.ErrorStatus.POSITION_ERROR_EXCEEDED, 12),
        (status.ErrorStatus.GOWHEN_ALREADY_TRUE, 14),
        (status.ErrorStatus.BAD_COMMAND, 16),
        (status.FollowingStatus.POSITION_PREDICTION_ON, 17),
        (status.OtherInputs.ENABLE, 6),
    ],
)
def test_bits_that_hosts_and_the_error_table_rely_on(bit: status.StatusBit, number: int) -> None:
    assert int(bit) == number
    assert bit.mask == 1 << (number - 1)


def test_io_functions() -> None:
    for kind in ("infnc", "outfnc"):
        table = catalogue.io_functions(kind)
        assert all(letter == row.letter and row.meaning and row.confidence for letter, row in table.items())
    assert {"A", "C", "D", "F", "H"} <= set(catalogue.io_functions("infnc"))


def test_numbers_in_the_catalogue_survive_as_written() -> None:
    row = catalogue.commands()["A"]
    assert range_of(row).minimum == Decimal("0.00025")


def test_the_packed_catalogue_is_the_present_one() -> None:
    from protocol.pack import PACKED, pack

    assert PACKED.read_text("utf-8") == pack(), "run: python -m protocol.pack"

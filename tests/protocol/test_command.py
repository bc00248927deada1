"""One command read into its parts: every form the references show, and the error each bad form draws."""

from __future__ import annotations

import time
from decimal import Decimal

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from protocol import catalogue
from protocol.command import (
    Direction,
    FieldValue,
    VariableReference,
    check_program_name,
    is_command_name,
    normalise,
    parse_command,
)
from protocol.errors import (
    COMMAND_NOT_IMPLEMENTED,
    INCORRECT_AXIS,
    INCORRECT_DATA,
    INVALID_COMMAND,
    STRING_IS_TOO_LONG,
    UNDEFINED_LABEL,
    CommandError,
)


def number(text: str) -> Decimal:
    return Decimal(text)


def refusal(text: str) -> str:
    with pytest.raises(CommandError) as caught:
        parse_command(text)
    return caught.value.text


@pytest.mark.parametrize(
    ("text", "address", "immediate", "all_axes", "axis", "name", "argument"),
    [
        ("V5", None, False, False, None, "V", "5"),
        ("1_ERRLVL1", 1, False, False, None, "ERRLVL", "1"),
        ("0_E1", 0, False, False, None, "E", "1"),
        ("99_ADDR5", 99, False, False, None, "ADDR", "5"),
        ("1_!1TPE", 1, True, False, 1, "TPE", ""),
        ("1_!TREV", 1, True, False, None, "TREV", ""),
        ("1_!1V5.000000", 1, True, False, 1, "V", "5.000000"),
        ("1_!K", 1, True, False, None, "K", ""),
        ("1_!TIN.3", 1, True, False, None, "TIN", ".3"),
        ("1_!1TAS", 1, True, False, 1, "TAS", ""),
        ("0_!tas.1", 0, True, False, None, "TAS", ".1"),
        ("!1V5", None, True, False, 1, "V", "5"),
        ("1!V5", None, True, False, 1, "V", "5"),
        ("@V1", None, False, True, None, "V", "1"),
        ("!@S", None, True, True, None, "S", ""),
        ("@GO1", None, False, True, None, "GO", "1"),
        ("2TPE", None, False, False, 2, "TPE", ""),
        ("3TPE", None, False, False, 3, "TPE", ""),
        ("1GO", None, False, False, 1, "GO", ""),
        ("1HOM0", None, False, False, 1, "HOM", "0"),
        ("1OUT.9-0", None, False, False, 1, "OUT", ".9-0"),
        ("2_1TPE", 2, False, False, 1, "TPE", ""),
    ],
)
def test_prefixes(
    text: str, address: int | None, immediate: bool, all_axes: bool, axis: int | None, name: str, argument: str
) -> None:
    command = parse_command(text)
    assert (command.address, command.immediate, command.all_axes, command.axis) == (address, immediate, all_axes, axis)
    assert (command.name, command.argument) == (name, argument)


@pytest.mark.parametrize(
    ("text", "normal"),
    [
        ("1_!1v 5.000000", "1V5.000000"),
        ("!comexc 1", "COMEXC1"),
        ("@ v1", "@V1"),
        ("SCLA 1,1,1,1", "SCLA1,1,1,1"),
        ("HOMBAC\t0000", "HOMBAC0000"),
        ('write "Hi there"', 'WRITE"Hi there"'),
        ('vars1 = "a b" ', 'VARS1="a b"'),
        ("1!v5", "1V5"),
    ],
)
def test_the_stored_text_is_upper_case_without_blanks_address_and_exclamation(text: str, normal: str) -> None:
    assert parse_command(text).text == normal


@pytest.mark.parametrize(
    ("text", "name", "mask"),
    [
        ("GOX1XXXXXX", "GO", "X1XXXXXX"),
        ("GOX1", "GO", "X1"),
        ("gox1", "GO", "X1"),
        ("S01000000", "S", "01000000"),
        ("!S10", "S", "10"),
        ("!S01", "S", "01"),
        ("DRIVE11", "DRIVE", "11"),
        ("DRIVE1,1", "DRIVE", "11"),
        ("MC000000", "MC", "000000"),
        ("MA110000", "MA", "110000"),
        ("HOMX0", "HOM", "X0"),
        ("HOMBAC 0000", "HOMBAC", "0000"),
        ("COMEXC1", "COMEXC", "1"),
        ("1DRIVE1", "DRIVE", "1"),
        ("OUT1_1", "OUT", "11"),
        ("INENEE01", "INEN", "EE01"),
        ("OUTENE_1X", "OUTEN", "E1X"),
    ],
)
def test_masks(text: str, name: str, mask: str) -> None:
    command = parse_command(text)
    assert (command.name, command.mask, command.values, command.is_query) == (name, mask, (), False)


@pytest.mark.parametrize(
    ("text", "name", "values"),
    [
        ("d,90", "D", (None, number("90"))),
        ("LSPOS,1000000", "LSPOS", (None, number("1000000"))),
        ("PSET,,,0", "PSET", (None, None, None, number("0"))),
        ("ERES ,,,", "ERES", (None,) * 4),
        ("V,5", "V", (None, number("5"))),
        ("1V5.000000", "V", (number("5.000000"),)),
        ("1D25000.000000", "D", (number("25000.000000"),)),
        ("D+4000", "D", (number("4000"),)),
        ("D-4000,+12", "D", (number("-4000"), number("12"))),
        ("D+", "D", (Direction.POSITIVE,)),
        ("1D-", "D", (Direction.NEGATIVE,)),
        ("D~", "D", (Direction.TOGGLE,)),
        ("D,-", "D", (None, Direction.NEGATIVE)),
        ("T(VAR4)", "T", (VariableReference("VAR", 4),)),
        ("D(VAR1)", "D", (VariableReference("VAR", 1),)),
        ("V(VAR2),(VAR3)", "V", (VariableReference("VAR", 2), VariableReference("VAR", 3))),
        ("V.5", "V", (number("0.5"),)),
        ("V5.", "V", (number("5"),)),
        ("EOT13,10,0", "EOT", (number("13"), number("10"), number("0"))),
        ("1PSET0", "PSET", (number("0"),)),
        ("1SGP10", "SGP", (number("10"),)),
        ("SCLA 1,1,1,1", "SCLA", (number("1"),) * 4),
        ("LSCW5", "LSPOS", (number("5"),)),
        ("LSCCW,-5", "LSNEG", (None, number("-5"))),
    ],
)
def test_fields(text: str, name: str, values: tuple[FieldValue, ...]) -> None:
    command = parse_command(text)
    assert (command.name, command.values, command.mask, command.is_query) == (name, values, "", False)


@pytest.mark.parametrize(
    ("text", "name", "bit", "bit_value", "is_query"),
    [
        ("OUT.5-1", "OUT", 5, "1", False),
        ("OUT.2-1", "OUT", 2, "1", False),
        ("ERROR.9-1", "ERROR", 9, "1", False),
        ("INEN.3-E", "INEN", 3, "E", False),
        ("TAS.1", "TAS", 1, "", True),
        ("1TAS.24", "TAS", 24, "", True),
        ("TSS.3", "TSS", 3, "", True),
        ("TIN.3", "TIN", 3, "", True),
        ("TLIM.6", "TLIM", 6, "", True),
        ("ERROR.9", "ERROR", 9, "", True),
    ],
)
def test_single_bits(text: str, name: str, bit: int, bit_value: str, is_query: bool) -> None:
    command = parse_command(text)
    assert (command.name, command.bit, command.bit_value, command.is_query) == (name, bit, bit_value, is_query)
    assert (command.mask, command.values) == ("", ())


def test_a_binary_variable_stands_for_a_pattern() -> None:
    assert parse_command("OUT(VARB1)").variable == VariableReference("VARB", 1)


@pytest.mark.parametrize(
    ("text", "name", "argument"),
    [
        ("DEL SETUP", "DEL", "SETUP"),
        ("DEF PROG1", "DEF", "PROG1"),
        ("STARTP MAIN", "STARTP", "MAIN"),
        ("GOSUB main", "GOSUB", "MAIN"),
        ("$PICK", "$", "PICK"),
        ("VAR1=5+3*2", "VAR", "1=5+3*2"),
        ("VARB1=b1101XX1", "VARB", "1=B1101XX1"),
        ("VARB1.3-1", "VARB", "1.3-1"),
        ('VARS1="HI MOM\\13"', "VARS", '1="HI MOM\\13"'),
        ('WRITE"a, b"', "WRITE", '"a, b"'),
        ("WAIT(AS.1=b0)", "WAIT", "(AS.1=B0)"),
        ("WAIT(6AS=XXXX1 AND 5AS=XXXX1)", "WAIT", "(6AS=XXXX1AND5AS=XXXX1)"),
        ("GOWHEN(1PE>4000)", "GOWHEN", "(1PE>4000)"),
        ("GOWHEN(1PE>1),(2PE>2)", "GOWHEN", "(1PE>1),(2PE>2)"),
        ("GOWHEN,(2PE>2)", "GOWHEN", ",(2PE>2)"),
        ("INFNC1-D", "INFNC", "1-D"),
        ("OUTPA1,5,+0,3", "OUTPA", "1,5,+0,3"),
        ("'10.0", "'", "10.0"),
        ("TPCAA", "TPCA", "A"),
    ],
)
def test_arguments_with_a_syntax_of_their_own(text: str, name: str, argument: str) -> None:
    command = parse_command(text)
    assert (command.name, command.argument) == (name, argument)
    assert command.row is not None and command.row.name == name


@pytest.mark.parametrize(
    "word",
    ["SETUP", "XYZZY", "MAIN", "PROG1", "GOX1Y", "V5X", "DRIVE2", "TAS1", "SETUP1", "HELLO WORLD"],
)
def test_a_word_no_command_claims_names_a_program(word: str) -> None:
    command = parse_command(word)
    assert command.row is None
    assert command.name == word.replace(" ", "")


@pytest.mark.parametrize(
    ("text", "name"),
    [("GO11", "GO"), ("GOL11", "GOL"), ("TASX", "TASX"), ("TASF", "TASF"), ("AD5", "AD"), ("ADA5", "ADA"), ("E1", "E")],
)
def test_the_longest_name_wins(text: str, name: str) -> None:
    assert parse_command(text).name == name


_OWN_ROWS = [row for row in catalogue.rows() if catalogue.commands().get(row.name) is row and row.applies_to_oem6250]


@pytest.mark.parametrize("row", _OWN_ROWS, ids=lambda row: row.name)
def test_every_command_of_the_unit_is_found_by_its_name(row: catalogue.CommandRow) -> None:
    """The bare name is read as that command, unless the command cannot go without an argument."""
    try:
        command = parse_command(row.name)
    except CommandError as error:
        assert error.text == INCORRECT_DATA
    else:
        assert command.name == row.name


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("DRES10000,19685", COMMAND_NOT_IMPLEMENTED),
        ("EPM1", COMMAND_NOT_IMPLEMENTED),
        ("PULSE,1", COMMAND_NOT_IMPLEMENTED),
        ("INTHW.1-1", COMMAND_NOT_IMPLEMENTED),
        ("LDTRES1", COMMAND_NOT_IMPLEMENTED),
        ("TLDT", COMMAND_NOT_IMPLEMENTED),
        ("FMAXA10", COMMAND_NOT_IMPLEMENTED),
        ("FMAXV", COMMAND_NOT_IMPLEMENTED),
        ("PTAN1", COMMAND_NOT_IMPLEMENTED),
        ("OUTPC1,5", INCORRECT_AXIS),
        ("REGC500", INCORRECT_AXIS),
        ("POUTD1", INCORRECT_AXIS),
        ("FVMFRQ5,5", UNDEFINED_LABEL),
        ("1TSWAP.3", UNDEFINED_LABEL),
        ("VARI1=5", UNDEFINED_LABEL),
        ("WHEN(1AS.1=B1)", UNDEFINED_LABEL),
    ],
)
def test_names_of_other_products(text: str, error: str) -> None:
    assert refusal(text) == error


@pytest.mark.parametrize("name", sorted(catalogue.other_product_names()))
def test_every_name_of_another_product_draws_its_error(name: str) -> None:
    """Names of later products are program names that no unit has: the interpreter answers UNDEFINED LABEL."""
    expected = catalogue.other_product_names()[name]
    if expected == UNDEFINED_LABEL:
        assert parse_command(name).row is None
    else:
        assert refusal(name) == expected
        assert refusal(f"{name},1") == expected


@pytest.mark.parametrize("text", ["BAUD9600", "OPTEN1", "AXSDEF11", "DRFEN1", "TNTMAC", "LIMLVL110110"])
def test_six_k_commands_read_as_unknown_programs(text: str) -> None:
    assert parse_command(text).row is None


def test_tpm_is_answered() -> None:
    assert parse_command("1TPM").name == "TPM"


@pytest.mark.parametrize(
    "text",
    [
        "V--5",
        "V1.2.3",
        "V.",
        "A-",
        "A+",
        "GO-",
        "V5,,+",
        "TAS.",
        "TAS.X",
        "TAS.1-1",
        "OUT.5-2",
        "OUT.5-",
        "V(VAR1",
        "V()",
        "V(VARB1)",
        "DRIVE(VAR1)",
        "A\x0110",
        "V\u0663",
        "D(VAR)",
        "TPE,1",
    ],
)
def test_a_malformed_field_is_incorrect_data(text: str) -> None:
    assert refusal(text) == INCORRECT_DATA


@pytest.mark.parametrize(
    "text", ["", "!", "@", "1", "1_", "5,5", "_", "?", "%#", "\xe9", "\xdf", "\xb5V", "\u0663V5", '"A"', "(A)", "-5"]
)
def test_what_cannot_be_a_word_is_an_invalid_command(text: str) -> None:
    assert refusal(text) == INVALID_COMMAND


@pytest.mark.parametrize(
    ("typed", "normal"),
    [("a 1\t0", "A10"), ('write "a b" ', 'WRITE"a b"'), ('write"a b', 'WRITE"a b'), ("\xdf\xff\xb5a", "\xdf\xff\xb5A")],
)
def test_normalise(typed: str, normal: str) -> None:
    assert normalise(typed) == normal


@pytest.mark.parametrize(("name", "error"), [("MAINLOOP", STRING_IS_TOO_LONG), ("1A", INCORRECT_DATA)])
def test_bad_program_names(name: str, error: str) -> None:
    with pytest.raises(CommandError) as caught:
        check_program_name(name)
    assert caught.value.text == error


def test_program_names_and_command_names() -> None:
    assert check_program_name("PROG12") == "PROG12"
    assert is_command_name("GO") and is_command_name("PE") and is_command_name("LSCW")
    assert not is_command_name("MAIN")


@pytest.mark.parametrize(
    "text",
    [
        "GOWHEN(" + "),(" * 30 + "X",
        "GOWHEN" + "," * 90 + "X",
        "V" + "1" * 98 + "!",
        "V" + "(VAR1)," * 13 + "!",
        "D" + "+," * 48 + "!",
        "OUT" + "X" * 96 + "!",
        "WAIT" + "(" * 95 + "!",
        "INFNC" + "1" * 94 + "!",
    ],
)
def test_no_line_of_the_permitted_length_takes_long_to_refuse(text: str) -> None:
    """A pattern that backtracks exponentially would hold the unit for hours on one of these."""
    started = time.process_time()
    refusal(text)
    assert time.process_time() - started < 0.5


@pytest.mark.parametrize("text", ["TAS." + "1" * 5000, "1" * 5000 + "V", "V(VAR" + "1" * 5000 + ")", "1" * 5000 + "_V"])
def test_numbers_longer_than_any_line_are_refused_too(text: str) -> None:
    assert refusal(text) in (INCORRECT_DATA, INVALID_COMMAND)


UNIT_TEXTS = {INCORRECT_DATA, INVALID_COMMAND, UNDEFINED_LABEL, COMMAND_NOT_IMPLEMENTED, INCORRECT_AXIS}


def check_reading(text: str) -> None:
    """Any text is read as a command, or refused with a text of the unit."""
    try:
        command = parse_command(text)
    except CommandError as error:
        assert error.text in UNIT_TEXTS
        return
    assert command.text.isascii() or command.row is not None
    assert command.row is None or command.row.applies_to_oem6250
    assert set(command.mask) <= set("01XE")
    again = parse_command(command.text)
    assert (again.name, again.argument, again.values, again.mask) == (
        command.name,
        command.argument,
        command.values,
        command.mask,
    )


@settings(deadline=None, max_examples=300)
@example("\u2167")
@given(text=st.text(max_size=120))
def test_any_text_is_read_or_refused(text: str) -> None:
    check_reading(text)


@settings(deadline=None, max_examples=300)
@given(data=st.binary(max_size=120))
def test_any_bytes_of_the_wire_are_read_or_refused_in_the_character_set_of_the_wire(data: bytes) -> None:
    text = data.decode("latin-1")
    check_reading(text)
    assert normalise(text).encode("latin-1") is not None


_NAMES = st.sampled_from(sorted(catalogue.commands()) + sorted(catalogue.other_product_names()))
_PREFIXES = st.sampled_from(["", "!", "1", "2", "3", "0", "@", "1_", "0_!", "1_!1", "12_", "!@", "1!", "_", "!!"])
_FRAGMENTS = st.sampled_from(
    [
        "1",
        "0",
        "X",
        "E",
        ",",
        ".",
        "-",
        "+",
        "~",
        "5.000000",
        "(VAR1)",
        "(VARB2)",
        ".3-1",
        "=",
        '"',
        "MAIN",
        "(",
        ")",
        "A",
    ]
)


@settings(deadline=None, max_examples=600)
@given(prefix=_PREFIXES, name=_NAMES, fragments=st.lists(_FRAGMENTS, max_size=6))
def test_almost_commands_are_read_or_refused(prefix: str, name: str, fragments: list[str]) -> None:
    check_reading(prefix + name + "".join(fragments))


@settings(deadline=None, max_examples=200)
@given(
    values=st.lists(st.none() | st.decimals(-99999, 99999, places=5), min_size=1, max_size=8),
    axis=st.none() | st.integers(0, 9),
    immediate=st.booleans(),
)
def test_fields_read_back_as_written(values: list[Decimal | None], axis: int | None, immediate: bool) -> None:
    fields = ",".join("" if value is None else f"{value:f}" for value in values)
    command = parse_command(f"{'!' if immediate else ''}{'' if axis is None else axis}V{fields}")
    assert (command.name, command.axis, command.immediate) == ("V", axis, immediate)
    assert command.values == (tuple(values) if fields else ())


@settings(deadline=None, max_examples=200)
@given(mask=st.text("01X", min_size=1, max_size=32), name=st.sampled_from(["GO", "S", "DRIVE", "OUT", "ERROR", "MC"]))
def test_masks_read_back_as_written(mask: str, name: str) -> None:
    command = parse_command(f"{name}{mask}")
    assert (command.name, command.mask) == (name, mask)

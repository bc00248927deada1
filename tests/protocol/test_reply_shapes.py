"""Replies in every shape of the catalogue: what the unit prints, a host reads back with the same row.

Each row's own example is the reference; the values in between are hypothesis's.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol import catalogue
from protocol.catalogue import CommandRow
from protocol.errors import ReplyError
from protocol.numbers import truncate
from protocol.reply import LEVEL_RULES, Framing, ReplyLine
from protocol.reply_shapes import (
    NO_PROGRAM_DEFINED,
    ParsedReply,
    bit_line,
    format_number,
    label,
    mask_line,
    name_line,
    numbers_line,
    parse_reply_line,
    places_of,
    word_line,
)
from tests.protocol.connection_pair import ConnectionPair

SHAPES = ("numbers", "mask", "word", "limits", "name")
SHAPED = [row for row in catalogue.rows() if row.reply in SHAPES]
OF_SHAPE = {shape: [row for row in SHAPED if row.reply == shape] for shape in SHAPES}

FREE_FORM = {
    "assignment": {"VAR", "VARB", "VARS"},
    "lines": {"TMEM", "TDIR", "TPROG", "TLABEL", "TGAIN", "TSGSET", "TSTAT", "HELP"},
    "table": {"TASF", "TASXF", "TSSF", "TERF", "TFSF", "TINOF"},
    "text": {"TREV", "TEX", "TCMDER", "INFNC", "OUTFNC", "INDUST"}
    | {"OUTPA", "OUTPB", "OUTPLC", "OUTTW", "INPLC", "INSTW", "ONVARA", "ONVARB"},
}
"""Rows whose reply has a form of its own; a parser of this package gives their text as it is."""

WITH_TRIGGER_LETTER = {"TPCA", "TPCC", "TPCE", "TRGFN"}
"""Rows that print the trigger letter between name and value (``*TPCAA+0,+0``)."""

WORD_BITS = {"TIN": 26, "TOUT": 26, "TINO": 8, "TUS": 16, "TAS": 32, "TASX": 32, "TSS": 32, "TER": 32, "TFS": 32}
WORD_BITS |= {"TSC": 32, "TLIM": 6}


def row_of(name: str) -> CommandRow:
    row = catalogue.lookup(name)
    assert row is not None
    return row


def name_of(row: CommandRow) -> str:
    return row.name


def examples(row: CommandRow) -> list[str]:
    """The reply lines a row's own example shows, without ERRLVL4's framing."""
    pieces = re.split(r" ; | <EOL> |-> | \(", row.query_response)
    return [piece.strip() for piece in pieces if piece.startswith("*") and "..." not in piece]


def printed(row: CommandRow, reply: ParsedReply) -> str:
    """A parsed reply formatted again with its row, as ERRLVL4 sends it."""
    line = lines_of(row, reply)
    return f"*{line.label}{reply.text if row.reply != 'name' else ''}{line.value}"


def lines_of(row: CommandRow, reply: ParsedReply) -> ReplyLine:
    if row.reply == "numbers":
        return numbers_line(row, reply.axis, reply.numbers, [places_of(row)] * len(reply.numbers))
    if row.reply == "mask":
        return mask_line(row, reply.axis, reply.bits)
    if row.reply == "name":
        return name_line(row, reply.text)
    return word_line(row, reply.axis, reply.bits)


def test_the_rows_of_free_form_are_known() -> None:
    for shape, names in FREE_FORM.items():
        assert {row.name for row in catalogue.rows() if row.reply == shape} == names


@pytest.mark.parametrize("row", SHAPED, ids=name_of)
def test_the_example_of_a_row_reads_back_to_the_same_text(row: CommandRow) -> None:
    shown = examples(row)
    assert shown
    for text in shown:
        reply = parse_reply_line(text, row)
        assert reply.name == row.name
        assert (reply.text in ("A", "B")) == (row.name in WITH_TRIGGER_LETTER) or row.reply == "name"
        assert printed(row, reply) == text


@pytest.mark.parametrize("row", SHAPED, ids=name_of)
def test_the_number_of_fields_in_the_example(row: CommandRow) -> None:
    """Two axes, or as many fields as the command takes, in the query without a prefix; one with a prefix."""
    for text in examples(row):
        reply = parse_reply_line(text, row)
        if row.reply == "numbers" and row.fields.per_axis:
            assert len(reply.numbers) == (2 if reply.axis is None else 1)
        elif row.reply == "numbers" and row.fields.count:
            assert len(reply.numbers) == row.fields.count
        elif row.reply == "mask":
            assert len(reply.bits) == (1 if reply.axis is not None and row.fields.per_axis else row.fields.count)
        elif row.reply in ("word", "limits"):
            assert len(reply.bits) == (row.fields.count or WORD_BITS[row.name])


FIELDS = st.lists(st.decimals(-999999999, 999999999, places=10), min_size=1, max_size=4)
AXIS = st.none() | st.integers(1, 2)


@settings(deadline=None, max_examples=400)
@given(row=st.sampled_from(OF_SHAPE["numbers"]), axis=AXIS, values=FIELDS, level=st.integers(0, 4))
def test_numbers_read_back_truncated(row: CommandRow, axis: int | None, values: list[Decimal], level: int) -> None:
    places = places_of(row)
    pair = ConnectionPair(Framing(rules=LEVEL_RULES[level]))
    (reply,) = pair.unit_answers(row, [numbers_line(row, axis, values, [places] * len(values))])
    assert reply.numbers == tuple(truncate(value, places) for value in values)
    assert (reply.axis, reply.name) == ((axis, row.name) if level >= 2 else (None, ""))


@settings(deadline=None, max_examples=300)
@given(row=st.sampled_from(OF_SHAPE["mask"]), axis=AXIS, bits=st.text("01X", min_size=1, max_size=4))
def test_masks_read_back(row: CommandRow, axis: int | None, bits: str) -> None:
    for rules in LEVEL_RULES:
        (reply,) = ConnectionPair(Framing(rules=rules)).unit_answers(row, [mask_line(row, axis, bits)])
        assert (reply.bits, reply.text) == (bits, "")
        assert (reply.axis, reply.name) == ((axis, row.name) if rules.names else (None, ""))


@settings(deadline=None, max_examples=300)
@given(
    row=st.sampled_from(OF_SHAPE["word"] + OF_SHAPE["limits"]),
    axes=st.sampled_from([(None,), (1,), (2,), (1, 2)]),
    bits=st.text("01XE", min_size=1, max_size=32),
)
def test_words_read_back_line_by_line(row: CommandRow, axes: Sequence[int | None], bits: str) -> None:
    for rules in LEVEL_RULES:
        lines = [word_line(row, axis, bits) for axis in axes]
        replies = ConnectionPair(Framing(rules=rules)).unit_answers(row, lines)
        assert [reply.bits for reply in replies] == [bits] * len(axes)
        assert [reply.axis for reply in replies] == (list(axes) if rules.names else [None] * len(axes))


@settings(deadline=None)
@given(
    row=st.sampled_from(OF_SHAPE["name"]), program=st.from_regex(r"[A-Z][A-Z0-9]{0,5}", fullmatch=True) | st.just("")
)
def test_program_names_read_back(row: CommandRow, program: str) -> None:
    for rules in LEVEL_RULES:
        (reply,) = ConnectionPair(Framing(rules=rules)).unit_answers(row, [name_line(row, program)])
        assert reply.text == program


@pytest.mark.parametrize("row", [row for row in SHAPED if row.name in WITH_TRIGGER_LETTER], ids=name_of)
def test_the_trigger_letter_is_read_at_every_level_that_sends_it(row: CommandRow) -> None:
    value = "+12,-3" if row.reply == "numbers" else "01"
    for letter in ("A", "B"):
        reply = parse_reply_line(f"*2{row.name}{letter}{value}", row)
        assert (reply.axis, reply.name, reply.text) == (2, row.name, letter)
        assert parse_reply_line(f"*{letter}{value}", row).text == letter


@pytest.mark.parametrize(
    ("name", "value", "places", "text"),
    [
        ("TPE", "0", 0, "+0"),
        ("TPE", "-4000", 0, "-4000"),
        ("D", "4000", 0, "+4000"),
        ("D", "105.277", 3, "+105.277"),
        ("V", "9.9", 1, "9.9"),
        ("V", "5", 4, "5.0000"),
        ("SGP", "0.5", 8, "0.5"),
        ("SOFFS", "-1.5", 3, "-1.500"),
        ("TDAC", "1.25", 3, "+1.250"),
        ("TVEL", "1", 4, "+1.0000"),
        ("EOT", "13", 0, "13"),
        ("FOLRN", "1.50000", 5, "1.5"),
    ],
)
def test_each_number_format(name: str, value: str, places: int, text: str) -> None:
    assert format_number(Decimal(value), row_of(name).fields.number_format, places) == text


@pytest.mark.parametrize(
    ("name", "places"),
    [
        *(("A", 4), ("V", 4), ("D", 0), ("LSPOS", 0), ("TPE", 0), ("SMPER", 0), ("STRGTD", 0), ("SGP", 8)),
        *(("SGILIM", 8), ("FOLRN", 5), ("FOLRD", 5), ("FOLMD", 5), ("FMCP", 0), ("REGA", 0), ("REGLOD", 0)),
        *(("SOFFS", 3), ("DACLIM", 3), ("TDAC", 3), ("TVEL", 4), ("TVELA", 4), ("TVMAS", 4), ("STRGTV", 4)),
        *(("STRGTT", 0), ("TSTLT", 0), ("INDEB", 0)),
    ],
)
def test_unscaled_decimals(name: str, places: int) -> None:
    """Settled section 3."""
    assert places_of(row_of(name)) == places


def test_labels_and_bits() -> None:
    assert label(row_of("TPE"), None) == "TPE" and label(row_of("TPE"), 2) == "2TPE"
    assert label(row_of("LSCW"), 1) == "1LSPOS"
    assert bit_line("1") == ReplyLine("", "1")
    assert word_line(row_of("TLIM"), None, "110110") == ReplyLine("TLIM", "110_110")
    assert name_line(row_of("ERRORP"), "") == ReplyLine("ERRORP", f" {NO_PROGRAM_DEFINED}")


@pytest.mark.parametrize("name", ["TAS", "TSS", "TIN", "TLIM"])
def test_the_answer_to_a_single_bit_is_read_with_the_same_row(name: str) -> None:
    assert parse_reply_line("*1", row_of(name)) == ParsedReply(None, "", bits="1")


def test_texts_are_given_as_they_are_without_the_head() -> None:
    revision = row_of("TREV")
    assert parse_reply_line("*TREV92-000000-01-4.7 OEM6250", revision).text == "92-000000-01-4.7 OEM6250"
    assert parse_reply_line("*92-000000-01-4.7 OEM6250", revision).text == "92-000000-01-4.7 OEM6250"
    assert parse_reply_line("*92-TREV OEM6250", revision) == ParsedReply(None, "", text="92-TREV OEM6250")
    assert parse_reply_line("*VAR1=+35.0", row_of("VAR")) == ParsedReply(None, "VAR", text="1=+35.0")


def test_axes_must_have_places_each() -> None:
    with pytest.raises(ValueError, match="argument"):
        numbers_line(row_of("V"), None, [Decimal(1), Decimal(2)], [4])


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("TPE", "*TPE"),
        ("TPE", "*TPC+0,+0"),
        ("TPE", "*1TAS0000_0000"),
        ("TPE", "*TPE+0,"),
        ("TPE", "*0000_0000"),
        ("TPE", "*UNDEFINED LABEL"),
        ("DRIVE", "*DRIVE"),
        ("DRIVE", "*DRIVE0_0"),
        ("DRIVE", "*2"),
        ("TAS", "*1TAS"),
        ("TAS", "*1TAS00000000"),
        ("TAS", "*1TASX0000_0000"),
        ("TLIM", "*TLIM1101_10"),
    ],
)
def test_a_reply_of_another_shape_is_a_reply_error(name: str, line: str) -> None:
    with pytest.raises(ReplyError):
        parse_reply_line(line, row_of(name))


@settings(deadline=None, max_examples=300)
@given(
    row=st.sampled_from(list(catalogue.rows())),
    line=st.text(max_size=40) | st.text("*12TASPEX_01+-.,\n ", max_size=40),
)
def test_any_line_is_read_or_a_reply_error(row: CommandRow, line: str) -> None:
    try:
        reply = parse_reply_line(line, row)
    except ReplyError:
        return
    assert reply == replace(reply)
    if row.reply in ("word", "limits"):
        assert reply.bits

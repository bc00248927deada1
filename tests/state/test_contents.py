"""Contents as rows and back."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given, settings

from emulator.state.contents import Contents, Key, contents_of, difference, parts, rows_of
from tests.state.samples import FULL, contents


def written(kept: Contents) -> str:
    """Every digit of it (equal decimals may be written differently)."""
    return repr(kept)


@settings(max_examples=40)
@given(contents())
def test_rows_hold_everything_exactly(kept: Contents) -> None:
    assert written(contents_of(rows_of(kept))) == written(kept)


def test_what_is_at_its_power_up_value_has_no_row() -> None:
    cleared = Contents(numbers=(Decimal(0),) * 150, bits=("X" * 32,) * 25, texts=("",) * 25)
    assert rows_of(cleared) == {}


def test_one_thing_a_row() -> None:
    rows = rows_of(FULL)
    assert rows[Key("VAR", "", 2)] == "3.50000000"
    assert rows[Key("program", "MAIN", 3)] == "VAR1=VAR1+1"
    assert rows[Key("scaled", "MAIN", 1)] == "1=2.0*25000"
    assert rows[Key("directory", "", 0)] == "MAIN EMPTY DATP1"
    assert rows[Key("gain", "SGSET1 axis2 SFB1 SMPER", 0)] == "4000*25000"


def test_only_places_that_differ_are_looked_at() -> None:
    one, two, three = Decimal("1.0"), Decimal("2.0"), Decimal("1.00")
    before = parts(Contents(numbers=(one, two)))["VAR", ""]
    assert difference(before, before) == ({}, {})
    after = parts(Contents(numbers=(three, two, one)))["VAR", ""]
    first, third = Key("VAR", "", 1), Key("VAR", "", 3)
    assert difference(before, after) == ({first: "1.0"}, {first: "1.00", third: "1.0"})
    assert difference(None, before)[0] == difference(before, None)[1] == {}


@settings(max_examples=25)
@given(contents(), contents())
def test_a_difference_leads_from_one_to_the_other(old: Contents, new: Contents) -> None:
    rows, before, after = rows_of(old), parts(old), parts(new)
    changes = [difference(before.get(name), after.get(name)) for name in before.keys() | after.keys()]
    for was, _ in changes:
        for key in was:
            del rows[key]
    for _, now in changes:
        rows |= now
    assert rows == rows_of(new)


def test_programs_the_directory_does_not_list_come_last() -> None:
    rows = rows_of(FULL)
    rows[Key("directory", "", 0)] = "EMPTY"
    assert [program.name for program in contents_of(rows).programs] == ["EMPTY", "DATP1", "MAIN"]


@pytest.mark.parametrize(
    ("key", "text"),
    [
        (Key("VAR", "", 1), "abc"),
        (Key("VAR", "", 1), "NaN"),
        (Key("VAR", "", 0), "1"),
        (Key("VARB", "", 1), "01"),
        (Key("gain", "SGP", 0), "1"),
        (Key("gain", "SGSET1 axis1 SFB1 SGP", 0), "1*x"),
        (Key("program", "P", 2), "V1"),
        (Key("scaled", "P", 1), "nonsense"),
        (Key("scaled", "P", 9), "1=5"),
        (Key("directory", "", 0), "P P"),
        (Key("weather", "", 0), "rain"),
    ],
)
def test_a_row_that_says_nothing(key: Key, text: str) -> None:
    with pytest.raises(ValueError, match=r".+"):
        contents_of({key: text})

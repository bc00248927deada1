"""Data programs: numbers are read in turn whatever the statements' lengths, and taught where they belong."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.controller.variables.data_statements import is_data_program, numbers_of, statement_of, statements_of
from tests.controller.session import Session

NUMBERS = st.decimals(-999999, 999999, places=3)


@given(numbers=st.lists(NUMBERS, min_size=1, max_size=4))
def test_a_statement_printed_reads_back(numbers: list[Decimal]) -> None:
    assert list(numbers_of(statement_of(numbers))) == numbers


@given(numbers=st.lists(NUMBERS, max_size=30))
def test_statements_hold_all_numbers_in_order(numbers: list[Decimal]) -> None:
    statements = statements_of(numbers)
    assert [value for statement in statements for value in numbers_of(statement)] == numbers
    assert len(statements) == -(-len(numbers) // 4)


@pytest.mark.parametrize(
    ("name", "is_one"), [("DATP1", True), ("DATP50", True), ("DATP51", False), ("DATP0", False), ("DATP01", False)]
)
def test_names(name: str, is_one: bool) -> None:
    assert is_data_program(name) is is_one


@settings(deadline=None, max_examples=10)
@given(statements=st.lists(st.lists(NUMBERS, min_size=1, max_size=4), min_size=1, max_size=4))
def test_every_number_is_read_in_turn_and_the_end_warns(statements: list[list[Decimal]]) -> None:
    session = Session()
    for line in ("DEF DATP7", *map(statement_of, statements), "END"):
        session.ask(line)
    numbers = [number for statement in statements for number in statement]
    for number in numbers + numbers[:1]:
        session.ask("VAR1=DAT7")
        assert Decimal(session.look("VAR1").removeprefix("VAR1=")) == number


def test_teaching_fills_a_data_program() -> None:
    session = Session()
    session.ok("DATSIZ3,6", *(f"VAR{n}={n * 1.5}" for n in range(1, 7)), "DATTCH1,2,3,4", "DATPTR3,5,1", "DATTCH5")
    session.ask("DATTCH6")
    for n in range(1, 7):
        session.ask("VAR9=DAT3")
        assert session.look("VAR9") == f"VAR9=+{n * 1.5}"


def test_a_data_program_defined_anew_is_read_anew() -> None:
    session = Session()
    for value in (5, 6):
        for line in ("DEL DATP1", "DEF DATP1", f"DATA={value},{value}", "END"):
            session.ask(line)
        session.ok("DATRST1", "VAR1=DAT1")
        assert session.query("VAR1") == f"VAR1=+{value}.0"


def test_a_program_defined_anew_starts_at_its_first_element() -> None:
    session = Session()
    session.ok("DATSIZ1,8", "DATPTR1,8,1", "DEL DATP1")
    for line in ("DEF DATP1", "DATA=1,2", "END"):
        session.ask(line)
    assert session.query("TDPTR") == "TDPTR1,1,1"
    session.ok("VAR1=DAT1")
    assert session.query("VAR1") == "VAR1=+1.0"


def test_memory_is_given_back() -> None:
    session = Session()
    free = session.ask("TMEM")
    session.ok("DATSIZ1,400", "DATSIZ1,4", "DATSIZ2,1984")
    assert session.error("DATSIZ3,4") == "INSUFFICIENT MEMORY"
    session.ok("ERASE")
    assert session.ask("TMEM") == free

"""Variables, substitution and READ on a whole unit."""

from __future__ import annotations

from decimal import Decimal

import pytest

from emulator.controller.changes import Changes
from emulator.controller.variables.store import Variables
from tests.controller.session import OK, Session


@pytest.fixture
def variables() -> Variables:
    return Variables(numbers=150, patterns=25, texts=25, text_length=20, changes=Changes())


def test_a_snapshot_brings_everything_back(variables: Variables) -> None:
    variables.set_number(150, Decimal("-1.5"))
    variables.set_bits(1, "101")
    variables.set_text(25, "KEPT")
    snapshot = variables.snapshot()
    variables.clear()
    assert variables.number(150) == 0
    variables.restore(snapshot)
    assert (variables.number(150), variables.bits(1), variables.text(25)) == (
        Decimal("-1.5"),
        "101" + "X" * 29,
        "KEPT",
    )


def test_a_snapshot_of_a_unit_with_other_counts(variables: Variables) -> None:
    variables.set_number(2, Decimal(7))
    small = Variables(numbers=2, patterns=1, texts=1, text_length=20, changes=Changes())
    small.restore(variables.snapshot())
    assert small.snapshot().numbers == (0, 7)
    variables.restore(small.snapshot())
    assert len(variables.snapshot().numbers) == 150


def test_variables_survive_reset_and_power_off() -> None:
    session = Session()
    session.ok("VAR1=5", 'VARS1="text"')
    session.ask("RESET")
    assert session.look("VAR1") == "VAR1=+5.0"
    controller = session.unit.controller
    controller.power_down()
    controller.power_up()
    session.read()
    assert session.look("VARS1") == 'VARS1="text"'


def test_the_machine_file_sets_the_counts() -> None:
    session = Session("[memory]\nvar = 200\nvarb = 1\nvars = 1\nstring_characters = 5")
    session.ok("VAR200=1", "VARB1=b1", 'VARS1="12345"')
    assert session.error("VAR201=1") == "INVALID DATA"
    assert session.error("VARB2=b1") == "INVALID DATA"
    assert session.error('VARS1="123456"') == "INVALID DATA"


@pytest.mark.parametrize(
    ("text", "query", "expected"),
    [
        ("V(VAR1),(VAR2)", "V", "V2.5000,7.0000"),
        ("V,(VAR2)", "V", "V1.0000,7.0000"),
        ("STRGTT(VAR2)", "1STRGTT", "1STRGTT7"),
        ("MC(VARB1)", "MC", "MC10"),
        ("2MC(VARB1)", "MC", "MC01"),
        ("OUTALL1,(VAR2),1", "OUT", "OUT1111_1110_0000_0000_0000_0000_00"),
    ],
)
def test_substitution(text: str, query: str, expected: str) -> None:
    session = Session()
    session.ok("VAR1=2.5", "VAR2=7", "VARB1=b1011", text)
    assert session.query(query) == expected


def test_a_read_holds_the_buffer_and_can_be_killed() -> None:
    session = Session()
    session.ok('VARS1="N?"')
    assert session.ask("VAR1=READ1") == "N?"
    assert session.system_bit(16)
    assert session.ask("VAR2=1") == ""
    assert session.ask("!'4.5") == OK * 3
    assert session.query("VAR1") == "VAR1=+4.5"
    assert not session.system_bit(16)


def test_a_program_asks_twice() -> None:
    session = Session()
    for line in ("DEF ASK", "VAR1=READ1", "VAR2=READ1", "END"):
        session.ask(line)
    session.ask("ASK")
    assert session.ask("!'1") == OK
    assert session.ask("!'2") == OK + OK
    assert session.query("VAR2") == "VAR2=+2.0"


def test_an_assignment_that_fails_changes_nothing() -> None:
    session = Session()
    session.ok("VARB1=b101", 'VARS1="OLD"')
    assert session.error("VARB1=VARB26") == "INVALID DATA"
    assert session.error('VARS1="' + "A" * 21 + '"') == "INVALID DATA"
    assert session.query("VARS1") == 'VARS1="OLD"'
    assert session.query("VARB1").startswith("VARB1=101X")

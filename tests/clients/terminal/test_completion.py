"""Completion from the catalogue."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clients.terminal.commands import OWN
from clients.terminal.completion import candidates, command_under, own_candidates, syntax_under
from protocol.catalogue import commands


def names(text: str) -> list[str]:
    return [each.text for each in candidates(text, programs={"CYCLE", "CUT", "HOMER"})]


@pytest.mark.parametrize(
    "text",
    ["SGV", "sgv", "!SGV", "1SGV", "!1SGV", "@SGV", "3_SGV", "12_!2sgv", "V5:SGV", 'WRITE"a b":sgv', "  sgv"],
)
def test_commands_after_any_prefix_and_delimiter(text: str) -> None:
    assert names(text) == ["SGV", "SGVF"]
    assert all(each.replaces == 3 for each in candidates(text))


def test_each_comes_with_its_title_and_syntax() -> None:
    (found,) = candidates("SGVF")
    assert (found.title, found.syntax) == ("Velocity feedforward gain", "<!><@><a>SGVF<r>,<r>")


@pytest.mark.parametrize("text", ['WRITE"TA', "V5;ta", "1V5", "D+", "", "V5:", "!"])
def test_nothing_where_nothing_is_being_named(text: str) -> None:
    assert names(text) == []


def test_all_commands_where_they_are_asked_for() -> None:
    found = {each.text for each in candidates("V5:", asked=True)}
    assert found == {row.name for row in commands().values() if row.applies_to_oem6250}


@pytest.mark.parametrize(("text", "operand"), [("VAR1=1P", "PE"), ("IF(A", "AS"), ("WAIT(1AS.1=b0 AND 1P", "PER")])
def test_operands_in_expressions(text: str, operand: str) -> None:
    assert operand in names(text)


@pytest.mark.parametrize("text", ["RUN C", "!RUN c", "DEL C", "TPROG C", "GOSUB C"])
def test_programs_where_one_belongs(text: str) -> None:
    assert names(text) == ["CUT", "CYCLE"]


def test_programs_by_their_name_alone() -> None:
    assert names("CYC") == ["CYCLE"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("1V5", "V"), ("V", "V"), ("DRIVE1", "DRIVE"), ("D5:!TA", None), ("!1tas.3", "TAS"), ("", None),
        ('VARS1="V', None),
    ],
)  # fmt: skip
def test_the_command_under_the_cursor(text: str, name: str | None) -> None:
    assert command_under(text) == name
    assert bool(syntax_under(text)) == (name is not None)


def test_the_terminal_s_own() -> None:
    def files(text: str) -> list[str]:
        return [text + "cle.prg"]

    assert [each.text for each in own_candidates("/de", OWN, files)] == ["/decode"]
    assert [(each.text, each.replaces) for each in own_candidates("/download cy", OWN, files)] == [("cycle.prg", 2)]
    assert own_candidates("/watch 1", OWN, files) == []
    assert [each.text for each in own_candidates("/help SGVF", OWN, files)] == ["SGVF"]


@given(st.text(alphabet='VTAS1_!@:;"=( .,-', max_size=30))
def test_anything_may_be_typed(text: str) -> None:
    for each in candidates(text):
        assert each.text.upper().startswith(text[len(text) - each.replaces :].upper())
    syntax_under(text)

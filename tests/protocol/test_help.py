"""Help made from the catalogue: every row can be described, in lines that fit a terminal."""

from __future__ import annotations

import pytest

from protocol import catalogue
from protocol.help import WIDTH, describe, matching


def test_a_command_is_described_with_all_a_user_needs() -> None:
    text = describe("v")
    assert text is not None
    lines = text.split("\n")
    assert lines[0] == "V  Velocity"
    assert lines[1].split(maxsplit=1) == ["syntax", "<!><@><a>V<r>,<r>"]
    heads = [line.split()[0] for line in lines[1:] if not line.startswith(" " * 4)]
    assert heads == ["syntax", "fields", "range", "default", "reply", "notes", "source"]
    assert "0.0 to 200.0" in text and "*V1.0000,1.0000" in text and "confidence high" in text


def test_what_the_language_has_no_word_for() -> None:
    assert describe("XYZZY") is None


def test_an_alias_leads_to_its_command() -> None:
    assert describe("LSCW") == describe("LSPOS")


def test_an_operand_is_described() -> None:
    text = describe("ER")
    assert text is not None and text.startswith("ER  ")


def test_a_command_of_other_products_says_so() -> None:
    text = describe("FMAXA")
    assert text is not None and "not on the OEM6250" in text


@pytest.mark.parametrize("name", [*catalogue.commands(), *catalogue.operands()])
def test_every_word_has_help_within_the_width(name: str) -> None:
    text = describe(name)
    assert text is not None
    lines = text.split("\n")
    row = catalogue.lookup(name)
    assert row is not None and lines[0] == f"{row.name}  {row.title}"
    assert any(line.startswith("  source   ") for line in lines)
    assert all(len(line) <= WIDTH for line in lines)


def test_matching_offers_each_command_once_in_order() -> None:
    names = [row.name for row in matching("ls")]
    assert names == ["LS", "LSAD", "LSADA", "LSNEG", "LSPOS"]
    assert len(matching("")) == len({row.name for row in catalogue.commands().values()})
    assert matching("XYZZY") == []

"""The ledger is complete, in step with the code, and honest about what it lists."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from emulator.fidelity import LIMITS, WORDS, entries, render
from emulator.machine import Machine
from protocol.catalogue import rows

DOCS = Path(__file__).parents[2] / "docs"


def leaves(value: Any, prefix: str = "") -> list[str]:
    """Dotted keys of everything that is not a table, found without the ledger's help."""
    if not isinstance(value, msgspec.Struct):
        return [prefix]
    names = zip(value.__struct_fields__, value.__struct_encode_fields__, strict=True)
    return [key for name, shown in names for key in leaves(getattr(value, name), f"{prefix}.{shown}".lstrip("."))]


def test_every_value_is_listed() -> None:
    listed = {entry.key for entry in entries()}
    others = tuple(f"axis{number}." for number in range(2, 9))
    expected = {key for key in leaves(Machine.default()) if not key.startswith(others) and key != "defaults"}
    assert expected <= listed
    assert {"defaults.ECHO", "defaults.FPPEN", "axis1.plant (torque_drive).inertia_kg_m2"} <= listed


@pytest.mark.parametrize("entry", entries(), ids=lambda entry: entry.key)
def test_every_value_says_what_it_is_and_how_we_know(entry: Any) -> None:
    assert entry.what
    assert entry.provenance in WORDS
    assert entry.confidence in {"", "H", "M", "L"}
    if entry.provenance == "assumed":
        assert entry.confidence, "an assumption says how sure we are"
    if entry.provenance in {"documented", "host"}:
        assert entry.source, "a documented value names its page, a seen one the program"


def test_the_committed_ledger_is_what_the_code_says() -> None:
    committed = (DOCS / "fidelity.md").read_text(encoding="utf-8")
    assert committed == render(rows()), "run: python -m emulator.fidelity > docs/fidelity.md"


def test_the_ledger_works_without_the_catalogue_and_lists_it_when_given() -> None:
    assert "## Commands" not in render()
    text = render(rows())
    assert text.count("\n| `") == len(entries()) + len(rows())
    for line in LIMITS:
        assert line in text

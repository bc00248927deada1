"""The fidelity ledger: every value that no page confirms, and where it comes from.

An emulator earns trust by saying what it does not know. The ledger is made from the annotations of the machine file
and from the source column of the command catalogue, so it cannot fall behind the code; a test compares the committed
docs/fidelity.md with what this module prints.

    python -m emulator.fidelity > docs/fidelity.md
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final, Protocol

import msgspec
from msgspec import inspect

from emulator.encoder_motion_tables import MOTION_KINDS
from emulator.machine import AXIS_KEYS, Machine, VelocityDrive
from emulator.machine_settings import DEFAULT_SETTINGS
from emulator.plant_tables import KINDS

WORDS: Final = {
    "documented": "documented",
    "host": "seen in host software",
    "inferred": "inferred",
    "assumed": "assumed",
    "design": "design choice",
}

NOT_YET: Final = " (accepted, no effect yet)"
"""Said of values kept for parts of the unit that are not built."""

LIMITS: Final = (
    "No OEM6250 was at hand. The manuals for this unit survive in part, and nothing was measured on hardware.",
    "The sign-on, the part number and the revision are placeholders; software that looks for its own product name "
    "may decide otherwise before a real unit.",
    "Error texts follow the product family's list; only a few are confirmed for this unit. Error levels 3, 2 and 0 "
    "are guesses.",
    "The layouts of TASF, TSSF, TERF, TGAIN, TDIR and TMEM are assumed: a test that compares them byte by byte tests "
    "us, not Parker.",
    "The update periods with two axes are assumed. Times of moves are right to within one trajectory update of the "
    "profile's arithmetic, not of a measured unit.",
    "By default commands are answered at once. A real unit answers after its line's baud rate and after one or more "
    "system updates; a program that works here only because it is answered quickly will not work there.",
    "Motor and load are models (docs/plants.md) without cogging, oil springs or temperature, and by default a velocity "
    "drive without resonance or backlash. Gains tuned here are not gains for your machine.",
    "The encoder is ideal unless the machine file says otherwise: no noise, and no missed counts below its input's "
    "greatest rate.",
    "What a trigger does not latch in hardware is timed in steps of 100 us: that its error stays within 50 us "
    "times the velocity is documented, the steps are assumed.",
    "Limits, ENABLE and drive faults follow the wiring of the machine file; contacts do not bounce.",
    "A virtual serial port has no baud rate, no modem lines, no framing errors and no line noise.",
    "What a unit remembers over power-off is taken from a later product's list.",
    "The Delta RMC151 (docs/rmc.md) rests on a part of its manual: word order, mode names, the accumulation of I-PD "
    "and the shape of the S-curve are inferred, the order of some status registers is assumed.",
    "Where a transcript under tests/transcripts says `~`, the bytes are not documented, and passing proves nothing "
    "about them.",
)
"""What a green test against the emulator does not prove."""


class CatalogueRow(Protocol):
    """The part of a catalogue row the ledger reads."""

    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def confidence(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the ledger: a value under its dotted key."""

    key: str
    value: str
    what: str
    provenance: str
    confidence: str
    source: str


def entries(machine: Machine | None = None) -> list[Entry]:
    """Every value of `machine` (None: the default one) with its provenance, in file order; other axes are as axis 1."""
    machine = machine or Machine.default()
    found = _table_entries(machine, inspect.type_info(Machine), "")
    other_plants = [
        entry
        for kind, table in KINDS.items()
        if table is not VelocityDrive
        for entry in _table_entries(table(), inspect.type_info(table), f"axis1.plant ({kind}).")
    ]
    motions = [
        entry
        for kind, table in MOTION_KINDS.items()
        for entry in _table_entries(table(), inspect.type_info(table), f"axis1.encoder_motion ({kind}).")
    ]
    others = tuple(f"{key}." for key in AXIS_KEYS[1:])
    shown = [entry for entry in found if not entry.key.startswith(others)]
    return [*shown, *other_plants, *motions, *_default_entries()]


def render(rows: Iterable[CatalogueRow] = ()) -> str:
    """The ledger as Markdown; `rows` are those of the command catalogue."""
    ledger = entries()
    parts = [_head(ledger), _limits(), _values(ledger), _commands(list(rows))]
    return "\n".join(part for part in parts if part)


def _table_entries(table: Any, info: Any, prefix: str) -> Iterator[Entry]:
    for field in info.fields:
        value, key = getattr(table, field.name), prefix + field.encode_name
        if field.name == "defaults":
            continue
        inner = _struct_of(field.type, value)
        if inner is not None:
            yield from _table_entries(value, inner, key + ".")
        else:
            yield _entry(key, value, field.type)


def _struct_of(node: Any, value: Any) -> Any:
    """The table type of a field that holds a table, else None."""
    return inspect.type_info(type(value)) if isinstance(value, msgspec.Struct) else None


def _entry(key: str, value: Any, node: Any) -> Entry:
    about = (node.extra or {}) if isinstance(node, inspect.Metadata) else {}
    schema = (node.extra_json_schema or {}) if isinstance(node, inspect.Metadata) else {}
    return Entry(
        key=key,
        value=_text(value),
        what=str(schema.get("description", "")) + ("" if about.get("acts", True) else NOT_YET),
        provenance=about.get("provenance", ""),
        confidence=about.get("confidence", ""),
        source=about.get("source", ""),
    )


def _text(value: Any) -> str:
    if isinstance(value, tuple) and value and isinstance(value[0], msgspec.Struct):
        return "; ".join("/".join(str(part) for part in msgspec.structs.astuple(row)) for row in value)
    if isinstance(value, tuple):
        return ", ".join(str(part) for part in value) or "none"
    if isinstance(value, dict):
        return ", ".join(f"{name} = {meaning}" for name, meaning in value.items()) or "none"
    return str(value).lower() if isinstance(value, bool) else str(value)


def _default_entries() -> Iterator[Entry]:
    for command, (text, provenance, confidence, source) in DEFAULT_SETTINGS.items():
        what = f"{command} at power-up; any other setting can be given the same way"
        yield Entry(f"defaults.{command}", text, what, provenance, confidence, source)


def _head(ledger: list[Entry]) -> str:
    count = Counter(entry.provenance for entry in ledger)
    listed = ", ".join(f"{count[kind]} {word}" for kind, word in WORDS.items() if count[kind])
    return f"""# Fidelity ledger

Made by `python -m emulator.fidelity > docs/fidelity.md`; do not edit.

Manuals for the OEM6250 survive only in part. Every value that could be wrong has one address: a key of the machine
file, listed here with its provenance (the other axes are as axis 1). Of {len(ledger)} values:
{listed}.

- *documented*: a page of a manual says so. *Seen in host software*: a program written for real units relies on it.
- *Inferred*: follows from documented or seen facts. *Assumed* (H, M, L: how sure we are): believed from general
  knowledge of the product family; no page confirms it.
- *Design choice*: not a claim about the unit, but what is connected to it.

If you have a unit or a manual that says otherwise, change the key in your machine file, and tell us.
"""


def _limits() -> str:
    bullets = "\n".join(f"- {line}" for line in LIMITS)
    return f"## What a green test here does not prove\n\n{bullets}\n"


def _values(ledger: list[Entry]) -> str:
    lines = ["## Values", "", "| key | value | what | provenance | source |", "| --- | --- | --- | --- | --- |"]
    for entry in ledger:
        sure = f" {entry.confidence}" if entry.confidence else ""
        cells = (f"`{entry.key}`", f"`{entry.value}`", entry.what, WORDS[entry.provenance] + sure, entry.source)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _commands(rows: list[CatalogueRow]) -> str:
    if not rows:
        return ""
    count = Counter(row.confidence for row in rows)
    lines = [
        "## Commands",
        "",
        f"{len(rows)} rows of the catalogue; confidence high {count['high']}, medium {count['medium']}, "
        f"low {count['low']}.",
        "",
        "| command | what | source | confidence |",
        "| --- | --- | --- | --- |",
    ]
    for row in rows:
        cells = (f"`{row.name}`", row.title, row.source, row.confidence)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Print the ledger, the catalogue included."""
    from protocol.catalogue import rows

    sys.stdout.write(render(rows()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

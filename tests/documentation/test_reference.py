"""The generated pages say everything the tables behind them hold, and nothing else."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest

import clients
from clients import testing
from documentation import commands, machine_file, python_api, replies, surface
from documentation.markdown import code
from documentation.refusals import refusals
from emulator.fidelity import entries
from emulator.machine import Machine
from emulator.plant_tables import KINDS, PRESETS
from protocol import catalogue

TABLES = machine_file.tables()


@pytest.fixture(scope="module")
def command_pages() -> dict[str, str]:
    return commands.pages()


class TestCommands:
    def test_every_row_has_one_entry(self, command_pages: dict[str, str]) -> None:
        text = "".join(command_pages.values())
        labels = re.findall(r"^\((.*)\)=$", text, re.MULTILINE)
        assert sorted(labels) == sorted(commands.label(row) for row in catalogue.rows())
        assert len(set(labels)) == len(labels)

    def test_every_name_is_in_the_index(self, command_pages: dict[str, str]) -> None:
        index = commands.index(list(command_pages))
        for row in catalogue.rows():
            if row.name.isalpha():
                assert f"[{row.name}](#{commands.label(row)})" in index

    def test_an_entry_says_what_the_catalogue_knows(self, command_pages: dict[str, str]) -> None:
        entry = command_pages["commands-homing.md"].partition("(command-homa)=")[2].partition("(command-homaa)=")[0]
        for said in ("`<!><@><a>HOMA<r>,<r>`", "2, one an axis", "0.00025 to 24999975", "`10.0`", "`SCLA`",
                     "at once with `!`", "implemented", "`setting_homa`", "assumed (confidence medium)"):  # fmt: skip
            assert said in entry

    def test_what_the_unit_has_not_is_said_to_be_absent(self, command_pages: dict[str, str]) -> None:
        text = "".join(command_pages.values())
        entry = text.partition("## PTAN:")[2].partition("\n(")[0]
        assert "absent: not a command of the OEM6250" in entry

    def test_a_group_nobody_has_given_a_heading_is_not_lost(self) -> None:
        groups = {row.group for row in catalogue.rows()}
        assert groups <= commands.GROUPS.keys()


class TestRefusals:
    def test_they_are_read_from_the_transcripts(self, tmp_path: Path) -> None:
        (tmp_path / "one.txt").write_text(
            "> A1,2,3\\r\n< \\r\\n*INCORRECT AXIS\\r{bad}\n> V99999999\\r\n~ .*\\*INVALID DATA-FIELD 1\\r\n"
            "> A0:V0\\r\n< \\r\\n*INVALID DATA\\r{bad}\n> 1TPE\\r\n< *1TPE+0\\r{ok}\n"
        )
        assert refusals(tmp_path) == {"A": ["INCORRECT AXIS"], "V": ["INVALID DATA-FIELD n"]}

    def test_none_without_transcripts(self, tmp_path: Path) -> None:
        assert refusals(tmp_path) == {}

    def test_those_of_the_suite(self) -> None:
        assert "DRIVE SHUTDOWN" in refusals()["GO"]


class TestMachineFile:
    def test_every_key_of_the_ledger_is_there(self) -> None:
        listed = {key.path for each in TABLES for key in each.keys}
        listed |= {f"{each.path} ({each.kind}).{key.name}" for each in TABLES for key in each.keys}
        in_ledger = {entry.key for entry in entries() if not entry.key.startswith("defaults.")}
        assert in_ledger <= listed

    @pytest.mark.parametrize("table", TABLES, ids=lambda table: f"{table.path} {table.kind}".strip() or "top")
    def test_the_example_is_the_default(self, table: machine_file.TableOfKeys) -> None:
        machine = Machine.parse(machine_file.example(table))
        if not table.kind:
            assert machine == Machine.default()
            return
        name = table.path.removeprefix("axis1.")
        given = getattr(machine.axis1, name)
        assert given == type(given)()
        assert type(given).__struct_config__.tag == table.kind
        assert machine.axis1 == msgspec.structs.replace(Machine.default().axis1, **{name: given})

    def test_every_kind_of_plant_has_a_table(self) -> None:
        assert [each.kind for each in TABLES if each.path == "axis1.plant"] == list(KINDS)

    def test_every_key_says_what_it_is_and_how_we_know(self) -> None:
        assert [key.path for each in TABLES for key in each.keys if not (key.what and key.known and key.type)] == []

    @pytest.mark.parametrize(
        ("path", "kind", "allowed"),
        [
            ("servo.dac_bits", "whole number", ">= 8, <= 24"),
            ("tas_layout", "one of", '"line_per_axis", "one_line"'),
            ("wires.analog", "list of 3 numbers", "each >= 0, <= 2.5"),
            ("timing.commands", "table of whole numbers by name", "each >= 0, <= 60,000,000"),
            ("memory.program_bytes", "whole number", ">= 1,000, a multiple of 2"),
            ("bare", "true or false", ""),
        ],
    )
    def test_types_and_ranges(self, path: str, kind: str, allowed: str) -> None:
        key = next(key for each in TABLES for key in each.keys if key.path == path)
        assert (key.type, key.range) == (kind, allowed)

    def test_what_a_running_server_takes_over_is_marked(self) -> None:
        marked = {key.path for each in TABLES for key in each.keys if key.at_reload}
        assert {"identity.revision", "axis1.plant.inertia_kg_m2", "wires.enable"} <= marked
        assert not {"servo.dac_bits", "axis1.encoder.counts_per_rev"} & marked

    def test_presets(self) -> None:
        text = machine_file.reference()
        assert all(f"| `{name}` |" in text for presets in PRESETS.values() for name in presets)


class TestReplies:
    def test_every_bit_of_every_word(self) -> None:
        text = replies.status_page()
        for word in catalogue.status_words().values():
            assert f"## {word.name}" in text
        assert text.count("\n| ") >= sum(len(word.bit) for word in catalogue.status_words().values())

    def test_every_error_and_every_foreign_name(self) -> None:
        text = replies.errors_page()
        assert all(code(row.text) in text for row in catalogue.error_rows())
        assert all(f"`{name}`" in text for name in catalogue.other_product_names())

    def test_every_letter(self) -> None:
        infnc, _, outfnc = replies.io_page().partition("## OUTFNC")
        assert all(f"| `{letter}` |" in infnc for letter in catalogue.io_functions("infnc"))
        assert all(f"| `{letter}` |" in outfnc for letter in catalogue.io_functions("outfnc"))


def test_the_control_surface() -> None:
    text = surface.reference()
    for said in ("`axis1.position.error`", "`set_wire`", "`limit_open`"):
        assert said in text
    assert "axis2" not in text.partition("## Signals")[2]


def test_the_python_reference_has_every_public_name() -> None:
    text = python_api.reference()
    names = {*clients.__all__, *testing.__all__, "Emulator", "Machine", "Unit"} - {"DEFAULT_PROMPTS"}
    assert [name for name in names if f"\n### {name}\n" not in text] == []
    assert "- `advance(seconds)`:" in text

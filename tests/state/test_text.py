"""The readable form: it reads back exactly, can be compared line by line, and its errors say where."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.state.contents import Contents, Key, ProgramText, rows_of
from emulator.state.errors import StateError
from emulator.state.text import export, read
from tests.state import samples
from tests.state.samples import FULL


@pytest.fixture
def anything_makes_sense(monkeypatch: pytest.MonkeyPatch) -> None:
    """Made-up programs are no programs; whether they make sense is another question."""
    monkeypatch.setattr("emulator.state.text.nonsense", lambda rows: "")


class TestExact:
    @settings(max_examples=25)
    @given(st.dictionaries(st.integers(0, 98), samples.contents(), max_size=2))
    def test_import_of_export(self, units: dict[int, Contents]) -> None:
        rows = {unit: rows_of(kept) for unit, kept in units.items()}
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("emulator.state.text.nonsense", lambda rows: "")
            assert read(export(rows), name="text") == rows

    def test_every_character(self, anything_makes_sense: None) -> None:
        every = "".join(map(chr, range(256)))
        rows = {0: rows_of(Contents(texts=(every,), programs=(ProgramText("P", (every, "'", '"', "'''", "\\")),)))}
        text = export(rows)
        assert read(text, name="text") == rows
        assert all(line.isprintable() for line in text.splitlines())

    def test_a_huge_program(self) -> None:
        lines = tuple(
            f'VAR{1 + place % 150}=VAR1*{place}.25:WRITE"N"'.partition(":")[place % 2 * 2] for place in range(3000)
        )
        rows = {0: rows_of(Contents(programs=(ProgramText("BIG", lines),)))}
        assert read(export(rows), name="text") == rows

    def test_one_change_is_one_line(self) -> None:
        before = export({0: rows_of(FULL)}).splitlines()
        rows = rows_of(FULL) | {Key("program", "MAIN", 3): "VAR1=VAR1+2"}
        after = export({0: rows}).splitlines()
        assert [new for old, new in zip(before, after, strict=True) if old != new] == ['  "VAR1=VAR1+2",']

    def test_it_reads_like_this(self) -> None:
        rows = rows_of(Contents(settings=(("STARTP", "P"),), texts=("hi",), programs=(ProgramText("P", ("V2",)),)))
        assert export({0: rows}).splitlines()[1:] == [
            "format = 1",
            "",
            "[unit.1]",
            "",
            "[unit.1.settings]",
            'STARTP = "P"',
            "",
            "[unit.1.VARS]",
            '1 = "hi"',
            "",
            "[unit.1.program.P]",
            "lines = [",
            '  "V2",',
            "]",
        ]


class TestRefused:
    @pytest.mark.parametrize(
        ("text", "told"),
        [
            ("", "does not say format = 1"),
            ("format = 2", "is of format 2; this oem6250 reads format 1"),
            ("format = ", "Invalid value (at end of document)"),
            ("format = 1\n[machine]", "machine: is not known here; there are unit"),
            ("format = 1\nunit = 3", "unit: must be a table"),
            ("format = 1\n[unit.x]", "unit.x: 'x' is not a number from 1"),
            ("format = 1\n[unit.0]", "unit.0: '0' is not a number from 1"),
            ("format = 1\n[unit.01]", "unit.01: '01' is not a number from 1"),
            ("format = 1\n[unit.1.VARX]", "unit.1.VARX: is not known here"),
            ("format = 1\n[unit.1.VAR]\n1 = 5", "unit.1.VAR.1: must be a string, not 5"),
            ('format = 1\n[unit.1.VAR]\n1 = "x"', "unit.1: VAR 1: 'x' cannot be read"),
            ('format = 1\n[unit.1.VAR]\n-1 = "1"', "unit.1.VAR.-1: '-1' is not a number from 1"),
            ('format = 1\n[unit.1.program.P]\nlines = "V1"', "unit.1.program.P.lines: must be a list"),
            ('format = 1\n[unit.1.program."P Q"]\nlines = []', "unit.1.program.P Q: is no name of a program"),
            ("format = 1\n[unit.1.program.GO]\nlines = []", "STRING IS A COMMAND"),
            ("format = 1\n[unit.1.program.TOOLONG]\nlines = []", "STRING IS TOO LONG"),
            ('format = 1\n[unit.1.program.P]\nlines = ["V1", "%%%"]', "program P 2: '%%%'"),
            ('format = 1\n[unit.1.program.P]\nlines = []\nscaled = { 1 = "1=5" }', "scaled values of a line"),
            ('format = 1\n[unit.1.settings]\nLH = "0"', "setting LH: '0'"),
            ('format = 1\n[unit.1.settings]\nADDR = "500"', "setting ADDR: '500'"),
            ('format = 1\n[unit.1.settings]\nCMDDIR = "012"', "setting CMDDIR: '012'"),
            ('format = 1\n[unit.1.settings]\nDPASS = "12345"', "setting DPASS: '12345'"),
        ],
    )
    def test_one_line_that_says_where(self, text: str, told: str) -> None:
        with pytest.raises(StateError) as refused:
            read(text, name="memory.toml")
        message = str(refused.value)
        assert message.startswith("memory.toml: ")
        assert told in message
        assert "\n" not in message

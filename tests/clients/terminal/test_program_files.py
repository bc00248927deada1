"""Program files, read and written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clients.terminal.program_files import (
    Outside,
    Program,
    ProgramFileError,
    format_programs,
    name_from_path,
    read_programs,
)


def test_programs_and_what_stands_around_them() -> None:
    text = """
; the press
DEL HOMER
scale1
DEF HOMER
HOM0 : T1
END
del cycle

DEF CYCLE
L2
D1000 : GO1   ; there
WRITE"a, b"
LN
END
STARTP CYCLE
"""
    assert read_programs(text, name="X") == [
        Outside(("SCALE1",)),
        Program("HOMER", ("HOM0", "T1")),
        Program("CYCLE", ("L2", "D1000", "GO1", 'WRITE"a, b"', "LN")),
        Outside(("STARTP CYCLE",)),
    ]


def test_a_file_without_def_is_one_program() -> None:
    assert read_programs("D5\nGO1\n", name=name_from_path("/x/cycle.prg")) == [Program("CYCLE", ("D5", "GO1"))]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("DEF A\nD5\n", "line 1: DEF A without END"),
        ("D5\nEND\n", "line 2: END without DEF"),
        ("DEF A\nDEF B\nEND", "line 2: DEF within the definition of A"),
        ("\nDEF 1234567\nEND", "line 2: '1234567' is no program name"),
    ],
)
def test_mistakes_name_their_line(text: str, said: str) -> None:
    with pytest.raises(ProgramFileError, match=said):
        read_programs(text, name="X")


_ONES = ["D5", "GO1", 'WRITE"a b"', "VAR1=1PE", "IF(VAR1>3)", "NIF", "L", "LN"]
_COMMANDS = st.lists(st.sampled_from(_ONES), max_size=6)


@given(st.dictionaries(st.sampled_from(["A1", "CYCLE", "Z"]), _COMMANDS))
def test_what_is_written_is_read_back(stored: dict[str, list[str]]) -> None:
    found = read_programs(format_programs(stored), name="NOBODY")
    if stored:
        assert found == [Program(name, tuple(commands)) for name, commands in stored.items()]

"""Every row of the catalogue is implemented or absent for a reason, and a transcript shows which."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from emulator.cli import main
from emulator.conformance import (
    ABSENT_ROWS,
    STORED_ROWS,
    TRANSCRIPTS,
    Conformance,
    exercised,
    find,
    names_in,
    render,
    table,
)
from protocol import catalogue

NEVER_PROVOKED = {
    "COMMAND/DRIVE MISMATCH": "both axes of this unit are servos",
    "MAXIMUM COUNTS PER SECOND EXCEEDED": "a velocity over the cap is refused when it is entered, INVALID DATA-FIELD n",
    "NO MOTION IN PROGRESS": "the reference names no command that answers it",
}
"""Error texts no transcript can provoke, and why."""


@pytest.fixture(scope="module")
def rows() -> list[Conformance]:
    return table()


def test_every_row_is_in_the_table(rows: list[Conformance]) -> None:
    assert [each.row.name for each in rows] == [row.name for row in catalogue.rows()]


def test_what_is_absent_or_only_stored_has_a_reason(rows: list[Conformance]) -> None:
    assert [each.row.name for each in rows if each.state != "implemented" and not each.reason] == []


def test_no_reason_is_kept_for_what_is_there(rows: list[Conformance]) -> None:
    there = {each.row.name for each in rows if each.state == "implemented"}
    assert there & (ABSENT_ROWS.keys() | STORED_ROWS.keys()) == set()


def test_every_row_has_a_transcript(rows: list[Conformance]) -> None:
    assert [each.row.name for each in rows if not each.transcripts] == []


def expected_lines() -> Iterable[str]:
    for path in sorted(TRANSCRIPTS.glob("*.txt")):
        yield from (line for line in path.read_text(encoding="utf-8").splitlines() if line[:2] in ("< ", "~ "))


@pytest.mark.parametrize("text", [row.text for row in catalogue.error_rows()])
def test_every_error_text_is_provoked(text: str) -> None:
    shown = any(text.removesuffix("n") in line.replace("\\(", "(").replace("\\)", ")") for line in expected_lines())
    assert shown != (text in NEVER_PROVOKED), NEVER_PROVOKED.get(text, "no transcript provokes it")


def test_there_are_three_hundred_transcripts() -> None:
    assert len(list(TRANSCRIPTS.glob("*.txt"))) >= 300


@pytest.mark.parametrize(
    ("line", "names"),
    [
        (r"1TPE\r", {"TPE", "<a>"}),
        (r"0_!1tas.1\r", {"TAS", "<a>", "<a_>", "!", "."}),
        (r"V1:@A2 ; both\r", {"V", "A", "@", ":", ";"}),
        (r"WAIT(1AS.1=b0 AND VAR1>=3)\r", {"WAIT", "AS", "AND", "=", ">=", "( )", "VAR", "."}),
        (r"VAR1=SIN(VAR2)+PI\r", {"VAR", "SIN", "PI", "+", "=", "( )"}),
        (r'WRITE"SIN: COS"\r', {"WRITE", '"'}),
        (r"XYZZY\r", {"<name>"}),
        (r"DEF SETUP\r", {"DEF"}),
    ],
)
def test_names_of_a_sent_line(line: str, names: set[str]) -> None:
    found = set(names_in(line))
    assert names - {"VAR"} <= found
    assert not {"COS", "TAN", "OR"} & found


def test_a_folder_without_transcripts_shows_nothing(tmp_path: Path) -> None:
    assert not exercised(tmp_path)


def test_the_command_line_shows_one_row(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["commands", "1v".removeprefix("1")]) == 0
    shown = capsys.readouterr().out
    assert "V  " in shown
    assert "state    implemented" in shown
    assert "transcripts/setting_v.txt" in shown


def test_the_command_line_refuses_what_is_no_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["commands", "XYZZY"])
    assert stopped.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_table_has_a_line_for_every_row(rows: list[Conformance], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["commands", "--table"]) == 0
    assert capsys.readouterr().out == render(rows)
    assert render(rows).count("\n| `") == len(rows)


def test_absence_is_noticed() -> None:
    found = find("TRANS")
    assert found is not None
    assert (found.state, bool(found.reason)) == ("absent", True)


def test_the_committed_table_is_the_present_one(rows: list[Conformance]) -> None:
    committed = (Path(__file__).parents[2] / "docs" / "conformance.md").read_text(encoding="utf-8")
    assert committed == render(rows), "run: oem6250 commands --table > docs/conformance.md"

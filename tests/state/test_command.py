"""`oem6250 state`: what a person types, sees, and is told."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from emulator.cli import main
from emulator.state.contents import rows_of
from emulator.state.store import Store
from tests.state.samples import FULL

CONTENTS = FULL._replace(profiles=())


@pytest.fixture
def path(tmp_path: Path) -> Path:
    store = Store(tmp_path / "unit.state")
    store.write({0: CONTENTS})
    store.close()
    return tmp_path / "unit.state"


def state(path: Path, *arguments: str) -> None:
    assert main(["state", str(path), *arguments]) == 0


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert main(["state", *map(str, arguments)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("oem6250: ")
    assert err.count("\n") == 1
    return err.removeprefix("oem6250: ")


def rows(path: Path) -> object:
    store = Store(path)
    try:
        return {unit: found for unit, found in store.units.items() if found}
    finally:
        store.close()


def test_show(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    state(path, "show")
    assert capsys.readouterr().out.splitlines() == [
        "unit 1",
        "  settings  ADDR 3, DPASS 77, MEMORY 20000,20000, STARTP MAIN",
        "  programs  MAIN (4 commands), EMPTY (0 commands), DATP1 (1 commands)",
        "  VAR       VAR2=3.50000000, VAR3=-123456789.87654321",
        f"  VARB      VARB1={'X' * 31}1",
        "  VARS      VARS2='it\\'s \"quoted\"\\\\13'",
        "  gain sets 1",
    ]


def test_export_and_import(path: Path, tmp_path: Path) -> None:
    state(path, "export", str(tmp_path / "text"))
    state(tmp_path / "other", "import", str(tmp_path / "text"))
    assert rows(tmp_path / "other") == rows(path) == {0: rows_of(CONTENTS)}


def test_through_standard_output_and_input(
    path: Path, tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    state(path, "export")
    text = capfdbinary.readouterr().out
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text)))
    state(tmp_path / "other", "import")
    assert rows(tmp_path / "other") == rows(path)


def test_import_puts_in_place_of_everything(path: Path, tmp_path: Path) -> None:
    (tmp_path / "text").write_text('format = 1\n[unit.2.VAR]\n1 = "5"\n')
    state(path, "import", str(tmp_path / "text"))
    state(path, "export", str(tmp_path / "back"))
    assert (tmp_path / "back").read_text().splitlines()[1:] == [
        "format = 1",
        "",
        "[unit.2]",
        "",
        "[unit.2.VAR]",
        '1 = "5"',
    ]


def test_clear(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    state(path, "clear")
    state(path, "show")
    assert capsys.readouterr().out == "nothing is kept\n"


def test_a_bad_text_changes_nothing(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "text").write_text('format = 1\n[unit.1.program.P]\nlines = ["%%%"]\n')
    assert "unit.1: program P 1: '%%%': " in refused(capsys, path, "import", tmp_path / "text")
    assert rows(path) == {0: rows_of(CONTENTS)}


def test_a_text_that_cannot_be_read(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "cannot be read (No such file" in refused(capsys, path, "import", tmp_path / "absent")
    (tmp_path / "text").write_bytes(b"\xff\xfe")
    assert "not UTF-8" in refused(capsys, path, "import", tmp_path / "text")


def test_a_place_that_cannot_be_written(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "cannot be written" in refused(capsys, path, "export", tmp_path / "no" / "where")


@pytest.mark.parametrize("action", ["show", "export", "clear"])
def test_no_such_file(action: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert refused(capsys, tmp_path / "absent", action) == f"{tmp_path / 'absent'}: there is no such file\n"
    assert not (tmp_path / "absent").exists()


@pytest.mark.parametrize("action", ["show", "export", "clear", "import"])
def test_one_in_use(action: str, path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "text").write_text("format = 1")
    arguments = (path, action, tmp_path / "text") if action == "import" else (path, action)
    store = Store(path)
    try:
        assert refused(capsys, *arguments) == f"{path}: in use by another emulator\n"
    finally:
        store.close()


def test_a_damaged_one_is_left_as_it_is(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = path.read_bytes()[:9000]
    path.write_bytes(data)
    assert "is damaged" in refused(capsys, path, "show")
    assert path.read_bytes() == data


def test_show_takes_no_text(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "show takes no text" in refused(capsys, path, "show", "x")

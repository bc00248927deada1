"""The file: what is written is there again, damage is seen, and nobody else's file is touched."""

from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
import tempfile
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from emulator.state.contents import Contents, ProgramText, rows_of
from emulator.state.errors import DamagedError, StateError
from emulator.state.store import APPLICATION_ID, FORMAT_VERSION, Store
from tests.ports.served import REPOSITORY
from tests.state import samples
from tests.state.samples import FULL

WHY = {
    "file": "written (read-only file)",
    "directory": "written (read-only directory, and SQLite needs a log beside it)",
}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "unit.state"


def made(path: Path, kept: Contents = FULL, unit: int = 0) -> Path:
    """A file with some contents, closed."""
    store = Store(path)
    store.write({unit: kept})
    store.close()
    return path


def opened(path: Path) -> dict[int, Contents]:
    """What a file holds."""
    store = Store(path, create=False)
    try:
        return {unit: store.contents(unit) for unit in store.units}
    finally:
        store.close()


class TestKept:
    def test_in_one_file(self, path: Path) -> None:
        made(path)
        assert opened(path) == {0: FULL}
        assert [entry.name for entry in path.parent.iterdir()] == [path.name], "no log and no lock file stay"

    @settings(
        max_examples=8,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=[HealthCheck.function_scoped_fixture],
    )
    @given(st.lists(st.tuples(st.integers(0, 2), samples.contents()), max_size=6))
    def test_after_any_history(self, tmp_path: Path, history: list[tuple[int, Contents]]) -> None:
        path = tmp_path / "history"
        path.unlink(missing_ok=True)
        store = Store(path)
        for unit, kept in history:
            store.write({unit: kept})
        store.close()
        last = {unit: repr(kept) for unit, kept in dict(history).items() if rows_of(kept)}
        assert {unit: repr(kept) for unit, kept in opened(path).items()} == last

    def test_before_anything_is_written(self, path: Path) -> None:
        Store(path).close()
        assert opened(path) == {}

    def test_an_empty_file_is_a_new_one(self, path: Path) -> None:
        path.touch()
        made(path)
        assert opened(path) == {0: FULL}

    def test_units_that_are_not_there_keep_theirs(self, path: Path) -> None:
        made(path, FULL, unit=7)
        made(path, Contents(texts=("A",)), unit=0)
        assert opened(path) == {0: Contents(texts=("A",)), 7: FULL}

    def test_what_a_unit_could_not_take_stays(self, path: Path) -> None:
        """A smaller machine writes; what it never held is left alone."""
        made(path, Contents(numbers=(Decimal(1), Decimal(2), Decimal(3))))
        store = Store(path)
        store.adopt(0, Contents(numbers=(Decimal(1),)))
        store.write({0: Contents(numbers=(Decimal(9),))})
        store.close()
        assert opened(path)[0].numbers == (Decimal(9), Decimal(2), Decimal(3))

    def test_a_program_that_did_not_fit_gives_way_to_one_of_its_name(self, path: Path) -> None:
        made(path, Contents(programs=(ProgramText("P", ("V1", "V2", "V3")), ProgramText("Q", ("V4",)))))
        store = Store(path)
        store.adopt(0, Contents())
        store.write({0: Contents(programs=(ProgramText("P", ("A1",)),))})
        store.close()
        assert opened(path)[0].programs == (ProgramText("P", ("A1",)), ProgramText("Q", ("V4",)))

    def test_put_in_place_of_everything(self, path: Path) -> None:
        made(path, FULL, unit=1)
        store = Store(path)
        store.replace({0: rows_of(FULL)})
        store.close()
        assert opened(path) == {0: FULL}


class TestDamage:
    @pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
    def test_cut_off(self, path: Path, share: float) -> None:
        made(path, Contents(texts=("X" * 20_000,)))
        os.truncate(path, int(path.stat().st_size * share))
        with pytest.raises(DamagedError, match="is damaged"):
            Store(path)

    @pytest.mark.parametrize("place", [200, 5000, 8000, 12_000])
    def test_bytes_that_changed(self, path: Path, place: int) -> None:
        made(path, Contents(texts=tuple("abcdefghi" * 30 for _ in range(40))))
        data = bytearray(path.read_bytes())
        data[place : place + 64] = bytes(byte ^ 0x15 for byte in data[place : place + 64])
        path.write_bytes(data)
        try:
            store = Store(path)
        except DamagedError:
            return
        found = store.contents(0)
        store.close()
        assert found.texts == tuple("abcdefghi" * 30 for _ in range(40)), "else only unused bytes were hit"

    @pytest.mark.parametrize(
        "statement",
        [
            "UPDATE kept SET value = '4' WHERE name = 'ADDR'",
            "DELETE FROM kept WHERE name = 'ADDR'",
            "INSERT INTO kept VALUES (0, 'VAR', '', 9, '1')",
            "UPDATE kept SET unit = 1",
            "UPDATE seal SET checksum = '1'",
            "DELETE FROM seal",
            "DROP TABLE kept",
            "DROP TABLE seal",
        ],
    )
    def test_contents_that_nobody_of_us_wrote(self, path: Path, statement: str) -> None:
        made(path)
        connection = sqlite3.connect(path)
        connection.execute(statement)
        connection.commit()
        connection.close()
        with pytest.raises(DamagedError, match="is damaged"):
            Store(path)

    def test_set_aside_under_a_free_name(self, path: Path) -> None:
        for number in (1, 2):
            made(path)
            os.truncate(path, path.stat().st_size // 2)
            damaged = path.read_bytes()
            store = Store.open_or_set_aside(path)
            assert store.units == {}
            assert store.set_aside == path.with_name(f"{path.name}.damaged-{number}")
            assert store.set_aside.read_bytes() == damaged
            store.close()
        assert opened(path) == {}


def refused(path: Path, *, create: bool = True) -> str:
    with pytest.raises(StateError) as error:
        Store(path, create=create)
    assert not isinstance(error.value, DamagedError)
    text = str(error.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    return text


class TestRefused:
    def test_a_newer_file(self, path: Path) -> None:
        made(path)
        connection = sqlite3.connect(path)
        connection.execute(f"PRAGMA user_version = {FORMAT_VERSION + 1}")
        connection.close()
        before = path.read_bytes()
        assert "written by a newer oem6250 (format 2, this one reads 1)" in refused(path)
        assert path.read_bytes() == before

    def test_a_file_of_another_kind(self, path: Path) -> None:
        path.write_text("[axis1]\n# a machine file, say" * 100)
        assert "is not a state file" in refused(path)
        assert path.read_text().startswith("[axis1]")

    def test_a_database_of_another_program(self, path: Path) -> None:
        connection = sqlite3.connect(path)
        connection.execute("CREATE TABLE birds (name)")
        connection.close()
        before = path.read_bytes()
        assert "another program" in refused(path)
        assert path.read_bytes() == before

    def test_a_directory(self, tmp_path: Path) -> None:
        assert "is a directory" in refused(tmp_path)

    def test_no_directory(self, tmp_path: Path) -> None:
        assert "there is no directory" in refused(tmp_path / "nowhere" / "file")
        assert not (tmp_path / "nowhere").exists()

    def test_no_file_where_one_must_be(self, path: Path) -> None:
        assert "there is no such file" in refused(path, create=False)
        assert not path.exists()

    def test_used_already_even_when_idle(self, path: Path) -> None:
        first = Store(path)
        assert "in use" in refused(path)
        first.write({0: FULL})
        first.close()
        assert opened(path) == {0: FULL}

    @pytest.mark.skipif(not hasattr(os, "geteuid"), reason="needs users")
    @pytest.mark.parametrize("locked", ["file", "directory"])
    def test_what_may_not_be_written(self, locked: str) -> None:
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory, "unit.state")
            if locked == "file":
                made(path).chmod(0o444)
            Path(directory).chmod(0o777 if locked == "file" else 0o555)
            assert self.told_without_privileges(path) == f"{path}: cannot be {WHY[locked]}\n"
            Path(directory).chmod(0o755)

    @staticmethod
    def told_without_privileges(path: Path) -> str:
        """What a process that is not root is told."""
        code = (
            "import os, sys\n"
            "from emulator.state.store import Store\n"
            "from emulator.state.errors import StateError\n"
            "if os.geteuid() == 0: os.setgroups([]); os.setgid(65534); os.setuid(65534)\n"
            "try: Store(sys.argv[1])\n"
            "except StateError as error: print(error)\n"
        )
        done = subprocess.run(
            [sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True, cwd=REPOSITORY
        )
        return done.stdout


class TestTakenAway:
    def test_a_deleted_file_is_made_anew_with_all_it_had(self, path: Path) -> None:
        store = Store(path)
        store.write({0: FULL, 1: FULL})
        path.unlink()
        store.write({0: FULL._replace(texts=("new",))})
        store.close()
        assert opened(path) == {0: FULL._replace(texts=("new",)), 1: FULL}

    def test_another_file_in_its_place_is_not_written(self, path: Path) -> None:
        store = Store(path)
        store.write({0: FULL})
        path.unlink()
        path.write_text("mine")
        with pytest.raises(StateError, match="replaced by another file"):
            store.write({0: Contents()})
        store.close()
        assert path.read_text() == "mine"

    def test_a_full_disk_leaves_the_file_as_it_was(self, path: Path) -> None:
        store = Store(path)
        store.write({0: FULL})
        pages = store._connection.execute("PRAGMA page_count").fetchone()[0]
        store._connection.execute(f"PRAGMA max_page_count = {pages}")
        large = FULL._replace(texts=("X" * 100_000,))
        with pytest.raises(StateError, match="no space left"):
            store.write({0: large})
        assert store.contents(0) == FULL
        store._connection.execute("PRAGMA max_page_count = 1000000")
        store.write({0: large})
        store.close()
        assert opened(path) == {0: large}


def test_the_file_is_marked(path: Path) -> None:
    """`file` and SQLite's own tools can tell what it is."""
    data = made(path).read_bytes()
    assert data[:15] == b"SQLite format 3"
    assert int.from_bytes(data[68:72]) == APPLICATION_ID
    assert int.from_bytes(data[60:64]) == FORMAT_VERSION

"""The state file: SQLite, one file for all units of an emulator, a transaction for what one turn changed.

Write-ahead log with `synchronous=FULL`: a commit is one append and one fsync (half the time of a rollback journal,
which takes two or three), is whole or absent after SIGKILL and after a power cut, and at an orderly end the log is
folded back, so that one file is left. `FILE-wal` beside a file whose emulator was killed belongs to it. Locking mode
EXCLUSIVE from the first access: the operating system drops the lock with the process however that ends, no lock file
is left lying about, and no shared memory file is needed.

SQLite has no checksum over contents, so there is one of ours: the sum of a hash of every row, kept in the same
transaction. It costs what the changed rows cost and sees a row that was altered, added or taken away.

Never open the file by other means while a `Store` has it: closing any descriptor of a file drops the locks this process
holds on it (POSIX).
"""

from __future__ import annotations

import contextlib
import os
import sqlite3
from collections.abc import Iterator, Mapping
from hashlib import blake2b
from pathlib import Path

from emulator.state.contents import Contents, Key, Part, PartName, Rows, contents_of, difference, parts
from emulator.state.errors import DamagedError, StateError

APPLICATION_ID = int.from_bytes(b"6250")
FORMAT_VERSION = 1
LOCK_PATIENCE_S = 0.5
"""An emulator that is just ending, or `oem6250 state` in passing, is waited for this long (design choice)."""

_SCHEMA = (
    "CREATE TABLE kept (unit INTEGER NOT NULL, kind TEXT NOT NULL, name TEXT NOT NULL, place INTEGER NOT NULL,"
    " value TEXT NOT NULL, PRIMARY KEY (unit, kind, name, place)) WITHOUT ROWID",
    "CREATE TABLE seal (one INTEGER PRIMARY KEY CHECK (one = 1), checksum TEXT NOT NULL)",
    "INSERT INTO seal VALUES (1, '0')",
    f"PRAGMA application_id = {APPLICATION_ID}",
    f"PRAGMA user_version = {FORMAT_VERSION}",
)
_REASONS = {
    sqlite3.SQLITE_BUSY: "in use by another emulator",
    sqlite3.SQLITE_LOCKED: "in use by another emulator",
    sqlite3.SQLITE_READONLY: "cannot be written (read-only file or directory)",
    sqlite3.SQLITE_CANTOPEN: "cannot be opened or made (directory or file not accessible)",
    sqlite3.SQLITE_PERM: "cannot be opened (permission denied)",
    sqlite3.SQLITE_NOTADB: "is not a state file (nor damaged beyond its first bytes); it was left as it is",
    sqlite3.SQLITE_FULL: "cannot be written (no space left)",
    sqlite3.SQLITE_TOOBIG: "cannot be written (file too large)",
}
_DAMAGED = frozenset({sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_FORMAT, sqlite3.SQLITE_ERROR})
"""Primary result codes that, on reading a file with our mark, mean that it is not what was written. ERROR: a table is
missing."""
_PRIMARY = 0xFF
_WORD = 1 << 64


class Store:
    """A state file that is open and ours alone. Not for several threads at once.

    `units` are the rows of each unit as the file has them; do not change them.
    """

    def __init__(self, path: str | Path, *, create: bool = True) -> None:
        """Open a file, make it if it is absent (or empty) and `create`.

        Raises:
            DamagedError: the file is ours and damaged; it was left as it is.
            StateError: it cannot be used.
        """
        self.path = Path(path)
        self.units: dict[int, Rows] = {}
        self.set_aside: Path | None = None
        """Where `open_or_set_aside` put the damaged file that was here."""
        self._baselines: dict[int, dict[PartName, Part]] = {}
        self._checksum = 0
        self._open(create=create)

    @classmethod
    def open_or_set_aside(cls, path: str | Path) -> Store:
        """As the constructor, but a damaged file is renamed to FILE.damaged-1 (-2 ...) and a fresh one made."""
        try:
            return cls(path)
        except DamagedError:
            aside = _move_aside(Path(path))
        store = cls(path)
        store.set_aside = aside
        return store

    def close(self) -> None:
        """Fold the log back and let go of the file."""
        self._connection.close()

    # Opening.

    def _open(self, *, create: bool) -> None:
        self._check_place(create=create)
        with self._told():
            self._connection = sqlite3.connect(
                f"{self.path.absolute().as_uri()}?mode={'rwc' if create else 'rw'}",
                uri=True,
                timeout=LOCK_PATIENCE_S,
                isolation_level=None,
                check_same_thread=False,
            )
        try:
            with self._told():
                self._take_possession()
            self._load()
            self._identity = self._identity_now()
        except BaseException:
            self._connection.close()
            raise

    def _check_place(self, *, create: bool) -> None:
        """What SQLite would only call 'unable to open database file'."""
        if self.path.is_dir():
            raise StateError(f"{self.path}: is a directory")
        if not self.path.exists() and not create:
            raise StateError(f"{self.path}: there is no such file")
        directory = self.path.absolute().parent
        if not directory.is_dir():
            raise StateError(f"{self.path}: there is no directory {directory}")
        if self.path.exists() and not os.access(self.path, os.R_OK | os.W_OK):
            raise StateError(f"{self.path}: cannot be written (read-only file)")
        if not os.access(directory, os.W_OK | os.X_OK):
            raise StateError(f"{self.path}: cannot be written (read-only directory, and SQLite needs a log beside it)")

    def _take_possession(self) -> None:
        execute = self._connection.execute
        execute("PRAGMA locking_mode = EXCLUSIVE")
        execute("BEGIN IMMEDIATE")
        mark, version = self._pragma("application_id"), self._pragma("user_version")
        (tables,) = execute("SELECT count(*) FROM sqlite_master").fetchone()
        execute("ROLLBACK")
        fresh = mark == version == tables == 0
        if not fresh and mark != APPLICATION_ID:
            raise StateError(f"{self.path}: is a database of another program; it was left as it is")
        if version > FORMAT_VERSION:
            raise StateError(
                f"{self.path}: was written by a newer oem6250 (format {version}, this one reads {FORMAT_VERSION});"
                " it was left as it is"
            )
        execute("PRAGMA journal_mode = WAL")
        execute("PRAGMA synchronous = FULL")
        execute("BEGIN IMMEDIATE")
        for statement in _SCHEMA if fresh else ():
            execute(statement)
        execute("COMMIT")

    def _pragma(self, name: str) -> int:
        return int(self._connection.execute(f"PRAGMA {name}").fetchone()[0])

    def _load(self) -> None:
        try:
            self._read_rows()
        except sqlite3.Error as error:
            if _code(error) in _DAMAGED:
                raise DamagedError(f"{self.path}: is damaged ({error})") from None
            raise self._refusal(error) from None
        except ValueError as error:
            raise DamagedError(f"{self.path}: is damaged ({error})") from None

    def _read_rows(self) -> None:
        execute = self._connection.execute
        (verdict,) = execute("PRAGMA quick_check(1)").fetchone()
        if verdict != "ok":
            raise ValueError(str(verdict).splitlines()[-1])
        units: dict[int, Rows] = {}
        checksum = 0
        for unit, kind, name, place, value in execute("SELECT unit, kind, name, place, value FROM kept"):
            key = Key(kind, name, place)
            units.setdefault(unit, {})[key] = value
            checksum += _hash(unit, key, value)
        (sealed,) = execute("SELECT checksum FROM seal").fetchone() or ("none",)
        if sealed != str(checksum % _WORD):
            raise ValueError("its checksum does not match its contents")
        for rows in units.values():
            contents_of(rows)
        self.units, self._checksum = units, checksum % _WORD

    # Reading and writing.

    def contents(self, unit: int) -> Contents:
        """What the file has of a unit; nothing is that of a new unit."""
        return contents_of(self.units.get(unit, {}))

    def adopt(self, unit: int, contents: Contents) -> None:
        """What a unit holds at its start: later snapshots are compared with this. Nothing is written.

        What the file has beyond it (variables this machine has not got, say) stays in the file.
        """
        self._baselines[unit] = parts(contents)

    def write(self, snapshots: Mapping[int, Contents]) -> None:
        """Make snapshots of units durable, all or nothing.

        Raises:
            StateError: it could not be written; the file is as it was before.
        """
        cut = {unit: parts(contents) for unit, contents in snapshots.items()}
        put: dict[int, Rows] = {}
        taken: dict[int, set[Key]] = {}
        for unit, new in cut.items():
            put[unit], taken[unit] = _difference(self._baselines.get(unit, {}), new)
            taken[unit] |= self._left_over(unit, new) - put[unit].keys()
        self._commit(put, taken)
        self._baselines.update(cut)

    def replace(self, units: Mapping[int, Rows]) -> None:
        """Put other contents in place of everything; errors as `write`."""
        put = {unit: dict(rows) for unit, rows in units.items()}
        taken = {unit: set(rows) - set(units.get(unit, {})) for unit, rows in self.units.items()}
        self._commit(put, taken)
        self._baselines.clear()

    def _left_over(self, unit: int, new: Mapping[PartName, Part]) -> set[Key]:
        """Rows of programs that did not fit at the start and whose names are now given to others."""
        names = {name for kind, name in new.keys() - self._baselines.get(unit, {}).keys() if kind == "program"}
        present = self.units.get(unit, {}) if names else {}
        return {key for key in present if key.kind in ("program", "scaled") and key.name in names}

    def _commit(self, put: Mapping[int, Rows], taken: Mapping[int, set[Key]]) -> None:
        self._check_identity()
        if not any(put.values()) and not any(taken.values()):
            return
        checksum = self._checksum
        with self._told(), self._transaction() as connection:
            for unit, keys in taken.items():
                present = self.units.get(unit, {})
                gone = [key for key in keys if key in present]
                checksum -= sum(_hash(unit, key, present[key]) for key in gone)
                connection.executemany(
                    "DELETE FROM kept WHERE unit = ? AND kind = ? AND name = ? AND place = ?",
                    [(unit, *key) for key in gone],
                )
            for unit, rows in put.items():
                present = self.units.get(unit, {})
                checksum -= sum(_hash(unit, key, present[key]) for key in rows if key in present)
                checksum += sum(_hash(unit, key, text) for key, text in rows.items())
                connection.executemany(
                    "INSERT OR REPLACE INTO kept VALUES (?, ?, ?, ?, ?)",
                    [(unit, *key, text) for key, text in rows.items()],
                )
            connection.execute("UPDATE seal SET checksum = ?", (str(checksum % _WORD),))
        self._checksum = checksum % _WORD
        self._note(put, taken)

    def _note(self, put: Mapping[int, Rows], taken: Mapping[int, set[Key]]) -> None:
        for unit, keys in taken.items():
            rows = self.units.setdefault(unit, {})
            for key in keys:
                rows.pop(key, None)
        for unit, rows in put.items():
            self.units.setdefault(unit, {}).update(rows)

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        connection = self._connection
        try:
            connection.execute("BEGIN IMMEDIATE")
            yield connection
            connection.execute("COMMIT")
        except BaseException:
            if connection.in_transaction:
                with contextlib.suppress(sqlite3.Error):
                    connection.execute("ROLLBACK")
            raise

    # A file that is taken away while it is in use.

    def _identity_now(self) -> tuple[int, int] | None:
        try:
            status = os.stat(self.path)
        except OSError:
            return None
        return status.st_dev, status.st_ino

    def _check_identity(self) -> None:
        """Writing into a file that has been deleted would look well and keep nothing: it is made anew, with all it had.

        Raises:
            StateError: another file is there in its place.
        """
        now = self._identity_now()
        if now == self._identity:
            return
        if now is not None:
            raise StateError(f"{self.path}: has been replaced by another file")
        kept = self.units
        self._connection.close()
        try:
            self._open(create=True)
            self._write_all(kept)
        finally:
            self.units = kept

    def _write_all(self, kept: Mapping[int, Rows]) -> None:
        try:
            self._commit(kept, {})
        except StateError:
            self._connection.close()
            self.path.unlink(missing_ok=True)
            raise

    # Errors.

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        """SQLite's errors as ours."""
        try:
            yield
        except sqlite3.Error as error:
            raise self._refusal(error) from None

    def _refusal(self, error: sqlite3.Error) -> StateError:
        code = _code(error)
        if code == sqlite3.SQLITE_CORRUPT:
            return DamagedError(f"{self.path}: is damaged ({error})")
        return StateError(f"{self.path}: {_REASONS.get(code, f'cannot be used ({error})')}")


def _code(error: sqlite3.Error) -> int:
    return int(getattr(error, "sqlite_errorcode", 0)) & _PRIMARY


def _difference(old: Mapping[PartName, Part], new: Mapping[PartName, Part]) -> tuple[Rows, set[Key]]:
    """Rows to put, and keys to take away, between two snapshots of a unit."""
    put: Rows = {}
    taken: set[Key] = set()
    for name in old.keys() | new.keys():
        was, is_now = difference(old.get(name), new.get(name))
        put |= {key: text for key, text in is_now.items() if was.get(key) != text}
        taken |= was.keys() - is_now.keys()
    return put, taken


def _hash(unit: int, key: Key, value: str) -> int:
    row = repr((unit, *key, value)).encode()
    return int.from_bytes(blake2b(row, digest_size=8).digest())


def _move_aside(path: Path) -> Path:
    """Rename a damaged file, and its log with it, to the first free name.

    Raises:
        StateError: it cannot be renamed.
    """
    number = 1
    while (aside := path.with_name(f"{path.name}.damaged-{number}")).exists():
        number += 1
    try:
        path.rename(aside)
        for suffix in ("-wal", "-shm", "-journal"):
            beside = path.with_name(path.name + suffix)
            if beside.exists():
                beside.rename(aside.with_name(aside.name + suffix))
    except OSError as error:
        raise StateError(f"{path}: is damaged and cannot be set aside ({error.strerror})") from None
    return aside

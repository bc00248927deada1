"""A recording read line by line, without holding it in memory, or whole."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from emulator.recording.format import End, Entry, RecordingError, parse_entry
from emulator.recording.header import Header, HeaderReader, check_first_line

Numbered = Iterator[tuple[int, str]]


@dataclass(frozen=True, slots=True)
class Recording:
    """A whole recording; `complete` tells that it was closed, not cut."""

    header: Header
    entries: tuple[Entry, ...]
    complete: bool


class Reader:
    """An open recording: the head at once, then the entries by iterating, once. Use as a context manager.

    Raises:
        RecordingError: the file cannot be read, is no recording, or has no complete head; names the file and line.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = str(path)
        self.complete = False
        """The entry `end` has been read."""
        self._line = 0
        try:
            self._file = open(path, "rb")  # noqa: SIM115 closed by close()
        except OSError as error:
            raise RecordingError(f"{path}: cannot be read ({error.strerror})") from None
        self._lines = self._numbered()
        try:
            self.header = self._head()
        except RecordingError:
            self.close()
            raise

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        self._file.close()

    def __iter__(self) -> Iterator[Entry]:
        for number, text in self._lines:
            try:
                entry = parse_entry(text, line=number)
                if entry is not None and self.complete:
                    raise RecordingError("something follows after the end")
            except RecordingError as error:
                raise self._wrong(error) from None
            if entry is not None:
                self.complete = isinstance(entry, End)
                yield entry

    def _numbered(self) -> Numbered:
        """The complete lines; what follows the last line feed was cut while it was being written."""
        try:
            for raw in self._file:
                if not raw.endswith(b"\n"):
                    return
                self._line += 1
                yield self._line, raw[:-1].decode("utf-8", "surrogateescape")
        except OSError as error:
            raise RecordingError(f"{self.path}: cannot be read ({error.strerror})") from None

    def _head(self) -> Header:
        head = HeaderReader()
        try:
            for number, text in self._lines:
                if number == 1:
                    check_first_line(text)
                elif (header := head.take(text)) is not None:
                    return header
        except RecordingError as error:
            raise self._wrong(error) from None
        if self._line == 0:
            raise RecordingError(f"{self.path}: not a recording: it has no complete line")
        raise RecordingError(f"{self.path}:{self._line}: cut within its head, there is nothing to replay")

    def _wrong(self, error: RecordingError) -> RecordingError:
        return RecordingError(f"{self.path}:{self._line}: {error}")


def read(path: str | Path) -> Recording:
    """The whole recording at `path`. Raises RecordingError."""
    with Reader(path) as reader:
        entries = tuple(reader)
        return Recording(reader.header, entries, reader.complete)

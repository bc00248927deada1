"""Writing a recording without ever making the engine wait.

Lines are formatted where they arise and handed to a thread that writes them in batches, so a slow disk delays the file
and nothing else. What was written survives the death of the process; at most `FLUSH_EVERY_S` of lines has not
been. When the disk fails or falls behind further than `MAX_BACKLOG_BYTES` the recording ends with one warning and
the units go on: a file with a hole could not be replayed beyond it.
"""

from __future__ import annotations

import contextlib
import logging
import os
import stat
import threading
from collections import deque
from pathlib import Path

from emulator.logs import event_line
from emulator.recording.format import End, Entry, RecordingError, format_entry
from emulator.recording.header import Header, format_header

FLUSH_EVERY_S = 0.1
"""How much of a session a killed process may lose (design choice)."""
WAKE_AT_BYTES = 262_144
"""A backlog that is written without waiting for the next round."""
MAX_BACKLOG_BYTES = 64 * 1024 * 1024
"""What may wait for a slow disk: minutes of the heaviest traffic (design choice)."""
CLOSE_PATIENCE_S = 5.0

_log = logging.getLogger("oem6250.recording")


class Recorder:
    """An open recording. `put` may be called from one thread at a time and never blocks.

    Raises:
        RecordingError: there is such a file already and it is not empty, or it cannot be written.
    """

    def __init__(self, path: str | Path, header: Header) -> None:
        self.path = str(path)
        self.failed = False
        """The disk did not take it: nothing is recorded any more."""
        self._queue: deque[bytes] = deque()
        self._put_bytes = 0
        self._written_bytes = 0
        self._wake = threading.Event()
        self._closing = False
        self._descriptor = _open(self.path)
        try:
            _write_all(self._descriptor, format_header(header))
        except OSError as error:
            os.close(self._descriptor)
            raise RecordingError(f"{path}: cannot be written ({error.strerror})") from None
        self._thread = threading.Thread(target=self._run, name="recording", daemon=True)
        self._thread.start()

    def put(self, line: bytes) -> None:
        """A line, its line feed included."""
        if self.failed or self._closing:
            return
        self._queue.append(line)
        self._put_bytes += len(line)
        backlog_bytes = self._put_bytes - self._written_bytes
        if backlog_bytes > WAKE_AT_BYTES:
            self._wake.set()
            if backlog_bytes > MAX_BACKLOG_BYTES:
                self._fail("the disk is too slow")

    def note(self, entry: Entry) -> None:
        """An entry, formatted here."""
        self.put(format_entry(entry))

    def close(self, at_ns: int | None = None) -> None:
        """Write what waits and close the file; `at_ns` is the time up to which it is complete, None if unknown."""
        if self._closing:
            return
        if at_ns is not None:
            self.note(End(at_ns))
        self._closing = True
        self._wake.set()
        self._thread.join(CLOSE_PATIENCE_S)
        if self._thread.is_alive():
            self._fail("the disk does not finish")

    def _run(self) -> None:
        try:
            while not self.failed:
                self._wake.wait(FLUSH_EVERY_S)
                self._wake.clear()
                closing = self._closing
                self._write_waiting()
                if closing:
                    return
        finally:
            with contextlib.suppress(OSError):
                os.close(self._descriptor)

    def _write_waiting(self) -> None:
        lines = [self._queue.popleft() for _ in range(len(self._queue))]
        if not lines:
            return
        batch = b"".join(lines)
        try:
            _write_all(self._descriptor, batch)
        except OSError as error:
            self._fail(error.strerror or "write error")
        self._written_bytes += len(batch)

    def _fail(self, reason: str) -> None:
        if not self.failed:
            self.failed = True
            self._queue.clear()
            _log.warning(event_line("recording stopped", file=self.path, reason=reason))


def _open(path: str) -> int:
    """A descriptor to write to. An existing recording is never written over; an empty file or a device is taken."""
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
        found = os.fstat(descriptor)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written ({error.strerror})") from None
    if stat.S_ISREG(found.st_mode) and found.st_size:
        os.close(descriptor)
        raise RecordingError(f"{path}: there is such a file already, and a recording is never written over")
    return descriptor


def _write_all(descriptor: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]

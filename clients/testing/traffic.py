"""What passed between hosts and units in one test, in the form of a recording (docs/recording.md).

It is kept in memory, so that a failing test can show its last lines and be written to a file for ``oem6250 replay``.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from emulator.recording.format import End, Entry, format_entry, parse_entry

if TYPE_CHECKING:
    from emulator.machine import Machine
    from emulator.recording.header import Header

MAX_LINES = 200_000
"""Kept of a session; a longer one can still show its end but not be replayed (design choice)."""


class Traffic:
    """The lines of a session.

    Args:
        machines: of the units, for the head.
        collect: brings what units have said up to now into the lines.
        now_ns: the virtual time.
        options: of the head, as ``emulator.recording.session.describe`` takes them.
    """

    def __init__(
        self,
        machines: Sequence[Machine],
        *,
        collect: Callable[[], None],
        now_ns: Callable[[], int],
        speed: str = "virtual",
        chain: int = 1,
    ) -> None:
        self._machines = machines
        self._collect = collect
        self._now_ns = now_ns
        self._speed = speed
        self._chain = chain
        self._lines: deque[bytes] = deque(maxlen=MAX_LINES)
        self._count = 0

    def put(self, line: bytes) -> None:
        """A line, its line feed included."""
        self._lines.append(line)
        self._count += 1

    def note(self, entry: Entry) -> None:
        """An entry, formatted here."""
        self.put(format_entry(entry))

    @property
    def complete(self) -> bool:
        """Nothing has been forgotten."""
        return self._count == len(self._lines)

    def lines(self) -> list[str]:
        """Everything up to now, a line each: ``0.500000000 u0 c0 > "1TPE\\r"``."""
        self._collect()
        return [line.decode("ascii").rstrip("\n") for line in self._lines]

    def tail(self, count: int) -> list[str]:
        """The last lines, after one that says how many were left out."""
        lines = self.lines()
        left_out = self._count - min(count, len(lines))
        return ([f"... {left_out} lines before"] if left_out else []) + lines[-count:]

    def entries(self) -> list[Entry]:
        """Everything up to now, as the recording module knows it."""
        entries = (parse_entry(line, line=number) for number, line in enumerate(self.lines(), start=1))
        return [entry for entry in entries if entry is not None]

    def recording(self) -> bytes:
        """A complete recording of the session up to now.

        Raises:
            ValueError: the beginning has been forgotten, or a machine cannot be written as a machine file.
        """
        from emulator.recording.header import format_header

        if not self.complete:
            raise ValueError(f"the session is longer than the {MAX_LINES} lines that are kept")
        lines = self.lines()
        end = format_entry(End(self._now_ns()))
        return format_header(self._header()) + "".join(f"{line}\n" for line in lines).encode("ascii") + end

    def transcript(self, title: str) -> str:
        """The session as a test transcript (docs/recording.md).

        Raises:
            ValueError: it has what a transcript cannot say.
        """
        from emulator.recording.transcribing import transcript

        return transcript(self._header(), [*self.entries(), End(self._now_ns())], title=title)

    def write(self, path: Path) -> None:
        """Write the recording to a file, over one that is there."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(self.recording())

    def _header(self) -> Header:
        from emulator.recording.machine_text import machine_text
        from emulator.recording.session import describe

        return describe([machine_text(each) for each in self._machines], speed=self._speed, chain=self._chain)

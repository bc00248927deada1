"""`python -m clients` in a pseudo-terminal of its own, typed at and read like a person does."""

from __future__ import annotations

import fcntl
import os
import select
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path
from types import TracebackType

import pyte

REPOSITORY = Path(__file__).resolve().parents[3]
PATIENCE_S = 15.0
ROWS, COLUMNS = 40, 160

BE_ITS_TERMINAL = (
    "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); "
    "os.execv(sys.executable, [sys.executable, *sys.argv[1:]])"
)
"""Only a controlling terminal turns Ctrl-C into a signal while the program is not reading keys."""

WHERE_IS_THE_CURSOR = b"\x1b[6n"


class Screen:
    """The program's terminal, as a person would see it; lines that were scrolled away still count."""

    def __init__(self, *arguments: str, history: Path, program: tuple[str, ...] = ("-m", "clients")) -> None:
        ours, theirs = os.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        command = [sys.executable, "-c", BE_ITS_TERMINAL, *program, *arguments, "--history", str(history)]
        environment = {**os.environ, "TERM": "xterm"}
        self.process = subprocess.Popen(
            command, stdin=theirs, stdout=theirs, stderr=theirs, cwd=REPOSITORY, env=environment, start_new_session=True
        )
        os.close(theirs)
        self._ours = ours
        self._screen = pyte.HistoryScreen(COLUMNS, ROWS, history=2000)
        self._stream = pyte.ByteStream(self._screen)
        self._before = ""

    def __enter__(self) -> Screen:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self._ours)

    @property
    def shown(self) -> str:
        """What is on the screen, and what was."""
        gone = ["".join(line[column].data for column in range(COLUMNS)) for line in self._screen.history.top]
        return "\n".join(line.rstrip() for line in [*gone, *self._screen.display]).rstrip()

    def type(self, keys: str) -> None:
        """Press keys."""
        self._before = self.shown
        os.write(self._ours, keys.encode())

    def wait_for(self, text: str) -> str:
        """Read until a text is on the screen that was not there before the last keys; AssertionError if it never is."""
        deadline = time.monotonic() + PATIENCE_S
        while self.shown.count(text) <= self._before.count(text):
            left = deadline - time.monotonic()
            assert left > 0, f"{text!r} never came; there is: {self.shown}"
            assert self._read(left), f"{text!r} never came before the program ended; there is: {self.shown}"
        return self.shown

    def enter(self, line: str, answer: str) -> str:
        """Type a line and wait for something in what comes then."""
        self.type(f"{line}\r")
        return self.wait_for(answer)

    def ended(self) -> int:
        """Its exit status, when it has ended by itself."""
        deadline = time.monotonic() + PATIENCE_S
        while self._read(0.1):
            assert time.monotonic() < deadline, f"it goes on; there is: {self.shown}"
        return self.process.wait(PATIENCE_S)

    def _read(self, timeout_s: float) -> bool:
        """Take in what there is; False at the end."""
        if not select.select([self._ours], [], [], timeout_s)[0]:
            return True
        try:
            data = os.read(self._ours, 65536)
        except OSError:
            return False
        self._stream.feed(data)
        for _ in range(data.count(WHERE_IS_THE_CURSOR)):
            os.write(self._ours, b"\x1b[%d;%dR" % (self._screen.cursor.y + 1, self._screen.cursor.x + 1))
        return bool(data)

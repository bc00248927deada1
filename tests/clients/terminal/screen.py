"""`python -m clients` in a pseudo-terminal of its own, typed at and read like a person does."""

from __future__ import annotations

import fcntl
import os
import re
import select
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path
from types import TracebackType

REPOSITORY = Path(__file__).resolve().parents[3]
PATIENCE_S = 20.0
ROWS, COLUMNS = 40, 160

_CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>()][A-Z0-9]?|\r")


class Screen:
    """The program's terminal; `shown` is all it has written, without what only moves the cursor."""

    def __init__(self, *arguments: str, history: Path, program: tuple[str, ...] = ("-m", "clients")) -> None:
        ours, theirs = os.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        command = [sys.executable, *program, *arguments, "--history", str(history)]
        environment = {**os.environ, "TERM": "xterm", "PROMPT_TOOLKIT_NO_CPR": "1"}
        self.process = subprocess.Popen(
            command, stdin=theirs, stdout=theirs, stderr=theirs, cwd=REPOSITORY, env=environment, start_new_session=True
        )
        os.close(theirs)
        self._ours = ours
        self._written = b""

    def __enter__(self) -> Screen:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self._ours)

    @property
    def shown(self) -> str:
        return _CONTROL.sub("", self._written.decode("utf-8", "replace"))

    def type(self, keys: str) -> None:
        """Press keys."""
        self._written = b""
        os.write(self._ours, keys.encode())

    def wait_for(self, text: str) -> str:
        """Read until a text is on the screen that was not there before the last keys; AssertionError if it never is."""
        deadline = time.monotonic() + PATIENCE_S
        while text not in self.shown:
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
        while self._read(PATIENCE_S):
            pass
        return self.process.wait(PATIENCE_S)

    def _read(self, timeout_s: float) -> bool:
        """Take in what there is; False at the end."""
        if not select.select([self._ours], [], [], timeout_s)[0]:
            return True
        try:
            data = os.read(self._ours, 65536)
        except OSError:
            return False
        self._written += data
        return bool(data)

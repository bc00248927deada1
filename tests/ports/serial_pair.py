"""A cable between two serial ports of this machine, made by socat, that can be pulled out and put back."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from pathlib import Path
from types import TracebackType

import pytest

from tests.ports.served import PATIENCE_S, wait_until

# Meant: socat is a program of the system, not of the package index; `apt install socat` brings it.
needs_socat = pytest.mark.skipif(shutil.which("socat") is None, reason="socat, which makes the cable, is missing")


class SerialPair:
    """`unit` and `host` are the two ends, links to pseudo-terminals. Plugged in from the start; a context manager.

    The ends are held open besides: socat would take a host that closes its port for the end of the cable.
    """

    def __init__(self, folder: Path) -> None:
        self.unit, self.host = folder / "unit", folder / "host"
        self._held: list[int] = []
        self._process: subprocess.Popen[bytes] | None = None
        self.plug()

    def __enter__(self) -> SerialPair:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        self.unplug()

    def plug(self) -> None:
        """Both devices appear (with other numbers than before, as a USB adapter may)."""
        ends = [f"pty,raw,echo=0,link={end}" for end in (self.unit, self.host)]
        self._process = subprocess.Popen(["socat", *ends])
        wait_until(lambda: self.unit.exists() and self.host.exists())
        self._held = [os.open(end, os.O_RDWR | os.O_NOCTTY) for end in (self.unit, self.host)]

    def unplug(self) -> None:
        """Both devices vanish, whoever has them open."""
        if self._process is None:
            return
        self._process.terminate()
        self._process.wait(PATIENCE_S)
        self._process = None
        for fd in self._held:
            with contextlib.suppress(OSError):
                os.close(fd)
        wait_until(lambda: not self.unit.is_symlink() and not self.host.is_symlink())

"""An emulator in a process of its own, for host code that must not share one with it.

The test cannot look inside it, inject faults or move its time: it has ports and a speed.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from clients.testing.errors import NotPossible

START_PATIENCE_S = 180.0
"""A cold start compiles the servo kernel."""
END_PATIENCE_S = 10.0
_POLL_S = 0.005


class ServedProcess:
    """`oem6250 serve` as a child process.

    Args:
        machine: a Machine, the text of a machine file or the path of one; None is the default machine.
        chain: units on the line.
        speed: N or ``max``; ``waiting``, which needs the test to take part, becomes ``max``.
    """

    def __init__(self, machine: Any = None, *, chain: int = 1, speed: float | str = "max") -> None:
        self._machine = machine
        self._chain = chain
        self.speed = "max" if speed == "waiting" else speed
        self._directory = tempfile.TemporaryDirectory(prefix="oem6250-")
        self._process: subprocess.Popen[str] | None = None
        self._announced: dict[str, Any] = {}

    def __enter__(self) -> ServedProcess:
        place = Path(self._directory.name)
        announced = place / "announced"
        command = [sys.executable, "-m", "emulator", "serve", *self._machine_file(place)]
        command += ["--tcp", "127.0.0.1:0", "--pty", "none" if sys.platform == "win32" else str(place / "port")]
        command += ["--units", str(self._chain), "--speed", f"{self.speed}", "--announce", str(announced)]
        self._process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + START_PATIENCE_S
        while not announced.exists():
            if self._process.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError(f"oem6250 serve did not start: {self._end()}")
            time.sleep(_POLL_S)
        self._announced = json.loads(announced.read_text())
        return self

    def __exit__(self, *error: object) -> None:
        self._end()
        self._directory.cleanup()

    @property
    def address(self) -> tuple[str, int]:
        """Host and port of the TCP port."""
        host, _, port = str(self._announced["tcp"][0]).rpartition(":")
        return host, int(port)

    @property
    def tcp_url(self) -> str:
        """``tcp://127.0.0.1:PORT``."""
        return f"tcp://{self._announced['tcp'][0]}"

    @property
    def port(self) -> str:
        """The virtual serial port; NotPossible where the system has none (Windows)."""
        if not self._announced["pty"]:
            raise NotPossible("this system has no virtual serial ports; use tcp_url")
        return str(self._announced["pty"])

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"an emulator in a process of its own has no {name!r}; leave out process=True")

    def _machine_file(self, place: Path) -> list[str]:
        if self._machine is None:
            return []
        from clients.testing.machines import machine_of
        from emulator.recording.machine_text import machine_text

        path = place / "machine.toml"
        path.write_text(machine_text(machine_of(self._machine)), encoding="utf-8")
        return [str(path)]

    def _end(self) -> str:
        """End the process; what it had to complain about."""
        process, self._process = self._process, None
        if process is None:
            return ""
        process.terminate()
        try:
            return process.communicate(timeout=END_PATIENCE_S)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            return process.communicate()[1]

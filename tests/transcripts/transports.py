"""The ways from a test to a running unit, all used alike: through the wires a host would use and its own software.

Each transport adds options to the command line of the server (`prepare`), opens a client once the server has announced
itself, and cleans up. What a client receives is what the host's program would see: after the telnet layer, where
there is one. A transport that this machine has not the means for says why in `missing`.
"""

from __future__ import annotations

import contextlib
import os
import select
import shutil
import subprocess
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from clients import LineClient
from tests.ports.serial_pair import SerialPair

Told = Mapping[str, object]
"""What the server announced."""

START_PATIENCE_S = 10.0
TELNET = "telnet"
_PTY_BYTES = 65536


class Transport(Protocol):
    """One way to a server; made anew for each server."""

    name: str
    missing: str | None
    """Why it cannot be used here; None if it can."""

    def prepare(self, folder: Path, number: int) -> list[str]:
        """Options for the server; starts whatever must be there before it."""
        ...

    def open(self, told: Told, *, timeout_s: float) -> LineClient: ...

    def close(self) -> None:
        """After the server has ended."""
        ...


class _Plain:
    """A transport that needs nothing beside the server."""

    missing: str | None = None

    def close(self) -> None:
        pass


class Tcp(_Plain):
    """A raw socket."""

    name = "tcp"

    def prepare(self, folder: Path, number: int) -> list[str]:
        return ["--tcp", "127.0.0.1:0"]

    def open(self, told: Told, *, timeout_s: float) -> LineClient:
        return LineClient.open(f"tcp://{_first(told, 'tcp')}", timeout_s=timeout_s)


class Rfc2217(_Plain):
    """pyserial's `rfc2217://`, on the port of the raw sockets."""

    name = "rfc2217"

    def prepare(self, folder: Path, number: int) -> list[str]:
        return []

    def open(self, told: Told, *, timeout_s: float) -> LineClient:
        return LineClient.open(f"rfc2217://{_first(told, 'tcp')}", timeout_s=timeout_s)


class Pty(_Plain):
    """The unit's pseudo-terminal, with pyserial."""

    name = "pty"
    missing = None if hasattr(os, "openpty") else "no pseudo-terminals here"

    def prepare(self, folder: Path, number: int) -> list[str]:
        return ["--pty", "none" if self.missing else str(folder / f"pty{number}")]

    def open(self, told: Told, *, timeout_s: float) -> LineClient:
        return LineClient.open(str(told["pty"]), timeout_s=timeout_s)


class SerialCable:
    """A serial port of this machine for the unit, another for the host with pyserial, and socat as the cable."""

    name = "serial"
    missing = None if shutil.which("socat") else "no socat here, which makes the cable"

    def prepare(self, folder: Path, number: int) -> list[str]:
        place = folder / f"cable{number}"
        place.mkdir()
        self._pair = SerialPair(place)
        return ["--serial", f"{self._pair.unit}:9600:8N1"]

    def open(self, told: Told, *, timeout_s: float) -> LineClient:
        return LineClient.open(str(self._pair.host), timeout_s=timeout_s)

    def close(self) -> None:
        if not self.missing:
            self._pair.unplug()


class TelnetSpeaksFirst(_Plain):
    """The system's telnet client on the port of the raw sockets, told by a dash to negotiate at once."""

    name = "telnet"
    missing = None if shutil.which(TELNET) and hasattr(os, "openpty") else "no telnet client here"
    dash = "-"
    announced = "tcp"

    def prepare(self, folder: Path, number: int) -> list[str]:
        return []

    def open(self, told: Told, *, timeout_s: float) -> LineClient:
        host, _, port = _first(told, self.announced).rpartition(":")
        return LineClient(TelnetLine("-E", "--", host, self.dash + port), timeout_s=timeout_s)


class TelnetListens(TelnetSpeaksFirst):
    """The same client, which says nothing by itself, on a `--telnet` port."""

    name = "telnet-listener"
    dash = ""
    announced = "telnet"

    def prepare(self, folder: Path, number: int) -> list[str]:
        return ["--telnet", "127.0.0.1:0"]


class TelnetLine:
    """The telnet client in a pseudo-terminal: what is sent is typed, what is received is what it shows."""

    name = TELNET
    clock = staticmethod(time.monotonic)

    def __init__(self, *arguments: str) -> None:
        self._fd, inner = os.openpty()
        environment = {**os.environ, "TERM": "dumb", "LC_ALL": "C"}
        self._process = subprocess.Popen(
            [TELNET, *arguments], stdin=inner, stdout=inner, stderr=inner, env=environment, start_new_session=True
        )
        os.close(inner)
        try:
            self.greeting = self._until(b"'off'.\r\n")
            self._until_character_mode()
        except OSError:
            self.close()
            raise

    def write(self, data: bytes) -> None:
        while data:
            data = data[os.write(self._fd, data) :]

    def read(self, timeout_s: float) -> bytes:
        if not select.select([self._fd], [], [], max(0.0, timeout_s))[0]:
            return b""
        try:
            return os.read(self._fd, _PTY_BYTES)
        except OSError:
            raise ConnectionResetError("telnet has ended") from None

    def close(self) -> None:
        self._process.kill()
        self._process.wait()
        with contextlib.suppress(OSError):
            os.close(self._fd)

    def _until(self, end: bytes) -> bytes:
        """Byte by byte, as what follows belongs to the session."""
        shown, deadline = b"", time.monotonic() + START_PATIENCE_S
        while not shown.endswith(end):
            ready = select.select([self._fd], [], [], max(0.0, deadline - time.monotonic()))[0]
            if not ready:
                raise TimeoutError(f"telnet shows {shown!r}")
            shown += os.read(self._fd, 1)
        return shown

    def _until_character_mode(self) -> None:
        """What is typed before the two sides have agreed would be echoed by the client or lost."""
        import termios

        deadline = time.monotonic() + START_PATIENCE_S
        while termios.tcgetattr(self._fd)[3] & (termios.ECHO | termios.ICANON):
            if time.monotonic() > deadline:
                raise TimeoutError("telnet stays in line mode")
            select.select([], [], [], 0.002)


def _first(told: Told, kind: str) -> str:
    addresses = told[kind]
    assert isinstance(addresses, list)
    return str(addresses[0])


ALL: tuple[type[Transport], ...] = (Tcp, Pty, TelnetSpeaksFirst, TelnetListens, Rfc2217, SerialCable)
"""Every transport; a further one is added here and nowhere else."""

"""A server process under test, and small blocking hosts that talk to it."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import TracebackType

import psutil

TOY = (sys.executable, "-m", "tests.ports.toy")
OEM6250 = (sys.executable, "-m", "emulator")
REPOSITORY = Path(__file__).resolve().parents[2]
PATIENCE_S = 20.0
START_PATIENCE_S = 180.0
"""A cold start compiles the servo kernel."""


class Served:
    """`COMMAND serve ...` as a child process, announced and ready. Use as a context manager."""

    def __init__(self, *options: str, announce: Path, command: Sequence[str] = TOY) -> None:
        arguments = [*command, "serve", "--announce", str(announce), *options]
        self.process = subprocess.Popen(arguments, cwd=REPOSITORY, stderr=subprocess.PIPE, text=True)
        wait_until(lambda: announce.exists() or self.process.poll() is not None, START_PATIENCE_S)
        if not announce.exists():
            raise AssertionError(f"server ended with {self.process.returncode}: {self.process.communicate()[1]}")
        self.announced = json.loads(announce.read_text())
        self.pty: str | None = self.announced["pty"]

    def __enter__(self) -> Served:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    @property
    def address(self) -> tuple[str, int]:
        host, _, port = self.announced["tcp"][0].rpartition(":")
        return host.strip("[]"), int(port)

    def connect(self) -> Host:
        sock = socket.create_connection(self.address, timeout=PATIENCE_S)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return Host(sock)

    def stop(self, number: int = signal.SIGTERM) -> tuple[int, float, str]:
        """Signal it; exit status, seconds it took, and what it wrote to stderr."""
        began = time.monotonic()
        self.process.send_signal(number)
        errors = self.process.communicate(timeout=PATIENCE_S)[1]
        return self.process.returncode, time.monotonic() - began, errors

    def descriptors(self) -> int:
        return psutil.Process(self.process.pid).num_fds()

    def resident_bytes(self) -> int:
        return int(psutil.Process(self.process.pid).memory_info().rss)


class Host:
    """A blocking TCP client that reads exactly what it expects."""

    def __init__(self, sock: socket.socket) -> None:
        self.sock = sock

    def __enter__(self) -> Host:
        return self

    def __exit__(self, *ignored: object) -> None:
        self.sock.close()

    def ask(self, data: bytes, count: int) -> bytes:
        """Send, then read `count` bytes."""
        self.sock.sendall(data)
        return self.read(count)

    def read(self, count: int) -> bytes:
        parts = bytearray()
        while len(parts) < count:
            part = self.sock.recv(count - len(parts))
            if not part:
                break
            parts += part
        return bytes(parts)

    def read_until(self, end: bytes) -> bytes:
        """Everything up to and with `end`."""
        text = b""
        while not text.endswith(end):
            part = self.sock.recv(65536)
            assert part, f"the connection ended after {text!r}"
            text += part
        return text

    def read_to_end(self) -> bytes:
        return b"".join(iter(lambda: self.sock.recv(65536), b""))

    def reset(self) -> None:
        """Close with RST."""
        self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.sock.close()


@contextlib.contextmanager
def opened(node: str) -> Iterator[int]:
    """The pseudo-terminal, opened as a host does."""
    fd = os.open(node, os.O_RDWR | os.O_NOCTTY)
    try:
        yield fd
    finally:
        os.close(fd)


def read_pty(fd: int, count: int, patience_s: float = PATIENCE_S) -> bytes:
    """`count` bytes, or what came within the patience."""
    import select

    parts = bytearray()
    deadline = time.monotonic() + patience_s
    while len(parts) < count:
        left = deadline - time.monotonic()
        if left <= 0 or not select.select([fd], [], [], left)[0]:
            break
        parts += os.read(fd, count - len(parts))
    return bytes(parts)


def wait_until(condition: Callable[[], bool], patience_s: float = PATIENCE_S) -> None:
    """Poll until it holds; AssertionError if it never does."""
    import threading

    deadline = time.monotonic() + patience_s
    pause = threading.Event()
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        pause.wait(0.002)

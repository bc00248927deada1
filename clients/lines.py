"""Lines: what bytes go through to a unit. A serial port by any pyserial URL, a TCP connection, or one of your own.

A `Line` moves bytes and keeps time, nothing else. All waiting of the library is done in `read` (and in `sleep`, where a
line has it), so a line whose `clock` is not the wall's decides how time passes.
"""

from __future__ import annotations

import contextlib
import os
import select
import socket
import struct
import time
import warnings
from collections.abc import Callable
from typing import Any, Final, Protocol, runtime_checkable

from clients.errors import LineLost

DEFAULT_BAUD: Final = 9600
"""8 data bits, no parity, one stop bit: what every host program of the family uses (host-seen, documented default)."""

CONNECT_TIMEOUT_S: Final = 5.0
_CHUNK: Final = 65536

_KERNEL_WAITS: Final = os.name == "posix"
"""Windows gives the time limits of sockets another form and no error to tell them by."""

_POLL_S: Final = 0.001


@runtime_checkable
class Line(Protocol):
    """What a client needs of a line. It may also have `sleep(seconds)`; without it, waiting is reading."""

    @property
    def name(self) -> str:
        """For messages: the URL or port."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of `data`; OSError if the line is gone."""
        ...

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, waiting at most so long for the first byte; b"" if nothing came.

        OSError if the line is gone.
        """
        ...

    def close(self) -> None:
        """Let go of the line; the unit goes on by itself."""
        ...

    def clock(self) -> float:
        """Seconds on the clock that `read` waits by."""
        ...


class _RealLine:
    """Lines of the wall's time."""

    def __init__(self, name: str) -> None:
        self.name = name

    clock: Callable[[], float] = staticmethod(time.monotonic)
    sleep: Callable[[float], None] = staticmethod(time.sleep)


class TcpLine(_RealLine):
    """A raw TCP connection: `tcp://host:port`."""

    def __init__(self, host: str, port: int, *, connect_timeout_s: float = CONNECT_TIMEOUT_S) -> None:
        super().__init__(f"tcp://{host}:{port}")
        self._socket = socket.create_connection((host, port), timeout=connect_timeout_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._timeout_s = connect_timeout_s
        if _KERNEL_WAITS:
            # The system's own time limits save a poll before each send and receive, half the cost of an exchange.
            self._socket.setblocking(True)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, _timeval(connect_timeout_s))
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, _timeval(connect_timeout_s))

    def write(self, data: bytes) -> None:
        """OSError also if the other side takes nothing for so long that it must be dead."""
        self._socket.sendall(data)

    def read(self, timeout_s: float) -> bytes:
        if timeout_s <= 0 and not select.select([self._socket], [], [], 0)[0]:
            return b""
        if timeout_s > 0 and timeout_s != self._timeout_s:
            self._limit(timeout_s)
        try:
            data = self._socket.recv(_CHUNK)
        except (BlockingIOError, TimeoutError):
            return b""
        if not data:
            raise ConnectionResetError("the other side closed the connection")
        return data

    def close(self) -> None:
        self._socket.close()

    def _limit(self, timeout_s: float) -> None:
        self._timeout_s = timeout_s
        if _KERNEL_WAITS:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, _timeval(timeout_s))
        else:
            self._socket.settimeout(timeout_s)


def _timeval(seconds: float) -> bytes:
    """A C `struct timeval`; never zero, which would mean no limit."""
    whole, part = divmod(max(1, round(seconds * 1e6)), 1_000_000)
    return struct.pack("@ll", whole, part)


class SerialLine(_RealLine):
    """A serial port by any URL pyserial knows: `/dev/ttyUSB0`, `COM3`, `socket://host:port`, `loop://` ..."""

    def __init__(self, url: str, *, baud: int = DEFAULT_BAUD) -> None:
        import serial

        super().__init__(url)
        self._port = serial.serial_for_url(url, baudrate=baud, timeout=0, write_timeout=CONNECT_TIMEOUT_S)

    def write(self, data: bytes) -> None:
        self._port.write(data)

    def read(self, timeout_s: float) -> bytes:
        waiting: int = self._port.in_waiting
        if waiting:
            return bytes(self._port.read(waiting))
        if timeout_s <= 0:
            return b""
        if timeout_s != self._port.timeout:
            self._port.timeout = timeout_s
        first: bytes = self._port.read(1)
        rest: bytes = self._port.read(self._port.in_waiting) if first else b""
        return first + rest

    def close(self) -> None:
        _close_port(self._port)


class Rfc2217Line(_RealLine):
    """A serial port behind RFC 2217.

    pyserial's client sets the port up again, a tenth of a second each, whenever its time limit is changed; so none
    is set and waiting is done here. It takes no limit for writing.
    """

    def __init__(self, url: str, *, baud: int = DEFAULT_BAUD) -> None:
        import serial

        super().__init__(url)
        with warnings.catch_warnings():
            # pyserial 3.5 names its thread in a way that Python 3.10 began to discourage.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._port = serial.serial_for_url(url, baudrate=baud, timeout=None)

    def write(self, data: bytes) -> None:
        self._port.write(data)

    def read(self, timeout_s: float) -> bytes:
        deadline = time.monotonic() + timeout_s
        while not (waiting := self._port.in_waiting) and time.monotonic() < deadline:
            time.sleep(_POLL_S)
        data: bytes = self._port.read(waiting)
        if waiting and not data:
            raise ConnectionResetError("the other side closed the connection")
        return data

    def close(self) -> None:
        _close_port(self._port)


def _close_port(port: Any) -> None:
    """Close a port of pyserial's, whose network ports leave their socket open when the other side has gone."""
    connection = getattr(port, "_socket", None)
    port.close()
    if connection is not None:
        connection.close()


def open_line(url: str, *, baud: int = DEFAULT_BAUD) -> Line:
    """The line of a URL: `tcp://host:port`, `rfc2217://host:port`, or whatever pyserial opens.

    `baud` is for serial ports (8N1). Raises LineLost if the port cannot be opened, ValueError if the URL is not
    understood.
    """
    try:
        if url.startswith("tcp://"):
            host, port = tcp_address(url)
            return TcpLine(host, port)
        return Rfc2217Line(url, baud=baud) if url.startswith("rfc2217://") else SerialLine(url, baud=baud)
    except OSError as error:
        raise LineLost(url, error) from error


def tcp_address(url: str) -> tuple[str, int]:
    """Host and port of `tcp://host:port`; ValueError if it is not that."""
    host, colon, port = url.removeprefix("tcp://").rpartition(":")
    if not (host and colon and port.isdigit()):
        raise ValueError(f"{url!r} is not tcp://host:port")
    return host.strip("[]"), int(port)


def close_quietly(line: Line) -> None:
    """Close a line that may be gone already."""
    with contextlib.suppress(OSError):
        line.close()

"""A small blocking client for a unit on a line: a serial port, a virtual one, or TCP.

It moves bytes and knows the three prompts, nothing else: what a reply means is the business of `protocol`. Because it
depends on nothing of the emulator it works just as well with a physical unit.

    with LineClient.open("/dev/ttyUSB0", timeout_s=1.0) as unit:
        unit.exchange(b"ECHO0")
        print(unit.exchange(b"1TPE"))        # b"*1TPE+0\\r\\r\\n> "
"""

from __future__ import annotations

import contextlib
import select
import socket
import time
import warnings
from types import TracebackType
from typing import Final, Protocol

DEFAULT_PROMPTS: Final = (b"\r\n> ", b"\r\n? ", b"\r\n- ")
"""ERROK, ERRBAD and ERRDEF as a unit powers up (documented: EPICS README_PC6K, Gemini Command Reference p.116)."""

DEFAULT_BAUD: Final = 9600
"""8 data bits, no parity, one stop bit: what every host program of the family uses."""

_CHUNK: Final = 65536
_POLL_S: Final = 0.001
_DELIMITERS: Final = (b"\r", b"\n", b":")


class UnitTimeout(TimeoutError):
    """The unit did not finish in time; `received` holds what had arrived."""

    def __init__(self, waited_for: str, received: bytes, timeout_s: float) -> None:
        self.received = received
        super().__init__(f"no {waited_for} within {timeout_s:g} s; received {received!r}")


class _Line(Protocol):
    """Something bytes go through; `receive` gives b"" when nothing came within the time."""

    def send(self, data: bytes) -> None: ...
    def receive(self, timeout_s: float) -> bytes: ...
    def close(self) -> None: ...


class _TcpLine:
    """A TCP connection."""

    def __init__(self, host: str, port: int, *, timeout_s: float) -> None:
        self._socket = socket.create_connection((host, port), timeout=timeout_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data: bytes) -> None:
        self._socket.sendall(data)

    def receive(self, timeout_s: float) -> bytes:
        ready, _, _ = select.select([self._socket], [], [], max(0.0, timeout_s))
        if not ready:
            return b""
        data = self._socket.recv(_CHUNK)
        if not data:
            raise ConnectionResetError("the unit closed the connection")
        return data

    def close(self) -> None:
        self._socket.close()


class _SerialLine:
    """A serial port, by any URL pyserial knows."""

    def __init__(self, url: str, *, timeout_s: float) -> None:
        import serial

        self._port = serial.serial_for_url(url, baudrate=DEFAULT_BAUD, timeout=timeout_s, write_timeout=timeout_s)
        self._timeout_s = timeout_s

    def send(self, data: bytes) -> None:
        self._port.write(data)

    def receive(self, timeout_s: float) -> bytes:
        if timeout_s != self._timeout_s:
            self._port.timeout = self._timeout_s = max(0.0, timeout_s)
        first: bytes = self._port.read(1)
        rest: bytes = self._port.read(self._port.in_waiting) if first else b""
        return first + rest

    def close(self) -> None:
        self._port.close()


class _Rfc2217Line:
    """A serial port behind RFC 2217.

    pyserial's client sets the port up again, a tenth of a second each, whenever its time limit is changed; so none
    is set and waiting is done here. It takes no limit for writing.
    """

    def __init__(self, url: str) -> None:
        import serial

        with warnings.catch_warnings():
            # pyserial 3.5 names its thread in a way that Python 3.10 began to discourage.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._port = serial.serial_for_url(url, baudrate=DEFAULT_BAUD, timeout=None)

    def send(self, data: bytes) -> None:
        self._port.write(data)

    def receive(self, timeout_s: float) -> bytes:
        deadline = time.monotonic() + timeout_s
        while not self._port.in_waiting and time.monotonic() < deadline:
            time.sleep(_POLL_S)
        waiting = self._port.in_waiting
        data: bytes = self._port.read(waiting)
        if waiting and not data:
            raise ConnectionResetError("the unit closed the connection")
        return data

    def close(self) -> None:
        self._port.close()


class LineClient:
    """A blocking connection to one unit; not for several threads at once."""

    def __init__(self, line: _Line, *, timeout_s: float, prompts: tuple[bytes, ...] = DEFAULT_PROMPTS) -> None:
        """Talk over `line`; `prompts` are the texts that end an answer (see ERROK, ERRBAD, ERRDEF)."""
        self._line = line
        self._pending = b""
        self.timeout_s = timeout_s
        self.prompts = prompts

    @classmethod
    def open(cls, url: str, *, timeout_s: float = 1.0, prompts: tuple[bytes, ...] = DEFAULT_PROMPTS) -> LineClient:
        """Connect to `url`: `tcp://host:port`, `rfc2217://host:port`, `/dev/ttyUSB0`, `COM3`, or any other URL of
        pyserial's.

        `timeout_s` bounds connecting and every wait for a prompt. Raises OSError (pyserial's SerialException is one)
        if the port cannot be opened, ValueError if the URL is not understood.
        """
        if url.startswith("rfc2217://"):
            return cls(_Rfc2217Line(url), timeout_s=timeout_s, prompts=prompts)
        if not url.startswith("tcp://"):
            return cls(_SerialLine(url, timeout_s=timeout_s), timeout_s=timeout_s, prompts=prompts)
        host, colon, port = url.removeprefix("tcp://").rpartition(":")
        if not (host and colon and port.isdigit()):
            raise ValueError(f"{url!r} is not tcp://host:port")
        line = _TcpLine(host.strip("[]"), int(port), timeout_s=timeout_s)
        return cls(line, timeout_s=timeout_s, prompts=prompts)

    def write(self, data: bytes) -> None:
        """Send `data` as it is, without a delimiter."""
        self._line.send(data)

    def receive(self, timeout_s: float) -> bytes:
        """What arrives next within `timeout_s` seconds, however little; b"" if nothing does."""
        pending, self._pending = self._pending, b""
        return pending or self._line.receive(timeout_s)

    def read_until_prompt(self) -> bytes:
        """Everything up to and including the next prompt; UnitTimeout if none comes within `timeout_s`."""
        received, deadline = b"", time.monotonic() + self.timeout_s
        while not (end := self._prompt_end(received)):
            left = deadline - time.monotonic()
            data = self.receive(left) if left > 0 else b""
            if not data:
                raise UnitTimeout("prompt", received, self.timeout_s)
            received += data
        self._pending = received[end:]
        return received[:end]

    def exchange(self, line: bytes | str) -> bytes:
        """Send one command line (a CR is added if no delimiter ends it) and return its answer, prompt included.

        With ECHO1 the answer begins with the echo. UnitTimeout if no prompt comes, as always below ERRLVL2.
        """
        data = line.encode("ascii") if isinstance(line, str) else line
        self.write(data if data.endswith(_DELIMITERS) else data + b"\r")
        return self.read_until_prompt()

    def read_available(self, quiet_s: float = 0.1) -> bytes:
        """Everything that arrives until the line has been quiet for `quiet_s` seconds; may be b""."""
        received = b""
        while data := self.receive(quiet_s):
            received += data
        return received

    def close(self) -> None:
        """Close the port; the unit goes on by itself."""
        with contextlib.suppress(OSError):
            self._line.close()

    def _prompt_end(self, received: bytes) -> int:
        ends = [at + len(prompt) for prompt in self.prompts if (at := received.find(prompt)) >= 0]
        return min(ends, default=0)

    def __enter__(self) -> LineClient:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

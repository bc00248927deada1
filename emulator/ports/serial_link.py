"""One opening of a serial device, as something the engine thread can wait for.

Where the system gives serial devices descriptors that can be waited for (Linux, macOS), the descriptor is used
directly. Where it does not (Windows, and the network protocols pyserial speaks itself) two threads carry the bytes
between the device and a pair of sockets, and the engine thread waits for its end of the pair. Either way the port
sees the same four operations.
"""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
from typing import Any, Protocol

from emulator.serial_address import SerialAddress

READ_BYTES = 4096
PUMP_PATIENCE_S = 0.2
"""How often a waiting reader thread looks whether it is still wanted (design choice)."""
PUMP_BUFFER_BYTES = 8192
"""Between the threads and the engine: what a host cannot take should wait where it is bounded and seen."""
DRAIN_S = 0.3
"""How long the last answers may take to leave when the port is closed (design choice)."""


class Link(Protocol):
    """An open serial device."""

    def fileno(self) -> int:
        """The descriptor that is readable when there is something to read or the device has gone."""
        ...

    def read(self) -> bytes:
        """One portion. Raises BlockingIOError when there is none; empty, or another OSError: the device has gone."""
        ...

    def write(self, data: bytes) -> int:
        """How many bytes the system took. Raises BlockingIOError when it took none, OSError: the device has gone."""
        ...

    def close(self) -> None: ...


def open_link(address: SerialAddress, *, threaded: bool | None = None) -> Link:
    """Open a device; `threaded` chooses the way, else the system decides.

    Raises:
        OSError: it cannot be opened (pyserial's SerialException is one).
        ValueError: it can, but not with these settings, or the address is none pyserial knows.
    """
    if threaded is None:
        threaded = os.name != "posix" or address.is_url
    try:
        port = _open(address)
        return ThreadedLink(port) if threaded else DirectLink(port)
    except (OSError, ValueError):
        raise
    except Exception as error:
        # A device that goes while it is being opened: termios has an exception of its own, with a number and a text.
        raise OSError(*error.args) from error


class DirectLink:
    """A device whose descriptor can be waited for."""

    def __init__(self, port: Any) -> None:
        self._port = port
        self._fd: int = port.fileno()
        try:
            os.set_blocking(self._fd, False)
            _tell_silence_from_absence(self._fd)
        except Exception:
            port.close()
            raise

    def fileno(self) -> int:
        return self._fd

    def read(self) -> bytes:
        return os.read(self._fd, READ_BYTES)

    def write(self, data: bytes) -> int:
        return os.write(self._fd, data)

    def close(self) -> None:
        """Closing a device with unsent output can take half a minute, so what does not leave soon is dropped."""
        deadline = time.monotonic() + DRAIN_S
        with contextlib.suppress(Exception):
            while self._port.out_waiting and time.monotonic() < deadline:
                threading.Event().wait(0.01)
            self._port.reset_output_buffer()
        with contextlib.suppress(Exception):
            self._port.close()


class ThreadedLink:
    """A device that can only be read and written by waiting: two threads do it, behind a pair of sockets."""

    def __init__(self, port: Any) -> None:
        self._port = port
        self._outer, self._inner = socket.socketpair()
        for end in (self._outer, self._inner):
            end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, PUMP_BUFFER_BYTES)
        self._outer.setblocking(False)
        self._open = True
        self._writer = threading.Thread(target=self._write_on, name="serial writer", daemon=True)
        self._reader = threading.Thread(target=self._read_on, name="serial reader", daemon=True)
        self._writer.start()
        self._reader.start()

    def fileno(self) -> int:
        return self._outer.fileno()

    def read(self) -> bytes:
        return self._outer.recv(READ_BYTES)

    def write(self, data: bytes) -> int:
        return self._outer.send(data)

    def close(self) -> None:
        """The threads see it and end; what they have not written has DRAIN_S to leave."""
        with contextlib.suppress(OSError):
            self._outer.shutdown(socket.SHUT_WR)
        self._writer.join(DRAIN_S)
        self._open = False
        self._outer.close()
        self._reader.join(2 * PUMP_PATIENCE_S)

    def _read_on(self) -> None:
        # pyserial raises many things when a device goes or is closed while it is read, TypeError among them.
        with contextlib.suppress(Exception):
            while self._open:
                data = self._port.read(max(1, min(self._port.in_waiting, READ_BYTES)))
                if data:
                    self._inner.sendall(data)
        self._hang_up()
        self._writer.join(PUMP_PATIENCE_S)
        with contextlib.suppress(Exception):
            self._port.close()
        self._inner.close()

    def _write_on(self) -> None:
        with contextlib.suppress(Exception):
            while data := self._inner.recv(READ_BYTES):
                self._port.write(data)
            return
        self._hang_up()

    def _hang_up(self) -> None:
        with contextlib.suppress(OSError):
            self._inner.shutdown(socket.SHUT_RDWR)


def _open(address: SerialAddress) -> Any:
    import serial

    # XON and XOFF are the unit's own business (XONOFF), so the driver keeps out of it.
    port = serial.serial_for_url(
        address.device,
        do_not_open=True,
        baudrate=address.baud,
        bytesize=address.data_bits,
        parity=address.parity,
        stopbits=address.stop_bits,
        timeout=PUMP_PATIENCE_S,
        xonxoff=False,
    )
    if not address.is_url:
        port.exclusive = True
    port.open()
    return port


def _tell_silence_from_absence(fd: int) -> None:
    """Have an empty read mean that the device has gone, not that nothing was there; a BREAK is a NUL."""
    import termios

    settings = termios.tcgetattr(fd)
    settings[0] &= ~(termios.BRKINT | termios.IXON | termios.IXOFF | termios.IXANY)
    settings[6][termios.VMIN], settings[6][termios.VTIME] = 1, 0
    termios.tcsetattr(fd, termios.TCSANOW, settings)

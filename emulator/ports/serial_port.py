"""A real serial port: a device of this machine with the host on the other end of its cable.

It is one line of the unit for as long as the server runs, however often the device goes (a USB adapter pulled out, a
pair of virtual ports taken down) and comes back. While it is gone, what the unit says on this line is lost, as on a
cable pulled out; complete commands received before are carried out, half a command is forgotten, and a host that comes
back finds motion, settings and the running program as they are. Nothing is ever sent twice.

The channel to the unit stays, only the device behind it changes. The engine thread alone uses the open device; the
event loop closes dead ones and looks for the next, and opens it in a thread of its own, since some drivers take their
time.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import threading
from collections.abc import Callable
from functools import partial

from emulator.channel import Channel
from emulator.logs import event_line
from emulator.pacing import EngineThread
from emulator.ports.errors import PortError
from emulator.ports.outlet import Outlet
from emulator.ports.serial_link import Link, open_link
from emulator.serial_address import SerialAddress

BACKLOG_BYTES = 64 * 1024
"""Unread output kept beside the driver's buffer: the longest listing of a full memory, a minute at 9600 baud
(design choice)."""
FIRST_RETRY_S = 0.1
LONGEST_RETRY_S = 2.0
"""A device that has gone is looked for at intervals that double from the first to the longest (design choice)."""

_log = logging.getLogger("oem6250.port")


class _Connection:
    """One opening of the device, with the sink that writes to it."""

    def __init__(
        self, link: Link, loop: asyncio.AbstractEventLoop, *, name: str, on_broken: Callable[[_Connection], None]
    ) -> None:
        self.link = link
        self.fd = link.fileno()
        self.outlet = Outlet(
            loop, self.fd, link.write, name=name, on_broken=lambda: on_broken(self), limit_bytes=BACKLOG_BYTES
        )


class SerialPort:
    """The port of one `--serial`. Raises PortError if it cannot be opened at the start.

    `threaded` makes the choice that otherwise depends on the system, see `serial_link`.
    """

    def __init__(self, address: SerialAddress, *, threaded: bool | None = None) -> None:
        self.address = address
        self._threaded = threaded
        try:
            self._first: Link | None = open_link(address, threaded=threaded)
        except (OSError, ValueError) as error:
            raise PortError(f"--serial {address.device}: {_reason(error)}") from None
        self._connection: _Connection | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._retry_s = FIRST_RETRY_S
        self._wanted = True
        self.strict_baud: int | None = None
        """The unit's rate, if a port at another one shall carry what such a line would: garbage."""

    @property
    def name(self) -> str:
        """What a person knows it by."""
        return f"{self.address.device} ({self.address.settings})"

    def serve(self, loop: asyncio.AbstractEventLoop, engine: EngineThread, unit_index: int = 0) -> None:
        """Connect it to a unit."""
        assert self._first is not None
        self._loop, self._engine = loop, engine
        self._connection, self._first = self._connect(self._first, loop), None
        self._channel = engine.attach(unit_index, self)

    def stop_accepting(self) -> None:
        """Look for the device no more; if it is there it stays connected."""
        self._wanted = False

    def close(self) -> None:
        """Close everything. The engine thread must have ended, or never have begun."""
        self.stop_accepting()
        self._loop = None
        connection, self._connection = self._connection, None
        first, self._first = self._first, None
        if connection is not None:
            connection.outlet.close()
            connection.link.close()
        if first is not None:
            first.close()

    # Engine thread.

    @property
    def descriptors(self) -> tuple[int, ...]:
        """The open device; none while it is gone."""
        return () if self._connection is None else (self._connection.fd,)

    def send(self, data: bytes) -> None:
        """To the device, if it is there."""
        if self._connection is not None:
            self._connection.outlet.send(self._as_heard(data, outward=True))

    def arrived(self, channel: Channel) -> None:
        connection = self._connection
        if connection is None:
            return
        try:
            data = connection.link.read()
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            data = b""
        if data:
            self._take(self._as_heard(data, outward=False), channel)
        else:
            self._unplug(connection)

    def _take(self, data: bytes, channel: Channel) -> None:
        if data:
            channel.waiting.append(data)

    def _as_heard(self, data: bytes, *, outward: bool) -> bytes:
        """What arrives of characters between the unit's rate and the port's."""
        unit, port = self.strict_baud, self.address.baud
        if unit is None or unit == port:
            return data
        from emulator.ports.baud import garbled

        return garbled(data, sent_at=unit, read_at=port) if outward else garbled(data, sent_at=port, read_at=unit)

    def _unplug(self, connection: _Connection) -> None:
        """The device has gone, as a read or a write has shown, or both."""
        if self._connection is not connection:
            return
        self._engine.unplug(self._channel)
        self._connection = None
        self._soon(partial(self._gone, connection))

    def _plug(self, connection: _Connection) -> None:
        self._connection = connection
        self._engine.replug(self._channel)

    def _soon(self, function: Callable[[], None]) -> None:
        loop = self._loop
        with contextlib.suppress(RuntimeError):
            if loop is not None:
                loop.call_soon_threadsafe(function)

    # Event loop.

    def _connect(self, link: Link, loop: asyncio.AbstractEventLoop) -> _Connection:
        return _Connection(link, loop, name=f"serial:{self.address.device}", on_broken=self._broken)

    def _broken(self, connection: _Connection) -> None:
        self._engine.put(self._channel, partial(self._unplug, connection))

    def _gone(self, connection: _Connection) -> None:
        connection.outlet.close()
        threading.Thread(target=connection.link.close, name="serial close", daemon=True).start()
        _log.warning(event_line("serial port gone, waiting for it", port=self.address.device))
        self._retry_s = FIRST_RETRY_S
        self._try_later()

    def _try_later(self) -> None:
        if self._loop is not None and self._wanted:
            self._loop.call_later(self._retry_s, self._try_now)
            self._retry_s = min(2 * self._retry_s, LONGEST_RETRY_S)

    def _try_now(self) -> None:
        if self._loop is not None and self._wanted:
            threading.Thread(target=self._open, args=(self._loop,), name="serial open", daemon=True).start()

    def _open(self, loop: asyncio.AbstractEventLoop) -> None:
        """On a thread of its own."""
        try:
            link = open_link(self.address, threaded=self._threaded)
        except (OSError, ValueError) as error:
            _log.debug(event_line("serial port still gone", port=self.address.device, reason=_reason(error)))
            self._soon(self._try_later)
            return
        try:
            loop.call_soon_threadsafe(self._opened, link)
        except RuntimeError:
            link.close()

    def _opened(self, link: Link) -> None:
        if self._loop is None or not self._wanted:
            link.close()
            return
        _log.warning(event_line("serial port back", port=self.address.device))
        self._engine.put(self._channel, partial(self._plug, self._connect(link, self._loop)))


_REASONS = {
    errno.ENOENT: "there is no such device",
    errno.ENODEV: "there is no such device",
    errno.ENXIO: "there is no such device",
    errno.EACCES: "you may not open it (on Linux its group, often dialout, may)",
    errno.EPERM: "you may not open it (on Linux its group, often dialout, may)",
    errno.EBUSY: "another program has it open",
    errno.EAGAIN: "another program has it open",
    errno.ENOTTY: "it is not a serial port",
}


def _reason(error: OSError | ValueError) -> str:
    """What went wrong, in one line."""
    known = _REASONS.get(error.errno or 0) if isinstance(error, OSError) else None
    return known or " ".join(str(error).split())

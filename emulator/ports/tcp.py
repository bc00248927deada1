"""TCP: any number of listeners and connections, all to one unit; a byte stream, or telnet if the client speaks it.

A raw client gets no greeting and not one byte that the unit did not send. A client whose stream holds a telnet command
is a telnet client from there on (`telnet_session`), an RFC 2217 client if it negotiates that. A listener made with
`negotiate` takes every client for a telnet client and speaks first.

Replies go to the connection whose bytes caused them. A client that only shuts down its sending side (`nc -N`, a shell
pipe) still gets all its answers; the connection is closed when its commands are done. Connections are raw non-blocking
sockets rather than asyncio transports, because the engine thread reads and writes them itself (see `emulator.pacing`).
"""

from __future__ import annotations

import asyncio
import errno
import logging
import socket
from collections.abc import Callable
from functools import partial

from emulator.channel import Channel
from emulator.logs import event_line
from emulator.pacing import EngineThread
from emulator.ports.listeners import address_text, bind_all, is_remote
from emulator.ports.outlet import Outlet
from emulator.ports.telnet import Recognizer
from emulator.ports.telnet_session import TelnetSession

READ_BYTES = 4096
TELNET_READ_BYTES = 512
"""Telnet is read in smaller portions: a portion of nothing but RFC 2217 requests must not hold up the others."""
ACCEPTS_PER_WAKE = 64
RETRY_ACCEPT_S = 0.5
FLUSH_S = 5.0
"""How long a half-closed connection may take to read its last answers (design choice)."""
KEEPALIVE = (("TCP_KEEPIDLE", 30), ("TCP_KEEPINTVL", 10), ("TCP_KEEPCNT", 3))
"""A host that vanished without a word is noticed within a minute (design choice)."""

IAC = b"\xff"
_OUT_OF_DESCRIPTORS = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
_log = logging.getLogger("oem6250.port")


class TcpPort:
    """The listeners of one `--tcp` or `--telnet HOST:PORT`; making one binds, `serve` accepts, `close` ends everything.

    `negotiate`: speak telnet first, to every client. `allow_remote`: addresses other than loopback are allowed.
    Raises PortError.
    """

    def __init__(self, host: str, port: int, *, negotiate: bool = False, allow_remote: bool = False) -> None:
        option = "--telnet" if negotiate else "--tcp"
        self._listeners = bind_all(host, port, option=option, allow_remote=allow_remote)
        self._connections: set[_Connection] = set()
        self.negotiate = negotiate
        self.strict_baud: int | None = None
        """The unit's rate, if RFC 2217 clients at another rate shall not understand it; set before `serve`."""

    @property
    def addresses(self) -> list[str]:
        """Where it listens, as `HOST:PORT` with the real port number."""
        return [address_text(listener.getsockname()) for listener in self._listeners]

    @property
    def remote_addresses(self) -> list[str]:
        """Those of `addresses` that other machines may reach."""
        names = [listener.getsockname() for listener in self._listeners]
        return [address_text(name) for name in names if is_remote(name[0])]

    def serve(self, loop: asyncio.AbstractEventLoop, engine: EngineThread, unit_index: int = 0) -> None:
        """Accept connections for a unit from now on (those made since binding wait in the backlog)."""
        self.loop, self.engine, self.unit_index = loop, engine, unit_index
        for listener in self._listeners:
            loop.add_reader(listener.fileno(), self._accept, listener)

    def stop_accepting(self) -> None:
        """Close the listeners; connections stay."""
        for listener in self._listeners:
            if hasattr(self, "loop"):
                self.loop.remove_reader(listener.fileno())
            listener.close()
        self._listeners = []

    def close(self) -> None:
        """Close everything. The engine thread must have ended, or never have begun."""
        self.stop_accepting()
        for connection in list(self._connections):
            connection.close()

    def _accept(self, listener: socket.socket) -> None:
        for _ in range(ACCEPTS_PER_WAKE):
            try:
                sock, address = listener.accept()
            except (BlockingIOError, InterruptedError, ConnectionAbortedError):
                return
            except OSError as error:
                self._accept_later(listener, error)
                return
            self._connections.add(_Connection(sock, address_text(address), self, self._gone))

    def _accept_later(self, listener: socket.socket, error: OSError) -> None:
        """Out of descriptors: leave the others alone and try again shortly."""
        if error.errno not in _OUT_OF_DESCRIPTORS:
            return
        _log.warning(event_line("cannot accept a connection", error=error.strerror))
        self.loop.remove_reader(listener.fileno())
        self.loop.call_later(RETRY_ACCEPT_S, self._accept_again, listener)

    def _accept_again(self, listener: socket.socket) -> None:
        if listener in self._listeners:
            self.loop.add_reader(listener.fileno(), self._accept, listener)

    def _gone(self, connection: _Connection) -> None:
        self._connections.discard(connection)


class _Connection:
    """One accepted socket. It ends in three steps: reading ends, the engine thread lets go, the socket is closed."""

    def __init__(self, sock: socket.socket, peer: str, port: TcpPort, on_closed: Callable[[_Connection], None]) -> None:
        _set_options(sock)
        self._sock, self._loop, self._engine, self._on_closed = sock, port.loop, port.engine, on_closed
        self._name = f"{'telnet' if port.negotiate else 'tcp'}:{peer}"
        self._strict_baud = port.strict_baud
        self._outlet = Outlet(self._loop, sock.fileno(), sock.send, name=self._name, on_broken=self._broken)
        self.descriptors = (sock.fileno(),)
        self.send = self._outlet.send
        self._recognizer = Recognizer()
        self._telnet: TelnetSession | None = None
        self._read_bytes = READ_BYTES
        if port.negotiate:
            self._begin_telnet()
        self._channel = self._engine.attach(port.unit_index, self)
        _log.info(event_line("connected", port=self._name, channel=self._channel.number))

    # Engine thread.

    def arrived(self, channel: Channel) -> None:
        try:
            data = self._sock.recv(self._read_bytes)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            self._engine.lose(channel, partial(self._soon, self.close))
            return
        if not data:
            self._queue(channel, self._recognizer.flush())
            self._engine.finish(channel, partial(self._soon, self._flush))
        elif self._telnet is not None:
            self._queue(channel, self._telnet.receive(data))
        elif IAC in data or self._recognizer.undecided:
            self._look_for_telnet(channel, data)
        else:
            channel.waiting.append(data)

    def _look_for_telnet(self, channel: Channel, data: bytes) -> None:
        raw, telnet = self._recognizer.feed(data)
        self._queue(channel, raw)
        if telnet:
            self._queue(channel, self._begin_telnet().receive(telnet))

    def _begin_telnet(self) -> TelnetSession:
        _log.info(event_line("telnet", port=self._name))
        self._telnet = TelnetSession(self._outlet.send, name=self._name, strict_baud=self._strict_baud)
        self.send = self._telnet.send
        self._read_bytes = TELNET_READ_BYTES
        self._telnet.open()
        return self._telnet

    def _queue(self, channel: Channel, data: bytes) -> None:
        if data:
            channel.waiting.append(data)

    def _soon(self, function: Callable[[], None]) -> None:
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(function)

    # Event loop.

    def close(self) -> None:
        """Close the socket; only when the engine thread will not touch it any more."""
        if self._sock.fileno() < 0:
            return
        self._outlet.close()
        self._sock.close()
        self._on_closed(self)
        _log.info(event_line("disconnected", port=self._name, channel=self._channel.number))

    def _broken(self) -> None:
        """A write failed: nothing more can be said, but what the host said holds."""
        self._engine.drop(self._channel, partial(self._soon, self.close))

    def _flush(self) -> None:
        """The last answers may still be waiting for the host to read them."""
        self._loop.call_later(FLUSH_S, self.close)
        self._outlet.when_empty(self.close)


def _set_options(sock: socket.socket) -> None:
    sock.setblocking(False)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    # Telnet clients send a data mark out of band; without this its byte would be missing from the stream.
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_OOBINLINE, 1)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in KEEPALIVE:
        if hasattr(socket, name):
            sock.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)

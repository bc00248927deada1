"""TCP: any number of listeners and connections, all to one unit; a plain byte stream without greeting.

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
from emulator.ports.errors import PortError
from emulator.ports.outlet import Outlet

READ_BYTES = 4096
BACKLOG = 512
ACCEPTS_PER_WAKE = 64
RETRY_ACCEPT_S = 0.5
FLUSH_S = 5.0
"""How long a half-closed connection may take to read its last answers (design choice)."""
KEEPALIVE = (("TCP_KEEPIDLE", 30), ("TCP_KEEPINTVL", 10), ("TCP_KEEPCNT", 3))
"""A host that vanished without a word is noticed within a minute (design choice)."""

_OUT_OF_DESCRIPTORS = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)
_log = logging.getLogger("oem6250.port")


def address_text(address: tuple[str, int] | tuple[str, int, int, int]) -> str:
    """`127.0.0.1:6250`, `[::1]:6250`."""
    host, port = address[0], address[1]
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


class TcpPort:
    """The listeners of one `--tcp HOST:PORT`; `open` binds, `serve` begins to accept, `close` ends everything."""

    def __init__(self, host: str, port: int) -> None:
        self._listeners = _bind_all(host, port)
        self._connections: set[_Connection] = set()

    @property
    def addresses(self) -> list[str]:
        """Where it listens, as `HOST:PORT` with the real port number."""
        return [address_text(listener.getsockname()) for listener in self._listeners]

    def serve(self, loop: asyncio.AbstractEventLoop, engine: EngineThread, unit_index: int = 0) -> None:
        """Accept connections for a unit from now on (those made since binding wait in the backlog)."""
        self._loop, self._engine, self._unit_index = loop, engine, unit_index
        for listener in self._listeners:
            loop.add_reader(listener.fileno(), self._accept, listener)

    def stop_accepting(self) -> None:
        """Close the listeners; connections stay."""
        for listener in self._listeners:
            if hasattr(self, "_loop"):
                self._loop.remove_reader(listener.fileno())
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
            self._connections.add(
                _Connection(sock, address_text(address), self._loop, self._engine, self._unit_index, self._gone)
            )

    def _accept_later(self, listener: socket.socket, error: OSError) -> None:
        """Out of descriptors: leave the others alone and try again shortly."""
        if error.errno not in _OUT_OF_DESCRIPTORS:
            return
        _log.warning(event_line("cannot accept a connection", error=error.strerror))
        self._loop.remove_reader(listener.fileno())
        self._loop.call_later(RETRY_ACCEPT_S, self._accept_again, listener)

    def _accept_again(self, listener: socket.socket) -> None:
        if listener in self._listeners:
            self._loop.add_reader(listener.fileno(), self._accept, listener)

    def _gone(self, connection: _Connection) -> None:
        self._connections.discard(connection)


class _Connection:
    """One accepted socket. It ends in three steps: reading ends, the engine thread lets go, the socket is closed."""

    def __init__(
        self,
        sock: socket.socket,
        peer: str,
        loop: asyncio.AbstractEventLoop,
        engine: EngineThread,
        unit_index: int,
        on_closed: Callable[[_Connection], None],
    ) -> None:
        _set_options(sock)
        self._sock, self._loop, self._engine, self._on_closed = sock, loop, engine, on_closed
        self._name = f"tcp:{peer}"
        self._outlet = Outlet(loop, sock.fileno(), sock.send, name=self._name, on_broken=self._broken)
        self.descriptors = (sock.fileno(),)
        self.send = self._outlet.send
        self._channel = engine.attach(unit_index, self)
        _log.info(event_line("connected", port=self._name, channel=self._channel.number))

    # Engine thread.

    def arrived(self, channel: Channel) -> None:
        try:
            data = self._sock.recv(READ_BYTES)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            self._engine.lose(channel, partial(self._soon, self.close))
            return
        if data:
            channel.waiting.append(data)
        else:
            self._engine.finish(channel, partial(self._soon, self._flush))

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
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in KEEPALIVE:
        if hasattr(socket, name):
            sock.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)


def _bind_all(host: str, port: int) -> list[socket.socket]:
    """Listeners on every address of `host` ("" is every interface), all with the same port number."""
    try:
        infos = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        raise PortError(f"--tcp {host}:{port}: no such address ({getattr(error, 'strerror', None) or error})") from None
    listeners: list[socket.socket] = []
    try:
        for family, address in dict.fromkeys((info[0], info[4]) for info in infos):
            number = listeners[0].getsockname()[1] if listeners else port
            listeners.append(_bind(family, (address[0], number, *address[2:])))
    except OSError as error:
        for listener in listeners:
            listener.close()
        raise PortError(f"--tcp {host}:{port}: {_reason(error)}") from None
    return listeners


def _bind(family: int, address: tuple[object, ...]) -> socket.socket:
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        listener.setblocking(False)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            listener.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        listener.bind(address)
        listener.listen(BACKLOG)
    except OSError:
        listener.close()
        raise
    return listener


def _reason(error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return "the port is in use (is another emulator running? port 0 picks a free one)"
    return error.strerror or str(error)

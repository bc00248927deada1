"""Listening sockets: every address of a host name, and the rule that strangers are let in only on request.

The protocol has no password: whoever reaches the port commands the unit. So addresses other than loopback need
`--allow-remote`.
"""

from __future__ import annotations

import errno
import ipaddress
import socket

from emulator.ports.errors import PortError

BACKLOG = 512


def address_text(address: tuple[str, int] | tuple[str, int, int, int]) -> str:
    """`127.0.0.1:6250`, `[::1]:6250`."""
    host, port = address[0], address[1]
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def bind_all(host: str, port: int, *, option: str, allow_remote: bool) -> list[socket.socket]:
    """Listeners on every address of `host` ("" is every interface), all with the same port number.

    Raises PortError, beginning with the command line's `option`, if one cannot be had or is open to others unasked.
    """
    where = f"{option} {host}:{port}"
    try:
        infos = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        raise PortError(f"{where}: no such address ({getattr(error, 'strerror', None) or error})") from None
    addresses = dict.fromkeys((info[0], info[4]) for info in infos)
    if not allow_remote and any(is_remote(str(address[0])) for _, address in addresses):
        raise PortError(f"{where}: other machines could reach it; add --allow-remote if they should")
    listeners: list[socket.socket] = []
    try:
        for family, address in addresses:
            number = listeners[0].getsockname()[1] if listeners else port
            listeners.append(_bind(family, (address[0], number, *address[2:])))
    except OSError as error:
        for listener in listeners:
            listener.close()
        raise PortError(f"{where}: {_reason(error)}") from None
    return listeners


def is_remote(host: str) -> bool:
    """Whether a numeric address is one that other machines may reach."""
    return not ipaddress.ip_address(host).is_loopback


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

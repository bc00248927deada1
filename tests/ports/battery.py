"""The wire under stress: what any emulator behind these ports must survive, whatever it speaks.

Each function takes a running server and the dialect of its controller, so that the same battery runs on the toy and
on the real unit.
"""

from __future__ import annotations

import socket
import threading
import time
from dataclasses import dataclass

from tests.ports.served import Host, Served, wait_until

MEGABYTE = 1024 * 1024
GROWTH_BYTES = 12 * MEGABYTE
"""Allocators keep some; a leak of 200 bytes a request would show as 14 MB after 70,000."""


@dataclass(frozen=True)
class Dialect:
    """How to talk to the controller: what to send once on each connection, a question and its whole answer."""

    question: bytes = b"1TPE\r"
    answer: bytes = b"*1TPE\r\n> "
    setup: bytes = b""
    setup_answer: bytes = b""

    def start(self, served: Served) -> Host:
        """A connection that is set up."""
        host = served.connect()
        assert host.ask(self.setup, len(self.setup_answer)) == self.setup_answer
        return host

    def check(self, host: Host) -> None:
        """One question is answered rightly."""
        assert host.ask(self.question, len(self.answer)) == self.answer


def split_request(served: Served, dialect: Dialect) -> None:
    """A request whose halves come in two packets, with traffic of another connection between them."""
    with dialect.start(served) as host, dialect.start(served) as other:
        for cut in range(1, len(dialect.question)):
            host.sock.sendall(dialect.question[:cut])
            dialect.check(other)
            assert host.ask(dialect.question[cut:], len(dialect.answer)) == dialect.answer


def several_in_one_packet(served: Served, dialect: Dialect) -> None:
    with dialect.start(served) as host:
        assert host.ask(dialect.question * 8, 8 * len(dialect.answer)) == dialect.answer * 8


def byte_by_byte(served: Served, dialect: Dialect) -> None:
    with dialect.start(served) as host:
        for byte in dialect.question * 3:
            host.sock.sendall(bytes([byte]))
        assert host.read(3 * len(dialect.answer)) == dialect.answer * 3


def no_terminator(served: Served, dialect: Dialect, megabytes: int = 16) -> None:
    """Megabytes without a terminator: memory stays, and others are served meanwhile and afterwards."""
    with dialect.start(served) as host, dialect.start(served) as other:
        before = served.resident_bytes()
        for _ in range(megabytes):
            host.sock.sendall(b"A" * MEGABYTE)
            dialect.check(other)
            assert served.resident_bytes() - before < GROWTH_BYTES


def connects_and_disconnects(served: Served, dialect: Dialect, count: int = 2000) -> None:
    """Descriptors and memory are the same after many short connections, some of them with a question."""
    dialect.start(served).sock.close()
    wait_until(lambda: served.descriptors() > 0)
    with dialect.start(served) as host:
        dialect.check(host)
        descriptors, resident = served.descriptors(), served.resident_bytes()
        for number in range(count):
            with served.connect() as visitor:
                if number % 10 == 0:
                    visitor.sock.sendall(dialect.question)
        dialect.check(host)
        wait_until(lambda: served.descriptors() <= descriptors)
        assert served.resident_bytes() - resident < GROWTH_BYTES


def reset_in_mid_command(served: Served, dialect: Dialect) -> None:
    """A connection reset in the middle of a command disturbs nobody, and the half does not stick to the next one."""
    for cut in range(1, len(dialect.question)):
        host = dialect.start(served)
        host.sock.sendall(dialect.question + dialect.question[:cut])
        host.reset()
    with dialect.start(served) as host:
        dialect.check(host)


def half_closed(served: Served, dialect: Dialect, count: int = 200) -> None:
    """A client that only shuts down its sending side gets every answer, then the end."""
    with dialect.start(served) as host:
        host.sock.sendall(dialect.question * count)
        host.sock.shutdown(socket.SHUT_WR)
        assert host.read_to_end() == dialect.answer * count


def never_reading(served: Served, dialect: Dialect, seconds: float = 2.0) -> None:
    """A client sends as fast as it can and never reads: others are served promptly, memory is bounded."""
    with dialect.start(served) as greedy, dialect.start(served) as other:
        dialect.check(other)
        before = served.resident_bytes()
        stop = threading.Event()
        sender = threading.Thread(target=_flood, args=(greedy, dialect.question * 1000, stop))
        sender.start()
        try:
            slowest_s = _ask_for(other, dialect, seconds)
        finally:
            stop.set()
            greedy.sock.shutdown(socket.SHUT_RDWR)
            sender.join()
        assert slowest_s < 0.5
        assert served.resident_bytes() - before < GROWTH_BYTES
    with dialect.start(served) as host:
        dialect.check(host)


def many_clients(served: Served, dialect: Dialect, count: int = 200) -> None:
    """All are connected at once, all ask at once, and each gets its own answer."""
    hosts = [dialect.start(served) for _ in range(count)]
    try:
        for _ in range(3):
            for host in hosts:
                host.sock.sendall(dialect.question)
            for host in hosts:
                assert host.read(len(dialect.answer)) == dialect.answer
    finally:
        for host in hosts:
            host.sock.close()


def many_requests(served: Served, dialect: Dialect, count: int = 70_000, batch: int = 100) -> None:
    """Many requests on one connection leave nothing behind."""
    with dialect.start(served) as host:
        _ask_in_batches(host, dialect, 5000, batch)
        before = served.resident_bytes()
        _ask_in_batches(host, dialect, count - 5000, batch)
        assert served.resident_bytes() - before < GROWTH_BYTES // 3


ALL = (
    split_request,
    several_in_one_packet,
    byte_by_byte,
    no_terminator,
    connects_and_disconnects,
    reset_in_mid_command,
    half_closed,
    never_reading,
    many_clients,
    many_requests,
)


def _ask_in_batches(host: Host, dialect: Dialect, count: int, batch: int) -> None:
    for _ in range(count // batch):
        assert host.ask(dialect.question * batch, len(dialect.answer) * batch) == dialect.answer * batch


def _flood(host: Host, data: bytes, stop: threading.Event) -> None:
    while not stop.is_set():
        try:
            host.sock.sendall(data)
        except OSError:
            return


def _ask_for(host: Host, dialect: Dialect, seconds: float) -> float:
    """Ask again and again; the slowest answer in seconds."""
    slowest_s = 0.0
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        began = time.monotonic()
        dialect.check(host)
        slowest_s = max(slowest_s, time.monotonic() - began)
    return slowest_s

"""Two writers and one descriptor: order, bound, and what is void."""

from __future__ import annotations

import asyncio
import random
import socket
import threading
from collections.abc import Iterator

import pytest

from emulator.ports.outlet import Outlet
from tests.ports.served import wait_until

LIMIT = 20_000


class Bench:
    """An outlet into a socket with little room, an event loop on a thread of its own; the test is the engine thread."""

    def __init__(self) -> None:
        self.ours, self.theirs = socket.socketpair()
        self.ours.setblocking(False)
        self.ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
        self.theirs.settimeout(10)
        self.loop = asyncio.SelectorEventLoop()
        self.thread = threading.Thread(target=self.loop.run_forever)
        self.thread.start()
        self.broken = threading.Event()
        self.outlet = Outlet(
            self.loop, self.ours.fileno(), self.ours.send, name="test", on_broken=self.broken.set, limit_bytes=LIMIT
        )

    def on_loop(self) -> None:
        """All that the loop was asked to do before has been done."""
        passed = threading.Event()
        self.loop.call_soon_threadsafe(passed.set)
        assert passed.wait(10)

    def read(self, count: int) -> bytes:
        parts = b""
        while len(parts) < count:
            parts += self.theirs.recv(min(1000, count - len(parts)))
        return parts

    def read_all_there_is(self) -> bytes:
        """Until nothing comes although the loop has had its chance."""
        self.theirs.settimeout(0.2)
        parts = b""
        try:
            while True:
                parts += self.theirs.recv(65536)
        except TimeoutError:
            self.theirs.settimeout(10)
        return parts

    def close(self) -> None:
        self.loop.call_soon_threadsafe(self.outlet.close)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()
        self.loop.close()
        self.ours.close()
        self.theirs.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.close()


def test_no_byte_overtakes_another_whoever_writes_it(bench: Bench) -> None:
    """A reader that is now faster, now slower than the writer; replies of all sizes."""
    chance = random.Random(6250)
    sent = 0
    heard = bytearray()
    expected = bytearray()
    while sent < 3000:
        data = b"%d;" % sent * chance.choice((1, 1, 10, 300))
        if bench.outlet.backlog_bytes + len(data) > LIMIT:
            heard += bench.theirs.recv(chance.choice((100, 5000, 100_000)))
            continue
        bench.outlet.send(data)
        expected += data
        sent += 1
    heard += bench.read(len(expected) - len(heard))
    assert heard == expected


def test_what_a_host_does_not_read_is_discarded_whole_beyond_the_bound(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    reply = b"*" + b"x" * 997 + b"\r\n"
    for _ in range(1000):
        bench.outlet.send(reply)
    bench.on_loop()
    heard = bench.read_all_there_is()
    assert heard == reply * (len(heard) // len(reply))
    assert LIMIT - len(reply) < len(heard) < LIMIT + 40_000
    assert [record.getMessage().split(" port=")[0] for record in caplog.records] == [
        'event="host does not read, output discarded"'
    ]


def test_each_episode_has_its_log_line(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    for _ in range(3):
        for _ in range(200):
            bench.outlet.send(b"x" * 1000)
        bench.on_loop()
        bench.read_all_there_is()
        bench.on_loop()
    assert len(caplog.records) == 3


def test_a_void_backlog_is_not_written_and_what_follows_is(bench: Bench) -> None:
    bench.outlet.send(b"a" * 1000)
    while bench.outlet.backlog_bytes == 0:
        bench.outlet.send(b"a" * 1000)
    bench.outlet.send(b"b" * 3000)
    bench.outlet.void_backlog()
    bench.outlet.send(b"c" * 3000)
    heard = bench.read_all_there_is()
    assert heard.endswith(b"c" * 3000)
    assert b"b" not in heard


def test_the_end_waits_for_the_backlog(bench: Bench) -> None:
    data = b"".join(b"%d;" % number for number in range(3000))
    bench.outlet.send(data)
    empty = threading.Event()
    bench.loop.call_soon_threadsafe(bench.outlet.when_empty, empty.set)
    bench.on_loop()
    assert not empty.is_set()
    assert bench.read(len(data)) == data
    assert empty.wait(10)


def test_a_lost_host_is_told_once_and_later_output_goes_nowhere(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    bench.theirs.close()
    bench.outlet.send(b"x")
    assert bench.broken.wait(10)
    for _ in range(100):
        bench.outlet.send(b"x" * 1000)
    wait_until(lambda: not caplog.records)


def test_sending_after_the_loop_has_closed_does_no_harm() -> None:
    bench = Bench()
    bench.outlet.send(b"x" * 15_000)
    bench.close()
    bench.outlet.send(b"x")

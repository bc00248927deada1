"""What a port costs: request and response over TCP, beside a bare asyncio echo server in the same run.

`python -m tests.ports.roundtrip` measures the toy controller; the benchmark uses the functions for the real unit. The
two servers are measured in alternation, because a shared machine changes its speed from one second to the next.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import selectors
import socket
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.queues import Queue
from pathlib import Path
from statistics import median
from typing import NamedTuple

from tests.ports.served import Served

Address = tuple[str, int]


class RoundTrip(NamedTuple):
    """Microseconds from sending a request to having its answer."""

    p50_us: float
    p99_us: float


class _Echo(asyncio.Protocol):
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport

    def data_received(self, data: bytes) -> None:
        self.transport.write(data)


def _serve_echo(told: Queue[Address]) -> None:
    async def serve() -> None:
        server = await asyncio.get_running_loop().create_server(_Echo, "127.0.0.1", 0)
        told.put(server.sockets[0].getsockname())
        await server.serve_forever()

    asyncio.run(serve())


@contextmanager
def bare_echo() -> Iterator[Address]:
    """An asyncio echo server in a process of its own."""
    context = multiprocessing.get_context("spawn")
    told: Queue[Address] = context.Queue()
    process = context.Process(target=_serve_echo, args=(told,), daemon=True)
    process.start()
    try:
        yield told.get(timeout=20)
    finally:
        process.kill()
        process.join()


def round_trip(address: Address, question: bytes, answer_bytes: int, count: int) -> RoundTrip:
    """One client that waits for each answer."""
    with _connect(address) as sock:
        taken = sorted(_ask(sock, question, answer_bytes) for _ in range(count))
    return RoundTrip(taken[count // 2] * 1e6, taken[count * 99 // 100] * 1e6)


def rate(
    address: Address, question: bytes, answer_bytes: int, *, clients: int, seconds: float, depth: int = 1
) -> float:
    """Requests per second of several clients, each with `depth` requests under way."""
    with selectors.DefaultSelector() as selector:
        left = {}
        for _ in range(clients):
            sock = _connect(address)
            selector.register(sock, selectors.EVENT_READ)
            left[sock] = answer_bytes * depth
            sock.sendall(question * depth)
        answered, began = 0, time.perf_counter()
        while time.perf_counter() - began < seconds:
            for key, _ in selector.select(1.0):
                sock = key.fileobj
                assert isinstance(sock, socket.socket)
                left[sock] -= len(sock.recv(65536))
                if left[sock] == 0:
                    answered += depth
                    left[sock] = answer_bytes * depth
                    sock.sendall(question * depth)
        elapsed = time.perf_counter() - began
        for sock in left:
            sock.close()
    return answered / elapsed


def _connect(address: Address) -> socket.socket:
    sock = socket.create_connection(address[:2], timeout=20)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return sock


def _ask(sock: socket.socket, question: bytes, answer_bytes: int) -> float:
    began = time.perf_counter()
    sock.sendall(question)
    got = 0
    while got < answer_bytes:
        got += len(sock.recv(answer_bytes - got))
    return time.perf_counter() - began


def main() -> None:
    question = b"1TPE\r"
    with tempfile.TemporaryDirectory() as directory, bare_echo() as echo:
        announce = Path(directory) / "announce"
        with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=announce) as served:
            pairs = [
                (round_trip(echo, question, 5, 2000), round_trip(served.address, question, 9, 2000)) for _ in range(7)
            ]
            for name, column in (("bare echo", 0), ("toy", 1)):
                p50, p99 = (median(pair[column][field] for pair in pairs) for field in (0, 1))
                print(f"{name:10} one client   p50 {p50:6.0f} us   p99 {p99:6.0f} us")
            print(f"ratio of p50 {median(toy.p50_us / bare.p50_us for bare, toy in pairs):.2f}")
            for depth in (1, 10):
                for name, address, answer_bytes in (("bare echo", echo, 5), ("toy", served.address, 9)):
                    per_s = rate(address, question, answer_bytes, clients=10, seconds=2.0, depth=depth)
                    print(f"{name:10} ten clients, {depth:2} requests under way each   {per_s:8.0f} /s")


if __name__ == "__main__":
    main()

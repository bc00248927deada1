"""The hosts of the benchmark, in a process of their own: `python -m tests.bench.load`.

One line of JSON on stdin is one job, one line on stdout its result. Being apart from both servers and doing next to
nothing per request (bytes encoded beforehand, one selector, no garbage collection) it must not be what is
measured; `cpu_share`, the part of the time it spent computing, tells when it comes near to that.
"""

from __future__ import annotations

import gc
import json
import os
import random
import selectors
import socket
import sys
import time
from collections.abc import Callable
from typing import Any, TypedDict

from tests.bench.figures import percentile

PATIENCE_S = 20.0
RECEIVE_BYTES = 65536
PROMPT = b"\r\n> "
QUIET_S = 0.1
NS_PER_US = 1_000


class Hammering(TypedDict):
    """What came of asking as fast as the answers come."""

    requests_per_s: float
    p50_us: float
    p99_us: float
    cpu_share: float


class Client:
    """One connection with `depth` requests under way, sent in one write; times from that write to the last answer."""

    def __init__(
        self, address: tuple[str, int] | str, question: bytes, answer_bytes: int, depth: int, opening: bytes = b""
    ) -> None:
        self.sock = Terminal(address) if isinstance(address, str) else connect(address)
        if opening:
            negotiate(self.sock, opening)
        self._questions, self._expected = question * depth, answer_bytes * depth
        self._left = 0
        self._sent_ns = 0
        self.taken_ns: list[int] = []

    def ask(self) -> None:
        self._left = self._expected
        self._sent_ns = time.perf_counter_ns()
        self.sock.send(self._questions)

    def take(self) -> bool:
        """Receive what there is; True if that completes the answers."""
        data = receive(self.sock)
        self._left -= len(data)
        if self._left < 0:
            raise RuntimeError(f"more was answered than asked for: {data!r}")
        if self._left:
            return False
        self.taken_ns.append(time.perf_counter_ns() - self._sent_ns)
        return True


class Terminal:
    """A pseudo-terminal with what of a socket is needed here."""

    def __init__(self, path: str) -> None:
        self._fd = os.open(path, os.O_RDWR | os.O_NOCTTY)

    def fileno(self) -> int:
        return self._fd

    def send(self, data: bytes) -> int:
        return os.write(self._fd, data)

    def recv(self, count: int) -> bytes:
        return os.read(self._fd, count)

    def close(self) -> None:
        os.close(self._fd)


Line = socket.socket | Terminal


def negotiate(line: Line, opening: bytes) -> None:
    """Send the first words of a telnet client and wait until all answers are there."""
    line.send(opening)
    with selectors.DefaultSelector() as selector:
        selector.register(line, selectors.EVENT_READ)
        while selector.select(QUIET_S):
            receive(line)


def connect(address: tuple[str, int]) -> socket.socket:
    """A blocking connection without Nagle's delay."""
    sock = socket.create_connection(address, timeout=PATIENCE_S)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return sock


def receive(sock: Line) -> bytes:
    """What has arrived, at least a byte. Raises ConnectionResetError at the end, TimeoutError after PATIENCE_S."""
    data = sock.recv(RECEIVE_BYTES)
    if not data:
        raise ConnectionResetError("the server closed the connection")
    return data


def hammer(
    *,
    address: tuple[str, int] | str,
    question: str,
    answer_bytes: int,
    clients: int,
    depth: int,
    seconds: float,
    opening: str = "",
) -> Hammering:
    """Closed loop: every client asks again as soon as it is answered, for `seconds`.

    `address` is that of a socket or the path of a terminal; `opening` is what a client says before it asks.
    """
    asked, first = question.encode("latin-1"), opening.encode("latin-1")
    crowd = [Client(address, asked, answer_bytes, depth, first) for _ in range(clients)]
    began_ns, began_cpu_ns = time.perf_counter_ns(), time.process_time_ns()
    (_hammer_alone if clients == 1 else _hammer_together)(crowd, began_ns + int(seconds * 1e9))
    elapsed_ns, cpu_ns = time.perf_counter_ns() - began_ns, time.process_time_ns() - began_cpu_ns
    for client in crowd:
        client.sock.close()
    taken_ns = [taken for client in crowd for taken in client.taken_ns]
    return {
        "requests_per_s": len(taken_ns) * depth * 1e9 / elapsed_ns,
        "p50_us": percentile(taken_ns, 50) / NS_PER_US,
        "p99_us": percentile(taken_ns, 99) / NS_PER_US,
        "cpu_share": cpu_ns / elapsed_ns,
    }


def _hammer_alone(crowd: list[Client], until_ns: int) -> None:
    (client,) = crowd
    while time.perf_counter_ns() < until_ns:
        client.ask()
        while not client.take():
            pass


def _hammer_together(crowd: list[Client], until_ns: int) -> None:
    """All answers are waited for in the end, so that the next measurement begins with nothing under way."""
    with selectors.DefaultSelector() as selector:
        for client in crowd:
            selector.register(client.sock, selectors.EVENT_READ, client)
            client.ask()
        waiting = len(crowd)
        while waiting:
            for key, _ in selector.select(PATIENCE_S):
                if key.data.take():
                    if time.perf_counter_ns() < until_ns:
                        key.data.ask()
                    else:
                        waiting -= 1


def poll(
    *, address: tuple[str, int], question: str, seconds: float, interval_s: float = 0.0, seed: int = 6250
) -> list[tuple[int, int, str]]:
    """Ask one question again and again: monotonic ns when sent, when answered, and the answer with its prompt.

    `interval_s` is the mean pause after an answer; pauses vary by half of it, so as not to beat with the servo's grid.
    """
    pauses = random.Random(seed)
    asked = question.encode("latin-1")
    answers = []
    with connect(address) as sock:
        until_ns = time.monotonic_ns() + int(seconds * 1e9)
        while (sent_ns := time.monotonic_ns()) < until_ns:
            sock.send(asked)
            data = receive(sock)
            while not data.endswith(PROMPT):
                data += receive(sock)
            answers.append((sent_ns, time.monotonic_ns(), data.decode("latin-1")))
            if interval_s:
                time.sleep(interval_s * pauses.uniform(0.5, 1.5))  # a host that polls in real time
    return answers


JOBS: dict[str, Callable[..., object]] = {"hammer": hammer, "poll": poll}


def main() -> None:
    gc.disable()
    for line in sys.stdin:
        job: dict[str, Any] = json.loads(line)
        name = job.pop("job")
        if isinstance(job["address"], list):
            job["address"] = tuple(job["address"])
        print(json.dumps(JOBS[name](**job)), flush=True)


if __name__ == "__main__":
    main()

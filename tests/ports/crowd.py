"""A crowd of hosts that come and go, each polling: `python -m tests.ports.crowd [--seconds 600] [--hosts 500]`.

Raw, telnet and RFC 2217 clients connect, ask for a position about once a second for some seconds and leave in one of
the ways hosts leave. Beside them one host never reads what it asks for, and one sends garbage. The unit moves all the
while, since only then it has a tick each millisecond to be late for. Printed is what would show a leak: descriptors,
threads and memory while the crowd is there and after it has gone; and the engine thread's account of its lateness.

The garbage holds no letters, Ctrl-K or XOFF: a host that happens to send `E0` silences the unit for everybody, rightly.
"""

from __future__ import annotations

import argparse
import contextlib
import heapq
import random
import re
import selectors
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from emulator.ports.telnet import COM_PORT, DO, ECHO, IAC, SB, SE, SUPPRESS_GO_AHEAD, WILL
from tests.bench.figures import percentile
from tests.ports.served import REPOSITORY, Served, wait_until

SERVER = (
    sys.executable,
    "-c",
    "import logging, sys; logging.getLogger('oem6250.server').setLevel(logging.INFO);"
    "from emulator.cli import main; sys.exit(main(sys.argv[1:]))",
)
"""The program itself, telling its lateness when it ends."""
MOVING = b"ECHO0\rDRIVE11\rCOMEXC1\rA100,100\rV1,1\rMC11\rGO11\r"
QUESTION, ANSWER_END = b"1TPE\r", b"\n> "
OPENINGS = {
    "raw": b"",
    "telnet": bytes((IAC, DO, SUPPRESS_GO_AHEAD, IAC, WILL, 24, IAC, DO, ECHO)),
    "rfc2217": bytes((IAC, WILL, COM_PORT, IAC, DO, COM_PORT, IAC, SB, COM_PORT, 1, 0, 0, 75, 0, IAC, SE)),
}
WEIGHTS = (70, 20, 10)
POLL_EVERY_S = 1.0
LIFE_S = 10.0
NOISE_EVERY_S = 0.02
NOISE_BYTES = 512
GARBAGE = bytes(byte for byte in range(256) if not chr(byte).isalpha() or byte > 127).translate(None, b"\x0b\x13")
PATIENCE_S = 10.0
_LATENESS = re.compile(r'event="stopped" p50_ns=(\d+) p99_ns=(\d+) max_ns=(\d+) samples=(\d+)')


@dataclass
class Figures:
    """What came of it."""

    hosts: int = 0
    answers: int = 0
    unanswered: int = 0
    slowest_us: list[float] = field(default_factory=list)
    samples: list[tuple[float, int, int, float]] = field(default_factory=list)
    """Seconds, descriptors, threads, resident MB of the server."""
    gone: tuple[int, int, float] = (0, 0, 0.0)
    before: tuple[int, int, float] = (0, 0, 0.0)
    lateness_ms: tuple[float, float, float] = (0.0, 0.0, 0.0)
    bare_p99_ms: float = 0.0
    """99 in 100 waits of a millisecond were shorter, in a process that does nothing else, at the same time."""
    busy: float = 0.0
    """Part of one processor that the server used."""

    def text(self) -> str:
        lines = [
            f"{at:6.0f} s  {fds:5d} descriptors  {threads} threads  {mb:6.1f} MB"
            for at, fds, threads, mb in self.samples
        ]
        p50, p99, worst = self.lateness_ms
        answered = [percentile(self.slowest_us, percent) / 1e3 for percent in (50, 99)] if self.slowest_us else [0, 0]
        return "\n".join(
            [
                *lines,
                f"before  {self.before[0]:5d} descriptors  {self.before[1]} threads  {self.before[2]:6.1f} MB",
                f"after   {self.gone[0]:5d} descriptors  {self.gone[1]} threads  {self.gone[2]:6.1f} MB",
                f"{self.hosts} hosts came and went, {self.answers} answers, {self.unanswered} missing, "
                f"p50 {answered[0]:.2f} ms, p99 {answered[1]:.2f} ms",
                f"lateness of the engine thread p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {worst:.2f} ms "
                f"(bare wait of 1 ms beside it: p99 {self.bare_p99_ms:.2f} ms); {self.busy:.0%} of a processor",
            ]
        )


class Visitor:
    """One polling host."""

    def __init__(self, address: tuple[str, int], kind: str, until_s: float) -> None:
        self.sock = socket.create_connection(address, timeout=PATIENCE_S)
        self.sock.sendall(OPENINGS[kind])
        self.sock.setblocking(False)
        self.until_s = until_s
        self.asked_s: float | None = None
        self._tail = b""

    def ask(self) -> None:
        self.asked_s = time.perf_counter()
        self.sock.send(QUESTION)

    def take(self) -> bool:
        """Receive; whether that answers the question."""
        self._tail = (self._tail + self.sock.recv(65536))[-8:]
        return self.asked_s is not None and self._tail.endswith(ANSWER_END)

    def leave(self, way: int) -> None:
        if way == 0:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        elif way == 1:
            with contextlib.suppress(OSError):
                self.sock.send(b"1TP")
        self.sock.close()


class Crowd:
    """All hosts, on one selector and one queue of things to do, in this thread."""

    def __init__(self, served: Served, hosts: int, seed: int) -> None:
        self._served = served
        self._random = random.Random(seed)
        self._selector = selectors.DefaultSelector()
        self._agenda: list[tuple[float, int, Visitor | None]] = []
        self._order = 0
        self.figures = Figures()
        self._deaf, self._mad, self._keeper = (self._connect() for _ in range(3))
        self._keeper.sendall(MOVING)
        for _ in range(hosts):
            self._welcome(spread_s=LIFE_S)

    def run(self, seconds: float) -> None:
        """Let them poll for so long, then have all of them leave."""
        began_s = time.perf_counter()
        next_sample_s, next_noise_s = began_s, began_s
        while (now_s := time.perf_counter()) < began_s + seconds:
            self._do_what_is_due(now_s)
            if now_s >= next_noise_s:
                next_noise_s = now_s + NOISE_EVERY_S
                self._make_noise()
            if now_s >= next_sample_s:
                next_sample_s += seconds / 8
                self.figures.samples.append((now_s - began_s, *state(self._served)))
            self._receive(0.005)
        for _, _, visitor in self._agenda:
            if visitor is not None:
                self._part_with(visitor)
        for sock in (self._deaf, self._mad, self._keeper):
            sock.close()

    def _connect(self) -> socket.socket:
        sock = socket.create_connection(self._served.address, timeout=PATIENCE_S)
        sock.setblocking(False)
        return sock

    def _welcome(self, *, spread_s: float = POLL_EVERY_S) -> None:
        now_s = time.perf_counter()
        kind = self._random.choices(list(OPENINGS), WEIGHTS)[0]
        visitor = Visitor(self._served.address, kind, now_s + self._random.expovariate(1 / LIFE_S))
        self._selector.register(visitor.sock, selectors.EVENT_READ, visitor)
        self._plan(visitor, now_s + self._random.uniform(0, min(spread_s, POLL_EVERY_S)))
        self.figures.hosts += 1

    def _plan(self, visitor: Visitor, at_s: float) -> None:
        self._order += 1
        heapq.heappush(self._agenda, (at_s, self._order, visitor))

    def _do_what_is_due(self, now_s: float) -> None:
        while self._agenda and self._agenda[0][0] <= now_s:
            visitor = heapq.heappop(self._agenda)[2]
            assert visitor is not None
            if now_s < visitor.until_s:
                if visitor.asked_s is None:
                    visitor.ask()
                self._plan(visitor, now_s + POLL_EVERY_S * self._random.uniform(0.5, 1.5))
            else:
                self._part_with(visitor)
                self._welcome()

    def _part_with(self, visitor: Visitor) -> None:
        if visitor.asked_s is not None and time.perf_counter() - visitor.asked_s > PATIENCE_S / 2:
            self.figures.unanswered += 1
        self._selector.unregister(visitor.sock)
        visitor.leave(self._random.randrange(3))

    def _receive(self, patience_s: float) -> None:
        for key, _ in self._selector.select(patience_s):
            visitor: Visitor = key.data
            if visitor.take():
                assert visitor.asked_s is not None
                self.figures.slowest_us.append((time.perf_counter() - visitor.asked_s) * 1e6)
                self.figures.answers += 1
                visitor.asked_s = None

    def _make_noise(self) -> None:
        """The deaf host asks, the mad one raves, and the axes are kept moving."""
        for sock, data in (
            (self._deaf, QUESTION * (NOISE_BYTES // len(QUESTION))),
            (self._mad, bytes(self._random.choices(GARBAGE, k=NOISE_BYTES))),
            (self._keeper, b"GO11\r" if self._random.random() < NOISE_EVERY_S else b""),
        ):
            with contextlib.suppress(BlockingIOError):
                sock.send(data)
        for sock in (self._mad, self._keeper):
            with contextlib.suppress(BlockingIOError):
                sock.recv(65536)


def state(served: Served) -> tuple[int, int, float]:
    """Descriptors, threads and resident MB of the server."""
    process = psutil.Process(served.process.pid)
    return process.num_fds(), process.num_threads(), process.memory_info().rss / 1e6


def cpu_s(served: Served) -> float:
    """Processor time the server has used."""
    times = psutil.Process(served.process.pid).cpu_times()
    return float(times.user + times.system)


class BareWaits:
    """A process that does nothing but wait a millisecond again and again: what the machine allows."""

    def __init__(self, seconds: float) -> None:
        code = f"from tests.bench.pacing import *; print(percentile(bare_waits_ms({seconds}), 99))"
        self._process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, cwd=REPOSITORY)

    def p99_ms(self) -> float:
        return float(self._process.communicate()[0])


@contextlib.contextmanager
def _server() -> Iterator[Served]:
    with tempfile.TemporaryDirectory() as folder:
        options = ("--tcp", "127.0.0.1:0", "--pty", "none")
        with Served(*options, announce=Path(folder) / "announce", command=SERVER) as served:
            yield served


def hold(*, seconds: float, hosts: int, seed: int = 6250) -> Figures:
    """One crowd at a server of its own."""
    with _server() as served:
        with served.connect() as host:
            host.ask(QUESTION, 4)
        before = state(served)
        began_s, bare = cpu_s(served), BareWaits(seconds)
        try:
            figures = _visit(served, hosts, seconds, seed)
            wait_until(lambda: state(served)[0] <= before[0])
        except (OSError, AssertionError) as error:
            raise AssertionError(f"{error!r}; the server said: {served.stop()[2][-4000:]}") from error
        figures.before, figures.gone = before, state(served)
        figures.bare_p99_ms, figures.busy = bare.p99_ms(), (cpu_s(served) - began_s) / seconds
        status, _, told = served.stop()
    found = _LATENESS.search(told)
    if status != 0 or found is None or "Traceback" in told:
        raise AssertionError(f"the server ended with {status}: {told[-2000:]}")
    p50, p99, worst = (int(text) / 1e6 for text in found.groups()[:3])
    figures.lateness_ms = (p50, p99, worst)
    return figures


def _visit(served: Served, hosts: int, seconds: float, seed: int) -> Figures:
    """Let the crowd come and go. Afterwards the motion is stopped: while a unit moves, up to 64 hosts that have said
    their last word are kept, as an answer may still come."""
    crowd = Crowd(served, hosts, seed)
    crowd.run(seconds)
    with served.connect() as host:
        host.sock.sendall(b"!K\r")
        host.read_until(b"> ")
    return crowd.figures


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.ports.crowd", description="A crowd of hosts at one unit.")
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--hosts", type=int, default=500)
    parser.add_argument("--seed", type=int, default=6250)
    parsed = parser.parse_args()
    print(hold(seconds=parsed.seconds, hosts=parsed.hosts, seed=parsed.seed).text())


if __name__ == "__main__":
    main()

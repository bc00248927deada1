"""A VAR write with --state: from sending it to its prompt, which means that it is on the disk.

Beside it what the disk takes by itself, one append of the size of a commit with fdatasync, and the same write without
--state.
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path
from statistics import median

from tests.bench.figures import Effort, Figure, Reference, percentile
from tests.bench.load import Hammering
from tests.bench.processes import Load, Server, oem6250

QUESTION = b"VAR1=VAR1+1\r"
ANSWER = b"\r\n> "
COMMIT_BYTES = 8240
"""Two pages of SQLite's log."""


def measure(effort: Effort) -> list[Figure]:
    """Both servers and the disk in alternation."""
    seconds = effort.of(0.4, 1.5)
    kept, volatile, disk, tens = [], [], [], []
    with tempfile.TemporaryDirectory() as directory:
        state = str(Path(directory, "state"))
        with oem6250("--state", state) as durable, oem6250() as plain, Load() as load:
            for server in (durable, plain):
                server.tell(b"ECHO0\r")
            for _ in range(effort.times(3, 7)):
                kept.append(_hammer(load, durable, seconds))
                volatile.append(_hammer(load, plain, seconds))
                disk.append(_fsync_us(directory, effort.times(30, 100)))
                tens.append(_hammer(load, durable, seconds, clients=10))
    without = Reference(name="without --state", samples=[float(one["p50_us"]) for one in volatile])
    bare = Reference(name="append + fdatasync", samples=[percentile(times, 99) for times in disk])
    return [
        Figure(
            name="acknowledged VAR write with --state, p50",
            unit="us",
            samples=[float(one["p50_us"]) for one in kept],
            reference=Reference(name="append + fdatasync", samples=[median(times) for times in disk]),
        ),
        Figure(
            name="acknowledged VAR write with --state, p99",
            unit="us",
            samples=[float(one["p99_us"]) for one in kept],
            reference=bare,
        ),
        Figure(
            name="the same, beside one not kept, p50",
            unit="us",
            samples=[float(one["p50_us"]) for one in kept],
            reference=without,
        ),
        Figure(
            name="acknowledged VAR writes, 10 clients",
            unit="requests/s",
            samples=[float(one["requests_per_s"]) for one in tens],
        ),
    ]


def _hammer(load: Load, server: Server, seconds: float, *, clients: int = 1) -> Hammering:
    return load.hammer(server, QUESTION, len(ANSWER), clients=clients, seconds=seconds)


def _fsync_us(directory: str, times: int) -> list[float]:
    taken = []
    with open(Path(directory, "raw"), "ab", buffering=0) as file:
        for _ in range(times):
            began_s = time.perf_counter()
            file.write(b"." * COMMIT_BYTES)
            os.fdatasync(file.fileno())
            taken.append((time.perf_counter() - began_s) * 1e6)
    return taken

"""What a running emulator occupies: memory when started and after 70,000 requests, processor while two axes hold."""

from __future__ import annotations

import time

from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.load import PROMPT
from tests.bench.processes import Load, Server, echo, oem6250
from tests.bench.round_trip import ECHO_NAME, QUESTION

REQUESTS = 70_000
CLIENTS, DEPTH = 10, 8
CHUNK_S = 0.5
MEMORY = Reach(bound=250)


def measure(effort: Effort) -> list[Figure]:
    """One server from start to end: memory, idle processor, requests, memory again."""
    with oem6250() as unit, echo() as reference, Load() as load:
        unit.tell(b"ECHO0\rDRIVE11\r")
        started_mb, echo_mb = unit.resident_mb, reference.resident_mb
        idle = [idle_percent((unit, reference), effort.of(1.5, 10.0)) for _ in range(2)]
        request(load, unit, len(unit.tell(QUESTION)[0] + PROMPT))
        used_mb = unit.resident_mb
    own_idle, echo_idle = zip(*idle, strict=True)
    bare = Reference(name=ECHO_NAME, samples=[echo_mb])
    return [
        Figure(name="resident after start", unit="MB", samples=[started_mb], reference=bare, reach=MEMORY),
        Figure(name=f"resident after {REQUESTS:,} requests", unit="MB", samples=[used_mb], reach=MEMORY),
        Figure(name="growth over those requests", unit="MB", samples=[used_mb - started_mb]),
        Figure(
            name="idle, 2 axes holding",
            unit="% CPU",
            samples=own_idle,
            reference=Reference(name=ECHO_NAME, samples=echo_idle),
            reach=Reach(bound=2.0),
        ),
    ]


def idle_percent(servers: tuple[Server, Server], seconds: float) -> tuple[float, float]:
    """Processor time per time of both servers while nobody asks anything."""
    before_s, began_s = [server.cpu_s for server in servers], time.perf_counter()
    time.sleep(seconds)  # what idle servers use in real time is what is measured
    after_s, elapsed_s = [server.cpu_s for server in servers], time.perf_counter() - began_s
    own, bare = ((after - before) / elapsed_s * 100 for after, before in zip(after_s, before_s, strict=True))
    return own, bare


def request(load: Load, server: Server, answer_bytes: int) -> None:
    """At least REQUESTS requests."""
    done = 0.0
    while done < REQUESTS:
        result = load.hammer(server, QUESTION, answer_bytes, clients=CLIENTS, depth=DEPTH, seconds=CHUNK_S)
        done += result["requests_per_s"] * CHUNK_S

"""A stretch of real time with a host that asks all the while, and what both sides noted about it."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.bench.load import PROMPT
from tests.bench.processes import SERVE, Load, Server
from tests.bench.stamped import Record

_STOPPED = re.compile(r'event="stopped" p50_ns=(\d+) p99_ns=(\d+) max_ns=(\d+) samples=(\d+)')


class Exchange(NamedTuple):
    """One question of the host: monotonic ns when it was sent and answered; virtual ns when the answer left."""

    sent_ns: int
    answered_ns: int
    left_at_ns: int
    answer: str


class Lateness(NamedTuple):
    """The engine thread's account of its busy ticks, ms."""

    p50_ms: float
    p99_ms: float
    max_ms: float


class Session(NamedTuple):
    """What is known after it."""

    exchanges: Sequence[Exchange]
    lateness: Lateness
    record: Record


def hold(
    load: Load, *, set_up: bytes, question: bytes, seconds: float, interval_s: float = 0.0, pause_s: float = 0.0
) -> Session:
    """Start an emulator at x1, send `set_up`, wait `pause_s` of virtual time (a T command), then poll `question`."""
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "record.json"
        with Server("-m", "tests.bench.stamped", str(path), *SERVE) as server:
            server.tell(b"ECHO0\r" + set_up + (f"T{pause_s}\r".encode() if pause_s else b""))
            polled = load.poll(server, question, seconds=seconds, interval_s=interval_s)
            told = server.stop()
        record: Record = json.loads(path.read_text())
    return Session(_matched(polled, record), _lateness(told), record)


def _matched(polled: Sequence[tuple[int, int, str]], record: Record) -> list[Exchange]:
    """The host's notes beside the unit's: its last outputs with a prompt are the answers, in their order."""
    ends = [(at_ns, text) for at_ns, text in record["outputs"] if text.endswith(PROMPT.decode())][-len(polled) :]
    exchanges = []
    for (sent_ns, answered_ns, answer), (left_at_ns, text) in zip(polled, ends, strict=True):
        if answer != text:
            raise RuntimeError(f"the host read {answer!r} where the unit sent {text!r}")
        exchanges.append(Exchange(sent_ns, answered_ns, left_at_ns, answer))
    return exchanges


def _lateness(told: str) -> Lateness:
    found = _STOPPED.search(told)
    if found is None:
        raise RuntimeError(f"the server did not tell its lateness: {told}")
    return Lateness(*(int(text) / 1e6 for text in found.groups()[:3]))

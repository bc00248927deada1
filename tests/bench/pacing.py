"""How punctual a unit at x1 is: the age of its machines at each tick, and prompts that come by themselves.

A tick is due each millisecond while anything moves, so an age of one millisecond is the best there can be; the
reference is the same wait in an otherwise idle process.
"""

from __future__ import annotations

import select
import time
from collections.abc import Sequence
from statistics import mean

from tests.bench.figures import Effort, Figure, Reach, Reference, percentile
from tests.bench.processes import Load
from tests.bench.session import Session, hold

TICK_S = 0.001
MOVING = b"DRIVE11\rCOMEXC1\rA100,100\rV1,1\rMC11\rGO11\r"
SHORT_MOVES = b"DRIVE11\rCOMEXC0\rA100,100\rAD100,100\rV5,5\rMA00\rD100,100\r"
POLL_EVERY_S = 0.01
REFERENCE_S = 0.3
HOSTS = (("polled 100/s", POLL_EVERY_S), ("polled flat out", 0.0))


def measure(effort: Effort) -> list[Figure]:
    """Lateness under two polling hosts, then prompts of timed moves: arrival at the host minus virtual time."""
    with Load() as load:
        figures = []
        for name, interval_s in HOSTS:
            figures += _lateness_figures(name, interval_s, load, effort)
        return figures + _prompt_figures(load, effort)


def _lateness_figures(name: str, interval_s: float, load: Load, effort: Effort) -> list[Figure]:
    sessions, waits = [], []
    for _ in range(effort.times(2, 4)):
        seconds = effort.of(1.0, 4.0)
        sessions.append(hold(load, set_up=MOVING, question=b"1TPE\r", seconds=seconds, interval_s=interval_s).lateness)
        waits.append(bare_waits_ms(REFERENCE_S))
    fields = (
        ("p50", [one.p50_ms for one in sessions], [percentile(each, 50) for each in waits], None),
        ("p99", [one.p99_ms for one in sessions], [percentile(each, 99) for each in waits], Reach(bound=2.0)),
        ("max", [one.max_ms for one in sessions], [max(each) for each in waits], None),
    )
    return [
        Figure(
            name=f"lateness {kind}, {name}",
            unit="ms",
            samples=samples,
            reference=Reference(name="bare 1 ms wait", samples=bare),
            reach=reach,
        )
        for kind, samples, bare, reach in fields
    ]


def bare_waits_ms(seconds: float) -> list[float]:
    """How long waits of one tick really take in a process with nothing else to do, ms."""
    waits = []
    until_s = time.perf_counter() + seconds
    while (began_s := time.perf_counter()) < until_s:
        select.select((), (), (), TICK_S)
        waits.append((time.perf_counter() - began_s) * 1e3)
    return waits


def _prompt_figures(load: Load, effort: Effort) -> list[Figure]:
    late_ms: list[list[float]] = []
    for _ in range(effort.times(1, 3)):
        session = hold(load, set_up=SHORT_MOVES, question=b"GO11\r", seconds=effort.of(1.5, 4.0))
        late_ms.append(prompts_late_ms(session))
    fields: tuple[tuple[str, Sequence[float]], ...] = (
        ("mean", [mean(each) for each in late_ms]),
        ("p99", [percentile(each, 99) for each in late_ms]),
        ("max", [max(each) for each in late_ms]),
    )
    return [Figure(name=f"prompt of a timed move, {kind}", unit="ms", samples=values) for kind, values in fields]


def prompts_late_ms(session: Session) -> list[float]:
    """How long after its virtual time each prompt was in the host's hands."""
    ahead_ns = session.record["virtual_ahead_ns"]
    return [(each.answered_ns + ahead_ns - each.left_at_ns) / 1e6 for each in session.exchanges]

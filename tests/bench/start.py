"""From starting the process to its first reply, with an empty kernel cache and with a filled one."""

from __future__ import annotations

import tempfile
import time
from typing import NamedTuple

from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.help_time import BARE_PYTHON, bare_python_s
from tests.bench.processes import oem6250

CACHE_VARIABLE = "OEM6250_CACHE_DIR"


class Start(NamedTuple):
    """One start: seconds to the announcement, to the first reply, and what the process then occupies."""

    announced_s: float
    replied_s: float
    resident_mb: float


def measure(effort: Effort) -> list[Figure]:
    """Cold starts each with a cache directory of their own, then warm ones with the last of those."""
    cold = []
    for _ in range(effort.times(1, 3)):
        with tempfile.TemporaryDirectory() as cache:
            cold.append(start_once(cache))
            if len(cold) == effort.times(1, 3):
                warm, bare = zip(
                    *[(start_once(cache), bare_python_s()) for _ in range(effort.times(3, 9))], strict=True
                )
    reference = Reference(name=BARE_PYTHON, samples=bare)
    return [
        Figure(name="cold start, first reply", unit="s", samples=[one.replied_s for one in cold]),
        Figure(
            name="cold start, resident", unit="MB", samples=[one.resident_mb for one in cold], reach=Reach(bound=250)
        ),
        Figure(name="warm start, announced", unit="s", samples=[one.announced_s for one in warm], reference=reference),
        Figure(
            name="warm start, first reply",
            unit="s",
            samples=[one.replied_s for one in warm],
            reference=reference,
            reach=Reach(bound=0.7),
        ),
    ]


def start_once(cache: str) -> Start:
    """Start with this kernel cache, ask one question, stop."""
    with oem6250(environment={CACHE_VARIABLE: cache}) as server:
        announced_s = time.perf_counter() - server.began_s
        (answer,) = server.tell(b"1TPE\r")
        replied_s = time.perf_counter() - server.began_s
        if b"*1TPE" not in answer:
            raise RuntimeError(f"not an answer: {answer!r}")
        return Start(announced_s, replied_s, server.resident_mb)

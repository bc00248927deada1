"""How long `--help` takes, beside a Python that does nothing."""

from __future__ import annotations

from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.processes import run_time_s

BARE_PYTHON = "python -c pass"


def measure(effort: Effort) -> list[Figure]:
    """Seconds from starting the process to its end, warmed up once."""
    run_time_s("-m", "emulator", "--help")
    pairs = [(run_time_s("-m", "emulator", "--help"), bare_python_s()) for _ in range(effort.times(5, 15))]
    own, bare = zip(*pairs, strict=True)
    reference = Reference(name=BARE_PYTHON, samples=bare)
    return [Figure(name="--help", unit="s", samples=own, reference=reference, reach=Reach(bound=0.15))]


def bare_python_s() -> float:
    """Seconds to start and end the interpreter alone."""
    return run_time_s("-c", "pass")

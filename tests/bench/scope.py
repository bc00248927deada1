"""What recording with the scope adds to the kernel, two axes moving: a few signals, and as many as a picture holds."""

from __future__ import annotations

from emulator.engine import Engine
from emulator.engine.trace import Source
from tests.bench import kernel
from tests.bench.figures import Effort, Figure, Reach, Reference

USUAL = ("commanded_counts", "feedback_counts", "dac_v")
"""Of one axis: commanded and actual position (their difference is the error) and output."""
MANY = (*USUAL, "term_p", "term_i", "term_v", "term_vf", "term_af", "commanded_velocity", "actual_velocity")


def measure(effort: Effort) -> list[Figure]:
    """Nanoseconds per axis-sample while recording, the same engine without as reference."""
    return [
        _measure(effort, "3 signals of one axis", [Source(name, 0) for name in USUAL], Reach(bound=1.1, of="ratio")),
        _measure(effort, "10 of each of two axes", [Source(name, axis) for name in MANY for axis in (0, 1)], None),
    ]


def _measure(effort: Effort, name: str, sources: list[Source], reach: Reach | None) -> Figure:
    engine = kernel.closed_loop(moving=True)
    span_ns = int(effort.of(3, 10) * kernel.NS_PER_S)
    samples = kernel.AXES * span_ns / engine.rates.servo_ns
    pairs = [(_recorded_ns(engine, span_ns, sources), _plain_ns(engine, span_ns)) for _ in range(effort.times(9, 21))]
    kernel.check(engine, moving=True)
    recorded, plain = zip(*pairs, strict=True)
    return Figure(
        name=f"scope, {name}",
        unit="ns/axis-sample",
        samples=[ns / samples for ns in recorded],
        reference=Reference(name="scope off", samples=[ns / samples for ns in plain]),
        reach=reach,
    )


def _recorded_ns(engine: Engine, span_ns: int, sources: list[Source]) -> int:
    engine.scope.arm(sources, rows=span_ns // engine.rates.servo_ns + 1)
    engine.memory.ring[:] = 0  # so that the system has handed the pages out before the clock starts
    cpu_ns = kernel.cpu_ns_of(engine, span_ns)
    if not engine.scope.triggered:
        raise RuntimeError("nothing was recorded")
    engine.scope.stop()
    return cpu_ns


def _plain_ns(engine: Engine, span_ns: int) -> int:
    return kernel.cpu_ns_of(engine, span_ns)

"""What Following costs the kernel: an axis that follows the other's encoder, beside the same axis moving in time."""

from __future__ import annotations

from fractions import Fraction

from emulator.engine import Engine, MasterSource, plan_continuous, plan_ratio_change
from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.kernel import (
    ACCELERATION_COUNTS_S2,
    AXES,
    NS_PER_S,
    SETTLE_NS,
    VELOCITY_COUNTS_S,
    closed_loop,
    cpu_ns_of,
    run,
)

SLAVE, MASTER = 1, 0
RATIO = Fraction(125, 97)
REACH = 1.3


def measure(effort: Effort) -> list[Figure]:
    """Kernel time of two axes of which one follows, over that of two that move, in alternation in one run."""
    span_ns = int(effort.of(20, 60) * NS_PER_S)
    moving, following = closed_loop(moving=True), gearing()
    pairs = [(cpu_ns_of(following, span_ns), cpu_ns_of(moving, span_ns)) for _ in range(effort.times(5, 15))]
    check(following)
    samples = span_ns / moving.rates.servo_ns
    # The axis that both engines have in common costs half of what two moving axes do.
    axes = [(slave_ns - plain_ns / AXES, plain_ns / AXES) for slave_ns, plain_ns in pairs]
    return [
        Figure(
            name="kernel, a following axis",
            unit="ns/axis-sample",
            samples=[slave_ns / samples for slave_ns, _ in axes],
            reference=Reference(name="moving axis", samples=[plain_ns / samples for _, plain_ns in axes]),
        ),
        Figure(
            name="following over moving axis",
            unit="x",
            samples=[slave_ns / plain_ns for slave_ns, plain_ns in axes],
            reach=Reach(bound=REACH, at_least=False),
        ),
    ]


def gearing() -> Engine:
    """The engine of the default machine, axis 2 following axis 1's encoder at a constant ratio, filtered."""
    engine = closed_loop(moving=False)
    engine.set_master(SLAVE, source=MasterSource.ENCODER, master_index=MASTER)
    engine.set_master_filter(SLAVE, 120.0)
    engine.start_following(SLAVE, plan_ratio_change(Fraction(0), RATIO, 10_000), preset=False)
    profile = plan_continuous(0.0, 0.0, VELOCITY_COUNTS_S, ACCELERATION_COUNTS_S2, ACCELERATION_COUNTS_S2)
    engine.start_profile(MASTER, profile)
    run(engine, SETTLE_NS)
    return engine


def check(engine: Engine) -> None:
    """RuntimeError unless the slave still follows at its ratio."""
    if engine.following_ratio(SLAVE) != RATIO or not engine.is_enabled(SLAVE):
        raise RuntimeError("the slave does not follow: not what was to be measured")

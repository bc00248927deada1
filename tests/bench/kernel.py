"""The servo cycle alone: two axes in closed loop, holding and moving, without a controller above them."""

from __future__ import annotations

import time

from emulator.emulator import Emulator
from emulator.engine import Engine, plan_continuous
from tests.bench import processor
from tests.bench.figures import Effort, Figure, Reach, Reference

AXES = 2
VELOCITY_COUNTS_S = 20_000.0
ACCELERATION_COUNTS_S2 = 400_000.0
SETTLE_NS = 1_000_000_000
NS_PER_S = 1_000_000_000


def measure(effort: Effort) -> list[Figure]:
    """Processor nanoseconds per axis and sample, and virtual over processor time, of both states."""
    return [figure for moving in (False, True) for figure in _measure_state(effort, moving=moving)]


def _measure_state(effort: Effort, *, moving: bool) -> list[Figure]:
    engine = closed_loop(moving=moving)
    span_ns = int(effort.of(20, 60) * NS_PER_S)
    pairs = [(cpu_ns_of(engine, span_ns), processor.multiply_add_ns()) for _ in range(effort.times(5, 15))]
    check(engine, moving=moving)
    cpu_ns, multiply_add_ns = zip(*pairs, strict=True)
    state = "moving" if moving else "holding"
    samples = AXES * span_ns / engine.rates.servo_ns
    reference = Reference(name=processor.NAME, samples=multiply_add_ns)
    return [
        Figure(
            name=f"kernel, {state}", unit="ns/axis-sample", samples=[ns / samples for ns in cpu_ns], reference=reference
        ),
        Figure(
            name=f"kernel, 2 axes {state}",
            unit="x real time",
            samples=[span_ns / ns for ns in cpu_ns],
            reach=Reach(bound=1000, at_least=True),
        ),
    ]


def closed_loop(*, moving: bool) -> Engine:
    """The engine of the default machine with its drives on, at rest or at constant velocity."""
    unit = Emulator().unit(0)
    unit.send(b"DRIVE11\r")
    engine = unit.controller.engine
    for axis_index in range(AXES):
        if moving:
            profile = plan_continuous(0.0, 0.0, VELOCITY_COUNTS_S, ACCELERATION_COUNTS_S2, ACCELERATION_COUNTS_S2)
            engine.start_profile(axis_index, profile)
    run(engine, SETTLE_NS)
    return engine


def run(engine: Engine, span_ns: int) -> None:
    """Let `span_ns` of virtual time pass, whatever happens on the way."""
    until_ns = engine.time_ns + span_ns
    while engine.time_ns < until_ns:
        engine.run(until_ns)


def cpu_ns_of(engine: Engine, span_ns: int) -> int:
    """Processor time of a span of virtual time."""
    began_ns = time.process_time_ns()
    run(engine, span_ns)
    return time.process_time_ns() - began_ns


def check(engine: Engine, *, moving: bool) -> None:
    """RuntimeError unless both axes still do what was measured."""
    for axis_index in range(AXES):
        speed = engine.commanded_velocity(axis_index)
        if not engine.is_enabled(axis_index) or speed != (VELOCITY_COUNTS_S if moving else 0.0):
            raise RuntimeError(f"axis {axis_index + 1} moves at {speed} counts/s: not what was to be measured")

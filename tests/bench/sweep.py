"""Sweeps: virtual seconds of one axis, simulated, recorded and measured, per second of wall time, on one core and two.

Both are taken in alternation, so that what else the machine does falls on both; with more runnable processes than
processors the second core is not there to be used, and the scaling says so.
"""

from __future__ import annotations

import time
from concurrent.futures import Executor, ThreadPoolExecutor

from emulator.machine import Machine
from emulator.tuning.executors import processors
from emulator.tuning.experiment import StepExperiment
from emulator.tuning.sampling import make_plan, parse_span
from emulator.tuning.sweep import SweepPlan, sweep
from tests.bench.figures import Effort, Figure, Reach, Reference

CORES = 2
SPANS = {"SGP": "2:40", "SGV": "0:25"}


def measure(effort: Effort) -> list[Figure]:
    """Throughput of a sweep over the default machine's gains on one thread and on two."""
    plan = sweep_plan(effort.times(40, 200))
    with ThreadPoolExecutor(1) as single, ThreadPoolExecutor(CORES) as pool:
        throughput(plan, pool)
        pairs = [(throughput(plan, single), throughput(plan, pool)) for _ in range(effort.times(3, 9))]
    (one, one_cpu), (two, _) = (tuple(zip(*side, strict=True)) for side in zip(*pairs, strict=True))
    note = "" if processors() >= CORES else "only one processor here"
    return [
        Figure(name="sweep, one core", unit="axis-s/s", samples=one),
        Figure(name="sweep, one core", unit="axis-s/CPU s", samples=one_cpu),
        Figure(
            name="sweep, two cores",
            unit="axis-s/s",
            samples=two,
            reference=Reference(name="sweep on one core", samples=one),
            reach=Reach(bound=1.8, of="ratio", at_least=True),
            note=note,
        ),
    ]


def sweep_plan(samples: int) -> SweepPlan:
    """Random gains on the default machine."""
    machine = Machine.default()
    spans = {name: parse_span(text) for name, text in SPANS.items()}
    experiment = StepExperiment.of_machine(machine, 0)
    return make_plan(machine, 0, experiment, spans, random_samples=samples, seed=1)


def throughput(plan: SweepPlan, executor: Executor) -> tuple[float, float]:
    """Axis-seconds per second of wall time and of processor time; RuntimeError if samples were left out."""
    began_s, began_cpu_s = time.perf_counter(), time.process_time()
    result = sweep(plan, executor)
    took_s, took_cpu_s = time.perf_counter() - began_s, time.process_time() - began_cpu_s
    if not result.complete:
        raise RuntimeError(f"only {len(result)} of {result.wanted} samples were done")
    return plan.axis_seconds / took_s, plan.axis_seconds / took_cpu_s

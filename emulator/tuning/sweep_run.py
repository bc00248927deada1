"""What `oem6250 sweep` does: from its options to a plan, an executor, a table."""

from __future__ import annotations

import argparse
import signal
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import replace
from threading import Event, current_thread, main_thread

from emulator.machine import Machine
from emulator.tuning import SWEPT_GAINS
from emulator.tuning.executors import cluster, local, processors
from emulator.tuning.experiment import Move, StepExperiment
from emulator.tuning.sampling import Span, make_plan, parse_span
from emulator.tuning.sweep import Progress, SweepPlan, SweepResult, sweep
from emulator.tuning.sweep_table import best_sets, render_sets, write_table

INTERRUPTED = 130
"""Exit status of a run ended by SIGINT, as shells have it."""

PROGRESS_EVERY_S = 0.2


def run(parsed: argparse.Namespace) -> int:
    """Make the sweep the options ask for and print its best sets.

    Raises:
        MachineError, ClusterError, ValueError, OSError: what the user can mend.
    """
    plan = _plan(parsed)
    if parsed.out is not None and not parsed.out.parent.is_dir():
        raise ValueError(f"--out: there is no folder {parsed.out.parent}")
    began_s = time.monotonic()
    with _executor(parsed) as executor, _interruptible() as interrupted:
        shown = _progress(began_s) if _progress_wanted(verbose=parsed.verbose) else None

        def tell(done: int, wanted: int) -> None:
            if shown is not None:
                shown(done, wanted)
            if interrupted.is_set():
                raise KeyboardInterrupt

        result = sweep(plan, executor, progress=tell)
    if parsed.out is not None:
        write_table(parsed.out, result)
    _report(parsed, plan, result, time.monotonic() - began_s)
    return 0 if result.complete else INTERRUPTED


def _plan(parsed: argparse.Namespace) -> SweepPlan:
    machine, axis_index = Machine.load(parsed.machine), parsed.axis - 1
    experiment = replace(
        StepExperiment.of_machine(machine, axis_index),
        move=Move(distance_counts=parsed.distance),
        duration_s=parsed.duration,
        settle_counts=parsed.settle,
    )
    return make_plan(machine, axis_index, experiment, _spans_of(parsed), random_samples=parsed.random, seed=parsed.seed)


def _spans_of(parsed: argparse.Namespace) -> dict[str, Span]:
    """The ranges asked for by name; ValueError for a --vary that is none."""
    spans = {name: getattr(parsed, name.lower()) for name in SWEPT_GAINS if getattr(parsed, name.lower()) is not None}
    for text in parsed.vary:
        name, sign, span = text.partition("=")
        if not sign:
            raise ValueError(f"--vary {text!r} is not plant.NAME=RANGE, as in plant.inertia_kg_m2=0.8:1.2")
        if name in spans:
            raise ValueError(f"--vary {name} is given twice")
        spans[name] = parse_span(span)
    return spans


@contextmanager
def _interruptible() -> Iterator[Event]:
    """The event is set by the first SIGINT, a second one interrupts at once.

    An exception out of a signal may come up where Python swallows it (a callback of the executor), and be lost.
    """
    interrupted = Event()

    def note(*_: object) -> None:
        interrupted.set()
        signal.signal(signal.SIGINT, previous)

    previous = signal.getsignal(signal.SIGINT)
    if current_thread() is main_thread():
        signal.signal(signal.SIGINT, note)
    try:
        yield interrupted
    finally:
        if current_thread() is main_thread():
            signal.signal(signal.SIGINT, previous)


@contextmanager
def _executor(parsed: argparse.Namespace) -> Iterator[Executor]:
    context = cluster(parsed.cluster) if parsed.cluster is not None else local(parsed.jobs or processors())
    with context as executor:
        yield executor


def _progress_wanted(*, verbose: bool) -> bool:
    """Whether to show progress: on a terminal, or when asked to."""
    return verbose or sys.stderr.isatty()


def _progress(began_s: float) -> Progress:
    """Shows the samples done and the time left on one line of stderr."""
    last_s = 0.0

    def show(done: int, wanted: int) -> None:
        nonlocal last_s
        now_s = time.monotonic()
        if done < wanted and now_s - last_s < PROGRESS_EVERY_S:
            return
        last_s = now_s
        left = f", {(now_s - began_s) / done * (wanted - done):.0f} s left" if done else ""
        end = "\n" if done == wanted else ""
        sys.stderr.write(f"\r{done} of {wanted} samples{left}        {end}")
        sys.stderr.flush()

    return show


def _report(parsed: argparse.Namespace, plan: SweepPlan, result: SweepResult, took_s: float) -> None:
    done_s = plan.axis_seconds * len(result) / result.wanted
    print(
        f"{len(result)} of {result.wanted} samples, {done_s:.0f} axis-seconds in {took_s:.1f} s"
        + (f", written to {parsed.out}" if parsed.out is not None else "")
    )
    if parsed.best and len(result):
        print(f"\nbest by {parsed.sort}, each the worst over encoder phases and plants:\n")
        sys.stdout.write(render_sets(best_sets(result, sort=parsed.sort, count=parsed.best)))
    if not result.complete:
        print("oem6250: interrupted; the table has what was done", file=sys.stderr)

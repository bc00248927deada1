"""The kernel beside the same loop hand-written in C (`servo_loop.c`), compiled here with -O2; needs a C compiler."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from emulator.engine import Engine
from tests.bench import kernel
from tests.bench.figures import Effort, Figure, Reach, Reference

SOURCE = Path(__file__).with_name("servo_loop.c")
FLAGS = ("-O2", "-shared", "-fPIC", "-ffp-contract=off", "-std=c11")
"""Without contraction to fused multiply-add, which numba does not do either, both give the same bits."""

_DECLARATION = re.compile(r"(double|int64_t) ([\w, ]+);")


def measure(effort: Effort) -> list[Figure]:
    """Nanoseconds per axis-sample, the kernel's with the C loop's as reference; nothing without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        return []
    with _library(compiler) as library:
        return [_measure_state(effort, library, moving=moving) for moving in (False, True)]


def _measure_state(effort: Effort, library: ctypes.CDLL, *, moving: bool) -> Figure:
    engine = kernel.closed_loop(moving=moving)
    loop = CLoop(library, engine)
    span_ns = int(effort.of(10, 30) * kernel.NS_PER_S)
    samples = kernel.AXES * span_ns / engine.rates.servo_ns
    pairs = [(kernel.cpu_ns_of(engine, span_ns), loop.cpu_ns_of(span_ns)) for _ in range(effort.times(5, 15))]
    loop.check(engine)
    ours, theirs = zip(*pairs, strict=True)
    return Figure(
        name=f"kernel beside C, {'moving' if moving else 'holding'}",
        unit="ns/axis-sample",
        samples=[ns / samples for ns in ours],
        reference=Reference(name="the same loop in C, -O2", samples=[ns / samples for ns in theirs]),
        reach=Reach(bound=1.5, of="ratio"),
    )


@contextmanager
def _library(compiler: str) -> Iterator[ctypes.CDLL]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "servo_loop.so"
        subprocess.run([compiler, *FLAGS, str(SOURCE), "-o", str(path), "-lm"], check=True)
        yield ctypes.CDLL(str(path))


def _fields(name: str) -> list[tuple[str, type]]:
    """The members of a structure of the C source, in order."""
    body = re.search(rf"struct {name} \{{(.*?)\}};", SOURCE.read_text(), re.DOTALL)
    assert body is not None
    kinds = {"double": np.float64, "int64_t": np.int64}
    return [
        (field.strip(), kinds[kind]) for kind, fields in _DECLARATION.findall(body[1]) for field in fields.split(",")
    ]


class CLoop:
    """The C loop, begun in the state an engine is in."""

    def __init__(self, library: ctypes.CDLL, engine: Engine) -> None:
        memory = engine.memory
        self._advance = library.advance
        self._advance.argtypes = [ctypes.c_void_p] * 3 + [ctypes.c_int64] * 2
        self._advance.restype = ctypes.c_int64
        self.unit = _copy(np.zeros(1, _fields("unit")), memory.units)
        self.axes = _copy(np.zeros(len(memory.axes), _fields("axis")), memory.axes)
        plants = memory.plants[1::2]
        for name in ("speed_per_volt", "period_s", "lag_decay", "loop_decay", "lag_to_speed", "loop_to_position"):
            self.axes[name] = plants[name]
        for name in ("lag_to_position", "speed_step_limit"):
            self.axes[name] = plants[name]
        self.segments = _copy(np.zeros(len(memory.segments), _fields("segment")), memory.segments)

    def run(self, until_ns: int) -> None:
        """Run to a time, whatever happens on the way."""
        unit, axes, segments = (array.ctypes.data for array in (self.unit, self.axes, self.segments))
        while self.unit["next_sample_ns"][0] <= until_ns:
            self._advance(unit, axes, segments, len(self.axes), until_ns)

    def cpu_ns_of(self, span_ns: int) -> int:
        """Processor time of a span of virtual time."""
        until_ns = int(self.unit["next_sample_ns"][0]) + span_ns
        began_ns = time.process_time_ns()
        self.run(until_ns)
        return time.process_time_ns() - began_ns

    def check(self, engine: Engine) -> None:
        """RuntimeError unless the engine, brought to the same sample, is in the same state to the last bit."""
        kernel.run(engine, int(self.unit["next_sample_ns"][0]) - engine.time_ns)
        self.run(engine.time_ns)
        for name, _ in _fields("axis"):
            if name in (engine.memory.axes.dtype.names or ()) and (self.axes[name] != engine.memory.axes[name]).any():
                raise RuntimeError(f"C and kernel differ in {name}: {self.axes[name]} {engine.memory.axes[name]}")


def _copy(target: Any, source: Any) -> Any:
    for name in target.dtype.names:
        if name in source.dtype.names:
            target[name] = source[name]
    return target

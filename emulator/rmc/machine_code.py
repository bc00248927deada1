"""The RMC's kernel as machine code: built, kept and loaded like the servo's (`emulator.engine.machine_code`)."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.engine import machine_code as shared
from emulator.engine.layout import PLANT
from protocol.rmc.maps import VARIABLES

from . import cycle
from .kernels import functions_of_kernel
from .layout import (
    AXIS,
    BODIES_PER_AXIS,
    BODY,
    DEVICE,
    FILTER,
    FILTERS_PER_AXIS,
    RAMP,
    RAMPS_PER_AXIS,
    RECORDS,
)

if TYPE_CHECKING:
    from pathlib import Path

    from .memory import Memory

AXIS_WORDS = AXIS.itemsize // 8

_loaded: dict[str, shared.Kernel] = {}


@dataclass(frozen=True, slots=True)
class Calls:
    """The kernel bound to one device: `advance(until_ns) -> events`, releasing the interpreter lock or keeping it."""

    long_run: Callable[[int], int]
    short_run: Callable[[int], int]
    keep_alive: Any


def load_kernel(on_build: shared.OnBuild | None = None) -> shared.Kernel:
    """The kernel of this process: interpreted if the environment says so, else from the cache, else built."""
    mode = os.environ.get(shared.MODE_VARIABLE, "")
    if mode not in _loaded:
        interpreted = shared.Kernel("interpreted", 0, None)
        _loaded[mode] = interpreted if mode == "interpreted" else _load_compiled(on_build)
    return _loaded[mode]


def bind(kernel: shared.Kernel, memory: Memory) -> Calls:
    """Bind the kernel to a device's arrays."""
    if kernel.origin == "interpreted":
        return _bind_interpreted(memory)
    table = memory.addresses()
    return Calls(
        _bound(shared.RELEASING(kernel.address), table.ctypes.data),
        _bound(shared.KEEPING(kernel.address), table.ctypes.data),
        (table, memory, kernel),
    )


def cache_path() -> Path:
    """Where the object code is kept."""
    functions, _ = functions_of_kernel()
    return shared.cache_file("rmc", shared.fingerprint(functions, RECORDS, also=(shared.__file__, __file__)))


def _load_compiled(on_build: shared.OnBuild | None) -> shared.Kernel:
    path = cache_path()
    sentence = f"building the kernel of the RMC {shared.FOR_THIS_MACHINE}"
    return shared.cached_kernel(path) or shared.build_saying(sentence, _build, path, on_build)


def _build(path: Path) -> shared.Kernel:
    return shared.keep(_compile(), path)


def _compile() -> Any:
    """The entry point as a numba C callback; its table is that of `Memory.addresses`."""
    numba, compiled = shared.compile_functions(*functions_of_kernel())
    advance, carray = compiled[id(cycle.advance)], numba.carray

    def entry(table, unused, until_ns):  # type: ignore[no-untyped-def]
        device = carray(table[0], (1,), DEVICE)
        count = device[0]["axis_count"]
        return advance(
            device[0],
            carray(table[1], (count,), AXIS),
            carray(table[2], (count * BODIES_PER_AXIS,), BODY),
            carray(table[3], (count * BODIES_PER_AXIS,), PLANT),
            carray(table[4], (count * RAMPS_PER_AXIS,), RAMP),
            carray(table[5], (count * FILTERS_PER_AXIS,), FILTER),
            carray(table[1], (count * AXIS_WORDS,), np.float64),
            carray(table[6], (VARIABLES,), np.float64),
            until_ns,
        )

    return shared.as_callback(numba, entry)


def _bound(function: Any, table: int) -> Callable[[int], int]:
    def advance(until_ns: int) -> int:
        return int(function(table, 0, until_ns))

    return advance


def _bind_interpreted(memory: Memory) -> Calls:
    def advance(until_ns: int) -> int:
        return cycle.advance(
            memory.device[0],
            memory.axes,
            memory.bodies,
            memory.plants,
            memory.ramps,
            memory.filters,
            memory.axis_floats,
            memory.variables,
            until_ns,
        )

    return Calls(advance, advance, memory)

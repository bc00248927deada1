"""How long PCOMP of a long profile takes: 500 segments, each with a velocity and a distance of its own."""

from __future__ import annotations

import time

from emulator import Emulator, Machine
from tests.bench.figures import Effort, Figure, Reach

SEGMENTS = 500
MACHINE = "[memory]\nsegment_bytes = 30\n[defaults]\nECHO = 0\n"


def measure(effort: Effort) -> list[Figure]:
    """Milliseconds of the processor for PCOMP, the program new each time so that nothing of it is prepared."""
    samples = [_compile_ms() for _ in range(effort.times(3, 15))]
    name = f"PCOMP of {SEGMENTS} segments"
    return [Figure(name=name, unit="ms", samples=samples, reach=Reach(bound=50.0))]


def _compile_ms() -> float:
    unit = Emulator(Machine.parse(MACHINE)).unit(0)
    moves = [f"V{1 + index % 3}:D{8000 + index}:GOBUF1" for index in range(SEGMENTS - 1)]
    unit.send("\r".join(["DEF P", "A10", *moves, "V1:D9000:VF0:GOBUF1", "END", ""]).encode())
    unit.read()
    begin = time.process_time()
    unit.send(b"PCOMP P\r")
    took_ms = (time.process_time() - begin) * 1e3
    if unit.read() != b"\r\n> ":
        raise RuntimeError("the profile was not compiled")
    return took_ms

"""Stored programs: commands per second of processor time, and how fast time can run while a program moves the axes.

Counting: a WHILE loop that adds to variables, carried out at the unit's own pace in virtual time, the servo running
beside it as always. Motion: a program that moves both axes to and fro in a loop, counts, and switches an output.
"""

from __future__ import annotations

import time

from emulator.emulator import Emulator
from tests.bench import processor
from tests.bench.figures import Effort, Figure, Reach, Reference

SET_UP = b"ECHO0\rCOMEXC0\rDRIVE11\rA100,100\rAD100,100\rV5,5\rMA00\r"
COUNT = b"DEF COUNT\rVAR1=0\rVAR2=0\rWHILE(VAR1<%d)\rVAR1=VAR1+1\rVAR2=VAR1*2-VAR2\rNWHILE\rEND\r"
COMMANDS_A_TURN = 4
"""WHILE, two assignments, NWHILE."""
MOTION = (
    b"DEF MOVES\rVAR1=0\rWHILE(VAR1<%d)\rD4000,4000\rGO11\rOUT1\rD-4000,-4000\rGO11\rOUT0\rVAR1=VAR1+1\rNWHILE\rEND\r"
)
SLICE_S = 1.0


def measure(effort: Effort) -> list[Figure]:
    """Commands of a counting loop per processor second, and the speed of a motion program."""
    counts, turns = effort.times(3_000, 20_000), effort.times(30, 150)
    rows = [
        (counting(counts), moving(turns), processor.multiply_add_ns()) for _ in range(effort.times(3, 9))
    ]  # fmt: skip
    commands, factors, multiply_add_ns = zip(*rows, strict=True)
    reference = Reference(name=processor.NAME, samples=multiply_add_ns)
    return [
        Figure(
            name="program, counting loop",
            unit="commands/CPU s",
            samples=commands,
            reference=reference,
            reach=Reach(bound=100_000, at_least=True),
        ),
        Figure(
            name="program, moves",
            unit="virtual s/CPU s",
            samples=factors,
            reference=reference,
            reach=Reach(bound=300, at_least=True),
        ),
    ]


def counting(turns: int) -> float:
    """Stored commands per processor second."""
    _, cpu_s, value = _run(COUNT % turns, b"COUNT\r")
    if value != turns:
        raise RuntimeError(f"the loop counted to {value}, not to {turns}")
    return COMMANDS_A_TURN * turns / cpu_s


def moving(turns: int) -> float:
    """Virtual over processor time of a program that moves."""
    virtual_s, cpu_s, value = _run(MOTION % turns, b"MOVES\r")
    if value != turns:
        raise RuntimeError(f"{value} turns were made, not {turns}")
    return virtual_s / cpu_s


def _run(definition: bytes, start: bytes) -> tuple[float, float, float]:
    """Define and run a program to its end: virtual and processor seconds, and VAR1 at the end."""
    emulator = Emulator()
    unit = emulator.unit(0)
    unit.send(SET_UP + definition)
    unit.read()
    began_s, began_cpu_s = emulator.time_s, time.process_time()
    unit.send(start)
    while unit.controller.busy:
        emulator.advance(SLICE_S)
    cpu_s = time.process_time() - began_cpu_s
    virtual_s = emulator.time_s - began_s
    unit.read()
    unit.send(b"VAR1\r")
    return virtual_s, cpu_s, float(unit.read().partition(b"=")[2].split()[0])

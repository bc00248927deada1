"""A whole controller in virtual time: how many virtual seconds one second of processor time is worth.

Idle: two enabled axes hold. Moving: both axes run one revolution to and fro, each GO waiting for the one before, with
the commands that make them parsed and answered within the time.
"""

from __future__ import annotations

import time

from emulator.emulator import Emulator
from tests.bench import processor
from tests.bench.figures import Effort, Figure, Reach, Reference

SET_UP = b"ECHO0\rCOMEXC0\rDRIVE11\rA100,100\rAD100,100\rV5,5\rMA00\r"
TO_AND_FRO = b"D4000,4000\rGO11\rD-4000,-4000\rGO11\r"
TURNS_AT_ONCE = 25
"""Buffered at a time: the unit's own input buffer holds hardly more."""
PROMPT = b"\r\n> "
SLICE_S = 1.0


def measure(effort: Effort) -> list[Figure]:
    """Virtual seconds per processor second, idle and moving."""
    idle_s, turns = effort.of(20, 60), effort.times(50, 200)
    rows = []
    for _ in range(effort.times(3, 9)):
        rows.append((idle(idle_s), moving(turns), processor.multiply_add_ns()))
    idle_factors, moving_factors, multiply_add_ns = zip(*rows, strict=True)
    reference = Reference(name=processor.NAME, samples=multiply_add_ns)
    unit = "virtual s/CPU s"
    return [
        Figure(name="controller, idle", unit=unit, samples=idle_factors, reference=reference),
        Figure(
            name="controller, moves back to back",
            unit=unit,
            samples=moving_factors,
            reference=reference,
            reach=Reach(bound=300, at_least=True),
        ),
    ]


def set_up() -> Emulator:
    """A default machine, set up and its answers read."""
    emulator = Emulator()
    emulator.unit(0).send(SET_UP)
    emulator.unit(0).read()
    return emulator


def idle(seconds: float) -> float:
    """Virtual over processor time while nothing but the servo runs."""
    emulator = set_up()
    began_s, began_cpu_s = emulator.time_s, time.process_time()
    while emulator.time_s < began_s + seconds:
        emulator.advance(SLICE_S)
    return (emulator.time_s - began_s) / (time.process_time() - began_cpu_s)


def moving(turns: int) -> float:
    """Virtual over processor time of `turns` revolutions to and fro."""
    emulator = set_up()
    unit = emulator.unit(0)
    began_s, began_cpu_s = emulator.time_s, time.process_time()
    prompts = 0
    for _ in range(turns // TURNS_AT_ONCE):
        unit.send(TO_AND_FRO * TURNS_AT_ONCE)
        while unit.controller.busy:
            emulator.advance(SLICE_S)
        prompts += unit.read().count(PROMPT)
    factor = (emulator.time_s - began_s) / (time.process_time() - began_cpu_s)
    if prompts != turns * TO_AND_FRO.count(b"\r"):
        raise RuntimeError(f"{prompts} prompts for {turns} turns: the moves did not all run")
    return factor

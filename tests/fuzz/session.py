"""One random session against a unit, and what must hold whatever was sent."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

from emulator import Emulator, Machine
from emulator.controller import Output

MACHINE = Machine.parse("[defaults]\nECHO = 0")
TURNING = Machine.parse(
    "[options]\nani = true\n[defaults]\nECHO = 0\n"
    '[axis2.encoder_motion]\nkind = "sine"\nswing_counts = 20000\nfrequency_hz = 0.7\n'
)
"""A unit whose second encoder something else turns to and fro."""
RUN_S = 0.05
"""Virtual time given after each batch of commands: some twenty system updates."""
BATCH = 10
PATIENCE = 3 * BATCH
"""Commands after which a host that is kept waiting (PS, WAIT, an endless loop) continues and kills."""
MOTION_PATIENCE = 20 * BATCH
"""The same for a session of motion, which brings its own kills."""
MAX_OUTPUT_BYTES = 4_000_000
MAX_CPU_S = 20.0
QUIET = b"!K\r!HALT\r!K\r"
DIRECTION = ";"
"""What begins a line that is a comment to the unit and a stage direction to ``play``."""
CONTACTS = {"enable": True, "axis1.drive_fault": False, "axis2.drive_fault": False}
"""Contacts as a unit that can move has them."""
FINITE = ("position.commanded", "position.actual", "velocity.commanded", "slave.position", "slave.shift", "dac")


class Broken(AssertionError):
    """Something that must hold does not; the text names it."""


def play(lines: Sequence[str], machine: Machine = MACHINE, *, of_motion: bool = False) -> list[Output]:
    """Send the lines, let time pass, and return what the unit said. Broken, or what the unit raised, on a fault."""
    emulator = Emulator(machine)
    unit = emulator.unit(0)
    unit.take_output()
    patience = MOTION_PATIENCE if of_motion else PATIENCE
    began_s, said = time.process_time(), []
    for start in range(0, len(lines), BATCH):
        if start % patience == 0:
            unit.send(b"!C\r!K\r")
        for line in lines[start : start + BATCH]:
            unit.send(f"{line}\r".encode("latin-1"))
            if line.startswith(DIRECTION):
                _direct(emulator, *line[1:].split())
        emulator.advance(RUN_S)
        said += unit.take_output()
        unit.read()
        _check_finite(emulator)
        if time.process_time() - began_s > MAX_CPU_S:
            raise Broken(f"{MAX_CPU_S} s of processor time are over after {start + BATCH} commands: it hangs")
    _check_alive(emulator)
    if of_motion:
        _check_moves(emulator)
    _check_bounds(emulator, said)
    return said


def _direct(emulator: Emulator, what: str, *fields: str) -> None:
    """Carry out a stage direction: ``wait s``, ``wire name level`` or ``turn axis counts``."""
    if what == "wait":
        emulator.advance(float(fields[0]))
    elif what == "wire":
        emulator.unit(0).do("set_wire", name=fields[0], closed=fields[1] == "1")
    else:
        emulator.unit(0).do("slip_encoder", axis=int(fields[0]), counts=int(fields[1]))


def _check_finite(emulator: Emulator) -> None:
    signals = emulator.unit(0).signals
    for name in (f"axis{axis}.{signal}" for axis in (1, 2) for signal in FINITE):
        value = signals[name]
        if not isinstance(value, int | float) or not math.isfinite(value):
            raise Broken(f"{name} is {value}")


def _check_alive(emulator: Emulator) -> None:
    """After a kill the unit answers a question at once, and after RESET too, both axes at rest where they are."""
    unit = emulator.unit(0)
    for command in (QUIET, b"!K\rRESET\r"):
        unit.send(b"\rEND\r" + command)
        emulator.advance(1.0)
        unit.read()
        unit.send(b"!1TPC\r")
        emulator.advance(0.1)
        if b"*1TPC" not in unit.read():
            raise Broken(f"no answer to !1TPC after {command!r}")


def _check_moves(emulator: Emulator) -> None:
    """After RESET nothing of the session is left that would keep an ordinary move from its place."""
    for name, closed in CONTACTS.items():
        emulator.unit(0).do("set_wire", name=name, closed=closed)
    unit = emulator.unit(0)
    unit.send(QUIET + b"END\rRESET\r")
    emulator.advance(0.1)
    unit.send(b"LH0,0\rSMPER0,0\rCOMEXC1\rDRIVE10\rPSET0\rA100\rAD100\rV10\rD4000\rGO10\r")
    emulator.advance(1.0)
    unit.read()
    unit.send(b"!1TPC\r")
    if b"*1TPC+4000\r" not in (answer := unit.read()):
        raise Broken(f"a move of 4000 counts ended at {answer!r}")


def _check_bounds(emulator: Emulator, said: Sequence[Output]) -> None:
    programs = emulator.unit(0).controller.programs
    if programs.bytes_free < 0:
        raise Broken(f"{-programs.bytes_free} bytes of programs too many in a memory of {programs.capacity_bytes}")
    if sum(len(output.data) for output in said) > MAX_OUTPUT_BYTES:
        raise Broken("more output than a line could carry")

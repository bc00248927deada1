"""One random session against a unit, and what must hold whatever was sent."""

from __future__ import annotations

import time
from collections.abc import Sequence

from emulator import Emulator, Machine
from emulator.controller import Output

MACHINE = Machine.parse("[defaults]\nECHO = 0")
RUN_S = 0.05
"""Virtual time given after each batch of commands: some twenty system updates."""
BATCH = 10
PATIENCE = 3 * BATCH
"""Commands after which a host that is kept waiting (PS, WAIT, an endless loop) continues and kills."""
MAX_OUTPUT_BYTES = 4_000_000
MAX_CPU_S = 20.0
QUIET = b"!K\r!HALT\r!K\r"


class Broken(AssertionError):
    """Something that must hold does not; the text names it."""


def play(lines: Sequence[str]) -> list[Output]:
    """Send the lines, let time pass, and return what the unit said. Broken, or what the unit raised, on a fault."""
    emulator = Emulator(MACHINE)
    unit = emulator.unit(0)
    unit.take_output()
    began_s, said = time.process_time(), []
    for start in range(0, len(lines), BATCH):
        if start % PATIENCE == 0:
            unit.send(b"!C\r!K\r")
        unit.send("".join(f"{line}\r" for line in lines[start : start + BATCH]).encode("latin-1"))
        emulator.advance(RUN_S)
        said += unit.take_output()
        unit.read()
        if time.process_time() - began_s > MAX_CPU_S:
            raise Broken(f"{MAX_CPU_S} s of processor time are over after {start + BATCH} commands: it hangs")
    _check_alive(emulator)
    _check_bounds(emulator, said)
    return said


def _check_alive(emulator: Emulator) -> None:
    """After a kill the unit answers a question at once."""
    unit = emulator.unit(0)
    unit.send(b"\rEND\r" + QUIET)
    emulator.advance(1.0)
    unit.read()
    unit.send(b"!1TPC\r")
    emulator.advance(0.1)
    if b"*1TPC" not in unit.read():
        raise Broken("no answer to !1TPC after a kill")


def _check_bounds(emulator: Emulator, said: Sequence[Output]) -> None:
    programs = emulator.unit(0).controller.programs
    if programs.bytes_free < 0:
        raise Broken(f"{-programs.bytes_free} bytes of programs too many in a memory of {programs.capacity_bytes}")
    if sum(len(output.data) for output in said) > MAX_OUTPUT_BYTES:
        raise Broken("more output than a line could carry")

"""What can be asked about programs: TDIR, TMEM, TPROG, TLABEL, TEX."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.programs.store import name_of, require_access
from protocol.command import Command
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

COMPILED = " COMPILED AS A PATH"
"""What TDIR adds to a program that is compiled, an individual-axis profile too (assumed M)."""


@handles("TPROG")
def list_program(controller: Controller, command: Command) -> Lines:
    """TPROG name: each stored command on its own line."""
    require_access(controller)
    return [ReplyLine("", line) for line in controller.programs.lines(name_of(command))] or [ReplyLine("", "")]


@handles("TMEM")
def memory_free(controller: Controller, command: Command) -> Lines:
    """TMEM: the two memory lines (text assumed M)."""
    return memory_lines(controller)


@handles("TDIR")
def directory(controller: Controller, command: Command) -> Lines:
    """TDIR: the programs, then the memory lines (text assumed M)."""
    programs, compiled = controller.programs, controller.compiled
    lines = [
        ReplyLine("", f"{number} - {name} USES {programs.bytes_used(name)} BYTES{COMPILED * compiled.has(name)}")
        for number, name in enumerate(programs.names, start=1)
    ]
    return [*(lines or [ReplyLine("", "NO PROGRAMS DEFINED")]), *memory_lines(controller)]


@handles("TLABEL")
def labels(controller: Controller, command: Command) -> Lines:
    """TLABEL: every label and its program (text assumed L)."""
    found = controller.programs.labels()
    lines = [ReplyLine("", f"{label} DEFINED IN PROGRAM {name}") for label, name in found]
    return lines or [ReplyLine("", "NO LABELS DEFINED")]


@handles("TEX")
def executing(controller: Controller, command: Command) -> Lines:
    """TEX: what is being carried out (text assumed L)."""
    found = controller.programs.executing
    if found is None:
        return [ReplyLine("", "PROGRAM NOT EXECUTING")]
    return [ReplyLine("", f"PROGRAM={found[0]} COMMAND={found[1]}")]


def memory_lines(controller: Controller) -> list[ReplyLine]:
    """Free program bytes and compiled segments; percent rounded."""
    free, capacity = controller.programs.bytes_free, controller.programs.capacity_bytes
    left, segments = controller.compiled.free, controller.compiled.capacity
    return [
        ReplyLine("", f"{free} OF {capacity} BYTES ({round(100 * free / capacity)}%) PROGRAM MEMORY REMAINING"),
        ReplyLine(
            "", f"{left} OF {segments} SEGMENTS ({round(100 * left / max(segments, 1))}%) COMPILED MEMORY REMAINING"
        ),
    ]

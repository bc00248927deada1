"""Compiled memory: the programs that are compiled, the segments they take, and the compiled motion under way.

Nothing here outlives power-off or RESET: a program must be compiled again (assumed M).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.compiled.kinds import CompiledMotion, MotionRun
from protocol.errors import INSUFFICIENT_MEMORY, CommandError
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NEARLY_FULL = 0.75
"""Share of compiled memory in use from which SS bit 29 is set."""


class CompiledPrograms:
    """Compiled memory of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._motions: dict[str, CompiledMotion] = {}
        self._runs: dict[str, MotionRun] = {}
        self.failed = False
        """The last PCOMP was refused (SS bit 31)."""

    # Memory.

    @property
    def capacity(self) -> int:
        """Segments compiled memory holds."""
        return self._controller.settings.integer("MEMORY", 1) // self._controller.machine.memory.segment_bytes

    @property
    def used(self) -> int:
        """Segments in use."""
        return sum(motion.segments for motion in self._motions.values())

    @property
    def free(self) -> int:
        """Segments left."""
        return self.capacity - self.used

    def has(self, name: str) -> bool:
        """Whether a program is compiled."""
        return name in self._motions

    def motion(self, name: str) -> CompiledMotion | None:
        """The compiled form of a program; None when it is not compiled."""
        return self._motions.get(name)

    def keep(self, name: str, motion: CompiledMotion) -> None:
        """Store a compiled program.

        Raises:
            CommandError: INSUFFICIENT MEMORY.
        """
        if motion.segments > self.free or len(self._motions) >= self._controller.machine.memory.compiled:
            raise CommandError(INSUFFICIENT_MEMORY)
        self._motions[name] = motion

    def remove(self, name: str) -> None:
        """A program is not compiled any longer; one that never was is no matter."""
        self._motions.pop(name, None)

    def clear(self) -> None:
        """Nothing is compiled, nothing runs (power-down, RESET, ERASE, MEMORY)."""
        self._motions.clear()
        for run in self._runs.values():
            run.end()
        self._runs.clear()
        self.failed = False

    # Running.

    def start(self, name: str) -> MotionRun:
        """Start a compiled program."""
        self.look()
        run = self._runs[name] = self._motions[name].start(self._controller)
        return run

    def look(self) -> None:
        """Something has happened: forget what is over."""
        if self._runs:
            for name in [name for name, run in self._runs.items() if not is_under_way(run)]:
                self._runs.pop(name).end()

    def running(self, name: str) -> bool:
        """Whether a compiled program has an axis in motion, or is paused."""
        run = self._runs.get(name)
        return run is not None and is_under_way(run)

    @property
    def any_running(self) -> bool:
        """Whether any compiled program has an axis in motion."""
        return any(map(self.running, self._runs))

    def moves(self, axis_index: int) -> bool:
        """Whether compiled motion has an axis."""
        return any(axis_index in run.axes and run.moves(axis_index) for run in self._runs.values())

    # Status.

    @property
    def status(self) -> dict[SystemStatus, bool]:
        """SS bits 29 to 31."""
        return {
            SystemStatus.COMPILED_MEMORY_75_PERCENT_FULL: self.used >= NEARLY_FULL * self.capacity,
            SystemStatus.COMPILED_MEMORY_FULL: self.free <= 0,
            SystemStatus.COMPILE_FAILED: self.failed,
        }


def is_under_way(run: MotionRun) -> bool:
    """Whether compiled motion still has one of its axes, or will have them again after a pause."""
    return run.paused or any(map(run.moves, run.axes))

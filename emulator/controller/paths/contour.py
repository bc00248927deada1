"""Contour paths as PCOMP keeps them and PRUN carries them out.

A compiled path is lines and arcs from where its axes will stand, each with the speed it was defined with; every PRUN
moves it there and travels it again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.compiled.profile import is_slave
from emulator.controller.motion.go import forget_refusals, held_by_limit
from emulator.controller.paths.geometry import Piece
from emulator.controller.paths.motion import Course, axes_at, first_headings
from emulator.controller.paths.speed import Stretch
from protocol.errors import AXES_NOT_READY, CommandError

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


@dataclass(frozen=True, slots=True)
class ContourPath:
    """A compiled path: X and Y axis (indexes), pieces in counts from its beginning, how fast each may be, and the
    outputs that change where one begins."""

    axes: tuple[int, int]
    pieces: tuple[Piece, ...]
    stretches: tuple[Stretch, ...]
    outputs: Mapping[int, str]

    @property
    def segments(self) -> int:
        """Segments of compiled memory it takes: one a line or arc (assumed)."""
        return len(self.pieces)

    def start(self, controller: Controller) -> ContourRun:
        """Start it from where the axes are; nothing moves if a limit lies in the way of one.

        Raises:
            CommandError: AXES NOT READY for an axis that is a slave (FOLEN1): a path is travelled in time (assumed).
        """
        if any(is_slave(controller.settings, axis_index) for axis_index in self.axes):
            raise CommandError(AXES_NOT_READY)
        headings = first_headings(self.pieces, len(self.axes))
        held = [held_by_limit(controller, axis, heading) for axis, heading in zip(self.axes, headings, strict=True)]
        course = self._course(axes_at(controller, self.axes))
        if not any(held):
            for axis_index in self.axes:
                forget_refusals(controller, axis_index)
            controller.paths.start(course)
        return ContourRun(controller, course)

    def _course(self, origin: tuple[int, ...]) -> Course:
        pieces = tuple(piece.moved(origin) for piece in self.pieces)
        return Course(self.axes, pieces, self.stretches, outputs=dict(self.outputs))


@dataclass(frozen=True, slots=True, eq=False)
class ContourRun:
    """A path under way."""

    controller: Controller
    course: Course

    @property
    def axes(self) -> tuple[int, ...]:
        return self.course.axes

    def moves(self, axis_index: int) -> bool:
        """Whether the path still has an axis."""
        return self.controller.paths.travels(self.course, axis_index)

    @property
    def paused(self) -> bool:
        """A pause holds it, with COMEXR1."""
        return self.controller.pausing.holds(self.course)

    def end(self) -> None:
        """It leaves nothing behind: outputs of segments that it has not reached are not switched."""

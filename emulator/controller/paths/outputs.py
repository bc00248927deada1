"""POUT: outputs that change where a piece of a path begins.

They can change only at system updates.  The one chosen is the first for which the piece begins less than three quarters
of an update later, so that with updates of 2 ms they change from 1.5 ms before to 0.5 ms after (6000 PG p. 160).
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import zip_longest
from typing import TYPE_CHECKING

from emulator.controller.compiled.profile import system_update_near
from emulator.controller.compiled.timed_axis import outputs_ahead_ns
from emulator.controller.wires.outputs import switch_outputs

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.paths.motion import Course


def merged(first: str, then: str) -> str:
    """Two patterns (0, 1 or X, output 1 first), one after the other, as one."""
    pairs = zip_longest(first, then, fillvalue="X")
    return "".join(old if new == "X" else new for old, new in pairs)


class SwitchedOutputs:
    """The outputs of a path under way; one path at a time has outputs."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._course: Course | None = None
        self._switched: set[int] = set()
        self._plan = 0

    def follow(self, course: Course, begins_ns: Mapping[int, int]) -> None:
        """Switch the outputs of a course as its pieces begin, each once; what was planned before is forgotten, so that
        a path that slows down switches later."""
        if course is not self._course:
            self._course, self._switched = course, set()
        self._plan += 1
        for piece, at_ns in begins_ns.items():
            if piece in course.outputs and piece not in self._switched:
                self._switch_at(at_ns, piece)

    def _switch_at(self, begins_ns: int, piece: int) -> None:
        ahead_ns = outputs_ahead_ns(self._controller.engine.rates.system_ns)
        at_ns, plan = system_update_near(self._controller, begins_ns - ahead_ns), self._plan
        if at_ns <= self._controller.now_ns:
            self._switch(piece, plan)
        else:
            self._controller.alarms.at(at_ns, lambda: self._switch(piece, plan))

    def _switch(self, piece: int, plan: int) -> None:
        if plan == self._plan and self._course is not None:
            self._switched.add(piece)
            switch_outputs(self._controller, self._course.outputs[piece])

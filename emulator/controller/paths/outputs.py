"""POUT: outputs that change where a piece of a path begins.

They can change only at system updates.  The one chosen is the first for which the piece begins less than three quarters
of an update later, so that with updates of 2 ms they change from 1.5 ms before to 0.5 ms after (6000 PG p. 160).
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import zip_longest
from typing import TYPE_CHECKING

from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.paths.motion import Course
    from protocol.command import Command


def pattern_of(command: Command, count: int) -> str:
    """The outputs an output command names, left to right from output 1: 0, 1, or X where it says nothing.

    Raises:
        CommandError: an output the unit does not have, or no pattern at all.
    """
    if command.bit is not None:
        if not 1 <= command.bit <= count or command.bit_value not in ("0", "1", "X"):
            raise CommandError(INVALID_DATA)
        return "X" * (command.bit - 1) + command.bit_value
    if not command.mask or "1" in command.mask[count:]:
        raise CommandError(INCORRECT_DATA)
    return command.mask[:count]


def merged(first: str, then: str) -> str:
    """Two patterns, one after the other, as one."""
    pairs = zip_longest(first, then, fillvalue="X")
    return "".join(old if new == "X" else new for old, new in pairs)


def switching_update_ns(begins_ns: int, *, an_update_ns: int, period_ns: int) -> int:
    """The system update at which outputs change for a piece that begins at a time; ``an_update_ns`` is any of them."""
    earliest_ns = begins_ns - 3 * period_ns // 4 + 1
    return an_update_ns - (an_update_ns - earliest_ns) // period_ns * period_ns


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
        engine, plan = self._controller.engine, self._plan
        at_ns = switching_update_ns(
            begins_ns, an_update_ns=engine.next_system_update_ns, period_ns=engine.rates.system_ns
        )
        if at_ns <= engine.time_ns:
            self._switch(piece, plan)
        else:
            self._controller.alarms.at(at_ns, lambda: self._switch(piece, plan))

    def _switch(self, piece: int, plan: int) -> None:
        if plan == self._plan and self._course is not None:
            self._switched.add(piece)
            set_outputs(self._controller, self._course.outputs[piece])


def set_outputs(controller: Controller, pattern: str) -> None:
    """Set outputs left to right from output 1; X keeps one."""
    controller.settings.store_bits("OUT", merged(controller.settings.bits("OUT"), pattern))

"""GOWHEN on PMAS: a start that waits for a place in the master cycle.

A position beyond the cycle length lies in a later cycle, counted from the one in which GOWHEN was given (6000 PG
p.223).  A slave that waits for its own master begins its ratio exactly there, whatever the system update: the servo
holds the move itself, and what is kept here only shows that it waits (AS bit 26).
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import ceil
from typing import TYPE_CHECKING

from emulator.controller.motion.following.cycles import CycleStart, position_since, travel_at
from emulator.engine import Signal
from emulator.engine.engine import FIRST_LASTING_WATCH

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_COMPARE: Mapping[str, Callable[[Decimal, Decimal], bool]] = {
    "=": operator.eq,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
_FROM_BELOW = frozenset({"=", ">", ">="})


@dataclass(slots=True)
class MasterPositionReached:
    """A master position of a slave axis, in counts from the beginning of a cycle."""

    axis_index: int
    sign: str
    counts: Decimal
    cycle: CycleStart

    def holds(self, controller: Controller) -> bool:
        """``sign`` may be = only until the start waits, then it is the side from which the position is approached."""
        return _COMPARE[self.sign](self._present(controller), self.counts)

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """The servo watches the master travel, in the slot of the axis that waits."""
        if self.sign == "=":
            self.sign = ">=" if self._present(controller) < self.counts else "<="
        threshold = travel_at(controller, self.axis_index, self.cycle, 0) + self.counts
        slot = FIRST_LASTING_WATCH + axis_index
        controller.engine.watch_value(slot, self.axis_index, Signal.MASTER, self.sign, float(threshold))

    def travel_ahead(self, controller: Controller, axis_index: int) -> int | None:
        """The master travel at which a slave's own start is to begin, if its master has yet to come there forwards."""
        if axis_index != self.axis_index or self.sign not in _FROM_BELOW or self._present(controller) >= self.counts:
            return None
        return travel_at(controller, axis_index, self.cycle, ceil(self.counts))

    def _present(self, controller: Controller) -> Decimal:
        return Decimal(position_since(controller, self.axis_index, self.cycle))

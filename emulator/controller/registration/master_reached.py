"""GOWHEN on PMAS: a master position to come, in this cycle or a later one.

The argument counts on from the cycle that is under way when GOWHEN is given: beyond FMCLEN lie the next ones (6000 PG
p. 238).  A slave that waits for its own master begins exactly there, between two updates, because the servo itself
holds the ratio move back; everything else begins at the update after.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.motion.following.cycles import CycleStart, cycle_start, travel_at
from emulator.controller.motion.following.ratio import master_counts
from emulator.engine import Signal
from emulator.engine.engine import FIRST_LASTING_WATCH

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

COMPARE = {"=": operator.eq, "<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge}
"""The relations GOWHEN knows."""

UPWARDS = frozenset({">", ">=", "="})


@dataclass(slots=True)
class MasterReached:
    """The master of an axis comes to a position; ``counts`` is in the cycle of ``since``."""

    axis_index: int
    sign: str
    counts: Decimal
    since: CycleStart

    def holds(self, controller: Controller) -> bool:
        """``=`` holds at the very count; a master beyond it comes by again only in the next cycle."""
        present, wanted = controller.engine.master_counts(self.axis_index), self._travel(controller)
        return COMPARE[self.sign](present, wanted)

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """The servo watches the master's travel, in the slot of the axis that waits."""
        if self.sign == "=":
            self.sign = ">="
            length = master_counts(controller.settings, "FMCLEN", self.axis_index)
            beyond = controller.engine.master_counts(self.axis_index) - self._travel(controller)
            if beyond > 0 and length > 0:
                self.counts += length * math.ceil(beyond / length)
        slot, wanted = FIRST_LASTING_WATCH + axis_index, float(self._travel(controller))
        controller.engine.watch_value(slot, self.axis_index, Signal.MASTER, self.sign, wanted)

    def begins_at(self, controller: Controller) -> int | None:
        """The first whole count of master travel at which it holds, for one that is to be reached from below."""
        if self.sign not in UPWARDS:
            return None
        wanted = self._travel(controller)
        return math.floor(wanted) + 1 if self.sign == ">" else math.ceil(wanted)

    def _travel(self, controller: Controller) -> Decimal:
        whole = math.floor(self.counts)
        return travel_at(controller, self.axis_index, self.since, whole) + self.counts - whole


def master_reached(controller: Controller, axis_index: int, sign: str, counts: Decimal) -> MasterReached:
    """The condition as GOWHEN gives it now."""
    return MasterReached(axis_index, sign, counts, cycle_start(controller, axis_index))

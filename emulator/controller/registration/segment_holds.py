"""GOWHEN and TRGFN between the GOBUFs of a compiled profile: the next segment waits as a GO would.

The condition is read at PCOMP; its time, its side of approach and its master cycle begin anew whenever the segment is
reached.  One that is true then already sets ER bit 14, as at a GO (assumed).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from emulator.controller.compiled.holds import SegmentHold, makes_holds
from emulator.controller.motion.following.cycles import cycle_start
from emulator.controller.registration import gowhen, trigger_functions
from emulator.controller.registration.gowhen import Condition
from emulator.controller.registration.master_reached import MasterReached

if TYPE_CHECKING:
    from emulator.controller.compiled.kinds import Compilation
    from emulator.controller.controller import Controller
    from protocol.command import Command


@dataclass(frozen=True, slots=True)
class ConditionHold:
    """GOWHEN before a segment."""

    condition: Condition

    def begin(self, controller: Controller, axis_index: int, release: Callable[[], None]) -> None:
        """The segment has been reached."""
        condition = copy(self.condition)
        if isinstance(condition, MasterReached):
            condition = replace(condition, since=cycle_start(controller, condition.axis_index))
        controller.held_starts.set_condition(axis_index, gowhen.NAME, condition)
        controller.held_starts.start((axis_index,), release)

    def cancel(self, controller: Controller, axis_index: int) -> None:
        """The profile was given up."""
        controller.held_starts.forget((axis_index,))


@dataclass(frozen=True, slots=True)
class TriggerHold:
    """TRGFN before a segment: it waits for the trigger if the first digit is 1, and a new master cycle begins with the
    trigger if the second is."""

    trigger_index: int
    digits: str

    def begin(self, controller: Controller, axis_index: int, release: Callable[[], None]) -> None:
        """The segment has been reached."""
        controller.trigger_functions.arm(self.trigger_index, axis_index, self.digits)
        controller.held_starts.start((axis_index,), release)

    def cancel(self, controller: Controller, axis_index: int) -> None:
        """The profile was given up."""
        controller.held_starts.forget((axis_index,))


@makes_holds(gowhen.NAME)
def gowhen_holds(compilation: Compilation, command: Command) -> Mapping[int, SegmentHold]:
    """GOWHEN in a profile."""
    conditions = gowhen.conditions_of(compilation.controller, command)
    return {axis_index: ConditionHold(condition) for axis_index, condition in conditions.items()}


@makes_holds(trigger_functions.NAME)
def trigger_holds(compilation: Compilation, command: Command) -> Mapping[int, SegmentHold]:
    """TRGFN in a profile."""
    trigger_index, digits, axes = trigger_functions.armed_by(compilation.controller, command)
    return {axis_index: TriggerHold(trigger_index, digits) for axis_index in axes}

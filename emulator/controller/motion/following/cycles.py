"""Master cycles: FMCLEN, FMCP, FMCNEW, and the master position that a WAIT compares.

The cycle position runs from 0 to FMCLEN like the minutes of a clock, the cycle number counts the hours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from emulator.controller.motion.following.assignment import has_master
from emulator.controller.motion.following.ratio import master_counts
from protocol.command import Command
from protocol.errors import FOLMAS_NOT_SPECIFIED, INCORRECT_DATA, CommandError
from protocol.fields import place_mask

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


@applies("FMCLEN")
def apply_cycle_length(controller: Controller, command: Command, changed: list[int]) -> None:
    """The length of the master cycle, 0 for one without end; it takes effect in the cycle under way (assumed)."""
    for axis_index in changed:
        controller.engine.set_master_cycle(axis_index, master_counts(controller.settings, "FMCLEN", axis_index))


@handles("FMCNEW")
def restart_cycle(controller: Controller, command: Command) -> Lines:
    """FMCNEW1: the master position is FMCP now and the cycle number 0.

    Raises:
        CommandError: FOLMAS NOT SPECIFIED where nothing is counted (assumed).
    """
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    lenient = controller.machine.lenient_masks
    placed = place_mask(command, controller.settings.axes_in_use, lenient=lenient)
    axes = [axis_index for axis_index, digit in enumerate(placed) if digit == "1"]
    if not all(has_master(controller, axis_index) for axis_index in axes):
        raise CommandError(FOLMAS_NOT_SPECIFIED)
    for axis_index in axes:
        controller.engine.restart_master_cycle(axis_index, master_counts(controller.settings, "FMCP", axis_index))
    return None


@dataclass(frozen=True, slots=True)
class CycleStart:
    """The master cycle that the master positions of a WAIT count from.

    ``zero`` is the master travel at which cycle 0 began; another one means that counting was restarted meanwhile.
    """

    number: int
    zero: int


def cycle_start(controller: Controller, axis_index: int) -> CycleStart:
    """The master cycle under way."""
    return CycleStart(controller.engine.master_cycle_number(axis_index), _zero(controller, axis_index))


def _zero(controller: Controller, axis_index: int) -> int:
    engine = controller.engine
    whole_cycles = engine.master_cycle_number(axis_index) * _cycle_length(controller, axis_index)
    return engine.master_counts(axis_index) - engine.master_position(axis_index) - whole_cycles


def _cycle_length(controller: Controller, axis_index: int) -> int:
    return master_counts(controller.settings, "FMCLEN", axis_index)


def travel_at(controller: Controller, axis_index: int, start: CycleStart, counts: int) -> int:
    """The master travel at which the position reaches ``counts``, counted on from the cycle of ``start``: beyond the
    cycle length lie the cycles after it."""
    zero = _zero(controller, axis_index)
    number = start.number if zero == start.zero else 0
    return zero + number * _cycle_length(controller, axis_index) + counts


def position_since(controller: Controller, axis_index: int, start: CycleStart) -> int:
    """The master position in counts, counted on from the cycle of ``start`` without rolling over."""
    return controller.engine.master_counts(axis_index) - travel_at(controller, axis_index, start, 0)

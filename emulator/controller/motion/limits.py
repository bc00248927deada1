"""End-of-travel limits: which are active, which lie in the way of a move, and their settings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from emulator.controller.faults import clear_without_cause
from protocol.command import Command
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

WATCH_NEGATIVE = 1
WATCH_POSITIVE = 2
"""LH and LS codes: 1 disables the positive direction, 2 the negative one, 3 has both ends watched (6K
configurations)."""


@dataclass(frozen=True, slots=True)
class LimitHit:
    """The limit in the way of a move: the AS bit it latches and the ER bit it sets."""

    axis_bit: AxisStatus
    error_bit: ErrorStatus


_HARD = {
    1: LimitHit(AxisStatus.POSITIVE_HARD_LIMIT_HIT, ErrorStatus.HARD_LIMIT_HIT),
    -1: LimitHit(AxisStatus.NEGATIVE_HARD_LIMIT_HIT, ErrorStatus.HARD_LIMIT_HIT),
}
_SOFT = {
    1: LimitHit(AxisStatus.POSITIVE_SOFT_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT),
    -1: LimitHit(AxisStatus.NEGATIVE_SOFT_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT),
}


def limit_in_the_way(controller: Controller, axis_index: int, direction: int) -> LimitHit | None:
    """The active limit that forbids motion in a direction (+1, -1; 0 never), hard before soft."""
    if direction == 0:
        return None
    watched = WATCH_POSITIVE if direction > 0 else WATCH_NEGATIVE
    settings = controller.settings
    if settings.integer("LH", axis_index) & watched and hard_limit_active(controller, axis_index, direction):
        return _HARD[direction]
    if settings.integer("LS", axis_index) & watched and _beyond_soft_limit(controller, axis_index, direction):
        return _SOFT[direction]
    return None


def hard_limit_active(controller: Controller, axis_index: int, direction: int) -> bool:
    """Whether the end-of-travel input of a direction is at its active level (LHLVL0: open)."""
    active_level = active_levels(controller, axis_index)[0 if direction > 0 else 1]
    return controller.wiring.limit_grounded(axis_index, direction) == bool(active_level)


def active_levels(controller: Controller, axis_index: int) -> tuple[int, int]:
    """LHLVL of the positive and negative end: 0 an open input is the limit, 1 a grounded one."""
    bits = controller.settings.bits("LHLVL")
    return int(bits[2 * axis_index]), int(bits[2 * axis_index + 1])


def _beyond_soft_limit(controller: Controller, axis_index: int, direction: int) -> bool:
    positive, negative = soft_limits(controller, axis_index)
    if positive == negative:
        return False
    commanded = controller.engine.commanded_position(axis_index)
    return commanded >= positive if direction > 0 else commanded <= negative


def soft_limits(controller: Controller, axis_index: int) -> tuple[int, int]:
    """LSPOS and LSNEG in whole counts."""
    counts = controller.settings.counts
    return int(counts("LSPOS", axis_index)), int(counts("LSNEG", axis_index))


@applies("LH", "LHLVL")
def apply_hard_limits(controller: Controller, command: Command, changed: list[int]) -> None:
    """LH, LHLVL changed; LH0 also clears what the limits had latched."""
    for axis_index in range(controller.settings.axes):
        enable = controller.settings.integer("LH", axis_index)
        positive, negative = active_levels(controller, axis_index)
        controller.engine.set_hard_limits(
            axis_index, enable=enable, positive_active_level=positive, negative_active_level=negative
        )
        if enable == 0:
            controller.engine.clear_status(axis_index, _HARD[1].axis_bit.mask | _HARD[-1].axis_bit.mask)
            clear_without_cause(controller, ErrorStatus.HARD_LIMIT_HIT)


@applies("LS", "LSPOS", "LSNEG")
def apply_soft_limits(controller: Controller, command: Command, changed: list[int]) -> None:
    """LS, LSPOS, LSNEG changed; LS0 also clears what the limits had latched."""
    for axis_index in changed:
        enable = controller.settings.integer("LS", axis_index)
        positive, negative = soft_limits(controller, axis_index)
        controller.engine.set_soft_limits(axis_index, enable=enable, positive=positive, negative=negative)
        if enable == 0:
            controller.engine.clear_status(axis_index, _SOFT[1].axis_bit.mask | _SOFT[-1].axis_bit.mask)
            clear_without_cause(controller, ErrorStatus.SOFT_LIMIT_HIT)

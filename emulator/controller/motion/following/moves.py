"""GO of a slave: a preset move over FOLMD of master travel, or a change of ratio over FOLMD that then goes on.

The ratio of a preset move starts and ends at 0.  A continuous one takes over the ratio the slave has, so FOLRN0 and GO
end it.  What GO refuses and when is assumed, but for the distance rule (Parker's knowledge base) and the greatest ratio
(6000 PG p.198).
"""

from __future__ import annotations

from enum import Enum, auto
from typing import TYPE_CHECKING

from emulator.controller.motion.following.assignment import at_ratio, in_ratio_move
from emulator.controller.motion.following.ratio import master_counts, ratio_in_force
from emulator.controller.motion.targets import preset_target
from emulator.engine import DistanceMismatch, RatioSegments, plan_ratio_change, plan_ratio_preset
from protocol.errors import (
    MASTER_SLAVE_DISTANCE_MISMATCH,
    MOTION_IN_PROGRESS,
    NOT_VALID_DURING_FOLLOWING_MOTION,
    NOT_VALID_DURING_RAMP,
    CommandError,
)
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class RatioMove(Enum):
    """What kind of ratio move a slave began last."""

    CONTINUOUS = auto()
    PRESET = auto()
    ADVANCE = auto()
    """A continuous move with a geared advance on top."""


class RatioMoves:
    """The ratio move each axis of a unit began last; it says something only while the servo reports a ratio move."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.reset()

    def reset(self) -> None:
        """Power-up."""
        self._begun = [RatioMove.CONTINUOUS] * self._controller.settings.axes

    def note(self, axis_index: int, move: RatioMove) -> None:
        """A ratio move begins."""
        self._begun[axis_index] = move

    def preset(self, axis_index: int) -> bool:
        """Whether a ratio move that has an end of its own is under way."""
        return self._begun[axis_index] is RatioMove.PRESET and in_ratio_move(self._controller, axis_index)

    def advancing(self, axis_index: int) -> bool:
        """Whether a geared advance is under way (TFS bit 24): the last piece of its move is the ratio it ends at."""
        if self._begun[axis_index] is not RatioMove.ADVANCE or not in_ratio_move(self._controller, axis_index):
            return False
        return self._controller.engine.ratio_pieces_left(axis_index) > 0


def check_go(controller: Controller, axis_index: int) -> None:
    """Refuse a GO of a slave that cannot be carried out.

    Raises:
        CommandError: MOTION IN PROGRESS (a move in time), NOT VALID DURING RAMP, NOT VALID DURING FOLLOWING MOTION (a
            preset move or a shift is under way, or a preset one is wanted of a slave that has a ratio), INVALID RATIO,
            MASTER SLAVE DISTANCE MISMATCH.
    """
    if in_ratio_move(controller, axis_index):
        _check_under_way(controller, axis_index)
    elif controller.engine.is_moving(axis_index):
        shifting = controller.engine.following_status(axis_index) & FollowingStatus.SHIFTING.mask
        raise CommandError(NOT_VALID_DURING_FOLLOWING_MOTION if shifting else MOTION_IN_PROGRESS)
    plan_move(controller, axis_index)


def _check_under_way(controller: Controller, axis_index: int) -> None:
    status = controller.engine.following_status(axis_index)
    preset = not controller.settings.flag("MC", axis_index) or controller.ratio_moves.preset(axis_index)
    if status & FollowingStatus.RATIO_CHANGING.mask:
        raise CommandError(NOT_VALID_DURING_RAMP)
    if preset or status & FollowingStatus.SHIFTING.mask or controller.ratio_moves.advancing(axis_index):
        raise CommandError(NOT_VALID_DURING_FOLLOWING_MOTION)
    if not at_ratio(controller, axis_index):
        raise CommandError(NOT_VALID_DURING_RAMP)


def plan_move(controller: Controller, axis_index: int) -> RatioSegments:
    """The ratio over master travel that GO would start now; none where there is nothing to do.

    Raises:
        CommandError: INVALID RATIO, MASTER SLAVE DISTANCE MISMATCH.
    """
    settings, engine = controller.settings, controller.engine
    ratio = ratio_in_force(settings, axis_index)
    master = master_counts(settings, "FOLMD", axis_index)
    if settings.flag("MC", axis_index):
        goal = ratio if settings.counts("D", axis_index) >= 0 else -ratio
        return plan_ratio_change(engine.following_ratio(axis_index), goal, master)
    distance = preset_target(controller, axis_index) - engine.commanded_position(axis_index)
    try:
        return plan_ratio_preset(distance, master, ratio)
    except DistanceMismatch:
        raise CommandError(MASTER_SLAVE_DISTANCE_MISMATCH) from None


def direction(controller: Controller, axis_index: int) -> int:
    """Which way GO would move the slave: +1, -1; 0 if it would not, or if only the master's direction will tell."""
    engine = controller.engine
    segments = plan_move(controller, axis_index)
    if not segments:
        return 0
    ratio = segments[-1].end_ratio or segments[0].end_ratio
    sign = 1 if ratio > 0 else -1
    if not controller.settings.flag("MC", axis_index):
        return sign
    status = engine.following_status(axis_index)
    if not status & FollowingStatus.MASTER_MOVING.mask:
        return 0
    return -sign if status & FollowingStatus.MASTER_DIRECTION_NEGATIVE.mask else sign


def start_move(controller: Controller, axis_index: int, *, start_at: int | None = None) -> None:
    """Start the ratio move that ``check_go`` has allowed; ``start_at`` is a master travel still to come (GOWHEN)."""
    segments = plan_move(controller, axis_index)
    preset = not controller.settings.flag("MC", axis_index)
    if segments or in_ratio_move(controller, axis_index):
        controller.ratio_moves.note(axis_index, RatioMove.PRESET if preset else RatioMove.CONTINUOUS)
        controller.engine.start_following(axis_index, segments, preset=preset, start_at=start_at)

"""What a GO with slaves among its axes holds the command buffer for (COMEXC0).

A preset Following move holds it to its end like any other.  A continuous one has no end of its own: it holds the buffer
while its ratio changes, so that what comes next finds the slave at its ratio.  With the master at rest it holds
nothing, because the commands that follow may be what sets the master going (all assumed M).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.motion.following.assignment import at_ratio, in_ratio_move, is_following
from emulator.controller.waits import MotionWait
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_WATCHED = (
    FollowingStatus.SLAVE_IN_RATIO_MOVE.mask
    | FollowingStatus.RATIO_CHANGING.mask
    | FollowingStatus.AT_RATIO.mask
    | FollowingStatus.MASTER_MOVING.mask
    | FollowingStatus.SHIFTING.mask
)


@dataclass(frozen=True, slots=True)
class FollowingWait(MotionWait):
    """Until ``axes`` are at rest, the ratio of ``slaves`` has changed and the shift of ``shifting`` is over."""

    slaves: tuple[int, ...] = ()
    shifting: tuple[int, ...] = ()

    def over(self, controller: Controller) -> bool:
        engine = controller.engine
        # the plain form of super() does not survive a dataclass with slots
        ended = MotionWait.over(self, controller)
        shifting = any(
            engine.following_status(axis) & FollowingStatus.SHIFTING.mask or controller.held_starts.holds(axis)
            for axis in self.shifting
        )
        if ended and not shifting and not any(_changes(controller, axis) for axis in self.slaves):
            return True
        for axis_index in (*self.slaves, *self.shifting):
            engine.watch_following(axis_index, _WATCHED)
            if controller.ratio_moves.advancing(axis_index):
                controller.alarms.at(engine.next_system_update_ns, _look_again)
        return False


def _changes(controller: Controller, axis_index: int) -> bool:
    """Whether a slave's move has not been taken up by a system update, a moving master is changing its ratio, or it has
    come to rest and is not yet in its zone."""
    engine = controller.engine
    status = engine.following_status(axis_index)
    if controller.held_starts.holds(axis_index):
        return bool(status & FollowingStatus.MASTER_MOVING.mask)
    if not in_ratio_move(controller, axis_index):
        return engine.is_settling(axis_index)
    if not status & (FollowingStatus.RATIO_CHANGING.mask | FollowingStatus.AT_RATIO.mask):
        return True
    on_its_way = not at_ratio(controller, axis_index) or controller.ratio_moves.advancing(axis_index)
    return on_its_way and bool(status & FollowingStatus.MASTER_MOVING.mask)


def _look_again() -> None:
    """The alarm alone makes the unit look: no status bit tells the end of an advance that has no ramps."""


def motion_wait(controller: Controller, axes: Sequence[int]) -> MotionWait:
    """What a GO of these axes waits for."""
    slaves = tuple(axis for axis in axes if is_following(controller, axis) and controller.settings.flag("MC", axis))
    if not slaves:
        return MotionWait(tuple(axes))
    return FollowingWait(tuple(axis for axis in axes if axis not in slaves), slaves=slaves)

"""What a GO with slaves among its axes holds the command buffer for (COMEXC0).

A preset Following move holds it to its end like any other.  A continuous one has no end of its own: it holds the buffer
while its ratio changes, so that what comes next finds the slave at its ratio.  With the master at rest it holds
nothing, because the commands that follow may be what sets the master going (all assumed M).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.motion.following.assignment import is_following
from emulator.controller.waits import MotionWait
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_RAMP_UNDER_WAY = FollowingStatus.RATIO_CHANGING.mask | FollowingStatus.MASTER_MOVING.mask


@dataclass(frozen=True, slots=True)
class FollowingWait(MotionWait):
    """Until ``axes`` are at rest, the ratio of ``slaves`` has changed and the shift of ``shifting`` is over."""

    slaves: tuple[int, ...] = ()
    shifting: tuple[int, ...] = ()

    def over(self, controller: Controller) -> bool:
        engine = controller.engine
        # the plain form of super() does not survive a dataclass with slots
        ended = MotionWait.over(self, controller)
        ramping = any(engine.following_status(axis) & _RAMP_UNDER_WAY == _RAMP_UNDER_WAY for axis in self.slaves)
        settling = any(engine.is_settling(axis) for axis in self.slaves)
        shifting = any(engine.following_status(axis) & FollowingStatus.SHIFTING.mask for axis in self.shifting)
        if ended and not (ramping or settling or shifting):
            return True
        for axis_index in self.slaves:
            engine.watch_following(axis_index, _RAMP_UNDER_WAY)
        for axis_index in self.shifting:
            engine.watch_following(axis_index, FollowingStatus.SHIFTING.mask)
        return False


def motion_wait(controller: Controller, axes: Sequence[int]) -> MotionWait:
    """What a GO of these axes waits for."""
    slaves = tuple(axis for axis in axes if is_following(controller, axis) and controller.settings.flag("MC", axis))
    if not slaves:
        return MotionWait(tuple(axes))
    return FollowingWait(tuple(axis for axis in axes if axis not in slaves), slaves=slaves)

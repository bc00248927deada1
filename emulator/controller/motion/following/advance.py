"""FGADV, the geared advance: a slave at constant ratio gains or loses a distance while its master travels FOLMD.

The ratio that the advance adds has the geometry of a preset move, FOLRN/FOLRD being its ceiling; the sum is one ratio
over master travel and ends at the ratio the slave had (6K See Also lists for its existence; all of it assumed M).
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.following.assignment import at_ratio, in_ratio_move, is_following
from emulator.controller.motion.following.fields import given_counts
from emulator.controller.motion.following.go_wait import FollowingWait
from emulator.controller.motion.following.moves import RatioMove
from emulator.controller.motion.following.ratio import master_counts, ratio_in_force
from emulator.controller.motion.go import check_ready
from emulator.engine import DistanceMismatch, RatioSegment, RatioSegments, plan_ratio_preset
from protocol.command import Command
from protocol.errors import (
    INVALID_CONDITIONS,
    MASTER_SLAVE_DISTANCE_MISMATCH,
    NOT_VALID_DURING_FOLLOWING_MOTION,
    NOT_VALID_DURING_RAMP,
    CommandError,
)
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def advance_refusal(controller: Controller, axis_index: int) -> str:
    """Why a geared advance may not begin now, as the unit says it; empty where it may (TFS bit 23)."""
    status = controller.engine.following_status(axis_index)
    if not (is_following(controller, axis_index) and in_ratio_move(controller, axis_index)):
        return INVALID_CONDITIONS
    if status & FollowingStatus.RATIO_CHANGING.mask:
        return NOT_VALID_DURING_RAMP
    moves = controller.ratio_moves
    if moves.preset(axis_index) or moves.advancing(axis_index) or status & FollowingStatus.SHIFTING.mask:
        return NOT_VALID_DURING_FOLLOWING_MOTION
    return "" if at_ratio(controller, axis_index) else NOT_VALID_DURING_RAMP


def plan_advance(base: Fraction, advance: RatioSegments) -> RatioSegments:
    """An advance on top of a constant ratio, and the ratio going on after it."""
    raised = [RatioSegment(part.master, base + part.start_ratio, base + part.end_ratio) for part in advance]
    return (*raised, RatioSegment(None, base, base))


@handles("FGADV")
def advance(controller: Controller, command: Command) -> Lines:
    """FGADV: advance (or with a negative distance retard) slaves; COMEXC0 holds the buffer as a change of ratio does.

    Raises:
        CommandError: what FS bit 23 excludes, INVALID RATIO, MASTER SLAVE DISTANCE MISMATCH.
    """
    given = given_counts(controller, command)
    plans = {axis_index: _plan(controller, axis_index, counts) for axis_index, counts in given.items()}
    for axis_index, segments in plans.items():
        if given[axis_index]:
            controller.ratio_moves.note(axis_index, RatioMove.ADVANCE)
            controller.engine.start_following(axis_index, segments, preset=False)
    if not controller.settings.flag("COMEXC"):
        controller.interpreter.wait_for(FollowingWait((), slaves=tuple(given)))
    return None


def _plan(controller: Controller, axis_index: int, counts: int) -> RatioSegments:
    check_ready(controller, (axis_index,))
    refusal = advance_refusal(controller, axis_index)
    if refusal:
        raise CommandError(refusal)
    base = controller.engine.following_ratio(axis_index)
    ceiling = ratio_in_force(controller.settings, axis_index)
    master = master_counts(controller.settings, "FOLMD", axis_index)
    status = controller.engine.following_status(axis_index)
    # A continuous move is mirrored while its master counts down, the advance must not be.
    backwards = -1 if status & FollowingStatus.MASTER_DIRECTION_NEGATIVE.mask else 1
    try:
        return plan_advance(base, plan_ratio_preset(backwards * counts, master, ceiling))
    except DistanceMismatch:
        raise CommandError(MASTER_SLAVE_DISTANCE_MISMATCH) from None

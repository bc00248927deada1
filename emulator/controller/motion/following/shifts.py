"""Phase shifts: FSHFC and FSHFD move a slave in time, by V, A and AD, on top of what its master asks of it.

They need TFS bit 9: Following enabled, no ramp, no preset move, no preset shift under way; the master may stand still
(Gem6K PG p.188; the exact condition, and everything about what is refused how, assumed M).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from enum import IntEnum
from functools import partial
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.following.assignment import at_ratio, in_ratio_move, is_following
from emulator.controller.motion.following.fields import given_counts, given_numbers
from emulator.controller.motion.following.go_wait import FollowingWait
from emulator.controller.motion.go import allow_motion, check_ready, check_s_curve, ramps, stop_segments
from emulator.engine import Segments, TargetOvershot, plan_continuous, plan_preset
from protocol.command import Command
from protocol.errors import (
    INVALID_CONDITIONS,
    MOTION_IN_PROGRESS,
    NOT_VALID_DURING_FOLLOWING_MOTION,
    NOT_VALID_DURING_RAMP,
    CommandError,
)
from protocol.status import AxisStatus, ErrorStatus, FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class ContinuousShift(IntEnum):
    """The field of FSHFC."""

    STOP = 0
    POSITIVE = 1
    NEGATIVE = 2
    KILL = 3


def shift_refusal(controller: Controller, axis_index: int) -> str:
    """Why a shift may not begin now, as the unit says it; empty where it may (TFS bit 9)."""
    status = controller.engine.following_status(axis_index)
    preset_shift = status & FollowingStatus.SHIFTING.mask and not status & FollowingStatus.SHIFT_CONTINUOUS.mask
    moves_in_time = controller.engine.is_moving(axis_index) and not (
        in_ratio_move(controller, axis_index) or status & FollowingStatus.SHIFTING.mask
    )
    if not is_following(controller, axis_index):
        return INVALID_CONDITIONS
    if moves_in_time:
        return MOTION_IN_PROGRESS
    if status & FollowingStatus.RATIO_CHANGING.mask:
        return NOT_VALID_DURING_RAMP
    moves = controller.ratio_moves
    if preset_shift or moves.preset(axis_index) or moves.advancing(axis_index):
        return NOT_VALID_DURING_FOLLOWING_MOTION
    if in_ratio_move(controller, axis_index) and not at_ratio(controller, axis_index):
        return NOT_VALID_DURING_RAMP
    return ""


def _check_shift(controller: Controller, axis_index: int) -> None:
    check_ready(controller, (axis_index,))
    refusal = shift_refusal(controller, axis_index)
    if refusal:
        raise CommandError(refusal)
    check_s_curve(controller, axis_index)


def _if_legal(controller: Controller, axis_index: int, shift: Callable[[], None]) -> None:
    """A shift that is no longer legal when what it was held for comes does not begin (assumed)."""
    with suppress(CommandError):
        _check_shift(controller, axis_index)
        shift()


@handles("FSHFC")
def shift_continuously(controller: Controller, command: Command) -> Lines:
    """FSHFC: 1 and 2 shift on and on in the positive and negative direction, 0 stops the shift, 3 kills it.

    Stopping where nothing shifts is no error (assumed).
    """
    given = {index: ContinuousShift(int(value)) for index, value in given_numbers(controller, command).items()}
    for axis_index, shift in given.items():
        if shift in (ContinuousShift.POSITIVE, ContinuousShift.NEGATIVE):
            _check_shift(controller, axis_index)
    for axis_index, shift in given.items():
        if shift is ContinuousShift.KILL:
            controller.engine.cancel_shift(axis_index)
        elif shift is ContinuousShift.STOP:
            _stop_shift(controller, axis_index)
        else:
            direction = 1 if shift is ContinuousShift.POSITIVE else -1
            controller.held_starts.start(
                (axis_index,),
                partial(_if_legal, controller, axis_index, partial(_run_on, controller, axis_index, direction)),
            )
    return None


def _run_on(controller: Controller, axis_index: int, direction: int) -> None:
    velocity = direction * float(controller.settings.counts("V", axis_index))
    state = controller.engine.shift_state(axis_index)
    segments = plan_continuous(state.position, state.velocity, velocity, *ramps(controller, axis_index))
    _begin(controller, axis_index, segments, direction, continuous=True)


def _stop_shift(controller: Controller, axis_index: int) -> None:
    engine = controller.engine
    status = engine.following_status(axis_index)
    if status & FollowingStatus.SHIFTING.mask:
        continuous = bool(status & FollowingStatus.SHIFT_CONTINUOUS.mask)
        engine.start_shift(axis_index, _braking(controller, axis_index), continuous=continuous)


def _braking(controller: Controller, axis_index: int) -> Segments:
    return stop_segments(controller, axis_index, "AD", controller.engine.shift_state(axis_index))


def _begin(
    controller: Controller, axis_index: int, segments: Segments, direction: int, *, continuous: bool = False
) -> None:
    """Start a shift; at rest nothing moves into an active limit."""
    resting = controller.engine.commanded_velocity(axis_index) == 0.0
    if (
        segments
        and not shift_refusal(controller, axis_index)
        and allow_motion(controller, axis_index, direction if resting else 0)
    ):
        controller.engine.start_shift(axis_index, segments, continuous=continuous)


@handles("FSHFD")
def shift_by_distance(controller: Controller, command: Command) -> Lines:
    """FSHFD: shift by a slave distance; with COMEXC0 the buffer is held until it is done (assumed)."""
    given = given_counts(controller, command)
    for axis_index in given:
        _check_shift(controller, axis_index)
    for axis_index, counts in given.items():
        controller.held_starts.start(
            (axis_index,),
            partial(_if_legal, controller, axis_index, partial(_shift_by, controller, axis_index, counts)),
        )
    if not controller.settings.flag("COMEXC"):
        controller.interpreter.wait_for(FollowingWait((), shifting=tuple(given)))
    return None


def _shift_by(controller: Controller, axis_index: int, counts: int) -> None:
    """A preset shift; one that cannot stop in its distance stops and is told as a move's (AS 30, ER 10)."""
    velocity = float(controller.settings.counts("V", axis_index))
    state = controller.engine.shift_state(axis_index)
    if counts == 0 or velocity == 0:
        return
    direction = 1 if counts > 0 else -1
    try:
        segments = plan_preset(
            state.position, state.velocity, state.position + counts, velocity, *ramps(controller, axis_index)
        )
    except TargetOvershot:
        controller.engine.latch_status(axis_index, AxisStatus.PRESET_MOVE_OVERSHOT.mask)
        controller.faults.latch(ErrorStatus.PRESET_MOVE_OVERSHOT)
        segments = _braking(controller, axis_index)
    _begin(controller, axis_index, segments, direction)

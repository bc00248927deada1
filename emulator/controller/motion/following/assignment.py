"""Who follows whom: FOLMAS and FOLEN, and what a change of feedback source does to them.

An axis is a slave as soon as FOLMAS names its master: from then on the master is counted.  FOLEN1 makes its next GO a
Following move.  FOLMAS0 takes the axis out of Following altogether, FOLEN included, because FOLEN1 without a master is
refused anyway (assumed).
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles, store_setting
from emulator.controller.motion.following.ratio import master_counts
from emulator.engine import MasterSource
from protocol.command import Command, FieldValue
from protocol.errors import (
    FOLMAS_NOT_SPECIFIED,
    INCORRECT_DATA,
    INVALID_CONDITIONS,
    MOTION_IN_PROGRESS,
    NOT_VALID_DURING_FOLLOWING_MOTION,
    CommandError,
)
from protocol.fields import Range, checked_number, place_mask, place_values
from protocol.masters import Master, MasterKind, check_masters, read_master
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

_SOURCES = {
    MasterKind.ENCODER: MasterSource.ENCODER,
    MasterKind.ANI: MasterSource.ANI,
    MasterKind.COMMANDED: MasterSource.COMMANDED,
}
_ANY_NUMBER = Range(None, None, 0)


def has_master(controller: Controller, axis_index: int) -> bool:
    """Whether FOLMAS makes the axis a slave."""
    return controller.settings.integer("FOLMAS", axis_index) != 0


def master_of(controller: Controller, axis_index: int) -> Master | None:
    """The master of an axis; None for an axis that is no slave."""
    return _master(controller, controller.settings.integer("FOLMAS", axis_index))


def is_following(controller: Controller, axis_index: int) -> bool:
    """Whether the axis's moves are Following moves (FOLEN1)."""
    return controller.settings.flag("FOLEN", axis_index)


def in_ratio_move(controller: Controller, axis_index: int) -> bool:
    """Whether a Following move is under way, waiting for its master included."""
    return bool(controller.engine.following_status(axis_index) & FollowingStatus.SLAVE_IN_RATIO_MOVE.mask)


def at_ratio(controller: Controller, axis_index: int) -> bool:
    """Whether the slave is at a constant ratio; not before its move has been taken up by a system update."""
    status = controller.engine.following_status(axis_index)
    return bool(status & FollowingStatus.AT_RATIO.mask) and not status & FollowingStatus.RATIO_CHANGING.mask


def _master(controller: Controller, value: int) -> Master | None:
    return read_master(value, axes=controller.settings.axes, ani_fitted=controller.machine.options.ani)


@handles("FOLMAS")
def assign_masters(controller: Controller, command: Command) -> Lines:
    """FOLMAS: axes given a field become slaves, or with 0 are slaves no longer; they have to be at rest.

    Raises:
        CommandError: MOTION IN PROGRESS, INVALID FOLMAS SPECIFIED.
    """
    if command.is_query:
        return controller.settings.report(command)
    settings = controller.settings
    wanted = [settings.integer("FOLMAS", axis_index) for axis_index in range(settings.axes)]
    given = _given_numbers(place_values(command, settings.axes_in_use))
    if any(controller.engine.is_moving(axis_index) for axis_index in given):
        raise CommandError(MOTION_IN_PROGRESS)
    for axis_index, value in given.items():
        wanted[axis_index] = value
    check_masters([_master(controller, value) for value in wanted], _feedback(controller))
    apply_masters(controller, command, settings.assign(command))
    return None


def _given_numbers(placed: Sequence[FieldValue]) -> dict[int, int]:
    """The fields that hold a number, by axis index, truncated."""
    return {
        index: int(checked_number(value, _ANY_NUMBER, field=index + 1, fields=len(placed)))
        for index, value in enumerate(placed)
        if value is not None
    }


def _feedback(controller: Controller) -> list[int]:
    return [controller.settings.integer("SFB", axis_index) for axis_index in range(controller.settings.axes)]


@applies("FOLMAS")
def apply_masters(controller: Controller, command: Command, changed: list[int]) -> None:
    """Have the servo count the masters; counting of master cycles begins anew at FMCP (assumed)."""
    for axis_index in changed:
        master = master_of(controller, axis_index)
        if master is None:
            controller.engine.set_master(axis_index, source=MasterSource.NONE, master_index=axis_index, sign=1)
            _switch(controller, axis_index, on=False)
        else:
            source = _SOURCES[master.kind]
            controller.engine.set_master(axis_index, source=source, master_index=master.axis_index, sign=master.sign)
            controller.engine.restart_master_cycle(axis_index, master_counts(controller.settings, "FMCP", axis_index))


def _switch(controller: Controller, axis_index: int, *, on: bool) -> None:
    bits = list(controller.settings.bits("FOLEN"))
    bits[axis_index] = "1" if on else "0"
    controller.settings.store_bits("FOLEN", "".join(bits))


@handles("FOLEN")
def enable_following(controller: Controller, command: Command) -> Lines:
    """FOLEN: 1 makes the next GO a Following move, 0 one in time; what changes has to be at rest.

    Raises:
        CommandError: FOLMAS NOT SPECIFIED, MOTION IN PROGRESS, NOT VALID DURING FOLLOWING MOTION.
    """
    if command.is_query:
        return controller.settings.report(command)
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    lenient = controller.machine.lenient_masks
    placed = place_mask(command, controller.settings.axes_in_use, lenient=lenient)
    wanted = {axis_index: digit == "1" for axis_index, digit in enumerate(placed) if digit != "X"}
    for axis_index, on in wanted.items():
        if on and not has_master(controller, axis_index):
            raise CommandError(FOLMAS_NOT_SPECIFIED)
        if on != is_following(controller, axis_index):
            _require_rest(controller, axis_index)
    for axis_index, on in wanted.items():
        _switch(controller, axis_index, on=on)
    return None


def _require_rest(controller: Controller, axis_index: int) -> None:
    if in_ratio_move(controller, axis_index):
        raise CommandError(NOT_VALID_DURING_FOLLOWING_MOTION)
    if controller.engine.is_moving(axis_index):
        raise CommandError(MOTION_IN_PROGRESS)


@handles("SFB")
def select_feedback(controller: Controller, command: Command) -> Lines:
    """SFB: refused where an axis would get a feedback that it follows as a slave (text assumed).

    Raises:
        CommandError: INVALID CONDITIONS FOR COMMAND, and what the setting itself refuses.
    """
    if command.is_query:
        return controller.settings.report(command)
    feedback = _feedback(controller)
    for axis_index, value in enumerate(place_values(command, controller.settings.axes_in_use)):
        if isinstance(value, Decimal):
            feedback[axis_index] = int(value)
    wanted = [controller.settings.integer("FOLMAS", axis_index) for axis_index in range(controller.settings.axes)]
    try:
        check_masters([_master(controller, value) for value in wanted], feedback)
    except CommandError:
        raise CommandError(INVALID_CONDITIONS) from None
    store_setting(controller, command)
    return None

"""Starting motion: GO reads A, AA, AD, ADA, V, D, MA and MC as they stand and starts the profile they make."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from decimal import ROUND_DOWN, Decimal
from functools import partial
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles, require_rest
from emulator.controller.faults import CLEARED_BY_GO, clear_without_cause
from emulator.controller.motion.following import moves
from emulator.controller.motion.following.assignment import is_following
from emulator.controller.motion.following.go_wait import motion_wait
from emulator.controller.motion.limits import limit_in_the_way
from emulator.controller.motion.targets import preset_target
from emulator.engine import Segments, State, TargetOvershot, plan_continuous, plan_preset, plan_stop
from protocol.command import Command
from protocol.errors import (
    DRIVE_SHUTDOWN,
    ENABLE_INPUT_INACTIVE,
    INCORRECT_DATA,
    MOTION_IN_PROGRESS,
    NOT_ALLOWED_IF_SFB0,
    CommandError,
    s_curve_acceleration,
    s_curve_deceleration,
)
from protocol.fields import axis_indexes, checked_number, place_mask, place_values
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

OPEN_LOOP = 0

CLEARED_BY_LEGAL_GO = (
    AxisStatus.POSITIVE_HARD_LIMIT_HIT.mask
    | AxisStatus.NEGATIVE_HARD_LIMIT_HIT.mask
    | AxisStatus.POSITIVE_SOFT_LIMIT_HIT.mask
    | AxisStatus.NEGATIVE_SOFT_LIMIT_HIT.mask
    | AxisStatus.TARGET_ZONE_TIMEOUT.mask
    | AxisStatus.PRESET_MOVE_OVERSHOT.mask
)
"""AS bits that the next legal GO clears (assumed M)."""


@handles("GO")
def go(controller: Controller, command: Command) -> Lines:
    """GO: start the loaded profile on the axes named, or on all whose drive is on."""
    axes = _axes_to_start(controller, command)
    controller.held_starts.withdraw(axes)
    for axis_index in axes:
        check_move(controller, axis_index)
    controller.faults.clear(CLEARED_BY_GO)
    for axis_index in axes:
        begin_at = _begin_at(controller, axis_index) if is_following(controller, axis_index) else None
        controller.held_starts.start((axis_index,), partial(start, controller, axis_index), begin_at=begin_at)
    if not controller.settings.flag("COMEXC") and axes:
        controller.interpreter.wait_for(motion_wait(controller, axes))
    return None


def _begin_at(controller: Controller, axis_index: int) -> Callable[[int], None]:
    """What starts a slave where its master comes to a position."""
    return lambda master_travel: start(controller, axis_index, at_master=master_travel)


def check_move(controller: Controller, axis_index: int) -> None:
    """Refuse a move that the settings of its axis do not make, in time (A, AD ...) or by its master (FOLRN ...).

    Raises:
        CommandError: INVALID CONDITIONS FOR S_CURVE ..., and what ``following.moves.check_go`` refuses.
    """
    if is_following(controller, axis_index):
        moves.check_go(controller, axis_index)
    else:
        check_s_curve(controller, axis_index)


def _axes_to_start(controller: Controller, command: Command) -> list[int]:
    """The axes a GO starts.

    Raises:
        CommandError: ENABLE open, a named axis shut down, none to start, or an axis in open loop.
    """
    named = named_axes(controller, command)
    if not controller.wiring.enable_grounded:
        raise CommandError(ENABLE_INPUT_INACTIVE)
    candidates = range(controller.settings.axes_in_use) if named is None else named
    enabled = [axis_index for axis_index in candidates if controller.engine.is_enabled(axis_index)]
    if candidates and not enabled:
        raise CommandError(DRIVE_SHUTDOWN)
    check_ready(controller, enabled if named is None else named)
    return enabled


def check_ready(controller: Controller, axes: Iterable[int]) -> None:
    """Refuse to start axes that cannot move, or that homing, jogging, the joystick, a path or a compiled profile moves
    already.

    Raises:
        CommandError: ENABLE open, drive shut down, open loop, MOTION IN PROGRESS (for the jog and joystick modes
            assumed: a C host of 6K units saw it with the joystick on; for paths assumed).
    """
    if not controller.wiring.enable_grounded:
        raise CommandError(ENABLE_INPUT_INACTIVE)
    for axis_index in axes:
        if not controller.engine.is_enabled(axis_index):
            raise CommandError(DRIVE_SHUTDOWN)
        if controller.settings.integer("SFB", axis_index) == OPEN_LOOP:
            raise CommandError(NOT_ALLOWED_IF_SFB0)
        by_hand = controller.settings.flag("JOG", axis_index) or controller.settings.flag("JOY", axis_index)
        by_others = controller.paths.carries(axis_index) or controller.compiled.moves(axis_index)
        if by_hand or by_others or controller.homing.active(axis_index):
            raise CommandError(MOTION_IN_PROGRESS)


def named_axes(controller: Controller, command: Command) -> list[int] | None:
    """The axes that a mask or prefix names; None for a bare command, which means all."""
    axes = controller.settings.axes_in_use
    if command.mask:
        lenient = controller.machine.lenient_masks
        return [index for index, digit in enumerate(place_mask(command, axes, lenient=lenient)) if digit == "1"]
    if command.argument:
        raise CommandError(INCORRECT_DATA)
    if command.axis is not None:
        return list(axis_indexes(command, axes))
    return None


def check_s_curve(controller: Controller, axis_index: int, family: str = "") -> None:
    """A/2 <= AA <= A and the same for the deceleration, checked at GO and never before (a host sets them one by one).

    ``family`` names the ramps: HOM for HOMA, HOMAA ..., JOG, JOY, or none for A, AA ...

    Raises:
        CommandError: INVALID CONDITIONS FOR S_CURVE ...
    """
    settings = controller.settings
    maximum, average = settings.counts(f"{family}A", axis_index), settings.counts(f"{family}AA", axis_index)
    if not maximum <= 2 * average <= 2 * maximum:
        raise s_curve_acceleration(axis_index + 1)
    maximum, average = settings.counts(f"{family}AD", axis_index), settings.counts(f"{family}ADA", axis_index)
    if not maximum <= 2 * average <= 2 * maximum:
        raise s_curve_deceleration(axis_index + 1)


def start(controller: Controller, axis_index: int, *, at_master: int | None = None) -> None:
    """Start one axis, moving or not: nothing moves into an active limit; a preset move that cannot be had from the
    present motion leaves that as it is, with AS bit 30 and ER bit 10 (assumed M).

    ``at_master`` is a master position to come, at which a slave is to begin.  A move that was legal when it was
    commanded and is no longer when what it waited for comes does not start (assumed).
    """
    with suppress(CommandError):
        if is_following(controller, axis_index):
            _start_following(controller, axis_index, at_master)
        else:
            check_s_curve(controller, axis_index)
            _start_in_time(controller, axis_index)


def _start_in_time(controller: Controller, axis_index: int) -> None:
    direction = _direction(controller, axis_index)
    segments: Segments = ()
    if limit_in_the_way(controller, axis_index, direction) is None:
        try:
            segments = _profile(controller, axis_index, direction)
        except TargetOvershot:
            controller.engine.latch_status(axis_index, AxisStatus.PRESET_MOVE_OVERSHOT.mask)
            controller.faults.latch(ErrorStatus.PRESET_MOVE_OVERSHOT)
            return
    if allow_motion(controller, axis_index, direction) and segments:
        controller.registration.watch(axis_index)
        controller.engine.start_profile(axis_index, segments)


def _start_following(controller: Controller, axis_index: int, at_master: int | None) -> None:
    if allow_motion(controller, axis_index, moves.direction(controller, axis_index)):
        moves.start_move(controller, axis_index, start_at=at_master)


def _direction(controller: Controller, axis_index: int) -> int:
    """Which way a move in time would go: +1, -1, or 0 for no move."""
    if not controller.settings.flag("MC", axis_index):
        distance = preset_target(controller, axis_index) - controller.engine.profile_state(axis_index).position
        return (distance > 0) - (distance < 0)
    if controller.settings.counts("V", axis_index) == 0:
        return 0
    return 1 if controller.settings.counts("D", axis_index) >= 0 else -1


def allow_motion(controller: Controller, axis_index: int, direction: int) -> bool:
    """Whether no active limit lies in a direction: then what earlier moves have left in AS and ER is cleared.

    Otherwise the limit is latched, AS 15 to 18 and ER 2 or 3.
    """
    if held_by_limit(controller, axis_index, direction):
        return False
    forget_refusals(controller, axis_index)
    return True


def held_by_limit(controller: Controller, axis_index: int, direction: int) -> bool:
    """Whether a limit forbids to set out in a direction; if so its AS and ER bits are set."""
    hit = limit_in_the_way(controller, axis_index, direction)
    if hit is not None:
        controller.engine.latch_status(axis_index, hit.axis_bit.mask)
        controller.faults.latch(hit.error_bit)
    return hit is not None


def forget_refusals(controller: Controller, axis_index: int) -> None:
    """A legal start clears the bits of limits met and zones missed before."""
    in_zone = controller.engine.status(axis_index) & AxisStatus.IN_TARGET_ZONE.mask
    controller.engine.clear_status(axis_index, CLEARED_BY_LEGAL_GO)
    clear_without_cause(controller, ErrorStatus.HARD_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT)
    if in_zone:
        clear_without_cause(controller, ErrorStatus.TARGET_ZONE_TIMEOUT)


def _profile(controller: Controller, axis_index: int, direction: int) -> Segments:
    """The profile GO starts; none for a preset move that goes nowhere.

    Raises:
        TargetOvershot: the axis moves, and its target lies behind it or within its braking distance.
    """
    if controller.settings.flag("MC", axis_index):
        return _continuous(controller, axis_index, direction)
    state = controller.engine.profile_state(axis_index)
    target = preset_target(controller, axis_index)
    velocity = float(controller.settings.counts("V", axis_index))
    if velocity == 0 or (target == state.position and state.velocity == 0):
        return ()
    return plan_preset(state.position, state.velocity, target, velocity, *ramps(controller, axis_index))


def _continuous(controller: Controller, axis_index: int, direction: int) -> Segments:
    state = controller.engine.profile_state(axis_index)
    velocity = direction * float(controller.settings.counts("V", axis_index))
    return plan_continuous(state.position, state.velocity, velocity, *ramps(controller, axis_index))


def ramps(controller: Controller, axis_index: int, family: str = "") -> tuple[float, float, float, float]:
    """A, AD, AA, ADA of a family (HOM, JOG, JOY) in force, counts/s2: the order the planner takes them in."""
    counts = controller.settings.counts
    return (
        float(counts(f"{family}A", axis_index)),
        float(counts(f"{family}AD", axis_index)),
        float(counts(f"{family}AA", axis_index)),
        float(counts(f"{family}ADA", axis_index)),
    )


def stop_segments(controller: Controller, axis_index: int, ramp: str, state: State | None = None) -> Segments:
    """The profile that brings an axis, or what has ``state``, to rest at a deceleration (AD, LHAD, LSAD) and its
    average partner.

    A partner outside the S-curve rule is left out: a stop is never refused (assumed).
    """
    state = state or controller.engine.profile_state(axis_index)
    maximum = float(controller.settings.counts(ramp, axis_index))
    average = float(controller.settings.counts(f"{ramp}A", axis_index))
    if not maximum <= 2 * average <= 2 * maximum:
        average = maximum
    return plan_stop(state.position, state.velocity, maximum, average)


@handles("PSET")
def set_position(controller: Controller, command: Command) -> Lines:
    """PSET: the present commanded position becomes the value given; the standing error is kept."""
    if not command.argument:
        raise CommandError(INCORRECT_DATA)
    require_rest(controller, command)
    row = command.row
    assert row is not None
    settings = controller.settings
    placed = place_values(controller.substitute(command), settings.axes_in_use)
    values: dict[int, int] = {}
    for index, value in enumerate(placed):
        if value is not None:
            number = checked_number(value, settings.range_in_force(row, index), field=index + 1, fields=2)
            values[index] = int(Decimal(number * settings.factor("distance", index)).to_integral_value(ROUND_DOWN))
    for index, counts in values.items():
        controller.engine.set_position(index, counts)
    return None


@applies("MA", "MC", "JOG", "JOY")
def apply_modes(controller: Controller, command: Command, changed: list[int]) -> None:
    """AS bits 6 to 9 show the modes."""
    for axis_index in changed:
        controller.refresh_axis_bits(axis_index)

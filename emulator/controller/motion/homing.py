"""Homing: HOM searches for the home input, backs up to an edge of it, goes on to the Z pulse, and calls that zero.

The order of the steps (assumed M throughout; the command reference for it has not survived):

search    at HOMV in the direction asked for, until the home input becomes active; a limit turns the search round once
found     decelerate at HOMAD; without HOMBAC and HOMZ this is the end
clear     with HOMBAC: if need be at HOMV across the edge of HOMEDG, to the side from which HOMDF crosses it
approach  at HOMVF in the direction of HOMDF until that edge, then to rest exactly where it was seen
index     with HOMZ: on at HOMVF to the first Z pulse seen while the home input is active, and to rest on it

Edges and pulses are caught by the servo in its sample, and the axis is brought to rest on the position it had then,
through a reversal where the command was already past it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from emulator.controller.faults import CLEARED_BY_GO, clear_without_cause
from emulator.controller.motion.go import CLEARED_BY_LEGAL_GO, check_ready, check_s_curve, ramps, stop_segments
from emulator.controller.motion.limits import limit_in_the_way
from emulator.controller.motion.stopping import end_of_travel
from emulator.controller.waits import MotionWait
from emulator.engine import Event, Segments, State, TargetOvershot, plan_continuous, plan_preset, plan_stop
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, MOTION_IN_PROGRESS, CommandError
from protocol.fields import place_mask
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

LIMIT_EVENTS = Event.HARD_LIMIT | Event.SOFT_LIMIT
"""Soft limits turn a search round and end it as the switches do (assumed L)."""

INSIDE = 0
"""Place of an axis whose home input is active; +1 and -1 are the sides of the zone."""


class Step(Enum):
    """What a homing axis is doing."""

    SEARCH = auto()
    TURN = auto()
    FOUND = auto()
    CLEAR = auto()
    CLEARED = auto()
    APPROACH = auto()
    LAND = auto()
    INDEX = auto()
    LAND_ON_INDEX = auto()


@dataclass(frozen=True, slots=True)
class HomingPlan:
    """What HOM has read: changes of a setting on the way do not matter any more (assumed, as for GO)."""

    search_counts_s: float
    final_counts_s: float
    ramps: tuple[float, float, float, float]
    backs_up: bool
    to_index: bool
    edge: int
    """HOMEDG: +1 the positive side's edge of the active zone, -1 the negative side's."""
    final_direction: int
    """HOMDF."""


@dataclass(slots=True)
class HomingMove:
    """One axis on its way home."""

    plan: HomingPlan
    direction: int
    turned: bool = False
    step: Step = Step.SEARCH


@dataclass(frozen=True, slots=True)
class HomingWait(MotionWait):
    """COMEXC0: until homing of these axes has ended, well or not, and the axes are at rest."""

    def over(self, controller: Controller) -> bool:
        if any(controller.homing.active(axis_index) for axis_index in self.axes):
            return False
        # the plain form of super() does not survive a dataclass with slots
        return MotionWait.over(self, controller)


class Homing:
    """The homing moves of one unit and which axes stand at home."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._moves: dict[int, HomingMove] = {}
        self.successful = [False] * controller.settings.axes
        """AS bit 5."""

    def reset(self) -> None:
        """Power-up: no axis knows where home is."""
        self._moves.clear()
        self.successful = [False] * self._controller.settings.axes

    def active(self, axis_index: int) -> bool:
        """The axis is homing."""
        return axis_index in self._moves

    def begin(self, axis_index: int, direction: int) -> None:
        """Start homing an axis at rest; direction +1 or -1."""
        self._note(axis_index, successful=False)
        self._controller.engine.clear_status(axis_index, CLEARED_BY_LEGAL_GO)
        clear_without_cause(self._controller, ErrorStatus.HARD_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT)
        self._moves[axis_index] = HomingMove(read_plan(self._controller, axis_index), direction)
        if self._controller.engine.home_active(axis_index):
            self._found(axis_index)
        else:
            self._search(axis_index)

    def abort(self, axis_index: int) -> None:
        """Give homing up; whoever calls brings the axis to rest."""
        if self._moves.pop(axis_index, None) is not None:
            self._controller.engine.cancel_capture(axis_index)

    def act_on(self, axis_index: int, events: Event) -> Event:
        """Take the next step that events of the servo call for; returns the events left for others."""
        move = self._moves.get(axis_index)
        if move is None:
            return events
        if events & Event.POSITION_ERROR:
            self.abort(axis_index)
        elif events & Event.HOME_EDGE:
            self._edge(axis_index, move)
        elif events & Event.INDEX:
            self._land(axis_index, Step.LAND_ON_INDEX)
        elif events & Event.MOVE_ENDED:
            self._at_rest(axis_index, move)
        if events & LIMIT_EVENTS:
            events = self._limit(axis_index, events)
        return events

    # What the servo has told.

    def _edge(self, axis_index: int, move: HomingMove) -> None:
        if move.step is Step.APPROACH:
            self._land(axis_index, Step.LAND)
        else:
            state = self._controller.engine.profile_state(axis_index)
            _, down, _, average_down = move.plan.ramps
            segments = plan_stop(state.position, state.velocity, down, average_down)
            self._controller.engine.start_profile(axis_index, segments)
            move.step = Step.FOUND if move.step is Step.SEARCH else Step.CLEARED

    def _at_rest(self, axis_index: int, move: HomingMove) -> None:
        match move.step:
            case Step.TURN:
                self._turn(axis_index, move)
            case Step.FOUND:
                self._found(axis_index)
            case Step.CLEARED:
                self._approach(axis_index)
            case Step.LAND if move.plan.to_index:
                self._seek_index(axis_index)
            case Step.LAND | Step.LAND_ON_INDEX:
                self._finish(axis_index)

    def _limit(self, axis_index: int, events: Event) -> Event:
        """A limit: the first one of a search turns it round, after the edge it only brakes harder, else it is the end.
        Returns the events others still have to act on."""
        move = self._moves.get(axis_index)
        ramp = "LHAD" if events & Event.HARD_LIMIT else "LSAD"
        if move is not None and move.step is Step.FOUND:
            self._brake(axis_index, ramp)
        elif move is not None and move.step is Step.SEARCH and not move.turned:
            self._controller.engine.cancel_capture(axis_index)
            self._brake(axis_index, ramp)
            move.step = Step.TURN
        else:
            self.abort(axis_index)
            return events
        return events & ~LIMIT_EVENTS

    # The steps.

    def _search(self, axis_index: int) -> None:
        move = self._moves[axis_index]
        hit = limit_in_the_way(self._controller, axis_index, move.direction)
        if hit is None:
            self._run(axis_index, move.direction * move.plan.search_counts_s)
            self._controller.engine.capture_home(axis_index, active=True, direction=move.direction)
            move.step = Step.SEARCH
        elif not move.turned:
            self._turn(axis_index, move)
        else:
            self.abort(axis_index)
            self._controller.engine.latch_status(axis_index, hit.axis_bit.mask)
            end_of_travel(self._controller, axis_index, "LHAD", hit.error_bit)

    def _turn(self, axis_index: int, move: HomingMove) -> None:
        """Search the other way. A home input that has become active while braking counts as found."""
        move.direction, move.turned = -move.direction, True
        self._controller.engine.clear_status(axis_index, CLEARED_BY_LEGAL_GO)
        if self._controller.engine.home_active(axis_index):
            self._found(axis_index)
        else:
            self._search(axis_index)

    def _found(self, axis_index: int) -> None:
        """At rest behind the first edge: stay there, or go to the edge that was chosen."""
        move = self._moves[axis_index]
        if not move.plan.backs_up:
            self._finish(axis_index)
            return
        place = INSIDE if self._controller.engine.home_active(axis_index) else move.direction
        if (2 * place - move.plan.edge) * move.plan.final_direction < 0:
            self._approach(axis_index)
        else:
            self._clear(axis_index)

    def _clear(self, axis_index: int) -> None:
        move = self._moves[axis_index]
        edge, direction = move.plan.edge, -move.plan.final_direction
        self._run(axis_index, direction * move.plan.search_counts_s)
        self._controller.engine.capture_home(axis_index, active=edge != direction, direction=direction)
        move.step = Step.CLEAR

    def _approach(self, axis_index: int) -> None:
        move = self._moves[axis_index]
        edge, direction = move.plan.edge, move.plan.final_direction
        self._run(axis_index, direction * move.plan.final_counts_s)
        self._controller.engine.capture_home(axis_index, active=edge != direction, direction=direction)
        move.step = Step.APPROACH

    def _seek_index(self, axis_index: int) -> None:
        move = self._moves[axis_index]
        self._run(axis_index, move.plan.final_direction * move.plan.final_counts_s)
        self._controller.engine.capture_index(axis_index)
        move.step = Step.INDEX

    def _finish(self, axis_index: int) -> None:
        """TPC becomes 0 where the axis rests; the standing error stays."""
        del self._moves[axis_index]
        self._controller.engine.set_position(axis_index, 0)
        self._note(axis_index, successful=True)

    def _note(self, axis_index: int, *, successful: bool) -> None:
        self.successful[axis_index] = successful
        self._controller.refresh_axis_bits(axis_index)

    # The profiles.

    def _run(self, axis_index: int, velocity_counts_s: float) -> None:
        """Move on endlessly."""
        engine = self._controller.engine
        state = engine.profile_state(axis_index)
        ramps = self._moves[axis_index].plan.ramps
        engine.start_profile(axis_index, plan_continuous(state.position, state.velocity, velocity_counts_s, *ramps))

    def _brake(self, axis_index: int, ramp: str) -> None:
        self._controller.engine.start_profile(axis_index, stop_segments(self._controller, axis_index, ramp))

    def _land(self, axis_index: int, step: Step) -> None:
        """Bring the axis to rest on the captured position; one that lies behind is reached through rest."""
        engine, move = self._controller.engine, self._moves[axis_index]
        segments = _landing(engine.profile_state(axis_index), engine.captured_position(axis_index), move.plan)
        engine.start_profile(axis_index, segments)
        move.step = step


def _landing(state: State, target: int, plan: HomingPlan) -> Segments:
    try:
        return plan_preset(state.position, state.velocity, target, plan.final_counts_s, *plan.ramps)
    except TargetOvershot:
        _, down, _, average_down = plan.ramps
        stop = plan_stop(state.position, state.velocity, down, average_down)
        return (*stop[:-1], *plan_preset(stop[-1].position, 0.0, target, plan.final_counts_s, *plan.ramps))


def read_plan(controller: Controller, axis_index: int) -> HomingPlan:
    """The homing settings of an axis as they stand."""
    flag, counts = controller.settings.flag, controller.settings.counts
    return HomingPlan(
        search_counts_s=float(counts("HOMV", axis_index)),
        final_counts_s=float(counts("HOMVF", axis_index)),
        ramps=ramps(controller, axis_index, "HOM"),
        backs_up=backs_up(controller, axis_index),
        to_index=flag("HOMZ", axis_index),
        edge=-1 if flag("HOMEDG", axis_index) else 1,
        final_direction=-1 if flag("HOMDF", axis_index) else 1,
    )


def backs_up(controller: Controller, axis_index: int) -> bool:
    """Whether homing ends on an edge: HOMBAC1, or HOMZ1 which implies it."""
    return controller.settings.flag("HOMBAC", axis_index) or controller.settings.flag("HOMZ", axis_index)


@handles("HOM")
def home(controller: Controller, command: Command) -> Lines:
    """HOM: 0 starts in the positive direction, 1 in the negative one, X leaves the axis alone."""
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    placed = place_mask(command, controller.settings.axes_in_use, lenient=controller.machine.lenient_masks)
    directions = {index: 1 if digit == "0" else -1 for index, digit in enumerate(placed) if digit in "01"}
    check_ready(controller, directions)
    for axis_index in directions:
        check_s_curve(controller, axis_index, "HOM")
        _check_home_move(controller, axis_index)
    controller.faults.clear(CLEARED_BY_GO)
    for axis_index, direction in directions.items():
        controller.homing.begin(axis_index, direction)
    if directions and not controller.settings.flag("COMEXC"):
        controller.interpreter.wait_for(HomingWait(tuple(directions)))
    return None


def _check_home_move(controller: Controller, axis_index: int) -> None:
    """Refuse what could not end.

    Raises:
        CommandError: MOTION IN PROGRESS; INVALID CONDITIONS for a velocity of 0 (assumed L).
    """
    if controller.engine.is_moving(axis_index):
        raise CommandError(MOTION_IN_PROGRESS)
    needed = ("HOMV", "HOMVF") if backs_up(controller, axis_index) else ("HOMV",)
    if any(controller.settings.counts(name, axis_index) == 0 for name in needed):
        raise CommandError(INVALID_CONDITIONS)


@applies("HOMLVL")
def apply_home_level(controller: Controller, command: Command, changed: list[int]) -> None:
    """HOMLVL0: a grounded home input is active."""
    for axis_index in changed:
        controller.engine.set_home_level(axis_index, 0 if controller.settings.flag("HOMLVL", axis_index) else 1)

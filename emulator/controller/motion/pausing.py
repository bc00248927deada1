"""Pause and continue by input or panel: with COMEXR1 motion is paused too and taken up again where it was left.

A preset move goes on to its target, a continuous one to its speed, with the ramps and velocity set by then (assumed).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from emulator.controller.motion.go import ramps
from emulator.controller.motion.stopping import stop_axes
from emulator.engine import TargetOvershot, plan_continuous, plan_preset

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.paths.motion import Course, PathMotion


class PausedMove(NamedTuple):
    """What an axis was doing: its target in reported counts, or the speed of a continuous move."""

    target_counts: float | None
    velocity_counts_s: float


class Pausing:
    """The pause of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._moves: dict[int, PausedMove] = {}
        self._paths: list[PathMotion] = []

    def pause(self) -> None:
        """Hold the program; with COMEXR1 decelerate every moving axis and remember what it was doing.

        In a pause another one changes nothing for what is held already.
        """
        controller = self._controller
        controller.interpreter.pause()
        if not controller.settings.flag("COMEXR"):
            return
        engine = controller.engine
        held = {*self._moves, *(axis_index for motion in self._paths for axis_index in motion.course.axes)}
        moving = [i for i in range(controller.settings.axes) if engine.is_moving(i) and i not in held]
        self._moves |= {axis_index: self._move(axis_index) for axis_index in moving if self._resumable(axis_index)}
        self._paths += [motion for motion in controller.paths.under_way() if held.isdisjoint(motion.course.axes)]
        stop_axes(controller, moving, "AD")

    def holds(self, course: Course) -> bool:
        """Whether a path is to be taken up again."""
        return any(motion.course is course for motion in self._paths)

    def _resumable(self, axis_index: int) -> bool:
        """Homing, jogging, the joystick, Following and compiled profiles do not go on after a pause (assumed); paths
        do, as a whole."""
        if self._controller.paths.carries(axis_index) or self._controller.engine.is_following(axis_index):
            return False
        by_hand = any(self._controller.settings.flag(mode, axis_index) for mode in ("JOG", "JOY"))
        if self._controller.compiled.moves(axis_index):
            return False
        return not by_hand and not self._controller.homing.active(axis_index)

    def _move(self, axis_index: int) -> PausedMove:
        controller = self._controller
        velocity = controller.engine.profile_state(axis_index).velocity
        target = controller.engine.profile_target(axis_index)
        if target is None:
            return PausedMove(None, velocity)
        return PausedMove(target, float(controller.settings.counts("V", axis_index)))

    def go_on(self) -> None:
        """Resume paused motion and the program."""
        moves, self._moves = self._moves, {}
        paths, self._paths = self._paths, []
        if not self._controller.interpreter.paused:
            return
        for axis_index, move in moves.items():
            if self._controller.engine.is_enabled(axis_index):
                self._resume(axis_index, move)
        for motion in paths:
            self._controller.paths.resume(motion)
        self._controller.interpreter.paused = False

    def _resume(self, axis_index: int, move: PausedMove) -> None:
        engine = self._controller.engine
        state = engine.profile_state(axis_index)
        in_force = ramps(self._controller, axis_index)
        if move.target_counts is None:
            segments = plan_continuous(state.position, state.velocity, move.velocity_counts_s, *in_force)
        else:
            try:
                segments = plan_preset(
                    state.position, state.velocity, move.target_counts, move.velocity_counts_s, *in_force
                )
            except TargetOvershot:
                return
        if segments:
            engine.start_profile(axis_index, segments)

    def forget(self) -> None:
        """A stop or kill ends what was paused."""
        self._moves.clear()
        self._paths.clear()

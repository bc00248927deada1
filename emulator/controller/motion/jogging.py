"""Jog mode: an axis moves while an input assigned to it with INFNC J (positive) or K (negative) is active.

The speed is JOGVL, or JOGVH while an L input is active, and changes on the way when L does.  J and K together mean
rest (assumed).  Where something else has stopped the axis (S, K, a limit, a fault) it stays at rest until one of its
inputs changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.by_hand import in_mode, run_at, set_mode
from emulator.controller.motion.go import check_s_curve
from emulator.controller.waits import MotionWait
from emulator.controller.wires.input_functions import InputFunction, acts_on
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, MOTION_IN_PROGRESS, CommandError
from protocol.fields import place_mask

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

POSITIVE, NEGATIVE, FAST = "J", "K", "L"
"""INFNC letters."""


@dataclass(frozen=True, slots=True)
class JogEnd(MotionWait):
    """A buffered JOG0 waits for the end of the jog and then ends the mode."""

    def over(self, controller: Controller) -> bool:
        # the plain form of super() does not survive a dataclass with slots
        if not MotionWait.over(self, controller):
            return False
        for axis_index in self.axes:
            set_mode(controller, "JOG", axis_index, on=False)
        return True


class Jogging:
    """What the jog inputs ask of each axis of a unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._asked = [0.0] * controller.settings.axes

    def reset(self) -> None:
        """Power-up: no axis is in jog mode."""
        self._asked = [0.0] * self._controller.settings.axes

    def refresh(self, axis_index: int) -> None:
        """An input or the mode of an axis has changed: change its velocity if something else is asked now."""
        if not in_mode(self._controller, "JOG", axis_index):
            self._asked[axis_index] = 0.0
            return
        asked = self._velocity_counts_s(axis_index)
        if asked != self._asked[axis_index]:
            self._asked[axis_index] = asked
            run_at(self._controller, axis_index, asked, "JOG")

    def _velocity_counts_s(self, axis_index: int) -> float:
        active = self._controller.inputs.function_active
        by_keys = self._controller.panel.jog_direction(axis_index)
        direction = by_keys or active(POSITIVE, axis_index) - active(NEGATIVE, axis_index)
        speed = "JOGVH" if active(FAST, axis_index) else "JOGVL"
        return direction * float(self._controller.settings.counts(speed, axis_index))


@acts_on(POSITIVE, NEGATIVE, FAST)
def jog_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """A jog input of an axis, or of all axes, has changed."""
    axes = range(controller.settings.axes_in_use) if function.axis_index is None else (function.axis_index,)
    for axis_index in axes:
        controller.jogging.refresh(axis_index)


@handles("JOG")
def jog(controller: Controller, command: Command) -> Lines:
    """JOG: 1 puts an axis at rest into jog mode; 0 ends it, an immediate one in the middle of a jog."""
    if command.is_query:
        return controller.settings.report(command)
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    placed = place_mask(command, controller.settings.axes_in_use, lenient=controller.machine.lenient_masks)
    entering = [index for index, digit in enumerate(placed) if digit == "1" and not in_mode(controller, "JOG", index)]
    leaving = [index for index, digit in enumerate(placed) if digit == "0" and in_mode(controller, "JOG", index)]
    for axis_index in entering:
        _check_enter(controller, axis_index)
    for axis_index in entering:
        set_mode(controller, "JOG", axis_index, on=True)
        controller.jogging.refresh(axis_index)
    _leave(controller, leaving)
    return None


def _check_enter(controller: Controller, axis_index: int) -> None:
    """Refuse jog mode.

    Raises:
        CommandError: MOTION IN PROGRESS, INVALID CONDITIONS in joystick mode (assumed L), an S-curve that is none.
    """
    if controller.engine.is_moving(axis_index):
        raise CommandError(MOTION_IN_PROGRESS)
    if in_mode(controller, "JOY", axis_index):
        raise CommandError(INVALID_CONDITIONS)
    check_s_curve(controller, axis_index, "JOG")


def _leave(controller: Controller, axes: list[int]) -> None:
    moving = tuple(axis_index for axis_index in axes if controller.engine.is_moving(axis_index))
    if moving and not controller.interpreter.immediate_now:
        controller.interpreter.wait_for(JogEnd(tuple(axes)))
        return
    for axis_index in axes:
        run_at(controller, axis_index, 0.0, "JOG")
        set_mode(controller, "JOG", axis_index, on=False)
        controller.jogging.refresh(axis_index)

"""GOL: axes go to their targets along a straight line, starting and arriving together.

D, MA and SCLD say where each axis goes, as for GO; PV, PA, PAD, PAA and PADA speak of the line (6000 PG p. 146).  An
axis whose distance is D of a line of length L moves at D / L of the path's velocity and ramps.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from emulator.controller.compiled.profile import is_slave
from emulator.controller.dispatch import Lines, handles
from emulator.controller.faults import CLEARED_BY_GO
from emulator.controller.motion.go import (
    check_ready,
    check_s_curve,
    forget_refusals,
    held_by_limit,
    named_axes,
)
from emulator.controller.motion.targets import preset_target
from emulator.controller.paths.geometry import Line
from emulator.controller.paths.motion import Averages, Course, axes_at, first_headings
from emulator.controller.paths.speed import Stretch
from emulator.controller.waits import MotionWait
from protocol.command import Command
from protocol.errors import INVALID_CONDITIONS, MOTION_IN_PROGRESS, PATH_VELOCITY_ZERO, CommandError

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


@handles("GOL")
def go_linear(controller: Controller, command: Command) -> Lines:
    """GOL: start the axes named along a straight line; bare it names all of them, as ``1GOL`` names axis 1 alone
    (assumed).  An axis with D0 takes part and stays where it is.

    Raises:
        CommandError: an axis that cannot start (nothing starts then), MC1, a slave (FOLEN1, assumed), S-curve rule,
            PV0.
    """
    named = named_axes(controller, command)
    axes = list(range(controller.settings.axes_in_use)) if named is None else named
    check_linear(controller, axes)
    controller.faults.clear(CLEARED_BY_GO)
    if axes:
        controller.held_starts.start(axes, partial(start_linear, controller, axes, line_rates(controller)))
    if axes and not controller.settings.flag("COMEXC"):
        controller.interpreter.wait_for(MotionWait(tuple(axes)))
    return None


def check_linear(controller: Controller, axes: list[int]) -> None:
    """Refuse a linear move that cannot be: unlike a GO it does not pre-empt motion (assumed).

    Raises:
        CommandError: as ``go_linear``.
    """
    check_ready(controller, axes)
    for axis_index in axes:
        if controller.settings.flag("MC", axis_index) or is_slave(controller.settings, axis_index):
            raise CommandError(f"{INVALID_CONDITIONS}-AXIS {axis_index + 1}")
        if controller.engine.is_moving(axis_index):
            raise CommandError(MOTION_IN_PROGRESS)
    check_s_curve(controller, 0, "P")
    if controller.settings.counts("PV") == 0:
        raise CommandError(PATH_VELOCITY_ZERO)


class LineRates(NamedTuple):
    """PV, PA, PAD and their averages, counts/s and counts/s2."""

    velocity: float
    acceleration: float
    deceleration: float
    averages: Averages


def line_rates(controller: Controller) -> LineRates:
    """The path values in force, which ``check_linear`` has found possible."""
    velocity, up, down, average_up, average_down = (
        float(controller.settings.counts(name)) for name in ("PV", "PA", "PAD", "PAA", "PADA")
    )
    return LineRates(velocity, up, down, Averages(average_up, average_down))


def start_linear(controller: Controller, axes: list[int], rates: LineRates) -> None:
    """Start a linear move that has been checked, from where the axes stand to where D says; nothing moves if a limit
    lies in the way of one, or there is nothing to go."""
    line = Line(axes_at(controller, axes), tuple(preset_target(controller, axis_index) for axis_index in axes))
    headings = dict(zip(axes, first_headings([line], len(axes)), strict=True))
    held = [held_by_limit(controller, axis_index, heading) for axis_index, heading in headings.items()]
    if any(held):
        return
    for axis_index in axes:
        forget_refusals(controller, axis_index)
    if line.length:
        stretch = Stretch(line.length, rates.velocity, rates.acceleration, rates.deceleration)
        controller.paths.start(Course(tuple(axes), (line,), (stretch,), rates.averages))

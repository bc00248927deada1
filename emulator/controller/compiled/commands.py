"""PCOMP, PUCOMP, PRUN and TSEG."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.compiled.compiling import compile_program
from emulator.controller.compiled.kinds import CompiledMotion, MotionRun
from emulator.controller.compiled.store import is_under_way
from emulator.controller.dispatch import Lines, handles, require_rest
from emulator.controller.faults import CLEARED_BY_GO
from emulator.controller.motion.go import OPEN_LOOP
from emulator.controller.programs.store import name_of, require_access
from emulator.controller.waits import NEVER
from protocol.command import Command
from protocol.errors import (
    AXES_NOT_READY,
    ENABLE_INPUT_INACTIVE,
    INVALID_CONDITIONS,
    NOT_ALLOWED_IF_SFB0,
    PATH_ALREADY_MOVING,
    PATH_NOT_COMPILED,
    CommandError,
)
from protocol.reply_shapes import numbers_line
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


@handles("PCOMP")
def compile_motion(controller: Controller, command: Command) -> Lines:
    """PCOMP name: compile a stored program.  One that was compiled before is so no longer if that fails (assumed).

    Raises:
        CommandError: motion, no such program, no room, or whatever makes the program impossible.
    """
    compiled = controller.compiled
    name = name_of(command)
    require_access(controller)
    require_rest(controller, command)
    controller.programs.lines(name)
    if controller.programs.defining == name:
        raise CommandError(INVALID_CONDITIONS)
    compiled.remove(name)
    compiled.failed = True
    compiled.keep(name, compile_program(controller, name))
    compiled.failed = False
    return None


@handles("PUCOMP")
def uncompile(controller: Controller, command: Command) -> Lines:
    """PUCOMP name: free the segments of a program; one that is not compiled is no error (assumed).

    Raises:
        CommandError: no such program, or it runs.
    """
    name = name_of(command)
    require_access(controller)
    controller.programs.lines(name)
    require_not_running(controller, name)
    controller.compiled.remove(name)
    return None


def require_not_running(controller: Controller, name: str) -> None:
    """Compiled motion may not lose its segments while it runs.

    Raises:
        CommandError: INVALID CONDITIONS FOR COMMAND.
    """
    if controller.compiled.running(name):
        raise CommandError(INVALID_CONDITIONS)


@dataclass(frozen=True, slots=True)
class RunWait:
    """COMEXC0: until compiled motion has left all its axes and, with STRGTE1, they have settled or timed out."""

    run: MotionRun
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = None

    def over(self, controller: Controller) -> bool:
        settling = any(map(controller.engine.is_settling, self.run.axes))
        return not is_under_way(self.run) and not settling


@handles("PRUN")
def run_compiled(controller: Controller, command: Command) -> Lines:
    """PRUN name: start compiled motion on all its axes at once.

    Raises:
        CommandError: no such program, not compiled, running already, or an axis that cannot start.
    """
    name = name_of(command)
    controller.programs.lines(name)
    motion = controller.compiled.motion(name)
    if motion is None:
        raise CommandError(PATH_NOT_COMPILED)
    if controller.compiled.running(name):
        raise CommandError(PATH_ALREADY_MOVING)
    require_axes_ready(controller, motion)
    controller.faults.clear(CLEARED_BY_GO)
    run = controller.compiled.start(name)
    if not controller.settings.flag("COMEXC"):
        controller.interpreter.wait_for(RunWait(run))
    return None


def require_axes_ready(controller: Controller, motion: CompiledMotion) -> None:
    """Every axis has its drive on, its loop closed, stands still and is not moved by hand.

    Raises:
        CommandError: WARNING: ENABLE INPUT INACTIVE, NOT ALLOWED IF SFB0, AXES NOT READY.
    """
    if not controller.wiring.enable_grounded:
        raise CommandError(ENABLE_INPUT_INACTIVE)
    settings, engine = controller.settings, controller.engine
    for axis_index in motion.axes:
        by_hand = settings.flag("JOG", axis_index) or settings.flag("JOY", axis_index)
        moving = engine.is_moving(axis_index) or controller.homing.active(axis_index)
        if by_hand or moving or not engine.is_enabled(axis_index) or axis_index >= settings.axes_in_use:
            raise CommandError(AXES_NOT_READY)
        if settings.integer("SFB", axis_index) == OPEN_LOOP:
            raise CommandError(NOT_ALLOWED_IF_SFB0)


@handles("TSEG")
def report_free_segments(controller: Controller, command: Command) -> Lines:
    """TSEG: free segments of compiled memory."""
    assert command.row is not None
    return [numbers_line(command.row, None, [Decimal(controller.compiled.free)], [0])]

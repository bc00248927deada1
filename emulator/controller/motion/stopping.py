"""Stopping: S, K, Ctrl-K, and what hitting a limit or a fault does to motion, programs and the command buffer."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.go import named_axes, stop_segments
from protocol.command import Command
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

KEEP_ON_STOP = 1
"""COMEXS1: a stop keeps program and buffer, C resumes."""

KEEP_SELECTION = 2
"""COMEXS2: as 0, but program selection by inputs stays in force (assumed H)."""


def stop_axes(controller: Controller, axes: Iterable[int], ramp: str) -> None:
    """Bring moving axes to rest at a deceleration setting (AD, LHAD); homing, joystick mode and starts that
    wait end."""
    for axis_index in axes:
        controller.homing.abort(axis_index)
        controller.joystick.leave(axis_index)
        controller.held_starts.forget((axis_index,))
        brake(controller, axis_index, ramp)


def brake(controller: Controller, axis_index: int, ramp: str) -> None:
    """Bring an axis to rest, if it moves, at a deceleration setting (AD, LHAD, LSAD), on a path all axes of it; no
    trigger registers then."""
    controller.registration.forget(axis_index)
    if controller.paths.carries(axis_index):
        controller.paths.brake(axis_index, ramp)
    elif controller.engine.is_moving(axis_index):
        controller.engine.start_profile(axis_index, stop_segments(controller, axis_index, ramp))


@handles("S")
def stop(controller: Controller, command: Command) -> Lines:
    """S: decelerate at AD; bare S also ends program execution and empties the buffer (COMEXS says how)."""
    named = named_axes(controller, command)
    if named is None:
        stop_everything(controller, ErrorStatus.STOP_OR_KILL_ISSUED)
    else:
        stop_axes(controller, named, "AD")
        abandons = controller.settings.integer("COMEXS") != KEEP_ON_STOP
        controller.faults.latch(ErrorStatus.STOP_OR_KILL_ISSUED, abandons=abandons)
    return None


def stop_everything(controller: Controller, bit: ErrorStatus) -> None:
    """Stop all axes; COMEXS says what becomes of program, buffer and program selection (COMEXS2 keeps INSELP)."""
    stop_axes(controller, range(controller.settings.axes_in_use), "AD")
    controller.faults.latch(bit)
    comexs = controller.settings.integer("COMEXS")
    if comexs == KEEP_ON_STOP:
        controller.interpreter.paused = True
        return
    controller.interpreter.discard()
    if comexs != KEEP_SELECTION:
        controller.program_select.leave()


@handles("K")
def kill(controller: Controller, command: Command) -> Lines:
    """K: decelerate at LHAD; bare K also ends program execution and empties the buffer (GemPG p.219)."""
    named = named_axes(controller, command)
    if named is None:
        kill_everything(controller, ErrorStatus.STOP_OR_KILL_ISSUED)
    else:
        kill_axes(controller, named)
        controller.faults.latch(ErrorStatus.STOP_OR_KILL_ISSUED, abandons=True)
    return None


def kill_everything(controller: Controller, bit: ErrorStatus) -> None:
    """Kill all axes, end the program, empty the buffer and leave program selection."""
    kill_axes(controller, range(controller.settings.axes_in_use))
    controller.faults.latch(bit)
    controller.interpreter.discard()
    controller.program_select.leave()


def kill_axes(controller: Controller, axes: Iterable[int]) -> None:
    """Kill motion: with KDRIVE1 the drive of the axis is shut down too."""
    for axis_index in axes:
        if controller.settings.flag("KDRIVE", axis_index):
            controller.shut_down(axis_index)
        else:
            stop_axes(controller, (axis_index,), "LHAD")


def end_of_travel(controller: Controller, axis_index: int, ramp: str, bit: ErrorStatus) -> None:
    """A hard (LHAD) or soft (LSAD) limit was run into: stop the axis; without COMEXL1 nothing after it is carried
    out."""
    controller.homing.abort(axis_index)
    controller.held_starts.forget((axis_index,))
    brake(controller, axis_index, ramp)
    controller.faults.latch(bit)
    if not controller.settings.flag("COMEXL", axis_index):
        controller.interpreter.discard()

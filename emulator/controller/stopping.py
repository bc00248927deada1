"""Stopping: S, K, Ctrl-K, and what hitting a limit or a fault does to motion, programs and the command buffer."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion import named_axes, stop_segments
from protocol.command import Command
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

KEEP_ON_STOP = 1
"""COMEXS1: a stop keeps program and buffer, C resumes."""


def stop_axes(controller: Controller, axes: Iterable[int], ramp: str) -> None:
    """Bring moving axes to rest at a deceleration setting (AD, LHAD, LSAD)."""
    for axis_index in axes:
        if controller.engine.is_moving(axis_index):
            controller.engine.start_profile(axis_index, stop_segments(controller, axis_index, ramp))


@handles("S")
def stop(controller: Controller, command: Command) -> Lines:
    """S: decelerate at AD; bare S also ends program execution and empties the buffer (COMEXS says how)."""
    named = named_axes(controller, command)
    axes = range(controller.settings.axes_in_use) if named is None else named
    stop_axes(controller, axes, "AD")
    controller.faults.latch(ErrorStatus.STOP_OR_KILL_ISSUED)
    if named is None:
        if controller.settings.integer("COMEXS") == KEEP_ON_STOP:
            controller.interpreter.paused = True
        else:
            controller.interpreter.discard()
    return None


@handles("K")
def kill(controller: Controller, command: Command) -> Lines:
    """K: decelerate at LHAD; bare K also ends program execution and empties the buffer (GemPG p.219)."""
    named = named_axes(controller, command)
    kill_axes(controller, range(controller.settings.axes_in_use) if named is None else named)
    controller.faults.latch(ErrorStatus.STOP_OR_KILL_ISSUED)
    if named is None:
        controller.interpreter.discard()
    return None


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
    stop_axes(controller, (axis_index,), ramp)
    controller.faults.latch(bit)
    if not controller.settings.flag("COMEXL", axis_index):
        controller.interpreter.discard()

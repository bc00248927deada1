"""What kill, stop, pause/continue and user-fault inputs do when they become active and when they are released.

Kill and stop act on the change and leave motion possible while they are held; their ER bits stay until the input is
released or given another function (assumed H, with the table of error branches)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.motion.stopping import kill_everything, stop_axes, stop_everything
from emulator.controller.wires.input_functions import InputFunction, acts_on
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


@acts_on("C")
def kill_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """INFNCi-C: as !K on all axes, ER bit 6."""
    if not active:
        _released(controller, function, ErrorStatus.KILL_INPUT_ACTIVE)
        return
    kill_everything(controller, ErrorStatus.KILL_INPUT_ACTIVE)


@acts_on("D")
def stop_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """INFNCi-D: as !S; with an axis digit only that axis, and the program goes on.  ER bit 8."""
    if not active:
        _released(controller, function, ErrorStatus.STOP_INPUT_ACTIVE)
    elif function.axis_index is None:
        stop_everything(controller, ErrorStatus.STOP_INPUT_ACTIVE)
    else:
        stop_axes(controller, (function.axis_index,), "AD")
        controller.faults.latch(ErrorStatus.STOP_INPUT_ACTIVE)


@acts_on("E")
def pause_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """INFNCi-E: pauses while active, goes on when released (or at !C)."""
    if active:
        controller.pausing.pause()
    else:
        controller.pausing.go_on()


@acts_on("F")
def user_fault_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """INFNCi-F: ER bit 7 and nothing else; ERRORP decides what follows."""
    if active:
        controller.faults.latch(ErrorStatus.USER_FAULT_INPUT)
    else:
        _released(controller, function, ErrorStatus.USER_FAULT_INPUT)


@acts_on("B", "P")
def program_select_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """A line of the program selection changed."""
    controller.program_select.note_change()


def _released(controller: Controller, function: InputFunction, bit: ErrorStatus) -> None:
    if not controller.input_functions.active(function.letter):
        controller.faults.clear(bit.mask)

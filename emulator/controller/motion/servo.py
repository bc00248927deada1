"""Drives and the servo loop: DRIVE, the gains and limits of the control law, dither, rates, target zone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles, store_setting
from emulator.controller.faults import clear_without_cause
from emulator.engine import Gains
from protocol.command import Command
from protocol.errors import ENABLE_INPUT_INACTIVE, MOTION_IN_PROGRESS, CommandError
from protocol.fields import place_mask
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

GAIN_COMMANDS = ("SGP", "SGI", "SGV", "SGVF", "SGAF", "SGILIM")


@handles("DRIVE")
def drive(controller: Controller, command: Command) -> Lines:
    """DRIVE: 1 closes the loop where the axis stands, 0 shuts the drive down (immediately: also in motion)."""
    if command.is_query:
        return controller.settings.report(command)
    wanted = place_mask(command, controller.settings.axes_in_use, lenient=controller.machine.lenient_masks)
    if "1" in wanted and not controller.wiring.enable_grounded:
        raise CommandError(ENABLE_INPUT_INACTIVE)
    moving_off = [i for i, digit in enumerate(wanted) if digit == "0" and controller.engine.is_moving(i)]
    if moving_off and not controller.interpreter.immediate_now:
        raise CommandError(MOTION_IN_PROGRESS)
    for axis_index, digit in enumerate(wanted):
        if digit == "1":
            turn_on(controller, axis_index)
        elif digit == "0":
            controller.shut_down(axis_index)
    return None


def turn_on(controller: Controller, axis_index: int) -> None:
    """Release the shutdown output: commanded position = feedback, drive faults of the axis are cleared."""
    controller.engine.enable(axis_index)
    controller.note_drive(axis_index, on=True)
    controller.drive_faulted[axis_index] = False
    controller.refresh_axis_bits(axis_index)
    clear_without_cause(controller, ErrorStatus.POSITION_ERROR_EXCEEDED, ErrorStatus.DRIVE_FAULT)
    if controller.wiring.enable_grounded:
        controller.faults.clear(ErrorStatus.ENABLE_INPUT_OPEN.mask)
    controller.check_drive_faults()


@applies("INFEN", "DRFLVL")
def apply_drive_fault_watch(controller: Controller, command: Command, changed: list[int]) -> None:
    """A fault that is there when the watch begins acts at once (6250 UG: the program stops at INFEN1)."""
    controller.check_drive_faults()
    controller.input_functions.refresh()


@applies(*GAIN_COMMANDS)
def apply_gains(controller: Controller, command: Command, changed: list[int]) -> None:
    """A gain changed: it acts from the next servo sample on."""
    for axis_index in changed:
        values = [float(controller.settings.number(name, axis_index)) for name in GAIN_COMMANDS]
        controller.engine.set_gains(axis_index, Gains(*values))


@applies("SOFFS", "DACLIM")
def apply_output(controller: Controller, command: Command, changed: list[int]) -> None:
    """Output offset and limit."""
    for axis_index in changed:
        controller.engine.set_output(
            axis_index,
            offset_v=float(controller.settings.number("SOFFS", axis_index)),
            limit_v=float(controller.settings.number("DACLIM", axis_index)),
        )


@applies("SDTAMP", "SDTFR")
def apply_dither(controller: Controller, command: Command, changed: list[int]) -> None:
    """Dither: its amplitude, and the servo samples of half a period (assumed L)."""
    for axis_index in changed:
        controller.engine.set_dither(
            axis_index,
            amplitude_v=float(controller.settings.number("SDTAMP", axis_index)),
            half_period_samples=controller.settings.integer("SDTFR", axis_index),
        )


@applies("SMPER")
def apply_position_error_limit(controller: Controller, command: Command, changed: list[int]) -> None:
    """Maximum allowable position error; 0 is not watched."""
    for axis_index in changed:
        controller.engine.set_position_error_limit(axis_index, int(controller.settings.counts("SMPER", axis_index)))


@applies("STRGTE", "STRGTD", "STRGTV", "STRGTT", "ERES")
def apply_target_zone(controller: Controller, command: Command, changed: list[int]) -> None:
    """Target zone, STRGTV unscaled being in revolutions of ERES counts; STRGTE0 clears a time-out."""
    settings = controller.settings
    for axis_index in changed:
        enable = settings.flag("STRGTE", axis_index)
        controller.engine.set_target_zone(
            axis_index,
            enable=enable,
            distance_counts=float(settings.counts("STRGTD", axis_index)),
            velocity_counts_s=float(settings.counts("STRGTV", axis_index)),
            timeout_ms=settings.integer("STRGTT", axis_index),
        )
        if not enable:
            controller.engine.clear_status(axis_index, AxisStatus.TARGET_ZONE_TIMEOUT.mask)
            clear_without_cause(controller, ErrorStatus.TARGET_ZONE_TIMEOUT)


@applies("SSFR")
def apply_rates(controller: Controller, command: Command, changed: list[int]) -> None:
    """Servo, trajectory and system update rates."""
    controller.apply_rates()


@handles("INDAX")
def participating_axes(controller: Controller, command: Command) -> Lines:
    """INDAX: reports shorten and the rates change; an axis that drops out is shut down (assumed)."""
    if command.is_query:
        return controller.settings.report(command)
    if any(controller.engine.is_moving(axis_index) for axis_index in range(controller.settings.axes)):
        raise CommandError(MOTION_IN_PROGRESS)
    store_setting(controller, command)
    for axis_index in range(controller.settings.axes_in_use, controller.settings.axes):
        controller.shut_down(axis_index)
    controller.apply_rates()
    return None

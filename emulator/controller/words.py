"""The status words as bit texts, bit 1 first: what TAS, TSS, TER ... print and what conditions compare."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.wires.wiring import JOYSTICK_CONTACTS
from protocol.reply import word_bits
from protocol.status import AxisStatus, ExtendedAxisStatus, OtherInputs, SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

WORD = 32
USER_BITS = 16
OTHER_INPUT_BITS = 8


def axis_status(controller: Controller, axis_index: int) -> str:
    """AS of one axis."""
    return word_bits(controller.engine.status(axis_index), WORD)


def extended_axis_status(controller: Controller, axis_index: int) -> str:
    """ASX of one axis: on a unit with external drives only the drive-fault input and the Z channel show (assumed)."""
    conditions = {
        ExtendedAxisStatus.DRIVE_FAULT_INPUT: controller.drive_fault_active(axis_index),
        ExtendedAxisStatus.Z_CHANNEL: controller.engine.index_active(axis_index),
    }
    return word_bits(sum(bit.mask for bit, on in conditions.items() if on), WORD)


def system_status(controller: Controller) -> str:
    """SS."""
    interpreter, settings, programs = controller.interpreter, controller.settings, controller.programs
    wait = interpreter.wait
    conditions = {
        SystemStatus.SYSTEM_READY: True,
        SystemStatus.EXECUTING_PROGRAM: programs.running,
        SystemStatus.IMMEDIATE_COMMAND: interpreter.immediate_now,
        SystemStatus.ASCII_MODE: True,
        SystemStatus.ECHO_MODE: settings.host_flag("ECHO"),
        SystemStatus.DEFINING_PROGRAM: programs.defining is not None,
        SystemStatus.TRACE_MODE: controller.debugging.trace,
        SystemStatus.STEP_MODE: controller.debugging.step,
        SystemStatus.COMMAND_ERROR: controller.faults.command_text is not None,
        SystemStatus.BREAK_POINT_ACTIVE: interpreter.at_break_point,
        SystemStatus.MONITORING_ON_CONDITION: controller.on_conditions.active,
        SystemStatus.PAUSE_ACTIVE: interpreter.paused,
        SystemStatus.WAIT_ACTIVE: wait is not None and wait.status_bit is SystemStatus.WAIT_ACTIVE,
        SystemStatus.WAITING_FOR_DATA: wait is not None and wait.status_bit is SystemStatus.WAITING_FOR_DATA,
        SystemStatus.DWELL_IN_PROGRESS: wait is not None and wait.status_bit is SystemStatus.DWELL_IN_PROGRESS,
        SystemStatus.LOADING_THUMBWHEEL_DATA: (
            wait is not None and wait.status_bit is SystemStatus.LOADING_THUMBWHEEL_DATA
        ),
        SystemStatus.EXTERNAL_PROGRAM_SELECT: settings.integer("INSELP") != 0,
        SystemStatus.WAITING_FOR_RP240: wait is not None and wait.status_bit is SystemStatus.WAITING_FOR_RP240,
        SystemStatus.RP240_CONNECTED: controller.machine.rp240.fitted,
        SystemStatus.NONVOLATILE_MEMORY_ERROR: controller.memory_lost,
        **controller.compiled.status,
        **controller.captures.status,
    }
    return word_bits(sum(bit.mask for bit, on in conditions.items() if on), WORD)


def error_status(controller: Controller) -> str:
    """ER."""
    return word_bits(controller.faults.word, WORD)


def limit_inputs(controller: Controller) -> str:
    """LIM."""
    return controller.wiring.limit_bits(controller.settings.axes_in_use)


def inputs(controller: Controller) -> str:
    """IN: programmable inputs, then the triggers."""
    return controller.inputs.bits


def other_inputs(controller: Controller) -> str:
    """INO: the joystick connector's digital inputs and ENABLE."""
    contacts = {contact for contact in JOYSTICK_CONTACTS.values() if controller.inputs.joystick(contact)}
    if controller.wiring.enable_grounded:
        contacts.add(OtherInputs.ENABLE)
    return word_bits(sum(contact.mask for contact in contacts), OTHER_INPUT_BITS)


def outputs(controller: Controller) -> str:
    """OUT: programmable outputs, then OUT-A and OUT-B, as functions and overrides leave them."""
    return controller.output_functions.bits()


def user_status(controller: Controller) -> str:
    """US."""
    return controller.user_status.word


def moving(controller: Controller) -> str:
    """MOV: AS bit 1 of each axis."""
    axes = range(controller.settings.axes_in_use)
    return "".join("1" if controller.engine.status(axis) & AxisStatus.MOVING.mask else "0" for axis in axes)

"""The status words as bit texts, bit 1 first: what TAS, TSS, TER ... print and what conditions compare."""

from __future__ import annotations

from typing import TYPE_CHECKING

from protocol.reply import word_bits
from protocol.status import ExtendedAxisStatus, OtherInputs, SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

WORD = 32
USER_BITS = 16
OTHER_INPUT_BITS = 8


def axis_status(controller: Controller, axis_index: int) -> str:
    """AS of one axis."""
    return word_bits(controller.engine.status(axis_index), WORD)


def extended_axis_status(controller: Controller, axis_index: int) -> str:
    """ASX of one axis: on a unit with external drives only the drive-fault input shows (assumed)."""
    active = controller.drive_fault_active(axis_index)
    return word_bits(ExtendedAxisStatus.DRIVE_FAULT_INPUT.mask if active else 0, WORD)


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
        SystemStatus.COMMAND_ERROR: controller.faults.command_text is not None,
        SystemStatus.PAUSE_ACTIVE: interpreter.paused,
        SystemStatus.WAIT_ACTIVE: wait is not None and wait.status_bit is SystemStatus.WAIT_ACTIVE,
        SystemStatus.DWELL_IN_PROGRESS: wait is not None and wait.status_bit is SystemStatus.DWELL_IN_PROGRESS,
        SystemStatus.RP240_CONNECTED: controller.machine.rp240.fitted,
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
    count = controller.wiring.input_count
    settings = controller.settings
    levels, overrides = settings.bits("INLVL")[:count], settings.bits("INEN")[:count]
    return controller.wiring.input_bits(active_levels=levels, overrides=overrides)


def other_inputs(controller: Controller) -> str:
    """INO: joystick inputs (not wired: 0) and ENABLE."""
    return word_bits(OtherInputs.ENABLE.mask if controller.wiring.enable_grounded else 0, OTHER_INPUT_BITS)


def outputs(controller: Controller) -> str:
    """OUT: programmable outputs, then OUT-A and OUT-B; OUTEN digits 0 and 1 force an output."""
    count = controller.machine.io.outputs + 2
    settings = controller.settings
    pairs = zip(settings.bits("OUT")[:count], settings.bits("OUTEN")[:count], strict=True)
    return "".join(forced if forced in "01" else state for state, forced in pairs)


def moving(controller: Controller) -> str:
    """MOV: one bit an axis."""
    axes = range(controller.settings.axes_in_use)
    return "".join("1" if controller.engine.is_moving(axis_index) else "0" for axis_index in axes)

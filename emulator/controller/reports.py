"""The reports: what each T... command answers."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller import words
from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.following.status import following_status
from emulator.controller.readings import reading_in_user_units, reading_text
from emulator.controller.settings import bit_of
from protocol.catalogue import CommandRow, status_words
from protocol.command import Command
from protocol.fields import axis_indexes
from protocol.reply import ReplyLine
from protocol.reply_shapes import bit_line, label, numbers_line, word_line
from protocol.status_report import bit_labels, status_table

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

AxisWord = Callable[["Controller", int], str]
UnitWord = Callable[["Controller"], str]

_READING_OF_REPORT = {
    "TPC": "PC",
    "TPM": "PC",
    "TPE": "PE",
    "TFB": "FB",
    "TPER": "PER",
    "TVEL": "VEL",
    "TVELA": "VELA",
    "TDAC": "DAC",
    "TANI": "PANI",
    "TPANI": "PANI",
    "TPMAS": "PMAS",
    "TNMCY": "NMCY",
    "TVMAS": "VMAS",
    "TPSLV": "PSLV",
    "TPSHF": "PSHF",
}
_AXIS_WORDS: dict[str, AxisWord] = {
    "TAS": words.axis_status,
    "TASX": words.extended_axis_status,
    "TFS": following_status,
}
_UNIT_WORDS: dict[str, UnitWord] = {
    "TSS": words.system_status,
    "TER": words.error_status,
    "TLIM": words.limit_inputs,
    "TIN": words.inputs,
    "TINO": words.other_inputs,
    "TOUT": words.outputs,
    "TUS": words.user_status,
    "TSC": lambda controller: "0" * words.WORD,
}
_AXIS_TABLES: dict[str, tuple[str, AxisWord]] = {
    "TASF": ("AS", words.axis_status),
    "TASXF": ("ASX", words.extended_axis_status),
    "TFSF": ("FS", following_status),
}
_UNIT_TABLES: dict[str, tuple[str, UnitWord]] = {
    "TSSF": ("SS", words.system_status),
    "TERF": ("ER", words.error_status),
    "TINOF": ("INO", words.other_inputs),
}

HELP_TEXT = (
    "OEM6250 EMULATOR, SOFTWARE FOR 6000 SERIES HOST PROGRAMS",
    "COMMANDS AND WHAT THEY TAKE: SEE THE PROJECT'S DOCUMENTATION",
)
"""The unit prints a support telephone number here; there is none to print."""


def _row(command: Command) -> CommandRow:
    assert command.row is not None
    return command.row


@handles(*_READING_OF_REPORT)
def report_reading(controller: Controller, command: Command) -> Lines:
    """Positions, velocities and the analogue output of the axes, and what masters do.

    Without the ANI option TANI and TPANI are 0, without a master TPMAS, TNMCY and TVMAS.
    """
    row = _row(command)
    name = _READING_OF_REPORT[row.name]
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    return [ReplyLine(label(row, command.axis), ",".join(reading_text(controller, row, name, i) for i in indexes))]


@handles(*_AXIS_WORDS)
def report_axis_word(controller: Controller, command: Command) -> Lines:
    """TAS, TASX, TFS: one line an axis; with ``.n`` the digit of each axis asked for."""
    row = _row(command)
    read = _AXIS_WORDS[row.name]
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    if command.bit is not None:
        return [bit_line(bit_of(read(controller, index), command.bit)) for index in indexes[:1]]
    if command.axis is None and controller.machine.tas_layout == "one_line":
        joined = ",".join(word_line(row, None, read(controller, index)).value for index in indexes)
        return [ReplyLine(row.name, joined)]
    return [word_line(row, index + 1, read(controller, index)) for index in indexes]


@handles(*_UNIT_WORDS)
def report_unit_word(controller: Controller, command: Command) -> Lines:
    """TSS, TER, TLIM, TIN, TINO, TOUT, TUS, TSC."""
    row = _row(command)
    bits = _UNIT_WORDS[row.name](controller)
    return [bit_line(bit_of(bits, command.bit)) if command.bit is not None else word_line(row, None, bits)]


@handles(*_AXIS_TABLES)
def report_axis_table(controller: Controller, command: Command) -> Lines:
    """TASF, TASXF, TFSF: one line a bit, one column an axis."""
    row = _row(command)
    word, read = _AXIS_TABLES[row.name]
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    columns = [read(controller, index) for index in indexes]
    labels = bit_labels(status_words()[word], len(columns[0]))
    return status_table(label(row, command.axis), labels, columns, axes=[index + 1 for index in indexes])


@handles(*_UNIT_TABLES)
def report_unit_table(controller: Controller, command: Command) -> Lines:
    """TSSF, TERF, TINOF: one line a bit."""
    row = _row(command)
    word, read = _UNIT_TABLES[row.name]
    bits = read(controller)
    return status_table(row.name, bit_labels(status_words()[word], len(bits)), [bits], axes=None)


@handles("TSTLT")
def report_settling_time(controller: Controller, command: Command) -> Lines:
    """TSTLT: milliseconds from the end of the last profile into the target zone, the last entry counting."""
    row = _row(command)
    indexes = axis_indexes(command, controller.settings.axes_in_use)
    values = [Decimal(controller.engine.settling_time_ms(index)) for index in indexes]
    return [numbers_line(row, command.axis, values, [0] * len(values))]


@handles("TREV")
def report_revision(controller: Controller, command: Command) -> Lines:
    """TREV."""
    return [ReplyLine("TREV", controller.machine.identity.revision)]


@handles("HELP")
def report_help(controller: Controller, command: Command) -> Lines:
    """HELP."""
    return [ReplyLine("", text) for text in HELP_TEXT]


@handles("TSTAT")
def report_statistics(controller: Controller, command: Command) -> Lines:
    """TSTAT: a summary of the unit (content as in the catalogue, wording assumed L)."""
    settings, axes = controller.settings, range(controller.settings.axes_in_use)
    start_up = settings.program_name("STARTP") or "NONE"
    per_axis = {
        "DRIVE": ["ON" if controller.engine.is_enabled(axis) else "OFF" for axis in axes],
        "FEEDBACK": [{0: "OPEN LOOP", 1: "ENCODER"}.get(settings.integer("SFB", axis), "ANI") for axis in axes],
        "COMMANDED POSITION": [str(reading_in_user_units(controller, "PC", axis)) for axis in axes],
        "ENCODER POSITION": [str(reading_in_user_units(controller, "PE", axis)) for axis in axes],
    }
    lines = [
        f"OEM6250 {controller.machine.identity.revision}",
        f"STARTUP PROGRAM: {start_up}",
        f"ENABLE INPUT: {'OK' if controller.wiring.enable_grounded else 'OPEN'}",
        *(f"{title}: {','.join(values)}" for title, values in per_axis.items()),
        f"SCALING: {'ON' if settings.scaled else 'OFF'}",
        *(f"{name}: {controller.query_text(name)}" for name in ("SGP", "SGI", "SGV", "SGVF", "SGAF", "LH", "LS")),
        f"LIMITS: {words.limit_inputs(controller)}",
    ]
    return [ReplyLine("", line) for line in lines]

"""What of an RMC is there and what is left out: docs/rmc-conformance.md, made from the tables of `protocol.rmc`.

python -m emulator.rmc.conformance > docs/rmc-conformance.md
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence

from protocol.rmc.bits import ErrorBits, StatusBits
from protocol.rmc.commands import COMMANDS, CommandType, Field
from protocol.rmc.maps import MAPS, STATUS_FILE, VARIABLE_FILES, Place, address_of
from protocol.rmc.registers import PARAMETERS, STATUS_REGISTERS

NEVER_RAISED = ErrorBits.NOISE
"""Error bits whose cause this device has not."""

PARTS = (
    ("Position PID, Velocity PID, Position I-PD, Velocity I-PD with all terms", "yes", ""),
    ("Double and triple differential, active damping", "yes", "axisN.rmc.high_order; no force input"),
    ("Integrator: held, active, zero; wind-down rules; frozen in saturation", "yes", "one page of rules is missing"),
    ("Symmetrical and ratioed gains, direction rule", "yes", ""),
    ("Directional Gain Ratio of old firmware (element 40)", "no", "kept, no effect"),
    ("Output chain: scale, ratio, deadband and tolerance, limit, bias, polarity", "yes", "the limit has no register"),
    ("Trapezoidal and S-curve targets, jerk output", "yes", ""),
    ("Second gain set", "no", "kept, no effect: no page at hand says what selects it"),
    ("Filters: Butterworth of fourth order, Status Only and Low-Pass", "yes", "type Model is refused"),
    ("Feedback model (elements 150 on)", "no", "kept, no effect"),
    ("Rotary axes", "no", "the Rotary bit is refused"),
    ("Analogue inputs, velocity feedback, force and pressure", "no", ""),
    ("Halts, AutoStops of four levels, halt groups", "yes", ""),
    ("Tasks, user programs, curves, sine, superimposed targets", "no", ""),
    ("Fault input, limit inputs with switches along the travel", "yes", "an open limit contact is active (assumed)"),
    ("Simulate mode of first and second order, suspension", "yes", "one gain; its force side has no equations"),
    ("Registers: RMC75 and RMC150 maps, duplicates, Indirect Data Map, REQ/ACK for each master", "yes", ""),
    ("Axis assignment, controller, communication, event log, discrete I/O, task registers", "no", "read as 0"),
    ("Modbus/TCP functions 3 4 6 8 16 23", "yes", "any other: exception 1"),
    ("EtherNet/IP, PROFINET, PROFIBUS, DMCP, FINS, Procedure Exist", "no", ""),
    ("Loop times 250 us to 4 ms, one to eight axes", "yes", "250 us: one axis, 500 us: two"),
)
"""The parts of an RMC, whether they are built, and what to know."""


def render() -> str:
    """The whole document."""
    return "\n".join([HEAD, _parts(), _commands(), _status(), _parameters(), _files(), _bits()])


HEAD = """# What of an RMC is there

Made by `python -m emulator.rmc.conformance > docs/rmc-conformance.md`; do not edit.

Sources: M = page of the digital copy of the "Delta RMC151 User Manual", H = topic of Delta's online help, L = RMCLink
help, F = Delta forum. Only part of the manual is at hand; *inferred* and *assumed* (H, M, L: how sure) say where it is
silent. Guesses that a machine file can override are in [fidelity.md](fidelity.md) under `rmc.`
"""


def _table(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [f"## {title}", "", "| " + " | ".join(heads) + " |", "| " + " | ".join("---" for _ in heads) + " |"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def _parts() -> str:
    return _table("Parts", ("part", "built", "to know"), PARTS)


def _commands() -> str:
    rows = [(str(row.number), row.title, _fields(row), "yes" if row.built else "no", row.source) for row in COMMANDS]
    said = "\nA command that is not built, not known or not possible sets the Command Error bit and does nothing.\n"
    return _table("Commands", ("no.", "command", "parameters", "built", "source"), rows) + said


def _fields(command: CommandType) -> str:
    return ", ".join(f"{field.name}{_range(field)}" for field in command.fields)


def _range(field: Field) -> str:
    if field.choices:
        return " (" + ", ".join(str(choice) for choice in field.choices) + ")"
    if field.positive:
        return " > 0"
    bounds = [f"{field.low:g}" if field.low > -1e300 else "", f"{field.high:g}" if field.high < 1e300 else ""]
    return f" {bounds[0]}..{bounds[1]}" if any(bounds) else ""


def _status() -> str:
    new = MAPS["rmc150"]
    rows = [
        (row.tag, str(row.element), str(address_of(new.status(0, row.element))), row.kind, row.unit, row.source)
        for row in STATUS_REGISTERS
    ]
    heads = ("tag", "element", "address, axis 0", "type", "unit", "source")
    return _table("Axis status registers (read-only)", heads, rows)


def _parameters() -> str:
    new = MAPS["rmc150"]
    rows = [
        (
            row.tag,
            str(row.element),
            str(address_of(new.parameter(0, row.element))),
            row.kind,
            row.unit,
            f"{row.default:g}" if row.kind == "REAL" else f"{row.default:#x}",
            row.source,
        )
        for row in PARAMETERS
    ]
    heads = ("tag", "element", "RMC150 address, axis 0", "type", "unit", "default", "source")
    said = "\nAny other element of a parameter file is kept as written and has no effect.\n"
    return _table("Axis parameters", heads, rows) + said


def _files() -> str:
    rows = []
    for row in MAPS.values():
        for what, file in (
            ("axis status", STATUS_FILE),
            ("axis parameters", row.parameter_file),
            ("small command area, 6 registers an axis", row.small_command_file),
            ("command area, 10 registers an axis", row.command_file),
            ("Indirect Map Definition", row.definition_file),
            ("Indirect Data Map", row.data_file),
            ("variables", VARIABLE_FILES[0]),
        ):
            if file is not None:
                rows.append((row.name, what, str(file), str(address_of(Place(file, 0)))))
    return _table("Files", ("map", "content", "first file", "first address"), rows)


def _bits() -> str:
    rows = [("status", str(bit.value.bit_length() - 1), _name(bit), "yes") for bit in StatusBits]
    rows += [
        ("error", str(bit.value.bit_length() - 1), _name(bit), "no" if bit & NEVER_RAISED else "yes")
        for bit in ErrorBits
    ]
    return _table("Bits", ("register", "bit", "meaning", "built"), rows)


def _name(bit: StatusBits | ErrorBits) -> str:
    return str(bit.name).replace("_", " ").lower()


if __name__ == "__main__":
    sys.stdout.write(render())

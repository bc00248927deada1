"""The machine file: which unit this is, what is wired to it, and every assumption that may be overridden.

A machine file is TOML. An empty one is the default machine: fully wired, a velocity drive and a
4000-count encoder on each axis. `bare = true` is a unit fresh out of its box with nothing wired,
which refuses to move. Everything is plain data: the engine and the controller make of it what they need.

The fields, their units and their provenance stand in `emulator.machine_tables`; the ledger made from them is
docs/fidelity.md, the guide with examples docs/machine-file.md.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import msgspec

from emulator.machine_errors import MachineError, explain
from emulator.machine_settings import check_command_name, master_conflicts, merged_settings, usual_settings
from emulator.machine_tables import (
    LOWEST_BAUD,
    REALISTIC_TIMING,
    Axis,
    Encoder,
    EncoderInput,
    ErrorLevels,
    Following,
    Identity,
    InputsOutputs,
    Limits,
    Memory,
    Options,
    Paths,
    RateRow,
    Rp240,
    Serial,
    Servo,
    Timing,
    Triggers,
    Wires,
)
from emulator.plant_tables import (
    ElasticCoupling,
    HydraulicCylinder,
    TorqueDrive,
    VelocityDrive,
    fill_preset,
    nan_keys,
    plant_conflict,
)
from emulator.rmc.tables import Rmc, rmc_conflicts
from emulator.table_fields import Table, known

__all__ = [
    "Axis",
    "ElasticCoupling",
    "Encoder",
    "HydraulicCylinder",
    "Machine",
    "MachineError",
    "TorqueDrive",
    "VelocityDrive",
]

_BARE_WIRES: Final = {"enable": "open"}
_BARE_AXIS_WIRES: Final = {"positive_limit": "open", "negative_limit": "open", "home": "open", "drive_fault": "open"}
AXIS_KEYS: Final = tuple(f"axis{number}" for number in range(1, 9))
TRIGGERS: Final = 2
"""TRG-A and TRG-B are the two bits after the programmable inputs (assumed M)."""


def _old_names() -> dict[str, str]:
    return {"LSCW": "LSPOS", "LSCCW": "LSNEG"}


class Machine(Table, frozen=True):
    """One unit with what is connected to it; the top table of a machine file."""

    identity: Annotated[Identity, known("what the unit says about itself", "assumed", "L")] = Identity()
    rp240: Annotated[Rp240, known("the operator panel", "assumed", "H")] = Rp240()
    options: Annotated[Options, known("what is fitted", "assumed", "M")] = Options()
    defaults: Annotated[
        dict[str, str],
        known("power-up setting of any command, as the field text it would be sent with", "assumed", "M"),
    ] = msgspec.field(default_factory=usual_settings)
    startp_needs_enable: Annotated[bool, known("STARTP waits for a closed ENABLE input", "assumed", "M")] = True
    errlvl: Annotated[ErrorLevels, known("error levels 3, 2 and 0", "assumed", "L")] = ErrorLevels()
    serial: Annotated[Serial, known("the line", "assumed", "M")] = Serial()
    lenient_masks: Annotated[
        bool,
        known("surplus X, 0 and empty fields are ignored", "host", source="MX and EPICS parker6k send eight digits"),
    ] = True
    answer_tpm: Annotated[bool, known("TPM answers the commanded position", "inferred", "M", "hosts ask for it")] = True
    tas_layout: Annotated[
        Literal["line_per_axis", "one_line"],
        known("bare TAS TFS TASX: one line per axis, or both words in one line", "assumed", "M"),
    ] = "line_per_axis"
    io: Annotated[InputsOutputs, known("inputs and outputs", "assumed", "M")] = InputsOutputs()
    wiring: Annotated[Literal["full", "bare"], known("everything wired, or nothing", "design")] = "full"
    bare: Annotated[bool, known('short for wiring = "bare"', "design")] = False
    drive_off_output: Annotated[
        Literal["offset", "zero"], known("output of a drive that is off: SOFFS, or 0 V", "assumed", "M")
    ] = "offset"
    aliases: Annotated[dict[str, str], known("older names of commands", "assumed", "L")] = msgspec.field(
        default_factory=_old_names
    )
    del_missing_is_error: Annotated[
        bool, known("DEL of a program that does not exist is refused", "assumed", "M", "host scripts DEL before DEF")
    ] = False
    limits: Annotated[Limits, known("field ranges", "assumed", "M")] = Limits()
    paths: Annotated[Paths, known("contour paths", "assumed", "L")] = Paths()
    memory: Annotated[Memory, known("user memory", "documented", source="UG 74, 83")] = Memory()
    timing: Annotated[Timing, known("how fast commands and programs run", "assumed", "L")] = Timing()
    servo: Annotated[Servo, known("the servo processor", "assumed", "L")] = Servo()
    encoder: Annotated[EncoderInput, known("the encoder inputs", "assumed", "L")] = EncoderInput()
    following: Annotated[Following, known("how masters are measured", "assumed", "M")] = Following()
    axis1: Annotated[Axis, known("what is connected to axis 1", "design")] = Axis()
    axis2: Annotated[Axis, known("what is connected to axis 2", "design")] = Axis()
    axis3: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    axis4: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    axis5: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    axis6: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    axis7: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    axis8: Annotated[Axis, known("axes 3 to 8: those of an RMC", "design")] = Axis()
    triggers: Annotated[Triggers, known("what the trigger inputs are connected to", "design")] = Triggers()
    wires: Annotated[Wires, known("contacts common to the unit", "design")] = Wires()
    rmc: Annotated[Rmc, known("a Delta RMC in place of the OEM6250", "design")] = Rmc()

    @classmethod
    def default(cls) -> Machine:
        """The machine of an empty file."""
        return cls()

    @classmethod
    def load(cls, path: str | Path) -> Machine:
        """Read the machine file at `path`; MachineError if it cannot be read or used."""
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "bytes that are not UTF-8"
            raise MachineError(file=str(path), key="", found=str(reason), allowed="a readable TOML file") from error
        return cls.parse(text, name=str(path))

    @classmethod
    def parse(cls, text: str, *, name: str = "<machine>") -> Machine:
        """Read a machine from TOML `text`; `name` stands for the file in a MachineError."""
        raw = _toml(text, name=name)
        _settle_wiring(raw, name=name)
        _settle_timing(raw, name=name)
        _fill_presets(raw, name=name)
        raw["defaults"] = merged_settings(raw.get("defaults", {}), file=name)
        try:
            machine = msgspec.convert(raw, cls)
        except msgspec.ValidationError as error:
            raise explain(error, raw=raw, model=cls, file=name) from None
        _check_together(machine, name=name)
        return machine

    def on_line(self, baud: int | None) -> Machine:
        """The same machine with its line at ``baud`` (0: instant, None: as it is)."""
        if baud is None:
            return self
        return msgspec.structs.replace(self, serial=msgspec.structs.replace(self.serial, baud=baud))

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """Both axes of an OEM6250, axis 1 first."""
        return (self.axis1, self.axis2)

    @property
    def all_axes(self) -> tuple[Axis, ...]:
        """The axes an RMC may have, axis 1 first."""
        return (*self.axes, self.axis3, self.axis4, self.axis5, self.axis6, self.axis7, self.axis8)

    @property
    def sign_on_lines(self) -> tuple[str, ...]:
        """The lines sent at power-up, the last one depending on the panel."""
        if not self.rp240.fitted:
            return self.identity.sign_on
        return (*self.identity.sign_on[:-1], self.rp240.sign_on_line)


def _toml(text: str, *, name: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise MachineError(file=name, key="", found=str(error), allowed="a TOML document") from None


def _settle_wiring(raw: dict[str, Any], *, name: str) -> None:
    """Make `bare` and `wiring` agree and let a bare unit's contacts start open; explicit contacts win."""
    if raw.get("bare") is True and raw.get("wiring", "bare") != "bare":
        raise MachineError(file=name, key="wiring", found=repr(raw["wiring"]), allowed='"bare" beside bare = true')
    if raw.get("bare") is True or raw.get("wiring") == "bare":
        raw["bare"], raw["wiring"] = True, "bare"
        _prefer(raw, ["wires"], _BARE_WIRES)
        _prefer(raw, ["axis1", "wires"], _BARE_AXIS_WIRES)
        _prefer(raw, ["axis2", "wires"], _BARE_AXIS_WIRES)


def _settle_timing(raw: dict[str, Any], *, name: str) -> None:
    """Expand the preset under the keys that are given, and refuse times for commands that do not exist."""
    timing = raw.get("timing")
    if not isinstance(timing, dict):
        return
    if timing.get("preset") == "realistic":
        _prefer(raw, ["timing"], REALISTIC_TIMING)
    commands = timing.get("commands")
    for command in commands if isinstance(commands, dict) else ():
        check_command_name(command, table="timing.commands", file=name)


def _fill_presets(raw: dict[str, Any], *, name: str) -> None:
    for axis in AXIS_KEYS:
        table = raw.get(axis)
        if isinstance(table, dict):
            fill_preset(table.get("plant"), key=f"{axis}.plant", file=name)
            _refuse_two_scales(table.get("encoder"), key=f"{axis}.encoder", name=name)


def _refuse_two_scales(encoder: Any, *, key: str, name: str) -> None:
    if isinstance(encoder, dict) and "counts_per_rev" in encoder and encoder.get("counts_per_unit"):
        found = repr(encoder["counts_per_unit"])
        raise MachineError(
            file=name, key=f"{key}.counts_per_unit", found=found, allowed="nothing beside counts_per_rev"
        )


def _prefer(raw: dict[str, Any], path: list[str], values: dict[str, Any]) -> None:
    table: Any = raw
    for step in path:
        table = table.setdefault(step, {}) if isinstance(table, dict) else None
    if isinstance(table, dict):
        table.update(values | table)


def _check_together(machine: Machine, *, name: str) -> None:
    """Refuse values that are each allowed but cannot stand together."""
    for key, found, allowed in _conflicts(machine):
        raise MachineError(file=name, key=key, found=found, allowed=allowed)


def _conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    return [
        *((key, "nan", "a number") for key in nan_keys(machine)),
        *_memory_conflicts(machine),
        *_wire_conflicts(machine),
        *_rate_conflicts(machine),
        *_range_conflicts(machine),
        *_travel_conflicts(machine),
        *_serial_conflicts(machine),
        *_plant_conflicts(machine),
        *_axis_conflicts(machine),
        *rmc_conflicts(machine.rmc, tuple(axis.rmc for axis in machine.all_axes)),
        *master_conflicts(machine.defaults, ani_fitted=machine.options.ani),
        *_mark_conflicts(machine),
    ]


def _serial_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    serial, conflicts = machine.serial, []
    if 0 < serial.baud < LOWEST_BAUD:
        conflicts.append(("serial.baud", str(serial.baud), f"0 (instant) or {LOWEST_BAUD} to 921,600"))
    if not serial.buffer.xoff_at_left < serial.buffer.xon_at_left <= serial.buffer.size:
        allowed = f"more than xoff_at_left, {serial.buffer.xoff_at_left}, and at most size, {serial.buffer.size}"
        conflicts.append(("serial.buffer.xon_at_left", str(serial.buffer.xon_at_left), allowed))
    return conflicts


def _memory_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    memory = machine.memory
    if memory.program_bytes + memory.compiled_bytes <= memory.total_bytes:
        return []
    room = memory.total_bytes - memory.program_bytes
    return [("memory.compiled_bytes", str(memory.compiled_bytes), f"at most {room}, what program_bytes leaves")]


def _wire_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    highest = machine.io.inputs + TRIGGERS
    return [
        ("wires.inputs", str(number), f"input numbers 1 to {highest}")
        for number in machine.wires.inputs
        if not 1 <= number <= highest
    ]


def _range_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    accel = machine.limits.accel
    if accel.minimum < accel.maximum:
        return []
    return [("limits.accel.maximum", f"{accel.maximum:g}", f"a number above minimum, {accel.minimum:g}")]


def _travel_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    conflicts = []
    for number, axis in enumerate(machine.all_axes, start=1):
        key, travel = f"axis{number}.travel", axis.travel
        if not travel.negative_limit_rev < travel.positive_limit_rev:
            found = f"{travel.positive_limit_rev:g}"
            conflicts.append((f"{key}.positive_limit_rev", found, f"above {travel.negative_limit_rev:g}"))
        no_home = travel.home_from_rev == math.inf and travel.home_to_rev == -math.inf
        if not no_home and not travel.home_from_rev < travel.home_to_rev:
            found = f"{travel.home_to_rev:g}"
            conflicts.append((f"{key}.home_to_rev", found, f"above home_from_rev, {travel.home_from_rev:g}"))
    return conflicts


def _mark_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    return [
        (f"triggers.{letter}.every_rev", f"{trigger.every_rev:g}", f"0 or above width_rev, {trigger.width_rev:g}")
        for letter, trigger in (("a", machine.triggers.a), ("b", machine.triggers.b))
        if trigger.every_rev != 0.0 and not trigger.every_rev > trigger.width_rev
    ]


def _plant_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    conflicts = []
    for number, axis in enumerate(machine.all_axes, start=1):
        if (conflict := plant_conflict(axis.plant)) is not None:
            key, found, allowed = conflict
            conflicts.append((f"axis{number}.plant.{key}", found, allowed))
        if axis.encoder.counts_per_unit and not isinstance(axis.plant, HydraulicCylinder):
            found = str(axis.encoder.counts_per_unit)
            conflicts.append(
                (f"axis{number}.encoder.counts_per_unit", found, "nothing unless a hydraulic_cylinder moves")
            )
    return conflicts


def _axis_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    """Axes beyond the second are an RMC's, as many as it has."""
    beyond = max(machine.rmc.axes, len(machine.axes))
    return [
        (f"axis{number}", "a table", f"nothing unless rmc.axes is {number} or more")
        for number, axis in enumerate(machine.all_axes, start=1)
        if number > beyond and axis != Axis()
    ]


def _rate_conflicts(machine: Machine) -> list[tuple[str, str, str]]:
    table = machine.servo.ssfr_table
    groups = {"indax1": table.indax1, "indax2": table.indax2}
    return [problem for group, rows in groups.items() for problem in _row_conflicts(group, rows)]


def _row_conflicts(group: str, rows: tuple[RateRow, ...]) -> list[tuple[str, str, str]]:
    key = f"servo.ssfr_table.{group}"
    ratios = [row.ssfr for row in rows]
    problems = [] if sorted(ratios) == [1, 2, 4, 8] else [(key, f"ssfr {ratios}", "one row each for 1, 2, 4, 8")]
    for index, row in enumerate(rows):
        if row.trajectory_us % row.servo_us:
            problems.append((f"{key}.{index}.trajectory_us", str(row.trajectory_us), f"a multiple of {row.servo_us}"))
        if row.system_us % row.trajectory_us:
            problems.append((f"{key}.{index}.system_us", str(row.system_us), f"a multiple of {row.trajectory_us}"))
    return problems

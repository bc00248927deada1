"""The plant tables of a machine file: what one axis's analogue output moves, one table a kind, with presets.

Every value is a design choice: not a claim about the unit, but what is connected to it. Whether values make sense
together is for the engine's plants to say; `plant_conflict` asks them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import msgspec

from emulator.machine_errors import MachineError
from emulator.table_fields import Table, known

if TYPE_CHECKING:
    from emulator.engine import Plant

Preset = Annotated[str, known("name of a preset, which gives the keys not given here; empty = none", "design")]
Backlash = Annotated[float, known("play between motor and load, rev", "design", ge=0, le=1e6)]
LoadTorque = Annotated[
    float, known("load torque, Nm; positive acts against positive motion, as gravity on a lifted load does", "design")
]


class VelocityDrive(Table, frozen=True, tag_field="kind", tag="velocity_drive"):
    """A drive that closes its own velocity loop; the command voltage asks for a speed."""

    preset: Preset = ""
    speed_per_volt_rev_s: Annotated[float, known("speed asked by one volt, rev/s", "design", gt=0)] = 10.0
    loop_time_constant_s: Annotated[float, known("lag of the drive's velocity loop, s", "design", gt=0, le=10)] = 0.002
    command_lag_s: Annotated[float, known("lag of the command input, s", "design", ge=0, le=10)] = 0.0003
    max_acceleration_rev_s2: Annotated[float, known("peak torque over inertia, rev/s2; inf = none", "design", gt=0)] = (
        5000.0
    )
    coast_time_constant_s: Annotated[float, known("run-down when shut down, s", "design", gt=0, le=1000)] = 0.05
    droop_rev_s_per_nm: Annotated[
        float, known("speed lost per Nm of load, rev/s; 0 = the drive's integrator holds the speed", "design", ge=0)
    ] = 0.0
    load_torque_nm: LoadTorque = 0.0
    backlash_rev: Backlash = 0.0


class TorqueDrive(Table, frozen=True, tag_field="kind", tag="torque_drive"):
    """A torque amplifier with motor and load; the command voltage asks for a torque."""

    preset: Preset = ""
    torque_per_volt_nm: Annotated[float, known("torque asked by one volt, Nm", "design", gt=0)] = 0.5
    inertia_kg_m2: Annotated[float, known("motor plus load, kg m2", "design", gt=0)] = 2.0e-4
    viscous_nm_s_per_rev: Annotated[float, known("viscous friction, Nm per rev/s", "design", ge=0)] = 0.001
    coulomb_nm: Annotated[float, known("Coulomb friction, Nm", "design", ge=0)] = 0.0
    load_torque_nm: LoadTorque = 0.0
    peak_torque_nm: Annotated[float, known("largest torque of the drive, Nm; inf = none", "design", gt=0)] = 5.0
    backlash_rev: Backlash = 0.0


class ElasticCoupling(Table, frozen=True, tag_field="kind", tag="elastic_coupling"):
    """Motor and load on a springy shaft, behind a torque- or velocity-mode drive: a two-mass resonance."""

    preset: Preset = ""
    drive: Annotated[Literal["torque", "velocity"], known("what one volt asks for", "design")] = "torque"
    torque_per_volt_nm: Annotated[float, known("torque asked by one volt, Nm; torque mode", "design", gt=0)] = 0.3
    speed_per_volt_rev_s: Annotated[float, known("speed asked by one volt, rev/s; velocity mode", "design", gt=0)] = (
        10.0
    )
    loop_time_constant_s: Annotated[
        float, known("lag of the drive's velocity loop were the shaft rigid, s; velocity mode", "design", gt=0, le=10)
    ] = 0.005
    peak_torque_nm: Annotated[float, known("largest torque of the drive, Nm; inf = none", "design", gt=0)] = 5.0
    motor_inertia_kg_m2: Annotated[float, known("motor, kg m2", "design", gt=0)] = 1.0e-4
    load_inertia_kg_m2: Annotated[float, known("load, kg m2", "design", gt=0)] = 2.0e-4
    stiffness_nm_per_rad: Annotated[float, known("stiffness of the coupling, Nm/rad", "design", gt=0)] = 30.0
    damping_nm_s_per_rad: Annotated[float, known("damping of the coupling, Nm s/rad", "design", ge=0)] = 0.005
    motor_viscous_nm_s_per_rev: Annotated[
        float, known("viscous friction of the motor, Nm per rev/s", "design", ge=0)
    ] = 0.001
    load_viscous_nm_s_per_rev: Annotated[float, known("viscous friction of the load, Nm per rev/s", "design", ge=0)] = (
        0.001
    )
    motor_coulomb_nm: Annotated[float, known("Coulomb friction of the motor, Nm", "design", ge=0)] = 0.0
    load_coulomb_nm: Annotated[float, known("Coulomb friction of the load, Nm", "design", ge=0)] = 0.0
    load_torque_nm: LoadTorque = 0.0
    backlash_rev: Annotated[float, known("play behind the load's inertia, rev", "design", ge=0, le=1e6)] = 0.0


class HydraulicCylinder(Table, frozen=True, tag_field="kind", tag="hydraulic_cylinder"):
    """A cylinder on a proportional or servo valve; one unit of length is the encoder's, inch or millimetre."""

    preset: Preset = ""
    extend_units_s_per_v: Annotated[float, known("speed outwards per volt, units/s", "design", gt=0)] = 3.0
    retract_units_s_per_v: Annotated[float, known("speed inwards per volt, units/s", "design", gt=0)] = 2.3
    overlap_v: Annotated[float, known("deadband: volts either way before anything flows", "design", ge=0, le=10)] = 0.0
    valve_hz: Annotated[float, known("natural frequency of the valve, Hz", "design", gt=0, le=20_000)] = 60.0
    valve_damping: Annotated[float, known("damping ratio of the valve, 1 = critical", "design", gt=0, le=100)] = 0.8
    max_speed_units_s: Annotated[float, known("speed at the pump's full flow, units/s; inf = none", "design", gt=0)] = (
        math.inf
    )
    extended_stop_units: Annotated[float, known("outer end stop, units from the start; inf = none", "design")] = (
        math.inf
    )
    retracted_stop_units: Annotated[
        float, known("inner end stop, units from the start; -inf = none", "design")
    ] = -math.inf
    backlash_units: Annotated[float, known("play between piston and load, units", "design", ge=0, le=1e6)] = 0.0


PlantTable: TypeAlias = VelocityDrive | TorqueDrive | ElasticCoupling | HydraulicCylinder

KINDS: dict[str, type[PlantTable]] = {
    "velocity_drive": VelocityDrive,
    "torque_drive": TorqueDrive,
    "elastic_coupling": ElasticCoupling,
    "hydraulic_cylinder": HydraulicCylinder,
}

PRESETS: dict[str, dict[str, dict[str, float | str]]] = {
    "velocity_drive": {
        "brushless_velocity": {"max_acceleration_rev_s2": 8000.0, "loop_time_constant_s": 0.0015},
        "brush_velocity": {
            "speed_per_volt_rev_s": 5.0,
            "loop_time_constant_s": 0.01,
            "command_lag_s": 0.001,
            "max_acceleration_rev_s2": 800.0,
            "coast_time_constant_s": 0.3,
        },
        "drooping_spindle": {
            "speed_per_volt_rev_s": 6.0,
            "loop_time_constant_s": 0.03,
            "max_acceleration_rev_s2": 300.0,
            "coast_time_constant_s": 2.0,
            "droop_rev_s_per_nm": 0.2,
        },
    },
    "torque_drive": {
        "small_brushless": {
            "torque_per_volt_nm": 0.1,
            "inertia_kg_m2": 3.0e-5,
            "viscous_nm_s_per_rev": 2.0e-4,
            "coulomb_nm": 0.01,
            "peak_torque_nm": 1.0,
        },
        "large_brushless": {
            "torque_per_volt_nm": 2.0,
            "inertia_kg_m2": 3.0e-3,
            "viscous_nm_s_per_rev": 0.02,
            "coulomb_nm": 0.2,
            "peak_torque_nm": 20.0,
        },
        "vertical_axis": {
            "torque_per_volt_nm": 0.5,
            "inertia_kg_m2": 4.0e-4,
            "viscous_nm_s_per_rev": 0.002,
            "coulomb_nm": 0.05,
            "load_torque_nm": 0.8,
        },
    },
    "elastic_coupling": {
        "timing_belt": {
            "motor_inertia_kg_m2": 1.0e-4,
            "load_inertia_kg_m2": 8.0e-4,
            "stiffness_nm_per_rad": 20.0,
            "damping_nm_s_per_rad": 0.01,
            "load_coulomb_nm": 0.05,
        },
        "ball_screw": {
            "motor_inertia_kg_m2": 2.0e-4,
            "load_inertia_kg_m2": 1.0e-4,
            "stiffness_nm_per_rad": 400.0,
            "damping_nm_s_per_rad": 0.02,
            "load_coulomb_nm": 0.1,
            "backlash_rev": 0.0005,
        },
        "long_shaft": {
            "drive": "velocity",
            "speed_per_volt_rev_s": 5.0,
            "loop_time_constant_s": 0.01,
            "peak_torque_nm": 20.0,
            "motor_inertia_kg_m2": 1.0e-3,
            "load_inertia_kg_m2": 5.0e-3,
            "stiffness_nm_per_rad": 60.0,
            "damping_nm_s_per_rad": 0.05,
        },
    },
    "hydraulic_cylinder": {
        "documented_cylinder": {"extend_units_s_per_v": 3.0, "retract_units_s_per_v": 2.3},
        "servo_valve": {"valve_hz": 100.0, "valve_damping": 0.9, "max_speed_units_s": 20.0},
        "proportional_valve": {
            "overlap_v": 0.5,
            "valve_hz": 25.0,
            "valve_damping": 1.0,
            "max_speed_units_s": 12.0,
        },
    },
}
"""Keys given by each preset of each kind; all design choices, in round numbers."""


def fill_preset(raw: Any, *, key: str, file: str) -> None:
    """Fill a raw plant table from the preset it names: its kind, if that is not given, and the keys not given.

    MachineError for an unknown preset, or one of another kind. Whatever else may be wrong is left for the tables.
    """
    name = raw.get("preset") if isinstance(raw, dict) else None
    if not isinstance(name, str) or not name:
        return
    kinds = [kind for kind in KINDS if name in PRESETS[kind] and raw.get("kind", kind) == kind]
    if not kinds:
        offered = [each for kind in KINDS if raw.get("kind", kind) == kind for each in PRESETS[kind]]
        if not offered:
            return
        of_kind = f" for a {raw['kind']}" if "kind" in raw else ""
        raise MachineError(file=file, key=f"{key}.preset", found=repr(name), allowed=" or ".join(offered) + of_kind)
    raw.update({"kind": kinds[0], **PRESETS[kinds[0]][name]} | raw)


def engine_plant(table: PlantTable) -> Plant:
    """The plant of a table in the engine's terms; its PlantError names the key that is wrong."""
    from emulator import engine

    values = {name: getattr(table, name) for name in table.__struct_fields__ if name != "preset"}
    plant: Plant = getattr(engine, type(table).__name__)(**values)
    return plant


def plant_conflict(table: PlantTable) -> tuple[str, str, str] | None:
    """Key, what was found and what is allowed, of a table whose values cannot stand together; None if they can."""
    if table == type(table)():
        return None
    from emulator.engine import PlantError

    try:
        engine_plant(table)
    except PlantError as error:
        return error.parameter, error.found, error.allowed
    return None


def nan_keys(value: Any, prefix: str = "") -> list[str]:
    """Dotted keys of everything in a table that is not a number."""
    if isinstance(value, float):
        return [prefix] if math.isnan(value) else []
    if not isinstance(value, msgspec.Struct):
        return []
    names = zip(value.__struct_fields__, value.__struct_encode_fields__, strict=True)
    return [key for name, shown in names for key in nan_keys(getattr(value, name), f"{prefix}.{shown}".lstrip("."))]

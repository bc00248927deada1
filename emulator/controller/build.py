"""From the machine file to the parts of a controller: the one place that knows both vocabularies."""

from __future__ import annotations

import math
from decimal import Decimal

from emulator.controller.changes import Changes
from emulator.controller.settings import Settings
from emulator.encoder_motion_tables import engine_motion
from emulator.engine import (
    AnalogSensor,
    AxisHardware,
    EncoderTraits,
    Engine,
    MarkSensor,
    MasterMeasurement,
    ServoRates,
    Travel,
    UnitFactors,
)
from emulator.engine.machine_code import OnBuild
from emulator.machine import Axis, Machine
from emulator.machine_tables import Trigger
from emulator.plant_tables import engine_plant


def build_settings(machine: Machine, changes: Changes) -> Settings:
    """The settings store with the machine's power-up defaults and ranges."""
    accel = machine.limits.accel
    return Settings(
        {"MEMORY": f"{machine.memory.program_bytes},{machine.memory.compiled_bytes}", **machine.defaults},
        acceleration_range=(Decimal(str(accel.minimum)), Decimal(str(accel.maximum))),
        ani_fitted=machine.options.ani,
        lenient_masks=machine.lenient_masks,
        changes=changes,
    )


def build_engine(machine: Machine, settings: Settings, on_build: OnBuild | None) -> Engine:
    """The servo engine with the machine's axes."""
    engine = Engine(
        [
            axis_hardware(axis, max_rate_counts_s=machine.encoder.max_rate, ani_fitted=machine.options.ani)
            for axis in machine.axes
        ],
        rates=rates_in_force(machine, settings),
        dac_bits=machine.servo.dac_bits,
        on_build=on_build,
        unit_factors=unit_factors(machine),
        drive_off_to_zero=machine.drive_off_output == "zero",
        output_delay_s=machine.servo.output_delay_us * 1e-6,
        measurement=MasterMeasurement(
            one_sample_predictor=machine.following.predictor == "one_sample",
            filter_order=machine.following.filter_order,
        ),
    )
    for trigger_index, trigger in enumerate((machine.triggers.a, machine.triggers.b)):
        engine.fit_mark_sensor(trigger_index, mark_sensor(trigger))
    return engine


def mark_sensor(trigger: Trigger) -> MarkSensor | None:
    """The sensor at a trigger, in the engine's terms."""
    if trigger.marks_on == "none":
        return None
    axis_index = int(trigger.marks_on[-1]) - 1
    return MarkSensor(axis_index, trigger.at_rev, every_rev=trigger.every_rev, width_rev=trigger.width_rev)


def unit_factors(machine: Machine) -> UnitFactors:
    """Volts per unit of each gain command: the family's, times what the machine file says."""
    family, file = UnitFactors(), machine.servo.unit_factors
    return UnitFactors(
        sgp=family.sgp * file.sgp,
        sgi=family.sgi * file.sgi,
        sgv=family.sgv * file.sgv,
        sgvf=family.sgvf * file.sgvf,
        sgaf=family.sgaf * file.sgaf,
    )


def rates_in_force(machine: Machine, settings: Settings) -> ServoRates:
    """Servo sample, trajectory and system update for the present INDAX and SSFR."""
    row = machine.servo.ssfr_table.row(indax=settings.axes_in_use, ssfr=settings.integer("SSFR"))
    return ServoRates.from_us(servo_us=row.servo_us, trajectory_us=row.trajectory_us, system_us=row.system_us)


def axis_hardware(axis: Axis, *, max_rate_counts_s: float = math.inf, ani_fitted: bool = False) -> AxisHardware:
    """What an axis is connected to, in the engine's terms."""
    switches, encoder = axis.travel, axis.encoder
    return AxisHardware(
        plant=engine_plant(axis.plant),
        counts_per_rev=encoder.counts,
        encoder_phase=encoder.phase,
        index_phase_rev=encoder.index_phase,
        travel=Travel(
            positive_limit_rev=switches.positive_limit_rev,
            negative_limit_rev=switches.negative_limit_rev,
            home_from_rev=switches.home_from_rev,
            home_to_rev=switches.home_to_rev,
        ),
        ani=AnalogSensor(axis.ani.volts_at_zero, axis.ani.volts_per_rev) if ani_fitted else None,
        encoder=EncoderTraits(
            on_load=encoder.at == "load",
            noise_counts_rms=encoder.noise_counts,
            noise_seed=encoder.noise_seed,
            max_rate_counts_s=max_rate_counts_s,
        ),
        motion=engine_motion(axis.encoder_motion),
    )

"""A step experiment as plain data, run in batches: one axis, its drive and load, a move, and lanes that differ in
gains, plant or encoder phase.

The axis is measured in an engine of its own with the rates of the whole unit: servo, trajectory and system update are
those of the unit's INDAX, the other axis costs nothing. Everything here can be pickled, and a lane's result depends on
nothing but the lane, so an experiment may be cut into batches and sent to other processes or machines as one likes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import msgspec
import numpy as np
import numpy.typing as npt

from emulator.controller.build import axis_hardware, build_settings, rates_in_force, unit_factors
from emulator.controller.changes import Changes
from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.controller.settings import Settings
from emulator.engine import AxisHardware, Engine, Gains, Plant, Segments, ServoRates, UnitFactors, plan_preset
from emulator.engine.batch import Batch
from emulator.engine.control_law import gain_fields
from emulator.engine.trace import Column, Source
from emulator.machine import Axis, Machine
from emulator.plant_tables import engine_plant
from emulator.tuning.measures import Floats, StepBatch, measure_steps

NS_PER_S = 1_000_000_000

START_PHASES = (0.1, 0.45, 0.8)
"""Where within a count the shaft stands at the start: a quantised loop that is quiet from one place may chatter from
another, so every experiment is made from several (design choice)."""

REST_S = 0.05
"""Time the axis holds its position before the move, s, in which a load or an offset makes itself felt (design
choice)."""

COMMANDED = Source("commanded_counts", 0)
ACTUAL = Source("feedback_counts", 0)
OUTPUT = Source("dac_v", 0)


@dataclass(frozen=True, slots=True)
class Move:
    """A preset move in the units of the commands: A and AD rev/s2, V rev/s, D counts.

    The defaults are the guide's step-input profile, A999 AD999 V30 D100 (OEM6250 Installation Guide p. 48).
    """

    acceleration_rev_s2: float = 999.0
    deceleration_rev_s2: float = 999.0
    velocity_rev_s: float = 30.0
    distance_counts: int = 100

    def __post_init__(self) -> None:
        if self.distance_counts == 0:
            raise ValueError("a step of 0 counts has no length to measure")
        if not min(self.acceleration_rev_s2, self.deceleration_rev_s2, self.velocity_rev_s) > 0.0:
            raise ValueError(f"accelerations and velocity of a move must be above 0: {self}")


@dataclass(frozen=True, slots=True)
class StepExperiment:
    """One axis with all that shapes its step response, gains and plant being those of lanes that say nothing else."""

    hardware: AxisHardware
    rates: ServoRates
    counts_per_rev: int
    """ERES: what makes counts of revolutions per second in a move."""
    gains: Gains = field(default_factory=Gains)
    factors: UnitFactors = field(default_factory=UnitFactors)
    move: Move = field(default_factory=Move)
    duration_s: float = 1.0
    """Recorded from the start of the move, s."""
    phases: tuple[float, ...] = START_PHASES
    dac_bits: int = 16
    output_delay_s: float = 0.0
    offset_v: float = 0.0
    output_limit_v: float = 10.0
    position_error_limit_counts: int = 4000
    encoder_reversed: bool = False
    command_reversed: bool = False
    settle_counts: float | None = None
    """Half-width of the settling band; None: the measures' own."""

    def __post_init__(self) -> None:
        if not self.rates.system_ns / NS_PER_S < self.duration_s < math.inf:
            raise ValueError(f"a recording of {self.duration_s:g} s is not possible")
        if not self.phases or not all(0.0 <= phase < 1.0 for phase in self.phases):
            raise ValueError(f"encoder phases are one or more numbers from 0 to below 1, not {self.phases}")

    @classmethod
    def of_machine(cls, machine: Machine, axis_index: int) -> StepExperiment:
        """The experiment on one axis of a machine as it is at power-up; ValueError for an axis in open loop or on ANI
        feedback, which has no encoder counts to step by."""
        settings = build_settings(machine, Changes())
        if settings.integer("SFB", axis_index) != 1:
            raise ValueError(f"axis {axis_index + 1} has no encoder feedback (SFB)")
        return cls(
            hardware=axis_hardware(machine.axes[axis_index], max_rate_counts_s=machine.encoder.max_rate),
            rates=rates_in_force(machine, settings),
            counts_per_rev=settings.integer("ERES", axis_index),
            gains=gains_in_force(settings, axis_index),
            factors=unit_factors(machine),
            dac_bits=machine.servo.dac_bits,
            output_delay_s=machine.servo.output_delay_us * 1e-6,
            offset_v=float(settings.number("SOFFS", axis_index)),
            output_limit_v=float(settings.number("DACLIM", axis_index)),
            position_error_limit_counts=int(settings.counts("SMPER", axis_index)),
            encoder_reversed=settings.flag("ENCPOL", axis_index),
            command_reversed=settings.flag("CMDDIR", axis_index),
        )

    @property
    def step_counts(self) -> int:
        """Signed length of the step."""
        return self.move.distance_counts


@dataclass(frozen=True, slots=True)
class Lanes:
    """What differs from lane to lane: arrays of shape (lanes,) or (lanes, 6), the columns in the order of
    GAIN_COMMANDS."""

    gains: Floats
    phases: Floats
    plants: Sequence[Plant] = ()
    """Plants some lanes have; empty: every lane has the experiment's own."""
    plant_of: npt.NDArray[np.int64] | None = None
    """Index into `plants` of each lane."""

    def __len__(self) -> int:
        return len(self.gains)


@dataclass(frozen=True, slots=True)
class Responses:
    """The measures of each lane, and whether its position error exceeded SMPER, which shut its drive down."""

    measures: StepBatch
    tripped: npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Recording:
    """Recorded signals: times from the sample before the move's first, s, shape (rows,); the others (lanes, rows)."""

    times_s: Floats
    commanded_counts: Column
    actual_counts: Column
    output_v: Column
    tripped: npt.NDArray[np.bool_]


def gains_in_force(settings: Settings, axis_index: int) -> Gains:
    """The gains a controller has set for an axis."""
    return Gains(*(float(settings.number(name, axis_index)) for name in GAIN_COMMANDS))


def with_plant_factors(axis: Axis, factors: dict[str, float]) -> Plant:
    """The plant of an axis with some of its quantities multiplied; ValueError for names it does not have, and for
    values no plant can have."""
    changed: dict[str, float] = {}
    for name, factor in factors.items():
        value = getattr(axis.plant, name, None)
        if isinstance(value, bool) or not isinstance(value, int | float):
            names = [key for key in axis.plant.__struct_fields__ if isinstance(getattr(axis.plant, key), int | float)]
            raise ValueError(f"the plant has no quantity {name!r}; there are {', '.join(names)}")
        changed[name] = value * factor
    return engine_plant(msgspec.structs.replace(axis.plant, **changed))


def measure_lanes(experiment: StepExperiment, lanes: Lanes) -> Responses:
    """Run every lane in one compiled call and measure it."""
    recording = record_lanes(experiment, lanes)
    measures = measure_steps(
        recording.times_s,
        recording.commanded_counts,
        recording.actual_counts,
        recording.output_v,
        start=0.0,
        setpoint=experiment.step_counts,
        settle_counts=experiment.settle_counts,
    )
    return Responses(measures, recording.tripped)


def record_lanes(experiment: StepExperiment, lanes: Lanes) -> Recording:
    """Run every lane in one compiled call for the rest and one for the move, and return what happened."""
    template, began_ns = _template(experiment)
    batch = Batch(template, len(lanes))
    _differ(batch, experiment, lanes)
    batch.run(began_ns - 1)
    batch.axes["profile_active"][:, 0] = batch.axes["enabled"][:, 0]
    batch.run(began_ns + round(experiment.duration_s * NS_PER_S) + template.rates.servo_ns)
    times_ns, columns = batch.traces()
    rest = int(np.searchsorted(times_ns, began_ns)) - 1
    return Recording(
        times_s=(times_ns[rest:] - times_ns[rest]) / NS_PER_S,
        commanded_counts=columns[COMMANDED][:, rest:],
        actual_counts=columns[ACTUAL][:, rest:],
        output_v=columns[OUTPUT][:, rest:],
        tripped=batch.axes["enabled"][:, 0] == 0,
    )


def _template(experiment: StepExperiment) -> tuple[Engine, int]:
    """An engine ready to run, its scope armed and its move loaded, and the time at which that shall start, ns."""
    engine = Engine(
        [replace(experiment.hardware, encoder_phase=0.0)],
        rates=experiment.rates,
        dac_bits=experiment.dac_bits,
        unit_factors=experiment.factors,
        output_delay_s=experiment.output_delay_s,
    )
    engine.set_polarity(0, encoder=int(experiment.encoder_reversed), command=int(experiment.command_reversed))
    engine.set_output(0, offset_v=experiment.offset_v, limit_v=experiment.output_limit_v)
    engine.set_position_error_limit(0, experiment.position_error_limit_counts)
    engine.set_hard_limits(0, enable=0)
    engine.enable(0)
    engine.start_profile(0, _profile(experiment.move, experiment.counts_per_rev))
    return engine, _arm(engine, experiment.duration_s)


def _profile(move: Move, counts_per_rev: int) -> Segments:
    return plan_preset(
        0.0,
        0.0,
        float(move.distance_counts),
        move.velocity_rev_s * counts_per_rev,
        move.acceleration_rev_s2 * counts_per_rev,
        move.deceleration_rev_s2 * counts_per_rev,
    )


def _arm(engine: Engine, duration_s: float) -> int:
    """Hold the move back until the axis has rested, and let the scope record everything; returns its start, ns."""
    rates = engine.rates
    updates = math.ceil(REST_S * NS_PER_S / rates.trajectory_ns)
    began_ns = engine.next_trajectory_ns + updates * rates.trajectory_ns
    engine.memory.axes["profile_active"] = 0
    engine.memory.axes["profile_start_ns"] = began_ns
    rows = (began_ns + int(duration_s * NS_PER_S)) // rates.servo_ns
    engine.scope.arm((COMMANDED, ACTUAL, OUTPUT), rows=rows)
    return began_ns


def _differ(batch: Batch, experiment: StepExperiment, lanes: Lanes) -> None:
    """Give every lane its gains, encoder phase and plant, in whole columns."""
    axes = batch.axes
    for name, column in _gain_columns(lanes.gains, experiment.factors).items():
        axes[name][:, 0] = column
    axes["encoder_phase"][:, 0] = lanes.phases
    if lanes.plant_of is None:
        return
    for index, each in enumerate(lanes.plants):
        own = np.flatnonzero(lanes.plant_of == index)
        if not len(own):
            continue
        batch.set_plant(int(own[0]), 0, each)
        for run in np.split(own, np.flatnonzero(np.diff(own) != 1) + 1):
            batch.copy_plant(0, source=int(own[0]), lanes=slice(int(run[0]), int(run[-1]) + 1))


def _gain_columns(table: Floats, factors: UnitFactors) -> dict[str, Floats]:
    """Fields of the axis records, each a column over the lanes, from gains in the units of the commands."""
    per_unit = gain_fields(Gains(*([1.0] * len(GAIN_COMMANDS))), factors)
    return {name: table[:, place] * factor for place, (name, factor) in enumerate(per_unit.items())}

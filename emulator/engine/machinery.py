"""What a unit's axes are connected to, and how that can be changed while it runs: plants, loads, encoders.

The writing half of `Engine` that belongs to the machine rather than to the servo. `axis_index` counts from 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .encoder import ENCODER_SOURCE, HIGHEST_COUNTS_PER_REV, AnalogSensor, EncoderTraits, EncoderWiring, read_ani
from .encoder_motion import EncoderMotion, drive_encoder, driven_velocity
from .events import Wire, wire_mask
from .layout import PLANT, UNIT, word_of
from .memory import Memory, write_fields
from .plants import WORLD_END_REV, Plant, VelocityDrive, load_fields, plant_fields
from .rates import NS_PER_S
from .readings import ENCODER, axis_word
from .travel import Travel, operate_switches
from .trigger_inputs import TriggerInputs

_SERVO = word_of(UNIT, "servo_ns")
_PHASE, _READING = axis_word("encoder_phase"), axis_word("encoder_reading")
_SIGN, _POLARITY, _WIRING = (axis_word(name) for name in ("encoder_sign", "encoder_polarity", "encoder_wiring"))
_APART = axis_word("load_apart")
_OUTPUT_SIGN = axis_word("output_sign")
_TIME = word_of(UNIT, "time_ns")
_DRIVEN, _DRIVEN_COUNTS = axis_word("encoder_driven"), axis_word("driven_counts")
_ON_LOAD, _COUNTS_PER_REV = axis_word("encoder_on_load"), axis_word("counts_per_rev")
_MOTION_START = axis_word("motion_start_ns")


LOAD_FIELDS = ("load_apart", "half_backlash", "encoder_step_limit", "encoder_easy_step")
"""Fields of the axis record that depend on the plant."""


@dataclass(frozen=True, slots=True)
class AxisHardware:
    """What one axis is connected to: drive and load, and an encoder counted post-quadrature."""

    plant: Plant = field(default_factory=VelocityDrive)
    counts_per_rev: int = 4000
    encoder_phase: float = 0.0
    """Position of the count edges within a count, 0 to 1."""
    start_position_rev: float = 0.0
    index_phase_rev: float = 0.0
    """Where in each revolution the index (Z) pulse lies, 0 to 1."""
    travel: Travel = field(default_factory=Travel)
    """The switches that follow the load."""
    ani: AnalogSensor | None = None
    """The sensor at the ANI feedback input; None: the option is not fitted."""
    encoder: EncoderTraits = field(default_factory=EncoderTraits)
    """Where the encoder sits, and its imperfections."""
    motion: EncoderMotion | None = None
    """What else turns the encoder; None: the axis itself does."""

    def __post_init__(self) -> None:
        if not 1 <= self.counts_per_rev <= HIGHEST_COUNTS_PER_REV:
            raise ValueError(f"counts_per_rev must be 1 to {HIGHEST_COUNTS_PER_REV}, not {self.counts_per_rev}")
        if not abs(self.start_position_rev) <= WORLD_END_REV:
            raise ValueError(f"start_position_rev must be within +-{WORLD_END_REV:g}, not {self.start_position_rev}")

    def encoder_reading(self, position_rev: float) -> float:
        """Counts the encoder shows with its shaft at a position."""
        return (position_rev * self.counts_per_rev + self.encoder_phase) // 1


class Machinery(TriggerInputs):
    """Drives, loads and encoders of one unit's axes."""

    def __init__(self, memory: Memory, *, output_delay_s: float) -> None:
        super().__init__(memory)
        self._plants: list[Plant] = [VelocityDrive() for _ in memory.axis]
        self._encoders = [EncoderTraits() for _ in memory.axis]
        self._output_delay_s = output_delay_s

    def _connect(self, axis_index: int, hardware: AxisHardware) -> None:
        """Connect an axis, its counter at 0; the plant's coefficients follow with the rates."""
        self._plants[axis_index], self._encoders[axis_index] = hardware.plant, hardware.encoder
        start_rev = hardware.start_position_rev
        self._write(
            axis_index,
            feedback_source=ENCODER_SOURCE,
            output_sign=1,
            ani_sign=1,
            ani_fitted=hardware.ani is not None,
            true_position=start_rev,
            load_position=start_rev,
            positive_limit_mask=wire_mask(Wire.POSITIVE_LIMIT, axis_index),
            negative_limit_mask=wire_mask(Wire.NEGATIVE_LIMIT, axis_index),
            home_mask=wire_mask(Wire.HOME, axis_index),
            home_active_level=1,
            counts_per_rev=hardware.counts_per_rev,
            encoder_phase=hardware.encoder_phase,
            encoder_reading=hardware.encoder_reading(start_rev),
            index_reading=hardware.encoder_reading(hardware.index_phase_rev),
            **hardware.encoder.fields(axis_index),
            **hardware.travel.fields(),
            **(hardware.ani or AnalogSensor()).fields(),
        )
        if hardware.motion is not None:
            origin = start_rev * hardware.counts_per_rev
            self._write(axis_index, **hardware.motion.fields(origin_counts=origin, now_ns=0))
        read_ani(self._memory.axes[axis_index])
        operate_switches(self._memory.units[0], self._memory.axes[axis_index])

    # Plants

    def _set_steps(self) -> None:
        """Work out anew, for the servo period in force, what the machines do in a sample."""
        for axis_index, plant in enumerate(self._plants):
            self.set_plant(axis_index, plant)

    def plant(self, axis_index: int) -> Plant:
        """The drive and load of an axis."""
        return self._plants[axis_index]

    def set_plant(self, axis_index: int, plant: Plant) -> None:
        """Change the drive and load of an axis while it runs; its position and speed go on.

        Between plants of different kinds the new one begins with a straight shaft and a shut valve.
        """
        if not self._ints[axis_index][_APART]:
            self._write(axis_index, load_position=self.true_position_rev(axis_index))
        if type(plant) is not type(self._plants[axis_index]):
            speed = self.true_velocity_rev_s(axis_index)
            self._write(axis_index, twist=0.0, load_velocity=speed, spool=0.0, spool_rate=0.0, lagged_command=speed)
        self._plants[axis_index] = plant
        self._write(axis_index, **self.load_fields(axis_index, plant))
        for place, fields in enumerate(self.plant_steps(plant), start=2 * axis_index):
            write_fields(self._memory.plant[place], PLANT, fields)

    def load_fields(self, axis_index: int, plant: Plant) -> dict[str, float]:
        """Fields of the axis record that depend on the plant: where its load is, and how the encoder is to be read."""
        period_s = self._unit[_SERVO] / NS_PER_S
        encoder = self._encoders[axis_index].step_fields(
            period_s, load_apart=plant.load_apart, driven=bool(self._ints[axis_index][_DRIVEN])
        )
        return load_fields(plant) | encoder

    def plant_steps(self, plant: Plant) -> tuple[dict[str, float], dict[str, float]]:
        """Fields of a plant's two records: before an output reaches the terminals, and after."""
        period_s = self._unit[_SERVO] / NS_PER_S
        before_s = min(self._output_delay_s, period_s)
        return plant_fields(plant, before_s), plant_fields(plant, period_s - before_s)

    def set_load(self, axis_index: int, torque_nm: float) -> None:
        """Change the load torque while the axis runs, Nm; positive acts against positive motion, as gravity on a
        lifted load does. PlantError for a plant that no load slows down."""
        self.set_plant(axis_index, self._plants[axis_index].with_load(torque_nm))

    def set_friction(self, axis_index: int, torque_nm: float) -> None:
        """Change the dry friction (of the load, where that is apart) while the axis runs, Nm; PlantError for a plant
        that has none."""
        self.set_plant(axis_index, self._plants[axis_index].with_friction(torque_nm))

    # Encoders

    def wire_encoder(self, axis_index: int, wiring: EncoderWiring) -> None:
        """Connect the encoder rightly, with its channels exchanged, or not at all. Its position does not jump; what it
        moves meanwhile without a connection is not counted."""
        self._write(axis_index, encoder_wiring=wiring)
        self.turn_counting(axis_index)

    def turn_counting(self, axis_index: int) -> None:
        """The encoder's direction follows from ENCPOL, CMDDIR and how it is wired."""
        ints = self._ints[axis_index]
        ints[_SIGN] = ints[_POLARITY] * ints[_OUTPUT_SIGN] * ints[_WIRING]

    def encoder_travel(self, axis_index: int) -> int:
        """What the encoder itself shows, whatever is counted of it, counts."""
        return self._ints[axis_index][_READING]

    def move_encoder(self, axis_index: int, motion: EncoderMotion) -> None:
        """Turn the encoder by something else than the axis, from now and from where it stands."""
        ints = self._ints[axis_index]
        if not ints[_DRIVEN]:
            position = self.load_position_rev(axis_index) if ints[_ON_LOAD] else self.true_position_rev(axis_index)
            self._write(axis_index, driven_counts=position * self._floats[axis_index][_COUNTS_PER_REV])
        else:
            drive_encoder(self._memory.axes[axis_index], self._unit[_TIME])
        origin = self._floats[axis_index][_DRIVEN_COUNTS]
        self._write(axis_index, **motion.fields(origin_counts=origin, now_ns=self._unit[_TIME]))
        self.set_plant(axis_index, self._plants[axis_index])

    def encoder_velocity(self, axis_index: int) -> float:
        """Velocity of an encoder that something else turns, a sine left aside, counts/s; 0 for one the axis turns."""
        ints = self._ints[axis_index]
        if not ints[_DRIVEN]:
            return 0.0
        elapsed_s = (self._unit[_TIME] - ints[_MOTION_START]) / NS_PER_S
        return driven_velocity(self._memory.axes[axis_index], elapsed_s)

    def release_encoder(self, axis_index: int) -> None:
        """The axis turns its encoder again; the position does not jump."""
        ints, floats = self._ints[axis_index], self._floats[axis_index]
        if not ints[_DRIVEN]:
            return
        drive_encoder(self._memory.axes[axis_index], self._unit[_TIME])
        position = self.load_position_rev(axis_index) if ints[_ON_LOAD] else self.true_position_rev(axis_index)
        floats[_PHASE] += floats[_DRIVEN_COUNTS] - position * floats[_COUNTS_PER_REV]
        self._write(axis_index, encoder_driven=0)
        self.set_plant(axis_index, self._plants[axis_index])

    def slip_encoder(self, axis_index: int, counts: int) -> None:
        """Turn the encoder on its shaft by whole counts, forwards positive; its index pulse turns with it."""
        ints = self._ints[axis_index]
        self._floats[axis_index][_PHASE] += counts
        ints[_READING] += counts
        ints[ENCODER] += ints[_SIGN] * counts
        self._stale = True

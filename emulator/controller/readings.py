"""What the unit measures: positions, velocities, the analogue output, in the units reports are printed in."""

from __future__ import annotations

from collections.abc import Callable
from decimal import ROUND_HALF_EVEN, Decimal
from typing import TYPE_CHECKING, NamedTuple

from emulator.controller.scaling import DISTANCE_SCALES
from emulator.engine import Engine
from protocol.catalogue import CommandRow, Scale
from protocol.numbers import divide
from protocol.reply_shapes import format_number

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

COUNTER_BITS = 32
"""Width of the position counters; they wrap (Aries guide p.151, assumed H for the 6250)."""

MEASURED_PLACES = 4
VOLT_PLACES = 3
"""Measured velocities and voltages are rounded to the places printed, where settings are truncated (assumed)."""


class Reading(NamedTuple):
    """A measured quantity of an axis: how to read it in counts (or volts), and which scale factor it is shown by."""

    read: Callable[[Engine, int], float]
    scale: Scale | None
    places: int

    @property
    def is_position(self) -> bool:
        """A position in a counter of whole counts."""
        return self.scale in DISTANCE_SCALES and self.places == 0


def _captured(trigger_index: int, name: str) -> Reading:
    return Reading(
        lambda engine, axis_index: getattr(engine.captured_positions(trigger_index, axis_index), name), "distance", 0
    )


READINGS = {
    "PC": Reading(Engine.commanded_position, "distance", 0),
    "PE": Reading(Engine.encoder_position, "distance", 0),
    "FB": Reading(Engine.feedback_position, "distance", 0),
    "PER": Reading(Engine.position_error, "distance", 0),
    "VEL": Reading(Engine.commanded_velocity, "velocity", MEASURED_PLACES),
    "VELA": Reading(Engine.actual_velocity, "velocity", MEASURED_PLACES),
    "DAC": Reading(Engine.dac_volts, None, VOLT_PLACES),
    "ANI": Reading(Engine.ani_volts, None, VOLT_PLACES),
    "PANI": Reading(Engine.ani_position, "distance", 0),
    "PMAS": Reading(Engine.master_position, "master", 0),
    "NMCY": Reading(Engine.master_cycle_number, None, 0),
    "VMAS": Reading(Engine.master_velocity, "master", MEASURED_PLACES),
    "PSLV": Reading(Engine.slave_position, "distance", 0),
    "PSHF": Reading(Engine.shift_counts, "distance", 0),
    **{
        f"{operand}{letter}": _captured(trigger_index, name)
        for operand, name in (("PCE", "encoder"), ("PCC", "commanded"), ("PCA", "ani"))
        for trigger_index, letter in enumerate("AB")
    },
}
"""The readings by operand name."""

SETTING_OPERANDS = frozenset({"A", "AD", "V", "D"})
"""Settings that can be read as operands."""


def wrapped(counts: int) -> int:
    """A position as a 32-bit signed counter shows it."""
    half = 1 << (COUNTER_BITS - 1)
    return (counts + half) % (1 << COUNTER_BITS) - half


def reading_in_user_units(controller: Controller, name: str, axis_index: int) -> Decimal:
    """A reading in user units, at the decimals a report prints."""
    reading = READINGS[name]
    value = reading.read(controller.engine, axis_index)
    if reading.is_position and reading.scale is not None:
        value = wrapped(int(value))
        factor = controller.settings.reading_factor(reading.scale, axis_index)
        return Decimal(value) if factor == 1 else divide(Decimal(value), factor)
    places = reading.places
    if reading.scale is not None:
        factor = controller.settings.reading_factor(reading.scale, axis_index)
        places = _places(controller, reading, axis_index)
        return (Decimal(value) / factor).quantize(Decimal(1).scaleb(-places), ROUND_HALF_EVEN)
    return Decimal(value).quantize(Decimal(1).scaleb(-places), ROUND_HALF_EVEN)


def _places(controller: Controller, reading: Reading, axis_index: int) -> int:
    """Decimals shown: those of the scale factor with SCALE1."""
    settings = controller.settings
    if reading.scale is None or not settings.scaled:
        return reading.places
    return settings.places(reading.scale, axis_index, reading.places)


def reading_text(controller: Controller, row: CommandRow, name: str, axis_index: int) -> str:
    """A reading as a report prints it."""
    reading = READINGS[name]
    if reading.is_position and not controller.settings.scaled:
        return f"{wrapped(int(reading.read(controller.engine, axis_index))):+d}"
    places = _places(controller, reading, axis_index)
    return format_number(reading_in_user_units(controller, name, axis_index), row.fields.number_format, places)

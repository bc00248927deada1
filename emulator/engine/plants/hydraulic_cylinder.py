"""A hydraulic cylinder on a proportional or servo valve.

Volts move the valve's spool, a second-order system. The spool first has to cross its overlap, then opens, and the
flow, up to what the pump gives, moves the piston: faster one way than the other, because the rod takes up part of one
side. The oil is taken as incompressible and the piston as stronger than whatever it moves, so speed is flow over area
and no force enters.

Travel is linear. The engine's "rev" is one unit of the encoder, whatever that is: inch or millimetre here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..kernels import Record, kernel, seldom
from .exponential import held_step
from .parameters import PlantError, require_not_negative, require_positive, require_positive_or_infinite

HYDRAULIC_CYLINDER = 3

TURN = 2.0 * math.pi

HIGHEST_VALVE_HZ = 20_000.0
"""Valves faster than this are refused (design choice): they are instantaneous to every servo rate."""

HIGHEST_DAMPING = 100.0

SHUT, OPENING, FULL = 0, 1, 2


@dataclass(frozen=True, slots=True)
class HydraulicCylinder:
    """A cylinder with its valve; positive volts extend it, and its unit of length is the encoder's.

    Within +-`overlap_v` nothing flows, beyond it the piston moves with `extend_units_s_per_v` or
    `retract_units_s_per_v` for each volt further. `max_speed_units_s` and the end stops may be infinite. A drive shut
    down is a valve without current: springs centre the spool.
    """

    extend_units_s_per_v: float = 3.0
    retract_units_s_per_v: float = 2.3
    overlap_v: float = 0.0
    valve_hz: float = 60.0
    valve_damping: float = 0.8
    max_speed_units_s: float = math.inf
    extended_stop_units: float = math.inf
    retracted_stop_units: float = -math.inf
    backlash_units: float = 0.0

    def __post_init__(self) -> None:
        require_positive(
            extend_units_s_per_v=self.extend_units_s_per_v,
            retract_units_s_per_v=self.retract_units_s_per_v,
            valve_hz=self.valve_hz,
            valve_damping=self.valve_damping,
        )
        require_positive_or_infinite(max_speed_units_s=self.max_speed_units_s)
        require_not_negative(overlap_v=self.overlap_v, backlash_units=self.backlash_units)
        if self.valve_hz > HIGHEST_VALVE_HZ:
            raise PlantError("valve_hz", self.valve_hz, f"at most {HIGHEST_VALVE_HZ:g}")
        if self.valve_damping > HIGHEST_DAMPING:
            raise PlantError("valve_damping", self.valve_damping, f"at most {HIGHEST_DAMPING:g}")
        if not self.retracted_stop_units < self.extended_stop_units:
            raise PlantError(
                "extended_stop_units", self.extended_stop_units, f"above the other stop, {self.retracted_stop_units:g}"
            )

    @property
    def play_rev(self) -> float:
        """Play between this and the load, rev."""
        return self.backlash_units

    @property
    def load_apart(self) -> bool:
        """The load can stand elsewhere than the shaft."""
        return self.backlash_units > 0.0

    def with_load(self, torque_nm: float) -> HydraulicCylinder:
        """PlantError: no force enters this model."""
        raise PlantError("load_torque_nm", torque_nm, "left alone on a hydraulic cylinder, which no load slows down")

    def with_friction(self, torque_nm: float) -> HydraulicCylinder:
        """PlantError: no force enters this model."""
        raise PlantError("friction", torque_nm, "left alone on a hydraulic cylinder, which no friction slows down")

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""
        frequency = TURN * self.valve_hz
        # Deviation of the spool from its command, its rate over the frequency, and the integral of the deviation.
        system = [
            [0.0, frequency, 0.0],
            [-frequency, -2.0 * self.valve_damping * frequency, 0.0],
            [1.0 / period_s, 0.0, 0.0],
        ]
        spool, rate, mean = held_step(system, [[0.0]] * 3, period_s)
        return {
            "kind": HYDRAULIC_CYLINDER,
            "extend_gain": self.extend_units_s_per_v,
            "retract_gain": self.retract_units_s_per_v,
            "overlap": self.overlap_v,
            "max_speed": self.max_speed_units_s,
            "extended_stop": self.extended_stop_units,
            "retracted_stop": self.retracted_stop_units,
            "spool_per_spool": spool[0],
            "spool_per_rate": spool[1],
            "rate_per_spool": rate[0],
            "rate_per_rate": rate[1],
            "mean_per_spool": mean[0],
            "mean_per_rate": mean[1],
        }


@kernel
def spool_region(plant: Record, spool: float) -> int:
    """Which straight piece of the valve's characteristic the spool is on: its number, negative when retracting."""
    opening = abs(spool) - plant["overlap"]
    if opening <= 0.0:
        return SHUT
    gain = plant["extend_gain"] if spool > 0.0 else plant["retract_gain"]
    region = OPENING if opening * gain < plant["max_speed"] else FULL
    return region if spool > 0.0 else -region


@kernel
def piston_speed(plant: Record, spool: float) -> float:
    """Speed of the piston with the spool at this many volts."""
    opening = abs(spool) - plant["overlap"]
    if opening <= 0.0:
        return 0.0
    speed = opening * (plant["extend_gain"] if spool > 0.0 else plant["retract_gain"])
    if speed > plant["max_speed"]:
        speed = plant["max_speed"]
    return float(speed if spool > 0.0 else -speed)


@kernel
def speed_integral(plant: Record, spool: float) -> float:
    """Integral of the speed over the spool's travel from the middle, units/s V."""
    opening = abs(spool) - plant["overlap"]
    if opening <= 0.0:
        return 0.0
    gain = plant["extend_gain"] if spool > 0.0 else plant["retract_gain"]
    if opening * gain <= plant["max_speed"]:
        return float(0.5 * gain * opening * opening)
    full_at = plant["max_speed"] / gain
    return float(plant["max_speed"] * (opening - 0.5 * full_at))


@seldom
def step_hydraulic_cylinder(axis: Record, plant: Record, volts: float) -> None:
    """Advance valve and piston by one step with the output held.

    The spool's motion is exact. The piston's is exact as long as the spool stays on one straight piece of the valve's
    characteristic; in a step in which it changes from one to another it is taken to move evenly.
    """
    command = volts if axis["enabled"] != 0 else 0.0
    spool = axis["spool"]
    deviation, rate = spool - command, axis["spool_rate"]
    end = command + plant["spool_per_spool"] * deviation + plant["spool_per_rate"] * rate
    axis["spool"] = end
    axis["spool_rate"] = plant["rate_per_spool"] * deviation + plant["rate_per_rate"] * rate
    from_rest = spool == 0.0 and plant["overlap"] == 0.0
    if from_rest or spool_region(plant, spool) == spool_region(plant, end):
        mean = command + plant["mean_per_spool"] * deviation + plant["mean_per_rate"] * rate
        mean_speed = piston_speed(plant, mean)
    else:
        mean_speed = (speed_integral(plant, end) - speed_integral(plant, spool)) / (end - spool)
    position = axis["true_position"] + mean_speed * plant["period_s"]
    speed = piston_speed(plant, end)
    if position >= plant["extended_stop"]:
        position = plant["extended_stop"]
        speed = speed if speed < 0.0 else 0.0
    if position <= plant["retracted_stop"]:
        position = plant["retracted_stop"]
        speed = speed if speed > 0.0 else 0.0
    axis["true_position"] = position
    axis["true_velocity"] = speed

"""Drives and loads: what the analogue output moves.

The controller is discrete and the plant continuous, with the output held in between, so each sample is the exact
solution over one period (zero-order hold), stable at every servo rate because the continuous plant is. The coefficients
need exp, which no two mathematical libraries round alike; they are worked out here in Python when a parameter or the
period changes, and the cycle only multiplies and adds.

Positions are revolutions, or on a linear axis the unit its encoder counts in, speeds revolutions per second. Every
default is a choice for a machine that behaves sensibly with the power-up gains, not a property of any product.
"""

from __future__ import annotations

from typing import TypeAlias

from ..kernels import Record, kernel
from .elastic_coupling import ELASTIC_COUPLING, ElasticCoupling, step_elastic_coupling
from .hydraulic_cylinder import HydraulicCylinder, step_hydraulic_cylinder
from .load import WORLD_END_REV, drag_load, keep_in_world, load_fields, place_of_load, plant_fields
from .parameters import PlantError
from .torque_drive import TORQUE_DRIVE, TorqueDrive, step_torque_drive
from .velocity_drive import VELOCITY_DRIVE, VelocityDrive, step_velocity_drive

__all__ = [
    "WORLD_END_REV",
    "ElasticCoupling",
    "HydraulicCylinder",
    "Plant",
    "PlantError",
    "TorqueDrive",
    "VelocityDrive",
    "drag_load",
    "keep_in_world",
    "load_fields",
    "place_of_load",
    "plant_fields",
    "step_plant",
]

Plant: TypeAlias = VelocityDrive | TorqueDrive | ElasticCoupling | HydraulicCylinder


@kernel
def step_plant(axis: Record, plant: Record, volts: float) -> None:
    """Advance the axis's plant by the step `plant` is for, with `volts` at the drive's input."""
    if plant["kind"] == VELOCITY_DRIVE:
        step_velocity_drive(axis, plant, volts)
    elif plant["kind"] == TORQUE_DRIVE:
        step_torque_drive(axis, plant, volts)
    elif plant["kind"] == ELASTIC_COUPLING:
        step_elastic_coupling(axis, plant, volts)
    else:
        step_hydraulic_cylinder(axis, plant, volts)

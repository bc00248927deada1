"""Simulate mode: the plant that the simulator's parameters describe (M965, H Param_Sim_Time_Constant).

The first order is a speed that follows the output with a time constant, the second a mass on a spring; both are exact
over a loop, being kinds of plant the engine has. That these are the equations is inferred.
"""

from __future__ import annotations

import math

from emulator.engine.plants import HydraulicCylinder, Plant, VelocityDrive

DEFAULT_TIME_CONSTANT_S = 0.75


def first_order(gain: float, time_constant_s: float) -> Plant:
    """`v' = (K u - v) / tau`. PlantError for what cannot be."""
    return VelocityDrive(
        speed_per_volt_rev_s=gain,
        loop_time_constant_s=time_constant_s,
        command_lag_s=0.0,
        max_acceleration_rev_s2=math.inf,
        coast_time_constant_s=math.inf,
    )


def second_order(gain: float, natural_hz: float, damping: float) -> Plant:
    """`v'' = wn2 (K u - v) - 2 z wn v'`. PlantError for what cannot be."""
    return HydraulicCylinder(
        extend_units_s_per_v=gain, retract_units_s_per_v=gain, valve_hz=natural_hz, valve_damping=damping
    )

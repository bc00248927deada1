"""The control law "PIV&F": proportional, integral and velocity feedback with velocity and acceleration feedforward.

    P  =  SGP e                 V  = -SGV (first difference of the feedback per servo sample)
    I += SGI e Ts, held within +-SGILIM
    VF =  SGVF v_commanded      AF =  SGAF a_commanded
    output = P + I + V + VF + AF + SOFFS + dither, held within +-10 V, then within +-DACLIM

Structure and signs are documented (6250 User Guide PDF pp. 31, 35, 36; OEM6250 Installation Guide pp. 40, 44). With
all five gains zero the algorithm is off and the output is SOFFS alone (OEM6250 Installation Guide p. 40).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .converter import OUTPUT_RANGE_V
from .kernels import Record, kernel, seldom


@dataclass(frozen=True, slots=True)
class Gains:
    """One axis's gain set in the units of the commands. The defaults are the unit's at power-up."""

    proportional_mv_per_count: float = 0.5
    integral_mv_per_count_s: float = 0.0
    velocity_uv_per_count_s: float = 0.0
    velocity_feedforward_uv_per_count_s: float = 0.0
    acceleration_feedforward_uv_per_count_s2: float = 0.0
    integral_limit_v: float = 200.0


@dataclass(frozen=True, slots=True)
class UnitFactors:
    """Volts per unit of each gain. The scale is that of the 6K family's commented configurations (assumed, high)."""

    sgp: float = 1e-3
    sgi: float = 1e-3
    sgv: float = 1e-6
    sgvf: float = 1e-6
    sgaf: float = 1e-6


def gain_fields(gains: Gains, factors: UnitFactors) -> dict[str, float]:
    """Fields of the axis record for a gain set, in volts. ValueError for a gain that is not a finite number."""
    fields = {
        "proportional_v": gains.proportional_mv_per_count * factors.sgp,
        "integral_v": gains.integral_mv_per_count_s * factors.sgi,
        "velocity_v": gains.velocity_uv_per_count_s * factors.sgv,
        "velocity_feedforward_v": gains.velocity_feedforward_uv_per_count_s * factors.sgvf,
        "acceleration_feedforward_v": gains.acceleration_feedforward_uv_per_count_s2 * factors.sgaf,
        "integral_limit_v": gains.integral_limit_v,
    }
    for name, value in fields.items():
        if not math.isfinite(value):
            raise ValueError(f"{name} would be {value}")
    return fields


@kernel
def clamp(value: float, limit: float) -> float:
    """`value` held within +-`limit`."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


@kernel
def open_loop(axis: Record) -> float:
    """Output with the algorithm off: the offset alone, every term and the integrator cleared."""
    axis["term_p"] = 0.0
    axis["term_i"] = 0.0
    axis["term_v"] = 0.0
    axis["term_vf"] = 0.0
    axis["term_af"] = 0.0
    return float(axis["offset_v"])


@kernel
def gains_are_zero(axis: Record) -> bool:
    """Whether all five gains are zero, which turns the algorithm off."""
    return bool(
        axis["proportional_v"] == 0.0
        and axis["integral_v"] == 0.0
        and axis["velocity_v"] == 0.0
        and axis["velocity_feedforward_v"] == 0.0
        and axis["acceleration_feedforward_v"] == 0.0
    )


@kernel
def integrate(axis: Record, error: float, servo_s: float) -> None:
    """Advance the integrator. Its state itself is limited, so it never winds up beyond SGILIM.

    With SGI zero the state is cleared: no integral term means none left over from before (assumed).
    """
    if axis["integral_v"] == 0.0:
        axis["term_i"] = 0.0
    else:
        axis["term_i"] = clamp(axis["term_i"] + axis["integral_v"] * error * servo_s, axis["integral_limit_v"])


@kernel
def closed_loop(unit: Record, axis: Record, feedback_counts: int) -> float:
    """Sum of the terms and the offset for this sample, V, not yet limited."""
    if gains_are_zero(axis):
        return open_loop(axis)
    error = float(axis["commanded_counts"] - feedback_counts)
    velocity = (feedback_counts - axis["previous_feedback_counts"]) * unit["servo_hz"]
    axis["term_p"] = axis["proportional_v"] * error
    integrate(axis, error, unit["servo_s"])
    axis["term_v"] = -(axis["velocity_v"] * velocity)
    axis["term_vf"] = axis["velocity_feedforward_v"] * axis["commanded_velocity"]
    axis["term_af"] = axis["acceleration_feedforward_v"] * axis["commanded_acceleration"]
    feedback = axis["term_p"] + axis["term_i"] + axis["term_v"]
    return float(feedback + axis["term_vf"] + axis["term_af"] + axis["offset_v"])


@seldom
def dither(axis: Record) -> float:
    """Dither for this sample, V: a square wave that turns round every SDTFR servo samples.

    That SDTFR counts servo samples of half a period is assumed, low confidence (the 6000 Series names a "dither
    frequency ratio" and no more); 0 means no dither, and is not asked for here.
    """
    half_period = axis["dither_samples"]
    sample = axis["dither_sample"]
    axis["dither_sample"] = sample + 1 if sample + 1 < 2 * half_period else 0
    return float(axis["dither_v"] if sample < half_period else -axis["dither_v"])


@seldom
def held_back(axis: Record, volts: float) -> float:
    """A control signal held within the output's range, then within DACLIM."""
    return clamp(clamp(volts, OUTPUT_RANGE_V), axis["output_limit_v"])


@kernel
def limited(axis: Record, volts: float) -> float:
    """The control signal within the output's range and DACLIM.

    One within both is not passed through the comparisons: a processor goes on with it before they are made.
    """
    if abs(volts) > OUTPUT_RANGE_V or abs(volts) > axis["output_limit_v"]:
        return held_back(axis, volts)
    return volts

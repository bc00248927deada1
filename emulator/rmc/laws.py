"""The four control laws of an RMC axis: Position PID, Velocity PID, Position I-PD, Velocity I-PD.

PID sums its terms anew in every loop:

    P = Kp e    I += Ki e T    D = Kd (target' - actual')    VFF = Kvff Vt    AFF = Kaff At    JFF = Kjff Jt
    PFID % = r (P + I + D + AFF + JFF + higher terms) + VFF

with e = Pt - Pa, D on velocities in position control, and e = Vt - Va, D on accelerations in velocity control (M104,
M974-M987, H Param_Differential_Gain). I-PD adjusts its output by differences of *actual* values; the target enters only
through the integral (M975; that the adjustments accumulate in a clamped output is inferred):

    u = clamp(u + Ki e T - Kp (y - y[n-1]) - Kd (y' - y'[n-1]) - ...)    PFID % = r u

While the output is saturated nothing grows in its direction, neither the integrator of a PID nor u (inferred).
r is 1 with symmetrical gains, or in the direction with the larger velocity feed forward, else smaller over larger
(M981, M990). All results are percentages of the maximum Control Output.
"""

from __future__ import annotations

from emulator.engine.kernels import Record

from .kernels import kernel, seldom

FULL_PERCENT = 100.0
"""Clamp of the integrator and of the I-PD output (inferred from the range of Integrator Adjust, M841)."""

POSITION_PID, POSITION_I_PD, VELOCITY_PID, VELOCITY_I_PD = 3, 4, 5, 6
HELD, ACTIVE, ZERO = 0, 1, 2
NO_HIGH_ORDER, ACCELERATION_CONTROL, ACTIVE_DAMPING = 0, 1, 2


@kernel
def held_within(value: float, limit: float) -> float:
    """`value` held within +-`limit`."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


@kernel
def is_finite(value: float) -> bool:
    """Neither infinite nor no number: hosts can write both."""
    return value - value == 0.0


@kernel
def ratio_of_gains(velocity_ff: float, opposite_ff: float) -> float:
    """What the gains are multiplied with in the direction of `velocity_ff`; either being 0 means 1 (M981)."""
    if velocity_ff <= 0.0 or opposite_ff <= 0.0 or velocity_ff >= opposite_ff:
        return 1.0
    return velocity_ff / opposite_ff


@kernel
def moves_positive(target_velocity: float, error: float) -> bool:
    """Direction that chooses the gains: that of the Target Velocity, or if it is 0 that of the error (M990)."""
    if target_velocity != 0.0:
        return target_velocity > 0.0
    return error >= 0.0


@kernel
def feed_forward_of(axis: Record, error: float) -> float:
    """Choose the direction: sets the ratio of the gains, returns the velocity feed forward gain."""
    if axis["symmetrical"] != 0:
        axis["gain_ratio"] = 1.0
        return float(axis["velocity_ff_positive"])
    if moves_positive(axis["target_velocity"], error):
        forward, opposite = axis["velocity_ff_positive"], axis["velocity_ff_negative"]
    else:
        forward, opposite = axis["velocity_ff_negative"], axis["velocity_ff_positive"]
    axis["gain_ratio"] = ratio_of_gains(forward, opposite)
    return float(forward)


@kernel
def may_grow(axis: Record, step: float) -> bool:
    """Whether the integrator may move away from zero by `step` in this loop.

    It may not while the output is saturated in that direction (inferred), while a stopped target has the position error
    within the Deadband Tolerance, or within half a count of the Command Position (M977, M1001).
    """
    if axis["saturated"] != 0 and axis["saturated"] * step > 0.0:
        return False
    if axis["mode"] != POSITION_PID:
        return True
    if axis["target_velocity"] == 0.0 and abs(axis["position_error"]) < axis["deadband_tolerance"]:
        return False
    return bool(abs(axis["command_position"] - axis["actual_position"]) > axis["half_count"])


@kernel
def integrate(axis: Record, error: float, loop_s: float) -> None:
    """Advance the integrator of a PID; what may not grow may still wind down."""
    if axis["integrator_mode"] == ZERO:
        axis["term_i"] = 0.0
        return
    if axis["integrator_mode"] == HELD:
        return
    present = axis["term_i"]
    step = axis["integral"] * error * loop_s
    if not may_grow(axis, step):
        if present * step >= 0.0:
            return
        if abs(step) > abs(present):
            step = -present
    axis["term_i"] = held_within(present + step, FULL_PERCENT)


@kernel
def sum_of_terms(axis: Record, velocity_ff: float) -> float:
    """Feed forwards, and the sum of all terms under the ratio, %."""
    axis["term_vff"] = velocity_ff * axis["target_velocity"]
    axis["term_aff"] = axis["acceleration_ff"] * axis["target_acceleration"]
    axis["term_jff"] = axis["jerk_ff"] * axis["target_jerk"]
    gained = axis["term_p"] + axis["term_i"] + axis["term_d"] + axis["term_aff"] + axis["term_jff"]
    gained += axis["term_double"] + axis["term_triple"]
    return float(axis["gain_ratio"] * gained + axis["term_vff"])


@kernel
def position_pid(axis: Record, loop_s: float) -> float:
    """PFID Output of Position PID, %."""
    error = axis["position_error"]
    velocity_ff = feed_forward_of(axis, error)
    axis["term_p"] = axis["proportional"] * error
    integrate(axis, error, loop_s)
    axis["term_d"] = axis["differential"] * (axis["target_velocity"] - axis["law_velocity"])
    axis["term_double"] = 0.0
    axis["term_triple"] = 0.0
    if axis["high_order"] == ACTIVE_DAMPING:
        axis["term_double"] = -axis["double_differential"] * axis["law_acceleration"]
    elif axis["high_order"] == ACCELERATION_CONTROL:
        lag = axis["target_acceleration"] - axis["law_acceleration"]
        axis["term_double"] = axis["double_differential"] * lag
        axis["term_triple"] = axis["triple_differential"] * (axis["target_jerk"] - axis["law_jerk"])
    return sum_of_terms(axis, velocity_ff)


@kernel
def velocity_pid(axis: Record, loop_s: float) -> float:
    """PFID Output of Velocity PID, %. Active damping takes the place of the differential term (M986)."""
    error = axis["velocity_error"]
    velocity_ff = feed_forward_of(axis, error)
    axis["term_p"] = axis["proportional"] * error
    integrate(axis, error, loop_s)
    axis["term_d"] = axis["differential"] * (axis["target_acceleration"] - axis["law_acceleration"])
    axis["term_double"] = 0.0
    axis["term_triple"] = 0.0
    if axis["high_order"] == ACTIVE_DAMPING:
        axis["term_d"] = 0.0
        axis["term_double"] = -axis["double_differential"] * axis["law_acceleration"]
    elif axis["high_order"] == ACCELERATION_CONTROL:
        axis["term_double"] = axis["double_differential"] * (axis["target_jerk"] - axis["law_jerk"])
    return sum_of_terms(axis, velocity_ff)


@kernel
def accumulate(axis: Record, error: float, loop_s: float) -> float:
    """PFID Output of an I-PD from this loop's adjustments, %."""
    feed_forward_of(axis, error)
    axis["term_i"] = 0.0
    if axis["integrator_mode"] == ACTIVE:
        axis["term_i"] = axis["integral"] * error * loop_s
    axis["term_vff"] = 0.0
    axis["term_aff"] = 0.0
    axis["term_jff"] = 0.0
    change = axis["term_i"] + axis["term_p"] + axis["term_d"] + axis["term_double"] + axis["term_triple"]
    # An Output Limit below 100 % saturates earlier than the clamp; beyond it nothing may pile up either.
    if axis["saturated"] * change <= 0.0:
        axis["accumulated"] = held_within(axis["accumulated"] + change, FULL_PERCENT)
    return float(axis["gain_ratio"] * axis["accumulated"])


@kernel
def limited_error(axis: Record) -> float:
    """Position error of an I-PD, held to what keeps the axis at the speed limit of its command: Kp Vmax / Ki."""
    error = axis["position_error"]
    if axis["speed_limit"] > 0.0 and axis["integral"] > 0.0:
        error = held_within(error, axis["proportional"] * axis["speed_limit"] / axis["integral"])
    return float(error)


@kernel
def position_i_pd(axis: Record, loop_s: float) -> float:
    """PFID Output of Position I-PD, %."""
    change = axis["actual_position"] - axis["previous_position"]
    axis["term_p"] = -axis["proportional"] * change
    axis["term_d"] = -axis["differential"] * (axis["law_velocity"] - axis["previous_velocity"])
    axis["term_double"] = 0.0
    axis["term_triple"] = 0.0
    if axis["high_order"] != NO_HIGH_ORDER:
        growth = axis["law_acceleration"] - axis["previous_law_acceleration"]
        axis["term_double"] = -axis["double_differential"] * growth
    if axis["high_order"] == ACCELERATION_CONTROL:
        axis["term_triple"] = -axis["triple_differential"] * (axis["law_jerk"] - axis["previous_jerk"])
    return accumulate(axis, limited_error(axis), loop_s)


@kernel
def velocity_i_pd(axis: Record, loop_s: float) -> float:
    """PFID Output of Velocity I-PD, %."""
    growth = axis["law_acceleration"] - axis["previous_law_acceleration"]
    axis["term_p"] = -axis["proportional"] * (axis["law_velocity"] - axis["previous_velocity"])
    axis["term_d"] = -axis["differential"] * growth
    axis["term_double"] = 0.0
    axis["term_triple"] = 0.0
    if axis["high_order"] == ACTIVE_DAMPING:
        axis["term_d"] = 0.0
        axis["term_double"] = -axis["double_differential"] * growth
    elif axis["high_order"] == ACCELERATION_CONTROL:
        axis["term_double"] = -axis["double_differential"] * (axis["law_jerk"] - axis["previous_jerk"])
    return accumulate(axis, axis["velocity_error"], loop_s)


@kernel
def closed_loop(axis: Record, loop_s: float) -> float:
    """PFID Output of the mode in force, %."""
    if axis["mode"] == POSITION_PID:
        return position_pid(axis, loop_s)
    if axis["mode"] == VELOCITY_PID:
        return velocity_pid(axis, loop_s)
    if axis["mode"] == POSITION_I_PD:
        return position_i_pd(axis, loop_s)
    return velocity_i_pd(axis, loop_s)


@seldom
def clear_terms(axis: Record) -> None:
    """No law at work: every term and both accumulators at zero."""
    axis["term_p"] = 0.0
    axis["term_i"] = 0.0
    axis["term_d"] = 0.0
    axis["term_vff"] = 0.0
    axis["term_aff"] = 0.0
    axis["term_jff"] = 0.0
    axis["term_double"] = 0.0
    axis["term_triple"] = 0.0
    axis["accumulated"] = 0.0
    axis["pfid"] = 0.0
    axis["captured_velocity"] = 0.0


@seldom
def take_over(axis: Record, percent: float) -> None:
    """Begin a closed loop whose first output shall be near `percent`: the state that would give it."""
    clear_terms(axis)
    axis["accumulated"] = held_within(percent, FULL_PERCENT)
    axis["term_i"] = axis["accumulated"] if axis["integral"] > 0.0 else 0.0

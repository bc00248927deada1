"""From PFID percent to volts: scale, deadband, limit, bias, and last the polarity of the pins.

The order is documented (M889, H Status_PFID_Output); the ratio of the gains, which stands between scale and deadband
there, is applied with the law, which comes to the same.
"""

from __future__ import annotations

from emulator.engine.kernels import Record

from .kernels import kernel
from .laws import FULL_PERCENT, VELOCITY_I_PD, VELOCITY_PID, held_within, is_finite

OUTPUT_RANGE_V = 10.0


@kernel
def deadband_share(axis: Record) -> float:
    """How much of the Output Deadband is added: less inside the Deadband Tolerance (H Param_Deadband_Tolerance).

    In position control the share falls in proportion to the error (inferred); in velocity control with a tolerance
    there is none while the Target Velocity is 0.
    """
    tolerance = axis["deadband_tolerance"]
    if tolerance <= 0.0:
        return 1.0
    if axis["mode"] == VELOCITY_PID or axis["mode"] == VELOCITY_I_PD:
        return 0.0 if axis["target_velocity"] == 0.0 else 1.0
    error = abs(axis["position_error"])
    return float(error / tolerance) if error < tolerance else 1.0


@kernel
def with_deadband(axis: Record, volts: float) -> float:
    """A closed loop's output with the Output Deadband added in its sign."""
    if volts > 0.0:
        return float(volts + deadband_share(axis) * axis["output_deadband"])
    if volts < 0.0:
        return float(volts - deadband_share(axis) * axis["output_deadband"])
    return volts


@kernel
def put_out(axis: Record, volts: float) -> None:
    """Limit, bias and polarity; what is no number puts out nothing.

    Only the limit makes Output Saturated; the range clips bias in silence (M870).
    """
    if not is_finite(volts):
        volts = 0.0
    limit = axis["output_limit"]
    axis["saturated"] = 1 if volts > limit else (-1 if volts < -limit else 0)
    axis["control_v"] = held_within(held_within(volts, limit) + axis["output_bias"], OUTPUT_RANGE_V)
    axis["pins_v"] = -axis["control_v"] if axis["invert_output"] != 0 else axis["control_v"]


@kernel
def put_out_percent(axis: Record, percent: float) -> None:
    """The whole chain of a closed loop."""
    axis["pfid"] = percent
    put_out(axis, with_deadband(axis, percent * axis["output_scale"] / FULL_PERCENT))

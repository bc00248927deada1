"""Commands that do not move an axis along a plan: halts, faults, enabling, modes, adjustments."""

from __future__ import annotations

from protocol.rmc.bits import ControlMode

from .axis import Axis, Complaint, Refused
from .commands import DeviceLike, Values, carries_out
from .halts import CLOSED_LOOP_HALT, DIRECT_OUTPUT_HALT, OPEN_LOOP_HALT
from .target import DIRECT_OUTPUT, open_to

VELOCITY_FF, VELOCITY_FF_NEGATIVE, POSITION_OFFSET, CONTROL_BITS = 65, 68, 1, 60


@carries_out("closed_loop_halt")
def closed_loop_halt(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp the target to rest."""
    axis.write(halt_wanted=CLOSED_LOOP_HALT)


@carries_out("open_loop_halt")
def open_loop_halt(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp the output to 0."""
    axis.write(halt_wanted=OPEN_LOOP_HALT)


@carries_out("direct_output_halt")
def direct_output_halt(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp the output to 0 and turn the Enable Output off."""
    axis.write(halt_wanted=DIRECT_OUTPUT_HALT)


@carries_out("clear_faults")
def clear_faults(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Error bits whose cause has gone."""
    axis.clear_faults()


@carries_out("enable_controller")
def enable_controller(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Enable all axes (assumed M)."""
    for each in device.axes:
        enable(device, each)


@carries_out("fault_controller")
def fault_controller(device: DeviceLike, axis: Axis, values: Values) -> None:
    """A Direct Output Halt on every axis (assumed M)."""
    for each in device.axes:
        each.write(halt_wanted=DIRECT_OUTPUT_HALT)


@carries_out("enable_axis")
def enable_axis(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Enable, or disable: the output goes to 0 and the Enable Output off."""
    if values[0] == 1.0:
        enable(device, axis)
        return
    axis.write(enabled=0)
    open_to(axis.record, DIRECT_OUTPUT, 0.0, axis["open_loop_halt_ramp"])
    axis.write(off_when_done=1)


def enable(device: DeviceLike, axis: Axis) -> None:
    """The axis accepts motion commands from now on."""
    axis.write(enabled=1)
    if device.enable_output_follows:
        axis.write(enable_output=1, off_when_done=0)


@carries_out("set_enable_output")
def set_enable_output(device: DeviceLike, axis: Axis, values: Values) -> None:
    """The Enable Output alone."""
    axis.write(enable_output=values[0], off_when_done=0)


@carries_out("set_control_mode")
def set_control_mode(device: DeviceLike, axis: Axis, values: Values) -> None:
    """The mode that closed-loop motion commands will use (M840)."""
    mode = device.next_mode_of(int(values[0]))
    if mode is None:
        raise Refused(Complaint.BAD_PARAMETER)
    axis.write(next_mode=mode)


@carries_out("offset_position")
def offset_position(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Shift actual, target and command position together (M838)."""
    shift(device, axis, values[0])


@carries_out("set_position")
def set_position(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Let the actual position be this one."""
    shift(device, axis, values[0] - axis["actual_position"])


def shift(device: DeviceLike, axis: Axis, change: float) -> None:
    """Move the origin of an axis, its parameter included."""
    axis.shift(change)
    device.parameters[axis.index].keep(POSITION_OFFSET, axis["position_offset"])


@carries_out("feed_forward_adjust")
def feed_forward_adjust(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Velocity feed forward from the output that constant velocity took; nothing if the signs differ (M841)."""
    percent, velocity = axis["captured_pfid"], axis["captured_velocity"]
    if percent * velocity <= 0.0:
        return
    both_ways = bool(axis.integer("symmetrical"))
    element = VELOCITY_FF if velocity > 0.0 or both_ways else VELOCITY_FF_NEGATIVE
    device.parameters[axis.index].set(element, percent / velocity)


@carries_out("integrator_adjust")
def integrator_adjust(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Set the integral term; not in I-PD (M841)."""
    if axis.mode in {ControlMode.POSITION_I_PD, ControlMode.VELOCITY_I_PD}:
        raise Refused(Complaint.WRONG_MODE)
    axis.write(term_i=values[0])


@carries_out("set_integrator_mode")
def set_integrator_mode(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Held, active, or zero."""
    parameters = device.parameters[axis.index]
    parameters.set(CONTROL_BITS, int(parameters[CONTROL_BITS]) & ~0xF | int(values[0]))

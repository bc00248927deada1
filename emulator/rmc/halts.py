"""Error bits, what they do to the axis, and the status bits.

An error bit stays until its cause has gone *and* Clear Faults or a motion command is given (H Status_Error_Bits). Its
rise fires the AutoStop chosen for it, unless the axis is in Direct Output (M1018).
"""

from __future__ import annotations

from emulator.engine.kernels import Record, Records

from .kernels import kernel, seldom
from .laws import POSITION_I_PD, POSITION_PID, VELOCITY_I_PD, VELOCITY_PID
from .target import DIRECT_OUTPUT, OPEN_LOOP, begin_stop, is_closed, open_to

FOLLOWING, OUTPUT_SATURATED, NO_TRANSDUCER, TRANSDUCER_OVERFLOW = 1 << 0, 1 << 2, 1 << 6, 1 << 7
POSITIVE_LIMIT_INPUT, NEGATIVE_LIMIT_INPUT = 1 << 4, 1 << 5
POSITIVE_OVERTRAVEL, NEGATIVE_OVERTRAVEL = 1 << 9, 1 << 10

NO_HALT, EXTERNAL_HALT, CLOSED_LOOP_HALT, OPEN_LOOP_HALT, DIRECT_OUTPUT_HALT = range(5)

LOOPS_TO_LOSE = 3
"""Loops without transducer that make No Transducer, and good ones that end it (M870)."""

IN_POSITION, AT_VELOCITY, IN_OPEN_LOOP, STOPPED, ENABLE_OUTPUT = 1 << 0, 1 << 1, 1 << 2, 1 << 6, 1 << 8
TARGET_DONE, STATE_SHIFT, DIRECT, ENABLED, EXTERNALLY_HALTED, HALTED = 1 << 9, 10, 1 << 12, 1 << 13, 1 << 14, 1 << 15
INPUT_ESTIMATED, FEEDBACK_OK = 1 << 7, 1 << 26


@kernel
def following_error(axis: Record) -> int:
    """Position PID watches the position error, Velocity PID the velocity error, I-PD neither (M870)."""
    if axis["mode"] == POSITION_PID:
        return FOLLOWING if abs(axis["position_error"]) > axis["position_error_tolerance"] else 0
    if axis["mode"] == VELOCITY_PID:
        return FOLLOWING if abs(axis["velocity_error"]) > axis["velocity_error_tolerance"] else 0
    return 0


@kernel
def overtravel(axis: Record) -> int:
    """In a closed loop the target counts, in open loop the actual position, in Direct Output nothing."""
    upper, lower = axis["positive_travel_limit"], axis["negative_travel_limit"]
    if upper <= lower or axis["mode"] == DIRECT_OUTPUT:
        return 0
    place = axis["target_position"] if is_closed(axis) else axis["actual_position"]
    if place > upper:
        return POSITIVE_OVERTRAVEL
    return NEGATIVE_OVERTRAVEL if place < lower else 0


@kernel
def transducer_errors(axis: Record, encoder_sign: int) -> int:
    """No Transducer after three loops without, and Transducer Overflow beyond its range."""
    lost = axis["live_errors"] & NO_TRANSDUCER
    if axis["simulated"] == 0 and encoder_sign == 0:
        if axis["lost_loops"] < LOOPS_TO_LOSE:
            axis["lost_loops"] += 1
        if axis["lost_loops"] == LOOPS_TO_LOSE:
            lost = NO_TRANSDUCER
    elif axis["lost_loops"] > 0:
        axis["lost_loops"] -= 1
        lost = lost if axis["lost_loops"] > 0 else 0
    beyond = axis["raw_counts"] < axis["lowest_count"] or axis["raw_counts"] > axis["highest_count"]
    return int(lost | (TRANSDUCER_OVERFLOW if beyond else 0))


@seldom
def halt(axis: Record, ramps: Records, level: int) -> None:
    """Carry out a halt; a Closed Loop Halt where no loop is closed becomes an Open Loop Halt (assumed M)."""
    if level == EXTERNAL_HALT:
        axis["external_halt"] = 1
        return
    axis["halted"] = 1
    if level == CLOSED_LOOP_HALT and is_closed(axis):
        begin_stop(axis, ramps, axis["closed_loop_halt_decel"])
    elif level == DIRECT_OUTPUT_HALT:
        open_to(axis, DIRECT_OUTPUT, 0.0, axis["open_loop_halt_ramp"])
        axis["off_when_done"] = 1
    else:
        direct = axis["mode"] == DIRECT_OUTPUT
        open_to(axis, DIRECT_OUTPUT if direct else OPEN_LOOP, 0.0, axis["open_loop_halt_ramp"])


@kernel
def level_of(axis: Record, rising: int) -> int:
    """The severest AutoStop of some error bits."""
    if (rising & axis["direct_output_mask"]) != 0:
        return DIRECT_OUTPUT_HALT
    if (rising & axis["open_loop_mask"]) != 0:
        return OPEN_LOOP_HALT
    if (rising & axis["closed_loop_mask"]) != 0:
        return CLOSED_LOOP_HALT
    return EXTERNAL_HALT if (rising & axis["external_mask"]) != 0 else NO_HALT


@seldom
def spread(axes: Records, axis_count: int, axis_index: int, level: int) -> None:
    """A halt of a group is a halt of all its axes, at the next loop."""
    group = axes[axis_index]["halt_group"]
    for other in range(axis_count):
        if other != axis_index and axes[other]["halt_group"] == group:
            axes[other]["halt_wanted"] = level


@seldom
def deal_with(axes: Records, axis_count: int, ramps: Records, axis_index: int) -> None:
    """Halts asked for from outside, and those that error bits have fired."""
    axis = axes[axis_index]
    level = axis["halt_wanted"]
    axis["halt_wanted"] = NO_HALT
    spreads = level == NO_HALT
    rising = axis["errors"] & ~axis["seen_errors"]
    axis["seen_errors"] = axis["errors"]
    if axis["mode"] != DIRECT_OUTPUT:
        fired = level_of(axis, rising)
        spreads = spreads or fired > level
        level = fired if fired > level else level
    if level == NO_HALT:
        return
    halt(axis, ramps, level)
    if spreads and axis["halt_group"] != 0 and level >= OPEN_LOOP_HALT:
        spread(axes, axis_count, axis_index, level)


@kernel
def check(axes: Records, axis_count: int, ramps: Records, axis_index: int, encoder_sign: int) -> None:
    """Error bits of this loop, and what follows from them."""
    axis = axes[axis_index]
    live = following_error(axis) | overtravel(axis) | transducer_errors(axis, encoder_sign) | axis["inputs"]
    if axis["saturated"] != 0:
        live |= OUTPUT_SATURATED
    axis["live_errors"] = live
    axis["errors"] |= live
    if axis["errors"] != axis["seen_errors"] or axis["halt_wanted"] != 0:
        deal_with(axes, axis_count, ramps, axis_index)


@kernel
def arrived(axis: Record) -> int:
    """In Position in position control, At Velocity in velocity control (M864, M972)."""
    if axis["mode"] == POSITION_PID or axis["mode"] == POSITION_I_PD:
        there = axis["moves_to_position"] != 0 and axis["target_position"] == axis["command_position"]
        near = abs(axis["actual_position"] - axis["command_position"]) < axis["in_position_tolerance"]
        return IN_POSITION if there and near else 0
    if axis["mode"] == VELOCITY_PID or axis["mode"] == VELOCITY_I_PD:
        there = axis["target_velocity"] == axis["command_velocity"] and axis["target_done"] != 0
        near = abs(axis["shown_velocity"] - axis["command_velocity"]) < axis["at_velocity_tolerance"]
        return AT_VELOCITY if there and near else 0
    return 0


@seldom
def refresh_status(axis: Record) -> None:
    """Put the Status Bits together."""
    status = arrived(axis) | axis["inputs"]
    if axis["mode"] <= OPEN_LOOP:
        status |= IN_OPEN_LOOP
    if abs(axis["shown_velocity"]) < axis["stop_threshold"]:
        status |= STOPPED
    if axis["lost_loops"] > 0:
        status |= INPUT_ESTIMATED
    else:
        status |= FEEDBACK_OK
    if axis["enable_output"] != 0:
        status |= ENABLE_OUTPUT
    if axis["target_done"] != 0:
        status |= TARGET_DONE
    status |= axis["target_state"] << STATE_SHIFT
    if axis["mode"] == DIRECT_OUTPUT:
        status |= DIRECT
    if axis["enabled"] != 0:
        status |= ENABLED
    if axis["external_halt"] != 0:
        status |= EXTERNALLY_HALTED
    if axis["halted"] != 0:
        status |= HALTED
    axis["status"] = status

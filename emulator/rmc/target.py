"""What makes the target of a loop: a plan of ramps, a gear, a master that is tracked, or a ramp of the output.

The phase of the generator is told in two bits, A and B (M718-M801): 1 accelerating or ramping away, 2 constant, 3
decelerating or ramping towards 0, 0 complete, or constant at 0.
"""

from __future__ import annotations

import math

from emulator.engine.kernels import Record, Records

from .kernels import kernel, seldom
from .laws import FULL_PERCENT, POSITION_I_PD, POSITION_PID, clear_terms, held_within, is_finite, take_over
from .ramps import LINEAR, S_CURVE, on_ramp

REST, RAMPS, GEAR_BY_TIME, GEAR_BY_RATE, GEAR_BY_DISTANCE, GEAR_MAP, TRACK, TRACK_STEPS = range(8)
OUTPUT_RAMP, OUTPUT_RAMP_THEN_CLOSE, QUICK_MOVE, OUTPUT_BY_DISTANCE = range(8, 12)

COMPLETE, RISING, CONSTANT, FALLING = range(4)

DIRECT_OUTPUT, OPEN_LOOP = 1, 2

FAULT, TRUNCATE, EXTRAPOLATE = range(3)
RUN_TIME_ERROR = 1 << 14

TRACK_LAG_SHARE = 0.25
"""Track Position: bandwidth of the position loop over that of the velocity loop (design choice: no overshoot)."""


@kernel
def is_closed(axis: Record) -> bool:
    """A loop is closed."""
    return bool(axis["mode"] >= POSITION_PID)


@kernel
def rest(axis: Record) -> None:
    """The target stands still where it is."""
    axis["generator"] = REST
    axis["target_velocity"] = 0.0
    axis["target_acceleration"] = 0.0
    axis["target_jerk"] = 0.0
    axis["target_state"] = COMPLETE
    axis["target_done"] = 1


@seldom
def close_at(axis: Record, mode: int) -> None:
    """Close the loop on the present position at rest; the output goes on where it is."""
    percent = (axis["control_v"] - axis["output_bias"]) / axis["output_scale"] * FULL_PERCENT
    axis["mode"] = mode
    take_over(axis, percent)
    axis["target_position"] = axis["actual_position"]
    axis["command_position"] = axis["actual_position"]
    axis["command_velocity"] = 0.0
    axis["speed_limit"] = 0.0
    axis["jump"] = 0
    axis["moves_to_position"] = 0
    rest(axis)


@seldom
def open_to(axis: Record, mode: int, goal_v: float, ramp: float) -> None:
    """Open the loop; the output goes from where it is to `goal_v` (before the bias) at `ramp` V/s."""
    if axis["mode"] >= POSITION_PID:
        axis["open_loop_v"] = axis["control_v"] - axis["output_bias"]
    axis["mode"] = mode
    axis["open_loop_goal_v"] = goal_v
    axis["open_loop_ramp"] = ramp
    axis["generator"] = OUTPUT_RAMP
    axis["off_when_done"] = 0
    axis["jump"] = 0
    axis["speed_limit"] = 0.0
    axis["moves_to_position"] = 0
    axis["command_follows"] = 3
    axis["target_done"] = 0
    clear_terms(axis)


@seldom
def begin_stop(axis: Record, ramps: Records, decel: float) -> None:
    """Ramp the Target Velocity to 0; the target of an I-PD that has jumped comes back to where the axis can stop."""
    velocity = axis["target_velocity"]
    axis["moves_to_position"] = 0
    if axis["jump"] != 0 and axis["mode"] == POSITION_I_PD:
        speed = axis["shown_velocity"]
        axis["target_position"] = axis["actual_position"] + speed * abs(speed) / (2.0 * decel)
        velocity = 0.0
    axis["jump"] = 0
    if velocity == 0.0:
        rest(axis)
        return
    ramp = ramps[axis["ramp_first"]]
    duration = abs(velocity) / decel
    ramp["start_s"] = 0.0
    ramp["duration_s"] = duration
    ramp["position"] = 0.0
    ramp["velocity"] = velocity
    ramp["change"] = -velocity
    ramp["shape"] = S_CURVE if axis["s_curve"] != 0 else LINEAR
    axis["plan_start"] = axis["target_position"]
    axis["plan_end"] = axis["target_position"] + 0.5 * velocity * duration
    axis["ramp_count"] = 1
    axis["ramp_index"] = 0
    axis["generator_loops"] = 0
    axis["generator"] = RAMPS
    axis["target_done"] = 0


@kernel
def phase_of(velocity: float, change: float) -> int:
    """Phase of a piece of a plan from the velocity it is about and its change."""
    if change == 0.0:
        return CONSTANT if velocity != 0.0 else COMPLETE
    middle = velocity + 0.5 * change
    return RISING if middle * change > 0.0 else FALLING


@kernel
def follow_ramps(axis: Record, ramps: Records, loop_s: float) -> None:
    """One loop further along the plan; it ends at rest exactly where it was to end."""
    axis["generator_loops"] += 1
    elapsed_s = axis["generator_loops"] * loop_s
    first, count, index = axis["ramp_first"], axis["ramp_count"], axis["ramp_index"]
    # A millionth of a loop: the sum of the durations and the count of loops are rounded differently.
    reached = elapsed_s + 1e-6 * loop_s
    while index < count and reached >= ramps[first + index]["start_s"] + ramps[first + index]["duration_s"]:
        index += 1
    axis["ramp_index"] = index
    if index == count:
        axis["target_position"] = axis["plan_end"]
        rest(axis)
        return
    ramp = ramps[first + index]
    on_ramp(axis, ramp, elapsed_s - ramp["start_s"])
    axis["target_state"] = phase_of(ramp["velocity"], ramp["change"])
    if math.isinf(ramp["duration_s"]):
        axis["target_done"] = 1


@kernel
def move_target(axis: Record, position: float, loops_per_s: float) -> None:
    """Put the target somewhere; velocity and acceleration are what that makes of them."""
    velocity = (position - axis["target_position"]) * loops_per_s
    axis["target_acceleration"] = (velocity - axis["target_velocity"]) * loops_per_s
    axis["target_jerk"] = 0.0
    axis["target_velocity"] = velocity
    axis["target_position"] = position


@kernel
def lock_gear(axis: Record) -> None:
    """From here on the target is tied to the master, free of rounding however long."""
    axis["gear_locked"] = 1
    axis["gear_master_at"] = axis["master"]
    axis["gear_slave_at"] = axis["target_position"]
    axis["target_state"] = CONSTANT if axis["gear_ratio"] != 0.0 else COMPLETE
    axis["target_done"] = 1


@kernel
def locked_position(axis: Record) -> float:
    """Where a locked gear has its slave."""
    return float(axis["gear_slave_at"] + axis["gear_ratio"] * (axis["master"] - axis["gear_master_at"]))


@seldom
def gear_by_time(axis: Record, loop_s: float, loops_per_s: float) -> None:
    """The ratio goes from the effective one to the one asked for within the clutch time."""
    moved = axis["master"] - axis["previous_master"]
    axis["generator_loops"] += 1
    if axis["generator_loops"] == 1:
        axis["gear_from_ratio"] = axis["target_velocity"] / (moved * loops_per_s) if moved != 0.0 else 0.0
    elapsed_s = axis["generator_loops"] * loop_s
    ratio = axis["gear_ratio"]
    if elapsed_s < axis["gear_clutch_s"]:
        ratio = axis["gear_from_ratio"] + (ratio - axis["gear_from_ratio"]) * elapsed_s / axis["gear_clutch_s"]
    move_target(axis, axis["target_position"] + ratio * moved, loops_per_s)
    rising = abs(axis["gear_ratio"]) > abs(axis["gear_from_ratio"])
    axis["target_state"] = RISING if rising else FALLING
    if elapsed_s >= axis["gear_clutch_s"]:
        lock_gear(axis)


@seldom
def gear_by_rate(axis: Record, loop_s: float, loops_per_s: float) -> None:
    """The slave accelerates until it runs at the ratio times the master's velocity."""
    wanted = axis["gear_ratio"] * (axis["master"] - axis["previous_master"]) * loops_per_s
    change = wanted - axis["target_velocity"]
    step = held_within(change, axis["gear_accel"] * loop_s)
    axis["target_state"] = RISING if axis["target_velocity"] * change >= 0.0 else FALLING
    mean = axis["target_velocity"] + 0.5 * step
    axis["target_velocity"] += step
    axis["target_position"] += mean * loop_s
    axis["target_acceleration"] = step * loops_per_s
    axis["target_jerk"] = 0.0
    if step == change:
        lock_gear(axis)


@seldom
def gear_by_distance(axis: Record, loops_per_s: float) -> None:
    """Between the master's start and its sync position the slave goes to its own with the gear's slope: a cubic."""
    span = axis["gear_master_to"] - axis["gear_master_at"]
    u = (axis["master"] - axis["gear_master_at"]) / span
    if u >= 1.0:
        axis["gear_master_at"] = axis["gear_master_to"]
        axis["gear_slave_at"] = axis["gear_slave_to"]
        axis["gear_locked"] = 1
        axis["target_done"] = 1
        axis["target_state"] = CONSTANT if axis["gear_ratio"] != 0.0 else COMPLETE
        move_target(axis, locked_position(axis), loops_per_s)
        return
    if u <= 0.0:
        move_target(axis, axis["gear_slave_at"], loops_per_s)
        return
    axis["target_state"] = RISING
    way = axis["gear_slave_to"] - axis["gear_slave_at"]
    place = u * u * ((3.0 - 2.0 * u) * way + (u - 1.0) * axis["gear_ratio"] * span)
    move_target(axis, axis["gear_slave_at"] + place, loops_per_s)


@seldom
def gear_map(axis: Record, loops_per_s: float) -> None:
    """The slave's range stands to the master's as given; beyond its ends as the command says."""
    span = axis["gear_master_to"] - axis["gear_master_at"]
    u = (axis["master"] - axis["gear_master_at"]) / span
    if u < 0.0 or u > 1.0:
        if axis["gear_end_point"] == FAULT:
            axis["errors"] |= RUN_TIME_ERROR
        if axis["gear_end_point"] != EXTRAPOLATE:
            u = 0.0 if u < 0.0 else 1.0
    way = axis["gear_slave_to"] - axis["gear_slave_at"]
    move_target(axis, axis["gear_slave_at"] + u * way, loops_per_s)
    axis["target_state"] = CONSTANT
    axis["target_done"] = 1


@kernel
def braked_speed(distance: float, acceleration: float, bandwidth: float) -> float:
    """Speed towards a goal from which it can still be braked: in proportion when near, a square root when far."""
    near = acceleration / (bandwidth * bandwidth)
    if abs(distance) <= near:
        return bandwidth * distance
    speed = math.sqrt(2.0 * acceleration * (abs(distance) - 0.5 * near))
    return speed if distance > 0.0 else -speed


@seldom
def track(axis: Record, loop_s: float, loops_per_s: float) -> None:
    """Follow the master within limits of velocity, acceleration and jerk; the filter itself is a design choice."""
    master = axis["master"]
    moved = 0.0
    if abs(master - axis["track_goal"]) > axis["track_deadband"]:
        moved = (master - axis["previous_master"]) * loops_per_s
        axis["track_goal"] = master
    bandwidth = axis["track_jerk"] / axis["track_acceleration"] * 0.5
    if bandwidth > 0.5 * loops_per_s:
        bandwidth = 0.5 * loops_per_s
    distance = axis["track_goal"] - axis["target_position"]
    velocity = braked_speed(distance, 0.5 * axis["track_acceleration"], TRACK_LAG_SHARE * bandwidth)
    velocity = held_within(velocity + moved, axis["track_velocity"])
    change = held_within((velocity - axis["target_velocity"]) * bandwidth, axis["track_acceleration"])
    step = held_within(change - axis["target_acceleration"], axis["track_jerk"] * loop_s)
    axis["target_jerk"] = step * loops_per_s
    axis["target_acceleration"] += step
    axis["target_velocity"] += axis["target_acceleration"] * loop_s
    axis["target_position"] += axis["target_velocity"] * loop_s
    axis["target_state"] = CONSTANT


@kernel
def ramp_output(axis: Record, loop_s: float) -> bool:
    """One loop further along a ramp of the output; true when it has arrived."""
    goal, volts = axis["open_loop_goal_v"], axis["open_loop_v"]
    step = held_within(goal - volts, axis["open_loop_ramp"] * loop_s)
    axis["open_loop_v"] = goal if step == goal - volts else volts + step
    if step == 0.0:
        axis["target_state"] = CONSTANT if goal != 0.0 else COMPLETE
    else:
        axis["target_state"] = RISING if (volts + step) * step > 0.0 else FALLING
    return bool(axis["open_loop_v"] == goal)


@seldom
def output_by_distance(axis: Record) -> None:
    """The output goes from where it was to its goal in proportion to the way made towards a position (M111)."""
    span = axis["open_loop_span"]
    share = (axis["actual_position"] - axis["open_loop_from"]) / span if span != 0.0 else 1.0
    start, goal = axis["open_loop_start_v"], axis["open_loop_goal_v"]
    axis["open_loop_v"] = start + (goal - start) * min(max(share, 0.0), 1.0)
    if share >= 1.0:
        axis["generator"] = OUTPUT_RAMP
    else:
        axis["target_state"] = RISING if abs(goal) > abs(start) else FALLING


@seldom
def open_loop_generator(axis: Record, loop_s: float) -> None:
    """A ramp of the output, and what follows it."""
    arrived = ramp_output(axis, loop_s)
    if not arrived:
        return
    axis["target_done"] = 1
    axis["target_state"] = CONSTANT if axis["open_loop_v"] != 0.0 else COMPLETE
    if axis["off_when_done"] != 0:
        axis["off_when_done"] = 0
        axis["enable_output"] = 0
    if axis["generator"] == OUTPUT_RAMP_THEN_CLOSE:
        close_at(axis, axis["next_mode"])


@seldom
def quick_move(axis: Record, ramps: Records, loop_s: float) -> None:
    """Open loop until what is left is the way to stop; from there a closed loop decelerates to the position."""
    arrived = ramp_output(axis, loop_s)
    if arrived:
        axis["target_state"] = CONSTANT
    sign = 1.0 if axis["open_loop_goal_v"] >= 0.0 else -1.0
    left = sign * (axis["command_position"] - axis["actual_position"])
    speed = sign * axis["shown_velocity"]
    if left > 0.0 and (speed <= 0.0 or 0.5 * speed * speed < axis["quick_decel"] * left):
        return
    goal = axis["command_position"]
    close_at(axis, POSITION_PID)
    axis["command_position"] = goal
    axis["moves_to_position"] = 1
    if left <= 0.0 or speed <= 0.0:
        axis["target_position"] = goal
        return
    axis["target_velocity"] = sign * speed
    begin_stop(axis, ramps, 0.5 * speed * speed / left)
    axis["moves_to_position"] = 1
    axis["plan_end"] = goal


@kernel
def follow_master(axis: Record, loop_s: float, loops_per_s: float) -> None:
    """One loop of a generator that has a master."""
    generator = axis["generator"]
    if generator == TRACK_STEPS:
        axis["target_position"] = axis["master"]
        axis["target_velocity"] = 0.0
        axis["target_done"] = 1
    elif generator == TRACK:
        track(axis, loop_s, loops_per_s)
    elif generator == GEAR_MAP:
        gear_map(axis, loops_per_s)
    elif axis["gear_locked"] != 0:
        move_target(axis, locked_position(axis), loops_per_s)
    elif generator == GEAR_BY_TIME:
        gear_by_time(axis, loop_s, loops_per_s)
    elif generator == GEAR_BY_RATE:
        gear_by_rate(axis, loop_s, loops_per_s)
    else:
        gear_by_distance(axis, loops_per_s)


@kernel
def generate(axis: Record, ramps: Records, loop_s: float, loops_per_s: float) -> None:
    """The target of this loop."""
    generator = axis["generator"]
    if generator == RAMPS:
        follow_ramps(axis, ramps, loop_s)
    elif OUTPUT_RAMP <= generator <= OUTPUT_RAMP_THEN_CLOSE:
        open_loop_generator(axis, loop_s)
    elif generator == QUICK_MOVE:
        quick_move(axis, ramps, loop_s)
    elif generator == OUTPUT_BY_DISTANCE:
        output_by_distance(axis)
    elif generator != REST:
        follow_master(axis, loop_s, loops_per_s)
    if not is_closed(axis) or not is_finite(axis["target_position"] + axis["target_velocity"]):
        axis["target_position"] = axis["actual_position"]
        axis["target_velocity"] = 0.0
        axis["target_acceleration"] = 0.0
        axis["target_jerk"] = 0.0
    if (axis["command_follows"] & 1) != 0:
        axis["command_position"] = axis["target_position"]
    if (axis["command_follows"] & 2) != 0:
        axis["command_velocity"] = axis["target_velocity"]

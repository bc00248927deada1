"""Commands that move an axis: closed-loop moves, open loop, gears, tracking, stops."""

from __future__ import annotations

from protocol.rmc.bits import ControlMode

from .axis import Axis, Complaint, Refused
from .commands import (
    COMMAND_FOLLOWS_BOTH,
    COMMAND_FOLLOWS_POSITION,
    COMMAND_FOLLOWS_VELOCITY,
    COMMAND_STANDS,
    DeviceLike,
    Values,
    base_of,
    carries_out,
    close,
    close_position,
    find_master,
    go_for,
)
from .laws import clear_terms
from .ramps import plan_move, plan_speed_at, plan_timed, plan_velocity
from .target import (
    DIRECT_OUTPUT,
    GEAR_BY_DISTANCE,
    GEAR_BY_RATE,
    GEAR_BY_TIME,
    GEAR_MAP,
    OPEN_LOOP,
    OUTPUT_BY_DISTANCE,
    OUTPUT_RAMP_THEN_CLOSE,
    QUICK_MOVE,
    TRACK,
    TRACK_STEPS,
    begin_stop,
    close_at,
    open_to,
    rest,
)

POSITIVE, NEGATIVE, CURRENT, SIGNED = 1, -1, 2, 4
NEVER_RAMPED_V_S = 1.0
"""Rate of an output that follows the position: it has arrived before a ramp in time would begin."""
RESET = 1

# Moves to a position


def move_to(axis: Axis, position: float, values: Values) -> None:
    """Speed, acceleration and deceleration lead the target to a position."""
    close_position(axis)
    speed, accel, decel = values
    goal = go_for(axis, position)
    way = goal - axis["target_position"]
    plan = plan_move(way, axis["target_velocity"], speed=speed, accel=accel, decel=decel, shape=axis.shape)
    axis.follow(plan, end=goal)


@carries_out("move_absolute")
def move_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position."""
    move_to(axis, values[0], values[1:4])


@carries_out("move_relative")
def move_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance from where the axis is, was sent or was to be."""
    move_to(axis, base_of(axis, values[4]) + values[0], values[1:4])


def timed_move(axis: Axis, position: float, time_s: float, velocity: float = 0.0, acceleration: float = 0.0) -> None:
    """To a position in a time; at once if there is none (M136)."""
    close_position(axis)
    goal = go_for(axis, position)
    if time_s == 0.0:
        rest(axis.record)
        axis.write(target_position=goal)
        return
    plan = plan_timed(
        goal - axis["target_position"],
        axis["target_velocity"],
        axis["target_acceleration"],
        time_s=time_s,
        to_velocity=velocity,
        to_acceleration=acceleration,
    )
    if velocity != 0.0:
        axis.write(moves_to_position=0, command_follows=COMMAND_FOLLOWS_VELOCITY)
    axis.follow(plan, end=goal)


@carries_out("time_move_absolute")
def time_move_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position in a time."""
    timed_move(axis, *values)


@carries_out("time_move_relative")
def time_move_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance in a time."""
    timed_move(axis, base_of(axis, values[2]) + values[0], values[1])


@carries_out("advanced_time_move_absolute")
def advanced_time_move_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position in a time, with velocity and acceleration there."""
    position, velocity, acceleration, time_s = values
    timed_move(axis, position, time_s, velocity, acceleration)


@carries_out("advanced_time_move_relative")
def advanced_time_move_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance in a time, with velocity and acceleration there."""
    distance, velocity, acceleration, time_s, relative_to = values
    timed_move(axis, base_of(axis, relative_to) + distance, time_s, velocity, acceleration)


def jump_to(axis: Axis, position: float, speed: float) -> None:
    """Position I-PD with the target at its goal at once and the axis's speed limited (M112)."""
    close(axis, ControlMode.POSITION_I_PD)
    goal = go_for(axis, position)
    rest(axis.record)
    axis.write(target_position=goal, speed_limit=speed, jump=1)


@carries_out("move_absolute_i_pd")
def move_absolute_i_pd(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position, target at once."""
    jump_to(axis, values[0], values[1])


@carries_out("move_relative_i_pd")
def move_relative_i_pd(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance, target at once."""
    jump_to(axis, base_of(axis, values[2]) + values[0], values[1])


@carries_out("speed_at_position")
def speed_at_position(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Reach a velocity at a position in one ramp; refused where none leads there."""
    position, velocity = values
    way = position - axis["target_position"]
    plan = plan_speed_at(way, axis["target_velocity"], to_velocity=velocity, shape=axis.shape)
    if plan is None:
        raise Refused(Complaint.BAD_PARAMETER)
    close_position(axis)
    goal = go_for(axis, position)
    axis.write(moves_to_position=velocity == 0.0)
    axis.follow(plan, end=goal)


def quick_move(axis: Axis, position: float, values: Values) -> None:
    """Open loop towards a position, closed loop to stop there (M736)."""
    output_v, ramp, decel = values
    position_now = axis["actual_position"]
    sign = 1.0 if position >= position_now else -1.0
    open_to(axis.record, OPEN_LOOP, sign * output_v, ramp)
    go_for(axis, position)
    axis.write(generator=QUICK_MOVE, quick_decel=decel, moves_to_position=1)


@carries_out("quick_move_absolute")
def quick_move_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position."""
    quick_move(axis, values[0], values[1:4])


@carries_out("quick_move_relative")
def quick_move_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance."""
    quick_move(axis, base_of(axis, values[4]) + values[0], values[1:4])


# Velocity


@carries_out("move_velocity")
def move_velocity(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Run at a speed until told otherwise: of the target position, or of the axis in velocity control (M800)."""
    speed, accel, decel, direction = values
    close(axis, axis.next_mode)
    wanted = speed
    if direction == CURRENT:
        wanted = -abs(speed) if axis["target_velocity"] < 0.0 else abs(speed)
    elif direction != SIGNED:
        wanted = direction * abs(speed)
    run_at(axis, wanted)
    axis.follow(plan_velocity(axis["target_velocity"], wanted, accel=accel, decel=decel, shape=axis.shape))


def run_at(axis: Axis, velocity: float) -> None:
    """Make a velocity the Command Velocity."""
    axis.write(command_velocity=velocity, moves_to_position=0, command_follows=COMMAND_FOLLOWS_POSITION)


@carries_out("move_velocity_i_pd")
def move_velocity_i_pd(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Velocity I-PD with the target velocity there at once."""
    close(axis, ControlMode.VELOCITY_I_PD)
    run_at(axis, values[0])
    rest(axis.record)
    axis.write(target_velocity=values[0], jump=1)


# Gears and tracking


def engage(device: DeviceLike, axis: Axis, master: float) -> None:
    """Close the position loop behind a master."""
    if axis.next_mode.velocity:
        raise Refused(Complaint.WRONG_MODE)
    found = find_master(device, axis, master)
    close_position(axis)
    axis.write(
        **found,
        moves_to_position=0,
        command_follows=COMMAND_FOLLOWS_BOTH,
        generator_loops=0,
        gear_locked=0,
        target_done=0,
    )


def ratio_of(numerator: float, denominator: float) -> float:
    """Refused for a denominator of 0."""
    if denominator == 0.0:
        raise Refused(Complaint.BAD_PARAMETER)
    return numerator / denominator


@carries_out("gear_clutch_by_time")
def gear_clutch_by_time(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Gear whose clutch closes in a time."""
    numerator, denominator, master, clutch_s = values
    ratio = ratio_of(numerator, denominator)
    engage(device, axis, master)
    axis.write(generator=GEAR_BY_TIME, gear_ratio=ratio, gear_clutch_s=clutch_s)


@carries_out("gear_clutch_by_rate")
def gear_clutch_by_rate(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Gear whose clutch closes at an acceleration of the slave."""
    numerator, denominator, master, accel = values
    ratio = ratio_of(numerator, denominator)
    engage(device, axis, master)
    axis.write(generator=GEAR_BY_RATE, gear_ratio=ratio, gear_accel=accel)


@carries_out("gear_clutch_by_distance")
def gear_clutch_by_distance(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Gear whose clutch closes while the master covers a distance: at its sync position the slave is at its own."""
    ratio, master, master_sync, slave_sync, start_distance, master_direction, _ = values
    engage(device, axis, master)
    axis.write(
        generator=GEAR_BY_DISTANCE,
        gear_ratio=ratio,
        gear_master_at=master_sync - master_direction * start_distance,
        gear_master_to=master_sync,
        gear_slave_at=axis["target_position"],
        gear_slave_to=slave_sync,
    )


@carries_out("gear_absolute")
def gear_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """The slave's range on the master's. Refused further than the Position Error Tolerance from where that puts the
    slave, since the target would jump (design choice)."""
    master, master_a, master_b, slave_a, slave_b, end_point = values
    if master_a == master_b:
        raise Refused(Complaint.BAD_PARAMETER)
    share = (find_master(device, axis, master)["master"] - master_a) / (master_b - master_a)
    place = slave_a + share * (slave_b - slave_a)
    if abs(place - axis["target_position"]) > axis["position_error_tolerance"]:
        raise Refused(Complaint.BAD_PARAMETER)
    engage(device, axis, master)
    axis.write(
        generator=GEAR_MAP,
        gear_master_at=master_a,
        gear_master_to=master_b,
        gear_slave_at=slave_a,
        gear_slave_to=slave_b,
        gear_end_point=end_point,
    )


@carries_out("track_position")
def track_position(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Follow a master within limits."""
    master, velocity, acceleration, jerk, deadband = values
    engage(device, axis, master)
    axis.write(
        generator=TRACK,
        track_velocity=velocity,
        track_acceleration=acceleration,
        track_jerk=jerk,
        track_deadband=deadband,
        track_goal=axis["target_position"],
        target_acceleration=0.0,
    )


@carries_out("track_position_i_pd")
def track_position_i_pd(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Position I-PD with the master as target, at a limited speed."""
    master, speed = values
    found = find_master(device, axis, master)
    close(axis, ControlMode.POSITION_I_PD)
    axis.write(
        **found,
        generator=TRACK_STEPS,
        speed_limit=speed,
        moves_to_position=0,
        command_follows=COMMAND_FOLLOWS_BOTH,
        jump=1,
        target_done=1,
    )


# Open loop, stops


@carries_out("direct_output")
def direct_output(device: DeviceLike, axis: Axis, values: Values) -> None:
    """A voltage, with the AutoStops off."""
    open_to(axis.record, DIRECT_OUTPUT, values[0], values[1])


@carries_out("open_loop_rate")
def open_loop_rate(device: DeviceLike, axis: Axis, values: Values) -> None:
    """A voltage, reached by a linear ramp."""
    open_to(axis.record, OPEN_LOOP, values[0], values[1])


@carries_out("open_loop_absolute")
def open_loop_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """A voltage, reached in proportion to the way made towards a position."""
    output_v, position = values
    open_over_distance(axis, output_v, position - axis["actual_position"])


@carries_out("open_loop_relative")
def open_loop_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """A voltage, reached in proportion to the way made of a distance."""
    output_v, distance = values
    open_over_distance(axis, output_v, distance)


def open_over_distance(axis: Axis, output_v: float, distance: float) -> None:
    """Open the loop; the output follows the position, not the time, so an axis that has no output does not set out."""
    open_to(axis.record, OPEN_LOOP, output_v, NEVER_RAMPED_V_S)
    axis.write(
        generator=OUTPUT_BY_DISTANCE,
        open_loop_start_v=axis["open_loop_v"],
        open_loop_from=axis["actual_position"],
        open_loop_span=distance,
    )


@carries_out("stop_open_loop")
def stop_open_loop(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp the output to 0."""
    open_to(axis.record, OPEN_LOOP, 0.0, values[0])


@carries_out("stop_closed_loop")
def stop_closed_loop(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp the target to rest; from open loop the output to 0 (V/s), and then close the loop there (M716)."""
    decel = values[0]
    if not axis.mode.closed_loop:
        open_to(axis.record, OPEN_LOOP, 0.0, decel)
        axis.write(generator=OUTPUT_RAMP_THEN_CLOSE)
        return
    if axis.mode == ControlMode.VELOCITY_I_PD and axis.integer("jump"):
        rest(axis.record)
        axis.write(jump=0)
    else:
        begin_stop(axis.record, axis.memory.ramps, decel)
    axis.write(command_velocity=0.0, command_follows=COMMAND_FOLLOWS_POSITION, moves_to_position=0, speed_limit=0.0)


@carries_out("hold_position")
def hold_position(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Target and command where the axis is; the output goes on, or with Reset from 0 (M718)."""
    mode = axis.mode if axis.mode.closed_loop and not axis.mode.velocity else axis.next_mode
    close_at(axis.record, ControlMode.POSITION_PID if mode.velocity else mode)
    if values[0] == RESET:
        clear_terms(axis.record)
    axis.write(moves_to_position=1, command_follows=COMMAND_STANDS)

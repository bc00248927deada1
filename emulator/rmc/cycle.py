"""The fused cycle of an RMC: every loop of every axis, until a given time or a watched status bit changes.

Inputs, law, outputs, once a loop (H Loop_Time). All axes are measured before any target is made, so that a gear sees
its master as it is in this loop.
"""

from __future__ import annotations

from emulator.engine.encoder import read_encoder
from emulator.engine.kernels import Floats, Record, Records
from emulator.engine.plants import place_of_load, step_plant

from .filters import low_pass
from .halts import NEGATIVE_LIMIT_INPUT, POSITIVE_LIMIT_INPUT, check, refresh_status
from .kernels import kernel, seldom
from .laws import VELOCITY_PID, closed_loop, is_finite
from .layout import BODIES_PER_AXIS, FILTERS_PER_AXIS, MODEL, SECTIONS
from .output_stage import put_out, put_out_percent
from .target import COMPLETE, CONSTANT, RAMPS, generate, is_closed

WATCHED = 1


@kernel
def move_body(body: Record, plant: Record, volts: float, now_ns: int) -> None:
    """Advance what is driven over the loop just past, the output held, and read its transducer."""
    step_plant(body, plant, volts)
    read_encoder(body, now_ns)


@kernel
def feed_law(axis: Record, loops_per_s: float) -> None:
    """What the law sees: unfiltered values, unless the filter's type is Low-Pass (M926)."""
    axis["previous_velocity"] = axis["law_velocity"]
    axis["previous_law_acceleration"] = axis["law_acceleration"]
    axis["previous_jerk"] = axis["law_jerk"]
    axis["law_velocity"] = axis["shown_velocity"] if axis["low_pass_velocity"] != 0 else axis["actual_velocity"]
    filtered = axis["low_pass_acceleration"] != 0
    axis["law_acceleration"] = axis["shown_acceleration"] if filtered else axis["actual_acceleration"]
    axis["law_jerk"] = (axis["law_acceleration"] - axis["previous_law_acceleration"]) * loops_per_s


@kernel
def measure(device: Record, axis: Record, body: Record, filters: Records, first_filter: int) -> None:
    """Actual values of this loop; velocity and acceleration are differences of the position (M877, M878)."""
    axis["raw_counts"] = body["encoder_counts"]
    position = axis["raw_counts"] * axis["position_scale"] + axis["position_offset"]
    velocity = (position - axis["actual_position"]) * device["loops_per_s"]
    acceleration = (velocity - axis["actual_velocity"]) * device["loops_per_s"]
    axis["actual_jerk"] = (acceleration - axis["actual_acceleration"]) * device["loops_per_s"]
    axis["previous_position"] = axis["actual_position"]
    axis["actual_position"] = position
    axis["actual_velocity"] = velocity
    axis["actual_acceleration"] = acceleration
    axis["shown_position"] = low_pass(filters, first_filter, position)
    axis["shown_velocity"] = low_pass(filters, first_filter + SECTIONS, velocity)
    axis["shown_acceleration"] = low_pass(filters, first_filter + 2 * SECTIONS, acceleration)
    feed_law(axis, device["loops_per_s"])


@kernel
def read_inputs(axis: Record, machine: Record) -> None:
    """Fault and limit inputs: as they are wired, and by the switches along the travel."""
    inputs = axis["wired_inputs"]
    place = place_of_load(machine)
    if place >= axis["positive_switch"]:
        inputs |= POSITIVE_LIMIT_INPUT
    if place <= axis["negative_switch"]:
        inputs |= NEGATIVE_LIMIT_INPUT
    axis["inputs"] = inputs


@kernel
def read_master(axis: Record, axis_floats: Floats, variables: Floats) -> None:
    """The master's value this loop; one that is no number is not followed."""
    axis["previous_master"] = axis["master"]
    word = axis["master_word"]
    value = axis_floats[word] if word >= 0 else variables[axis["master_variable"]]
    if is_finite(value):
        axis["master"] = value


@kernel
def take_errors(axis: Record) -> None:
    """Position and velocity error; in velocity control the position is not controlled and has none."""
    if axis["mode"] >= VELOCITY_PID:
        axis["target_position"] = axis["actual_position"]
    axis["position_error"] = axis["target_position"] - axis["actual_position"]
    axis["velocity_error"] = axis["target_velocity"] - axis["law_velocity"]


@kernel
def capture_feed_forward(axis: Record) -> None:
    """Remember the output that a constant velocity takes, for Feed Forward Adjust (69)."""
    steady = axis["generator"] == RAMPS and axis["target_state"] == CONSTANT and axis["target_velocity"] != 0.0
    if steady and axis["saturated"] == 0:
        axis["captured_pfid"] = axis["pfid"]
        axis["captured_velocity"] = axis["target_velocity"]


@kernel
def control(axis: Record, loop_s: float) -> None:
    """The law, or the output of open loop, and the output chain."""
    if is_closed(axis):
        put_out_percent(axis, closed_loop(axis, loop_s))
        if axis["target_state"] != COMPLETE:
            capture_feed_forward(axis)
    else:
        put_out(axis, axis["open_loop_v"])


@kernel
def loop(
    device: Record,
    axes: Records,
    bodies: Records,
    plants: Records,
    ramps: Records,
    filters: Records,
    axis_floats: Floats,
    variables: Floats,
) -> None:
    """One loop of all axes."""
    axis_count = device["axis_count"]
    loop_s, loops_per_s = device["loop_s"], device["loops_per_s"]
    now_ns = device["next_loop_ns"]
    for index in range(axis_count):
        axis = axes[index]
        machine = BODIES_PER_AXIS * index
        bodies[machine]["enabled"] = axis["enable_output"]
        move_body(bodies[machine], plants[machine], 0.0 if axis["simulated"] != 0 else axis["pins_v"], now_ns)
        feedback = machine
        if axis["simulated"] != 0:
            feedback = machine + MODEL
            if axis["model_held"] == 0:
                move_body(bodies[feedback], plants[feedback], axis["control_v"], now_ns)
        read_inputs(axis, bodies[machine])
        measure(device, axis, bodies[feedback], filters, FILTERS_PER_AXIS * index)
    for index in range(axis_count):
        axis = axes[index]
        read_master(axis, axis_floats, variables)
        generate(axis, ramps, loop_s, loops_per_s)
        take_errors(axis)
        check(axes, axis_count, ramps, index, bodies[BODIES_PER_AXIS * index]["encoder_sign"])
        control(axis, loop_s)


@seldom
def watched_change(device: Record, axes: Records) -> int:
    """WATCHED if a watched status bit of any axis has changed."""
    fired = 0
    for index in range(device["axis_count"]):
        axis = axes[index]
        refresh_status(axis)
        watched = axis["status"] & device["watch_mask"]
        if watched != axis["watched_status"]:
            axis["watched_status"] = watched
            fired = WATCHED
    return fired


@seldom
def advance(
    device: Record,
    axes: Records,
    bodies: Records,
    plants: Records,
    ramps: Records,
    filters: Records,
    axis_floats: Floats,
    variables: Floats,
    until_ns: int,
) -> int:
    """Run every loop up to `until_ns`, or up to a change of a watched bit; returns WATCHED or 0."""
    fired = 0
    while fired == 0 and device["next_loop_ns"] <= until_ns:
        loop(device, axes, bodies, plants, ramps, filters, axis_floats, variables)
        device["next_loop_ns"] += device["loop_ns"]
        if device["watch_mask"] != 0:
            fired = watched_change(device, axes)
    for index in range(device["axis_count"]):
        refresh_status(axes[index])
    return fired

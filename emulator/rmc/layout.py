"""The records of the RMC's kernel: every variable of an axis, one documented line each.

As in the servo's layout all fields are 8 bytes wide. Positions are in position-units (pu), percentages of the maximum
Control Output, times in seconds or in loops. A *body* is something that can be moved and is measured: of each axis
there are two, the machine and the model of Simulate mode, with the fields plants and encoder work on.
"""

from __future__ import annotations

import numpy as np

from emulator.engine.layout import DRIVEN_ENCODER_FIELDS, FLOAT, INT, PLANT, Fields

DEVICE_FIELDS: Fields = (
    ("axis_count", INT, "axes"),
    ("loop_ns", INT, "loop time, ns"),
    ("loop_s", FLOAT, "loop time, s"),
    ("loops_per_s", FLOAT, "its inverse, 1/s"),
    ("next_loop_ns", INT, "time of the next loop, ns"),
    ("watch_mask", INT, "status bits of any axis that end a run when they change; 0 = none"),
)

AXIS_FIELDS: Fields = (
    # state
    ("mode", INT, "Current Control Mode, code of `ControlMode`"),
    ("next_mode", INT, "Next Pos/Vel Control Mode, code of `ControlMode`"),
    ("enabled", INT, "1 = motion commands are accepted"),
    ("enable_output", INT, "1 = the Enable Output is on"),
    ("halted", INT, "1 = a halt happened"),
    ("external_halt", INT, "1 = an External Halt happened"),
    ("halt_group", INT, "halts spread to axes of the same group; 0 = none"),
    ("halt_wanted", INT, "level of the halt that another axis or the controller asks for; 0 = none"),
    ("closed_loop_halt_decel", FLOAT, "Closed Loop Halt Deceleration, pu/s2"),
    ("open_loop_halt_ramp", FLOAT, "Open Loop Halt Ramp, V/s"),
    # feedback
    ("simulated", INT, "1 = the model is the feedback and the pins stay at 0 V"),
    ("model_held", INT, "1 = the model is suspended while its parameters are written"),
    ("position_scale", FLOAT, "pu per count"),
    ("position_offset", FLOAT, "pu"),
    ("half_count", FLOAT, "half a count, pu"),
    ("lowest_count", INT, "count below which the transducer overflows"),
    ("highest_count", INT, "count above which it does"),
    ("wired_inputs", INT, "bits of the fault and limit inputs that are wired to be active"),
    ("positive_switch", FLOAT, "place of the load from which the positive limit switch is operated, its units"),
    ("negative_switch", FLOAT, "place up to which the negative one is"),
    ("inputs", INT, "bits of the fault and limit inputs in this loop, the same in status and errors"),
    ("raw_counts", INT, "counts of the transducer"),
    ("actual_position", FLOAT, "pu"),
    ("actual_velocity", FLOAT, "first difference of the position, pu/s"),
    ("actual_acceleration", FLOAT, "second difference, pu/s2"),
    ("actual_jerk", FLOAT, "third difference, pu/s3"),
    ("law_velocity", FLOAT, "velocity as the law sees it: filtered only under Low-Pass, pu/s"),
    ("law_acceleration", FLOAT, "acceleration as the law sees it, pu/s2"),
    ("previous_law_acceleration", FLOAT, "the same one loop earlier, pu/s2"),
    ("shown_position", FLOAT, "Actual Position behind its filter, pu"),
    ("shown_velocity", FLOAT, "Actual Velocity behind its filter, pu/s"),
    ("shown_acceleration", FLOAT, "Actual Acceleration behind its filter, pu/s2"),
    ("low_pass_velocity", INT, "1 = the filtered velocity goes into the law"),
    ("low_pass_acceleration", INT, "1 = the filtered acceleration goes into the law"),
    ("previous_position", FLOAT, "Actual Position one loop earlier, pu"),
    ("previous_velocity", FLOAT, "law velocity one loop earlier, pu/s"),
    ("previous_jerk", FLOAT, "law jerk one loop earlier, pu/s3"),
    ("law_jerk", FLOAT, "jerk as the law sees it, pu/s3"),
    # target
    ("target_position", FLOAT, "pu"),
    ("target_velocity", FLOAT, "pu/s"),
    ("target_acceleration", FLOAT, "pu/s2"),
    ("target_jerk", FLOAT, "pu/s3"),
    ("command_position", FLOAT, "pu"),
    ("command_velocity", FLOAT, "pu/s"),
    ("command_follows", INT, "1 = Command Position is the target, 2 = Command Velocity is, 3 = both"),
    ("position_error", FLOAT, "pu"),
    ("velocity_error", FLOAT, "pu/s"),
    ("generator", INT, "what makes the target, code of `target`"),
    ("generator_loops", INT, "loops since it began"),
    ("ramp_first", INT, "row of its first ramp"),
    ("ramp_count", INT, "ramps of the plan"),
    ("ramp_index", INT, "ramp in force, 0 = first"),
    ("plan_start", FLOAT, "position at which the plan began, pu"),
    ("plan_end", FLOAT, "position at which it ends, pu"),
    ("moves_to_position", INT, "1 = the command ends at Command Position, so In Position may be set"),
    ("s_curve", INT, "1 = ramps are S-curves (Requested Jerk is not 0)"),
    ("target_state", INT, "phase code: bit 0 A, bit 1 B"),
    ("target_done", INT, "1 = the target generator has finished"),
    ("jump", INT, "1 = the target has jumped to the command (I-PD moves)"),
    ("speed_limit", FLOAT, "greatest speed of an I-PD move, pu/s; 0 = none"),
    # what the target follows
    ("master_word", INT, "word of the axes' records that is the master; -1 = a variable"),
    ("master_variable", INT, "which variable"),
    ("master", FLOAT, "master's value this loop"),
    ("previous_master", FLOAT, "one loop earlier"),
    ("gear_ratio", FLOAT, "ratio asked for"),
    ("gear_from_ratio", FLOAT, "ratio when the clutch began to close"),
    ("gear_clutch_s", FLOAT, "time of the clutch, s"),
    ("gear_accel", FLOAT, "acceleration of the clutch, pu/s2"),
    ("gear_locked", INT, "1 = locked"),
    ("gear_master_at", FLOAT, "master at the lock, or at the map's or the clutch's beginning"),
    ("gear_slave_at", FLOAT, "target there, pu"),
    ("gear_master_to", FLOAT, "master at the map's or the clutch's end"),
    ("gear_slave_to", FLOAT, "target there, pu"),
    ("gear_end_point", INT, "beyond the map's ends: 0 fault, 1 truncate, 2 extrapolate"),
    ("track_velocity", FLOAT, "Track Position: velocity limit, pu/s"),
    ("track_acceleration", FLOAT, "acceleration limit, pu/s2"),
    ("track_jerk", FLOAT, "jerk limit, pu/s3"),
    ("track_deadband", FLOAT, "the master may move this much unfollowed, pu"),
    ("track_goal", FLOAT, "what the target goes for, pu"),
    # open loop
    ("open_loop_v", FLOAT, "output of open loop before the bias, V"),
    ("open_loop_goal_v", FLOAT, "where its ramp ends, V"),
    ("open_loop_ramp", FLOAT, "its rate, V/s"),
    ("open_loop_start_v", FLOAT, "where a ramp over distance began, V"),
    ("open_loop_from", FLOAT, "position at which it began, pu"),
    ("open_loop_span", FLOAT, "way over which it goes, signed, pu"),
    ("off_when_done", INT, "1 = the Enable Output goes off when the ramp has ended"),
    ("quick_decel", FLOAT, "quick move: deceleration of the closed-loop part, pu/s2"),
    # law
    ("symmetrical", INT, "1 = one velocity feed forward for both directions, no ratio"),
    ("integrator_mode", INT, "0 always held, 1 always active, 2 always zero"),
    ("high_order", INT, "0 none, 1 acceleration control, 2 active damping"),
    ("proportional", FLOAT, "%/pu or %/(pu/s)"),
    ("integral", FLOAT, "%/(pu s) or %/((pu/s) s)"),
    ("differential", FLOAT, "%/(pu/s) or %/(pu/s2)"),
    ("velocity_ff_positive", FLOAT, "%/(pu/s)"),
    ("velocity_ff_negative", FLOAT, "%/(pu/s)"),
    ("acceleration_ff", FLOAT, "%/(pu/s2)"),
    ("jerk_ff", FLOAT, "%/(pu/s3)"),
    ("double_differential", FLOAT, "or active damping, %/(pu/s2), %/(pu/s3)"),
    ("triple_differential", FLOAT, "%/(pu/s3)"),
    ("term_p", FLOAT, "proportional term, %"),
    ("term_i", FLOAT, "integral term: the integrator's state; in I-PD this loop's increment, %"),
    ("term_d", FLOAT, "differential term, %"),
    ("term_vff", FLOAT, "velocity feed forward, %"),
    ("term_aff", FLOAT, "acceleration feed forward, %"),
    ("term_jff", FLOAT, "jerk feed forward, %"),
    ("term_double", FLOAT, "double differential, or active damping, %"),
    ("term_triple", FLOAT, "triple differential, %"),
    ("accumulated", FLOAT, "I-PD: the accumulated output before the ratio, %"),
    ("gain_ratio", FLOAT, "ratio of the gains in this direction"),
    ("pfid", FLOAT, "PFID Output, %"),
    ("captured_pfid", FLOAT, "PFID Output last seen at constant velocity, %"),
    ("captured_velocity", FLOAT, "Target Velocity at the same loop, pu/s; 0 = none"),
    # output
    ("output_scale", FLOAT, "V per 100 %"),
    ("output_deadband", FLOAT, "V"),
    ("deadband_tolerance", FLOAT, "pu"),
    ("output_limit", FLOAT, "V"),
    ("output_bias", FLOAT, "V"),
    ("invert_output", INT, "1 = the pins have the opposite sign"),
    ("saturated", INT, "sign in which the output is beyond its limit, 0 = it is not"),
    ("control_v", FLOAT, "Control Output, V"),
    ("pins_v", FLOAT, "voltage at the pins, V"),
    # watched
    ("in_position_tolerance", FLOAT, "pu"),
    ("position_error_tolerance", FLOAT, "pu"),
    ("at_velocity_tolerance", FLOAT, "pu/s"),
    ("velocity_error_tolerance", FLOAT, "pu/s"),
    ("stop_threshold", FLOAT, "pu/s"),
    ("positive_travel_limit", FLOAT, "pu"),
    ("negative_travel_limit", FLOAT, "pu; both equal = none"),
    ("live_errors", INT, "error bits whose cause is there"),
    ("errors", INT, "Error Bits: latched"),
    ("seen_errors", INT, "Error Bits whose rise has been dealt with"),
    ("external_mask", INT, "error bits with the AutoStop External Halt"),
    ("closed_loop_mask", INT, "with Closed Loop Halt"),
    ("open_loop_mask", INT, "with Open Loop Halt"),
    ("direct_output_mask", INT, "with Direct Output Halt"),
    ("lost_loops", INT, "loops without transducer, 3 at most, counted down again by good ones"),
    ("status", INT, "Status Bits as of the last return of the kernel, bit 31 excepted"),
    ("watched_status", INT, "the watched bits when last reported"),
)

BODY_FIELDS: Fields = (
    ("enabled", INT, "1 = drive on"),
    ("counts_per_rev", FLOAT, "counts per revolution or per unit of travel"),
    ("encoder_phase", FLOAT, "position of the count edges, in counts"),
    ("encoder_easy_step", FLOAT, "largest step since the last loop that is simply counted, counts; below 0 = none"),
    ("encoder_on_load", INT, "1 = it sits on the load"),
    ("encoder_noise", FLOAT, "noise of its position, counts rms"),
    ("noise_state", INT, "state of the noise's random sequence"),
    ("encoder_step_limit", FLOAT, "most counts the input can take in a loop"),
    ("encoder_credit", FLOAT, "fraction of a count the input could still have taken"),
    ("encoder_sign", INT, "+1, -1 or 0: how it is wired"),
    ("encoder_counts", INT, "counts taken since the start"),
    ("encoder_reading", INT, "counts of the encoder itself"),
    ("true_position", FLOAT, "of motor or piston, rev or units"),
    ("true_velocity", FLOAT, "rev/s or units/s"),
    ("load_apart", INT, "1 = the load can stand elsewhere than the shaft"),
    ("half_backlash", FLOAT, "half the play, rev"),
    ("load_position", FLOAT, "of a load that is apart, rev"),
    ("lagged_command", FLOAT, "speed command behind the drive's input lag, rev/s"),
    ("twist", FLOAT, "motor ahead of the load's inertia, rev"),
    ("load_velocity", FLOAT, "of the load's inertia, rev/s"),
    ("spool", FLOAT, "position of a valve's spool, V"),
    ("spool_rate", FLOAT, "its velocity over the valve's natural frequency, V"),
    *DRIVEN_ENCODER_FIELDS,
)

RAMP_FIELDS: Fields = (
    ("start_s", FLOAT, "start within the plan, s"),
    ("duration_s", FLOAT, "duration, s"),
    ("position", FLOAT, "position at the start, from the beginning of the plan, pu"),
    ("velocity", FLOAT, "velocity at the start, pu/s"),
    ("change", FLOAT, "change of velocity, pu/s"),
    ("shape", INT, "0 linear, 1 S-curve, 2 polynomial"),
    ("half_acceleration", FLOAT, "polynomial: coefficient of t2"),
    ("c3", FLOAT, "polynomial: coefficient of t3"),
    ("c4", FLOAT, "polynomial: coefficient of t4"),
    ("c5", FLOAT, "polynomial: coefficient of t5"),
)

FILTER_FIELDS: Fields = (
    ("on", INT, "1 = it filters, 0 = the value goes through"),
    ("b0", FLOAT, "numerator; b1 is twice it, b2 the same"),
    ("a1", FLOAT, "denominator"),
    ("a2", FLOAT, "denominator"),
    ("z1", FLOAT, "state"),
    ("z2", FLOAT, "state"),
)


def _dtype(fields: Fields) -> np.dtype:
    return np.dtype([(name, kind) for name, kind, _ in fields], align=True)


DEVICE = _dtype(DEVICE_FIELDS)
AXIS = _dtype(AXIS_FIELDS)
BODY = _dtype(BODY_FIELDS)
RAMP = _dtype(RAMP_FIELDS)
FILTER = _dtype(FILTER_FIELDS)

RECORDS = (DEVICE, AXIS, BODY, PLANT, RAMP, FILTER)

RAMPS_PER_AXIS = 8
SECTIONS = 2
"""Second-order sections of a filter of fourth order."""
FILTERS_PER_AXIS = 3 * SECTIONS
"""Position, velocity, acceleration."""
BODIES_PER_AXIS = 2
MACHINE, MODEL = 0, 1

"""The records the servo kernel works on: every variable of a unit's servo, one documented line each.

All fields are 8 bytes wide, 64-bit integers or floats, so that Python can read any of them through a memory view as
a plain number (`word_of`) at a fraction of the cost of a numpy scalar, and so that two units are in the same state
exactly when their bytes are equal.

Positions called *raw* count from power-up and know nothing of `PSET`; reported = raw - `offset_counts`.
"""

from __future__ import annotations

from functools import cache

import numpy as np

INT = np.dtype(np.int64)
FLOAT = np.dtype(np.float64)

Fields = tuple[tuple[str, np.dtype, str], ...]

UNIT_FIELDS: Fields = (
    ("time_ns", INT, "virtual time the unit has reached, ns"),
    ("next_sample_ns", INT, "time of the next servo sample, ns"),
    ("servo_ns", INT, "servo sample period, ns"),
    ("servo_s", FLOAT, "servo sample period, s"),
    ("servo_hz", FLOAT, "servo samples per second"),
    ("system_hz", FLOAT, "system updates per second"),
    ("samples_per_trajectory", INT, "servo samples in a trajectory update"),
    ("trajectories_per_system", INT, "trajectory updates in a system update"),
    ("samples_to_trajectory", INT, "samples up to and including the one of the next trajectory update"),
    ("trajectories_to_system", INT, "trajectory updates up to and including the one of the next system update"),
    ("axis_count", INT, "axes in the unit"),
    ("segment_capacity", INT, "rows of the segment table kept for each axis"),
    ("dac_step_v", FLOAT, "one step of the output converter, V"),
    ("dac_steps_per_volt", FLOAT, "converter steps per volt"),
    ("dac_lowest_code", FLOAT, "most negative converter code"),
    ("dac_highest_code", FLOAT, "most positive converter code"),
    ("drive_off_to_zero", INT, "1 = the output of a drive that is off is 0 V, 0 = it is SOFFS"),
    ("wires", INT, "electrical state of limits, homes, drive faults and ENABLE, one bit each, 1 = grounded"),
    ("reported_wires", INT, "state of `wires` at the last WIRES event"),
    ("inputs", INT, "electrical state of the programmable inputs, bit 0 = input 1, 1 = grounded"),
    ("reported_inputs", INT, "state of `inputs` at the last WIRES event"),
    ("outputs", INT, "programmable outputs that are on, bit 0 = output 1, as the controller last set them"),
    ("armed_watches", INT, "value watches still armed"),
    ("fired_watches", INT, "value watches that have fired, bit = slot, since Python last asked"),
    ("trigger_work", INT, "why samples are looked between, bits of `trigger_capture`; 0 = no reason"),
    ("slaves", INT, "axes that have a master"),
    ("ratio_capacity", INT, "rows of the table of ratios kept for each axis"),
)

_FOLLOWING_FIELDS: Fields = (
    # the master, at system updates
    ("master_source", INT, "0 no master, 1 encoder, 2 ANI input, 4 commanded position (source digit of FOLMAS)"),
    ("master_index", INT, "axis the master belongs to"),
    ("master_sign", INT, "+1 or -1: sign of FOLMAS"),
    ("master_raw", INT, "what the source showed at the last system update, counts"),
    ("master_counts", INT, "master travel since it was assigned, after the sign, counts"),
    ("master_moved", INT, "master travel in the last system update period, counts"),
    ("master_decay", FLOAT, "FFILT: share of the filter's lag that is left after a system update; 0 = no filter"),
    ("master_lag", FLOAT, "master position less filtered master position, counts"),
    ("first_master_lag", FLOAT, "share of it of the filter's first stage, counts"),
    ("filter_stages", INT, "stages of the filter: 1 or 2"),
    ("previous_master_lag", FLOAT, "the same one system update earlier, counts"),
    ("prediction", INT, "FPPEN: 0 off, else the samples the master velocity is measured over, 1 or 2"),
    ("master_used", INT, "master position filtered and predicted, whole counts"),
    ("master_used_part", FLOAT, "its fraction of a count"),
    ("master_velocity", FLOAT, "change of the filtered master position over two system updates, counts/s"),
    ("cycle_length", INT, "FMCLEN, counts; 0 = endless"),
    ("cycle_counts", INT, "position in the master cycle (PMAS), counts"),
    ("cycle_number", INT, "master cycles finished since the last restart (NMCY)"),
    # the ratio profile in force
    ("first_ratio", INT, "row of the profile's first piece in the table of ratios"),
    ("ratio_count", INT, "pieces in the profile"),
    ("ratio_index", INT, "piece in force, 0 = first"),
    ("ratio_master", INT, "master position at which the profile begins, whole counts"),
    ("ratio_master_part", FLOAT, "its fraction of a count"),
    ("ratio_base", INT, "raw slave position at which the profile begins, whole counts"),
    ("ratio_direction", INT, "+1 or -1: master direction in which the profile runs"),
    ("ratio_mirrored", INT, "1 = it still runs in whichever direction the master goes from its beginning"),
    ("ratio_waiting", INT, "1 = a preset move whose beginning still goes with a master that backs up"),
    ("ratio_held", INT, "1 = a move whose beginning is a given master position"),
    ("ratio_told_index", INT, "row of the ratio profile in which the kernel tells that it is there"),
    ("ratio_phase", INT, "0 none, 1 held, 2 waits for the master, 3 ratio changes, 4 constant ratio, 5 at its end"),
    ("ratio_updates_left", INT, "of a profile at its end: system updates until the slave is there; 0 = not at its end"),
    ("ratio_now", FLOAT, "ratio at the last system update, slave counts per master count"),
    ("sum_piece", INT, "piece the exact sum belongs to"),
    ("sum_master", INT, "whole master counts from the profile's beginning that the exact sum has taken in"),
    ("sum_counts", INT, "exact slave travel after them, whole counts"),
    ("sum_part", INT, "its fraction of a count, in units of the piece's denominator"),
    # the slave
    ("slave_next", INT, "raw slave position computed at the last system update, whole counts"),
    ("slave_next_part", FLOAT, "its fraction of a count"),
    ("slave_target", INT, "raw slave position being gone to, to be reached at the next system update, whole counts"),
    ("slave_target_part", FLOAT, "its fraction of a count"),
    ("slave_from", INT, "raw slave position reached at the last system update, whole counts"),
    ("slave_from_part", FLOAT, "its fraction of a count"),
    ("slave_step", FLOAT, "way between the two in a trajectory update, counts"),
    ("slave_velocity", FLOAT, "velocity of the ratio move, counts/s"),
    ("slave_acceleration", FLOAT, "change of that velocity over the last system update, counts/s2"),
    # the phase shift
    ("shift_active", INT, "1 = a shift is under way"),
    ("shift_continuous", INT, "1 = it is, or was, an FSHFC"),
    ("shift_start_ns", INT, "time of the trajectory update at which the shift begins, ns"),
    ("shift_end_s", FLOAT, "duration of the shift, s (infinite while it goes on at constant velocity)"),
    ("shift_end_counts", FLOAT, "net shift at its end, counts"),
    ("first_shift_segment", INT, "row of the shift's first segment in the segment table"),
    ("shift_count", INT, "segments in the shift"),
    ("shift_index", INT, "segment in force, 0 = first"),
    ("shift_counts", FLOAT, "net shift, counts"),
    ("shift_velocity", FLOAT, "velocity of the shift, counts/s"),
    ("shift_acceleration", FLOAT, "acceleration of the shift, counts/s2"),
    # status
    ("following_status", INT, "FS word as of the last return of the kernel, bit n = 1 << (n - 1)"),
)


def _trigger_fields() -> Fields:
    """What happens between two samples: `trigger_capture`. Trigger n is in the record of axis n."""
    positions = {"encoder": "encoder", "commanded": "commanded", "ani": "ANI"}
    return (
        ("trigger_mask", INT, "bit of the axis's trigger in `inputs`"),
        ("trigger_armed", INT, "1 = its active edge latches positions (INFNC-H)"),
        ("trigger_active_level", INT, "1 = grounded is active (INLVL0), 0 = open"),
        ("trigger_lockout_ns", INT, "TRGLOT, ns"),
        ("trigger_locked_until_ns", INT, "edges before this time are ignored, ns"),
        ("trigger_edge_ns", INT, "time of an edge that the next sample captures, ns; -1 = none"),
        ("captured_edge_ns", INT, "time of the last edge captured, ns; -1 = none"),
        ("captures", INT, "edges captured since power-up"),
        ("sensor_fitted", INT, "1 = a sensor at the trigger sees marks"),
        ("sensor_axis", INT, "axis the marks are on"),
        ("sensor_operated", INT, "bit of `inputs` that a mark at the sensor has changed over"),
        ("mark_at_rev", FLOAT, "true position of a mark's beginning, rev"),
        ("mark_every_rev", FLOAT, "from mark to mark, rev; 0 = one mark"),
        ("mark_width_rev", FLOAT, "width of a mark, rev"),
        ("compare_direction", INT, "which way the encoder is to come to compare_counts, +1 or -1; 0 = not waited for"),
        ("compare_counts", INT, "raw encoder position waited for, counts"),
        ("compare_passed_ns", INT, "when it was passed, ns; -1 = not yet"),
        ("before_rev", FLOAT, "true position of the shaft at the last sample, rev"),
        ("before_load_rev", FLOAT, "position of the load at the last sample, rev"),
        ("before_rev_s", FLOAT, "true velocity at the last sample, rev/s"),
        ("before_reading", INT, "encoder_reading at the last sample"),
        *((f"before_{key}_counts", INT, f"raw {name} position at the last sample") for key, name in positions.items()),
        ("before_feedback_counts", INT, "raw feedback position at the last sample"),
        *((f"own_{key}_capture", INT, f"raw {name} position, by its own trigger") for key, name in positions.items()),
        *((f"other_{key}_capture", INT, "the same by the other axis's trigger") for key in positions),
    )


DRIVEN_ENCODER_FIELDS: Fields = (
    ("encoder_driven", INT, "1 = its motion is what follows, 0 = the axis turns it"),
    ("driven_counts", FLOAT, "where it stands, without its phase, counts"),
    ("motion_start_ns", INT, "when its motion begins, ns"),
    ("motion_origin", FLOAT, "where it stood then, counts"),
    ("motion_start_velocity", FLOAT, "its velocity then, counts/s"),
    ("motion_velocity", FLOAT, "its velocity after the ramp, counts/s"),
    ("motion_ramp_s", FLOAT, "duration of the ramp, s"),
    ("motion_swing", FLOAT, "amplitude of a sine on top, counts"),
    ("motion_hz", FLOAT, "its frequency, Hz"),
    ("motion_end_s", FLOAT, "duration of the motion, s; it then rests"),
    ("motion_end_counts", FLOAT, "travel of the whole motion, counts"),
)
"""An encoder turned by something else than its motor."""

AXIS_FIELDS: Fields = (
    # drive and loop
    ("enabled", INT, "1 = drive on"),
    ("feedback_source", INT, "SFB code: 0 open loop, 1 encoder, 2 ANI"),
    ("encoder_sign", INT, "+1, -1 or 0: ENCPOL times CMDDIR times the encoder's wiring"),
    ("encoder_polarity", INT, "+1 or -1: ENCPOL"),
    ("encoder_wiring", INT, "+1 as it should be, -1 channels exchanged, 0 nothing arrives"),
    ("output_sign", INT, "+1 or -1: CMDDIR"),
    # trajectory
    ("profile_active", INT, "1 = a profile is running, or waits for its first trajectory update; 2 = Following"),
    ("profile_start_ns", INT, "time of the trajectory update at which the profile begins, ns"),
    ("profile_end_s", FLOAT, "duration of the profile, s (infinite while moving on at constant velocity)"),
    ("profile_end_counts", FLOAT, "commanded position at the end of the profile, counts from profile_origin_counts"),
    ("profile_origin_counts", INT, "raw position from which the positions of the profile's rows count, counts"),
    ("refill_index", INT, "segment of the profile in which the kernel asks for more rows"),
    ("first_segment", INT, "row of the profile's first segment in the segment table"),
    ("segment_count", INT, "segments in the profile"),
    ("segment_index", INT, "segment in force, 0 = first"),
    ("commanded_counts", INT, "raw commanded position, counts"),
    ("commanded_velocity", FLOAT, "velocity of the profile at the last trajectory update, counts/s"),
    ("commanded_acceleration", FLOAT, "acceleration of the profile at the last trajectory update, counts/s2"),
    # feedback
    ("counts_per_rev", FLOAT, "encoder counts (post-quadrature) per revolution"),
    ("encoder_phase", FLOAT, "position of the encoder's count edges, in counts, 0 to 1"),
    ("encoder_easy_step", FLOAT, "largest step since the last sample that is simply counted, counts; below 0 = none"),
    ("encoder_on_load", INT, "1 = it sits on the load, 0 = on the motor's shaft"),
    ("encoder_noise", FLOAT, "noise of its position, counts rms"),
    ("noise_state", INT, "state of the noise's random sequence"),
    ("encoder_step_limit", FLOAT, "most counts the input can take in a servo sample"),
    ("encoder_credit", FLOAT, "fraction of a count the input could still have taken"),
    ("encoder_counts", INT, "raw encoder position, counts"),
    ("encoder_offset_counts", INT, "PSET offset of the encoder, counts"),
    ("encoder_reading", INT, "counts of the encoder itself at the last sample, before polarity"),
    ("feedback_counts", INT, "raw feedback position, counts"),
    ("previous_feedback_counts", INT, "raw feedback position one servo sample earlier, counts"),
    ("system_feedback_counts", INT, "raw feedback position at the last system update, counts"),
    ("actual_velocity", FLOAT, "feedback difference over the last system update period, counts/s"),
    ("offset_counts", INT, "PSET offset of the selected source: raw minus reported position, counts"),
    ("ani_fitted", INT, "1 = there is an ANI feedback input"),
    ("ani_rest_v", FLOAT, "voltage at the ANI input with the shaft at 0 rev, V"),
    ("ani_volts_per_rev", FLOAT, "what the sensor adds to it, V per rev"),
    ("ani_sign", INT, "+1 or -1: ANIPOL times CMDDIR"),
    ("ani_counts", INT, "converter reading of the ANI input at the last sample, counts"),
    ("ani_offset_counts", INT, "PSET offset of the ANI input, counts"),
    ("position_error_limit", INT, "SMPER, counts; 0 = not watched"),
    # control law
    ("proportional_v", FLOAT, "SGP, V per count"),
    ("integral_v", FLOAT, "SGI, V per count and second"),
    ("velocity_v", FLOAT, "SGV, V per count/s"),
    ("velocity_feedforward_v", FLOAT, "SGVF, V per count/s"),
    ("acceleration_feedforward_v", FLOAT, "SGAF, V per count/s2"),
    ("integral_limit_v", FLOAT, "SGILIM, V"),
    ("offset_v", FLOAT, "SOFFS, V"),
    ("output_limit_v", FLOAT, "DACLIM, V"),
    ("dither_v", FLOAT, "SDTAMP, V"),
    ("dither_samples", INT, "SDTFR: servo samples in half a period of the dither; 0 = none"),
    ("dither_sample", INT, "servo samples since the dither last began a period"),
    ("term_p", FLOAT, "proportional term, V"),
    ("term_i", FLOAT, "integral term: the integrator's state, V"),
    ("term_v", FLOAT, "velocity feedback term, V"),
    ("term_vf", FLOAT, "velocity feedforward term, V"),
    ("term_af", FLOAT, "acceleration feedforward term, V"),
    ("control_v", FLOAT, "control signal within +-10 V and DACLIM, before polarity and converter, V"),
    ("dac_v", FLOAT, "voltage at the analogue output, V"),
    ("previous_dac_v", FLOAT, "the same one servo sample earlier, V"),
    ("output_stuck", INT, "1 = the output stays at stuck_v whatever the law says (a fault)"),
    ("stuck_v", FLOAT, "voltage of a stuck output, V"),
    # switches along the travel, and captures
    ("switches_fitted", INT, "1 = at least one switch follows the shaft"),
    ("positive_switch_rev", FLOAT, "true position from which the positive limit switch is operated, rev"),
    ("negative_switch_rev", FLOAT, "true position up to which the negative limit switch is operated, rev"),
    ("home_from_rev", FLOAT, "true position of the home switch's negative-side edge, rev"),
    ("home_to_rev", FLOAT, "true position of the home switch's positive-side edge, rev"),
    ("operated_switches", INT, "bits of `wires` that the switches have changed over"),
    ("home_mask", INT, "bit of the home input in `wires`"),
    ("home_active_level", INT, "1 = a grounded home input is active (HOMLVL0), 0 = an open one"),
    ("index_reading", INT, "encoder reading at an index pulse"),
    ("capture_mode", INT, "what is waited for: 0 nothing, 1 home on, 2 home off, 3 index"),
    ("capture_direction", INT, "+1 or -1: which way a home edge must be crossed"),
    ("capture_origin_counts", INT, "raw feedback position when the capture was armed, counts"),
    ("home_was_active", INT, "home input at the last sample of an armed capture, 1 = active"),
    ("captured_counts", INT, "raw feedback position at the last captured edge or pulse, counts"),
    # limits
    ("hard_limit_enable", INT, "LH code: bit 0 negative end watched, bit 1 positive end watched"),
    ("positive_limit_mask", INT, "bit of the positive end-of-travel input in `wires`"),
    ("negative_limit_mask", INT, "bit of the negative end-of-travel input in `wires`"),
    ("positive_active_level", INT, "0 = an open input is the limit (LHLVL0), 1 = a grounded one"),
    ("negative_active_level", INT, "the same for the negative end"),
    ("soft_limit_enable", INT, "LS code, bits as hard_limit_enable"),
    ("positive_soft_limit", INT, "LSPOS, reported counts"),
    ("negative_soft_limit", INT, "LSNEG, reported counts"),
    # target zone
    ("target_zone_enable", INT, "STRGTE"),
    ("target_distance", FLOAT, "STRGTD, counts"),
    ("target_velocity", FLOAT, "STRGTV, counts/s"),
    ("target_timeout_ns", INT, "STRGTT, ns"),
    ("settling", INT, "after a profile: 1 = not yet in the target zone, 2 = in it, 3 = has left it again, 0 = over"),
    ("settle_start_ns", INT, "when the last profile ended, ns"),
    ("settling_ns", INT, "time from the end of a profile into the target zone (TSTLT), the last entry counting, ns"),
    # status and events
    ("latched_status", INT, "AS bits that stay until cleared: 15-18, 23, 25"),
    ("extra_status", INT, "AS bits that the controller owns, or-ed into the word"),
    ("status", INT, "AS word as of the last return of the kernel, bit n = 1 << (n - 1)"),
    ("watch_mask", INT, "AS bits being watched"),
    ("watched_status", INT, "the watched bits when armed or last reported"),
    ("following_watch_mask", INT, "FS bits being watched"),
    ("watched_following", INT, "the watched bits when armed or last reported"),
    ("pending_events", INT, "events since the last system update"),
    ("events", INT, "events reported and not yet read"),
    # plant: state
    ("true_position", FLOAT, "position of the motor's shaft or of the piston, rev"),
    ("true_velocity", FLOAT, "velocity of the same, rev/s"),
    ("load_apart", INT, "1 = the load can stand elsewhere than the shaft"),
    ("half_backlash", FLOAT, "half the play between shaft and load, rev"),
    ("load_position", FLOAT, "position of a load that is apart, behind coupling and backlash, rev"),
    ("lagged_command", FLOAT, "speed command behind the drive's input lag, rev/s"),
    ("twist", FLOAT, "motor ahead of the load's inertia on a springy shaft, rev"),
    ("load_velocity", FLOAT, "velocity of the load's inertia on a springy shaft, rev/s"),
    ("spool", FLOAT, "position of a cylinder's valve spool, V"),
    ("spool_rate", FLOAT, "its velocity over the valve's natural frequency, V"),
    *DRIVEN_ENCODER_FIELDS,
    *_FOLLOWING_FIELDS,
    *_trigger_fields(),
)


def _coupling_fields(prefix: str) -> Fields:
    """What two inertias on a springy shaft do in a step, per cause at its beginning."""
    effects = {"twist": "rev", "motor_speed": "rev/s", "load_speed": "rev/s", "travel": "rev, of the motor"}
    causes = {
        "twist": "rev of twist",
        "motor_speed": "rev/s of the motor",
        "load_speed": "rev/s of the load",
        "motor_torque": "Nm on the motor",
        "load_torque": "Nm on the load",
    }
    return tuple(
        (f"{prefix}_{effect}_per_{cause}", FLOAT, f"{effect.replace('_', ' ')}, {unit}, per {per}")
        for effect, unit in effects.items()
        for cause, per in causes.items()
    )


PLANT_FIELDS: Fields = (
    ("kind", INT, "0 velocity-mode drive, 1 torque-mode drive, 2 elastic coupling, 3 hydraulic cylinder"),
    ("period_s", FLOAT, "length of the step these coefficients are for, s; 0 = no such step"),
    # velocity-mode drive
    ("speed_per_volt", FLOAT, "speed command, rev/s per V"),
    ("speed_droop", FLOAT, "speed lost to the load torque, rev/s"),
    ("lag_decay", FLOAT, "share of the input lag's state that is left"),
    ("loop_decay", FLOAT, "share of the speed deviation that is left"),
    ("lag_to_speed", FLOAT, "speed per rev/s of input lag deviation"),
    ("loop_to_position", FLOAT, "position per rev/s of speed deviation, s"),
    ("lag_to_position", FLOAT, "position per rev/s of input lag deviation, s"),
    ("speed_step_limit", FLOAT, "largest change of speed in a step that the peak torque allows, rev/s"),
    ("coast_decay", FLOAT, "share of the speed that is left, drive shut down"),
    ("coast_to_position", FLOAT, "position per rev/s of speed, drive shut down, s"),
    # torque-mode drive, elastic coupling
    ("torque_per_volt", FLOAT, "torque of the drive at rest, Nm per V"),
    ("peak_torque", FLOAT, "largest torque of the drive, Nm"),
    ("load_torque", FLOAT, "torque against positive motion, Nm"),
    ("coulomb_torque", FLOAT, "torque of dry friction, of the load if that is apart, Nm"),
    ("speed_decay", FLOAT, "share of the speed that viscous friction leaves"),
    ("speed_to_position", FLOAT, "position per rev/s of speed, s"),
    ("torque_to_speed", FLOAT, "speed per Nm, rev/s"),
    ("torque_to_position", FLOAT, "position per Nm, rev"),
    # elastic coupling: `loose` with the motor's torque given, `held` with the drive's speed loop closed
    ("motor_coulomb_torque", FLOAT, "torque of the motor's dry friction, Nm"),
    ("speed_loop_gain", FLOAT, "torque of a velocity-mode drive per error of speed, Nm s/rev; 0 = torque mode"),
    *_coupling_fields("loose"),
    *_coupling_fields("held"),
    # hydraulic cylinder
    ("extend_gain", FLOAT, "speed outwards, units/s per V beyond the overlap"),
    ("retract_gain", FLOAT, "speed inwards, the same"),
    ("overlap", FLOAT, "travel of the spool either way before anything flows, V"),
    ("max_speed", FLOAT, "speed at the pump's full flow, units/s"),
    ("extended_stop", FLOAT, "position of the outer end stop, units"),
    ("retracted_stop", FLOAT, "position of the inner end stop, units"),
    ("spool_per_spool", FLOAT, "share of the spool's deviation that is left"),
    ("spool_per_rate", FLOAT, "the spool's deviation per rate"),
    ("rate_per_spool", FLOAT, "the spool's rate per deviation"),
    ("rate_per_rate", FLOAT, "share of the spool's rate that is left"),
    ("mean_per_spool", FLOAT, "mean deviation over the step per deviation"),
    ("mean_per_rate", FLOAT, "the same per rate"),
)

SEGMENT_FIELDS: Fields = (
    ("start_s", FLOAT, "start within the profile, s"),
    (
        "position",
        FLOAT,
        "position at the start, counts from the profile's origin; on an arc the length travelled",
    ),
    ("velocity", FLOAT, "velocity at the start, counts/s; on an arc along the path"),
    ("acceleration", FLOAT, "acceleration at the start, counts/s2; on an arc along the path"),
    ("jerk", FLOAT, "jerk, counts/s3"),
    ("radius", FLOAT, "radius of the arc, counts; 0 = the axis moves straight"),
    ("centre", FLOAT, "the arc's centre on this axis, counts from the profile's origin"),
    ("phase", FLOAT, "angle from this axis's positive direction at the beginning of the arc, rad"),
    ("curvature", FLOAT, "change of that angle, rad per count of path"),
)

RATIO_FIELDS: Fields = (
    ("kind", INT, "0 ratio on its way, 1 hold before the beginning, 2 endless, 3 end"),
    ("master", INT, "first whole master count of the piece, from the profile's beginning"),
    ("master_part", FLOAT, "beginning of the piece less that count, above -1 to 0"),
    ("slave", INT, "slave travel at that count (of a changing ratio: at its beginning), whole counts"),
    ("slave_part", INT, "its fraction of a count, in units of 1 / denominator"),
    ("base_part", INT, "the fraction of a count in the slave's position at the profile's beginning, the same units"),
    ("denominator", INT, "parts in a count"),
    ("most_master", INT, "master counts that can be added up at once"),
    ("ratio_counts", INT, "constant ratio: whole slave counts per master count, rounded down"),
    ("ratio_part", INT, "constant ratio: the rest, in units of 1 / denominator"),
    ("ratio", FLOAT, "ratio at the beginning of the piece, slave counts per master count"),
    ("slope", FLOAT, "change of the ratio per master count"),
)

WATCH_FIELDS: Fields = (
    ("armed", INT, "1 = armed"),
    ("axis_index", INT, "axis whose signal is compared"),
    ("signal", INT, "code of `events.Signal`"),
    ("relation", INT, "code of `events.Relation`"),
    ("threshold", FLOAT, "value compared with, in the signal's unit"),
)


SCOPE_FIELDS: Fields = (
    ("state", INT, "0 off or full, 1 waiting for the trigger, 2 triggered"),
    ("axis_channels", INT, "words of the axis records in a row of the ring"),
    ("unit_channels", INT, "words of the unit's record in a row of the ring"),
    ("rows", INT, "rows the ring holds"),
    ("next_word", INT, "word of the ring at which the next row begins"),
    ("rows_written", INT, "rows written since arming"),
    ("rows_to_go", INT, "rows still to be written after the trigger"),
    ("pre_trigger_rows", INT, "rows that must be in the ring before the trigger may act"),
    ("trigger_row", INT, "count of rows written before the row of the trigger"),
    ("every", INT, "servo samples in a row"),
    ("samples_to_row", INT, "samples up to and including the one of the next row"),
    ("wants_status", INT, "1 = AS words are worked out for every row"),
    ("trigger_on", INT, "1 = there is a condition, 0 = trigger at once"),
    ("trigger_unit", INT, "1 = the condition looks at the unit's record, 0 = at the axes'"),
    ("trigger_word", INT, "word the condition looks at"),
    ("trigger_minus", INT, "word subtracted from it, -1 for none"),
    ("trigger_mask", INT, "bits of the word that make it 1, else 0; 0 = the word is a number"),
    ("trigger_is_float", INT, "1 = the word is a float"),
    ("trigger_relation", INT, "code of `events.Relation`"),
    ("trigger_threshold", FLOAT, "value compared with"),
    ("trigger_held", INT, "1 = the condition held at the row before"),
)


def _dtype(fields: Fields) -> np.dtype:
    return np.dtype([(name, kind) for name, kind, _ in fields], align=True)


UNIT = _dtype(UNIT_FIELDS)
AXIS = _dtype(AXIS_FIELDS)
PLANT = _dtype(PLANT_FIELDS)
SEGMENT = _dtype(SEGMENT_FIELDS)
RATIO = _dtype(RATIO_FIELDS)
WATCH = _dtype(WATCH_FIELDS)
SCOPE = _dtype(SCOPE_FIELDS)

WORD_BYTES = 8


@cache
def places_of(record: np.dtype) -> dict[str, tuple[int, bool]]:
    """Of each field of `record`, its place in 8-byte words from the beginning, and whether it is an integer."""
    assert record.fields is not None
    return {name: (entry[1] // WORD_BYTES, entry[0] == INT) for name, entry in record.fields.items()}


def word_of(record: np.dtype, field: str) -> int:
    """Place of `field` in `record`, in 8-byte words from its beginning; KeyError for an unknown field."""
    return places_of(record)[field][0]


def description(fields: Fields) -> dict[str, str]:
    """What each field means, with its unit, by name."""
    return {name: text for name, _, text in fields}

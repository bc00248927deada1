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
    ("armed_watches", INT, "value watches still armed"),
    ("fired_watches", INT, "value watches that have fired, bit = slot, since Python last asked"),
)

AXIS_FIELDS: Fields = (
    # drive and loop
    ("enabled", INT, "1 = drive on"),
    ("feedback_source", INT, "SFB code: 0 open loop, 1 encoder"),
    ("encoder_sign", INT, "+1 or -1: ENCPOL times CMDDIR"),
    ("output_sign", INT, "+1 or -1: CMDDIR"),
    # trajectory
    ("profile_active", INT, "1 = a profile is running, or waits for its first trajectory update"),
    ("profile_start_ns", INT, "time of the trajectory update at which the profile begins, ns"),
    ("profile_end_s", FLOAT, "duration of the profile, s (infinite while moving on at constant velocity)"),
    ("profile_end_counts", FLOAT, "raw commanded position at the end of the profile, counts"),
    ("first_segment", INT, "row of the profile's first segment in the segment table"),
    ("segment_count", INT, "segments in the profile"),
    ("segment_index", INT, "segment in force, 0 = first"),
    ("commanded_counts", INT, "raw commanded position, counts"),
    ("commanded_velocity", FLOAT, "velocity of the profile at the last trajectory update, counts/s"),
    ("commanded_acceleration", FLOAT, "acceleration of the profile at the last trajectory update, counts/s2"),
    # feedback
    ("counts_per_rev", FLOAT, "encoder counts (post-quadrature) per revolution"),
    ("encoder_phase", FLOAT, "position of the encoder's count edges, in counts, 0 to 1"),
    ("encoder_reading", INT, "counts of the encoder itself at the last sample, before polarity"),
    ("feedback_counts", INT, "raw feedback position, counts"),
    ("previous_feedback_counts", INT, "raw feedback position one servo sample earlier, counts"),
    ("system_feedback_counts", INT, "raw feedback position at the last system update, counts"),
    ("actual_velocity", FLOAT, "feedback difference over the last system update period, counts/s"),
    ("offset_counts", INT, "PSET offset: raw minus reported position, counts"),
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
    ("term_p", FLOAT, "proportional term, V"),
    ("term_i", FLOAT, "integral term: the integrator's state, V"),
    ("term_v", FLOAT, "velocity feedback term, V"),
    ("term_vf", FLOAT, "velocity feedforward term, V"),
    ("term_af", FLOAT, "acceleration feedforward term, V"),
    ("control_v", FLOAT, "control signal within +-10 V and DACLIM, before polarity and converter, V"),
    ("dac_v", FLOAT, "voltage at the analogue output, V"),
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
    ("settling", INT, "1 = a profile has ended and the axis is not yet in the target zone"),
    ("settle_start_ns", INT, "when the last profile ended, ns"),
    ("settling_ns", INT, "last settling time (TSTLT), ns"),
    # status and events
    ("latched_status", INT, "AS bits that stay until cleared: 15-18, 23, 25"),
    ("extra_status", INT, "AS bits that the controller owns, or-ed into the word"),
    ("status", INT, "AS word as of the last return of the kernel, bit n = 1 << (n - 1)"),
    ("watch_mask", INT, "AS bits being watched"),
    ("watched_status", INT, "the watched bits when armed or last reported"),
    ("pending_events", INT, "events since the last system update"),
    ("events", INT, "events reported and not yet read"),
    # plant: state
    ("plant_kind", INT, "0 velocity-mode drive, 1 torque-mode drive"),
    ("true_position", FLOAT, "position of the shaft, rev"),
    ("true_velocity", FLOAT, "velocity of the shaft, rev/s"),
    ("lagged_command", FLOAT, "speed command behind the drive's input lag, rev/s"),
    # plant: coefficients of a velocity-mode drive over one servo sample
    ("speed_per_volt", FLOAT, "speed command, rev/s per V"),
    ("lag_decay", FLOAT, "share of the input lag's state that is left"),
    ("loop_decay", FLOAT, "share of the speed deviation that is left"),
    ("lag_to_speed", FLOAT, "speed per rev/s of input lag deviation"),
    ("loop_to_position", FLOAT, "position per rev/s of speed deviation, s"),
    ("lag_to_position", FLOAT, "position per rev/s of input lag deviation, s"),
    ("speed_step_limit", FLOAT, "largest change of speed in a sample that the peak torque allows, rev/s"),
    ("coast_decay", FLOAT, "share of the speed that is left, drive shut down"),
    ("coast_to_position", FLOAT, "position per rev/s of speed, drive shut down, s"),
    # plant: coefficients of a torque-mode drive over one servo sample
    ("torque_per_volt", FLOAT, "torque of the drive, Nm per V"),
    ("peak_torque", FLOAT, "largest torque of the drive, Nm"),
    ("load_torque", FLOAT, "torque against positive motion, Nm"),
    ("coulomb_torque", FLOAT, "torque of dry friction, Nm"),
    ("speed_decay", FLOAT, "share of the speed that viscous friction leaves"),
    ("speed_to_position", FLOAT, "position per rev/s of speed, s"),
    ("torque_to_speed", FLOAT, "speed per Nm, rev/s"),
    ("torque_to_position", FLOAT, "position per Nm, rev"),
)

SEGMENT_FIELDS: Fields = (
    ("start_s", FLOAT, "start within the profile, s"),
    ("position", FLOAT, "raw position at the start, counts"),
    ("velocity", FLOAT, "velocity at the start, counts/s"),
    ("acceleration", FLOAT, "acceleration at the start, counts/s2"),
    ("jerk", FLOAT, "jerk, counts/s3"),
)

WATCH_FIELDS: Fields = (
    ("armed", INT, "1 = armed"),
    ("axis_index", INT, "axis whose signal is compared"),
    ("signal", INT, "code of `events.Signal`"),
    ("relation", INT, "code of `events.Relation`"),
    ("threshold", FLOAT, "value compared with, in the signal's unit"),
)


def _dtype(fields: Fields) -> np.dtype:
    return np.dtype([(name, kind) for name, kind, _ in fields], align=True)


UNIT = _dtype(UNIT_FIELDS)
AXIS = _dtype(AXIS_FIELDS)
SEGMENT = _dtype(SEGMENT_FIELDS)
WATCH = _dtype(WATCH_FIELDS)

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

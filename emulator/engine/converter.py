"""Where numbers become wires and back: the analogue output's converter and the encoder counter.

Both only quantise. They are kept apart from the law and the plant because the shaft's true position and the position
the unit believes in are two different things, and most of what goes wrong on a real machine lies between them.
"""

from __future__ import annotations

import math

from .kernels import Record, kernel

OUTPUT_RANGE_V = 10.0
"""Range of the analogue output, +-V. Documented (6250 User Guide PDF p. 31)."""

ANI_COUNTS_PER_VOLT = 819.2
"""14 bits over +-10 V (6250 User Guide PDF p. 76 names 14 bits; the range is assumed, medium confidence)."""

ANI_HIGHEST_COUNT = 8191
ANI_LOWEST_COUNT = -8192

OPEN_LOOP = 0
ENCODER_SOURCE = 1
ANI_SOURCE = 2
"""Codes of SFB (6K configurations; the 6250's own are assumed)."""

DEFAULT_DAC_BITS = 16
"""Resolution of the output converter over the whole range. Assumed, low confidence."""


def dac_fields(bits: int) -> dict[str, float]:
    """Fields of the unit record for a converter of `bits` bits, two's complement over +-10 V."""
    if not 2 <= bits <= 32:
        raise ValueError(f"a converter of {bits} bits cannot be built")
    codes = 2**bits
    return {
        "dac_step_v": 2 * OUTPUT_RANGE_V / codes,
        "dac_steps_per_volt": codes / (2 * OUTPUT_RANGE_V),
        "dac_lowest_code": -codes / 2,
        "dac_highest_code": codes / 2 - 1,
    }


@kernel
def convert_output(unit: Record, volts: float) -> float:
    """The voltage the converter really gives for `volts`: nearest step, halves upwards."""
    code = float(math.floor(volts * unit["dac_steps_per_volt"] + 0.5))
    if code > unit["dac_highest_code"]:
        code = unit["dac_highest_code"]
    if code < unit["dac_lowest_code"]:
        code = unit["dac_lowest_code"]
    return float(code * unit["dac_step_v"])


@kernel
def read_encoder(axis: Record) -> None:
    """Take the encoder's counts since the last sample into the encoder position, with the sign in force."""
    reading = math.floor(axis["true_position"] * axis["counts_per_rev"] + axis["encoder_phase"])
    axis["encoder_counts"] += axis["encoder_sign"] * (reading - axis["encoder_reading"])
    axis["encoder_reading"] = reading


@kernel
def read_ani(axis: Record) -> None:
    """Take a reading of the ANI feedback input's converter: whole counts of the voltage, held at the range's ends."""
    volts = axis["ani_rest_v"] + axis["ani_volts_per_rev"] * axis["true_position"]
    reading = math.floor(volts * ANI_COUNTS_PER_VOLT)
    if reading > ANI_HIGHEST_COUNT:
        reading = ANI_HIGHEST_COUNT
    if reading < ANI_LOWEST_COUNT:
        reading = ANI_LOWEST_COUNT
    axis["ani_counts"] = reading


@kernel
def take_feedback(axis: Record) -> None:
    """Read the sensors; the selected one is the feedback position. In open loop that is the encoder (assumed)."""
    axis["previous_feedback_counts"] = axis["feedback_counts"]
    read_encoder(axis)
    if axis["ani_fitted"] != 0:
        read_ani(axis)
    axis["feedback_counts"] = axis["ani_counts"] if axis["feedback_source"] == ANI_SOURCE else axis["encoder_counts"]

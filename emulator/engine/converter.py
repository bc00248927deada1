"""Where numbers become wires: the analogue output's converter, which only quantises."""

from __future__ import annotations

import numpy as np

from .kernels import Record, kernel, seldom

OUTPUT_RANGE_V = 10.0
"""Range of the analogue output, +-V. Documented (6250 User Guide PDF p. 31)."""

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


@seldom
def nearest_code(unit: Record, code: float) -> float:
    """The end of the converter's range that is nearest to a code outside of it."""
    return float(unit["dac_highest_code"] if code > unit["dac_highest_code"] else unit["dac_lowest_code"])


@kernel
def convert_output(unit: Record, volts: float) -> float:
    """The voltage the converter really gives for `volts`: nearest step, halves upwards."""
    # A floor that stays a float: the way through an integer would hold up the whole sample.
    code = np.floor(volts * unit["dac_steps_per_volt"] + 0.5)
    if code > unit["dac_highest_code"] or code < unit["dac_lowest_code"]:
        code = nearest_code(unit, code)
    return float(code * unit["dac_step_v"])

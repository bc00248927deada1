"""The low-pass filters of the actual values: Butterworth, fourth order, two sections (M924-M928)."""

from __future__ import annotations

import math

from emulator.engine.kernels import Record, Records

from .kernels import kernel
from .layout import SECTIONS

LOWEST_HZ = 0.01
"""Cut-off frequencies up to this turn a filter off."""
HIGHEST_SHARE = 0.45
"""Cut-off frequencies are held to this share of the loop frequency (design choice: a filter needs room below half)."""
ORDER = 4


def sections(cutoff_hz: float, loop_s: float) -> list[dict[str, float]]:
    """Fields of the two sections' records; both off for a cut-off of `LOWEST_HZ` and less."""
    if cutoff_hz <= LOWEST_HZ:
        return [{"on": 0, "z1": 0.0, "z2": 0.0}] * SECTIONS
    warped = math.tan(math.pi * min(cutoff_hz * loop_s, HIGHEST_SHARE))
    return [_section(warped, number) for number in range(SECTIONS)]


def _section(warped: float, number: int) -> dict[str, float]:
    damping = 2.0 * math.sin(math.pi * (2 * number + 1) / (2 * ORDER))
    scale = 1.0 / (1.0 + damping * warped + warped * warped)
    return {
        "on": 1,
        "b0": warped * warped * scale,
        "a1": 2.0 * (warped * warped - 1.0) * scale,
        "a2": (1.0 - damping * warped + warped * warped) * scale,
    }


@kernel
def section(record: Record, value: float) -> float:
    """One section, in transposed direct form."""
    part = record["b0"] * value
    result = part + record["z1"]
    record["z1"] = 2.0 * part - record["a1"] * result + record["z2"]
    record["z2"] = part - record["a2"] * result
    return float(result)


@kernel
def low_pass(filters: Records, first: int, value: float) -> float:
    """The value behind both sections; the value itself where the filter is off."""
    if filters[first]["on"] == 0:
        return value
    return section(filters[first + 1], section(filters[first], value))

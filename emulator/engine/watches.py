"""Value watches: a comparison of one signal with a threshold, tested at every system update, told once.

They exist so that waiting on a position or a velocity costs nothing: the kernel runs on until the condition holds,
instead of stopping at every system update for Python to look.
"""

from __future__ import annotations

from .encoder import ANI_COUNTS_PER_VOLT
from .events import EVENT_VALUE
from .kernels import Record, Records, kernel, seldom

WATCH_SLOTS = 8


@kernel
def ani_value(axis: Record, signal: int) -> float:
    """Value of a signal of the ANI feedback input."""
    if signal == 7:
        return float(axis["ani_sign"] * axis["ani_counts"]) / ANI_COUNTS_PER_VOLT
    return float(axis["ani_counts"] - axis["ani_offset_counts"])


@seldom
def following_value(axis: Record, signal: int) -> float:
    """Value of a signal of Following."""
    if signal == 9:
        return float(axis["cycle_counts"])
    if signal == 10:
        return float(axis["cycle_number"])
    if signal == 11:
        return float(axis["master_velocity"])
    if signal == 12:
        return float(axis["commanded_counts"] - axis["offset_counts"])
    if signal == 13:
        return float(axis["shift_counts"])
    return float(axis["master_counts"])


@kernel
def signal_value(axis: Record, signal: int) -> float:
    """Value of a signal, codes of `events.Signal`; positions in reported counts."""
    if signal == 0:
        return float(axis["commanded_counts"] - axis["offset_counts"])
    if signal == 1:
        return float(axis["encoder_counts"] - axis["encoder_offset_counts"])
    if signal == 2:
        return float(axis["feedback_counts"] - axis["offset_counts"])
    if signal == 3:
        return float(axis["commanded_counts"] - axis["feedback_counts"])
    if signal == 4:
        return float(axis["commanded_velocity"])
    if signal == 5:
        return float(axis["actual_velocity"])
    if signal == 6:
        return float(axis["dac_v"])
    return ani_value(axis, signal) if signal < 9 else following_value(axis, signal)


@kernel
def holds(value: float, relation: int, threshold: float) -> bool:
    """Whether `value relation threshold` is true, codes of `events.Relation`."""
    if relation == 0:
        return value == threshold
    if relation == 1:
        return value != threshold
    if relation == 2:
        return value < threshold
    if relation == 3:
        return value > threshold
    if relation == 4:
        return value <= threshold
    return value >= threshold


@seldom
def check_watches(unit: Record, axes: Records, watches: Records) -> None:
    """Test every armed watch and disarm those that hold."""
    for slot in range(WATCH_SLOTS):
        watch = watches[slot]
        if watch["armed"] == 0:
            continue
        axis = axes[watch["axis_index"]]
        if holds(signal_value(axis, watch["signal"]), watch["relation"], watch["threshold"]):
            watch["armed"] = 0
            unit["armed_watches"] -= 1
            unit["fired_watches"] |= 1 << slot
            axis["pending_events"] |= EVENT_VALUE

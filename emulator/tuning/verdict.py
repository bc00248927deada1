"""One word for a step response, as the guides use them.

Documented are critically damped (the best trade-off), oscillatory (sustained oscillation of equal amplitude) and
chattering (high frequency, low amplitude) (Aries User Guide p. 82, OEM6250 Installation Guide p. 44); that unstable
is what runs
away, over-damped what is sluggish and under-damped what overshoots and then settles is assumed. No page gives numbers:
the thresholds below are choices of this emulator. Overshoot is taken here beyond where the axis comes to rest as well,
so that a load that holds it short of the setpoint does not hide it.
"""

from __future__ import annotations

import math
from enum import StrEnum

from emulator.tuning.measures import StepMeasures


class Verdict(StrEnum):
    """What a step response is called."""

    OVER_DAMPED = "over-damped"
    WELL_DAMPED = "well damped"
    SLIGHTLY_UNDER_DAMPED = "slightly under-damped"
    UNDER_DAMPED = "under-damped"
    OSCILLATORY = "oscillatory"
    CHATTERING = "chattering"
    UNSTABLE = "unstable"


CHATTER_RIPPLE_V = 0.1
"""Output peak-to-peak at rest above which the axis chatters, V: half way between what the guide's scenario is taken
to show where it chatters (above 0.15 V) and where the chatter is gone (below 0.05 V)."""

CHATTER_SWING_COUNTS = 4.0
"""Actual position peak-to-peak at rest up to which a restless axis chatters rather than oscillates, counts: chatter is
the encoder's last count or two, each way."""

UNSTABLE_RIPPLE_V = 10.0
"""Output peak-to-peak at rest from which on a response counts as run away: half of what the output can do at all."""

NO_OVERSHOOT_PERCENT = 1.0
"""Overshoot up to which there is none: one count of the guide's step of 100."""

WELL_DAMPED_PERCENT = 3.0
"""Overshoot up to which a response is well damped."""

SLIGHT_OVERSHOOT_PERCENT = 15.0
"""Overshoot up to which a response is *slightly* under-damped."""

SLUGGISH_RATIO = 2.5
"""Time to 90 % over time to half, above which a response without overshoot is sluggish. A critically damped
second-order response has 2.32, a first-order one 3.32."""


def verdict(measures: StepMeasures, *, step_counts: float, tripped: bool = False) -> Verdict:
    """The word for a response to a step of `step_counts`; `tripped`: its position error exceeded SMPER."""
    swing = oscillation_counts(measures)
    beyond = beyond_percent(measures)
    if tripped or measures.ripple_v >= UNSTABLE_RIPPLE_V or swing >= abs(step_counts):
        return Verdict.UNSTABLE
    if swing > CHATTER_SWING_COUNTS:
        return Verdict.OSCILLATORY
    if measures.ripple_v > CHATTER_RIPPLE_V:
        return Verdict.CHATTERING
    if beyond > SLIGHT_OVERSHOOT_PERCENT:
        return Verdict.UNDER_DAMPED
    if beyond > WELL_DAMPED_PERCENT:
        return Verdict.SLIGHTLY_UNDER_DAMPED
    if measures.overshoot_percent <= NO_OVERSHOOT_PERCENT and _sluggish(measures):
        return Verdict.OVER_DAMPED
    return Verdict.WELL_DAMPED


def oscillation_counts(measures: StepMeasures) -> float:
    """Peak-to-peak of the actual position at rest without what a steady creep (an integrator still at work) adds."""
    return max(measures.resting_swing_counts - 2.0 * abs(measures.resting_drift_counts), 0.0)


def beyond_percent(measures: StepMeasures) -> float:
    """Overshoot beyond the setpoint or beyond where the axis rests, whichever is more, percent of the step: a load may
    hold it short of the setpoint, friction may hold it beyond."""
    return max(measures.overshoot_percent, measures.overswing_percent)


def _sluggish(measures: StepMeasures) -> bool:
    return math.isinf(measures.time_to_90_s) or measures.time_to_90_s > SLUGGISH_RATIO * measures.time_to_half_s


def milliseconds(seconds: float) -> str:
    """A time as tables show it, ms; what never happened is `never`."""
    return f"{seconds * 1e3:.1f}" if seconds < float("inf") else "never"

"""One GOBUF segment of a slave: what it becomes over master travel when it is entered at a given ratio.

A continuous segment is one ramp of the ratio over FOLMD.  A preset segment covers D slave counts over FOLMD; with
FOLRNF0 it is an ordinary preset Following move from ratio 0 to ratio 0, without it it ends at FOLRN/FOLRD (6000 PG
p.166).  Then the ramp comes first and the new ratio after it, or the old ratio first where the slave's distance is
nearer to that (inferred): the mean ratio D/FOLMD must lie between the two (knowledge base, "Master Slave Distance
Mismatch").
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from emulator.controller.compiled.blending import CannotBlend
from emulator.engine.ratio_profile import DistanceMismatch, RatioSegment, plan_ratio_preset

ZERO = Fraction(0)


@dataclass(frozen=True, slots=True)
class RatioMove:
    """The values of one GOBUF of a slave, frozen: slave distance of a preset segment (None = continuous), the ratio
    signed by its direction, and FOLMD."""

    distance: Fraction | None
    ratio: Fraction
    master_distance: int
    ends_at_rest: bool = False


class RatioBlended(NamedTuple):
    """A segment planned: its pieces and the ratio at its end."""

    segments: tuple[RatioSegment, ...]
    exit_ratio: Fraction


def blend_ratio(move: RatioMove, entry_ratio: Fraction) -> RatioBlended:
    """Plan a segment entered at `entry_ratio`.

    Raises CannotBlend for a reversal at a ratio, or FOLRNF0 at one; DistanceMismatch for a distance that does not fit.
    """
    if entry_ratio * move.ratio < 0:
        raise CannotBlend("the direction changes at a ratio that is not zero")
    if move.distance is None:
        ramp = RatioSegment(Fraction(move.master_distance), entry_ratio, move.ratio)
        return RatioBlended(_without_nothing(ramp), move.ratio)
    if not move.ends_at_rest:
        return RatioBlended(_between(move, entry_ratio), move.ratio)
    if entry_ratio:
        raise CannotBlend("FOLRNF0 needs a segment that starts at ratio 0")
    return RatioBlended(plan_ratio_preset(_whole(move.distance), move.master_distance, abs(move.ratio)), ZERO)


def _whole(distance: Fraction) -> int:
    return distance.numerator // distance.denominator


def _between(move: RatioMove, entry: Fraction) -> tuple[RatioSegment, ...]:
    """`entry` to `move.ratio` with a mean of D/FOLMD: a ramp, and constant ratio before or after it."""
    assert move.distance is not None
    goal, length = move.ratio, Fraction(move.master_distance)
    lowest, highest = sorted((entry * length, goal * length))
    if not lowest <= move.distance <= highest:
        raise DistanceMismatch(f"{move.distance} slave counts over {length} do not lie between the two ratios")
    if entry == goal:
        return _without_nothing(RatioSegment(length, entry, goal))
    ramp = 2 * abs(goal * length - move.distance) / abs(goal - entry)
    if ramp <= length:
        return _without_nothing(RatioSegment(ramp, entry, goal), RatioSegment(length - ramp, goal, goal))
    ramp = 2 * abs(move.distance - entry * length) / abs(goal - entry)
    return _without_nothing(RatioSegment(length - ramp, entry, entry), RatioSegment(ramp, entry, goal))


def _without_nothing(*segments: RatioSegment) -> tuple[RatioSegment, ...]:
    return tuple(segment for segment in segments if segment.master)

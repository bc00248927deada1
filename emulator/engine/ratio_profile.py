"""The planner of Following: ratio over master travel, as a row of segments in exact rationals.

In Following a move is a function of master travel and not of time. The ratio (slave counts per master count) goes in
straight lines over master distance; its integral is where the slave belongs. Everything is a `Fraction`, so that
neither a segment's end nor a constant ratio after it is ever rounded.

Geometry of ramps: a preset move ends after `FOLMD` of master travel with the ratio up, constant, and down again in
equal ramps; a continuous one changes its ratio in one ramp over `FOLMD` (6000 Series Programmer's Guide p. 166, Gemini
Programmer's Guide p. 203; the slave's place within a ramp is inferred).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple, TypeAlias

ZERO = Fraction(0)


class RatioSegment(NamedTuple):
    """One straight piece of ratio over master travel.

    `master` is its length in master counts, None for an endless one, which has a constant ratio. The ratios are slave
    counts per master count at its two ends, signed by the direction of the slave's move.
    """

    master: Fraction | None
    start_ratio: Fraction
    end_ratio: Fraction

    @property
    def slave(self) -> Fraction:
        """Slave travel over the whole segment, counts; ValueError for an endless one."""
        if self.master is None:
            raise ValueError("an endless segment has no whole travel")
        return self.master * (self.start_ratio + self.end_ratio) / 2


RatioSegments: TypeAlias = tuple[RatioSegment, ...]


class DistanceMismatch(ValueError):
    """The slave cannot cover its distance within the master distance at the ratio allowed."""


def plan_ratio_preset(distance: int, master_distance: int, ratio: Fraction) -> RatioSegments:
    """A move of `distance` slave counts (signed) over `master_distance` master counts, `ratio` being the ceiling.

    Trapezoid, triangle where the ceiling is not reached, rectangle where only the full ratio all the way will do. A
    distance of 0 needs no segments. Raises DistanceMismatch where even that is too little.
    """
    travel = abs(distance)
    farthest = master_distance * ratio
    if travel > farthest:
        raise DistanceMismatch(f"{travel} slave counts over {master_distance} master counts need more than {ratio}")
    if travel == 0:
        return ()
    peak = min(ratio, Fraction(2 * travel, master_distance))
    ramp = master_distance - travel / peak
    signed = peak if distance > 0 else -peak
    pieces = (
        RatioSegment(ramp, ZERO, signed),
        RatioSegment(master_distance - 2 * ramp, signed, signed),
        RatioSegment(ramp, signed, ZERO),
    )
    return tuple(piece for piece in pieces if piece.master)


def plan_ratio_change(start: Fraction, goal: Fraction, master_distance: int) -> RatioSegments:
    """From ratio `start` to `goal` (signed) in one ramp over `master_distance`, then on at `goal` without end.

    A master distance of 0 is a step of the ratio (assumed). Nothing follows a ramp to 0, and no segments are left of a
    step to 0.
    """
    ramp = (RatioSegment(Fraction(master_distance), start, goal),) if master_distance and start != goal else ()
    return (*ramp, RatioSegment(None, goal, goal)) if goal else ramp


def master_travel(segments: Sequence[RatioSegment]) -> Fraction | None:
    """Master counts from the beginning to the end of all segments; None for an endless last one."""
    total = ZERO
    for segment in segments:
        if segment.master is None:
            return None
        total += segment.master
    return total


def ratio_at(segments: Sequence[RatioSegment], master: Fraction | int) -> Fraction:
    """The ratio after `master` counts of travel from the beginning, the later segment's where two meet; 0 outside."""
    place = _place(segments, Fraction(master))
    if place is None:
        return ZERO
    segment, beyond, _ = place
    return segment.start_ratio + _slope(segment) * beyond


def slave_at(segments: Sequence[RatioSegment], master: Fraction | int) -> Fraction:
    """The slave's travel after `master` counts of travel from the beginning, held before it and after the end."""
    place = _place(segments, Fraction(master))
    if place is None:
        return sum((segment.slave for segment in segments), ZERO) if master > 0 else ZERO
    segment, beyond, before = place
    return before + beyond * (segment.start_ratio + _slope(segment) * beyond / 2)


def _slope(segment: RatioSegment) -> Fraction:
    """Change of ratio per master count."""
    return (segment.end_ratio - segment.start_ratio) / segment.master if segment.master else ZERO


def _place(segments: Sequence[RatioSegment], master: Fraction) -> tuple[RatioSegment, Fraction, Fraction] | None:
    """The segment in which `master` lies, how far into it, and the slave's travel before it; None outside all."""
    slave = ZERO
    if master < 0:
        return None
    for segment in segments:
        if segment.master is None or master < segment.master:
            return segment, master, slave
        master -= segment.master
        slave += segment.slave
    return None

"""How fast a path is travelled: the profile of its length, piece by piece, in closed form.

Each stretch of a path has a velocity that is nowhere exceeded on it, and ramps of its own.  Speed rises after the
beginning of a faster stretch and falls before the beginning of a slower one, so the lower velocity holds wherever it
applies (assumed); the path begins and ends at rest and stops nowhere between.  Where a stretch is too short for its
ramps the peak is lower, and a low velocity reaches back over as many short stretches as braking needs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from emulator.engine import Segment, Segments


class Stretch(NamedTuple):
    """A part of a path: its length (counts), the velocity (counts/s) not exceeded on it, its ramps (counts/s2)."""

    length: float
    velocity: float
    acceleration: float
    deceleration: float


ROUNDING = 1e-5
"""Counts of path that are nothing: between two ramps there is no level part then."""


def plan_speed(stretches: Sequence[Stretch]) -> tuple[Segments, ...]:
    """The profile of the length travelled, from rest to rest: a row of segments for each stretch, with positions from
    the beginning of that stretch.  Velocities and ramps are above 0."""
    borders = pairwise(_border_velocities(stretches))
    return tuple(
        tuple(_trapezoid(stretch, entry, leave)) for stretch, (entry, leave) in zip(stretches, borders, strict=True)
    )


def plan_brake(
    remaining: Sequence[float], start: float, velocity: float, deceleration: float
) -> tuple[Segments, ...] | None:
    """Slow down to rest along what remains of a path, from ``start`` counts into its first stretch.

    ``remaining`` holds the lengths of the stretches, the first one whole; the result has a row of segments for each
    that is still entered.  None if the path ends before it comes to rest.
    """
    rows: list[Segments] = []
    for length in remaining:
        square = velocity * velocity - 2.0 * deceleration * (length - start)
        leave = math.sqrt(square) if square > 0.0 else 0.0
        duration_s = (velocity - leave) / deceleration
        rows.append((Segment(duration_s, start, velocity, -deceleration, 0.0),))
        if square <= 0.0:
            return tuple(rows)
        start, velocity = 0.0, leave
    return None


def _border_velocities(stretches: Sequence[Stretch]) -> list[float]:
    """Velocities at the beginning, between the stretches and at the end: as high as ramps and stretches allow."""
    borders = [0.0, *(min(one.velocity, other.velocity) for one, other in pairwise(stretches)), 0.0]
    for index, stretch in enumerate(stretches):
        borders[index + 1] = min(borders[index + 1], _reached(borders[index], stretch.acceleration, stretch.length))
    for index in reversed(range(len(stretches))):
        stretch = stretches[index]
        borders[index] = min(borders[index], _reached(borders[index + 1], stretch.deceleration, stretch.length))
    return borders


def _reached(velocity: float, acceleration: float, length: float) -> float:
    """Velocity after speeding up over a length."""
    return math.sqrt(velocity * velocity + 2.0 * acceleration * length)


def _trapezoid(stretch: Stretch, entry: float, leave: float) -> Iterator[Segment]:
    """Up, level and down again within one stretch; parts that take no time are left out."""
    length, velocity, up, down = stretch
    highest = (2.0 * up * down * length + down * entry * entry + up * leave * leave) / (up + down)
    peak = max(entry, leave, min(velocity, math.sqrt(highest)))
    rise = (peak * peak - entry * entry) / (2.0 * up)
    fall = (peak * peak - leave * leave) / (2.0 * down)
    if peak > entry:
        yield Segment((peak - entry) / up, 0.0, entry, up, 0.0)
    level = length - rise - fall
    if peak > 0.0 and level > ROUNDING:
        yield Segment(level / peak, rise, peak, 0.0, 0.0)
    if peak > leave:
        yield Segment((peak - leave) / down, rise + max(level, 0.0), peak, -down, 0.0)

"""Lines and arcs: the pieces a path is made of, in counts, and what each axis does while its length is travelled.

A path is one-dimensional in its length.  How fast that grows is planned in ``speed``; a piece turns a profile of
length into the profile of each axis, so that all axes are on the path at every trajectory update.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

from emulator.engine import Segment
from protocol.errors import (
    EXCESSIVE_PATH_RADIUS_DIFFERENCE,
    INVALID_DATA,
    PATH_RADIUS_TOO_SMALL,
    PATH_RADIUS_ZERO,
    CommandError,
)

CLOCKWISE = -1
COUNTER_CLOCKWISE = 1
"""PARCM, PARCOM and PARCP, PARCOP, seen with X to the right and Y up (inferred: only this joins the guide's two arcs
smoothly)."""

FULL_TURN = 2.0 * math.pi

Point = tuple[int, ...]
"""Whole counts, one coordinate an axis."""


class Piece(Protocol):
    """A part of a path without corner or change of curvature."""

    @property
    def start(self) -> Point:
        """Where it begins, counts."""
        ...

    @property
    def end(self) -> Point:
        """Where it ends, counts."""
        ...

    @property
    def length(self) -> float:
        """Its length, counts."""
        ...

    def coordinate(self, axis: int, length: float) -> float:
        """Where an axis is after some length of it, counts."""
        ...

    def heading(self, axis: int, length: float) -> float:
        """Velocity of an axis per velocity along the path there, -1 to 1."""
        ...

    def share(self, along: Segment, axis: int) -> Segment:
        """What an axis does while the length travelled of this piece follows ``along``."""
        ...

    def moved(self, by: Point) -> Piece:
        """The same piece elsewhere."""
        ...


@dataclass(frozen=True, slots=True)
class Line:
    """A straight piece; of no length if it ends where it begins."""

    start: Point
    end: Point

    @property
    def length(self) -> float:
        return math.dist(self.start, self.end)

    def coordinate(self, axis: int, length: float) -> float:
        return self.start[axis] + self.heading(axis, length) * length

    def heading(self, axis: int, length: float) -> float:
        whole = self.length
        return (self.end[axis] - self.start[axis]) / whole if whole else 0.0

    def share(self, along: Segment, axis: int) -> Segment:
        slope = self.heading(axis, 0.0)
        return Segment(
            along.duration_s,
            self.start[axis] + slope * along.position,
            slope * along.velocity,
            slope * along.acceleration,
            slope * along.jerk,
        )

    def moved(self, by: Point) -> Line:
        return Line(_sum(self.start, by), _sum(self.end, by))


@dataclass(frozen=True, slots=True)
class Arc:
    """Part of a circle, or all of it, in the plane of two axes; ``turn`` is CLOCKWISE or COUNTER_CLOCKWISE, ``phase``
    the angle of its beginning seen from the centre and ``sweep`` what it turns through, rad."""

    start: Point
    end: Point
    centre: tuple[float, float]
    radius: float
    phase: float
    sweep: float
    turn: int

    @property
    def length(self) -> float:
        return self.radius * self.sweep

    def coordinate(self, axis: int, length: float) -> float:
        return self.centre[axis] + self.radius * math.cos(self._angle(axis, length))

    def heading(self, axis: int, length: float) -> float:
        return -self.turn * math.sin(self._angle(axis, length))

    def _angle(self, axis: int, length: float) -> float:
        return self._phase(axis) + self.turn * length / self.radius

    def _phase(self, axis: int) -> float:
        """The Y axis lies a quarter turn ahead of the X axis."""
        return self.phase - axis * FULL_TURN / 4.0

    def share(self, along: Segment, axis: int) -> Segment:
        return along._replace(
            radius=self.radius,
            centre=self.centre[axis],
            phase=self._phase(axis),
            curvature=self.turn / self.radius,
        )

    def moved(self, by: Point) -> Arc:
        centre = (self.centre[0] + by[0], self.centre[1] + by[1])
        return replace(self, start=_sum(self.start, by), end=_sum(self.end, by), centre=centre)


def arc_by_radius(start: Point, end: Point, radius: float, turn: int, tolerance: float) -> Arc:
    """An arc through two points: of at most half a turn, or of more with a negative radius.

    A radius smaller than half the distance of the points by no more than ``tolerance`` counts as half of it.

    Raises:
        CommandError: PATH RADIUS ZERO, PATH RADIUS TOO SMALL; INVALID DATA for an arc that ends where it begins, of
            which a radius does not tell the centre (assumed).
    """
    if radius == 0.0:
        raise CommandError(PATH_RADIUS_ZERO)
    half_chord = math.dist(start, end) / 2.0
    if half_chord == 0.0:
        raise CommandError(INVALID_DATA)
    if half_chord - abs(radius) > tolerance:
        raise CommandError(PATH_RADIUS_TOO_SMALL)
    size = max(abs(radius), half_chord)
    height = math.sqrt((size - half_chord) * (size + half_chord))
    centre = _beside_chord(start, end, math.copysign(height, turn * radius))
    half_sweep = math.atan2(half_chord, height)
    sweep = 2.0 * half_sweep if radius > 0.0 else FULL_TURN - 2.0 * half_sweep
    return _arc(start, end, centre, sweep, turn)


def arc_by_centre(start: Point, end: Point, offset: tuple[float, float], turn: int, tolerance: float) -> Arc:
    """An arc about a centre given from its start; a full turn if it ends where it begins.

    Radii at start and end may differ by ``tolerance``; the centre then moves to the nearest place that is equally far
    from both points (assumed), so that the path has no gap.

    Raises:
        CommandError: PATH RADIUS ZERO, EXCESSIVE PATH RADIUS DIFFERENCE.
    """
    centre = (start[0] + offset[0], start[1] + offset[1])
    first, last = math.dist(start, centre), math.dist(end, centre)
    if first == 0.0:
        raise CommandError(PATH_RADIUS_ZERO)
    if abs(first - last) > tolerance:
        raise CommandError(EXCESSIVE_PATH_RADIUS_DIFFERENCE)
    if start == end:
        return _arc(start, end, centre, FULL_TURN, turn)
    chord = math.dist(start, end)
    height = ((end[0] - start[0]) * offset[1] - (end[1] - start[1]) * offset[0]) / chord
    centre = _beside_chord(start, end, height)
    if math.dist(start, centre) == 0.0:
        raise CommandError(PATH_RADIUS_ZERO)
    sweep = turn * (_angle_of(centre, end) - _angle_of(centre, start)) % FULL_TURN
    return _arc(start, end, centre, sweep, turn)


def _arc(start: Point, end: Point, centre: tuple[float, float], sweep: float, turn: int) -> Arc:
    return Arc(start, end, centre, math.dist(start, centre), _angle_of(centre, start), sweep, turn)


def _beside_chord(start: Point, end: Point, height: float) -> tuple[float, float]:
    """The point ``height`` to the left of the middle of a chord, looking along it."""
    chord = math.dist(start, end)
    across, up = (end[0] - start[0]) / chord, (end[1] - start[1]) / chord
    return (start[0] + end[0]) / 2.0 - height * up, (start[1] + end[1]) / 2.0 + height * across


def _angle_of(centre: tuple[float, float], point: Point) -> float:
    return math.atan2(point[1] - centre[1], point[0] - centre[0])


def _sum(point: Point, by: Point) -> Point:
    return tuple(coordinate + step for coordinate, step in zip(point, by, strict=True))

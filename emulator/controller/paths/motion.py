"""Paths under way: axes that move together along lines and arcs, started, slowed down and taken up again as one.

What is planned is the length travelled; every axis gets its share of it.  Therefore whatever stops one of the axes (S,
K, an end-of-travel limit, a fault of one drive) brings all of them to rest along the path, not beside it: S at PAD, a
kill at the lowest LHAD of the axes, soft limits at the lowest LSAD (assumed; a real unit's manual page is missing).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from emulator.controller.paths.geometry import Piece
from emulator.controller.paths.outputs import SwitchedOutputs
from emulator.controller.paths.speed import Stretch, plan_brake, plan_speed
from emulator.engine import Segment, Segments, State, plan_preset, plan_stop
from emulator.engine.profile import segment_state
from emulator.engine.rates import NS_PER_S

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

STOP = "AD"
"""The ramp a stop asks for; on a path PAD takes its place, on kills and limits the lowest of the axes' own ramps."""


class Averages(NamedTuple):
    """PAA and PADA of a linear move, counts/s2."""

    up: float
    down: float


@dataclass(frozen=True, slots=True)
class Course:
    """A path as it is to be travelled: its axes (indexes, in the order of the coordinates), its pieces in reported
    counts and how fast each may be.  Only a straight line can have S-curves (6000 PG p. 146); ``outputs`` are switched
    where a piece begins, by its index."""

    axes: tuple[int, ...]
    pieces: tuple[Piece, ...]
    stretches: tuple[Stretch, ...]
    averages: Averages | None = None
    outputs: dict[int, str] = field(default_factory=dict)

    @property
    def end(self) -> tuple[int, ...]:
        return self.pieces[-1].end


class Place(NamedTuple):
    """Where on a path: the piece, by its index, and length, speed and its change along that piece."""

    piece: int
    along: State


@dataclass(slots=True)
class PathMotion:
    """One path under way.  ``rows`` are the profiles of length of its pieces from ``first`` on; ``lost`` the axes that
    have dropped out because their drive was shut down."""

    course: Course
    first: int
    rows: tuple[Segments, ...]
    start_ns: int
    lost: set[int] = field(default_factory=set)

    def place(self, at_ns: int) -> Place:
        """Where it is to be at a time; at the end once it is over."""
        left_s = max(0, at_ns - self.start_ns) / NS_PER_S
        place = Place(self.first, State(0.0, 0.0, 0.0))
        for piece, row in enumerate(self.rows, start=self.first):
            for along in row:
                if left_s < along.duration_s:
                    return Place(piece, segment_state(along, left_s))
                left_s -= along.duration_s
                place = Place(piece, segment_state(along, along.duration_s)._replace(velocity=0.0, acceleration=0.0))
        return place

    def begins_ns(self) -> dict[int, int]:
        """When each piece that is still to be entered begins."""
        times, elapsed_s = {}, 0.0
        for piece, row in enumerate(self.rows, start=self.first):
            times[piece] = self.start_ns + round(elapsed_s * NS_PER_S)
            elapsed_s += sum(along.duration_s for along in row)
        return times

    def profile(self, axis: int) -> Segments:
        """The profile of one axis, by its place among the coordinates."""
        shares = tuple(
            self.course.pieces[piece].share(along, axis)
            for piece, row in enumerate(self.rows, start=self.first)
            for along in row
            if along.duration_s > 0.0
        )
        return (*shares, Segment(0.0, self._rest(axis), 0.0, 0.0, 0.0))

    def _rest(self, axis: int) -> float:
        """Where an axis ends: at the end of the path exactly, or where a brake has brought it to rest."""
        last, along = self.first + len(self.rows) - 1, self.rows[-1][-1]
        place = Place(last, segment_state(along, along.duration_s))
        piece = self.course.pieces[last]
        if _at_the_end(self.course, place):
            return float(piece.end[axis])
        return piece.coordinate(axis, place.along.position)


AT_THE_END = 1e-3
"""Counts of path from its end that are rounding: the end is meant."""


class Paths:
    """The paths of one unit that are under way."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._motions: list[PathMotion] = []
        self._outputs = SwitchedOutputs(controller)

    def carries(self, axis_index: int) -> bool:
        """Whether a path that is not over yet has this axis."""
        return self._of(axis_index) is not None

    def travels(self, course: Course, axis_index: int) -> bool:
        """Whether a course is under way and moves this axis."""
        motion = self._of(axis_index)
        return motion is not None and motion.course is course and self._controller.engine.is_moving(axis_index)

    def under_way(self) -> list[PathMotion]:
        """The paths that are not over."""
        moving = self._controller.engine.is_moving
        self._motions = [motion for motion in self._motions if any(map(moving, motion.course.axes))]
        return list(self._motions)

    def _of(self, axis_index: int) -> PathMotion | None:
        return next((motion for motion in self.under_way() if axis_index in motion.course.axes), None)

    # Starting.

    def start(self, course: Course) -> None:
        """Travel a path from rest, at the next trajectory update; its axes are ready and at its beginning."""
        self._begin(PathMotion(course, 0, _speeds(course, Place(0, State(0.0, 0.0, 0.0))), self._next_ns))

    def resume(self, motion: PathMotion) -> None:
        """Go on from where a path has come to rest; nothing if an axis of it has been shut down or has left that place
        meanwhile (assumed)."""
        course = motion.course
        place = motion.place(self._next_ns)
        if motion.lost or _at_the_end(course, place) or not self._is_at(course, place):
            return
        self._begin(PathMotion(course, place.piece, _speeds(course, place), self._next_ns))

    def _is_at(self, course: Course, place: Place) -> bool:
        """Whether all axes stand at a place of a path with their drives on."""
        engine, piece = self._controller.engine, course.pieces[place.piece]
        return all(
            engine.is_enabled(axis_index)
            and not engine.is_moving(axis_index)
            and abs(engine.commanded_position(axis_index) - piece.coordinate(axis, place.along.position)) <= 1.0
            for axis, axis_index in enumerate(course.axes)
        )

    @property
    def _next_ns(self) -> int:
        return self._controller.engine.next_trajectory_ns

    def _begin(self, motion: PathMotion) -> None:
        self._motions = [other for other in self.under_way() if not set(other.course.axes) & set(motion.course.axes)]
        self._motions.append(motion)
        for place, axis_index in enumerate(motion.course.axes):
            if self._controller.engine.is_enabled(axis_index) and axis_index not in motion.lost:
                self._controller.engine.start_profile(axis_index, motion.profile(place))
        self._outputs.follow(motion.course, motion.begins_ns())

    # Stopping.

    def brake(self, axis_index: int, ramp: str) -> None:
        """Bring all axes of the path that has this one to rest along it; where the path ends before, there."""
        motion = self._of(axis_index)
        if motion is None:
            return
        place = motion.place(self._next_ns)
        deceleration, average = self._deceleration(motion, ramp)
        rows = _brake_rows(motion.course, place, deceleration, average)
        if rows is not None:
            motion.first, motion.rows, motion.start_ns = place.piece, rows, self._next_ns
            self._begin(motion)

    def _deceleration(self, motion: PathMotion, ramp: str) -> tuple[float, float | None]:
        """Deceleration along the path and, for a stop of a linear move, its average; one outside the S-curve rule is
        left out, because a stop is never refused."""
        counts = self._controller.settings.counts
        if ramp != STOP:
            return min(float(counts(ramp, axis_index)) for axis_index in motion.course.axes), None
        maximum, average = float(counts("PAD")), float(counts("PADA"))
        curved = motion.course.averages is not None and maximum <= 2.0 * average <= 2.0 * maximum
        return maximum, average if curved else None

    def lose_axis(self, axis_index: int) -> None:
        """A drive has been shut down: the other axes of its path come to rest as in a kill (assumed)."""
        motion = self._of(axis_index)
        if motion is not None and axis_index not in motion.lost:
            motion.lost.add(axis_index)
            self.brake(axis_index, "LHAD")

    def reset(self) -> None:
        """Forget every path (RESET, power-down)."""
        self._motions.clear()


def _at_the_end(course: Course, place: Place) -> bool:
    """Whether nothing of a course is left but rounding."""
    left = course.stretches[place.piece].length - place.along.position
    return place.piece + 1 == len(course.pieces) and left < AT_THE_END


def _speeds(course: Course, place: Place) -> tuple[Segments, ...]:
    """Profiles of length from rest at a place to rest at the end."""
    done = place.along.position
    first, *others = course.stretches[place.piece :]
    if course.averages is not None:
        up, down = course.averages
        ramps = (first.velocity, first.acceleration, first.deceleration, up, down)
        return (plan_preset(done, 0.0, first.length, *ramps),)
    begun, *rest = plan_speed([first._replace(length=first.length - done), *others])
    return (tuple(along._replace(position=along.position + done) for along in begun), *rest)


def _brake_rows(
    course: Course, place: Place, deceleration: float, average: float | None
) -> tuple[Segments, ...] | None:
    """Profiles of length that end at rest as soon as the ramp allows; None if the path ends before."""
    start, velocity, _ = place.along
    if average is None:
        remaining = [stretch.length for stretch in course.stretches[place.piece :]]
        return plan_brake(remaining, start, velocity, deceleration)
    row = plan_stop(start, velocity, deceleration, average)
    return (row,) if row[-1].position <= course.stretches[0].length else None


def axes_at(controller: Controller, axes: Iterable[int]) -> tuple[int, ...]:
    """Where axes are commanded to be, reported counts."""
    return tuple(controller.engine.commanded_position(axis_index) for axis_index in axes)


def first_headings(pieces: Sequence[Piece], axes: int) -> list[int]:
    """The direction (+1, -1, 0) in which each axis sets out on a path: that of the first piece or, where that begins
    square to the axis, of its middle."""
    piece = pieces[0]
    return [_sign(piece.heading(axis, 0.0)) or _sign(piece.heading(axis, piece.length / 2.0)) for axis in range(axes)]


SQUARE = 1e-9
"""A heading this small is rounding: the axis does not move there."""


def _sign(heading: float) -> int:
    return 0 if abs(heading) < SQUARE else 1 if heading > 0.0 else -1

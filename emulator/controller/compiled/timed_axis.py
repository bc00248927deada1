"""GOBUF segments over time: from the settings in force to pieces of a streamed profile."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from math import inf
from typing import TYPE_CHECKING, TypeAlias

from emulator.controller.compiled.axis_builder import AxisBuilder
from emulator.controller.compiled.blending import TimedMove, blend
from emulator.controller.compiled.loops import Planned, pieces_of
from emulator.controller.compiled.marks import Held, Marks, Over
from emulator.controller.compiled.profile_axis import ProfileAxis
from emulator.controller.scaling import Quantity
from emulator.engine import Engine, Segment
from emulator.engine.rates import NS_PER_S
from emulator.engine.streaming import ENDLESS, PARTS_PER_COUNT, Stream, StreamedSegment
from protocol.errors import s_curve_acceleration, s_curve_deceleration

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings

RAMPS = ("A", "AD", "AA", "ADA")

Ramps: TypeAlias = tuple[float, float, float, float]

OUTPUTS_AHEAD = (3, 4)
"""Outputs switch at the system update before which their segment begins less than this share of a period later: from
1.5 ms before to 0.5 ms after it at a period of 2 ms (6000 PG p.160; the share is inferred)."""


@dataclass(frozen=True, slots=True)
class TimedSegment:
    """A GOBUF: its move, and what goes with its beginning."""

    move: TimedMove
    marks: Marks


@dataclass(frozen=True, slots=True)
class TimedPlanner:
    """Plans the segments of one axis; ``system_s`` is the system update period in force at PCOMP."""

    system_s: float

    def plan(self, move: TimedSegment, entry: float) -> tuple[tuple[StreamedSegment, ...], float]:
        """The pieces of a segment, marked, and the velocity at its end.  Raises CannotBlend."""
        pieces, leaving = blend(move.move, entry, system_s=self.system_s)
        if move.marks.outputs is not None:
            first, *others = pieces or (StreamedSegment(Segment(0.0, 0.0, entry, 0.0, 0.0), 0, 0),)
            pieces = (first._replace(mark=move.marks), *others)
        if move.marks.hold is not None:
            pieces = (_endless(entry, Held(move.marks.hold)), *pieces)
        return pieces, leaving

    def travel(self, pieces: tuple[StreamedSegment, ...]) -> Fraction:
        """Counts that pieces move the axis."""
        return Fraction(sum(piece.displacement for piece in pieces), PARTS_PER_COUNT)

    def lasts(self, piece: StreamedSegment) -> bool:
        """Whether a piece takes time."""
        return piece.duration != 0


def _endless(velocity: float, mark: object) -> StreamedSegment:
    return StreamedSegment(Segment(inf, 0.0, velocity, 0.0, 0.0), ENDLESS, 0, mark)


class TimedAxis(ProfileAxis):
    """An axis that moves in time, from where it is commanded to be at PCOMP (which MA1 counts with)."""

    def __init__(self, controller: Controller, axis_index: int) -> None:
        planner = TimedPlanner(controller.engine.rates.system_ns / NS_PER_S)
        position = Fraction(controller.engine.commanded_position(axis_index))
        self._timed: AxisBuilder[TimedSegment, StreamedSegment, float] = AxisBuilder(
            axis_index, planner, position=position, at_rest=0.0
        )
        self._entered: tuple[Quantity, ...] = ()
        self._ramps: Ramps = (0.0, 0.0, 0.0, 0.0)
        super().__init__(axis_index, self._timed)

    def add_segment(self, settings: Settings, marks: Marks, *, ends_at_rest: bool) -> int:
        """A segment made of A, AA, AD, ADA, V, D, MA and MC.

        Raises:
            CommandError: INVALID CONDITIONS FOR S_CURVE ...
        """
        distance, velocity = travel_and_velocity(settings, self.axis_index, self._timed.position)
        move = TimedMove(distance, velocity, *self._ramps_in_force(settings), ends_at_rest)
        self._timed.add(TimedSegment(move, marks))
        return (velocity > 0.0) - (velocity < 0.0)

    def _ramps_in_force(self, settings: Settings) -> Ramps:
        """A, AD, AA, ADA in counts/s2, worked out and checked anew only when one of them has been set."""
        entered = tuple(settings.setting(name, self.axis_index) for name in RAMPS)
        if entered != self._entered:
            up, down, average_up, average_down = (float(settings.counts(name, self.axis_index)) for name in RAMPS)
            _check_s_curves(self.axis_index + 1, up, down, average_up, average_down)
            self._entered, self._ramps = entered, (up, down, average_up, average_down)
        return self._ramps

    def profile(self) -> TimedProfile:
        """All segments."""
        return TimedProfile(self.axis_index, self.direction, tuple(self._timed.planned), self._timed.speed)


def _check_s_curves(axis: int, up: float, down: float, average_up: float, average_down: float) -> None:
    """The rule of GO, checked at PCOMP."""
    if not up <= 2.0 * average_up <= 2.0 * up:
        raise s_curve_acceleration(axis)
    if not down <= 2.0 * average_down <= 2.0 * down:
        raise s_curve_deceleration(axis)


def travel_and_velocity(settings: Settings, axis_index: int, position: Fraction) -> tuple[float | None, float]:
    """Distance (None with MC1) and signed velocity of a segment that begins at `position`, counts."""
    whole, continuous = int(settings.counts("D", axis_index)), settings.flag("MC", axis_index)
    travel = float(whole - position) if settings.flag("MA", axis_index) and not continuous else float(whole)
    velocity = float(settings.counts("V", axis_index))
    return None if continuous else travel, -velocity if travel < 0.0 else velocity


@dataclass(frozen=True, slots=True)
class TimedProfile:
    """The compiled profile of an axis that moves in time; ``exit_velocity`` is the one it runs on at, counts/s."""

    axis_index: int
    direction: int
    planned: Sequence[Planned[StreamedSegment]]
    exit_velocity: float
    follows: bool = False

    def pieces(self) -> Iterator[StreamedSegment]:
        """Every piece in turn, and the endless one it ends with if it does not end at rest."""
        running_on = (_endless(self.exit_velocity, Over()),) if self.exit_velocity else ()
        return chain(pieces_of(self.planned), running_on)

    def start(self, controller: Controller, act_at: Callable[[int, object], None]) -> TimedMotion:
        """Start it at the next trajectory update."""
        engine = controller.engine

        def on_mark(begins_ns: int, mark: object) -> None:
            ahead_ns = outputs_ahead_ns(engine.rates.system_ns) if isinstance(mark, Marks) else 0
            act_at(begins_ns - ahead_ns, mark)

        return TimedMotion(engine, self.axis_index, engine.stream_profile(self.axis_index, self.pieces(), on_mark))


def outputs_ahead_ns(system_ns: int) -> int:
    """How long before their segment outputs may switch at most, at the first system update from then on."""
    share, whole = OUTPUTS_AHEAD
    return share * system_ns // whole - 1


@dataclass(frozen=True, slots=True)
class TimedMotion:
    """A streamed profile under way."""

    engine: Engine
    axis_index: int
    stream: Stream

    def in_force(self) -> bool:
        """Whether it moves the axis."""
        return self.engine.streams(self.axis_index, self.stream)

    def resume(self) -> None:
        """Leave the endless piece it waits in."""
        self.engine.resume_stream(self.axis_index)

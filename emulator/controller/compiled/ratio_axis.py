"""GOBUF segments of a slave: from the settings in force to pieces of a streamed ratio profile."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING

from emulator.controller.compiled.axis_builder import AxisBuilder
from emulator.controller.compiled.loops import Planned, pieces_of
from emulator.controller.compiled.marks import Held, Marks, Over
from emulator.controller.compiled.profile_axis import ProfileAxis
from emulator.controller.compiled.ratio_blending import ZERO, RatioMove, blend_ratio
from emulator.controller.motion.following.ratio import master_counts, ratio_in_force
from emulator.engine import Engine
from emulator.engine.ratio_profile import RatioSegment
from emulator.engine.ratio_streaming import RatioStream, StreamedRatio

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings


@dataclass(frozen=True, slots=True)
class RatioSegmentWritten:
    """A GOBUF: its move, and what goes with its beginning."""

    move: RatioMove
    marks: Marks


class RatioPlanner:
    """Plans the segments of a slave."""

    def plan(self, move: RatioSegmentWritten, entry: Fraction) -> tuple[tuple[StreamedRatio, ...], Fraction]:
        """The pieces of a segment, marked, and the ratio at its end.  Raises CannotBlend, DistanceMismatch."""
        segments, leaving = blend_ratio(move.move, entry)
        pieces = tuple(map(StreamedRatio, segments))
        if move.marks.outputs is not None:
            first, *others = pieces or (StreamedRatio(RatioSegment(ZERO, entry, entry)),)
            pieces = (first._replace(mark=move.marks), *others)
        if move.marks.hold is not None:
            pieces = (_endless(entry, Held(move.marks.hold)), *pieces)
        return pieces, leaving

    def travel(self, pieces: tuple[StreamedRatio, ...]) -> Fraction:
        """Counts that pieces move the slave."""
        return sum((piece.segment.slave for piece in pieces if piece.segment.master is not None), ZERO)

    def lasts(self, piece: StreamedRatio) -> bool:
        """Whether a piece takes master travel."""
        return piece.segment.master is None or piece.segment.master > 0


def _endless(ratio: Fraction, mark: object) -> StreamedRatio:
    return StreamedRatio(RatioSegment(None, ratio, ratio), mark)


class RatioAxis(ProfileAxis):
    """A slave: FOLEN1 at PCOMP."""

    def __init__(self, controller: Controller, axis_index: int) -> None:
        position = Fraction(controller.engine.commanded_position(axis_index))
        self._ratios: AxisBuilder[RatioSegmentWritten, StreamedRatio, Fraction] = AxisBuilder(
            axis_index, RatioPlanner(), position=position, at_rest=ZERO
        )
        self._preset = False
        super().__init__(axis_index, self._ratios)

    def add_segment(self, settings: Settings, marks: Marks, *, ends_at_rest: bool) -> int:
        """A segment made of FOLRN, FOLRD, FOLMD, D, MA and MC."""
        move = ratio_move(settings, self.axis_index, self._ratios.position, ends_at_rest=ends_at_rest)
        self._preset = self._preset or move.distance is not None
        self._ratios.add(RatioSegmentWritten(move, marks))
        return (move.ratio > 0) - (move.ratio < 0)

    def profile(self) -> RatioProfile:
        """All segments."""
        speed = self._ratios.speed
        return RatioProfile(self.axis_index, self.direction, tuple(self._ratios.planned), speed, self._preset)


def ratio_move(settings: Settings, axis_index: int, position: Fraction, *, ends_at_rest: bool) -> RatioMove:
    """What the settings make of a segment that begins with the slave at `position`, counts.

    Raises:
        CommandError: INVALID RATIO.
    """
    ratio = ratio_in_force(settings, axis_index)
    whole, continuous = int(settings.counts("D", axis_index)), settings.flag("MC", axis_index)
    travel = whole - position if settings.flag("MA", axis_index) and not continuous else Fraction(whole)
    return RatioMove(
        distance=None if continuous else travel,
        ratio=-ratio if travel < 0 else ratio,
        master_distance=master_counts(settings, "FOLMD", axis_index),
        ends_at_rest=ends_at_rest,
    )


@dataclass(frozen=True, slots=True)
class RatioProfile:
    """The compiled profile of a slave; ``exit_ratio`` is the one it keeps at its end.

    ``preset`` says that a segment is preset: it then runs in the positive master direction only.
    """

    axis_index: int
    direction: int
    planned: Sequence[Planned[StreamedRatio]]
    exit_ratio: Fraction
    preset: bool
    follows: bool = True

    def pieces(self) -> Iterator[StreamedRatio]:
        """Every piece in turn, and the endless one it ends with if it does not end at ratio 0."""
        keeping = (_endless(self.exit_ratio, Over()),) if self.exit_ratio else ()
        return chain(pieces_of(self.planned), keeping)

    def start(self, controller: Controller, act_at: Callable[[int, object], None]) -> RatioMotion:
        """Start it where the master is.

        The slave gets to a segment two system updates after the master, and its outputs switch at the one between
        (assumed).
        """
        engine = controller.engine
        stream = engine.stream_following(self.axis_index, self.pieces(), preset=self.preset, on_mark=act_at)
        return RatioMotion(engine, self.axis_index, stream)


@dataclass(frozen=True, slots=True)
class RatioMotion:
    """A streamed ratio profile under way."""

    engine: Engine
    axis_index: int
    stream: RatioStream

    def in_force(self) -> bool:
        """Whether it moves the axis."""
        return self.engine.streams_ratio(self.axis_index, self.stream)

    def resume(self) -> None:
        """Leave the endless piece it waits in."""
        self.engine.resume_following(self.axis_index)

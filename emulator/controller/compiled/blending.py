"""One GOBUF segment in time: what it becomes when the axis enters it at a given velocity.

A preset segment covers exactly its distance: a ramp from the velocity before it to V, then V to its end, where the next
segment begins; with VF0 it ends at rest like an ordinary preset move.  Too short for V it ends as near to V as its ramp
comes (assumed).  A continuous segment is the ramp to V and nothing more.  All in counts and seconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from emulator.engine import Segment, Segments, TargetOvershot, plan_continuous, plan_preset
from emulator.engine.streaming import PARTS_PER_COUNT, TICKS_PER_S, StreamedSegment

SLOWEST_COUNTS_PER_UPDATE = 1.0
"""Counts in a system update that a segment must reach at its fastest; below, the unit cannot compile it (assumed M)."""


class CannotBlend(ValueError):
    """The segment does not fit the velocity it is entered at, or is too slow for the unit."""


@dataclass(frozen=True, slots=True)
class TimedMove:
    """The values of one GOBUF, frozen: distance of a preset segment (None = continuous), signed V, and the ramps."""

    distance: float | None
    velocity: float
    acceleration: float
    deceleration: float
    average_acceleration: float
    average_deceleration: float
    ends_at_rest: bool = False

    @property
    def ramps(self) -> tuple[float, float, float, float]:
        """A, AD, AA, ADA: the order the planner takes them in."""
        return self.acceleration, self.deceleration, self.average_acceleration, self.average_deceleration


class Blended(NamedTuple):
    """A segment planned: its pieces and the velocity at its end, counts/s, signed."""

    pieces: tuple[StreamedSegment, ...]
    exit_velocity: float


def blend(move: TimedMove, entry_velocity: float, *, system_s: float) -> Blended:
    """Plan a segment entered at `entry_velocity`; `system_s` is the system update period.

    Raises CannotBlend for a reversal while moving, for VF0 within less than the braking distance, and for what is too
    slow.
    """
    if entry_velocity * move.velocity < 0.0:
        raise CannotBlend("the direction changes at a velocity that is not zero")
    if move.distance is not None and move.velocity == 0.0:
        raise CannotBlend("a distance cannot be covered at velocity 0")
    if move.distance is None:
        return _continuous(move, entry_velocity)
    sign = -1.0 if move.velocity < 0.0 else 1.0
    segments, exit_velocity = _preset(move, entry_velocity, sign)
    fastest = max((abs(segment.velocity) for segment in segments), default=0.0)
    if max(fastest, abs(exit_velocity)) * system_s < SLOWEST_COUNTS_PER_UPDATE:
        raise CannotBlend("distance and velocity come to less than one count in a system update")
    return Blended(_pieces(segments, move.distance), exit_velocity)


def _continuous(move: TimedMove, entry_velocity: float) -> Blended:
    segments = plan_continuous(0.0, entry_velocity, move.velocity, *move.ramps)
    ramp = [segment for segment in segments if 0.0 < segment.duration_s < math.inf]
    return Blended(_pieces(tuple(ramp), None), move.velocity)


def _preset(move: TimedMove, entry_velocity: float, sign: float) -> tuple[Segments, float]:
    assert move.distance is not None
    if move.ends_at_rest:
        try:
            velocity = abs(move.velocity)
            return plan_preset(0.0, entry_velocity, move.distance, velocity, *move.ramps), 0.0
        except TargetOvershot as error:
            raise CannotBlend(str(error)) from None
    exit_velocity = sign * _reached(move, abs(entry_velocity))
    *ramp, cruise = plan_continuous(0.0, entry_velocity, exit_velocity, *move.ramps)
    left = abs(move.distance) - abs(cruise.position)
    duration_s = max(0.0, left / abs(exit_velocity)) if exit_velocity else 0.0
    return (*ramp, cruise._replace(duration_s=duration_s)), exit_velocity


def _reached(move: TimedMove, entry: float) -> float:
    """The speed a preset segment that does not stop ends at: V, or as near as its distance lets it come."""
    assert move.distance is not None
    goal, distance = abs(move.velocity), abs(move.distance)
    if goal >= entry:
        return min(goal, math.sqrt(entry**2 + 2.0 * (move.average_acceleration or move.acceleration) * distance))
    slowest = entry**2 - 2.0 * (move.average_deceleration or move.deceleration) * distance
    return max(goal, math.sqrt(max(slowest, 0.0)))


def _pieces(segments: Segments, distance: float | None) -> tuple[StreamedSegment, ...]:
    """Pieces that each begin where the one before ends; the last one makes up for all rounding of `distance`."""
    timed = [segment for segment in segments if segment.duration_s > 0.0]
    if not timed:
        return ()
    begins = [round(segment.position * PARTS_PER_COUNT) for segment in timed]
    end = round((_end(timed) if distance is None else distance) * PARTS_PER_COUNT)
    return tuple(
        StreamedSegment(segment._replace(position=0.0), round(segment.duration_s * TICKS_PER_S), after - begin)
        for segment, begin, after in zip(timed, begins, [*begins[1:], end], strict=True)
    )


def _end(segments: list[Segment]) -> float:
    last = segments[-1]
    t = last.duration_s
    return last.position + t * (last.velocity + t * (last.acceleration / 2.0 + t * last.jerk / 6.0))

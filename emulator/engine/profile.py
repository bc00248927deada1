"""The profile planner: from where the axis is to where it shall be, as a row of cubic segments in closed form.

Everything is in counts and seconds and says nothing about when it begins; the kernel evaluates the segments at its
trajectory updates. A planned profile that ends at rest closes with a segment of no duration which states the end
position exactly, free of the rounding the segments before it have gathered.

Ramps: with `average` acceleration AA below the maximum A a ramp is an S-curve of symmetric jerk which takes dv / AA
and covers the distance of a straight ramp at AA (6250 User Guide p. 95: A/2 <= AA < A; equations inferred). A move too
short for its velocity keeps A and AA and lowers the peak velocity (inferred; the manual's choice is unknown).

Planning may start in motion. The acceleration of the profile that is given up then drops to zero at once (assumed),
which is `ACCELERATION_AT_REPLAN`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

ACCELERATION_AT_REPLAN = 0.0
"""Acceleration from which a ramp begins, counts/s2, whatever it was in the profile given up. Assumed."""

TOLERANCE = 1e-9
"""Relative room for rounding when a braking distance or an average acceleration is compared with its bound."""

NEGLIGIBLE_VELOCITY = 1e-9
"""A change of velocity this small (counts/s) is none: it needs no ramp, and its jerk could not be expressed."""


class Segment(NamedTuple):
    """One cubic piece: its duration (s, infinite for an endless one) and the state at its start (counts, s).

    With a `radius` it is an axis's share of an arc: the cubic is then the length of it travelled, and the position is
    centre + radius * cos(phase + curvature * length) (`curvature` in rad per count of path).
    """

    duration_s: float
    position: float
    velocity: float
    acceleration: float
    jerk: float
    radius: float = 0.0
    centre: float = 0.0
    phase: float = 0.0
    curvature: float = 0.0

    def moved(self, counts: float) -> Segment:
        """The same piece elsewhere, `counts` further on."""
        if self.radius:
            return self._replace(centre=self.centre + counts)
        return self._replace(position=self.position + counts)


class State(NamedTuple):
    """Position (counts), velocity (counts/s), acceleration (counts/s2)."""

    position: float
    velocity: float
    acceleration: float


Segments: TypeAlias = tuple[Segment, ...]


class TargetOvershot(ValueError):
    """The target lies behind, or nearer than the braking distance: it cannot be reached without reversing."""


class InvalidSCurve(ValueError):
    """An average acceleration outside A/2 <= AA <= A."""


class _Ramp(NamedTuple):
    """A change of velocity with its own maximum and average acceleration."""

    start_velocity: float
    end_velocity: float
    maximum: float
    average: float


def plan_preset(
    start_position: float,
    start_velocity: float,
    target_position: float,
    velocity: float,
    acceleration: float,
    deceleration: float,
    average_acceleration: float | None = None,
    average_deceleration: float | None = None,
) -> Segments:
    """A move that ends at rest at `target_position`: trapezoid, or triangle where too short.

    From a higher `start_velocity` it slows down to `velocity` (a magnitude) with the deceleration first.
    Raises TargetOvershot, InvalidSCurve, ValueError for a velocity or acceleration that is not above 0.
    """
    _require_positive(velocity)
    average_up = _average(acceleration, average_acceleration)
    average_down = _average(deceleration, average_deceleration)
    distance = target_position - start_position
    sign = -1.0 if distance < 0.0 or (distance == 0.0 and start_velocity < 0.0) else 1.0
    entry = sign * start_velocity
    distance = abs(distance)
    spare = _spare_distance(entry, distance, average_down)
    if entry > velocity:
        peak, first = velocity, _Ramp(sign * entry, sign * velocity, deceleration, average_down)
    else:
        peak = min(velocity, _peak_velocity(entry, distance, average_up, average_down))
        first = _Ramp(sign * entry, sign * peak, acceleration, average_up)
        spare = distance - (peak**2 - entry**2) / (2.0 * average_up) - peak**2 / (2.0 * average_down)
    cruise_s = max(spare, 0.0) / peak if peak > 0.0 else 0.0
    last = _Ramp(sign * peak, 0.0, deceleration, average_down)
    segments = _joined(start_position, [first], cruise_s, [last])
    return _rest_at(segments, target_position)


def plan_continuous(
    start_position: float,
    start_velocity: float,
    velocity: float,
    acceleration: float,
    deceleration: float,
    average_acceleration: float | None = None,
    average_deceleration: float | None = None,
) -> Segments:
    """Ramp to `velocity` (signed), through rest if the direction changes, and move on endlessly; 0 ends at rest.

    Raises InvalidSCurve, ValueError for an acceleration that is not above 0.
    """
    average_up = _average(acceleration, average_acceleration)
    average_down = _average(deceleration, average_deceleration)
    ramps: list[_Ramp] = []
    if start_velocity * velocity < 0.0:
        ramps = [
            _Ramp(start_velocity, 0.0, deceleration, average_down),
            _Ramp(0.0, velocity, acceleration, average_up),
        ]
    elif abs(velocity) < abs(start_velocity):
        ramps = [_Ramp(start_velocity, velocity, deceleration, average_down)]
    else:
        ramps = [_Ramp(start_velocity, velocity, acceleration, average_up)]
    if velocity == 0.0:
        segments = _joined(start_position, ramps, 0.0, [])
        return _rest_at(segments, _end_of(segments, start_position))
    return _joined(start_position, ramps, math.inf, [])


def plan_stop(
    start_position: float,
    start_velocity: float,
    deceleration: float,
    average_deceleration: float | None = None,
) -> Segments:
    """Slow down to rest. Raises InvalidSCurve, ValueError for a deceleration that is not above 0."""
    return plan_continuous(
        start_position,
        start_velocity,
        0.0,
        deceleration,
        deceleration,
        average_deceleration,
        average_deceleration,
    )


def profile_duration(segments: Sequence[Segment]) -> float:
    """Time from the beginning to rest, s; infinite for a profile that moves on endlessly."""
    return math.fsum(segment.duration_s for segment in segments) if segments else 0.0


def evaluate(segments: Sequence[Segment], t: float) -> State:
    """The state `t` seconds after the beginning, held at the end once the profile is over."""
    elapsed = 0.0
    for segment in segments[:-1]:
        if t < elapsed + segment.duration_s:
            return segment_state(segment, t - elapsed)
        elapsed += segment.duration_s
    last = segments[-1]
    if last.duration_s == 0.0:
        return State(last.position, 0.0, 0.0)
    return segment_state(last, min(t - elapsed, last.duration_s))


def segment_state(segment: Segment, t: float) -> State:
    """The state `t` seconds into a segment."""
    half_rate = 0.5 * segment.jerk * t
    velocity = segment.velocity + t * (segment.acceleration + half_rate)
    position = segment.position + t * (segment.velocity + t * (0.5 * segment.acceleration + half_rate / 3.0))
    state = State(position, velocity, segment.acceleration + segment.jerk * t)
    return _on_arc(segment, state) if segment.radius else state


def _on_arc(segment: Segment, along: State) -> State:
    """An axis's state on its arc from the state along the path."""
    angle = segment.phase + segment.curvature * along.position
    across, slope = segment.radius * math.cos(angle), -segment.radius * math.sin(angle)
    turning = segment.curvature * along.velocity
    acceleration = slope * segment.curvature * along.acceleration - across * turning * turning
    return State(segment.centre + across, slope * turning, acceleration)


def _require_positive(*values: float) -> None:
    for value in values:
        if not 0.0 < value < math.inf:
            raise ValueError(f"velocities and accelerations must be above 0, not {value}")


def _average(maximum: float, average: float | None) -> float:
    """The average acceleration in force: none given, 0 or the maximum itself mean a straight ramp."""
    _require_positive(maximum)
    if not average:
        return maximum
    if not 0.5 * (1.0 - TOLERANCE) <= average / maximum <= 1.0 + TOLERANCE:
        raise InvalidSCurve(f"average acceleration {average} is not between {maximum / 2} and {maximum}")
    return min(average, maximum)


def _spare_distance(entry: float, distance: float, braking: float) -> float:
    """What is left of `distance` after braking from `entry` velocity towards the target; TargetOvershot if none."""
    room = TOLERANCE * max(1.0, distance)
    spare = distance - entry * entry / (2.0 * braking)
    if entry < 0.0 or spare < -room:
        raise TargetOvershot(f"{distance} counts are too few to stop from {entry} counts/s")
    return spare


def _peak_velocity(entry: float, distance: float, up: float, down: float) -> float:
    """Velocity at which speeding up and braking together cover `distance`."""
    return max(entry, math.sqrt((2.0 * up * down * distance + down * entry * entry) / (up + down)))


def _pieces(ramp: _Ramp) -> list[tuple[float, float, float]]:
    """A ramp as (duration s, acceleration at the start, jerk), signed."""
    change = abs(ramp.end_velocity - ramp.start_velocity)
    if change < NEGLIGIBLE_VELOCITY:
        return []
    sign = math.copysign(1.0, ramp.end_velocity - ramp.start_velocity)
    peak = sign * ramp.maximum
    jerk_s = change / ramp.average - change / ramp.maximum
    if jerk_s <= TOLERANCE * change / ramp.maximum:
        return [(change / ramp.maximum, peak, 0.0)]
    constant_s = max(0.0, change / ramp.maximum - jerk_s)
    jerk = peak / jerk_s
    middle = [(constant_s, peak, 0.0)] if constant_s > TOLERANCE * jerk_s else []
    return [(jerk_s, ACCELERATION_AT_REPLAN, jerk), *middle, (jerk_s, peak, -jerk)]


def _append_ramp(segments: list[Segment], position: float, ramp: _Ramp) -> float:
    """Append a ramp's segments; the position after it is that of the average velocity over its time."""
    velocity, here = ramp.start_velocity, position
    for duration_s, acceleration, jerk in _pieces(ramp):
        segment = Segment(duration_s, here, velocity, acceleration, jerk)
        segments.append(segment)
        here, velocity, _ = segment_state(segment, duration_s)
    return here


def _joined(position: float, before: list[_Ramp], cruise_s: float, after: list[_Ramp]) -> Segments:
    """Ramps, constant velocity for `cruise_s`, ramps."""
    segments: list[Segment] = []
    for ramp in before:
        position = _append_ramp(segments, position, ramp)
    if cruise_s > 0.0:
        velocity = before[-1].end_velocity
        segments.append(Segment(cruise_s, position, velocity, 0.0, 0.0))
        position += velocity * cruise_s
    for ramp in after:
        position = _append_ramp(segments, position, ramp)
    return tuple(segments)


def _end_of(segments: Segments, start_position: float) -> float:
    """Where segments end; the start if there are none."""
    if not segments:
        return start_position
    return segment_state(segments[-1], segments[-1].duration_s).position


def _rest_at(segments: Segments, position: float) -> Segments:
    return (*segments, Segment(0.0, position, 0.0, 0.0, 0.0))

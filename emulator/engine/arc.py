"""Positions on a circular arc: what an axis does whose profile is the length of a path rather than its own distance.

Each axis of a contour evaluates its own share of the arc, coordinate = centre + radius * cos(phase + curvature * s),
with s the length of path travelled. The kernel may use no function of the mathematics library, whose last bit differs
from machine to machine, so the cosine is worked out here from the four operations that IEEE 754 fixes.
"""

from __future__ import annotations

import math

from .kernels import Record, kernel, seldom

QUARTERS_PER_RADIAN = 0.6366197723675814
QUARTER_TURN_HIGH = 1.57079632673412561417e00
QUARTER_TURN_LOW = 6.07710050650619224932e-11
"""A quarter turn in two parts: the first has so few digits that a multiple of it is exact."""

SINE = 3
"""Quarters by which a sine is ahead of the cosine of the same angle."""


@kernel
def small_sine(x: float) -> float:
    """Sine of at most an eighth of a turn either way, by its Taylor series (the first term left out is below 1e-19)."""
    y = x * x
    series = 1.0 - y / 342.0
    series = 1.0 - y / 272.0 * series
    series = 1.0 - y / 210.0 * series
    series = 1.0 - y / 156.0 * series
    series = 1.0 - y / 110.0 * series
    series = 1.0 - y / 72.0 * series
    series = 1.0 - y / 42.0 * series
    series = 1.0 - y / 20.0 * series
    return x - x * (y / 6.0 * series)


@kernel
def small_cosine(x: float) -> float:
    """Cosine of at most an eighth of a turn either way, by its Taylor series (the same bound)."""
    y = x * x
    series = 1.0 - y / 306.0
    series = 1.0 - y / 240.0 * series
    series = 1.0 - y / 182.0 * series
    series = 1.0 - y / 132.0 * series
    series = 1.0 - y / 90.0 * series
    series = 1.0 - y / 56.0 * series
    series = 1.0 - y / 30.0 * series
    series = 1.0 - y / 12.0 * series
    return 1.0 - y / 2.0 * series


@seldom
def cosine(angle: float, quarters: int) -> float:
    """Cosine of an angle (rad, some turns at most) and so many quarter turns more."""
    nearest = math.floor(angle * QUARTERS_PER_RADIAN + 0.5)
    x = (angle - nearest * QUARTER_TURN_HIGH) - nearest * QUARTER_TURN_LOW
    quadrant = (nearest + quarters) % 4
    if quadrant == 0:
        return small_cosine(x)
    if quadrant == 1:
        return -small_sine(x)
    if quadrant == 2:
        return -small_cosine(x)
    return small_sine(x)


@seldom
def go_along_arc(axis: Record, segment: Record, length: float, speed: float, speed_rate: float) -> None:
    """Commanded position, velocity and acceleration of an axis `length` counts along its arc, at a speed (counts/s)
    along the path that changes at `speed_rate` (counts/s2)."""
    curvature, radius = segment["curvature"], segment["radius"]
    angle = segment["phase"] + curvature * length
    across, along = radius * cosine(angle, 0), -radius * cosine(angle, SINE)
    turning = curvature * speed
    axis["commanded_counts"] = axis["profile_origin_counts"] + math.floor(segment["centre"] + across + 0.5)
    axis["commanded_velocity"] = along * turning
    axis["commanded_acceleration"] = along * (curvature * speed_rate) - across * (turning * turning)

"""An encoder that something else turns than the motor of its axis: a conveyor, a press, a hand at a test's disposal.

The position is a closed form of time, evaluated at every servo sample, so that it neither drifts nor depends on how a
run is cut into slices. Whatever moved the encoder before, a new motion goes on from where it is. The motor of such an
axis moves its load as ever, but its encoder does not see it.

Positions are counts, before polarity and wiring.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .kernels import Record, kernel, seldom

S_PER_NS = 1e-9
TURN = 2.0 * math.pi

FASTEST_COUNTS_S = 1e9
WIDEST_COUNTS = 1e12
"""Bounds (design choice) that keep counts exact in floating point for weeks."""


@dataclass(frozen=True, slots=True)
class EncoderMotion:
    """A motion from its start on: from `start_velocity` to `velocity` (counts/s) in `ramp_s`, then on at it.

    A sine of `swing_counts` to either side at `frequency_hz` lies on top. After `end_s` the encoder rests at
    `end_counts` from where it was at the start.
    """

    velocity_counts_s: float = 0.0
    start_velocity_counts_s: float = 0.0
    ramp_s: float = 0.0
    swing_counts: float = 0.0
    frequency_hz: float = 0.0
    end_s: float = math.inf
    end_counts: float = 0.0
    start_s: float = 0.0
    """Virtual time at which it starts, for a motion that is there from the beginning."""

    def __post_init__(self) -> None:
        for velocity in (self.velocity_counts_s, self.start_velocity_counts_s):
            if not abs(velocity) <= FASTEST_COUNTS_S:
                raise ValueError(f"an encoder turns at up to {FASTEST_COUNTS_S:g} counts/s, not {velocity}")
        for counts in (self.swing_counts, self.end_counts):
            if not abs(counts) <= WIDEST_COUNTS:
                raise ValueError(f"an encoder turns by up to {WIDEST_COUNTS:g} counts, not {counts}")
        for name in ("ramp_s", "frequency_hz", "end_s", "start_s"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} must not be below 0, not {getattr(self, name)}")

    @classmethod
    def by(cls, counts: int, velocity_counts_s: float) -> EncoderMotion:
        """A travel of so many counts at a velocity (magnitude), or at once with velocity 0."""
        speed = abs(velocity_counts_s)
        if counts == 0 or speed == 0.0:
            return cls(end_s=0.0, end_counts=counts)
        return cls(velocity_counts_s=math.copysign(speed, counts), end_s=abs(counts) / speed, end_counts=counts)

    def fields(self, *, origin_counts: float, now_ns: int) -> dict[str, float]:
        """Fields of the axis record for a motion that goes on from a position; `now_ns` is the present time."""
        return {
            "encoder_driven": 1,
            "motion_start_ns": now_ns + round(self.start_s / S_PER_NS),
            "motion_origin": origin_counts,
            "motion_start_velocity": self.start_velocity_counts_s,
            "motion_velocity": self.velocity_counts_s,
            "motion_ramp_s": self.ramp_s,
            "motion_swing": self.swing_counts,
            "motion_hz": self.frequency_hz,
            "motion_end_s": self.end_s,
            "motion_end_counts": self.end_counts,
            "driven_counts": origin_counts,
        }


@kernel
def sine_of_turns(turns: float) -> float:
    """sin(2 pi turns) to 1e-13, by the power series within a quarter turn: the same on every machine."""
    part = turns - math.floor(turns)
    sign = 1.0
    if part > 0.5:
        part -= 0.5
        sign = -1.0
    if part > 0.25:
        part = 0.5 - part
    angle = TURN * part
    square = angle * angle
    term = 1.0
    total = 1.0
    for n in range(1, 10):
        term *= -square / (2.0 * n * (2.0 * n + 1.0))
        total += term
    return sign * angle * total


@kernel
def driven_velocity(axis: Record, elapsed_s: float) -> float:
    """Velocity of a driven encoder without its sine, counts/s."""
    if elapsed_s < 0.0 or elapsed_s >= axis["motion_end_s"]:
        return 0.0
    if elapsed_s >= axis["motion_ramp_s"]:
        return float(axis["motion_velocity"])
    change = axis["motion_velocity"] - axis["motion_start_velocity"]
    return float(axis["motion_start_velocity"] + change * elapsed_s / axis["motion_ramp_s"])


@kernel
def driven_travel(axis: Record, elapsed_s: float) -> float:
    """Counts a driven encoder has gone since its motion began."""
    if elapsed_s <= 0.0:
        return 0.0
    if elapsed_s >= axis["motion_end_s"]:
        return float(axis["motion_end_counts"])
    ramp_s = axis["motion_ramp_s"]
    ramped_s = min(elapsed_s, ramp_s)
    mean = axis["motion_start_velocity"] + driven_velocity(axis, ramped_s)
    travel = 0.5 * mean * ramped_s + axis["motion_velocity"] * (elapsed_s - ramped_s)
    if axis["motion_swing"] != 0.0:
        travel += axis["motion_swing"] * sine_of_turns(axis["motion_hz"] * elapsed_s)
    return float(travel)


@seldom
def drive_encoder(axis: Record, now_ns: int) -> None:
    """Servo sample of a driven encoder."""
    elapsed_s = (now_ns - axis["motion_start_ns"]) * S_PER_NS
    axis["driven_counts"] = axis["motion_origin"] + driven_travel(axis, elapsed_s)

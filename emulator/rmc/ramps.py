"""Plans of the target: ramps of velocity, straight or S-shaped, and polynomials.

A trapezoidal ramp has constant acceleration. An S-curve with the same average acceleration takes the same time and the
same way: its acceleration rises over the first third of the ramp as a cubic smoothstep, holds 1.5 times the average
over the second, and falls over the third, so that the position is a polynomial of fifth order (H param_requested_jerk
gives both factors of 1.5 and "5th order"; the thirds are inferred). So whatever is planned is planned as trapezoids.

Planning is plain Python, done once a command; evaluating is the kernel's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from emulator.engine.kernels import Record

from .kernels import kernel, seldom

LINEAR, S_CURVE, POLYNOMIAL = 0, 1, 2

PEAK = 1.5
"""Peak over average acceleration of an S-curve."""
QUARTER, THIRD, TWO_THIRDS, PLACE_AT_THIRD = 0.25, 1.0 / 3.0, 2.0 / 3.0, 0.025
SLOPE = 3.0 * PEAK


@dataclass(frozen=True, slots=True)
class Ramp:
    """A piece of a plan: `change` of velocity within `duration_s`, or a polynomial with its higher coefficients."""

    duration_s: float
    velocity: float
    change: float = 0.0
    shape: int = LINEAR
    higher: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """Coefficients of t2 to t5 of a polynomial."""

    @property
    def distance(self) -> float:
        """Way of the whole ramp; infinite for one that never ends."""
        t = self.duration_s
        if self.shape == POLYNOMIAL:
            c2, c3, c4, c5 = self.higher
            return t * (self.velocity + t * (c2 + t * (c3 + t * (c4 + t * c5))))
        if math.isinf(t):
            return math.inf if self.velocity else 0.0
        return t * (self.velocity + 0.5 * self.change)


Plan = tuple[Ramp, ...]


def ramp_between(velocity: float, to_velocity: float, *, rate: float, shape: int) -> Plan:
    """Change the velocity at an average rate; nothing if there is nothing to change."""
    change = to_velocity - velocity
    return (Ramp(abs(change) / rate, velocity, change, shape),) if change else ()


def plan_velocity(velocity: float, to_velocity: float, *, accel: float, decel: float, shape: int) -> Plan:
    """Go over to another velocity and keep it: decelerating towards 0, accelerating away from it (M800)."""
    ramps: Plan = ()
    at = velocity
    if at * to_velocity < 0.0:
        ramps, at = ramp_between(at, 0.0, rate=decel, shape=shape), 0.0
    rate = accel if abs(to_velocity) > abs(at) else decel
    return (*ramps, *ramp_between(at, to_velocity, rate=rate, shape=shape), Ramp(math.inf, to_velocity))


def plan_stop(velocity: float, *, decel: float, shape: int) -> Plan:
    """Come to rest."""
    return ramp_between(velocity, 0.0, rate=decel, shape=shape)


def plan_move(distance: float, velocity: float, *, speed: float, accel: float, decel: float, shape: int) -> Plan:
    """Cover a distance from a velocity and be at rest there, as fast as `speed`, `accel` and `decel` allow.

    A start in the wrong direction, or too fast to stop in time, first comes to rest and goes back.
    """
    sign = 1.0 if distance > 0.0 or (distance == 0.0 and velocity >= 0.0) else -1.0
    way, v = sign * distance, sign * velocity
    if v < 0.0 or v * v / (2.0 * decel) > way * (1.0 + 1e-12):
        stop = plan_stop(velocity, decel=decel, shape=shape)
        left = distance - sum(ramp.distance for ramp in stop)
        back = plan_move(left, 0.0, speed=speed, accel=accel, decel=decel, shape=shape) if left else ()
        return (*stop, *back)
    if way == 0.0:
        return ()
    top = min(speed, math.sqrt((2.0 * accel * decel * way + decel * v * v) / (accel + decel)))
    # Faster than asked at the start: the way to the lower speed is braked at the rate of deceleration.
    to_top = ramp_between(v, speed if v > speed else top, rate=decel if v > speed else accel, shape=shape)
    top = speed if v > speed else top
    to_rest = plan_stop(top, decel=decel, shape=shape)
    cruise = way - sum(ramp.distance for ramp in (*to_top, *to_rest))
    between = (Ramp(cruise / top, top),) if cruise > 1e-12 * way else ()
    return tuple(turned(ramp, sign) for ramp in (*to_top, *between, *to_rest))


def turned(ramp: Ramp, sign: float) -> Ramp:
    """The same ramp in the other direction, if `sign` is negative."""
    return Ramp(ramp.duration_s, sign * ramp.velocity, sign * ramp.change, ramp.shape)


def stretched(plan: Plan, factor: float) -> Plan:
    """The same way from rest to rest in `factor` times the time."""
    return tuple(
        Ramp(ramp.duration_s * factor, ramp.velocity / factor, ramp.change / factor, ramp.shape) for ramp in plan
    )


def plan_timed(
    distance: float, velocity: float, acceleration: float, *, time_s: float, to_velocity: float, to_acceleration: float
) -> Plan:
    """Cover a distance in a time, with velocity and acceleration given at both ends: the polynomial of fifth order.

    A final velocity is kept.
    """
    t = time_s
    way = distance - t * (velocity + 0.5 * acceleration * t)
    gain = to_velocity - velocity - acceleration * t
    rise = to_acceleration - acceleration
    c3 = (10.0 * way - 4.0 * gain * t + 0.5 * rise * t * t) / t**3
    c4 = (-15.0 * way + 7.0 * gain * t - rise * t * t) / t**4
    c5 = (6.0 * way - 3.0 * gain * t + 0.5 * rise * t * t) / t**5
    timed = Ramp(t, velocity, to_velocity - velocity, POLYNOMIAL, (0.5 * acceleration, c3, c4, c5))
    return (timed, Ramp(math.inf, to_velocity)) if to_velocity else (timed,)


def plan_speed_at(distance: float, velocity: float, *, to_velocity: float, shape: int) -> Plan | None:
    """Reach a velocity after a distance in one ramp, and keep it; None where no such ramp exists."""
    mean = 0.5 * (velocity + to_velocity)
    if mean * distance <= 0.0 or velocity * to_velocity < 0.0:
        return None
    ramp = Ramp(distance / mean, velocity, to_velocity - velocity, shape)
    return (ramp, Ramp(math.inf, to_velocity)) if to_velocity else (ramp,)


def plan_distance(plan: Sequence[Ramp]) -> float:
    """Way of a whole plan."""
    return math.fsum(ramp.distance for ramp in plan)


def plan_duration(plan: Sequence[Ramp]) -> float:
    """Time of a whole plan, s."""
    return math.fsum(ramp.duration_s for ramp in plan)


@kernel
def smooth_part(u: float) -> float:
    """Share of the change of velocity reached after a share `u` (up to a third) of an S-curve."""
    w = 3.0 * u
    return 0.5 * w * w * w * (1.0 - 0.5 * w)


@kernel
def smooth_way(u: float) -> float:
    """Integral of `smooth_part` from 0."""
    w = 3.0 * u
    return w * w * w * w * (0.25 - 0.1 * w) / 6.0


@kernel
def s_share(u: float) -> float:
    """Share of the change of velocity reached after a share `u` of an S-curve."""
    if u < THIRD:
        return smooth_part(u)
    if u <= TWO_THIRDS:
        return QUARTER + PEAK * (u - THIRD)
    return 1.0 - smooth_part(1.0 - u)


@kernel
def s_way(u: float) -> float:
    """Integral of `s_share` from 0."""
    if u < THIRD:
        return smooth_way(u)
    if u <= TWO_THIRDS:
        past = u - THIRD
        return PLACE_AT_THIRD + past * (QUARTER + 0.5 * PEAK * past)
    return u - 0.5 + smooth_way(1.0 - u)


@kernel
def s_slope(u: float) -> float:
    """Derivative of `s_share`: acceleration over the average one."""
    if THIRD <= u <= TWO_THIRDS:
        return PEAK
    w = 3.0 * u if u < THIRD else 3.0 * (1.0 - u)
    return PEAK * w * w * (3.0 - 2.0 * w)


@kernel
def s_bend(u: float) -> float:
    """Second derivative of `s_share`: jerk times the square of the duration, over the change of velocity."""
    if THIRD <= u <= TWO_THIRDS:
        return 0.0
    w = 3.0 * u if u < THIRD else 3.0 * (1.0 - u)
    bend = SLOPE * 6.0 * w * (1.0 - w)
    return bend if u < THIRD else -bend


@kernel
def on_line(axis: Record, ramp: Record, t: float) -> None:
    """Target on a straight ramp or at constant velocity, `t` seconds after its start."""
    acceleration = ramp["change"] / ramp["duration_s"] if ramp["change"] != 0.0 else 0.0
    way = ramp["position"] + t * (ramp["velocity"] + 0.5 * acceleration * t)
    axis["target_position"] = axis["plan_start"] + way
    axis["target_velocity"] = ramp["velocity"] + acceleration * t
    axis["target_acceleration"] = acceleration
    axis["target_jerk"] = 0.0


@seldom
def on_s_curve(axis: Record, ramp: Record, t: float) -> None:
    """Target on an S-curve."""
    duration, change = ramp["duration_s"], ramp["change"]
    u = t / duration
    way = ramp["position"] + t * ramp["velocity"] + change * duration * s_way(u)
    axis["target_position"] = axis["plan_start"] + way
    axis["target_velocity"] = ramp["velocity"] + change * s_share(u)
    axis["target_acceleration"] = change / duration * s_slope(u)
    axis["target_jerk"] = change / (duration * duration) * s_bend(u)


@seldom
def on_polynomial(axis: Record, ramp: Record, t: float) -> None:
    """Target on a polynomial of fifth order."""
    c2, c3, c4, c5 = ramp["half_acceleration"], ramp["c3"], ramp["c4"], ramp["c5"]
    way = t * (ramp["velocity"] + t * (c2 + t * (c3 + t * (c4 + t * c5))))
    axis["target_position"] = axis["plan_start"] + ramp["position"] + way
    axis["target_velocity"] = ramp["velocity"] + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + 5.0 * t * c5)))
    axis["target_acceleration"] = 2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + 20.0 * t * c5))
    axis["target_jerk"] = 6.0 * c3 + t * (24.0 * c4 + 60.0 * t * c5)


@kernel
def on_ramp(axis: Record, ramp: Record, t: float) -> None:
    """Target `t` seconds after the start of a ramp."""
    if ramp["shape"] == LINEAR:
        on_line(axis, ramp, t)
    elif ramp["shape"] == S_CURVE:
        on_s_curve(axis, ramp, t)
    else:
        on_polynomial(axis, ramp, t)

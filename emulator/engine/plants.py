"""Drives and loads: what the analogue output moves.

Two plants. `VelocityDrive`, the default, is a drive that closes its own velocity loop: volts are speed, and motor
inertia shows as the time constant of that loop and as the limit its peak torque puts on acceleration. `TorqueDrive`
turns volts into torque on an inertia with viscous and dry friction.

The controller is discrete and the plant continuous, with the output held in between, so each sample is the exact
solution over one period (zero-order hold). Its coefficients need exp, which no two mathematical libraries round alike;
they are worked out here in Python when a parameter or the period changes, and the cycle only multiplies and adds.

Positions are revolutions, speeds revolutions per second. Every default is a choice for a machine that behaves
sensibly with the power-up gains, not a property of any product.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .kernels import Record, kernel, seldom

VELOCITY_DRIVE = 0
TORQUE_DRIVE = 1

# Two time constants closer than this (relative) are taken as equal; the general solution divides by their difference.
EQUAL_TIME_CONSTANTS = 1e-6

# Below this exponent the series of (1 - exp(-x)) is used, where the closed form would lose digits.
SMALL_EXPONENT = 1e-3


@dataclass(frozen=True, slots=True)
class VelocityDrive:
    """A velocity-mode drive with its motor.

    `max_acceleration_rev_s2` (peak torque over inertia) and `coast_time_constant_s` may be infinite,
    `command_lag_s` may be 0. With 4000 counts/rev and SGP 0.5 the defaults give a position loop of 20 1/s.
    """

    speed_per_volt_rev_s: float = 10.0
    loop_time_constant_s: float = 0.002
    command_lag_s: float = 0.0003
    max_acceleration_rev_s2: float = 5000.0
    coast_time_constant_s: float = 0.05

    def __post_init__(self) -> None:
        _require_positive(
            loop_time_constant_s=self.loop_time_constant_s,
            max_acceleration_rev_s2=self.max_acceleration_rev_s2,
            coast_time_constant_s=self.coast_time_constant_s,
        )
        _require_not_negative(command_lag_s=self.command_lag_s)

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""
        tau, lag = self.loop_time_constant_s, self.command_lag_s
        loop_decay = math.exp(-period_s / tau)
        lag_decay = math.exp(-period_s / lag) if lag > 0.0 else 0.0
        lag_to_speed, lag_to_position = _lag_response(tau, lag, period_s)
        return {
            "kind": VELOCITY_DRIVE,
            "speed_per_volt": self.speed_per_volt_rev_s,
            "lag_decay": lag_decay,
            "loop_decay": loop_decay,
            "lag_to_speed": lag_to_speed,
            "loop_to_position": tau * (1.0 - loop_decay),
            "lag_to_position": lag_to_position,
            "speed_step_limit": self.max_acceleration_rev_s2 * period_s,
            "coast_decay": math.exp(-period_s / self.coast_time_constant_s),
            "coast_to_position": _held_time(self.coast_time_constant_s, period_s),
        }


@dataclass(frozen=True, slots=True)
class TorqueDrive:
    """A torque-mode drive on an inertia. A positive `load_torque_nm` acts against positive motion, as gravity does."""

    torque_per_volt_nm: float = 0.3
    inertia_kg_m2: float = 2e-4
    viscous_nm_s_per_rev: float = 2e-3
    coulomb_nm: float = 0.02
    load_torque_nm: float = 0.0
    peak_torque_nm: float = math.inf

    def __post_init__(self) -> None:
        _require_positive(inertia_kg_m2=self.inertia_kg_m2, peak_torque_nm=self.peak_torque_nm)
        _require_not_negative(viscous_nm_s_per_rev=self.viscous_nm_s_per_rev, coulomb_nm=self.coulomb_nm)

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""
        torque_per_acceleration = 2.0 * math.pi * self.inertia_kg_m2
        rate = self.viscous_nm_s_per_rev / torque_per_acceleration
        speed_to_position, second_integral = _viscous_response(rate, period_s)
        return {
            "kind": TORQUE_DRIVE,
            "torque_per_volt": self.torque_per_volt_nm,
            "peak_torque": self.peak_torque_nm,
            "load_torque": self.load_torque_nm,
            "coulomb_torque": self.coulomb_nm,
            "speed_decay": math.exp(-rate * period_s),
            "speed_to_position": speed_to_position,
            "torque_to_speed": speed_to_position / torque_per_acceleration,
            "torque_to_position": second_integral / torque_per_acceleration,
        }


Plant = VelocityDrive | TorqueDrive


def _require_positive(**values: float) -> None:
    for name, value in values.items():
        if not value > 0.0:
            raise ValueError(f"{name} must be above 0, not {value}")


def _require_not_negative(**values: float) -> None:
    for name, value in values.items():
        if not 0.0 <= value < math.inf:
            raise ValueError(f"{name} must be 0 or above, not {value}")


def _held_time(tau: float, period_s: float) -> float:
    """Integral of exp(-t / tau) over one period, s."""
    return period_s if math.isinf(tau) else -tau * math.expm1(-period_s / tau)


def _lag_response(tau: float, lag: float, period_s: float) -> tuple[float, float]:
    """What a unit deviation of the input lag does to speed (-) and position (s) within one period."""
    if lag == 0.0:
        return 0.0, 0.0
    decay = math.exp(-period_s / tau)
    if abs(lag - tau) < EQUAL_TIME_CONSTANTS * tau:
        return period_s / tau * decay, tau * (1.0 - (1.0 + period_s / tau) * decay)
    share = lag / (lag - tau)
    speed = share * (math.exp(-period_s / lag) - decay)
    return speed, share * (_held_time(lag, period_s) - _held_time(tau, period_s))


def _viscous_response(rate: float, period_s: float) -> tuple[float, float]:
    """First (s) and second (s2) integral over one period of exp(-rate t)."""
    x = rate * period_s
    if x < SMALL_EXPONENT:
        first = period_s * (1.0 - x / 2.0 + x * x / 6.0 - x * x * x / 24.0)
        return first, period_s * period_s * (0.5 - x / 6.0 + x * x / 24.0 - x * x * x / 120.0)
    first = -math.expm1(-x) / rate
    return first, (period_s - first) / rate


@kernel
def step_velocity_drive(axis: Record, plant: Record, volts: float) -> None:
    """Advance a velocity-mode drive by one step with the output held.

    While the average acceleration over the sample would exceed what the peak torque allows, speed changes at that
    limit instead. A drive shut down lets the motor coast; its input lag follows the voltage all the same.
    """
    command = volts * plant["speed_per_volt"]
    lag_deviation = axis["lagged_command"] - command
    axis["lagged_command"] = command + lag_deviation * plant["lag_decay"]
    speed = axis["true_velocity"]
    if axis["enabled"] == 0:
        axis["true_position"] += speed * plant["coast_to_position"]
        axis["true_velocity"] = speed * plant["coast_decay"]
        return
    deviation = speed - command
    step = command + deviation * plant["loop_decay"] + lag_deviation * plant["lag_to_speed"] - speed
    if abs(step) <= plant["speed_step_limit"]:
        travel = (
            command * plant["period_s"]
            + deviation * plant["loop_to_position"]
            + lag_deviation * plant["lag_to_position"]
        )
    else:
        step = plant["speed_step_limit"] if step > 0.0 else -plant["speed_step_limit"]
        travel = (speed + 0.5 * step) * plant["period_s"]
    axis["true_position"] += travel
    axis["true_velocity"] = speed + step


@kernel
def drive_torque(axis: Record, plant: Record, volts: float) -> float:
    """Torque on the shaft without friction, Nm: the drive's within its peak, less the load."""
    torque = volts * plant["torque_per_volt"]
    if torque > plant["peak_torque"]:
        torque = plant["peak_torque"]
    if torque < -plant["peak_torque"]:
        torque = -plant["peak_torque"]
    if axis["enabled"] == 0:
        torque = 0.0
    return float(torque - plant["load_torque"])


@kernel
def beyond_friction(applied: float, coulomb: float) -> float:
    """What is left of a torque on a resting shaft after dry friction, which can hold but not push."""
    if applied > coulomb:
        return applied - coulomb
    if applied < -coulomb:
        return applied + coulomb
    return 0.0


@seldom
def step_torque_drive(axis: Record, plant: Record, volts: float) -> None:
    """Advance a torque-mode drive by one step with the output held.

    Dry friction opposes motion. Where it would turn the speed round within the sample, the shaft comes to rest at the
    crossing, found with speed taken as linear, and leaves again only if the torque beats friction: no chatter at rest.
    """
    applied = drive_torque(axis, plant, volts)
    coulomb = plant["coulomb_torque"]
    speed = axis["true_velocity"]
    net = beyond_friction(applied, coulomb)
    if speed > 0.0:
        net = applied - coulomb
    if speed < 0.0:
        net = applied + coulomb
    end_speed = speed * plant["speed_decay"] + net * plant["torque_to_speed"]
    travel = speed * plant["speed_to_position"] + net * plant["torque_to_position"]
    if speed * end_speed < 0.0:
        before_rest = speed / (speed - end_speed)
        after_rest = 1.0 - before_rest
        end_speed = beyond_friction(applied, coulomb) * plant["torque_to_speed"] * after_rest
        travel = 0.5 * plant["period_s"] * (speed * before_rest + end_speed * after_rest)
    axis["true_velocity"] = end_speed
    axis["true_position"] += travel


@kernel
def step_plant(axis: Record, plant: Record, volts: float) -> None:
    """Advance the axis's plant by the step `plant` is for, with `volts` at the drive's input."""
    if plant["kind"] == VELOCITY_DRIVE:
        step_velocity_drive(axis, plant, volts)
    else:
        step_torque_drive(axis, plant, volts)

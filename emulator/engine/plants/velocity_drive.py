"""A drive that closes its own velocity loop: volts are speed.

Motor inertia shows as the time constant of that loop and as the limit its peak torque puts on acceleration. A load
torque shows only where the drive's loop has no integrator: as a droop of speed in proportion to the torque, which comes
and goes with the loop's time constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..kernels import Record, kernel
from .parameters import (
    PlantError,
    require_finite,
    require_not_negative,
    require_positive,
    require_positive_or_infinite,
)

VELOCITY_DRIVE = 0

# Two time constants closer than this (relative) are taken as equal; the general solution divides by their difference.
EQUAL_TIME_CONSTANTS = 1e-6


@dataclass(frozen=True, slots=True)
class VelocityDrive:
    """A velocity-mode drive with its motor.

    `max_acceleration_rev_s2` (peak torque over inertia) and `coast_time_constant_s` may be infinite,
    `command_lag_s` may be 0. With 4000 counts/rev and SGP 0.5 the defaults give a position loop of 20 1/s.
    A positive `load_torque_nm` acts against positive motion, as gravity on a lifted load does; it costs
    `droop_rev_s_per_nm` of speed per Nm, 0 for a drive whose integrator holds the speed.
    """

    speed_per_volt_rev_s: float = 10.0
    loop_time_constant_s: float = 0.002
    command_lag_s: float = 0.0003
    max_acceleration_rev_s2: float = 5000.0
    coast_time_constant_s: float = 0.05
    droop_rev_s_per_nm: float = 0.0
    load_torque_nm: float = 0.0
    backlash_rev: float = 0.0

    def __post_init__(self) -> None:
        require_positive(speed_per_volt_rev_s=self.speed_per_volt_rev_s, loop_time_constant_s=self.loop_time_constant_s)
        require_positive_or_infinite(
            max_acceleration_rev_s2=self.max_acceleration_rev_s2, coast_time_constant_s=self.coast_time_constant_s
        )
        require_not_negative(
            command_lag_s=self.command_lag_s,
            droop_rev_s_per_nm=self.droop_rev_s_per_nm,
            backlash_rev=self.backlash_rev,
        )
        require_finite(load_torque_nm=self.load_torque_nm)
        if self.load_torque_nm != 0.0 and self.droop_rev_s_per_nm == 0.0:
            raise PlantError(
                "load_torque_nm",
                self.load_torque_nm,
                "0 on a velocity drive without droop_rev_s_per_nm",
            )

    @property
    def play_rev(self) -> float:
        """Play between this and the load, rev."""
        return self.backlash_rev

    @property
    def load_apart(self) -> bool:
        """The load can stand elsewhere than the shaft."""
        return self.backlash_rev > 0.0

    def with_load(self, torque_nm: float) -> VelocityDrive:
        """The same drive under another load torque; PlantError if it has no droop."""
        return replace(self, load_torque_nm=torque_nm)

    def with_friction(self, torque_nm: float) -> VelocityDrive:
        """PlantError: dry friction is the inner loop's affair."""
        raise PlantError("friction", torque_nm, "left alone on a velocity drive, whose own loop deals with it")

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""
        tau, lag = self.loop_time_constant_s, self.command_lag_s
        loop_decay = math.exp(-period_s / tau)
        lag_decay = math.exp(-period_s / lag) if lag > 0.0 else 0.0
        lag_to_speed, lag_to_position = _lag_response(tau, lag, period_s)
        return {
            "kind": VELOCITY_DRIVE,
            "speed_per_volt": self.speed_per_volt_rev_s,
            "speed_droop": self.droop_rev_s_per_nm * self.load_torque_nm,
            "lag_decay": lag_decay,
            "loop_decay": loop_decay,
            "lag_to_speed": lag_to_speed,
            "loop_to_position": _held_time(tau, period_s),
            "lag_to_position": lag_to_position,
            "speed_step_limit": self.max_acceleration_rev_s2 * period_s,
            "coast_decay": math.exp(-period_s / self.coast_time_constant_s),
            "coast_to_position": _held_time(self.coast_time_constant_s, period_s),
        }


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
    aim = command - plant["speed_droop"]
    deviation = speed - aim
    step = aim + deviation * plant["loop_decay"] + lag_deviation * plant["lag_to_speed"] - speed
    if abs(step) <= plant["speed_step_limit"]:
        travel = (
            aim * plant["period_s"] + deviation * plant["loop_to_position"] + lag_deviation * plant["lag_to_position"]
        )
    else:
        step = plant["speed_step_limit"] if step > 0.0 else -plant["speed_step_limit"]
        travel = (speed + 0.5 * step) * plant["period_s"]
    axis["true_position"] += travel
    axis["true_velocity"] = speed + step

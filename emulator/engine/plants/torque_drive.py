"""A drive that turns volts into torque, on one inertia with viscous and dry friction."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..kernels import Record, kernel, seldom
from .parameters import require_finite, require_not_negative, require_positive, require_positive_or_infinite

TORQUE_DRIVE = 1

# Below this exponent the series of (1 - exp(-x)) is used, where the closed form would lose digits.
SMALL_EXPONENT = 1e-3


@dataclass(frozen=True, slots=True)
class TorqueDrive:
    """A torque-mode drive on an inertia.

    A positive `load_torque_nm` acts against positive motion, as gravity on a lifted load does. `peak_torque_nm` is the
    drive's own limit and may be infinite.
    """

    torque_per_volt_nm: float = 0.3
    inertia_kg_m2: float = 2e-4
    viscous_nm_s_per_rev: float = 2e-3
    coulomb_nm: float = 0.02
    load_torque_nm: float = 0.0
    peak_torque_nm: float = math.inf
    backlash_rev: float = 0.0

    def __post_init__(self) -> None:
        require_positive(torque_per_volt_nm=self.torque_per_volt_nm, inertia_kg_m2=self.inertia_kg_m2)
        require_positive_or_infinite(peak_torque_nm=self.peak_torque_nm)
        require_not_negative(
            viscous_nm_s_per_rev=self.viscous_nm_s_per_rev, coulomb_nm=self.coulomb_nm, backlash_rev=self.backlash_rev
        )
        require_finite(load_torque_nm=self.load_torque_nm)

    @property
    def play_rev(self) -> float:
        """Play between this and the load, rev."""
        return self.backlash_rev

    @property
    def load_apart(self) -> bool:
        """The load can stand elsewhere than the shaft."""
        return self.backlash_rev > 0.0

    def with_load(self, torque_nm: float) -> TorqueDrive:
        """The same drive under another load torque."""
        return replace(self, load_torque_nm=torque_nm)

    def with_friction(self, torque_nm: float) -> TorqueDrive:
        """The same drive with another dry friction."""
        return replace(self, coulomb_nm=torque_nm)

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


def _viscous_response(rate: float, period_s: float) -> tuple[float, float]:
    """First (s) and second (s2) integral over one period of exp(-rate t)."""
    x = rate * period_s
    if x < SMALL_EXPONENT:
        first = period_s * (1.0 - x / 2.0 + x * x / 6.0 - x * x * x / 24.0)
        return first, period_s * period_s * (0.5 - x / 6.0 + x * x / 24.0 - x * x * x / 120.0)
    first = -math.expm1(-x) / rate
    return first, (period_s - first) / rate


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

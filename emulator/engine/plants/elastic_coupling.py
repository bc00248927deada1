"""A motor and a load on a springy shaft: two inertias, a stiffness, a damping, and a resonance between them.

    Jm wm' = drive torque - k twist - d (wm - wl) - viscous - dry friction of the motor
    Jl wl' =                k twist + d (wm - wl) - viscous - dry friction of the load - load torque

The step is exact with the drive's voltage held. In front stands a torque-mode drive, or a velocity-mode one: a
proportional speed loop on the motor, which is part of the exact step while its torque stays within the peak. There are
therefore two sets of coefficients, `loose` for a given motor torque and `held` with the speed loop closed.

Dry friction is the torque, within its bounds, that would bring the inertia to rest by the end of the step: it slows
down, it holds, and it can never turn a shaft round, so that there is no chatter at rest at any servo rate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from ..kernels import Record, kernel, seldom
from .exponential import Matrix, held_step
from .parameters import (
    PlantError,
    require_finite,
    require_not_negative,
    require_positive,
    require_positive_or_infinite,
)

ELASTIC_COUPLING = 2

TURN = 2.0 * math.pi

LOWEST_RESONANCE_HZ = 0.1
HIGHEST_RESONANCE_HZ = 20_000.0
"""Resonances outside are refused (design choice): below, nothing connects the inertias; above, the shaft is rigid."""

FASTEST_RATE_PER_S = 1e6
"""Fastest decay of any part of the system, 1/s (design choice): faster ones are instantaneous to every servo rate."""

ROWS = ("twist", "motor_speed", "load_speed", "travel")
COLUMNS = ("twist", "motor_speed", "load_speed", "motor_torque", "load_torque")


@dataclass(frozen=True, slots=True)
class ElasticCoupling:
    """Motor and load joined by a spring with damping.

    `drive` chooses what volts are: torque (`torque_per_volt_nm`) or speed (`speed_per_volt_rev_s`, with the loop
    closing in `loop_time_constant_s` on motor and load together). A positive `load_torque_nm` acts on the load against
    positive motion.
    """

    drive: Literal["torque", "velocity"] = "torque"
    torque_per_volt_nm: float = 0.3
    speed_per_volt_rev_s: float = 10.0
    loop_time_constant_s: float = 0.005
    peak_torque_nm: float = math.inf
    motor_inertia_kg_m2: float = 1e-4
    load_inertia_kg_m2: float = 2e-4
    stiffness_nm_per_rad: float = 30.0
    damping_nm_s_per_rad: float = 0.005
    motor_viscous_nm_s_per_rev: float = 1e-3
    load_viscous_nm_s_per_rev: float = 1e-3
    motor_coulomb_nm: float = 0.0
    load_coulomb_nm: float = 0.0
    load_torque_nm: float = 0.0
    backlash_rev: float = 0.0

    def __post_init__(self) -> None:
        if self.drive not in ("torque", "velocity"):
            raise PlantError("drive", repr(self.drive), "torque or velocity")
        require_positive(
            torque_per_volt_nm=self.torque_per_volt_nm,
            speed_per_volt_rev_s=self.speed_per_volt_rev_s,
            loop_time_constant_s=self.loop_time_constant_s,
            motor_inertia_kg_m2=self.motor_inertia_kg_m2,
            load_inertia_kg_m2=self.load_inertia_kg_m2,
            stiffness_nm_per_rad=self.stiffness_nm_per_rad,
        )
        require_positive_or_infinite(peak_torque_nm=self.peak_torque_nm)
        require_not_negative(
            damping_nm_s_per_rad=self.damping_nm_s_per_rad,
            motor_viscous_nm_s_per_rev=self.motor_viscous_nm_s_per_rev,
            load_viscous_nm_s_per_rev=self.load_viscous_nm_s_per_rev,
            motor_coulomb_nm=self.motor_coulomb_nm,
            load_coulomb_nm=self.load_coulomb_nm,
            backlash_rev=self.backlash_rev,
        )
        require_finite(load_torque_nm=self.load_torque_nm)
        self._require_sense()

    def _require_sense(self) -> None:
        """Each value may be possible and the whole still be no elastic coupling."""
        resonance = self.resonance_hz
        if not LOWEST_RESONANCE_HZ <= resonance <= HIGHEST_RESONANCE_HZ:
            raise PlantError(
                "stiffness_nm_per_rad",
                f"{self.stiffness_nm_per_rad:g} (a resonance at {resonance:.3g} Hz)",
                f"such that the resonance lies between {LOWEST_RESONANCE_HZ:g} and {HIGHEST_RESONANCE_HZ:g} Hz",
            )
        lighter = min(self.motor_inertia_kg_m2, self.load_inertia_kg_m2)
        most = FASTEST_RATE_PER_S * lighter
        if self.damping_nm_s_per_rad > most:
            raise PlantError("damping_nm_s_per_rad", self.damping_nm_s_per_rad, f"at most {most:g} on these inertias")
        for name, inertia in (("motor", self.motor_inertia_kg_m2), ("load", self.load_inertia_kg_m2)):
            viscous, most = getattr(self, f"{name}_viscous_nm_s_per_rev"), FASTEST_RATE_PER_S * TURN * inertia
            if viscous > most:
                raise PlantError(f"{name}_viscous_nm_s_per_rev", viscous, f"at most {most:g} on this inertia")
        fastest = self._speed_loop_gain / (TURN * self.motor_inertia_kg_m2)
        if fastest > FASTEST_RATE_PER_S:
            least = self.loop_time_constant_s * fastest / FASTEST_RATE_PER_S
            raise PlantError("loop_time_constant_s", self.loop_time_constant_s, f"at least {least:g} on these inertias")

    @property
    def resonance_hz(self) -> float:
        """Undamped frequency at which motor and load swing against each other, Hz."""
        return math.sqrt(self.stiffness_nm_per_rad * self._inverse_inertia) / TURN

    @property
    def antiresonance_hz(self) -> float:
        """Frequency at which the load alone swings on a motor held fast, Hz."""
        return math.sqrt(self.stiffness_nm_per_rad / self.load_inertia_kg_m2) / TURN

    @property
    def damping_ratio(self) -> float:
        """Damping of the resonance by the coupling alone, 1 = critical."""
        return self.damping_nm_s_per_rad / 2.0 * math.sqrt(self._inverse_inertia / self.stiffness_nm_per_rad)

    @property
    def _inverse_inertia(self) -> float:
        return 1.0 / self.motor_inertia_kg_m2 + 1.0 / self.load_inertia_kg_m2

    @property
    def _speed_loop_gain(self) -> float:
        """Torque of a velocity-mode drive per error of speed, Nm per rev/s; 0 in torque mode."""
        if self.drive == "torque":
            return 0.0
        return TURN * (self.motor_inertia_kg_m2 + self.load_inertia_kg_m2) / self.loop_time_constant_s

    @property
    def play_rev(self) -> float:
        """Play between this and the load, rev."""
        return self.backlash_rev

    @property
    def load_apart(self) -> bool:
        """The load can stand elsewhere than the shaft."""
        return True

    def with_load(self, torque_nm: float) -> ElasticCoupling:
        """The same machine under another load torque."""
        return replace(self, load_torque_nm=torque_nm)

    def with_friction(self, torque_nm: float) -> ElasticCoupling:
        """The same machine with another dry friction of the load."""
        return replace(self, load_coulomb_nm=torque_nm)

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""
        loop_gain = self._speed_loop_gain
        return {
            "kind": ELASTIC_COUPLING,
            "torque_per_volt": self.torque_per_volt_nm if loop_gain == 0.0 else loop_gain * self.speed_per_volt_rev_s,
            "speed_loop_gain": loop_gain,
            "peak_torque": self.peak_torque_nm,
            "load_torque": self.load_torque_nm,
            "coulomb_torque": self.load_coulomb_nm,
            "motor_coulomb_torque": self.motor_coulomb_nm,
            **_named("loose", self._step(period_s, 0.0)),
            **_named("held", self._step(period_s, loop_gain)),
        }

    def _step(self, period_s: float, loop_gain: float) -> Matrix:
        """Rows `ROWS`, columns `COLUMNS`, units rev, s, Nm; both torques forwards."""
        frequency = TURN * self.resonance_hz
        motor, load = TURN * self.motor_inertia_kg_m2, TURN * self.load_inertia_kg_m2
        stiffness, damping = TURN * self.stiffness_nm_per_rad / frequency, TURN * self.damping_nm_s_per_rad
        motor_loss = self.motor_viscous_nm_s_per_rev + loop_gain
        # The twist is counted in units in which it swings as far as the speeds: a balanced matrix loses no digits.
        system = [
            [0.0, frequency, -frequency, 0.0],
            [-stiffness / motor, -(damping + motor_loss) / motor, damping / motor, 0.0],
            [stiffness / load, damping / load, -(damping + self.load_viscous_nm_s_per_rev) / load, 0.0],
            [0.0, frequency, 0.0, 0.0],
        ]
        inputs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]
        step = held_step(system, inputs, period_s)
        lengths = (1.0 / frequency, 1.0, 1.0, 1.0 / frequency)
        causes = (frequency, 1.0, 1.0, None, 1.0 / motor, 1.0 / load)
        return [
            [length * entry * cause for entry, cause in zip(row, causes, strict=True) if cause is not None]
            for length, row in zip(lengths, step, strict=True)
        ]


def _named(prefix: str, rows: Sequence[Sequence[float]]) -> dict[str, float]:
    return {
        f"{prefix}_{row}_per_{column}": entry
        for row, entries in zip(ROWS, rows, strict=True)
        for column, entry in zip(COLUMNS, entries, strict=True)
    }


@seldom
def respond_loose(
    plant: Record, twist: float, motor: float, load: float, motor_torque: float, load_torque: float
) -> tuple[float, float, float, float]:
    """Twist, motor speed, load speed and travel of the motor after a step under given torques."""
    return (
        plant["loose_twist_per_twist"] * twist
        + plant["loose_twist_per_motor_speed"] * motor
        + plant["loose_twist_per_load_speed"] * load
        + plant["loose_twist_per_motor_torque"] * motor_torque
        + plant["loose_twist_per_load_torque"] * load_torque,
        plant["loose_motor_speed_per_twist"] * twist
        + plant["loose_motor_speed_per_motor_speed"] * motor
        + plant["loose_motor_speed_per_load_speed"] * load
        + plant["loose_motor_speed_per_motor_torque"] * motor_torque
        + plant["loose_motor_speed_per_load_torque"] * load_torque,
        plant["loose_load_speed_per_twist"] * twist
        + plant["loose_load_speed_per_motor_speed"] * motor
        + plant["loose_load_speed_per_load_speed"] * load
        + plant["loose_load_speed_per_motor_torque"] * motor_torque
        + plant["loose_load_speed_per_load_torque"] * load_torque,
        plant["loose_travel_per_twist"] * twist
        + plant["loose_travel_per_motor_speed"] * motor
        + plant["loose_travel_per_load_speed"] * load
        + plant["loose_travel_per_motor_torque"] * motor_torque
        + plant["loose_travel_per_load_torque"] * load_torque,
    )


@seldom
def respond_held(
    plant: Record, twist: float, motor: float, load: float, motor_torque: float, load_torque: float
) -> tuple[float, float, float, float]:
    """The same with the speed loop closed: its command comes as the torque it would ask for at rest."""
    return (
        plant["held_twist_per_twist"] * twist
        + plant["held_twist_per_motor_speed"] * motor
        + plant["held_twist_per_load_speed"] * load
        + plant["held_twist_per_motor_torque"] * motor_torque
        + plant["held_twist_per_load_torque"] * load_torque,
        plant["held_motor_speed_per_twist"] * twist
        + plant["held_motor_speed_per_motor_speed"] * motor
        + plant["held_motor_speed_per_load_speed"] * load
        + plant["held_motor_speed_per_motor_torque"] * motor_torque
        + plant["held_motor_speed_per_load_torque"] * load_torque,
        plant["held_load_speed_per_twist"] * twist
        + plant["held_load_speed_per_motor_speed"] * motor
        + plant["held_load_speed_per_load_speed"] * load
        + plant["held_load_speed_per_motor_torque"] * motor_torque
        + plant["held_load_speed_per_load_torque"] * load_torque,
        plant["held_travel_per_twist"] * twist
        + plant["held_travel_per_motor_speed"] * motor
        + plant["held_travel_per_load_speed"] * load
        + plant["held_travel_per_motor_torque"] * motor_torque
        + plant["held_travel_per_load_torque"] * load_torque,
    )


@kernel
def respond(
    held: bool, plant: Record, twist: float, motor: float, load: float, motor_torque: float, load_torque: float
) -> tuple[float, float, float, float]:
    """The step with the speed loop closed or not."""
    if held:
        return respond_held(plant, twist, motor, load, motor_torque, load_torque)
    return respond_loose(plant, twist, motor, load, motor_torque, load_torque)


@kernel
def holding_torque(speed: float, speed_per_torque: float, coulomb: float) -> float:
    """The dry friction, within +-`coulomb`, that takes away a speed an inertia would have at the end of the step."""
    if speed > coulomb * speed_per_torque:
        return -coulomb
    if speed < -coulomb * speed_per_torque:
        return coulomb
    return -speed / speed_per_torque


@kernel
def within(value: float, limit: float) -> float:
    """`value` held within +-`limit`."""
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


@seldom
def step_elastic_coupling(axis: Record, plant: Record, volts: float) -> None:
    """Advance motor and load by one step with the output held.

    A velocity-mode drive whose mean torque over the step would exceed the peak gives the peak throughout.
    """
    twist, motor, load = axis["twist"], axis["true_velocity"], axis["load_velocity"]
    load_torque = -plant["load_torque"]
    peak = plant["peak_torque"]
    loop_gain = plant["speed_loop_gain"]
    torque = volts * plant["torque_per_volt"]
    held = loop_gain != 0.0 and axis["enabled"] != 0
    if held:
        travel = respond_held(plant, twist, motor, load, torque, load_torque)[3]
        mean_torque = torque - loop_gain * travel / plant["period_s"]
        if abs(mean_torque) > peak:
            held = False
            torque = peak if mean_torque > 0.0 else -peak
    elif axis["enabled"] != 0:
        torque = within(torque, peak)
    else:
        torque = 0.0
    end_twist, end_motor, end_load, travel = respond(held, plant, twist, motor, load, torque, load_torque)
    if plant["motor_coulomb_torque"] != 0.0 or plant["coulomb_torque"] != 0.0:
        gain = plant["held_motor_speed_per_motor_torque"] if held else plant["loose_motor_speed_per_motor_torque"]
        on_motor = holding_torque(end_motor, gain, plant["motor_coulomb_torque"])
        gain = plant["held_load_speed_per_load_torque"] if held else plant["loose_load_speed_per_load_torque"]
        on_load = holding_torque(end_load, gain, plant["coulomb_torque"])
        by_twist, by_motor, by_load, by_travel = respond(held, plant, 0.0, 0.0, 0.0, on_motor, on_load)
        end_twist += by_twist
        end_motor += by_motor
        end_load += by_load
        travel += by_travel
    axis["twist"] = end_twist
    axis["true_velocity"] = end_motor
    axis["load_velocity"] = end_load
    axis["true_position"] += travel

"""The far end of the machine: where the load is when it is not simply where the motor is, and where travel ends.

Behind a springy shaft or a gear with play the load is somewhere else than the motor's shaft. Switches and the analogue
sensor sit at the load, the encoder at either. Play is pure hysteresis: what lies behind it has no inertia of its own
and stays where it was left until the play is used up.
"""

from __future__ import annotations

from typing import Protocol

from ..kernels import Record, kernel

WORLD_END_REV = 1e9
"""Where every axis ends, +-rev: a wall that stops it dead (design choice).

A runaway must end somewhere before its position outgrows the counter; at 200 rev/s this takes two months.
"""


class Driven(Protocol):
    """What every plant says about itself to the engine."""

    @property
    def play_rev(self) -> float:
        """Play between this and the load, rev."""

    @property
    def load_apart(self) -> bool:
        """The load can stand elsewhere than the shaft."""

    def fields(self, period_s: float) -> dict[str, float]:
        """Fields of a plant record for a step of `period_s`."""


def plant_fields(plant: Driven, period_s: float) -> dict[str, float]:
    """All that is to be written into the plant record for a step of `period_s` seconds, which may be 0: no step."""
    return {"period_s": period_s, **(plant.fields(period_s) if period_s > 0.0 else {})}


def load_fields(plant: Driven) -> dict[str, float]:
    """What the axis record says about the load of a plant."""
    return {"load_apart": plant.load_apart, "half_backlash": 0.5 * plant.play_rev}


@kernel
def keep_in_world(axis: Record) -> None:
    """Stop a runaway axis at the end of its world."""
    if abs(axis["true_position"]) > WORLD_END_REV:
        axis["true_position"] = WORLD_END_REV if axis["true_position"] > 0.0 else -WORLD_END_REV
        axis["true_velocity"] = 0.0


@kernel
def drag_load(axis: Record) -> None:
    """Take the load along behind the twisted shaft and the play."""
    shaft = axis["true_position"] - axis["twist"]
    load = axis["load_position"]
    if load > shaft + axis["half_backlash"]:
        load = shaft + axis["half_backlash"]
    if load < shaft - axis["half_backlash"]:
        load = shaft - axis["half_backlash"]
    if load > WORLD_END_REV:
        load = WORLD_END_REV
    if load < -WORLD_END_REV:
        load = -WORLD_END_REV
    axis["load_position"] = load


@kernel
def place_of_load(axis: Record) -> float:
    """Where the load is, rev; a rigid one where the shaft is."""
    return float(axis["load_position"] if axis["load_apart"] != 0 else axis["true_position"])

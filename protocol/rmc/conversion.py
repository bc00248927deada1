"""Gains of the older RMC100 as those of an RMC75 or RMC150 (F rmc100-to-rmc75-or-rmc150-gain-conversion).

`N` and `L` of that thread are taken to be counts of the RMC100's transducer and the position-units they make
(inferred); their ratio is all that enters but for the plain factors.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rmc100Gains:
    """Gains in the RMC100's units."""

    proportional: float = 0.0
    integral: float = 0.0
    differential: float = 0.0
    velocity_ff: float = 0.0
    acceleration_ff: float = 0.0


@dataclass(frozen=True, slots=True)
class Gains:
    """Gains in percent per position-unit and so on."""

    proportional: float
    integral: float
    differential: float
    velocity_ff: float
    acceleration_ff: float


def from_rmc100(old: Rmc100Gains, *, counts: float, length: float, loops_per_s: float) -> Gains:
    """The same gains, `counts` of the transducer being `length` position-units."""
    scale = counts / length
    return Gains(
        proportional=scale * old.proportional / 100.0,
        integral=loops_per_s * scale * old.integral / 102_400.0,
        differential=scale * old.differential / 102_400.0,
        velocity_ff=scale * old.velocity_ff / 10_000.0,
        acceleration_ff=scale * old.acceleration_ff / 1e6,
    )

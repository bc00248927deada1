"""The three periods of the unit's clockwork: servo sample, trajectory update, system update.

The signal processor computes both the control signal and the commanded position, so sampling faster leaves less time
for the trajectory; `SSFR` chooses the ratio and the number of participating axes (`INDAX`) sets how much there is to
do. Commands, inputs, outputs and status are handled at system updates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

NS_PER_US = 1_000
NS_PER_S = 1_000_000_000


@dataclass(frozen=True, slots=True)
class ServoRates:
    """Periods of one unit, nested exactly: a system update is also a trajectory update and a servo sample."""

    servo_ns: int
    samples_per_trajectory: int
    trajectories_per_system: int

    def __post_init__(self) -> None:
        if min(self.servo_ns, self.samples_per_trajectory, self.trajectories_per_system) < 1:
            raise ValueError(f"servo rates must be positive: {self}")

    @property
    def trajectory_ns(self) -> int:
        """Period of the motion trajectory update, ns."""
        return self.servo_ns * self.samples_per_trajectory

    @property
    def system_ns(self) -> int:
        """Period of the system update, ns."""
        return self.trajectory_ns * self.trajectories_per_system

    @classmethod
    def from_us(cls, *, servo_us: int, trajectory_us: int, system_us: int) -> ServoRates:
        """Rates from a row of the table, in microseconds; ValueError if the periods do not nest exactly."""
        if trajectory_us % servo_us or system_us % trajectory_us:
            raise ValueError(f"periods {servo_us}, {trajectory_us}, {system_us} us do not divide one another")
        return cls(servo_us * NS_PER_US, trajectory_us // servo_us, system_us // trajectory_us)


RateTable: TypeAlias = Mapping[tuple[int, int], ServoRates]


def _rows(axes: int, rows: tuple[tuple[int, int, int, int], ...]) -> dict[tuple[int, int], ServoRates]:
    return {
        (axes, ssfr): ServoRates.from_us(servo_us=servo, trajectory_us=trajectory, system_us=system)
        for ssfr, servo, trajectory, system in rows
    }


# Documented for the one-axis sister unit, APEX615n Installation Guide p. 83; taken over for INDAX1 (assumed, high).
ONE_AXIS_ROWS = ((1, 330, 330, 1320), (2, 185, 370, 1480), (4, 160, 640, 1920), (8, 150, 1200, 2400))

# No page survives for two axes: assumed, low confidence. Columns: SSFR, servo, trajectory, system update (us).
TWO_AXIS_ROWS = ((1, 580, 580, 2320), (2, 325, 650, 1950), (4, 280, 1120, 2240), (8, 265, 2120, 2120))

RATES: RateTable = MappingProxyType(_rows(1, ONE_AXIS_ROWS) | _rows(2, TWO_AXIS_ROWS))


def rates_for(indax: int, ssfr: int, table: RateTable = RATES) -> ServoRates:
    """The rates of `INDAX` (1, 2) and `SSFR` (1, 2, 4, 8); ValueError for a pair the table does not have."""
    try:
        return table[indax, ssfr]
    except KeyError:
        raise ValueError(f"no servo rates for INDAX{indax} SSFR{ssfr}") from None

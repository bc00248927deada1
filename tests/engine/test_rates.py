"""The SSFR and INDAX table."""

import pytest

from emulator.engine import RATES, ServoRates, rates_for


@pytest.mark.parametrize(
    ("indax", "ssfr", "servo_us", "trajectory_us", "system_us"),
    [
        (1, 1, 330, 330, 1320),
        (1, 2, 185, 370, 1480),
        (1, 4, 160, 640, 1920),
        (1, 8, 150, 1200, 2400),
        (2, 1, 580, 580, 2320),
        (2, 2, 325, 650, 1950),
        (2, 4, 280, 1120, 2240),
        (2, 8, 265, 2120, 2120),
    ],
)
def test_periods(indax: int, ssfr: int, servo_us: int, trajectory_us: int, system_us: int) -> None:
    rates = rates_for(indax, ssfr)
    assert rates.servo_ns == servo_us * 1000
    assert rates.trajectory_ns == trajectory_us * 1000
    assert rates.system_ns == system_us * 1000
    assert rates.samples_per_trajectory == ssfr


def test_a_table_of_ones_own_replaces_the_rows() -> None:
    row = ServoRates.from_us(servo_us=100, trajectory_us=400, system_us=2000)
    assert rates_for(2, 4, {**RATES, (2, 4): row}).system_ns == 2_000_000


def test_unknown_pairs_and_periods_that_do_not_nest_are_refused() -> None:
    with pytest.raises(ValueError, match="INDAX3 SSFR4"):
        rates_for(3, 4)
    with pytest.raises(ValueError, match="do not divide"):
        ServoRates.from_us(servo_us=300, trajectory_us=1000, system_us=2000)

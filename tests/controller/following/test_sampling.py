"""Master position sampling in the running unit: the lag without prediction, none with it, the filter's own.

The figures are those of the 6000 Series Programmer's Guide p.214 and what follows from it: two sample periods of the
slave's velocity.
"""

from __future__ import annotations

import math

import pytest

from tests.controller.following.rig import FollowingRig

RATES = """
[servo.ssfr_table]
indax2 = [
    {{ ssfr = 1, servo_us = {us}, trajectory_us = {us}, system_us = {us} }},
    {{ ssfr = 2, servo_us = 325, trajectory_us = 650, system_us = 1950 }},
    {{ ssfr = 4, servo_us = 280, trajectory_us = 1120, system_us = 2240 }},
    {{ ssfr = 8, servo_us = 265, trajectory_us = 2120, system_us = 2120 }},
]
"""

UPDATES = 40


def lag(rig: FollowingRig, step: int) -> float:
    """Master position less slave position while the master makes ``step`` counts in every system update."""
    *_, position = rig.turn([step] * UPDATES)
    return rig.master_counts - position


def at_ratio_one(*commands: str, **options: object) -> FollowingRig:
    rig = FollowingRig("MC1", "FOLMD0", "SMPER0", *commands, **options)  # type: ignore[arg-type]
    rig.ok("1GO1")
    return rig


@pytest.mark.parametrize(
    ("period_us", "velocity", "lag_counts"),
    [(2000, 25_000, 100), (1000, 25_000, 50), (1700, 40_000, 136), (1320, 100_000, 264)],
)
def test_without_prediction_the_slave_lags_two_sample_periods(period_us: int, velocity: int, lag_counts: int) -> None:
    step = velocity * period_us // 1_000_000
    machine = RATES.format(us=period_us)
    rig = at_ratio_one("1FPPEN0", machine=machine, update_ns=1000 * period_us, SSFR=1)
    assert lag(rig, step) == lag_counts
    assert rig.look("1TVMAS") == f"1TVMAS+{velocity}.0000"


@pytest.mark.parametrize(
    ("ssfr", "update_us", "lag_counts"), [(1, 1320, 66), (2, 1480, 74), (4, 1920, 96), (8, 2400, 120)]
)
def test_the_sample_period_is_the_system_update_of_one_axis(ssfr: int, update_us: int, lag_counts: int) -> None:
    """25000 counts/s at the rates of the APEX guide p.83."""
    rig = at_ratio_one("1FPPEN0", update_ns=1000 * update_us, SSFR=ssfr, INDAX=1)
    assert lag(rig, 25 * update_us // 1000) == lag_counts


def test_the_default_rates_of_two_axes() -> None:
    """SSFR4: 2240 us, 112 counts at 25000 counts/s."""
    assert lag(at_ratio_one("1FPPEN0"), 56) == 112


@pytest.mark.parametrize("step", [1, 56, -56, 200])
def test_prediction_leaves_no_lag_at_constant_velocity(step: int) -> None:
    assert lag(at_ratio_one(), step) == 0


def test_the_lag_is_that_of_the_slaves_velocity() -> None:
    rig = at_ratio_one("1FPPEN0", "FOLRN3")
    *_, position = rig.turn([40] * UPDATES)
    assert 3 * rig.master_counts - position == 3 * 80


def test_prediction_errs_under_acceleration() -> None:
    """2 m(k) - m(k-2), reached two updates later: for steps that grow by a each update it is 4 a behind."""
    rig = at_ratio_one()
    growth = 3
    *_, position = rig.turn([growth * update for update in range(UPDATES)])
    assert rig.master_counts - position == 4 * growth


@pytest.mark.parametrize(("ffilt", "corner_hz"), [(1, 120.0), (2, 80.0), (3, 50.0), (4, 20.0)])
@pytest.mark.parametrize("prediction", [0, 1])
def test_the_filter_lags_whether_predicted_or_not(ffilt: int, corner_hz: float, prediction: int) -> None:
    """First order behind a ramp: v Ts d / (1 - d) with d = exp(-2 pi f Ts); prediction does not take it away."""
    rig = at_ratio_one(f"FFILT{ffilt}", f"1FPPEN{prediction}")
    step = 56
    decay = math.exp(-2 * math.pi * corner_hz * rig.update_ns / 1e9)
    expected = step * decay / (1 - decay) + (0 if prediction else 2 * step)
    *_, position = rig.turn([step] * 200)
    assert rig.master_counts - position == pytest.approx(expected, abs=1)


def test_a_filtered_slave_arrives_where_its_master_stops() -> None:
    rig = at_ratio_one("FFILT4")
    rig.travel(5000)
    *_, position = rig.turn([0] * 200)
    assert position == 5000


def swing(rig: FollowingRig) -> int:
    """How far the slave swings under a master that shakes by 20 counts, 50 to 100 updates on."""
    positions = list(rig.turn([20, -20] * 50))[50:]
    return max(positions) - min(positions)


def test_a_rough_master_makes_a_rough_slave_unless_filtered() -> None:
    """Prediction doubles what it sees, the filter takes it away."""
    rough, plain, smooth = swing(at_ratio_one()), swing(at_ratio_one("1FPPEN0")), swing(at_ratio_one("FFILT4"))
    assert smooth < plain <= rough


def test_a_master_that_is_a_commanded_position() -> None:
    """Axis 2 moves at 25000 counts/s; at the end the slave is where the master is."""
    rig = FollowingRig("MC1", "FOLMD0", "2DRIVE1", "2V6.25", "2A100")
    rig.ok("1FOLEN0", "1FOLMAS+24", "1FOLEN1", "1GO1", "2MC0", "2D50000", "2GO")
    rig.advance(1.0)
    behind = rig.position(2) - rig.position(1)
    assert abs(behind) <= 56
    assert float(rig.look("1TVMAS").removeprefix("1TVMAS")) == pytest.approx(25_000, abs=500)
    rig.until_rest(2)
    rig.advance(0.1)
    assert (rig.position(1), rig.position(2)) == (50_000, 50_000)


def test_an_ani_master_counts_the_converter() -> None:
    """819 counts a volt (6000 Programmer's Guide p.196)."""
    rig = FollowingRig("1FOLEN0", machine="[options]\nani = true")
    rig.unit.do("force_ani", axis=2, volts=0.0)
    rig.advance(0.1)
    rig.ok("1FOLMAS+22", "1FOLEN1", "MC1", "FOLMD0", "1GO1")
    rig.unit.do("force_ani", axis=2, volts=2.0)
    rig.advance(0.1)
    assert rig.position() == 1638


def test_pset_of_the_master_moves_no_slave() -> None:
    rig = at_ratio_one()
    rig.travel(1000)
    rig.ok("2DRIVE1", "2PSET77777")
    rig.advance(0.1)
    assert rig.position() == pytest.approx(1000, abs=2)
    assert abs(int(rig.look("1TPMAS").removeprefix("1TPMAS")) - 1000) <= 2

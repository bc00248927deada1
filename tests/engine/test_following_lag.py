"""How far a slave is behind its master: two sample periods without prediction, none with it, and what filters add."""

from __future__ import annotations

import math
import statistics

import pytest

from emulator.engine import RATES, AxisHardware, EncoderMotion, EncoderTraits, MasterMeasurement, ServoRates
from tests.engine.following_rig import Gearing

RATE_ROWS = [pytest.param(rates, id=f"INDAX{indax} SSFR{ssfr}") for (indax, ssfr), rates in RATES.items()]
VELOCITY_COUNTS_S = 25_000.0


def system_period(system_us: int) -> ServoRates:
    return ServoRates.from_us(servo_us=system_us // 4, trajectory_us=system_us // 2, system_us=system_us // 4 * 4)


def run_at(gearing: Gearing, velocity_counts_s: float, updates: int = 60) -> None:
    """A master of constant velocity, its counts those an ideal encoder shows."""
    step = velocity_counts_s * gearing.period_s
    gearing.turn_to(math.floor(step * k + 1e-6) for k in range(1, updates + 1))


@pytest.mark.parametrize("rates", RATE_ROWS)
@pytest.mark.parametrize("sign", [1, -1])
def test_two_sample_periods_without_prediction(rates: ServoRates, sign: int) -> None:
    gearing = Gearing(rates=rates, prediction=False)
    gearing.at_ratio(1)
    run_at(gearing, sign * VELOCITY_COUNTS_S)
    lag = gearing.master - gearing.slave
    assert lag == pytest.approx(sign * 2 * gearing.period_s * VELOCITY_COUNTS_S, abs=1)


@pytest.mark.parametrize("rates", RATE_ROWS)
@pytest.mark.parametrize("sign", [1, -1])
def test_none_with_prediction(rates: ServoRates, sign: int) -> None:
    gearing = Gearing(rates=rates)
    gearing.at_ratio(1)
    run_at(gearing, sign * VELOCITY_COUNTS_S)
    whole_counts = (VELOCITY_COUNTS_S * gearing.period_s).is_integer()
    assert abs(gearing.master - gearing.slave) <= (0 if whole_counts else 2), "only the master's own counts are rounded"


@pytest.mark.parametrize(
    ("system_us", "velocity_counts_s", "lag"),
    [(2000, 25_000, 100), (1000, 25_000, 50), (1700, 40_000, 136), (1320, 100_000, 264)],
)
def test_lags_the_guide_and_its_table_name(system_us: int, velocity_counts_s: float, lag: int) -> None:
    for prediction, expected in ((False, lag), (True, 0)):
        gearing = Gearing(rates=system_period(system_us), prediction=prediction)
        gearing.at_ratio(1)
        run_at(gearing, velocity_counts_s)
        assert gearing.master - gearing.slave == expected


@pytest.mark.parametrize("acceleration", [100, -60, 7])
def test_prediction_errs_by_four_a_ts_squared_under_acceleration(acceleration: int) -> None:
    """m(k+2) - (2 m(k) - m(k-2)) of m = a k^2 / 2 counts, a in counts per sample squared."""
    gearing = Gearing()
    gearing.at_ratio(1)
    gearing.turn_to(acceleration * k * k // 2 for k in range(1, 40))
    assert abs(gearing.master - gearing.slave - 4 * acceleration) <= 2


def test_without_prediction_the_slave_is_exactly_two_samples_behind() -> None:
    gearing = Gearing(prediction=False)
    gearing.at_ratio(1)
    places = [3 * k * k - 40 * k for k in range(1, 40)]
    seen = []
    for place in places:
        gearing.turn_to([place])
        seen.append(gearing.slave)
    assert seen[2:] == places[:-2]


@pytest.mark.parametrize("corner_hz", [120.0, 80.0, 50.0, 20.0])
@pytest.mark.parametrize("prediction", [True, False])
def test_a_filter_adds_its_lag_which_prediction_does_not_take_away(corner_hz: float, prediction: bool) -> None:
    """The discrete filter's own steady lag, v Ts d / (1 - d) with d = exp(-Ts / tau); near v tau for Ts below tau."""
    gearing = Gearing(prediction=prediction, corner_hz=corner_hz)
    gearing.at_ratio(1)
    run_at(gearing, VELOCITY_COUNTS_S, updates=100)
    step = VELOCITY_COUNTS_S * gearing.period_s
    tau_s = 1 / (2 * math.pi * corner_hz)
    decay = math.exp(-gearing.period_s / tau_s)
    lag = step * decay / (1 - decay)
    assert lag == pytest.approx(VELOCITY_COUNTS_S * tau_s, abs=0.55 * step), "less than a sample from v tau"
    assert gearing.master - gearing.slave == pytest.approx(lag + (0 if prediction else 2 * step), abs=1)


def test_a_filtered_slave_arrives_where_its_resting_master_is() -> None:
    gearing = Gearing(corner_hz=20.0)
    gearing.at_ratio(3)
    run_at(gearing, VELOCITY_COUNTS_S)
    gearing.pass_updates(200)
    assert gearing.slave == 3 * gearing.master


def test_between_system_updates_the_slave_goes_in_a_straight_line() -> None:
    rates = ServoRates(servo_ns=250_000, samples_per_trajectory=2, trajectories_per_system=4)
    gearing = Gearing(rates=rates, prediction=False)
    gearing.at_ratio(1)
    gearing.turn(400, 80, 0)
    seen = []
    for _ in range(8):
        gearing.engine.run(gearing.engine.next_trajectory_ns)
        seen.append((gearing.slave, gearing.engine.commanded_velocity(0)))
    assert [position for position, _ in seen] == [420, 440, 460, 480, 480, 480, 480, 480]
    assert [velocity for _, velocity in seen] == [40_000.0] * 4 + [0.0] * 4


@pytest.mark.parametrize("acceleration", [100, -60])
def test_prediction_from_one_sample_errs_by_three_a_ts_squared(acceleration: int) -> None:
    """m(k+2) - (3 m(k) - 2 m(k-1)) of m = a k^2 / 2."""
    gearing = Gearing(measurement=MasterMeasurement(one_sample_predictor=True))
    gearing.at_ratio(1)
    gearing.turn_to(acceleration * k * k // 2 for k in range(1, 40))
    assert gearing.master - gearing.slave == 3 * acceleration


@pytest.mark.parametrize("corner_hz", [50.0, 20.0])
@pytest.mark.parametrize("order", [1, 2])
def test_a_filter_of_either_order_passes_its_corner_at_minus_3_db(corner_hz: float, order: int) -> None:
    """A fast system update, so that the discrete filter is near the continuous one."""
    gearing = Gearing(rates=system_period(200), corner_hz=corner_hz, measurement=MasterMeasurement(filter_order=order))
    gearing.at_ratio(1)
    periods = 5
    updates = round(periods / corner_hz / gearing.period_s)
    seen = []
    for k in range(1, updates + 1):
        gearing.turn_to([round(100_000 * math.sin(2 * math.pi * corner_hz * k * gearing.period_s))])
        seen.append(gearing.slave)
    assert max(seen[updates // 2 :]) == pytest.approx(100_000 / math.sqrt(2), rel=0.03)


def noisy_gearing(*, prediction: bool, corner_hz: float | None = None) -> Gearing:
    encoder = EncoderTraits(noise_counts_rms=50.0, noise_seed=7)
    hardware = AxisHardware(encoder=encoder, motion=EncoderMotion())
    gearing = Gearing(prediction=prediction, corner_hz=corner_hz, master=hardware)
    gearing.at_ratio(1)
    return gearing


@pytest.mark.parametrize(
    ("prediction", "corner_hz", "gain"),
    [(False, None, 1.0), (True, None, math.sqrt(5)), (False, 20.0, None), (False, 80.0, None)],
)
def test_prediction_makes_a_noisy_master_rougher_and_a_filter_smoother(
    prediction: bool, corner_hz: float | None, gain: float | None
) -> None:
    """White noise: 2 m(k) - m(k-2) has five times the variance, a first-order low-pass (1 - d) / (1 + d) of it."""
    gearing = noisy_gearing(prediction=prediction, corner_hz=corner_hz)
    seen = []
    for _ in range(3000):
        gearing.pass_updates(1)
        seen.append(gearing.slave)
    if corner_hz is not None:
        decay = math.exp(-2 * math.pi * corner_hz * gearing.period_s)
        gain = math.sqrt((1 - decay) / (1 + decay))
    assert gain is not None
    assert statistics.pstdev(seen) == pytest.approx(50.0 * gain, rel=0.08)


@pytest.mark.parametrize("rates", RATE_ROWS)
def test_lags_behind_a_conveyor_of_the_machine_file(rates: ServoRates) -> None:
    """The running system: an encoder that turns in time, sampled, followed by the commanded position."""
    hardware = AxisHardware(motion=EncoderMotion(VELOCITY_COUNTS_S))
    for prediction, lag in ((False, 2 * rates.system_ns * 1e-9 * VELOCITY_COUNTS_S), (True, 0.0)):
        gearing = Gearing(rates=rates, prediction=prediction, master=hardware)
        gearing.at_ratio(1)
        gearing.pass_updates(40)
        assert gearing.engine.master_counts(0) - gearing.slave == pytest.approx(lag, abs=2 if prediction else 1)

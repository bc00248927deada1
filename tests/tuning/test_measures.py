"""Measures of step responses against closed forms and hand-made recordings."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.tuning.measures import NAMES, StepMeasures, measure_step, measure_steps

DT = 1e-4


def second_order(zeta: float, omega: float, times: np.ndarray, step: float = 100.0) -> np.ndarray:
    """Step response of omega^2 / (s^2 + 2 zeta omega s + omega^2) for zeta below 1."""
    damped = omega * math.sqrt(1.0 - zeta**2)
    wave = np.cos(damped * times) + zeta * omega / damped * np.sin(damped * times)
    return step * (1.0 - np.exp(-zeta * omega * times) * wave)


def ideal_step(times: np.ndarray, setpoint: float) -> np.ndarray:
    command = np.full_like(times, setpoint)
    command[0] = 0.0
    return command


def measured(times: np.ndarray, actual: np.ndarray, setpoint: float = 100.0, **band: float) -> StepMeasures:
    output = np.zeros_like(times)
    return measure_step(times, ideal_step(times, setpoint), actual, output, start=0.0, setpoint=setpoint, **band)


@pytest.mark.parametrize("zeta", [0.2, 0.4, 0.6, 0.8])
@pytest.mark.parametrize("setpoint", [100.0, -250.0])
def test_second_order_response_has_the_textbook_overshoot_and_passes_the_setpoint_when_it_should(
    zeta: float, setpoint: float
) -> None:
    """Overshoot exp(-pi zeta / sqrt(1 - zeta^2)); first crossing at (pi - acos zeta) / omega_d."""
    omega = 60.0
    times = np.arange(0.0, 2.0, DT)
    found = measured(times, second_order(zeta, omega, times, setpoint), setpoint)
    root = math.sqrt(1.0 - zeta**2)
    assert found.overshoot_percent == pytest.approx(100.0 * math.exp(-math.pi * zeta / root), rel=1e-3)
    assert found.rise_s == pytest.approx((math.pi - math.acos(zeta)) / (omega * root), abs=1.5 * DT)
    assert found.settled


def test_first_order_response_times_are_logarithms_and_it_never_passes_the_setpoint() -> None:
    tau = 0.02
    times = np.arange(0.0, 0.5, DT)
    found = measured(times, 100.0 * (1.0 - np.exp(-times / tau)), settle_percent=5.0)
    assert found.rise_s == math.inf
    assert found.overshoot_percent == 0.0
    assert found.time_to_half_s == pytest.approx(tau * math.log(2.0), abs=1.5 * DT)
    assert found.time_to_90_s == pytest.approx(tau * math.log(10.0), abs=1.5 * DT)
    assert found.settling_s == pytest.approx(tau * math.log(20.0), abs=2.5 * DT)


def test_settling_counts_from_when_the_commanded_position_arrives() -> None:
    rows = np.arange(100)
    times = rows * 0.01
    commanded = np.clip(rows * 5, 0, 100)
    actual = np.clip((rows - 10) * 5, 0, 100)
    found = measure_step(times, commanded, actual, np.zeros(100), start=0.0, setpoint=100.0, settle_counts=0.5)
    assert found.settling_s == pytest.approx(0.1, abs=1e-9)
    assert found.rise_s == pytest.approx(0.3, abs=1e-9)


def test_times_count_from_the_last_row_before_the_command_moves() -> None:
    times = np.arange(10) * 0.1
    commanded = np.array([0, 0, 0, 50, 100, 100, 100, 100, 100, 100])
    actual = np.array([0, 0, 0, 0, 50, 100, 100, 100, 100, 100])
    found = measure_step(times, commanded, actual, np.zeros(10), start=0, setpoint=100)
    assert found.rise_s == pytest.approx(0.3)
    assert found.settling_s == pytest.approx(0.1)


def test_resting_part_is_the_last_three_tenths() -> None:
    times = np.arange(100) * 1e-3
    actual, output = np.full(100, 97.0), np.zeros(100)
    output[5], output[69] = -8.0, 3.0
    output[70:] = np.tile([0.1, -0.15], 15)
    actual[70:] = np.tile([98.0, 99.0], 15)
    found = measure_step(times, ideal_step(times, 100.0), actual, output, start=0, setpoint=100)
    assert found.peak_output_v == 8.0
    assert found.ripple_v == pytest.approx(0.25)
    assert found.steady_error_counts == pytest.approx(1.5)
    assert found.resting_swing_counts == 1.0


def test_an_oscillation_never_settles_even_if_the_recording_ends_at_the_setpoint() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    actual = 100.0 + 20.0 * np.sin(2 * math.pi * 25.0 * times + 0.01)
    actual[-1] = 100.0
    found = measured(times, actual)
    assert found.settling_s == math.inf
    assert not found.settled


def test_an_axis_that_stays_where_it_is_reaches_nothing() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    found = measured(times, np.zeros_like(times))
    assert (found.rise_s, found.time_to_90_s, found.settling_s) == (math.inf,) * 3
    assert found.overshoot_percent == 0.0
    assert found.steady_error_counts == 100.0


def test_a_command_that_never_arrives_leaves_nothing_to_settle_from() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    found = measure_step(times, np.zeros(1000), np.full(1000, 100.0), np.zeros(1000), start=0, setpoint=100)
    assert found.settling_s == math.inf


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"setpoint": 0.0}, "no length"),
        ({"setpoint": math.nan}, "no length"),
        ({"settle_counts": 1.0, "settle_percent": 1.0}, "not both"),
        ({"settle_counts": -1.0}, "not possible"),
        ({"settle_percent": math.nan}, "not possible"),
        ({"times_s": np.zeros(0)}, "no rows"),
        ({"actual": np.zeros(9)}, "do not fit"),
    ],
)
def test_what_cannot_be_measured_is_refused(changed: dict[str, object], message: str) -> None:
    arguments: dict[str, object] = {
        "times_s": np.arange(10.0), "commanded": np.zeros(10), "actual": np.zeros(10), "output_v": np.zeros(10),
        "start": 0.0, "setpoint": 100.0,
    }  # fmt: skip
    with pytest.raises(ValueError, match=message):
        measure_step(**{**arguments, **changed})  # type: ignore[arg-type]


recordings = st.lists(
    st.tuples(st.integers(-300, 300), st.floats(-10.0, 10.0, allow_subnormal=False)), min_size=1, max_size=40
)


@given(recordings, st.integers(-200, 200).filter(bool), st.floats(0.0, 50.0))
def test_measures_agree_with_a_plain_loop_over_the_rows(
    rows: list[tuple[int, float]], setpoint: int, band: float
) -> None:
    times = np.arange(len(rows)) * 0.5
    actual, output = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    found = measure_step(
        times, ideal_step(times, setpoint), actual, output, start=0, setpoint=setpoint, settle_counts=band
    )
    sign = 1 if setpoint > 0 else -1
    beyond = max(sign * (int(x) - setpoint) for x in actual)
    assert found.overshoot_percent == pytest.approx(100.0 * max(0, beyond) / abs(setpoint))
    passes = [time for time, x in zip(times, actual, strict=True) if sign * (x - setpoint) >= 0]
    assert found.rise_s == (passes[0] if passes else math.inf)
    assert found.peak_output_v == max(abs(v) for v in output)
    if found.settled:
        settled_at = found.settling_s + times[min(1, len(rows) - 1)]
        later = [x for time, x in zip(times, actual, strict=True) if time >= settled_at]
        assert all(abs(x - setpoint) <= band for x in later)


@given(st.integers(1, 5), st.integers(5, 30), st.randoms(use_true_random=False))
def test_a_batch_measures_each_lane_as_if_it_were_alone(lanes: int, rows: int, random: object) -> None:
    generator = np.random.default_rng(random.getrandbits(32))  # type: ignore[attr-defined]
    times = np.arange(rows) * 1e-3
    commanded = np.minimum(np.arange(rows) * 40, 100)
    actual = generator.integers(-150, 150, (lanes, rows))
    output = generator.uniform(-10, 10, (lanes, rows))
    batch = measure_steps(times, commanded[np.newaxis], actual, output, start=0, setpoint=100)
    for lane in range(lanes):
        alone = measure_step(times, commanded, actual[lane], output[lane], start=0, setpoint=100)
        assert batch.lane(lane) == alone
    assert set(batch.columns) == set(NAMES)

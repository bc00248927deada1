"""Three real rates: the command moves at trajectory updates, the loop closes at servo samples, and both show.

More servo samples to a trajectory update (SSFR) close the loop faster and make the command's steps longer (APEX p.83).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from emulator.engine import Engine, Gains, ServoRates, VelocityDrive, plan_continuous, rates_for
from emulator.engine.trace import Source
from tests.engine.loop_model import COUNTS_PER_REV, LoopModel, closed_loop_response, recorded_step, run_for

MakeEngine = Callable[..., Engine]

EVERY_RATE = pytest.mark.parametrize(("indax", "ssfr"), [(indax, ssfr) for indax in (1, 2) for ssfr in (1, 2, 4, 8)])

VELOCITY = 100_000.0
FREE = VelocityDrive(max_acceleration_rev_s2=math.inf)
GAINS = Gains(4.0, 0.0, 10.0)
STEP_COUNTS, SAMPLES = 2000, 4096


def seconds(period_ns: int) -> float:
    return period_ns * 1e-9


@EVERY_RATE
def test_the_command_is_a_staircase_of_trajectory_updates(make_engine: MakeEngine, indax: int, ssfr: int) -> None:
    """Velocity x trajectory update in one step, then flat for SSFR samples: the roughness that grows with SSFR."""
    engine = make_engine(rates=rates_for(indax, ssfr))
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)
    engine.start_profile(0, plan_continuous(0.0, 0.0, VELOCITY, 1e6, 1e6))
    run_for(engine, 0.5)
    engine.scope.arm([Source("commanded_counts", 0)], rows=50 * ssfr)
    run_for(engine, 0.2)
    trace = engine.scope.read()
    assert np.all(np.diff(trace.times_ns) == engine.rates.servo_ns)
    steps = np.diff(trace.columns[0])
    stairs = np.flatnonzero(steps)
    assert np.all(np.diff(stairs) == ssfr)
    assert steps[stairs] == pytest.approx(VELOCITY * seconds(engine.rates.trajectory_ns), abs=1)


@EVERY_RATE
def test_the_output_is_rougher_the_longer_the_stairs(make_engine: MakeEngine, indax: int, ssfr: int) -> None:
    """At constant velocity the P term saws: SGP x velocity x (trajectory update less a sample), peak to peak."""
    engine = make_engine(FREE, rates=rates_for(indax, ssfr))
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)
    engine.start_profile(0, plan_continuous(0.0, 0.0, 10_000.0, 1e6, 1e6))
    run_for(engine, 1.0)
    engine.scope.arm([Source("term_p", 0)], rows=200)
    run_for(engine, 0.2)
    saw_s = seconds(engine.rates.trajectory_ns - engine.rates.servo_ns)
    assert float(np.ptp(engine.scope.read().columns[0])) == pytest.approx(0.5e-3 * 10_000 * saw_s, abs=1.1e-3)


@EVERY_RATE
def test_events_come_at_system_updates(make_engine: MakeEngine, indax: int, ssfr: int) -> None:
    engine = make_engine(rates=rates_for(indax, ssfr))
    first_ns = engine.time_ns
    for _ in range(5):
        engine.report_wires()
        engine.run(first_ns + 1_000_000_000)
        assert (engine.time_ns - first_ns) % engine.rates.system_ns == 0


def measured(
    make_engine: MakeEngine, rates: ServoRates, gains: Gains = GAINS
) -> tuple[npt.NDArray[np.complex128], npt.NDArray[np.floating]]:
    """Frequency response of the closed loop, from the spectrum of what a step of the command makes of the shaft."""
    engine = make_engine(FREE, rates=rates)
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)
    engine.set_gains(0, gains)
    trace = recorded_step(engine, STEP_COUNTS, SAMPLES)
    impulse = np.diff(trace.columns[0] * COUNTS_PER_REV / STEP_COUNTS, prepend=0.0)
    return np.fft.rfft(impulse), np.fft.rfftfreq(SAMPLES, seconds(rates.servo_ns))


def computed(rates: ServoRates, frequencies_hz: npt.NDArray[np.floating]) -> npt.NDArray[np.complex128]:
    return closed_loop_response(LoopModel(FREE, GAINS, seconds(rates.servo_ns)), frequencies_hz)


def bandwidth_hz(response: npt.NDArray[np.complex128], frequencies_hz: npt.NDArray[np.floating]) -> float:
    """The frequency at which the response has fallen to 3 dB below its value at rest."""
    magnitude = np.abs(response)
    first = int(np.argmax(magnitude < math.sqrt(0.5)))
    return float(np.interp(-math.sqrt(0.5), -magnitude[first - 1 : first + 1], frequencies_hz[first - 1 : first + 1]))


@EVERY_RATE
def test_bandwidth_and_phase_are_those_of_the_rate(make_engine: MakeEngine, indax: int, ssfr: int) -> None:
    """The z-transform of plant and law at this servo period, against the scope: 3 dB point, and phase up to it."""
    rates = rates_for(indax, ssfr)
    response, frequencies = measured(make_engine, rates)
    used = slice(1, int(np.searchsorted(frequencies, 120.0)))
    expected = computed(rates, frequencies[used])
    assert response[used] == pytest.approx(expected, abs=0.01)
    assert bandwidth_hz(response[1:], frequencies[1:]) == pytest.approx(
        bandwidth_hz(computed(rates, frequencies[1:400]), frequencies[1:400]), rel=0.01
    )


def test_faster_sampling_lags_less(make_engine: MakeEngine) -> None:
    """The held output costs half a sample: the open loop lags 90 degrees + atan(w tau) + atan(w lag) + w Ts/2.

    Slowest to fastest sampling: 580 us, 325, 280, 265, 160 us; at 40 Hz from 4.2 to 1.2 degrees for the sampling.
    """
    order = [rates_for(*key) for key in ((2, 1), (2, 2), (2, 4), (2, 8), (1, 4))]
    lags = []
    for rates in order:
        response, frequencies = measured(make_engine, rates, Gains(4.0))
        index = int(np.argmin(np.abs(frequencies - 40.0)))
        angular = 2 * math.pi * frequencies[index]
        plant = math.atan(angular * FREE.loop_time_constant_s) + math.atan(angular * FREE.command_lag_s)
        expected = math.pi / 2 + plant + angular * seconds(rates.servo_ns) / 2
        open_loop = response[index] / (1 - response[index])
        lag = -float(np.angle(open_loop)) % (2 * math.pi)
        assert math.degrees(lag) == pytest.approx(math.degrees(expected), abs=0.5)
        lags.append(math.degrees(lag - math.pi / 2 - plant) * 40.0 / frequencies[index])
    assert lags == sorted(lags, reverse=True)
    assert lags[0] - lags[-1] == pytest.approx(360 * 40 * (580e-6 - 160e-6) / 2, abs=0.5)

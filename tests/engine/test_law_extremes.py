"""Gains at their limits, plants that cannot be controlled: a faulted axis or the output's stops, never a NaN."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator.engine import Engine, Gains, Plant, TorqueDrive, VelocityDrive, plan_preset, rates_for
from emulator.engine.layout import AXIS
from tests.engine.conftest import build_engine
from tests.engine.loop_model import run_for

MakeEngine = Callable[..., Engine]

LARGEST = 2_800_000.0
"""Upper end of the gain commands' range (assumed M)."""

FLOATS = [name for name in AXIS.names or () if AXIS[name] == np.float64]
MAY_BE_INFINITE = {
    "profile_end_s",
    "positive_switch_rev",
    "negative_switch_rev",
    "home_from_rev",
    "home_to_rev",
    "encoder_step_limit",
}


def assert_sound(engine: Engine) -> None:
    """No number of the axis is a NaN, none that is not infinite by design is, the output is within its range."""
    for axis in engine.memory.axes:
        for name in FLOATS:
            value = float(axis[name])
            assert not math.isnan(value), name
            assert math.isfinite(value) or name in MAY_BE_INFINITE, name
        assert -10.0 <= axis["dac_v"] <= 10.0


@pytest.mark.parametrize("place", range(5))
@pytest.mark.parametrize("plant", [VelocityDrive(), TorqueDrive()], ids=["velocity", "torque"])
def test_every_gain_at_its_limit(make_engine: MakeEngine, plant: Plant, place: int) -> None:
    engine = make_engine(plant)
    values = [0.5, 0.0, 0.0, 0.0, 0.0]
    values[place] = LARGEST
    engine.set_gains(0, Gains(*values))
    engine.start_profile(0, plan_preset(0.0, 0.0, 4000.0, 4000.0, 40_000.0, 40_000.0))
    run_for(engine, 2.0)
    assert_sound(engine)


def test_all_gains_at_their_limit_with_smper_off(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.set_position_error_limit(0, 0)
    engine.set_gains(0, Gains(*[LARGEST] * 5))
    engine.start_profile(0, plan_preset(0.0, 0.0, 999_999_999.0, 800_000.0, 1e11, 1e11))
    run_for(engine, 5.0)
    assert_sound(engine)
    assert engine.is_enabled(0)


def test_a_loop_that_grows_trips_smper(make_engine: MakeEngine) -> None:
    """A torque drive without damping under P alone is unstable by half a sample: it grows until SMPER."""
    engine = make_engine(TorqueDrive(coulomb_nm=0.0, viscous_nm_s_per_rev=0.0))
    engine.set_gains(0, Gains(50.0))
    engine.start_profile(0, plan_preset(0.0, 0.0, 100.0, 4000.0, 40_000.0, 40_000.0))
    run_for(engine, 10.0)
    assert not engine.is_enabled(0)
    assert engine.status(0) & 1 << 22
    assert_sound(engine)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", range(6))
def test_no_number_no_gain(make_engine: MakeEngine, wrong: float, place: int) -> None:
    engine = make_engine()
    before = engine.snapshot()
    values = [0.5, 0.0, 0.0, 0.0, 0.0, 200.0]
    values[place] = wrong
    with pytest.raises(ValueError, match="would be"):
        engine.set_gains(0, Gains(*values))
    assert engine.snapshot() == before
    assert engine.gains(0) == Gains()


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_no_number_no_voltage(make_engine: MakeEngine, wrong: float) -> None:
    engine = make_engine()
    with pytest.raises(ValueError):
        engine.set_output(0, offset_v=wrong)
    with pytest.raises(ValueError):
        engine.set_output(0, limit_v=wrong)
    with pytest.raises(ValueError):
        engine.set_dither(0, amplitude_v=wrong, half_period_samples=1)


GAIN = st.one_of(st.just(0.0), st.floats(1e-8, 100.0), st.floats(100.0, LARGEST))
TIMES = st.floats(1e-5, 0.1)
VELOCITY_DRIVES = st.builds(VelocityDrive, st.floats(1e-6, 100.0), TIMES, TIMES, st.floats(1.0, 1e6), TIMES)
TORQUE_DRIVES = st.builds(
    TorqueDrive,
    st.floats(1e-6, 10.0),
    st.floats(1e-7, 1.0),
    st.floats(0.0, 1.0),
    st.floats(0.0, 1.0),
    st.floats(-1, 1),
)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    plant=st.one_of(VELOCITY_DRIVES, TORQUE_DRIVES),
    gains=st.builds(Gains, GAIN, GAIN, GAIN, GAIN, GAIN, st.floats(0.0, 200.0)),
    limit=st.sampled_from([0, 4000]),
    ssfr=st.sampled_from([1, 2, 4, 8]),
    offset_v=st.floats(-10.0, 10.0),
)
def test_whatever_gains_on_whatever_plant(plant: Plant, gains: Gains, limit: int, ssfr: int, offset_v: float) -> None:
    engine = build_engine(plant, rates=rates_for(2, ssfr))
    engine.set_position_error_limit(0, limit)
    engine.set_gains(0, gains)
    engine.set_output(0, offset_v=offset_v)
    engine.start_profile(0, plan_preset(0.0, 0.0, 4000.0, 8000.0, 1e5, 1e5))
    until_ns = engine.time_ns + 1_000_000_000
    calls = 0
    while engine.time_ns < until_ns:
        engine.run(until_ns)
        calls += 1
    assert calls < 2000, "every event is told once, not at every update for ever"
    assert_sound(engine)
    assert limit == 0 or not engine.is_enabled(0) or abs(engine.position_error(0)) <= limit

"""The encoder and its input: whole edges, lost counts, noise, faults."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.engine import AnalogSensor, AxisHardware, EncoderTraits, EncoderWiring, Engine, VelocityDrive, rates_for
from emulator.engine.encoder import noise_state, read_encoder, take_feedback
from emulator.engine.layout import AXIS

MakeEngine = Callable[..., Engine]
PERIOD_S = 280e-6


def encoder(traits: EncoderTraits | None = None, *, axis_index: int = 0, **state: float) -> Any:
    axis = np.zeros(1, AXIS)[0]
    traits = traits or EncoderTraits()
    fields = {"counts_per_rev": 4000.0, **traits.fields(axis_index), **traits.step_fields(PERIOD_S, load_apart=False)}
    for name, value in {**fields, **state}.items():
        axis[name] = value
    return axis


@given(st.lists(st.floats(-1000.0, 1000.0), min_size=1), st.floats(0.0, 0.999))
def test_the_encoder_counts_whole_edges_passed(positions: list[float], phase: float) -> None:
    axis = encoder(encoder_phase=phase)
    for position in positions:
        before = int(axis["encoder_counts"])
        axis["true_position"] = position
        take_feedback(axis, 0)
        assert axis["encoder_counts"] == axis["feedback_counts"] == math.floor(position * 4000.0 + phase)
        assert axis["previous_feedback_counts"] == before


def test_turning_the_polarity_round_does_not_move_the_position() -> None:
    axis = encoder(true_position=1.0)
    read_encoder(axis, 0)
    axis["encoder_sign"] = -1
    read_encoder(axis, 0)
    assert axis["encoder_counts"] == 4000
    axis["true_position"] = 1.25
    read_encoder(axis, 0)
    assert axis["encoder_counts"] == 3000


@pytest.mark.parametrize("rate", [1_600_000.0, 900_000.0, 123_456.7])
def test_counts_beyond_the_greatest_rate_are_lost(rate: float) -> None:
    samples = 10_000
    for speed_counts_s in (0.99 * rate, 2.0 * rate, -3.0 * rate):
        axis = encoder(EncoderTraits(max_rate_counts_s=rate))
        for sample in range(1, samples + 1):
            axis["true_position"] = speed_counts_s * sample * PERIOD_S / 4000.0
            read_encoder(axis, 0)
        possible = math.copysign(min(abs(speed_counts_s), rate), speed_counts_s)
        assert int(axis["encoder_counts"]) == pytest.approx(possible * samples * PERIOD_S, abs=1.5)


def test_an_axis_at_the_units_greatest_speed_loses_nothing() -> None:
    axis = encoder(EncoderTraits(max_rate_counts_s=1_600_000.0))
    for sample in range(1, 1000):
        axis["true_position"] = 200.0 * sample * PERIOD_S
        read_encoder(axis, 0)
    assert axis["encoder_counts"] == math.floor(200.0 * 999 * PERIOD_S * 4000.0)


def noisy_counts(seed: int, axis_index: int = 0, *, rms: float = 50.0, count: int = 20_000) -> np.ndarray:
    axis = encoder(EncoderTraits(noise_counts_rms=rms, noise_seed=seed), axis_index=axis_index)
    counts = []
    for _ in range(count):
        read_encoder(axis, 0)
        counts.append(int(axis["encoder_counts"]))
    return np.array(counts)


def test_noise_has_the_size_asked_for_and_no_memory() -> None:
    counts = noisy_counts(3)
    assert counts.std() == pytest.approx(50.0, rel=0.02)
    assert abs(counts.mean() + 0.5) < 4 * 50.0 / math.sqrt(len(counts)), "floor costs half a count"
    assert np.abs(counts).max() <= 151
    centred = counts - counts.mean()
    for lag in (1, 2, 3, 7):
        assert abs(np.mean(centred[lag:] * centred[:-lag])) < 4 * 50.0**2 / math.sqrt(len(counts))


def test_noise_is_reproducible_by_its_seed() -> None:
    one = noisy_counts(3, count=500)
    assert (one == noisy_counts(3, count=500)).all()
    for other in (noisy_counts(4, count=500), noisy_counts(3, axis_index=1, count=500)):
        assert abs(np.corrcoef(one, other)[0, 1]) < 0.2


@given(st.integers(0, 2**31 - 1), st.integers(0, 1))
def test_every_seed_gives_a_state_within_the_sequence(seed: int, axis_index: int) -> None:
    assert 0 < noise_state(seed, axis_index) < 2**31 - 1


def spinning(make_engine: MakeEngine) -> Engine:
    engine = make_engine()
    engine.set_feedback(0, 0)
    engine.set_output(0, offset_v=0.1)
    engine.run(engine.time_ns + 200_000_000)
    return engine


@pytest.mark.parametrize(("wiring", "sign"), [(EncoderWiring.OPEN, 0), (EncoderWiring.REVERSED, -1)])
def test_a_wrongly_wired_encoder_counts_wrongly_and_jumps_nowhere(
    make_engine: MakeEngine, wiring: EncoderWiring, sign: int
) -> None:
    engine = spinning(make_engine)
    before, shaft = engine.encoder_position(0), engine.true_position_rev(0)
    engine.wire_encoder(0, wiring)
    engine.run(engine.time_ns + 100_000_000)
    turned = (engine.true_position_rev(0) - shaft) * 4000
    assert turned > 300
    assert engine.encoder_position(0) - before == pytest.approx(sign * turned, abs=2)
    engine.set_polarity(0, encoder=1)
    before, shaft = engine.encoder_position(0), engine.true_position_rev(0)
    engine.run(engine.time_ns + 100_000_000)
    turned = (engine.true_position_rev(0) - shaft) * 4000
    assert engine.encoder_position(0) - before == pytest.approx(-sign * turned, abs=2)
    engine.wire_encoder(0, EncoderWiring.NORMAL)
    engine.set_polarity(0, encoder=0)
    before, shaft = engine.encoder_position(0), engine.true_position_rev(0)
    engine.run(engine.time_ns + 100_000_000)
    assert engine.encoder_position(0) - before == pytest.approx((engine.true_position_rev(0) - shaft) * 4000, abs=2)


def test_a_slipped_encoder_makes_the_axis_move_by_as_much(make_engine: MakeEngine) -> None:
    engine = make_engine()
    engine.slip_encoder(0, 1000)
    assert engine.encoder_position(0) == 1000
    engine.run(engine.time_ns + 2_000_000_000)
    assert engine.true_position_rev(0) == pytest.approx(-0.25, abs=1e-3)
    assert abs(engine.encoder_position(0)) <= 2


def test_the_index_pulse_slips_with_the_encoder() -> None:
    engine = Engine([AxisHardware(VelocityDrive())], rates=rates_for(2, 4))
    assert engine.index_active(0)
    engine.slip_encoder(0, 10)
    assert not engine.index_active(0)
    engine.slip_encoder(0, 3990)
    assert engine.index_active(0)


@pytest.mark.parametrize(
    ("make", "values", "name"),
    [
        (EncoderTraits, {"noise_counts_rms": math.nan}, "noise_counts_rms"),
        (EncoderTraits, {"noise_counts_rms": -1.0}, "noise_counts_rms"),
        (EncoderTraits, {"max_rate_counts_s": 0.0}, "max_rate_counts_s"),
        (AnalogSensor, {"volts_per_rev": math.inf}, "volts_per_rev"),
        (AxisHardware, {"counts_per_rev": 0}, "counts_per_rev"),
        (AxisHardware, {"start_position_rev": math.nan}, "start_position_rev"),
    ],
)
def test_impossible_sensors_are_named(make: Callable[..., object], values: dict[str, Any], name: str) -> None:
    with pytest.raises(ValueError, match=name):
        make(**values)

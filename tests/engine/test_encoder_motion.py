"""Encoders that something else turns than their motor, against the closed forms of their motions."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.engine import AxisHardware, EncoderMotion, EncoderTraits, Engine, rates_for
from emulator.engine.encoder_motion import sine_of_turns

MS = 1_000_000


def engine_with(motion: EncoderMotion | None, **options: object) -> Engine:
    return Engine([AxisHardware(), AxisHardware(motion=motion, **options)], rates=rates_for(2, 4))  # type: ignore[arg-type]


def sample_time(engine: Engine, until_ns: int) -> float:
    """Run, and tell the time of the last servo sample in seconds."""
    engine.run(until_ns)
    return until_ns // engine.rates.servo_ns * engine.rates.servo_ns / 1e9


@given(st.floats(-50.0, 50.0))
def test_the_sine_is_the_mathematical_library_s(turns: float) -> None:
    assert sine_of_turns(turns) == pytest.approx(math.sin(2 * math.pi * turns), abs=1e-12)


@pytest.mark.parametrize("velocity", [25_000.0, -1234.5])
def test_constant_velocity_from_its_start_on(velocity: float) -> None:
    engine = engine_with(EncoderMotion(velocity, start_s=0.01))
    engine.run(10 * MS)
    assert engine.encoder_position(1) == 0
    for until_ns in (11 * MS, 500 * MS, 3_600_000 * MS):
        t = sample_time(engine, until_ns)
        assert engine.encoder_position(1) == pytest.approx(velocity * (t - 0.01), abs=1.0)


def test_a_ramp_is_a_parabola_and_then_a_line() -> None:
    engine = engine_with(EncoderMotion(10_000.0, ramp_s=0.5))
    for until_ns in (100 * MS, 300 * MS, 499 * MS):
        t = sample_time(engine, until_ns)
        assert engine.encoder_position(1) == pytest.approx(10_000 * t * t, abs=1.0)
    t = sample_time(engine, 900 * MS)
    assert engine.encoder_position(1) == pytest.approx(2500 + 10_000 * (t - 0.5), abs=1.0)


def test_a_sine_about_a_velocity() -> None:
    engine = engine_with(EncoderMotion(500.0, 500.0, swing_counts=300.0, frequency_hz=7.0))
    for until_ns in range(13 * MS, 900 * MS, 37 * MS):
        t = sample_time(engine, until_ns)
        expected = 500 * t + 300 * math.sin(2 * math.pi * 7 * t)
        assert engine.encoder_position(1) == pytest.approx(expected, abs=1.0)


def test_noise_is_seeded_and_stays_near() -> None:
    def places(seed: int) -> list[int]:
        encoder = EncoderTraits(noise_counts_rms=5.0, noise_seed=seed)
        engine = engine_with(EncoderMotion(1000.0), encoder=encoder)
        seen = []
        for k in range(1, 200):
            t = sample_time(engine, k * MS)
            seen.append(engine.encoder_position(1))
            assert abs(seen[-1] - 1000 * t) <= 16
        return seen

    assert places(3) == places(3) != places(4)


def test_slices_make_no_difference() -> None:
    motion = EncoderMotion(31_000.0, ramp_s=0.3, swing_counts=40.0, frequency_hz=11.0)
    whole, sliced = engine_with(motion), engine_with(motion)
    whole.run(700 * MS)
    for until_ns in range(0, 701 * MS, MS // 3):
        sliced.run(min(until_ns, 700 * MS))
    sliced.run(700 * MS)
    assert whole.snapshot() == sliced.snapshot()


@pytest.mark.parametrize("counts", [1, -7, 12_345, -1_000_000])
@pytest.mark.parametrize("velocity", [0.0, 40_000.0, 777.7])
def test_a_test_turns_it_by_exact_counts(counts: int, velocity: float) -> None:
    engine = engine_with(EncoderMotion())
    engine.run(5 * MS)
    engine.move_encoder(1, EncoderMotion.by(counts, velocity))
    engine.run(engine.time_ns + 100 * MS)
    if velocity and abs(counts) > 0.2 * velocity:
        assert engine.encoder_position(1) == pytest.approx(math.copysign(velocity * 0.1, counts), rel=0.01, abs=1)
    engine.run(engine.time_ns + 2_000_000 * MS)
    assert engine.encoder_position(1) == counts


def test_a_test_changes_its_velocity_without_a_jump() -> None:
    engine = engine_with(None)
    engine.move_encoder(1, EncoderMotion(10_000.0))
    engine.run(100 * MS)
    here = engine.encoder_position(1)
    engine.move_encoder(1, EncoderMotion(-10_000.0, engine.encoder_velocity(1), ramp_s=0.2))
    assert engine.encoder_velocity(1) == pytest.approx(10_000.0)
    engine.run(200 * MS)
    assert engine.encoder_velocity(1) == pytest.approx(0.0, abs=1.0)
    assert engine.encoder_position(1) - here == pytest.approx(500, abs=2)
    engine.run(300 * MS)
    assert engine.encoder_position(1) == pytest.approx(here, abs=2)


def test_the_motor_does_not_turn_it_until_it_is_released() -> None:
    engine = engine_with(EncoderMotion())
    engine.set_output(1, offset_v=1.0)
    engine.enable(1)
    engine.set_feedback(1, 0)
    engine.run(500 * MS)
    assert abs(engine.true_position_rev(1)) > 1.0
    assert engine.encoder_position(1) == 0
    engine.release_encoder(1)
    engine.run(501 * MS)
    assert 0 < abs(engine.encoder_position(1)) < 100
    engine.release_encoder(1)


def test_slips_and_wiring_act_on_it_too() -> None:
    engine = engine_with(EncoderMotion())
    engine.slip_encoder(1, 40)
    engine.move_encoder(1, EncoderMotion.by(100, 0.0))
    engine.run(5 * MS)
    engine.set_polarity(1, encoder=1)
    engine.move_encoder(1, EncoderMotion.by(100, 0.0))
    engine.run(10 * MS)
    assert engine.encoder_position(1) == 40


@pytest.mark.parametrize(
    "values",
    [
        {"velocity_counts_s": 2e9},
        {"velocity_counts_s": math.nan},
        {"swing_counts": 1e13},
        {"ramp_s": -1.0},
        {"frequency_hz": math.nan},
    ],
)
def test_impossible_motions_are_refused(values: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="not"):
        EncoderMotion(**values)

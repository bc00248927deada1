"""Whatever a plant's parameters and the servo rate: bounded, never a NaN, the same compiled and interpreted."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from emulator.engine import (
    RATES,
    AxisHardware,
    ElasticCoupling,
    EncoderTraits,
    Engine,
    Event,
    Gains,
    HydraulicCylinder,
    Plant,
    PlantError,
    ServoRates,
    TorqueDrive,
    VelocityDrive,
    plan_preset,
    rates_for,
)
from emulator.engine.batch import Batch
from emulator.engine.machine_code import MODE_VARIABLE
from emulator.engine.plants import WORLD_END_REV
from tests.engine.rig import Rig

MS = 1_000_000
rate_rows = st.sampled_from(list(RATES.values()))
shares = st.floats(0.001, 1.0)
"""Parts of a servo period that an output delay leaves."""


def sized(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of any size between two."""
    return st.floats(math.log10(low), math.log10(high)).map(lambda exponent: 10.0**exponent)


@given(
    rate_rows, shares, sized(1e-6, 1e3), sized(1e-6, 1e3), sized(1e-6, 1e8), sized(1e-9, 10.0), st.booleans(), shares
)
@settings(max_examples=60, deadline=None)
def test_an_elastic_coupling_never_swings_up(
    rates: ServoRates, share: float, motor: float, load: float, k: float, d: float, velocity: bool, tau: float
) -> None:
    """Left to itself its energy never rises; dry friction does not add to it in the long run."""
    try:
        plant = ElasticCoupling(
            drive="velocity" if velocity else "torque",
            loop_time_constant_s=tau,
            motor_inertia_kg_m2=motor,
            load_inertia_kg_m2=load,
            stiffness_nm_per_rad=k,
            damping_nm_s_per_rad=d,
        )
    except PlantError:
        assume(False)
        raise
    first = 0.5 * (k * 0.01**2 + motor * 9.0 + load * 4.0)
    for each in (plant, replace(plant, motor_coulomb_nm=0.01, load_coulomb_nm=0.02)):
        rig = Rig(each, share * rates.servo_ns * 1e-9, twist=0.01, true_velocity=3.0, load_velocity=-2.0)
        rows = rig.record(["twist", "true_velocity", "load_velocity"], [0.0] * 120)
        energy = 0.5 * (k * rows[:, 0] ** 2 + motor * rows[:, 1] ** 2 + load * rows[:, 2] ** 2)
        assert np.isfinite(energy).all()
        assert energy.max() <= 1.01 * first
        if each is plant:
            assert (energy <= np.concatenate([[first], energy[:-1]]) * (1.0 + 1e-9) + 1e-12 * first).all()


@given(rate_rows, shares, sized(0.1, 19_999.0), sized(1e-3, 99.0), st.floats(0.0, 5.0), sized(1e-3, 1e3))
@settings(max_examples=100, deadline=None)
def test_a_cylinder_never_outruns_its_pump(
    rates: ServoRates, share: float, hz: float, damping: float, overlap: float, most: float
) -> None:
    plant = HydraulicCylinder(valve_hz=hz, valve_damping=damping, overlap_v=overlap, max_speed_units_s=most)
    period_s = share * rates.servo_ns * 1e-9
    rows = Rig(plant, period_s).record(["spool", "true_position"], [10.0 * (-1) ** (k // 9) for k in range(300)])
    assert np.isfinite(rows).all()
    # Each reversal can throw a spool without damping by at most twice the step of 20 V beyond what it swung before.
    assert np.abs(rows[:, 0]).max() <= 10.0 + 20.0 * 34
    assert np.abs(np.diff(rows[:, 1])).max() <= most * period_s * (1 + 1e-6)


@given(rate_rows, shares, sized(1e-6, 1e3), st.floats(0.0, 10.0), st.floats(0.0, 10.0), st.floats(-5.0, 5.0))
@settings(max_examples=100, deadline=None)
def test_a_torque_drive_gains_no_more_speed_than_its_torque_gives(
    rates: ServoRates, share: float, inertia: float, viscous: float, coulomb: float, load: float
) -> None:
    plant = TorqueDrive(
        inertia_kg_m2=inertia, viscous_nm_s_per_rev=viscous, coulomb_nm=coulomb, load_torque_nm=load, peak_torque_nm=2.0
    )
    period_s = share * rates.servo_ns * 1e-9
    speeds = Rig(plant, period_s).record(["true_velocity"], [10.0 * (-1) ** (k // 9) for k in range(300)])[:, 0]
    assert np.isfinite(speeds).all()
    assert np.abs(speeds).max() <= 300 * period_s * (2.0 + abs(load)) / (2.0 * math.pi * inertia) * (1 + 1e-9)


WILD: list[Plant] = [
    VelocityDrive(speed_per_volt_rev_s=1e12, max_acceleration_rev_s2=math.inf),
    VelocityDrive(speed_per_volt_rev_s=1e12, max_acceleration_rev_s2=1e12, backlash_rev=0.1),
    TorqueDrive(torque_per_volt_nm=1e12, inertia_kg_m2=1e-12),
    ElasticCoupling(torque_per_volt_nm=1e12),
    ElasticCoupling(drive="velocity", speed_per_volt_rev_s=1e12),
    HydraulicCylinder(extend_units_s_per_v=1e12, retract_units_s_per_v=1e12),
]


@pytest.mark.parametrize("plant", WILD, ids=lambda plant: type(plant).__name__)
@pytest.mark.parametrize("mode", ["", "interpreted"])
@pytest.mark.parametrize("limit_counts", [0, 4000])
def test_a_runaway_ends_at_the_end_of_the_world_or_in_a_fault(
    monkeypatch: pytest.MonkeyPatch, plant: Plant, mode: str, limit_counts: int
) -> None:
    monkeypatch.setenv(MODE_VARIABLE, mode)
    hardware = AxisHardware(plant, counts_per_rev=100_000_000, encoder=EncoderTraits(on_load=True))
    engine = Engine([hardware], rates=rates_for(2, 4))
    engine.set_gains(0, Gains(2_800_000.0, 2_800_000.0, 2_800_000.0))
    engine.set_position_error_limit(0, limit_counts)
    engine.set_polarity(0, encoder=1)
    engine.set_output(0, offset_v=10.0)
    engine.enable(0)
    tripped = Event.NONE
    while engine.time_ns < 300 * MS:
        tripped |= engine.run(300 * MS)
    numbers = [
        engine.true_position_rev(0),
        engine.load_position_rev(0),
        engine.actual_velocity(0),
        engine.dac_volts(0),
        *engine.terms(0).values(),
    ]
    assert all(math.isfinite(number) for number in numbers)
    assert abs(engine.true_position_rev(0)) <= WORLD_END_REV
    assert abs(engine.encoder_position(0)) <= WORLD_END_REV * 1e8 * 1.01
    assert bool(tripped & Event.POSITION_ERROR) == (limit_counts > 0)
    assert engine.is_enabled(0) == (limit_counts == 0)


@pytest.mark.parametrize(
    ("plant", "encoder"),
    [
        (VelocityDrive(droop_rev_s_per_nm=0.5, load_torque_nm=0.3, backlash_rev=0.002), EncoderTraits(on_load=True)),
        (TorqueDrive(load_torque_nm=0.1), EncoderTraits(noise_counts_rms=1.5, noise_seed=7)),
        (ElasticCoupling(load_coulomb_nm=0.02, motor_coulomb_nm=0.01, backlash_rev=0.001), EncoderTraits(on_load=True)),
        (ElasticCoupling(drive="velocity", peak_torque_nm=0.5), EncoderTraits(max_rate_counts_s=40_000.0)),
        (
            HydraulicCylinder(overlap_v=0.2, max_speed_units_s=6.0, extended_stop_units=0.3),
            EncoderTraits(noise_counts_rms=0.3),
        ),
    ],
    ids=lambda value: type(value).__name__,
)
def test_every_plant_is_the_same_compiled_and_interpreted(
    monkeypatch: pytest.MonkeyPatch, plant: Plant, encoder: EncoderTraits
) -> None:
    def play() -> bytes:
        engine = Engine([AxisHardware(plant, encoder=encoder)], rates=rates_for(2, 4), output_delay_s=100e-6)
        engine.set_gains(0, Gains(5.0, 20.0, 2.0, 10.0, 0.1, 5.0))
        engine.set_position_error_limit(0, 0)
        engine.enable(0)
        engine.start_profile(0, plan_preset(0.0, 0.0, 2000.0, 40_000.0, 1e6, 1e6, 5e5, 7e5))
        for stop_ms in range(1, 300, 37):
            while engine.time_ns < stop_ms * MS:
                engine.run(stop_ms * MS)
        engine.disable(0)
        while engine.time_ns < 400 * MS:
            engine.run(400 * MS)
        return engine.snapshot()

    compiled = play()
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    assert play() == compiled


def test_a_load_put_on_while_it_runs_turns_the_shaft_backwards() -> None:
    engine = Engine([AxisHardware(TorqueDrive(coulomb_nm=0.05))], rates=rates_for(2, 4))
    engine.set_load(0, 0.04)
    engine.run(100 * MS)
    assert engine.true_position_rev(0) == 0.0, "dry friction holds it"
    engine.set_load(0, 0.3)
    engine.run(200 * MS)
    assert engine.true_position_rev(0) < -0.5
    engine.set_load(0, 0.0)
    engine.set_friction(0, 3.0)
    engine.run(400 * MS)
    assert engine.true_velocity_rev_s(0) == 0.0


@pytest.mark.parametrize("plant", [VelocityDrive(), HydraulicCylinder()])
def test_a_load_on_a_plant_that_takes_none_is_refused(plant: Plant) -> None:
    engine = Engine([AxisHardware(plant)], rates=rates_for(2, 4))
    with pytest.raises(PlantError, match="load_torque_nm"):
        engine.set_load(0, 1.0)
    with pytest.raises(PlantError, match="friction"):
        engine.set_friction(0, 1.0)


def test_another_kind_of_plant_takes_over_position_and_speed() -> None:
    engine = Engine([AxisHardware(VelocityDrive())], rates=rates_for(2, 4))
    engine.set_feedback(0, 0)
    engine.set_output(0, offset_v=0.5)
    engine.enable(0)
    engine.run(100 * MS)
    position, speed = engine.true_position_rev(0), engine.true_velocity_rev_s(0)
    for plant in (ElasticCoupling(), TorqueDrive(backlash_rev=0.1), HydraulicCylinder(), VelocityDrive()):
        engine.set_plant(0, plant)
        assert engine.true_position_rev(0) == position
        assert engine.load_position_rev(0) == pytest.approx(position)
    assert engine.true_velocity_rev_s(0) == speed


def test_a_lane_with_another_plant_does_what_an_engine_with_it_does() -> None:
    template = Engine([AxisHardware(VelocityDrive())], rates=rates_for(2, 4))
    other = Engine([AxisHardware(VelocityDrive())], rates=rates_for(2, 4))
    plant = ElasticCoupling(drive="velocity", backlash_rev=0.01)
    other.set_plant(0, plant)
    for engine in (template, other):
        engine.set_position_error_limit(0, 0)
        engine.enable(0)
        engine.start_profile(0, plan_preset(0.0, 0.0, 2000.0, 40_000.0, 1e6, 1e6, 5e5, 5e5))
    batch = Batch(template, 3)
    batch.set_plant(1, 0, plant)
    batch.copy_plant(0, source=1, lanes=slice(2, 3))
    batch.run(200 * MS)
    for each in (template, other):
        while each.time_ns < 200 * MS:
            each.run(200 * MS)
    for name, position in (("true_position", Engine.true_position_rev), ("load_position", Engine.load_position_rev)):
        expected = [position(template, 0) if name == "true_position" else 0.0, position(other, 0), position(other, 0)]
        assert batch.axes[name][:, 0].tolist() == expected

"""Step experiments in batches against the unit driven by commands, and against the closed form of the loop."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import signal

from emulator.engine import VelocityDrive
from emulator.machine import Machine
from emulator.tuning.experiment import Lanes, Move, StepExperiment, measure_lanes, record_lanes, with_plant_factors
from emulator.tuning.gains import changed
from emulator.tuning.rig import Rig, StepProfile

NO_LIMIT_V = 200.0


def lanes(*rows: tuple[float, ...], phase: float = 0.0) -> Lanes:
    """Lanes with SGP, SGI, SGV, SGVF, SGAF."""
    gains = np.array([(*row, NO_LIMIT_V) for row in rows])
    return Lanes(gains, np.full(len(rows), phase))


@pytest.mark.parametrize("axis_index", [0, 1])
def test_a_lane_shows_what_the_unit_shows_when_it_is_driven_by_commands(axis_index: int) -> None:
    """GO falls on another moment of the trajectory grid, so the recordings are compared from the start of the move."""
    machine = Machine.default()
    experiment = StepExperiment.of_machine(machine, axis_index)
    recorded = record_lanes(experiment, lanes((15.0, 0.0, 2.0, 0.0, 0.0)))
    response = Rig(machine, axis_index).step(changed(experiment.gains, {"SGP": 15.0, "SGV": 2.0}))
    commanded, actual = recorded.commanded_counts[0], recorded.actual_counts[0]
    first = int((commanded != 0).argmax())
    count = 2000
    np.testing.assert_array_equal(commanded[first : first + count], response.commanded_counts[1 : 1 + count])
    np.testing.assert_array_equal(actual[first : first + count], response.actual_counts[1 : 1 + count])


def test_a_long_slow_step_follows_the_linear_loop_of_drive_and_gain() -> None:
    """Position of a velocity drive K / (s (tau s + 1)) under SGP alone, by scipy; a fine encoder and a command that
    arrives within a few samples leave only sampling and quantisation to differ."""
    tau_s, speed_per_volt, counts_per_rev, sgp = 0.02, 10.0, 1000, 2.0
    machine = Machine.parse(
        f"""
        [axis1.plant]
        kind = "velocity_drive"
        speed_per_volt_rev_s = {speed_per_volt}
        loop_time_constant_s = {tau_s}
        command_lag_s = 0.0
        max_acceleration_rev_s2 = inf
        [axis1.encoder]
        counts_per_rev = {counts_per_rev}
        [defaults]
        ERES = "{counts_per_rev},{counts_per_rev}"
        SMPER = "0,0"
        """
    )
    base = StepExperiment.of_machine(machine, 0)
    move = Move(1e6, 1e6, 1e4, distance_counts=2000)
    experiment = StepExperiment(
        hardware=base.hardware,
        rates=base.rates,
        counts_per_rev=counts_per_rev,
        move=move,
        position_error_limit_counts=0,
    )
    recorded = record_lanes(experiment, lanes((sgp, 0.0, 0.0, 0.0, 0.0), phase=0.5))
    rate = sgp * 1e-3 * speed_per_volt * counts_per_rev
    loop = signal.TransferFunction([rate], [tau_s, 1.0, rate])
    _, expected = signal.step(loop, T=recorded.times_s)
    assert np.abs(recorded.actual_counts[0] - 2000.0 * expected).max() < 0.05 * 2000.0
    zeta = 1.0 / (2.0 * math.sqrt(rate * tau_s))
    overshoot = 100.0 * math.exp(-math.pi * zeta / math.sqrt(1.0 - zeta**2))
    measures = measure_lanes(experiment, lanes((sgp, 0.0, 0.0, 0.0, 0.0), phase=0.5)).measures.lane(0)
    assert measures.overshoot_percent == pytest.approx(overshoot, abs=2.0)


def test_a_lane_does_not_depend_on_its_neighbours() -> None:
    experiment = StepExperiment.of_machine(Machine.default(), 0)
    rows = [(2.0, 0.0, 0.0, 0.0, 0.0), (500.0, 0.0, 0.0, 0.0, 0.0), (15.0, 1.0, 2.0, 3.0, 0.0)]
    together = measure_lanes(experiment, lanes(*rows))
    for index, row in enumerate(rows):
        alone = measure_lanes(experiment, lanes(row))
        assert alone.measures.lane(0) == together.measures.lane(index)
        assert alone.tripped[0] == together.tripped[index]


def test_reversed_feedback_trips_on_its_position_error() -> None:
    machine = Machine.parse('[defaults]\nENCPOL = "1,0"\n')
    responses = measure_lanes(StepExperiment.of_machine(machine, 0), lanes((5.0, 0.0, 0.0, 0.0, 0.0)))
    assert responses.tripped[0]
    assert responses.measures.lane(0).settling_s == math.inf


def test_lanes_have_the_plants_they_are_given_whatever_their_order() -> None:
    experiment = StepExperiment.of_machine(Machine.default(), 0)
    plants = (VelocityDrive(speed_per_volt_rev_s=2.0), VelocityDrive(speed_per_volt_rev_s=20.0))
    gains = np.tile([5.0, 0.0, 0.0, 0.0, 0.0, NO_LIMIT_V], (4, 1))
    mixed = Lanes(gains, np.zeros(4), plants, np.array([0, 1, 1, 0]))
    t90 = measure_lanes(experiment, mixed).measures["time_to_90_s"]
    assert t90[0] == t90[3] > 2.0 * t90[1] == 2.0 * t90[2]


def test_plant_factors_multiply_what_the_machine_file_says() -> None:
    axis = Machine.default().axis1
    made = with_plant_factors(axis, {"speed_per_volt_rev_s": 0.5})
    assert isinstance(made, VelocityDrive)
    assert made.speed_per_volt_rev_s == 0.5 * axis.plant.speed_per_volt_rev_s  # type: ignore[union-attr]
    with pytest.raises(ValueError, match="no quantity 'inertia"):
        with_plant_factors(axis, {"inertia_kg_m2": 1.0})
    with pytest.raises(ValueError, match="must be above 0"):
        with_plant_factors(axis, {"loop_time_constant_s": -1.0})


@pytest.mark.parametrize(("text", "message"), [('[defaults]\nSFB = "0,1"\n', "no encoder feedback")])
def test_an_axis_without_encoder_feedback_is_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        StepExperiment.of_machine(Machine.parse(text), 0)


def test_the_rig_uses_the_guides_step() -> None:
    """A999 AD999 V30 over 100 counts of 1/4000 rev: a triangle of sqrt(4 d / a) = 10 ms."""
    response = Rig(Machine.default(), 0, profile=StepProfile()).step(changed(StepExperiment.of_machine(
        Machine.default(), 0).gains, {"SGP": 2.0}))  # fmt: skip
    arrived = response.times_s[int((response.commanded_counts >= 100).argmax())]
    assert arrived == pytest.approx(math.sqrt(4 * 100 / (999 * 4000)), abs=2.5e-3)
    assert response.commanded_counts[-1] == 100

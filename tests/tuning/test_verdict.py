"""The words for responses: linear second-order responses of known damping, and the chatter the guide speaks of."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from emulator.tuning.measures import StepMeasures, measure_step
from emulator.tuning.verdict import Verdict, milliseconds, verdict

TIMES = np.arange(0.0, 1.0, 2.8e-4)


def second_order(zeta: float, omega: float = 80.0) -> np.ndarray:
    """100 counts times the step response of omega^2 / (s^2 + 2 zeta omega s + omega^2), any zeta but 1."""
    roots = np.roots([1.0, 2.0 * zeta * omega, omega**2]).astype(complex)
    first, second = roots
    shape = (second * np.exp(first * TIMES) - first * np.exp(second * TIMES)) / (first - second)
    return np.floor(100.0 * (1.0 + np.real(shape)) + 1e-6)


def measured(actual: np.ndarray, output: np.ndarray | None = None) -> StepMeasures:
    command = np.full(len(TIMES), 100)
    command[0] = 0
    return measure_step(
        TIMES, command, actual, np.zeros(len(TIMES)) if output is None else output, start=0, setpoint=100
    )


@pytest.mark.parametrize(
    ("zeta", "word"),
    [
        (3.0, Verdict.OVER_DAMPED),
        (1.5, Verdict.OVER_DAMPED),
        (0.98, Verdict.WELL_DAMPED),
        (0.8, Verdict.WELL_DAMPED),
        (0.6, Verdict.SLIGHTLY_UNDER_DAMPED),
        (0.3, Verdict.UNDER_DAMPED),
        (0.0, Verdict.UNSTABLE),
    ],
)
def test_damping_decides_the_word(zeta: float, word: Verdict) -> None:
    assert verdict(measured(second_order(zeta)), step_counts=100) == word


def test_sustained_oscillation_and_chatter_differ_in_amplitude() -> None:
    wave = np.sin(2 * math.pi * 40.0 * TIMES)
    assert verdict(measured(100 + np.round(10 * wave)), step_counts=100) == Verdict.OSCILLATORY
    chatter = verdict(measured(100 + np.round(wave), 0.1 * np.sign(wave)), step_counts=100)
    assert chatter == Verdict.CHATTERING
    assert verdict(measured(100 + np.round(wave), 0.02 * np.sign(wave)), step_counts=100) == Verdict.WELL_DAMPED


def test_run_away_and_a_shut_down_drive_are_unstable() -> None:
    wave = np.sin(2 * math.pi * 40.0 * TIMES)
    assert verdict(measured(100 + 20 * wave, 10.0 * wave), step_counts=100) == Verdict.UNSTABLE
    assert verdict(measured(second_order(0.8)), step_counts=100, tripped=True) == Verdict.UNSTABLE


def test_a_creep_towards_the_setpoint_is_no_oscillation() -> None:
    creeping = np.floor(60.0 + 30.0 * TIMES / TIMES[-1])
    assert verdict(measured(creeping), step_counts=100) != Verdict.OSCILLATORY


def test_overshoot_counts_from_where_a_load_holds_the_axis() -> None:
    short = second_order(0.6) * 0.5
    assert measured(short).overshoot_percent == 0.0
    assert verdict(replace(measured(short)), step_counts=100) == Verdict.SLIGHTLY_UNDER_DAMPED


def test_what_never_happened_is_shown_as_never() -> None:
    assert milliseconds(0.0125) == "12.5"
    assert milliseconds(math.inf) == "never"

"""A plant by itself, and independent solutions to compare it with."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from scipy.linalg import expm

from emulator.engine import RATES, EncoderTraits, Plant
from emulator.engine.encoder import read_encoder
from emulator.engine.layout import AXIS, PLANT
from emulator.engine.plants import load_fields, plant_fields, step_plant

PERIODS_S = [rates.servo_ns * 1e-9 for rates in RATES.values()]
TURN = 2.0 * math.pi


class Rig:
    """A plant by itself: the state it has in an axis, its coefficients for one period, and a hand on its voltage.

    The encoder is read after each step, as in a servo sample, since that is where loads are dragged along.
    """

    def __init__(self, plant: Plant, period_s: float, encoder: EncoderTraits | None = None, **state: float) -> None:
        self._axis, self._plant = np.zeros(1, AXIS)[0], np.zeros(1, PLANT)[0]
        encoder = encoder or EncoderTraits()
        fields = {
            "enabled": 1,
            "counts_per_rev": 4000,
            **encoder.fields(0),
            **encoder.step_fields(period_s, load_apart=plant.load_apart),
            **load_fields(plant),
            **state,
        }
        for name, value in plant_fields(plant, period_s).items():
            self._plant[name] = value
        for name, value in fields.items():
            self._axis[name] = value

    def __getitem__(self, name: str) -> Any:
        return self._axis[name]

    def __setitem__(self, name: str, value: float) -> None:
        self._axis[name] = value

    def step(self, volts: float) -> None:
        step_plant(self._axis, self._plant, volts)
        read_encoder(self._axis, 0)

    def record(self, names: Sequence[str], volts: Iterable[float]) -> np.ndarray:
        """One row a step."""
        rows = []
        for each in volts:
            self.step(each)
            rows.append([float(self._axis[name]) for name in names])
        return np.array(rows)


def volts_sequence(count: int) -> list[float]:
    """Voltages that differ from sample to sample."""
    return [3.0 * math.sin(0.7 * k) + (k % 5) - 2.0 for k in range(count)]


def exact_linear(system: np.ndarray, inputs: np.ndarray, volts: Iterable[float], period_s: float) -> np.ndarray:
    """States after holding each voltage for a period, one row a step, by scipy's matrix exponential."""
    n = len(system)
    augmented = np.zeros((n + 1, n + 1))
    augmented[:n, :n], augmented[:n, n] = system, inputs
    step = expm(augmented * period_s)
    state = np.zeros(n + 1)
    rows = []
    for u in volts:
        state[n] = u
        state = step @ state
        rows.append(state[:n])
    return np.array(rows)

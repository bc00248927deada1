"""What a sweep tries: ranges as they are typed, and the grids and random samples made of them.

5:100:20   20 values from 5 to 100        0,1,2   these        15   this one        5:100   a range to draw from
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.machine import Machine
from emulator.tuning.experiment import StepExperiment, with_plant_factors
from emulator.tuning.gains import checked, row_of
from emulator.tuning.measures import Floats
from emulator.tuning.sweep import SweepPlan

MAX_SAMPLES = 1_000_000
"""Largest sweep (design choice): a day of one processor."""

PLANT_PREFIX = "plant."


@dataclass(frozen=True, slots=True)
class Span:
    """Values to try: `values`, or `count` of them (None: not said) from `low` to `high`."""

    low: float
    high: float
    count: int | None = None
    values: tuple[float, ...] = ()

    def grid(self, name: str) -> tuple[float, ...]:
        """The values of a grid; ValueError for a range that does not say how many."""
        if self.values:
            return self.values
        if self.count is None:
            raise ValueError(
                f"{name} {self.low:g}:{self.high:g} does not say how many values; {self.low:g}:{self.high:g}:10 does"
            )
        return tuple(float(value) for value in np.linspace(self.low, self.high, self.count))

    def draw(self, generator: np.random.Generator, count: int) -> Floats:
        """`count` values at random: of the list, or anywhere in the range."""
        if self.values:
            return generator.choice(np.array(self.values), count)
        return generator.uniform(self.low, self.high, count)


def parse_span(text: str) -> Span:
    """A range or list as typed; ValueError, in one line, for anything else."""
    if ":" not in text:
        values = tuple(_number(part, text) for part in text.split(","))
        return Span(min(values), max(values), values=values)
    low, high, *count = text.split(":")
    if len(count) > 1 or (count and not (count[0].isascii() and count[0].isdigit() and int(count[0]) >= 1)):
        raise ValueError(f"{text!r} is not LOW:HIGH:COUNT, a list as 0,1,2, or one number")
    span = Span(_number(low, text), _number(high, text), int(count[0]) if count else None)
    if span.low > span.high or (span.count == 1 and span.low < span.high):
        raise ValueError(f"{text!r} is not a range from the lower to the higher value")
    if span.count is not None and span.count > MAX_SAMPLES:
        raise ValueError(f"{text!r} has more than {MAX_SAMPLES:,} values")
    return span


def _number(text: str, whole: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{text!r} in {whole!r} is not a number")
    return value


def make_plan(
    machine: Machine,
    axis_index: int,
    experiment: StepExperiment,
    spans: Mapping[str, Span],
    *,
    random_samples: int | None = None,
    seed: int = 0,
) -> SweepPlan:
    """A sweep over `spans`: values by gain command, and by `plant.<quantity>` factors on what the machine file says.

    A grid of all combinations, or so many random samples. Gains not named stay as they are in the machine.

    Raises:
        ValueError: nothing to vary, an unknown name, a value out of range, too many samples.
    """
    if not spans:
        raise ValueError("nothing to sweep: give at least one range, as --sgp 5:100:20")
    for name, span in spans.items():
        if name in GAIN_COMMANDS:
            checked(name, span.low)
            checked(name, span.high)
        elif not name.startswith(PLANT_PREFIX):
            raise ValueError(f"{name!r} cannot be varied; plant.<quantity> can, as plant.inertia_kg_m2=0.8:1.2")
    table = _grid(spans) if random_samples is None else _random(spans, random_samples, seed)
    columns = dict(zip(spans, table.T, strict=True))
    gains = np.tile(np.array(row_of(experiment.gains)), (len(table), 1))
    for place, name in enumerate(GAIN_COMMANDS):
        if name in columns:
            gains[:, place] = columns[name]
    return _with_plants(machine, axis_index, SweepPlan(experiment, gains), columns)


def _grid(spans: Mapping[str, Span]) -> Floats:
    axes = [span.grid(name) for name, span in spans.items()]
    _check_count(math.prod(len(values) for values in axes))
    return np.array(list(itertools.product(*axes)))


def _random(spans: Mapping[str, Span], samples: int, seed: int) -> Floats:
    _check_count(samples)
    generator = np.random.default_rng(seed)
    return np.column_stack([span.draw(generator, samples) for span in spans.values()])


def _check_count(samples: int) -> None:
    if not 1 <= samples <= MAX_SAMPLES:
        raise ValueError(f"{samples:,} samples; 1 to {MAX_SAMPLES:,} are possible")


def _with_plants(machine: Machine, axis_index: int, plan: SweepPlan, columns: Mapping[str, Floats]) -> SweepPlan:
    """The plan with the plants that the factors among `columns` make; each kind of plant is made once."""
    names = [name for name in columns if name.startswith(PLANT_PREFIX)]
    if not names:
        return plan
    factors = np.column_stack([columns[name] for name in names])
    kinds, plant_of = np.unique(factors, axis=0, return_inverse=True)
    axis = machine.axes[axis_index]
    quantities = [name.removeprefix(PLANT_PREFIX) for name in names]
    plants = tuple(with_plant_factors(axis, dict(zip(quantities, row, strict=True))) for row in kinds.tolist())
    inputs = tuple((name, columns[name]) for name in names)
    return SweepPlan(plan.experiment, plan.gains, plants, plant_of.reshape(-1), inputs)

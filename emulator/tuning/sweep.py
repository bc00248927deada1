"""Sweeps over gains and plants: many step experiments in parallel, and a table of what came of them.

A sample is a gain set with a plant. It is run from several encoder phases, and again with its feedback gains multiplied
by MARGIN_FACTORS, all of them lanes of one compiled call. The table has the worst over the phases, and the *margin to
chatter*: the largest factor, from 1, up to which the axis stays quiet at rest (see `chatter_margin`).

`sweep` cuts the samples into jobs of plain data and hands them to any `concurrent.futures` executor: threads (the
kernel releases the interpreter lock), processes, or a cluster's. The result depends on none of that, nor on the order.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Executor, as_completed
from contextlib import closing
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.engine import Plant
from emulator.tuning.experiment import Lanes, StepExperiment, measure_lanes
from emulator.tuning.measures import NAMES, Floats
from emulator.tuning.verdict import CHATTER_RIPPLE_V

MARGIN_FACTORS = (1.1, 1.25, 1.5, 2.0)
"""What the feedback gains SGP, SGI and SGV are multiplied by to find the margin to chatter (design choice)."""

FEEDBACK_GAINS = tuple(GAIN_COMMANDS.index(name) for name in ("SGP", "SGI", "SGV"))

AXIS_SECONDS_PER_JOB = 60.0
"""Virtual time recorded in one compiled call, s: enough to make the call's own cost small, little enough that the
recordings (5 MB) are still near the processor when they are measured; twice as much gains nothing, four times loses a
third (measured)."""

MARGIN = "chatter_margin"
TRIPPED = "tripped"
RESULTS = (*NAMES, MARGIN, TRIPPED)
"""Columns of results, after those of the gains and of the plant's factors."""

Progress = Callable[[int, int], None]
"""Called with samples done and samples wanted."""


@dataclass(frozen=True, slots=True)
class SweepPlan:
    """What to try: `gains` of shape (samples, 6) in the order of GAIN_COMMANDS, and which plant each sample has."""

    experiment: StepExperiment
    gains: Floats
    plants: tuple[Plant, ...] = ()
    plant_of: npt.NDArray[np.int64] | None = None
    """Index into `plants` of each sample; None: all have the experiment's own."""
    inputs: tuple[tuple[str, Floats], ...] = ()
    """Further input columns for the table, such as the factors that made the plants: name, values of shape
    (samples,)."""

    def __post_init__(self) -> None:
        if self.gains.ndim != 2 or self.gains.shape[1] != len(GAIN_COMMANDS) or not len(self.gains):
            raise ValueError(f"gains are a table of one or more rows of {len(GAIN_COMMANDS)}, not {self.gains.shape}")
        if not np.isfinite(self.gains).all():
            raise ValueError("gains must be numbers")
        if self.plant_of is not None and not 0 <= self.plant_of.min() <= self.plant_of.max() < len(self.plants):
            raise ValueError("plant_of names a plant that is not there")

    def __len__(self) -> int:
        return len(self.gains)

    @property
    def lanes_per_sample(self) -> int:
        """Step experiments that make one sample."""
        return len(self.experiment.phases) * (1 + len(MARGIN_FACTORS))

    @property
    def axis_seconds(self) -> float:
        """Virtual seconds of one axis recorded in all."""
        return len(self) * self.lanes_per_sample * self.experiment.duration_s


@dataclass(frozen=True, slots=True)
class Job:
    """A share of a plan, to be run anywhere: samples `first` up to before `first + len(gains)`."""

    first: int
    experiment: StepExperiment
    gains: Floats
    plants: tuple[Plant, ...]
    plant_of: npt.NDArray[np.int64] | None


@dataclass(frozen=True, slots=True)
class JobResult:
    """The results of a job's samples: an array of shape (samples,) for each of RESULTS."""

    first: int
    columns: dict[str, Floats]


@dataclass(frozen=True, slots=True)
class SweepResult:
    """The table: by name an array of shape (samples,), the plan's inputs first; samples not done are left out."""

    columns: dict[str, Floats]
    wanted: int

    def __len__(self) -> int:
        return len(self.columns[MARGIN])

    @property
    def complete(self) -> bool:
        """Whether every sample was done."""
        return len(self) == self.wanted

    @property
    def input_names(self) -> tuple[str, ...]:
        """Columns that were given rather than found."""
        return tuple(name for name in self.columns if name not in RESULTS)


def sweep(
    plan: SweepPlan,
    executor: Executor | None = None,
    *,
    progress: Progress | None = None,
    samples_per_job: int | None = None,
) -> SweepResult:
    """Run a plan on an executor, or in this thread without one.

    KeyboardInterrupt ends it with what has been done by then. Errors of a job are raised.
    """
    jobs = split(plan, samples_per_job or _samples_per_job(plan))
    done: list[JobResult] = []
    count = 0
    tell = progress or (lambda done, wanted: None)
    try:
        with closing(_here(jobs) if executor is None else _results(executor, jobs)) as results:
            tell(0, len(plan))
            for result in results:
                done.append(result)
                count += len(result.columns[MARGIN])
                tell(count, len(plan))
    except KeyboardInterrupt:
        pass
    return _table(plan, done)


def _samples_per_job(plan: SweepPlan) -> int:
    return max(1, int(AXIS_SECONDS_PER_JOB * len(plan) / plan.axis_seconds))


def split(plan: SweepPlan, samples_per_job: int) -> list[Job]:
    """The plan as jobs of at most so many samples."""
    jobs = []
    for first in range(0, len(plan), samples_per_job):
        share = slice(first, first + samples_per_job)
        plants, plant_of = (), None
        if plan.plant_of is not None:
            used, plant_of = np.unique(plan.plant_of[share], return_inverse=True)
            plants = tuple(plan.plants[index] for index in used)
        jobs.append(Job(first, plan.experiment, plan.gains[share], plants, plant_of))
    return jobs


def run_job(job: Job) -> JobResult:
    """Run a job's samples in one batch. Depends on nothing but the job."""
    factors = np.array((1.0, *MARGIN_FACTORS))
    samples, phases = len(job.gains), np.array(job.experiment.phases)
    gains = np.repeat(job.gains[:, np.newaxis], len(factors), axis=1)
    gains[:, :, FEEDBACK_GAINS] *= factors[:, np.newaxis]
    lanes_per_sample = len(factors) * len(phases)
    lanes = Lanes(
        gains=np.repeat(gains.reshape(-1, gains.shape[2]), len(phases), axis=0),
        phases=np.tile(phases, samples * len(factors)),
        plants=job.plants,
        plant_of=None if job.plant_of is None else np.repeat(job.plant_of, lanes_per_sample),
    )
    responses = measure_lanes(job.experiment, lanes)
    shape = (samples, len(factors), len(phases))
    columns = {name: worst(name, responses.measures[name].reshape(shape)[:, 0, :]) for name in NAMES}
    tripped = responses.tripped.reshape(shape)
    ripple = np.where(tripped, np.inf, responses.measures["ripple_v"].reshape(shape))
    columns[MARGIN] = chatter_margin(ripple.max(axis=2), factors)
    columns[TRIPPED] = np.asarray(tripped[:, 0].any(axis=1), np.float64)
    return JobResult(job.first, columns)


SIGNED = frozenset({"steady_error_counts", "resting_drift_counts"})
"""Results of which more either way is worse."""


def worst(name: str, values: Floats) -> Floats:
    """The worst over the last axis: the largest, of a signed result the largest either way."""
    if name not in SIGNED:
        return np.asarray(values.max(axis=-1))
    at = np.abs(values).argmax(axis=-1)[..., np.newaxis]
    return np.asarray(np.take_along_axis(values, at, axis=-1)[..., 0])


def chatter_margin(ripple_v: Floats, factors: Floats) -> Floats:
    """The largest of `factors` (rising, from 1) up to which the ripple at rest stays within CHATTER_RIPPLE_V; 0
    where it does not even at 1. `ripple_v` is of shape (samples, factors), infinite where the drive was shut down."""
    quiet = (ripple_v <= CHATTER_RIPPLE_V).cumprod(axis=1).sum(axis=1)
    return np.concatenate(([0.0], factors))[quiet]


def _results(executor: Executor, jobs: Sequence[Job]) -> Generator[JobResult, None, None]:
    """Results as they come; when the iteration ends early, what has not begun is given up."""
    futures = [executor.submit(run_job, job) for job in jobs]
    try:
        for future in as_completed(futures):
            yield future.result()
    finally:
        for future in futures:
            future.cancel()


def _here(jobs: Sequence[Job]) -> Generator[JobResult, None, None]:
    for job in jobs:
        yield run_job(job)


def _table(plan: SweepPlan, results: Sequence[JobResult]) -> SweepResult:
    """The inputs and results of the samples that were done, in the plan's order."""
    ordered = sorted(results, key=lambda result: result.first)
    spans = [np.arange(result.first, result.first + len(result.columns[MARGIN])) for result in ordered]
    done = np.concatenate(spans) if spans else np.zeros(0, np.int64)
    columns = {name: plan.gains[done, place] for place, name in enumerate(GAIN_COMMANDS)}
    columns |= {name: values[done] for name, values in plan.inputs}
    for name in RESULTS:
        columns[name] = np.concatenate([result.columns[name] for result in ordered] or [np.zeros(0)])
    return SweepResult(columns, len(plan))

"""What a measurement comes to: a median, how far its repetitions spread, and how it compares.

A figure in seconds means little on a machine that is shared and changes its speed from one minute to the next. So
wherever there is something to compare with, the reference is measured in the same run, in alternation with the subject,
and the ratio is the median of the ratios of neighbours: what slows both down cancels out.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class Reach:
    """What a figure should get to, given on the figure itself or on its ratio to the reference."""

    bound: float
    of: Literal["measured", "ratio"] = "measured"
    at_least: bool = False

    def met_by(self, value: float) -> bool:
        return value >= self.bound if self.at_least else value <= self.bound

    @property
    def text(self) -> str:
        return f"{'>=' if self.at_least else '<='} {self.bound:g}{'x ref' if self.of == 'ratio' else ''}"


@dataclass(frozen=True, kw_only=True)
class Reference:
    """What a figure is compared with; `samples` has one value for each of the figure's, taken next to it."""

    name: str
    samples: Sequence[float]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One line of the table. `samples` are its repetitions, in `unit`."""

    name: str
    unit: str
    samples: Sequence[float]
    reference: Reference | None = None
    reach: Reach | None = None
    note: str = ""

    def __post_init__(self) -> None:
        if not self.samples:
            raise ValueError(f"{self.name}: nothing was measured")
        if self.reference is not None and len(self.reference.samples) != len(self.samples):
            raise ValueError(f"{self.name}: each sample needs a reference sample next to it")

    @property
    def measured(self) -> float:
        """Median of the repetitions."""
        return median(self.samples)

    @property
    def ratio(self) -> float | None:
        """Median of sample over neighbouring reference sample; None without a reference or where that is 0."""
        if self.reference is None or not all(self.reference.samples):
            return None
        return median(own / other for own, other in zip(self.samples, self.reference.samples, strict=True))

    @property
    def met(self) -> bool | None:
        """Whether the reach is met; None if there is none, or nothing to judge it by."""
        value = self.measured if self.reach is None or self.reach.of == "measured" else self.ratio
        return None if self.reach is None or value is None else self.reach.met_by(value)

    def as_json(self, group: str, load_average: float) -> dict[str, object]:
        """The figure as plain values; the keys are always the same."""
        reference = self.reference
        return {
            "group": group,
            "name": self.name,
            "unit": self.unit,
            "measured": self.measured,
            "low": min(self.samples),
            "high": max(self.samples),
            "samples": list(self.samples),
            "reference": None if reference is None else reference.name,
            "reference_measured": None if reference is None else median(reference.samples),
            "reference_samples": None if reference is None else list(reference.samples),
            "ratio": self.ratio,
            "reach": None if self.reach is None else self.reach.text,
            "met": self.met,
            "note": self.note,
            "load_average": load_average,
        }


@dataclass(frozen=True)
class Effort:
    """How much to do: `quick` for a look, else enough for figures worth keeping."""

    quick: bool

    def of(self, quick: float, full: float) -> float:
        return quick if self.quick else full

    def times(self, quick: int, full: int) -> int:
        return quick if self.quick else full


def percentile(values: Sequence[float], percent: float) -> float:
    """The value below which `percent` of `values` (not empty) lie."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(len(ordered) * percent / 100))]


def load_average() -> float:
    """Processes that wanted a processor over the last minute; 0 where the system does not tell."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0

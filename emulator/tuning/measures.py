"""The measures of a step response, in the definitions of the tuning guides.

They are not all the textbook's (Aries User Guide p. 82, APEX615n Installation Guide p. 77): rise time is the
time to pass the setpoint, and settling time runs from the moment the *commanded* position reaches the setpoint. What
never happens within the recording takes infinitely long (`inf`), so that tables sort as one expects.

`measure_steps` does whole batches: arrays of shape (lanes, rows), one vectorised pass for all of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Signal = npt.NDArray[Any]

RESTING_SHARE = 0.3
"""The last part of a recording that counts as rest: steady-state error and ripple are taken there (design choice)."""

HELD_SHARE = 0.1
"""The last part of a recording that must lie wholly within the band for the response to have settled at all, so that an
oscillation caught by chance as it passes the setpoint does not count (design choice)."""

DEFAULT_SETTLE_PERCENT = 2.0
"""Half-width of the settling band where neither it nor a target zone is given, percent of the step (design choice)."""


@dataclass(frozen=True, slots=True)
class StepMeasures:
    """One step response. Times run from the start of the commanded move, settling from its end; `inf` = never."""

    overshoot_percent: float
    """Largest excursion beyond the setpoint, percent of the step; 0 if there is none."""
    overswing_percent: float
    """Largest excursion beyond where it comes to rest, percent of the step: the overshoot proper where a load keeps
    the axis from the setpoint. Not one of the guide's measures; the verdict goes by it."""
    rise_s: float
    """Time at which the actual position first reaches the setpoint."""
    time_to_half_s: float
    """Time at which it first reaches half the step."""
    time_to_90_s: float
    """Time at which it first reaches 90 % of the step."""
    settling_s: float
    """From when the commanded position reaches the setpoint to when the actual position stays within the band."""
    steady_error_counts: float
    """Setpoint less mean actual position at rest."""
    resting_swing_counts: float
    """Peak-to-peak of the actual position at rest."""
    resting_drift_counts: float
    """Mean actual position in the second half of the rest less that in the first: a creep, not an oscillation."""
    peak_output_v: float
    """Largest magnitude of the output."""
    ripple_v: float
    """Peak-to-peak of the output at rest."""

    @property
    def settled(self) -> bool:
        """Whether it settled within the recording."""
        return math.isfinite(self.settling_s)


NAMES = tuple(field.name for field in fields(StepMeasures))
"""The measures in the order in which tables show them."""


@dataclass(frozen=True, slots=True)
class StepBatch:
    """The measures of many responses: by name an array of shape (lanes,)."""

    columns: dict[str, Floats]

    def __len__(self) -> int:
        return len(self.columns[NAMES[0]])

    def __getitem__(self, name: str) -> Floats:
        return self.columns[name]

    def lane(self, lane: int) -> StepMeasures:
        """The measures of one response."""
        return StepMeasures(**{name: float(self.columns[name][lane]) for name in NAMES})


def measure_step(
    times_s: npt.ArrayLike,
    commanded: npt.ArrayLike,
    actual: npt.ArrayLike,
    output_v: npt.ArrayLike,
    *,
    start: float,
    setpoint: float,
    settle_counts: float | None = None,
    settle_percent: float | None = None,
) -> StepMeasures:
    """Measure one step from `start` to `setpoint` (counts): four arrays of shape (rows,), positions in counts.

    The settling band is `settle_counts` to each side of the setpoint (the target-zone distance, say) or
    `settle_percent` of the step; DEFAULT_SETTLE_PERCENT if neither is given.

    Raises:
        ValueError: no rows, arrays of different lengths, a step of no length, both kinds of band, a band below 0.
    """
    rows = [np.asarray(signal)[np.newaxis] for signal in (commanded, actual, output_v)]
    batch = measure_steps(
        times_s, *rows, start=start, setpoint=setpoint, settle_counts=settle_counts, settle_percent=settle_percent
    )
    return batch.lane(0)


def measure_steps(
    times_s: npt.ArrayLike,
    commanded: npt.ArrayLike,
    actual: npt.ArrayLike,
    output_v: npt.ArrayLike,
    *,
    start: float,
    setpoint: float,
    settle_counts: float | None = None,
    settle_percent: float | None = None,
) -> StepBatch:
    """Measure many steps at once: `times_s` of shape (rows,), the signals of shape (lanes, rows).

    `commanded` may also be of shape (1, rows), when all lanes were commanded alike. Otherwise as `measure_step`.
    """
    times = np.asarray(times_s, np.float64)
    command, position, output = (np.asarray(signal) for signal in (commanded, actual, output_v))
    _check_shapes(times, command, position, output)
    step = setpoint - start
    if step == 0.0 or not math.isfinite(step):
        raise ValueError(f"a step from {start:g} to {setpoint:g} counts has no length to measure")
    band = _band_counts(abs(step), settle_counts, settle_percent)
    sign = 1.0 if step > 0.0 else -1.0
    began_s, arrived_s = _commanded_times(times, command, start=start, setpoint=setpoint)
    resting = _resting_rows(len(times))
    rest = position[:, resting]
    rest_mean = rest.mean(axis=1, dtype=np.float64)
    furthest = _furthest(position, sign)
    return StepBatch(
        {
            "overshoot_percent": np.maximum(furthest - sign * setpoint, 0.0) * (100.0 / abs(step)),
            "overswing_percent": (furthest - sign * rest_mean) * (100.0 / abs(step)),
            "rise_s": _first_s(times, _reached(position, setpoint, sign)) - began_s,
            "time_to_half_s": _first_s(times, _reached(position, start + 0.5 * step, sign)) - began_s,
            "time_to_90_s": _first_s(times, _reached(position, start + 0.9 * step, sign)) - began_s,
            "settling_s": _settling_s(_within_from_s(times, position, setpoint, band), arrived_s),
            "steady_error_counts": setpoint - rest_mean,
            "resting_swing_counts": _peak_to_peak(rest),
            "resting_drift_counts": _drift(rest),
            "peak_output_v": np.maximum(output.max(axis=1), -output.min(axis=1)).astype(np.float64),
            "ripple_v": _peak_to_peak(output[:, resting]),
        }
    )


def _check_shapes(times: Floats, command: Signal, position: Signal, output: Signal) -> None:
    rows = times.shape[0] if times.ndim == 1 else 0
    if rows == 0:
        raise ValueError("there are no rows to measure")
    lanes = position.shape[0] if position.ndim else 0
    fits = position.shape == output.shape == (lanes, rows) and command.shape in {(lanes, rows), (1, rows)}
    if not fits or lanes == 0:
        shapes = ", ".join(str(array.shape) for array in (times, command, position, output))
        raise ValueError(f"times and signals do not fit together: shapes {shapes}")


def _band_counts(step: float, counts: float | None, percent: float | None) -> float:
    if counts is not None and percent is not None:
        raise ValueError("the settling band is given in counts or in percent, not both")
    if counts is None:
        counts = step * (DEFAULT_SETTLE_PERCENT if percent is None else percent) / 100.0
    if not counts >= 0.0:
        raise ValueError(f"a settling band of {counts:g} counts is not possible")
    return counts


def _resting_rows(rows: int) -> slice:
    return slice(rows - max(1, round(rows * RESTING_SHARE)), rows)


def _commanded_times(times: Floats, command: Signal, *, start: float, setpoint: float) -> tuple[Floats, Floats]:
    """When the commanded position was last at `start` before it moved, and when it reached the setpoint, s."""
    moved = command != start
    leaves = np.where(moved.any(axis=1), np.maximum(moved.argmax(axis=1) - 1, 0), 0)
    return times[leaves], _first_s(times, _reached(command, setpoint, 1.0 if setpoint > start else -1.0))


def _reached(position: Signal, level: float, sign: float) -> npt.NDArray[np.bool_]:
    reached: npt.NDArray[np.bool_] = position >= level if sign > 0.0 else position <= level
    return reached


def _furthest(position: Signal, sign: float) -> Floats:
    furthest = position.max(axis=1) if sign > 0.0 else -position.min(axis=1)
    return furthest.astype(np.float64)


def _first_s(times: Floats, holds: npt.NDArray[np.bool_]) -> Floats:
    """Time of the first row that holds, for each lane; inf where none does."""
    first = holds.argmax(axis=1)
    return np.where(holds[np.arange(len(holds)), first], times[first], np.inf)


def _within_from_s(times: Floats, position: Signal, setpoint: float, band: float) -> Floats:
    """Time from which on the position stays within the band; inf where it does not do so to the end."""
    outside = (position < setpoint - band) | (position > setpoint + band)
    rows = len(times)
    from_end = outside[:, ::-1].argmax(axis=1)
    inside_from = np.where(outside.any(axis=1), rows - from_end, 0)
    held = inside_from <= rows - max(1, round(rows * HELD_SHARE))
    return np.where(held, times[np.minimum(inside_from, rows - 1)], np.inf)


def _settling_s(within_from_s: Floats, arrived_s: Floats) -> Floats:
    """Never without a commanded position that arrives; 0 where the actual position was there first."""
    happens = np.isfinite(within_from_s) & np.isfinite(arrived_s)
    took_s = np.subtract(within_from_s, arrived_s, where=happens, out=np.full(len(happens), np.inf))
    return np.maximum(took_s, 0.0)


def _drift(rest: Signal) -> Floats:
    half = rest.shape[1] // 2
    if half == 0:
        return np.zeros(len(rest))
    drift: Floats = rest[:, -half:].mean(axis=1, dtype=np.float64) - rest[:, :half].mean(axis=1, dtype=np.float64)
    return drift


def _peak_to_peak(signal: Signal) -> Floats:
    return (signal.max(axis=1) - signal.min(axis=1)).astype(np.float64)

"""Pictures of recordings with matplotlib (`oem6250[plot]`): signals grouped by unit into panels, steps marked.

`draw_signals` is general; `draw_step` shows one step response: commanded against actual position, the error and the
output below, overshoot, rise and settling time marked in the guide's definitions (see `measures`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from emulator.tuning.measures import DEFAULT_SETTLE_PERCENT, StepMeasures
from emulator.tuning.verdict import milliseconds

WIDTH_IN = 9.0
PANEL_HEIGHT_IN = 2.4
DOTS_PER_INCH = 110
MARK_COLOUR = "0.45"
VIEW_FACTOR = 4.0
"""A step is shown up to so many times the moment it settles: the rest is a straight line (design choice)."""


class NoPictures(RuntimeError):
    """matplotlib is not installed; the message is one line."""


@dataclass(frozen=True, slots=True)
class Shown:
    """A signal in a picture: its values, shape (rows,), and its unit; signals of like unit share a panel."""

    values: npt.ArrayLike
    unit: str


@dataclass(frozen=True, slots=True)
class StepMarks:
    """What marks a step: its measures, the positions it went between, when its commanded move began and ended, s."""

    measures: StepMeasures
    start: float
    setpoint: float
    began_s: float
    arrived_s: float
    band_counts: float


def available() -> bool:
    """Whether pictures can be drawn here."""
    from importlib.util import find_spec

    return find_spec("matplotlib") is not None


def draw_step(
    path: str | Path,
    times_s: npt.ArrayLike,
    commanded: npt.ArrayLike,
    actual: npt.ArrayLike,
    output_v: npt.ArrayLike,
    measures: StepMeasures,
    title: str,
    *,
    setpoint: float | None = None,
    settle_counts: float | None = None,
) -> None:
    """Draw one step response into `path` (png, svg, pdf); arrays of shape (rows,), positions in counts.

    The setpoint is the last commanded position unless given. Raises NoPictures without matplotlib, OSError and
    ValueError for a path that cannot be written.
    """
    times, command, position = (np.asarray(signal, np.float64) for signal in (times_s, commanded, actual))
    goal = float(command[-1]) if setpoint is None else setpoint
    start = float(command[0])
    moved, arrived = command != start, (command >= goal) if goal > start else (command <= goal)
    band = abs(goal - start) * DEFAULT_SETTLE_PERCENT / 100.0 if settle_counts is None else settle_counts
    marks = StepMarks(
        measures,
        start,
        goal,
        began_s=float(times[max(int(moved.argmax()) - 1, 0)]),
        arrived_s=float(times[int(arrived.argmax())]) if arrived.any() else math.inf,
        band_counts=band,
    )
    signals = {
        "commanded": Shown(command, "counts"),
        "actual": Shown(position, "counts"),
        "position error": Shown(command - position, "counts of error"),
        "output": Shown(output_v, "V"),
    }
    until_s = marks.arrived_s + VIEW_FACTOR * max(measures.settling_s, marks.arrived_s - marks.began_s)
    draw_signals(path, times, signals, title, marks=marks, until_s=until_s)


def draw_signals(
    path: str | Path,
    times_s: npt.ArrayLike,
    signals: Mapping[str, Shown],
    title: str,
    *,
    marks: StepMarks | None = None,
    until_s: float = math.inf,
) -> None:
    """Draw named signals over time, one panel for each unit in the order of first appearance; step marks go into the
    first panel. Raises as `draw_step`; ValueError without signals."""
    if not signals:
        raise ValueError("there are no signals to draw")
    figure_class = _figure_class()
    times = np.asarray(times_s, np.float64)
    units = list(dict.fromkeys(shown.unit for shown in signals.values()))
    figure = figure_class(figsize=(WIDTH_IN, 1.0 + PANEL_HEIGHT_IN * len(units)), layout="constrained")
    panels = figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0]
    for panel, unit in zip(panels, units, strict=True):
        _draw_panel(panel, times, {name: shown for name, shown in signals.items() if shown.unit == unit}, unit)
    if marks is not None:
        _mark_step(panels[0], marks)
    panels[-1].set_xlabel("time, s")
    panels[0].set_xlim(times[0], min(times[-1], until_s) if len(times) > 1 else times[0] + 1.0)
    figure.suptitle(title)
    figure.savefig(path, dpi=DOTS_PER_INCH)


def _figure_class() -> Any:
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise NoPictures("pictures need matplotlib: pip install 'oem6250[plot]'") from None

    def figure(**options: Any) -> Any:
        made = Figure(**options)
        FigureCanvasAgg(made)
        return made

    return figure


def _draw_panel(panel: Any, times: npt.NDArray[np.float64], signals: Mapping[str, Shown], unit: str) -> None:
    for name, shown in signals.items():
        panel.plot(times, np.asarray(shown.values), label=name, linewidth=1.1, drawstyle="steps-post")
    panel.set_ylabel(unit)
    panel.grid(visible=True, alpha=0.3)
    panel.legend(loc="right", fontsize="small")


def _mark_step(panel: Any, marks: StepMarks) -> None:
    measures = marks.measures
    panel.axhspan(marks.setpoint - marks.band_counts, marks.setpoint + marks.band_counts, alpha=0.15, color="green")
    panel.axhline(marks.setpoint, color=MARK_COLOUR, linewidth=0.6)
    step = marks.setpoint - marks.start
    if measures.overshoot_percent > 0.0:
        peak = marks.setpoint + step * measures.overshoot_percent / 100.0
        panel.axhline(peak, color=MARK_COLOUR, linewidth=0.6, linestyle=":")
    for at_s in _moments_s(marks):
        panel.axvline(at_s, color=MARK_COLOUR, linewidth=0.8, linestyle="--")
    text = (
        f"overshoot {measures.overshoot_percent:.1f} %\n"
        f"rise time {_with_unit(measures.rise_s)}\nsettling time {_with_unit(measures.settling_s)}"
    )
    panel.text(0.99, 0.04, text, transform=panel.transAxes, ha="right", va="bottom", fontsize="small")


def _moments_s(marks: StepMarks) -> Sequence[float]:
    """Where the rise ends, where the commanded position arrives, and where the axis has settled, s."""
    measures = marks.measures
    moments = (marks.began_s + measures.rise_s, marks.arrived_s, marks.arrived_s + measures.settling_s)
    return [moment for moment in moments if math.isfinite(moment)]


def _with_unit(seconds: float) -> str:
    shown = milliseconds(seconds)
    return shown if shown == "never" else f"{shown} ms"

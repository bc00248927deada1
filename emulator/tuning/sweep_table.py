"""What a sweep found, for people and for other programs: the best sets, and the table as CSV, JSON or npz."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.engine.converter import OUTPUT_RANGE_V
from emulator.tuning.gains import tidy
from emulator.tuning.measures import Floats
from emulator.tuning.sweep import MARGIN, RESULTS, TRIPPED, SweepResult, worst
from emulator.tuning.verdict import milliseconds

SORTS = {
    "settling": "settling_s",
    "overshoot": "overshoot_percent",
    "rise": "rise_s",
    "t90": "time_to_90_s",
    "error": "steady_error_counts",
    "output": "peak_output_v",
    "ripple": "ripple_v",
    "margin": MARGIN,
}
"""What the best sets can be sorted by, and the column that is."""

TIES = ("settling_s", "overshoot_percent", "time_to_90_s", "ripple_v")
"""What decides between sets that are equal in what they are sorted by, the most important first."""

FORM = "oem6250 sweep 1"
"""Names the form of the JSON file."""


def best_sets(result: SweepResult, *, sort: str = "settling", count: int = 10) -> dict[str, Floats]:
    """The best gain sets, best first: by column an array of shape (sets,), the worst over the plants each set met.

    Sets that chatter or trip come after all that do not, whatever they are sorted by.
    """
    sets = _worst_over_plants(result)
    key = SORTS[sort]
    rank = {MARGIN: -sets[MARGIN], "steady_error_counts": np.abs(sets["steady_error_counts"])}
    restless = (sets[MARGIN] == 0.0) | (sets[TRIPPED] > 0.0)
    order = np.lexsort([*(rank.get(name, sets[name]) for name in reversed((key, *TIES))), restless])[:count]
    return {name: values[order] for name, values in sets.items()}


def _worst_over_plants(result: SweepResult) -> dict[str, Floats]:
    """One row for each gain set. The inputs other than gains fall away where a set met more than one plant."""
    gains = np.column_stack([result.columns[name] for name in GAIN_COMMANDS])
    if not len(gains):
        return {name: values for name, values in result.columns.items() if name in (*GAIN_COMMANDS, *RESULTS)}
    sets, set_of = np.unique(gains, axis=0, return_inverse=True)
    set_of = set_of.reshape(-1)
    found: dict[str, Floats] = {name: sets[:, place] for place, name in enumerate(GAIN_COMMANDS)}
    bounds = np.searchsorted(np.sort(set_of), np.arange(1, len(sets)))
    rows = np.split(np.argsort(set_of, kind="stable"), bounds)
    for name, values in result.columns.items():
        if name in result.input_names:
            continue
        found[name] = np.array([values[own].min() if name == MARGIN else worst(name, values[own]) for own in rows])
    return found


HEADINGS: tuple[tuple[str, str, Callable[[float], str]], ...] = (
    ("overshoot %", "overshoot_percent", lambda value: f"{value:.1f}"),
    ("t90 ms", "time_to_90_s", milliseconds),
    ("rise ms", "rise_s", milliseconds),
    ("settling ms", "settling_s", milliseconds),
    ("error", "steady_error_counts", lambda value: f"{value:.1f}"),
    ("peak V", "peak_output_v", lambda value: f"{value:.2f}"),
    ("ripple V", "ripple_v", lambda value: f"{value:.3f}"),
    ("margin", MARGIN, lambda value: f"{value:g}x" if value else "none"),
)
"""Columns of the printed table: heading, column, how a value is shown."""


def render_sets(sets: dict[str, Floats]) -> str:
    """The sets as a table of text; gains that are alike in all of them and do nothing are left out, except SGP."""
    count = len(sets[MARGIN])
    shown = [name for name in GAIN_COMMANDS if name == "SGP" or _says_something(name, sets[name])]
    rows = [[*shown, *(heading for heading, _, _ in HEADINGS)]]
    for row in range(count):
        gains = [tidy(float(f"{sets[name][row]:.6g}")) for name in shown]
        rows.append([*gains, *(show(float(sets[column][row])) for _, column, show in HEADINGS)])
    return columns_of(rows)


def _says_something(name: str, values: Floats) -> bool:
    """Whether a column of gains differs anywhere, or from what it is when it does nothing."""
    idle = values >= OUTPUT_RANGE_V if name == "SGILIM" else values == 0.0
    return len(np.unique(values)) > 1 or not bool(idle.all())


def columns_of(rows: list[list[str]]) -> str:
    """Rows of cells under one another, to the right of their columns."""
    widths = [max(len(row[place]) for row in rows) for place in range(len(rows[0]))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def write_table(path: Path, result: SweepResult) -> None:
    """Write every sample to `path`, in the form its ending names; OSError if that is not possible."""
    WRITERS[path.suffix](path, result)


def _write_csv(path: Path, result: SweepResult) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(result.columns)
        writer.writerows(zip(*(values.tolist() for values in result.columns.values()), strict=True))


def _write_npz(path: Path, result: SweepResult) -> None:
    np.savez_compressed(path, **result.columns)  # type: ignore[arg-type]


def _write_json(path: Path, result: SweepResult) -> None:
    """JSON has no infinity: what never happened is null."""
    columns = {
        name: [value if math.isfinite(value) else None for value in values.tolist()]
        for name, values in result.columns.items()
    }
    content = {"form": FORM, "complete": result.complete, "wanted": result.wanted, "columns": columns}
    path.write_text(json.dumps(content, allow_nan=False) + "\n", encoding="utf-8")


WRITERS: dict[str, Callable[[Path, SweepResult], None]] = {".csv": _write_csv, ".npz": _write_npz, ".json": _write_json}
"""Endings of table files, and what writes each."""

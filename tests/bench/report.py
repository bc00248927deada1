"""The table for people and the JSON for programs."""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from os import cpu_count
from pathlib import Path

from tests.bench.figures import Figure, load_average

SCHEMA = 1
COLUMNS = ("name", "measured", "spread", "reference", "ratio", "reach", "met?", "load")


class Report:
    """Figures as they come, with the load average the machine had when each group began."""

    def __init__(self, *, quick: bool) -> None:
        self._quick = quick
        self._began = datetime.now(UTC)
        self._load_average = load_average()
        self._rows: list[tuple[str, float, Figure]] = []
        self._failures: dict[str, str] = {}

    def add(self, group: str, group_load_average: float, figures: Sequence[Figure]) -> None:
        self._rows += [(group, group_load_average, figure) for figure in figures]

    def fail(self, group: str, reason: str) -> None:
        """A group that could not be measured; the others still count."""
        self._failures[group] = reason

    @property
    def whole(self) -> bool:
        return not self._failures

    def header(self) -> str:
        return (
            f"{platform.machine()}, {cpu_count()} processors, Python {platform.python_version()}, "
            f"load average {self._load_average:.2f} at the start"
        )

    def table(self) -> str:
        """One line a figure, in columns; then notes and failures."""
        cells = [COLUMNS, *(_cells(figure, load) for _, load, figure in self._rows)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells
        ]
        lines.insert(1, "  ".join("-" * width for width in widths))
        notes = [f"{figure.name}: {figure.note}" for _, _, figure in self._rows if figure.note]
        failures = [f"{group}: NOT MEASURED: {reason}" for group, reason in self._failures.items()]
        return "\n".join([*lines, "", *notes, *failures])

    def write(self, path: Path) -> None:
        """The same as JSON; OSError if it cannot be written."""
        content = {
            "schema": SCHEMA,
            "quick": self._quick,
            "began": self._began.isoformat(timespec="seconds"),
            "took_s": round((datetime.now(UTC) - self._began).total_seconds(), 1),
            "host": {
                "platform": platform.platform(),
                "machine": platform.machine(),
                "processors": cpu_count(),
                "python": sys.version.split()[0],
                "load_average": self._load_average,
            },
            "figures": [figure.as_json(group, load) for group, load, figure in self._rows],
            "failures": self._failures,
        }
        path.write_text(json.dumps(content, indent=1) + "\n")


def _cells(figure: Figure, load: float) -> tuple[str, ...]:
    reference = figure.as_json("", load)
    middle = reference["reference_measured"]
    return (
        figure.name,
        f"{number(figure.measured)} {figure.unit}",
        f"{number(min(figure.samples))} .. {number(max(figure.samples))}",
        "" if figure.reference is None else f"{number(float(str(middle)))} ({figure.reference.name})",
        "" if figure.ratio is None else f"{figure.ratio:.2f}",
        "" if figure.reach is None else figure.reach.text,
        {True: "yes", False: "NO", None: ""}[figure.met],
        f"{load:.1f}",
    )


def number(value: float) -> str:
    """Three or four digits that matter."""
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.2f}" if abs(value) >= 1 else f"{value:.3f}"

"""`python -m tests.bench [--quick] [--json bench.json] [--only NAME ...]`: measure, print a table, write JSON.

Nothing here is a test: a figure that misses its reach says so in the table and changes no exit status, because
machines are shared and figures belong to a machine. Exit status 1 means that something could not be measured.
"""

from __future__ import annotations

import argparse
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from tests.bench.figures import Effort, Figure, load_average
from tests.bench.report import Report

GROUPS = {
    "help": "help_time",
    "start": "start",
    "kernel": "kernel",
    "c-loop": "c_loop",
    "scope": "scope",
    "plants": "plants",
    "following": "following",
    "controller": "controller",
    "interpreter": "interpreter",
    "round-trip": "round_trip",
    "transports": "transports",
    "pacing": "pacing",
    "staleness": "staleness",
    "footprint": "footprint",
    "state": "acknowledged",
    "sweep": "sweep",
    "testing": "testing",
    "client": "client_overhead",
    "rmc": "rmc",
    "compiled": "compiling",
}
"""What can be asked for with --only, and the module whose `measure(effort)` does it."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the groups asked for, one after another."""
    parsed = _parser().parse_args(arguments)
    report = Report(quick=parsed.quick)
    print(report.header(), flush=True)
    for group in parsed.only or GROUPS:
        _run(report, group, Effort(parsed.quick))
    print(f"\n{report.table()}")
    report.write(parsed.json)
    print(f"\nwritten to {parsed.json}")
    return 0 if report.whole else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description="Measure the emulator.")
    parser.add_argument("--quick", action="store_true", help="fewer and shorter repetitions: under a minute")
    parser.add_argument("--json", type=Path, default=Path("bench.json"), metavar="FILE", help="default: bench.json")
    parser.add_argument("--only", nargs="+", choices=GROUPS, metavar="NAME", help=f"of: {', '.join(GROUPS)}")
    return parser


def _run(report: Report, group: str, effort: Effort) -> None:
    """Measure one group; what goes wrong there is told and spoils nothing else."""
    print(f"measuring {group} ...", file=sys.stderr, flush=True)
    before = load_average()
    try:
        figures: list[Figure] = import_module(f"tests.bench.{GROUPS[group]}").measure(effort)
    except Exception as error:
        traceback.print_exc()
        report.fail(group, f"{type(error).__name__}: {error}")
    else:
        report.add(group, before, figures)


if __name__ == "__main__":
    sys.exit(main())

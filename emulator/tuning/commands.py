"""`oem6250 tune` and `oem6250 sweep`: their options, and what leads from them to the work.

Only argparse is imported at the top, so that `--help` stays quick. Mistakes of the user are one line and exit status 2.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from emulator.tuning import SWEPT_GAINS

if TYPE_CHECKING:
    from emulator.tuning.sampling import Span

AXES = 2
SORTS = ("settling", "overshoot", "rise", "t90", "error", "output", "ripple", "margin")
TABLE_ENDINGS = (".csv", ".npz", ".json")
MAX_DURATION_S = 100.0

TUNE_EXAMPLES = """\
examples:
  oem6250 tune axis.toml                                     walk the guide's procedure on axis 1
  oem6250 tune axis.toml --axis 2 --out pictures             axis 2, with a picture of each response
  oem6250 tune axis.toml --gains SGP=2 SGP=15 SGP=15,SGV=2   the responses with these gains
"""

SWEEP_EXAMPLES = """\
examples:
  oem6250 sweep axis.toml --sgp 5:100:20 --sgv 0,1,2 --out table.csv
  oem6250 sweep axis.toml --sgp 5:100 --sgv 0:5 --random 1000 --vary plant.inertia_kg_m2=0.8:1.2
  oem6250 sweep axis.toml --sgp 5:100:200 --sgv 0:5:50 --cluster tcp://scheduler:8786
"""


def add_tune(commands: argparse._SubParsersAction[Any]) -> None:
    """Add `tune` to the command line."""
    tune = commands.add_parser(
        "tune",
        description="Walk the guide's tuning procedure (SGP, SGV, SGI, feedforward) on an emulated axis, or show the "
        "step responses with given gains.",
        epilog=TUNE_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_common(tune)
    add = tune.add_argument
    add("--gains", nargs="+", metavar="SGP=15,SGV=2", help="show the responses with these gains instead, a step for "
        "each; gains not named are as in the machine")  # fmt: skip
    add(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="write a picture of each response (needs matplotlib) and table.csv here",
    )
    tune.set_defaults(carry_out=run_tune, fail=tune.error)


def add_sweep(commands: argparse._SubParsersAction[Any]) -> None:
    """Add `sweep` to the command line."""
    sweep = commands.add_parser(
        "sweep",
        description="Try a grid or a random sample of gains and plants in parallel: overshoot, settling time, peak "
        "output, ripple and margin to chatter of each, and the best sets. A range is LOW:HIGH:COUNT, a list 0,1,2 or "
        "one number; with --random LOW:HIGH. Gains without one stay as in the machine.",
        epilog=SWEEP_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    _add_common(sweep)
    add = sweep.add_argument
    for name in SWEPT_GAINS:
        add(f"--{name.lower()}", type=_span, metavar="RANGE", help=f"values of {name}")
    add("--vary", action="append", default=[], metavar="plant.NAME=RANGE", help="multiply a quantity of the plant by "
        "these factors; may be repeated")  # fmt: skip
    add("--random", type=_whole(1), metavar="N", help="N random samples instead of the grid of all combinations")
    add("--seed", type=_whole(0), default=0, metavar="S", help="seed of the random samples (default: 0)")
    add("--jobs", type=_jobs, default=None, metavar="N|auto", help="processors to use (default: auto, all)")
    add("--cluster", metavar="ADDRESS", help="use the Dask cluster with this scheduler instead")
    add("--out", type=_table_path, metavar="TABLE.csv|.npz|.json", help="write every sample here")
    add("--best", type=_whole(0), default=10, metavar="N", help="show the N best gain sets (default: 10)")
    add("--sort", choices=SORTS, default="settling", help="what best means (default: settling)")
    add("-v", dest="verbose", action="store_true", help="show progress even if stderr is no terminal")
    sweep.set_defaults(carry_out=run_sweep, fail=sweep.error)


def _add_common(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("machine", metavar="MACHINE.toml", help="machine file")
    add("--axis", type=int, choices=range(1, AXES + 1), default=1, help="axis (default: 1)")
    add("--duration", type=_duration, default=1.0, metavar="S", help="seconds recorded of each step (default: 1)")
    add("--distance", type=_distance, default=100, metavar="COUNTS", help="length of the step, D (default: 100)")
    add("--settle", type=_band, metavar="COUNTS", help="half-width of the settling band (default: 2 %% of the step)")


def run_tune(parsed: argparse.Namespace) -> int:
    """Carry out `tune`; returns the exit status."""
    from emulator.machine import MachineError
    from emulator.tuning.procedure import NotTunable
    from emulator.tuning.rig import RigError
    from emulator.tuning.tune import tune

    try:
        return tune(parsed)
    except (MachineError, NotTunable, RigError, ValueError, OSError) as error:
        return _refuse(parsed, error)


def run_sweep(parsed: argparse.Namespace) -> int:
    """Carry out `sweep`; returns the exit status: 130 if it was interrupted."""
    from emulator.machine import MachineError
    from emulator.tuning.executors import ClusterError
    from emulator.tuning.sweep_run import run

    try:
        return run(parsed)
    except (MachineError, ClusterError, ValueError, OSError) as error:
        return _refuse(parsed, error)


def _refuse(parsed: argparse.Namespace, error: Exception) -> int:
    if isinstance(error, BrokenPipeError):
        raise error
    reason = " ".join(str(error).split())
    if isinstance(error, OSError) and error.filename is not None:
        reason = f"{error.filename}: {error.strerror}"
    parsed.fail(reason)
    return 2


def _span(text: str) -> Span:
    from emulator.tuning.sampling import parse_span

    try:
        return parse_span(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _whole(least: int) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not (text.isascii() and text.isdigit() and int(text) >= least):
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least {least}")
        return int(text)

    return parse


def _jobs(text: str) -> int | None:
    return None if text == "auto" else _whole(1)(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _duration(text: str) -> float:
    value = _number(text)
    if not 0.0 < value <= MAX_DURATION_S:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of seconds above 0, at most {MAX_DURATION_S:g}")
    return value


def _distance(text: str) -> int:
    digits = text.removeprefix("-")
    if not (digits.isascii() and digits.isdigit() and 0 < int(digits) <= 999_999_999):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of counts other than 0")
    return int(text)


def _band(text: str) -> float:
    value = _number(text)
    if not 0.0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of counts of at least 0")
    return value


def _table_path(text: str) -> Path:
    path = Path(text)
    if path.suffix not in TABLE_ENDINGS:
        raise argparse.ArgumentTypeError(f"{text!r} does not end in {', '.join(TABLE_ENDINGS)}")
    return path

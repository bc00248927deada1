"""What `oem6250 tune` does: responses one after another, a table of them, a picture of each, the gains to type."""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from emulator.controller.build import build_settings
from emulator.controller.changes import Changes
from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.engine import Gains
from emulator.machine import Machine
from emulator.tuning.experiment import gains_in_force
from emulator.tuning.gains import changed, parse_gains, row_of, short
from emulator.tuning.measures import NAMES
from emulator.tuning.pictures import available, draw_step
from emulator.tuning.procedure import Try, Walk
from emulator.tuning.rig import Rig, StepProfile, describe
from emulator.tuning.verdict import milliseconds, verdict

LINE = "{:>3}  {:>9}  {:>8}  {:>11}  {:>7}  {:>7}  {:>9}  {:<20}  {}"
HEADINGS = ("try", "overshoot", "rise ms", "settling ms", "error", "peak V", "ripple V", "verdict", "gains")


def tune(parsed: argparse.Namespace) -> int:
    """Walk the procedure, or show the given gains; returns the exit status.

    Raises:
        MachineError, NotTunable, RigError, ValueError, OSError: what the user can mend.
    """
    machine, axis_index = Machine.load(parsed.machine), parsed.axis - 1
    own = gains_in_force(build_settings(machine, Changes()), axis_index)
    profile = StepProfile(distance_counts=parsed.distance)
    rig = Rig(machine, axis_index, profile=profile, duration_s=parsed.duration, settle_counts=parsed.settle)
    given = [changed(own, parse_gains(text)) for text in parsed.gains or ()]
    walk = None if given else Walk(rig, own)
    if parsed.out is not None:
        _prepare(parsed.out)
    print(f"axis {parsed.axis}, step {describe(profile)}\n")
    print(LINE.format(*HEADINGS))
    made = _show(walk.tries() if walk is not None else _given(rig, given), parsed)
    if parsed.out is not None:
        _write_table(parsed.out / "table.csv", made)
    if walk is not None:
        _conclude(walk, rig)
    return 0


def _given(rig: Rig, gains: Sequence[Gains]) -> Iterator[Try]:
    for each in gains:
        response = rig.step(each)
        word = verdict(response.measures, step_counts=response.step_counts, tripped=response.tripped)
        yield Try("given", response, word)


def _show(tries: Iterator[Try], parsed: argparse.Namespace) -> list[Try]:
    """Print a line for each try as it is made, and draw its picture."""
    made = []
    for number, each in enumerate(tries, start=1):
        made.append(each)
        print(line_of(number, each), flush=True)
        if parsed.out is not None and available():
            _draw(parsed.out / f"step-{number:02}.png", number, each, parsed.settle)
    return made


def line_of(number: int, made: Try) -> str:
    """One line of the table; the reason follows where the walk had one."""
    measures = made.measures
    reason = "" if made.reason == "given" else f"    ({made.reason})"
    return LINE.format(
        number,
        f"{measures.overshoot_percent:.1f} %",
        milliseconds(measures.rise_s),
        milliseconds(measures.settling_s),
        f"{measures.steady_error_counts:.1f}",
        f"{measures.peak_output_v:.2f}",
        f"{measures.ripple_v:.3f}",
        made.verdict,
        short(made.gains) + reason,
    )


def _draw(path: Path, number: int, made: Try, settle_counts: float | None) -> None:
    response = made.response
    draw_step(
        path,
        response.times_s,
        response.commanded_counts,
        response.actual_counts,
        response.output_v,
        response.measures,
        f"{number}: {short(made.gains)}: {made.verdict}",
        setpoint=float(response.commanded_counts[0]) + response.step_counts,
        settle_counts=settle_counts,
    )


def _prepare(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    if not available():
        print("oem6250: no pictures without matplotlib: pip install 'oem6250[plot]'", file=sys.stderr)


def _write_table(path: Path, tries: Sequence[Try]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("try", *GAIN_COMMANDS, *NAMES, "verdict", "reason"))
        for number, made in enumerate(tries, start=1):
            measures = [getattr(made.measures, name) for name in NAMES]
            writer.writerow((number, *row_of(made.gains), *measures, made.verdict, made.reason))


def _conclude(walk: Walk, rig: Rig) -> None:
    print()
    for note in walk.notes:
        print(f"note: {note}")
    print(f"\nresult: {short(walk.gains)}\ntype:   {':'.join(rig.commands_for(walk.gains))}")

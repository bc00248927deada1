"""Recordings of the scope as files: CSV, numpy, pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from emulator.scope import Recording


def write_csv(path: Path, recording: Recording) -> None:
    """A line a row, the first column `time_s`; units stand in a comment line above the names.

    Floats are written in full: read back they are the same to the last bit.
    """
    units = ", ".join(f"{name} [{unit}]" for name, unit in recording.units.items() if unit)
    columns = [recording.time_s, *recording.values()]
    with path.open("w", encoding="utf-8") as file:
        file.write(f"# units: {units}\n" if units else "# no units\n")
        if recording.trigger_s is not None:
            file.write(f"# trigger at {recording.trigger_s!r} s\n")
        file.write(",".join(["time_s", *recording]) + "\n")
        for row in zip(*(column.tolist() for column in columns), strict=True):
            file.write(",".join(map(repr, row)) + "\n")


def write_npz(path: Path, recording: Recording) -> None:
    """An array a signal under its name, `time_s`, and `trigger_s` (NaN without a trigger)."""
    trigger_s = np.nan if recording.trigger_s is None else recording.trigger_s
    arrays = {**recording, "time_s": recording.time_s, "trigger_s": np.array(trigger_s)}
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **arrays)


def write_picture(path: Path, recording: Recording) -> None:
    """A picture, one panel a unit of measurement. NoPictures without matplotlib."""
    from emulator.tuning.pictures import Shown, draw_signals

    shown = {name: Shown(column, recording.units[name]) for name, column in recording.items()}
    draw_signals(path, recording.time_s, shown, path.stem)

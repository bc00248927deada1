"""`oem6250 scope`: run a file of commands on an emulated unit and record signals at servo rate into a file.

The commands are sent as a host would send them, all at once; the unit carries them out in turn, waiting for motion and
for T as always. Recording begins with the first of them, or around the trigger.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from emulator.emulator import Emulator
    from emulator.scope import Recording

SETTLE_S = 0.1
"""Recorded after the last command is done, unless --seconds tells how long."""
LONGEST_S = 600.0
"""Virtual time after which a program that does not end is recorded no further."""
SLICE_S = 0.05

DEFAULT_SIGNALS = ("position.commanded", "position.actual", "position.error", "servo.output", "dac")
"""Signals of axis 1 recorded when none are named."""

EXAMPLES = """\
examples:
  oem6250 scope axis.toml --run move.txt --out move.png
  oem6250 scope axis.toml --run move.txt --signals axis1.position.error,axis1.dac,output.1 --out move.csv
  oem6250 scope axis.toml --run move.txt --trigger "axis1.moving > 0" --pre-trigger 0.01 --seconds 0.2 --out move.npz
  oem6250 scope --list
"""


class CommandError(Exception):
    """Something the user can mend; the text is one line."""


def add_scope(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to the command line."""
    scope = commands.add_parser(
        "scope",
        description="Run commands on an emulated unit in virtual time and record any of its signals at servo rate.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = scope.add_argument
    add("machine", nargs="?", metavar="MACHINE.toml", help="machine file (default: two wired axes)")
    add("--run", metavar="FILE|-", help="commands to run, as a host would type them; - reads standard input")
    add("--signals", metavar="A,B,...", help="what to record (default: axis 1's positions, error and output)")
    add("--out", metavar="FILE", help="where to: .csv, .npz (numpy), .png or .svg (needs oem6250[plot])")
    add("--seconds", type=float, metavar="S", help="how long to record (default: until all commands are done)")
    add("--trigger", metavar="CONDITION", help='record around the moment at which it comes true: "axis1.dac > 2"')
    add("--pre-trigger", type=float, default=0.0, metavar="S", help="how much of it before the trigger (default: 0)")
    add("--every", type=int, default=1, metavar="N", help="one row every N servo samples (default: 1)")
    add("--list", action="store_true", help="list the signals that can be recorded")
    scope.set_defaults(carry_out=_do_scope, fail=scope.error)


def _do_scope(parsed: argparse.Namespace) -> int:
    fail: Callable[[str], NoReturn] = parsed.fail
    from emulator.machine import MachineError
    from emulator.scope import ScopeError

    try:
        if parsed.list:
            return _list_signals(parsed.machine)
        return _record(parsed)
    except (CommandError, MachineError, ScopeError) as error:
        fail(str(error))


def _list_signals(path: str | None) -> int:
    unit = _emulator(path).unit()
    signals = unit.scope.signals()
    width = max(map(len, signals))
    sys.stdout.writelines(
        f"{name:{width}}  {signal.sentence}{f', {signal.unit}' if signal.unit else ''}\n"
        for name, signal in signals.items()
    )
    return 0


def _record(parsed: argparse.Namespace) -> int:
    if parsed.run is None:
        raise CommandError("--run FILE is needed (or --list)")
    if parsed.out is None:
        raise CommandError("--out FILE is needed (.csv, .npz, .png or .svg)")
    write = _writer(Path(parsed.out))
    text = _commands(parsed.run)
    emulator = _emulator(parsed.machine)
    unit = emulator.unit()
    unit.read()
    names = _names(parsed.signals)
    every, pre_s = parsed.every, parsed.pre_trigger
    unit.scope.record(names, seconds=parsed.seconds, trigger=parsed.trigger, pre_trigger_s=pre_s, every=every)
    emulator.advance(pre_s + SLICE_S if parsed.trigger is not None else 0.0)
    unit.send(text)
    run_to_the_end(emulator)
    sys.stdout.write(unit.read().decode("latin-1").replace("\r", ""))
    recording = unit.scope.read()
    if parsed.trigger is not None and recording.trigger_s is None:
        raise CommandError(f"--trigger {parsed.trigger!r}: it did not come true within {emulator.time_s:.2f} s")
    from emulator.tuning.pictures import NoPictures

    try:
        write(Path(parsed.out), recording)
    except NoPictures as error:
        raise CommandError(f"--out {parsed.out}: {error}") from None
    except OSError as error:
        raise CommandError(f"--out {parsed.out}: cannot be written ({error.strerror})") from None
    span_s = recording.time_s[-1] - recording.time_s[0] if len(recording.time_s) else 0.0
    print(f"\n{parsed.out}: {len(recording)} signals, {len(recording.time_s)} rows, {span_s:.3f} s")
    return 0


def run_to_the_end(emulator: Emulator) -> None:
    """Let time pass until the unit has nothing more to do and the axes have come to rest, and a recording that has
    been triggered is full."""
    unit = emulator.unit()
    while unit.controller.busy and emulator.time_s < LONGEST_S:
        emulator.advance(SLICE_S)
    emulator.advance(SETTLE_S)
    while unit.scope.filling and emulator.time_s < LONGEST_S:
        emulator.advance(SLICE_S)
    unit.scope.stop()


def _emulator(path: str | None) -> Emulator:
    from emulator.emulator import Emulator
    from emulator.machine import Machine

    machine = Machine.load(path) if path is not None else Machine.default()
    return Emulator(machine, on_build=lambda message: print(f"oem6250: {message}", file=sys.stderr, flush=True))


def _commands(place: str) -> bytes:
    """The commands of a file, each line ended as a host would."""
    try:
        text = sys.stdin.read() if place == "-" else Path(place).read_text(encoding="latin-1")
    except OSError as error:
        raise CommandError(f"--run {place}: cannot be read ({error.strerror})") from None
    return "".join(line.strip() + "\r" for line in text.splitlines() if line.strip()).encode("latin-1", "replace")


def _names(text: str | None) -> list[str]:
    if text is None:
        return [f"axis1.{name}" for name in DEFAULT_SIGNALS]
    return [name.strip() for name in text.split(",") if name.strip()]


def _writer(path: Path) -> Callable[[Path, Recording], None]:
    from emulator.scope.files import write_csv, write_npz, write_picture

    writers = {".csv": write_csv, ".npz": write_npz}
    pictures = {".png": write_picture, ".svg": write_picture}
    writer = (writers | pictures).get(path.suffix.lower())
    if writer is None:
        raise CommandError(f"--out {path}: found {path.suffix or 'no suffix'!r}; allowed: .csv, .npz, .png, .svg")
    return writer

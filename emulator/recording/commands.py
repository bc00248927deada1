"""`oem6250 replay` and `oem6250 transcript`: the options, and what they print.

The parsers are made whenever the command line runs, so nothing is imported here before a command is carried out.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.machine import Machine
    from emulator.recording.replaying import Outcome

NS_PER_MS = 1_000_000
SAME, DIFFERENT, UNUSABLE = 0, 1, 2


def add_replay(commands: Any) -> None:
    """The parser of `oem6250 replay`."""
    replay = commands.add_parser(
        "replay",
        description="Run a recording (serve --record) again in virtual time and compare every byte and its time. "
        "Exit status: 0 the same, 1 different, 2 a file that cannot be used.",
        allow_abbrev=False,
    )
    add = replay.add_argument
    _add_source(replay)
    add("--machine", metavar="MACHINE.toml", help="replay on this machine instead of the recorded one")
    add("--line-timing-tolerance", type=_milliseconds, metavar="MS", help="times may differ by this much (default: "
        "exact; in a recording of a unit's line times do not count)")  # fmt: skip
    replay.set_defaults(carry_out=do_replay)


def add_transcript(commands: Any) -> None:
    """The parser of `oem6250 transcript`."""
    transcript = commands.add_parser(
        "transcript",
        description="Turn a recording into a test transcript: a session as plain text that the tests play to a unit.",
        allow_abbrev=False,
    )
    _add_source(transcript)
    transcript.add_argument("-o", dest="output", metavar="OUT", help="where to write it (default: stdout)")
    transcript.add_argument("--title", metavar="TEXT", help="what the session shows, one line (default: the file name)")
    transcript.add_argument("--machine", metavar="MACHINE.toml", help="the machine file of the transcript")
    transcript.set_defaults(carry_out=do_transcript)


def _add_source(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="the recording")
    parser.add_argument("--socat", action="store_true", help="FILE is what `socat -x` wrote about a line between a "
        "host (left) and a unit (right)")  # fmt: skip


def do_replay(parsed: argparse.Namespace) -> int:
    """Carry out `oem6250 replay`; the exit status."""
    from emulator.machine import MachineError
    from emulator.recording import RecordingError
    from emulator.recording.replaying import replay_entries

    try:
        machine = _machine(parsed.machine)
        with _source(parsed) as source:
            outcome = replay_entries(source.header, source, machine=machine, tolerance_ns=parsed.line_timing_tolerance)
            different = _other_versions(source.header) if outcome.difference else []
    except (RecordingError, MachineError) as error:
        return _unusable(parsed.file, error)
    return _report(parsed.file, outcome, different)


def do_transcript(parsed: argparse.Namespace) -> int:
    """Carry out `oem6250 transcript`; the exit status."""
    from emulator.machine import MachineError
    from emulator.recording import RecordingError
    from emulator.recording.transcribing import transcript

    try:
        machine = _text_of(parsed.machine)
        with _source(parsed) as source:
            text = transcript(source.header, source, title=parsed.title or Path(parsed.file).stem, machine=machine)
            cut = not source.complete and not source.header.from_line
    except (RecordingError, MachineError) as error:
        return _unusable(parsed.file, error)
    if cut:
        _say(f"{parsed.file}: the recording was cut; the transcript ends there")
    if parsed.output is None:
        sys.stdout.write(text)
        return SAME
    try:
        Path(parsed.output).write_text(text, encoding="utf-8")
    except OSError as error:
        return _unusable(parsed.output, f"cannot be written ({error.strerror})")
    return SAME


def _source(parsed: argparse.Namespace) -> Any:
    from emulator.recording.reading import Reader
    from emulator.recording.socat import SocatReader

    return SocatReader(parsed.file) if parsed.socat else Reader(parsed.file)


def _machine(path: str | None) -> Machine | None:
    from emulator.machine import Machine

    return None if path is None else Machine.load(path)


def _text_of(path: str | None) -> str | None:
    """The text of a machine file that can be used."""
    return None if _machine(path) is None or path is None else Path(path).read_text(encoding="utf-8")


def _other_versions(header: Any) -> list[str]:
    from emulator.recording.session import different_versions

    return [] if header.from_line else different_versions(header)


def _report(path: str, outcome: Outcome, different: list[str]) -> int:
    from emulator.recording.comparison import render
    from emulator.recording.format import seconds

    for text in outcome.raised:
        _say(f"the program itself failed: {text}")
    if outcome.difference is not None:
        print(render(outcome.difference, path=path))
        if different:
            print(f"the recording was made with {'; '.join(different)}")
        return DIFFERENT
    if not outcome.complete:
        _say(f"{path}: cut after line {outcome.last_line}; replayed up to there")
    print(f"{path}: the same: {outcome.inputs} inputs, {outcome.sent_bytes} bytes sent, up to "
          f"{seconds(outcome.reached_ns)} s")  # fmt: skip
    return SAME


def _unusable(path: str, error: object) -> int:
    text = str(error)
    _say(text if text.startswith(path) else f"{path}: {text}")
    return UNUSABLE


def _say(message: str) -> None:
    print(f"oem6250: {message}", file=sys.stderr)


def _milliseconds(text: str) -> int:
    """A tolerance in ns."""
    try:
        milliseconds = float(text)
    except ValueError:
        milliseconds = -1.0
    if not 0 <= milliseconds <= 1e9:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of milliseconds")
    return round(milliseconds * NS_PER_MS)

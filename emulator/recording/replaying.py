"""A recording run again in virtual time, without ports and as fast as the processor allows.

A unit is a deterministic machine: the same bytes at the same virtual times give the same bytes at the same times. So
what a unit sends between two inputs must be what the recording has between them. A recording of a real unit's line has
wall times and a unit of flesh and copper behind it: there only the order of the bytes counts, unless a tolerance for
times is given.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from emulator.channel import ControllerLike
from emulator.machine import Machine
from emulator.recording.comparison import Cause, Comparison, Difference
from emulator.recording.format import (
    Attached,
    Detached,
    Done,
    End,
    Entry,
    Received,
    RecordingError,
    Sent,
    format_entry,
)
from emulator.recording.header import Header
from emulator.recording.reading import Reader
from emulator.recording.recorded import RELOAD, members_of
from emulator.recording.session import build_units
from emulator.registry import ACTIONS

CONTEXT = 6
"""Lines shown before a difference."""
REMEMBERED = 256
"""Lines kept to find those that came before a difference."""
LINE_LEAD_NS = 1_000_000_000
"""A unit is given this long after power-up before the first byte of a line recording (design choice)."""
LINE_GRACE_NS = 500_000_000
"""What a unit says this close to the end of a line recording may have been missed by the sniffer (design choice)."""
MAX_FAILURES = 100
_ENDS_COMMAND = re.compile(rb"[\r\n:]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a replay went."""

    difference: Difference | None
    reached_ns: int
    """The time of the last line that was replayed."""
    last_line: int
    inputs: int
    sent_bytes: int
    complete: bool
    """The recording was closed; else it was cut, and replayed up to the cut."""
    raised: tuple[str, ...] = ()
    """What the program itself raised on the way: its fault, whatever the bytes."""


class Replay:
    """One recording being replayed; `run` it once."""

    def __init__(
        self,
        header: Header,
        entries: Iterable[Entry],
        units: Sequence[ControllerLike],
        *,
        tolerance_ns: int | None = None,
    ) -> None:
        self._header = header
        self._entries = entries
        exact = None if header.from_line else 0
        self._tolerance_ns = exact if tolerance_ns is None else tolerance_ns
        self._units = [_UnitReplay(index, unit, self) for index, unit in enumerate(units)]
        self._offset_ns: int | None = None if header.from_line else 0
        self._reached_ns = 0
        self._last_line = 0
        self._inputs = 0
        self._sent_bytes = 0

    @property
    def tolerance_ns(self) -> int | None:
        """How far times may differ; None when they do not count."""
        return self._tolerance_ns

    @property
    def from_line(self) -> bool:
        return self._header.from_line

    @property
    def offset_ns(self) -> int:
        """Time in the recording less virtual time."""
        return self._offset_ns or 0

    def run(self) -> Outcome:
        """Replay up to the end or the first difference. Raises RecordingError for a line that cannot be replayed."""
        ended: End | None = None
        for entry in self._entries:
            self._count(entry)
            if isinstance(entry, End):
                ended = entry
            elif (difference := self._unit(entry.unit, entry.line).take(entry)) is not None:
                return self._outcome(difference, complete=False)
        for unit in self._units:
            difference = unit.close(None if ended is None else ended.at_ns, recorded_to_ns=self._reached_ns)
            if difference is not None:
                return self._outcome(difference, complete=ended is not None)
        return self._outcome(None, complete=ended is not None or self.from_line)

    def _count(self, entry: Entry) -> None:
        if self._offset_ns is None:
            self._offset_ns = entry.at_ns - LINE_LEAD_NS
        self._reached_ns = max(self._reached_ns, entry.at_ns)
        self._last_line = entry.line
        self._inputs += isinstance(entry, Received)
        if isinstance(entry, Sent):
            self._sent_bytes += len(entry.data)

    def _unit(self, number: int, line: int) -> _UnitReplay:
        if number >= len(self._units):
            raise RecordingError(f"line {line}: there is no unit u{number}; the head says {len(self._units)}")
        return self._units[number]

    def _outcome(self, difference: Difference | None, *, complete: bool) -> Outcome:
        return Outcome(
            difference=difference,
            reached_ns=self._reached_ns,
            last_line=self._last_line,
            inputs=self._inputs,
            sent_bytes=self._sent_bytes,
            complete=complete,
            raised=tuple(text for unit in self._units for text in unit.raised),
        )


class _UnitReplay:
    """One unit, its comparison, and what came before."""

    def __init__(self, number: int, unit: ControllerLike, replay: Replay) -> None:
        self._number = number
        self._unit = unit
        self._replay = replay
        self._comparison = Comparison(tolerance_ns=replay.tolerance_ns)
        self._commands: dict[int, bytearray] = {}
        self._cause: Cause | None = None
        self._causes: dict[int, Cause] = {}
        self._before: deque[Entry] = deque(maxlen=REMEMBERED)
        self._silent = replay.from_line
        self._last_ns = 0
        self.raised: list[str] = []

    def take(self, entry: Received | Sent | Attached | Detached | Done) -> Difference | None:
        """The recording's next line for this unit; the difference that shows by it."""
        if isinstance(entry, Sent):
            self._silent = False
            self._last_ns = max(self._last_ns, entry.at_ns)
            self._comparison.expect(self._plain(entry), self._cause_for(entry.channel))
        elif not isinstance(entry, Attached):
            if entry.at_ns < self._last_ns:
                raise RecordingError(f"line {entry.line}: time goes backwards")
            self._last_ns = entry.at_ns
            self._run_to(entry.at_ns)
            if not self._comparison.settle(entry.at_ns):
                return self._difference()
            self._act(entry)
        self._before.append(entry)
        return None

    def close(self, end_ns: int | None, *, recorded_to_ns: int) -> Difference | None:
        """The recording has ended at `end_ns`, or was cut (None); the difference in what is left."""
        slack_ns = LINE_GRACE_NS if self._replay.from_line else self._replay.tolerance_ns or 0
        if end_ns is None:
            end_ns = recorded_to_ns if self._replay.from_line else self._last_ns
            goes_on_ns: int | None = end_ns - slack_ns
        else:
            goes_on_ns = end_ns - slack_ns if slack_ns else None
        self._run_to(end_ns + slack_ns)
        same = self._comparison.end(may_go_on_from_ns=goes_on_ns)
        return None if same else self._difference()

    def _run_to(self, at_ns: int) -> None:
        until_ns = max(at_ns - self._replay.offset_ns, self._unit.now_ns)
        for _ in range(MAX_FAILURES):
            try:
                self._unit.advance(until_ns)
                break
            except Exception as error:
                self._note(error)
        pieces = [
            Sent(out.at_ns + self._replay.offset_ns, self._number, out.channel, out.data)
            for out in self._unit.take_output()
        ]
        if not self._silent:
            self._comparison.came((self._plain(piece) for piece in pieces), self._cause)

    def _act(self, entry: Received | Detached | Done) -> None:
        self._silent = False
        try:
            match entry:
                case Received():
                    self._learn(entry)
                    self._unit.receive(entry.data, at_ns=self._unit.now_ns, channel=entry.channel)
                case Detached():
                    self._unit.detach(entry.channel)
                case Done():
                    self._carry_out(entry)
        except RecordingError:
            raise
        except Exception as error:
            self._note(error)

    def _carry_out(self, done: Done) -> None:
        controllers = members_of(self._unit)
        if done.member >= len(controllers):
            raise RecordingError(f"line {done.line}: the chain has no unit u{done.unit}.{done.member}")
        if done.action == RELOAD:
            from emulator.reload import take_over

            take_over([self._unit], Machine.parse(str(done.parameters.get("text", "")), name=f"line {done.line}"))
            return
        if done.action not in ACTIONS:
            raise RecordingError(f"line {done.line}: no action {done.action!r}; there are {', '.join(ACTIONS)}")
        try:
            ACTIONS[done.action].carry_out(controllers[done.member], done.parameters)
        except (KeyError, TypeError, ValueError) as error:
            raise RecordingError(f"line {done.line}: {error.args[0] if error.args else error}") from None

    def _learn(self, received: Received) -> None:
        """Remember the latest complete command of a connection, or the characters of one that has begun."""
        typed = self._commands.setdefault(received.channel, bytearray())
        typed += received.data
        commands = [part for part in _ENDS_COMMAND.split(bytes(typed)) if part.strip()]
        command = commands[-1] if commands else bytes(typed)
        if received.data[-1:] in (b"\r", b"\n", b":"):
            command += received.data[-1:]
            typed.clear()
        del typed[:-REMEMBERED]
        self._cause = Cause(received.at_ns, received.channel, command[-REMEMBERED:], received.line)
        self._causes[received.channel] = self._cause

    def _cause_for(self, channel: int | None) -> Cause | None:
        return self._cause if channel is None else self._causes.get(channel, self._cause)

    def _plain(self, sent: Sent) -> Sent:
        """On a line there are no connections."""
        return replace(sent, channel=0) if self._replay.from_line else sent

    def _note(self, error: Exception) -> None:
        if len(self.raised) < MAX_FAILURES:
            at_s = self._unit.now_ns / 1e9
            self.raised.append(f"unit {self._number} at {at_s:.9f} s: {type(error).__name__}: {error}")

    def _difference(self) -> Difference:
        assert self._comparison.difference is not None
        kind, expected, actual, offset, cause = self._comparison.difference
        piece = expected or actual
        assert piece is not None
        if expected is not None:
            before = [entry for entry in self._before if entry.line < expected.line]
        else:
            before = [entry for entry in self._before if entry.at_ns <= piece.at_ns]
        lines = tuple(format_entry(entry).decode("ascii").rstrip("\n") for entry in before[-CONTEXT:])
        return Difference(kind, self._number, expected, actual, offset, cause, lines)


def replay(path: str | Path, *, machine: Machine | None = None, tolerance_ns: int | None = None) -> Outcome:
    """Replay the recording at `path`; `machine` takes the place of the recorded ones.

    Raises:
        RecordingError: the recording cannot be used.
        MachineError: its machine file cannot be used by this program.
    """
    with Reader(path) as reader:
        return replay_entries(reader.header, reader, machine=machine, tolerance_ns=tolerance_ns)


def replay_entries(
    header: Header, entries: Iterable[Entry], *, machine: Machine | None = None, tolerance_ns: int | None = None
) -> Outcome:
    """Replay what has been read already. Raises as `replay` does."""
    return Replay(header, entries, build_units(header, machine=machine), tolerance_ns=tolerance_ns).run()

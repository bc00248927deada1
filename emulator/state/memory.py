"""A state file and the units whose memory it is: puts the one into the other, and holds replies until it is durable.

On the engine thread, with every output of a unit. A unit that has changed what it keeps may not be heard before the
change is on the disk, so its output waits, in order, until the keeper has confirmed a snapshot that is at least as new.
One commit is under way at a time; what changes meanwhile goes into the next together, so a slow disk makes commits
larger, not more. Changes nobody has heard of (a program that counts silently) are written a few times a second. A unit
that has changed nothing is not delayed, whatever the others do.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from emulator.controller import nonvolatile
from emulator.controller.controller import Controller
from emulator.logs import event_line
from emulator.state.contents import Contents
from emulator.state.errors import StateError
from emulator.state.keeper import Keeper
from emulator.state.store import Store

SILENT_NS = 100_000_000
"""Changes without output are written this long after the commit before them (design choice)."""
STOP_PATIENCE_S = 5.0
"""How long the end waits for the last commit (design choice)."""

_log = logging.getLogger("oem6250.state")
Outputs = Sequence[Any]
Release = Callable[[int, Outputs], None]


class _Line:
    """The units of one line (a chain, or one unit), as the engine thread sees them: as one."""

    def __init__(self, members: Mapping[int, Controller]) -> None:
        self.members = members
        self.saved = self.durable = self.count
        self.held: deque[tuple[int, Outputs]] = deque()

    @property
    def count(self) -> int:
        """Changes so far."""
        return sum(controller.changes.count for controller in self.members.values())

    def collect(self) -> dict[int, Contents]:
        return {index: nonvolatile.collect(controller) for index, controller in self.members.items()}

    def take_ready(self) -> list[Any]:
        """What need not be held any longer."""
        ready: list[Any] = []
        while self.held and self.held[0][0] <= self.durable:
            ready += self.held.popleft()[1]
        return ready


class Memory:
    """The non-volatile memory of the units of one emulator.

    `restore` before the units are switched on; then either `run`, and from the engine thread `hold_back` ... `finish`,
    or, without an engine thread, `save` whenever it shall be durable. `close` in any case.
    """

    def __init__(self, path: str | Path) -> None:
        """Open the file, or make it. Raises StateError if it cannot be used."""
        self._store = Store.open_or_set_aside(path)
        self._lines: list[_Line] = []
        self._keeper: Keeper | None = None
        self.at_start: str | None = None
        """For a recording: what the units had before they were switched on, as text."""
        self._under_way = False
        self._silent_until_ns = 0
        self._post: Callable[[Callable[[], None]], None] = _call
        self._release: Release = _drop

    stop_patience_s = STOP_PATIENCE_S + 1.0
    """How long an engine thread with this memory may take to end."""

    def restore(self, lines: Sequence[Any]) -> None:
        """Put what the file has into units that are not switched on yet: controllers, or chains of them, in the order
        of the file. What does not fit a unit is logged and stays in the file."""
        if self._store.set_aside is not None:
            _log.warning(event_line("state file damaged, memory cleared", kept_as=self._store.set_aside))
        index = 0
        for line in lines:
            members: dict[int, Controller] = {}
            for controller in getattr(line, "controllers", (line,)):
                self._restore_one(index, controller)
                members[index] = controller
                index += 1
            self._lines.append(_Line(members))

    def _restore_one(self, index: int, controller: Controller) -> None:
        misfits = nonvolatile.put_back(controller, self._store.contents(index))
        if misfits:
            what = ", ".join(misfits)
            _log.warning(event_line("state does not fit the machine, it stays in the file", unit=index, what=what))
        if self._store.set_aside is not None:
            controller.memory_damaged = True
        self._store.adopt(index, nonvolatile.collect(controller))

    # With an engine thread.

    def run(self, *, post: Callable[[Callable[[], None]], None], release: Release) -> None:
        """Start the keeper. `post` has the engine thread call a function soon; `release` delivers a unit's output."""
        self._post, self._release = post, release
        self._keeper = Keeper(self._store)
        self._keeper.start()

    def hold_back(self, line_index: int, outputs: Outputs) -> Outputs:
        """What of a line's output may be delivered now; the rest is released when it may."""
        line = self._lines[line_index]
        count = line.count
        if count == line.durable and not line.held:
            return outputs
        if outputs:
            line.held.append((count, outputs))
            self._commit()
        elif count != line.saved and time.monotonic_ns() >= self._silent_until_ns:
            self._commit()
        return ()

    def holds(self, line_index: int) -> bool:
        """Whether a line's output is being held."""
        return bool(self._lines[line_index].held)

    def finish(self) -> None:
        """The engine thread ends: make everything durable, release what is held, close the file."""
        if self._keeper is None:
            return
        changed = self._changed()
        if changed:
            self._keeper.submit(_collect(changed), lambda: None)
        keeper, self._keeper = self._keeper, None
        if not keeper.stop(STOP_PATIENCE_S):
            _log.error(event_line("state file does not take the last changes", file=self._store.path))
            return
        for line in self._lines:
            line.durable = line.count
        self._release_ready()

    def _changed(self) -> list[_Line]:
        return [line for line in self._lines if line.count != line.saved]

    def _commit(self) -> None:
        """Have all that changed written, unless a commit is under way: the next begins when that is done."""
        changed = self._changed()
        if self._under_way or not changed or self._keeper is None:
            return
        counts = []
        for line in changed:
            line.saved = line.count
            counts.append((line, line.saved))
        self._under_way = True
        self._silent_until_ns = time.monotonic_ns() + SILENT_NS
        self._keeper.submit(_collect(changed), lambda: self._post(lambda: self._confirmed(counts)))

    def _confirmed(self, counts: list[tuple[_Line, int]]) -> None:
        self._under_way = False
        for line, count in counts:
            line.durable = count
        self._release_ready()
        if any(line.held for line in self._lines):
            self._commit()

    def _release_ready(self) -> None:
        for index, line in enumerate(self._lines):
            ready = line.take_ready()
            if ready:
                self._release(index, ready)

    # Without one.

    def save(self) -> None:
        """Make everything durable now. Raises StateError if it cannot be written."""
        changed = self._changed()
        if changed:
            self._store.write(_collect(changed))
            for line in changed:
                line.saved = line.durable = line.count

    def close(self) -> None:
        """Let go of the file; nothing is written any more."""
        if self._keeper is not None:
            self._keeper.stop(STOP_PATIENCE_S)
            self._keeper = None
        self._store.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()


def _collect(lines: Sequence[_Line]) -> dict[int, Contents]:
    return {index: contents for line in lines for index, contents in line.collect().items()}


def _call(function: Callable[[], None]) -> None:
    function()


def _drop(line_index: int, outputs: Outputs) -> None:
    """Where nobody listens."""


__all__ = ["Memory", "StateError"]

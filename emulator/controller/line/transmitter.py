"""The unit's transmitter on a timed line: one character after the other, whoever they are for.

Characters are sent as time passes and not a moment earlier: what has been queued can still be stopped by a host's
XOFF, and our own XOFF and XON go ahead of it, after the character under way.  Time passes here only when somebody
calls; since each call first brings the transmitter up to its time, it does not matter how often that is.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from emulator.controller.line.direction import Direction
from emulator.controller.output import Output
from emulator.controller.waits import NEVER


class _Said(NamedTuple):
    at_ns: int
    data: bytes
    channel: int | None


class TimedTransmitter:
    """Sends at the line's speed.  ``on_full`` is called when ``limit`` characters wait."""

    def __init__(self, wire: Direction, *, limit: int, on_full: Callable[[], None]) -> None:
        self._wire = wire
        self._limit = limit
        self._on_full = on_full
        self._said: deque[_Said] = deque()
        self._taken = 0
        self._under_way: deque[Output] = deque()
        self._left: list[Output] = []
        self._stopped_by: set[int] = set()
        self._released_ns = 0
        self.waiting = 0
        """Characters that have not begun."""
        self.sent = 0
        """Characters that have left the unit."""

    @property
    def stopped(self) -> bool:
        """A host's XOFF holds the transmitter."""
        return bool(self._stopped_by)

    @property
    def sending(self) -> bool:
        """Characters are going out."""
        return bool(self._under_way or (self._said and not self._stopped_by))

    def send(self, at_ns: int, data: bytes, channel: int | None) -> None:
        """Queue output; empty data (a prompt that ERRLVL suppresses) adds nothing."""
        if not data:
            return
        self.run_to(at_ns)
        self._said.append(_Said(at_ns, data, channel))
        self.waiting += len(data)
        if self.waiting >= self._limit:
            self._on_full()

    def send_ahead(self, at_ns: int, byte: int, *, heard_by_hosts: bool) -> int:
        """Send XON or XOFF to everyone ahead of what waits, even while stopped; when its stop bit ends."""
        self.run_to(at_ns)
        end_ns = self._wire.send(at_ns)
        self._under_way.append(Output(end_ns, bytes((byte,)) if heard_by_hosts else b"", None))
        return end_ns

    def stop(self, channel: int, at_ns: int) -> None:
        """A host's XOFF: the character under way is the last."""
        self.run_to(at_ns)
        self._stopped_by.add(channel)

    def go_on(self, channel: int, at_ns: int) -> None:
        """A host's XON, or the host is gone; the transmitter goes on when nobody else holds it."""
        if channel in self._stopped_by:
            self.run_to(at_ns)
            self._stopped_by.discard(channel)
            self._released_ns = at_ns

    def go_on_for_all(self, at_ns: int) -> None:
        """Whoever held the transmitter holds it no longer (XONOFF0)."""
        for channel in sorted(self._stopped_by):
            self.go_on(channel, at_ns)

    def room_ns(self, limit: int) -> int:
        """When fewer than ``limit`` characters will wait, if nothing comes between; NEVER while stopped."""
        return NEVER if self._stopped_by else self._wire.after(self.waiting - limit)

    def take(self, now_ns: int) -> list[Output]:
        """Everything that has left since last asked, in order, each character with the end of its stop bit."""
        self.run_to(now_ns)
        taken, self._left = self._left, []
        return taken

    def clear(self) -> None:
        """The unit is switched off in mid-character."""
        self._said.clear()
        self._under_way.clear()
        self._stopped_by.clear()
        self._taken = self.waiting = 0

    def run_to(self, now_ns: int) -> None:
        """Send what can have begun by now; what has also ended has left."""
        under_way = self._under_way
        while True:
            while under_way and under_way[0].at_ns <= now_ns:
                self._leave(under_way.popleft())
            if under_way or not self._said or self._stopped_by:
                return
            under_way.append(self._begin())

    def _leave(self, output: Output) -> None:
        self.sent += 1
        if output.data:
            self._left.append(output)

    def _begin(self) -> Output:
        said = self._said[0]
        byte = said.data[self._taken : self._taken + 1]
        self._taken += 1
        self.waiting -= 1
        if self._taken == len(said.data):
            self._said.popleft()
            self._taken = 0
        return Output(self._wire.send(max(said.at_ns, self._released_ns)), byte, said.channel)

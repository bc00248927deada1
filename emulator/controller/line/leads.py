"""Characters on their way to the unit: what each connection has sent and the unit has not received yet.

Every connection has a lead of its own into the unit's receiver, so that its characters queue behind each other and not
behind those of others (design choice: on one real wire two hosts that speak at once would destroy each other's
characters).  What waits here has not been sent yet: it is what a computer keeps in the driver of its serial port.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from heapq import heappop, heappush
from typing import NamedTuple

from emulator.controller.line.direction import Direction
from emulator.controller.waits import NEVER


class Arrival(NamedTuple):
    """A character that has reached the unit; None when its connection is gone."""

    channel: int
    byte: int | None


class _Lead:
    """What one connection has sent: portions with the times they were given, the first one partly gone."""

    def __init__(self, wire: Direction) -> None:
        self.wire = wire
        self.portions: deque[tuple[int, bytes]] = deque()
        self.taken = 0
        self.waiting = 0
        self.under_way: int | None = None
        self.given = 0
        self.arrived = 0
        self.gone_after: deque[int] = deque()
        """How many characters had been given when a connection went."""

    def put(self, from_ns: int, data: bytes) -> None:
        if data:
            self.portions.append((from_ns, data))
            self.waiting += len(data)
            self.given += len(data)

    @property
    def silent(self) -> bool:
        """Nothing waits or is under way."""
        return self.under_way is None and not self.portions

    def arrive(self) -> int | None:
        """The character under way has arrived."""
        byte, self.under_way = self.under_way, None
        self.arrived += 1
        return byte

    def has_gone(self) -> bool:
        """Whether the character that just arrived was the last of a connection that is gone."""
        gone = False
        while self.gone_after and self.gone_after[0] <= self.arrived:
            self.gone_after.popleft()
            gone = True
        return gone

    def next(self) -> int:
        """The next waiting character."""
        _, data = self.portions[0]
        byte = data[self.taken]
        self.taken += 1
        self.waiting -= 1
        if self.taken == len(data):
            self.portions.popleft()
            self.taken = 0
        return byte


class Leads:
    """All connections' leads.  A host that obeys XOFF starts no character from ``stop`` to ``go_on``."""

    def __init__(self, *, baud: int, bits: int) -> None:
        self._baud, self._bits = baud, bits
        self._leads: dict[int, _Lead] = {}
        self._arriving: list[tuple[int, int, int]] = []
        self._count = 0
        self._stopped_from_ns = NEVER
        self._goes_on_ns: int | None = None

    @property
    def next_ns(self) -> int:
        """When the next character arrives; NEVER while none is under way."""
        return self._arriving[0][0] if self._arriving else NEVER

    def waiting(self, channel: int) -> int:
        """Characters of a connection that have not begun."""
        lead = self._leads.get(channel)
        return lead.waiting if lead is not None else 0

    def put(self, data: bytes, channel: int, from_ns: int) -> None:
        """A connection sends characters from a time on, behind what it has sent before."""
        lead = self._leads.get(channel)
        if lead is None:
            lead = self._leads[channel] = _Lead(Direction(baud=self._baud, bits=self._bits))
        lead.put(from_ns, data)
        self._begin(channel, lead)

    def leave(self, channel: int) -> bool:
        """A connection is gone once all it has sent has arrived: whether that is now."""
        lead = self._leads.get(channel)
        if lead is not None and not lead.silent:
            lead.gone_after.append(lead.given)
            return False
        self._leads.pop(channel, None)
        return True

    def arrived(self, now_ns: int) -> Iterator[Arrival]:
        """The characters whose stop bits have ended, in order; each begins the next of its lead."""
        while self._arriving and self._arriving[0][0] <= now_ns:
            channel = heappop(self._arriving)[2]
            lead = self._leads[channel]
            byte, gone = lead.arrive(), lead.has_gone()
            self._begin(channel, lead)
            if gone and lead.silent:
                del self._leads[channel]
            yield Arrival(channel, byte)
            if gone:
                yield Arrival(channel, None)

    def stop(self, from_ns: int) -> None:
        """XOFF has been heard at a time: from then on no character begins."""
        self._stopped_from_ns, self._goes_on_ns = from_ns, None

    def go_on(self, from_ns: int) -> None:
        """XON has been heard at a time: characters begin again."""
        self._goes_on_ns = from_ns
        for channel, lead in self._leads.items():
            self._begin(channel, lead)

    def _begin(self, channel: int, lead: _Lead) -> None:
        """Start the next character of a lead if it may."""
        if lead.under_way is not None or not lead.portions:
            return
        start_ns = max(lead.portions[0][0], lead.wire.free_ns)
        from_ns = lead.portions[0][0]
        if start_ns >= self._stopped_from_ns:
            if self._goes_on_ns is None:
                return
            from_ns = max(from_ns, self._goes_on_ns)
        lead.under_way = lead.next()
        heappush(self._arriving, (lead.wire.send(from_ns), self._count, channel))
        self._count += 1

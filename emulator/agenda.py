"""What is to be done from outside at virtual times that have not come: a fault in the middle of a move, for instance.

Whoever runs units stops at `next_ns`, carries out what is due, and goes on. So it happens at exactly its time, and a
recording of the session replays it at that time.
"""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappop, heappush

NEVER = 1 << 62
"""Later than any session."""


class Agenda:
    """Functions by virtual time; those of one moment in the order in which they were entered."""

    def __init__(self) -> None:
        self._entries: list[tuple[int, int, Callable[[], None]]] = []
        self._entered = 0

    @property
    def next_ns(self) -> int:
        """The time of the next one; NEVER while there is none."""
        return self._entries[0][0] if self._entries else NEVER

    def enter(self, at_ns: int, function: Callable[[], None]) -> None:
        """Have a function called at a virtual time; at once, when time next passes, if that is over."""
        heappush(self._entries, (at_ns, self._entered, function))
        self._entered += 1

    def carry_out(self, now_ns: int) -> None:
        """Call what is due."""
        while self._entries and self._entries[0][0] <= now_ns:
            heappop(self._entries)[2]()

"""Things that become due at a virtual time by themselves: a debounced input, the end of an output pulse.

The controller looks only at the time of the next one, so a unit in which nothing is due pays nothing."""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappop, heappush

from emulator.controller.waits import NEVER


class Alarms:
    """What is due when; those of one moment are carried out in the order they were set."""

    def __init__(self) -> None:
        self._due: list[tuple[int, int, Callable[[], None]]] = []
        self._count = 0

    @property
    def pending(self) -> bool:
        """Something is due at some time."""
        return bool(self._due)

    @property
    def next_ns(self) -> int:
        """The time of the next one; NEVER while there is none."""
        return self._due[0][0] if self._due else NEVER

    def at(self, at_ns: int, action: Callable[[], None]) -> None:
        """Have something carried out when the unit reaches a virtual time."""
        heappush(self._due, (at_ns, self._count, action))
        self._count += 1

    def carry_out(self, now_ns: int) -> None:
        """Carry out what is due now."""
        while self._due and self._due[0][0] <= now_ns:
            heappop(self._due)[2]()

    def clear(self) -> None:
        """Forget everything (RESET, power-down)."""
        self._due.clear()

"""A line to a unit in this process: time passes exactly while the host reads or sleeps, and costs nothing.

A host that waits 30 s for a move gets its answer as soon as the processor has worked out the move, and its own
time-outs run on the same clock.  Time stands still while the host computes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

NS_PER_S = 1_000_000_000

LEAST_WAIT_NS = 1
"""A wait too short for the clock still lets time pass, or a host that waits for what is left of a moment never ends."""


class _Clocked(Protocol):
    @property
    def now_ns(self) -> int: ...


class LineEnd(Protocol):
    """The host's end of a unit's or a chain's line."""

    @property
    def controller(self) -> _Clocked: ...
    def send(self, data: bytes, *, channel: int = 0) -> None: ...
    def read(self, *, channel: int = 0) -> bytes: ...
    def hang_up(self, *, channel: int = 0) -> None: ...


class VirtualLine:
    """One connection to a unit; a ``clients.lines.Line``.

    Args:
        unit: the unit or the chain at its other end.
        step: lets virtual time pass up to the next thing that happens in the unit, at most to a moment (ns).
        channel: the number of the connection.
    """

    def __init__(self, unit: LineEnd, step: Callable[[int], None], *, channel: int = 0, name: str = "emulated") -> None:
        self._unit = unit
        self._step = step
        self._channel = channel
        self._open = True
        self.name = name

    def write(self, data: bytes) -> None:
        """The unit receives all of it now."""
        self._check()
        self._unit.send(data, channel=self._channel)

    def read(self, timeout_s: float) -> bytes:
        """What the unit has said; lets virtual time pass until it says something, at most so long."""
        self._check()
        controller = self._unit.controller
        until_ns = controller.now_ns + (max(LEAST_WAIT_NS, round(timeout_s * NS_PER_S)) if timeout_s > 0 else 0)
        data = self._unit.read(channel=self._channel)
        while not data and controller.now_ns < until_ns:
            self._step(until_ns)
            data = self._unit.read(channel=self._channel)
        return data

    def sleep(self, seconds: float) -> None:
        """Let virtual time pass."""
        controller = self._unit.controller
        until_ns = controller.now_ns + round(max(0.0, seconds) * NS_PER_S)
        while controller.now_ns < until_ns:
            self._step(until_ns)

    def clock(self) -> float:
        """Virtual seconds."""
        return self._unit.controller.now_ns / NS_PER_S

    def close(self) -> None:
        """The connection ends: half a command is forgotten, everything else goes on."""
        if self._open:
            self._open = False
            self._unit.hang_up(channel=self._channel)

    def _check(self) -> None:
        if not self._open:
            raise OSError("the line is closed")

"""One connection between a port and a controller, as the engine thread sees it.

A channel has a queue of its own: bytes to execute and functions to call, in order. The engine thread works off a little
of each channel in turn, so that a host that sends without pause delays the others by a few commands and no more, and it
asks a channel's port for more only when that queue is empty. So none of a host's commands is ever lost and memory
stays bounded: what has not been read waits in the operating system, which slows the host down.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

TURN_BYTES = 256
"""What one channel may have executed before the next gets its turn: about fifty commands (design choice)."""

Item = bytes | Callable[[], None]


class OutputLike(Protocol):
    """Bytes a controller sends: when they leave the unit, and to which channel (None: to every channel)."""

    @property
    def at_ns(self) -> int: ...
    @property
    def data(self) -> bytes: ...
    @property
    def channel(self) -> int | None: ...


class ControllerLike(Protocol):
    """One unit as the engine thread sees it: bytes in and bytes out at virtual times, no I/O, no clock."""

    @property
    def now_ns(self) -> int: ...
    @property
    def busy(self) -> bool:
        """Motion, dwell, wait or program under way: the next output or effect may come by itself."""
        ...

    def input_full(self, channel: int) -> bool:
        """So many commands of this channel wait that more of its input should stay on the wire."""
        ...

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None: ...
    def advance(self, until_ns: int) -> None: ...
    def take_output(self) -> Sequence[OutputLike]: ...
    def detach(self, channel: int) -> None: ...


@runtime_checkable
class HearsOfConnections(Protocol):
    """A unit that wants to know when a connection is made, besides when it is gone."""

    def attach(self, channel: int) -> None: ...


class Wire(Protocol):
    """What a port gives the engine thread. All of it is called on that thread and must neither block nor raise."""

    @property
    def descriptors(self) -> tuple[int, ...]:
        """Descriptors that become readable when `arrived` should be called; the same until the channel is detached."""
        ...

    def arrived(self, channel: Channel) -> None:
        """Append what has arrived, one modest portion, to `channel.waiting`."""
        ...

    def send(self, data: bytes) -> None:
        """Take output: write it, keep it or discard it."""
        ...


class Channel:
    """One connection of one unit. Made by `EngineThread.attach`; `number` is what the controller calls it."""

    def __init__(self, unit_index: int, number: int, wire: Wire) -> None:
        self.unit_index = unit_index
        self.number = number
        self.wire = wire
        self.waiting: deque[Item] = deque()
        self.on_finished: Callable[[], None] | None = None
        """Set once the host will send no more: what to call when it has been answered."""

    def take(self) -> Item:
        """The next thing to do, bytes cut to one turn. Raises IndexError when nothing waits."""
        item = self.waiting.popleft()
        if isinstance(item, bytes) and len(item) > TURN_BYTES:
            self.waiting.appendleft(item[TURN_BYTES:])
            return item[:TURN_BYTES]
        return item

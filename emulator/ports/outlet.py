"""Output of one connection: written by the engine thread itself where possible, by the event loop where not.

Why two writers: a reply that first travels to the event loop costs the host half a round trip more. So the engine
thread writes to the descriptor directly, without blocking, and only what the system does not take is handed to the
event loop, which writes the rest when the descriptor becomes writable.

Why the order holds without a lock: `_handed` counts the bytes ever handed to the event loop and is written by the
engine thread alone; `_settled` counts those the event loop has disposed of (written or voided) and is written by the
event loop alone, after the write. The engine thread writes directly only when the two are equal: then everything
handed over is already in the system's buffer, and the event loop, having nothing, writes nothing. In every other case
it hands over, and `call_soon_threadsafe` keeps the order of its calls. So at no time may both write, and no byte
overtakes another.

The same difference bounds the memory: output that would bring it over the limit is discarded whole, as on a serial
line that nobody reads, with one log line per episode. An episode ends when the backlog is empty.

Life of the descriptor: the event loop closes it only after the engine thread has confirmed that it will not call `send`
again (`EngineThread.drop`, `finish`, `lose`), so a reused number is never written to by mistake.
"""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Callable

from emulator.logs import event_line

OUTPUT_LIMIT_BYTES = 256 * 1024
"""Unread output kept for one connection beside the system's own buffer (design choice)."""

_log = logging.getLogger("oem6250.port")


class Outlet:
    """The sink of one connection. `write` takes bytes and returns how many the system took, or raises OSError.

    `on_broken` is called on the event loop, once, when the connection turns out to be gone.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        fd: int,
        write: Callable[[bytes], int],
        *,
        name: str,
        on_broken: Callable[[], None],
        limit_bytes: int = OUTPUT_LIMIT_BYTES,
    ) -> None:
        self._loop = loop
        self._fd = fd
        self._write = write
        self._name = name
        self._on_broken = on_broken
        self._limit = limit_bytes
        self._handed = 0
        self._settled = 0
        self._void_below = 0
        self._broken = False
        self._discarding = False
        self._backlog: deque[bytes] = deque()
        self._awaiting_room = False
        self._when_empty: Callable[[], None] | None = None

    @property
    def backlog_bytes(self) -> int:
        """What is handed over and neither written nor voided."""
        return self._handed - self._settled

    # Engine thread.

    def send(self, data: bytes) -> None:
        """Write, hand over or discard; never blocks, never raises."""
        if self._broken:
            return
        if self._handed == self._settled:
            self._discarding = False
            taken = self._try_write(data)
            if taken == len(data) or self._broken:
                return
            data = data[taken:]
        self._hand_over(data)

    def void_backlog(self) -> None:
        """What was handed over until now and is not yet written will not be: the host it was for has gone."""
        self._void_below = self._handed
        self._soon(self._drain)

    def _try_write(self, data: bytes) -> int:
        try:
            return self._write(data)
        except (BlockingIOError, InterruptedError):
            return 0
        except OSError:
            self._broken = True
            self._soon(self._on_broken)
            return 0

    def _hand_over(self, data: bytes) -> None:
        if self.backlog_bytes + len(data) > self._limit:
            if not self._discarding:
                self._discarding = True
                _log.warning(event_line("host does not read, output discarded", port=self._name, limit=self._limit))
            return
        self._handed += len(data)
        self._soon(self._take_over, data)

    def _soon(self, function: Callable[..., None], *arguments: bytes) -> None:
        """Have the event loop do it; at shutdown there may be none any more, and nothing to write to either."""
        try:
            self._loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:
            self._broken = True

    # Event loop.

    def when_empty(self, function: Callable[[], None]) -> None:
        """Call `function` when the backlog is written; at once if there is none. For use after the last `send`."""
        self._when_empty = function
        self._loop.call_soon(self._drain)

    def close(self) -> None:
        """No more writing; before the descriptor is closed."""
        self._broken = True
        self._when_empty = None
        self._backlog.clear()
        self._await_room(False)

    def _take_over(self, data: bytes) -> None:
        if self._broken:
            return
        self._backlog.append(data)
        if not self._awaiting_room:
            self._drain()

    def _drain(self) -> None:
        while self._backlog and not self._broken:
            data = self._backlog[0]
            taken = len(data) if self._settled < self._void_below else self._try_write(data)
            if self._broken or taken == 0:
                break
            if taken == len(data):
                self._backlog.popleft()
            else:
                self._backlog[0] = data[taken:]
            self._settled += taken
        self._await_room(bool(self._backlog) and not self._broken)
        if not self._backlog and self._when_empty is not None:
            when_empty, self._when_empty = self._when_empty, None
            when_empty()

    def _await_room(self, wanted: bool) -> None:
        if wanted and not self._awaiting_room:
            self._loop.add_writer(self._fd, self._drain)
        elif self._awaiting_room and not wanted:
            self._loop.remove_writer(self._fd)
        self._awaiting_room = wanted

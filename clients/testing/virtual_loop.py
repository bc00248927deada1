"""An event loop on the virtual time of an emulator: `asyncio.sleep`, time-outs and reads of its lines all wait in it.

An ordinary event loop sleeps in its selector until the next timer is due. This one lets the emulator run for so long
instead, and stops as soon as a unit says something that a task waits for. So a supervisor that sleeps a tenth of a
second between two looks makes exactly as many looks in a move as on a real machine, and costs no time.

Files, sockets and threads of the host stay on the wall's time, and are not waited for while a timer is due.
"""

from __future__ import annotations

import asyncio
import math
import selectors
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

from clients.testing.virtual_line import VirtualLine

T = TypeVar("T")
NS_PER_S = 1_000_000_000


class VirtualLoop(asyncio.SelectorEventLoop):
    """See the module.

    Args:
        now_ns: the virtual time.
        step: lets it pass up to the next thing that happens, at most to a moment (ns).
    """

    def __init__(self, now_ns: Callable[[], int], step: Callable[[int], None]) -> None:
        self._now_ns = now_ns
        self.readers: list[Callable[[], bool]] = []
        """Called after each step; whoever has got what it waits for says so."""
        super().__init__(_VirtualSelector(now_ns, step, self.readers))
        self._clock_resolution = 1 / NS_PER_S

    def time(self) -> float:
        """Virtual seconds."""
        return self._now_ns() / NS_PER_S


class _VirtualSelector(selectors.DefaultSelector):
    """Waits by letting virtual time pass; what is ready by the wall's time comes first."""

    def __init__(
        self, now_ns: Callable[[], int], step: Callable[[int], None], readers: list[Callable[[], bool]]
    ) -> None:
        super().__init__()
        self._now_ns, self._step, self._readers = now_ns, step, readers

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """As any selector; without a time limit there is nothing virtual to wait for."""
        ready: list[tuple[selectors.SelectorKey, int]] = super().select(None if timeout is None else 0)
        if ready or not timeout:
            return ready
        until_ns = self._now_ns() + math.ceil(timeout * NS_PER_S)
        while not any([reader() for reader in self._readers]) and self._now_ns() < until_ns:
            self._step(until_ns)
        return ready


class AsyncVirtualLine:
    """A virtual line for tasks of a VirtualLoop; a `clients.async_lines.AsyncLine`."""

    def __init__(self, line: VirtualLine) -> None:
        self._line = line
        self.name, self.clock = line.name, line.clock

    async def write(self, data: bytes) -> None:
        """The unit receives all of it now."""
        self._line.write(data)

    async def read(self, timeout_s: float) -> bytes:
        """What the unit has said, once it says something; others run meanwhile."""
        loop = _the_loop()
        got = self._line.read(0)
        if got or timeout_s <= 0:
            return got
        said: asyncio.Future[bytes] = loop.create_future()

        def look() -> bool:
            data = b"" if said.done() else self._line.read(0)
            if data:
                said.set_result(data)
            return bool(data)

        loop.readers.append(look)
        try:
            await asyncio.wait({said}, timeout=timeout_s)
        finally:
            loop.readers.remove(look)
            if not said.done():
                said.cancel()
        return b"" if said.cancelled() else said.result()

    async def pause(self, seconds: float) -> bytes:
        """Let virtual time pass; others use the line meanwhile."""
        await asyncio.sleep(seconds)
        return b""

    async def close(self) -> None:
        """The connection ends."""
        self._line.close()


def _the_loop() -> VirtualLoop:
    loop = asyncio.get_running_loop()
    if not isinstance(loop, VirtualLoop):
        raise RuntimeError("this line belongs to an event loop on virtual time: start the host with emu.run(...)")
    return loop


def run_virtually(main: Coroutine[Any, Any, T], *, now_ns: Callable[[], int], step: Callable[[int], None]) -> T:
    """Run a coroutine in an event loop of its own on virtual time; its result."""
    with asyncio.Runner(loop_factory=lambda: VirtualLoop(now_ns, step)) as runner:
        return runner.run(main)

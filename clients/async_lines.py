"""Lines for the event loop: TCP by asyncio's streams, everything else by a blocking line in a thread of its own."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Protocol, Self

from clients.errors import LineLost
from clients.lines import CONNECT_TIMEOUT_S, DEFAULT_BAUD, Line, close_quietly, open_line, tcp_address

_CHUNK = 65536


class AsyncLine(Protocol):
    """What the asyncio face needs of a line; as `Line`, awaitable."""

    @property
    def name(self) -> str:
        """For messages."""
        ...

    async def write(self, data: bytes) -> None:
        """Send all of `data`."""
        ...

    async def read(self, timeout_s: float) -> bytes:
        """What has arrived, waiting at most so long for the first byte."""
        ...

    async def pause(self, seconds: float) -> bytes:
        """Let time pass; what was read meanwhile, if time passes by reading."""
        ...

    async def close(self) -> None:
        """Let go of the line."""
        ...

    def clock(self) -> float:
        """Seconds on the clock that `read` waits by."""
        ...


class AsyncTcpLine:
    """A raw TCP connection."""

    clock: Callable[[], float] = staticmethod(time.monotonic)

    def __init__(self, name: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.name = name
        self._reader, self._writer = reader, writer
        self._reading: asyncio.Task[bytes] | None = None

    @classmethod
    async def open(cls, host: str, port: int) -> Self:
        """Connect; OSError if that fails or takes too long."""
        async with asyncio.timeout(CONNECT_TIMEOUT_S):
            reader, writer = await asyncio.open_connection(host, port)
        return cls(f"tcp://{host}:{port}", reader, writer)

    async def write(self, data: bytes) -> None:
        self._writer.write(data)
        await self._writer.drain()

    async def read(self, timeout_s: float) -> bytes:
        """A read that a time limit or a cancelled task interrupts goes on for the next one: no byte is lost."""
        if self._reading is None:
            self._reading = asyncio.ensure_future(self._reader.read(_CHUNK))
            if timeout_s <= 0:
                await asyncio.sleep(0)
        if not self._reading.done():
            await asyncio.wait({self._reading}, timeout=max(0.0, timeout_s))
        if not self._reading.done():
            return b""
        data, self._reading = self._reading.result(), None
        if not data:
            raise ConnectionResetError("the other side closed the connection")
        return data

    async def pause(self, seconds: float) -> bytes:
        await asyncio.sleep(seconds)
        return b""

    async def close(self) -> None:
        if self._reading is not None:
            self._reading.cancel()
            with contextlib.suppress(asyncio.CancelledError, OSError):
                await self._reading
        self._writer.close()
        with contextlib.suppress(OSError):
            await self._writer.wait_closed()


class ThreadedLine:
    """A blocking line used from one thread of its own, which does one thing after another."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self.clock = line.clock
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix="oem6250-line")
        self._reading: asyncio.Future[bytes] | None = None

    @property
    def name(self) -> str:
        return self._line.name

    async def write(self, data: bytes) -> None:
        await asyncio.get_running_loop().run_in_executor(self._thread, self._line.write, data)

    async def read(self, timeout_s: float) -> bytes:
        """A cancelled read is finished by the next one: no byte is lost."""
        if self._reading is None:
            self._reading = asyncio.get_running_loop().run_in_executor(self._thread, self._line.read, timeout_s)
        data = await asyncio.shield(self._reading)
        self._reading = None
        return data

    async def pause(self, seconds: float) -> bytes:
        await asyncio.sleep(seconds)
        return b""

    async def close(self) -> None:
        loop = asyncio.get_running_loop()
        await loop.run_in_executor(self._thread, close_quietly, self._line)
        self._thread.shutdown(wait=False)


class DirectLine:
    """A blocking line that never waits for long (a virtual one), called from the event loop itself."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self.clock = line.clock

    @property
    def name(self) -> str:
        return self._line.name

    async def write(self, data: bytes) -> None:
        self._line.write(data)

    async def read(self, timeout_s: float) -> bytes:
        return self._line.read(timeout_s)

    async def pause(self, seconds: float) -> bytes:
        """Other tasks come first, then time passes by reading."""
        await asyncio.sleep(0)
        end, got = self.clock() + seconds, b""
        while (left := end - self.clock()) > 0:
            got += self._line.read(left)
        return got

    async def close(self) -> None:
        close_quietly(self._line)


def as_async(line: AsyncLine | Line) -> AsyncLine:
    """A blocking line in a thread of its own; an asynchronous one as it is."""
    return line if asyncio.iscoroutinefunction(line.read) else ThreadedLine(line)  # type: ignore[return-value, arg-type]


async def open_async_line(url: str, *, baud: int = DEFAULT_BAUD) -> AsyncLine:
    """As clients.lines.open_line, for the event loop; LineLost, ValueError."""
    if not url.startswith("tcp://"):
        return ThreadedLine(await asyncio.get_running_loop().run_in_executor(None, lambda: open_line(url, baud=baud)))
    host, port = tcp_address(url)
    try:
        return await AsyncTcpLine.open(host, port)
    except OSError as error:
        raise LineLost(url, error) from error

"""An emulated RMC in this process on virtual time, with a client: what the fixture ``rmc151`` gives.

    with EmulatedRmc() as emu:
        emu.axis[0].enable()
        emu.axis[0].move_absolute(10.0, speed=5.0, accel=50.0)
        emu.axis[0].wait_in_position()

Time stands still except inside ``advance`` and while the client waits.  ``serve`` opens a Modbus/TCP port for host code
of your own.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from clients.rmc import RMC, RmcAxis, RmcLost, RmcRefused
from clients.testing.machines import machine_of
from emulator.rmc.device import RmcDevice
from emulator.rmc.registers import BadAddress, Connection, Registers

if TYPE_CHECKING:
    from emulator.machine import Machine
    from emulator.rmc.modbus import ModbusServer

NS_PER_S = 1_000_000_000
REQUEST_NS = 1_000_000
"""What each request of a client takes, virtual time (design choice: about what a small network takes)."""
ILLEGAL_ADDRESS = 2


class VirtualRmcLink:
    """Words straight into the registers of a device; waiting lets virtual time pass."""

    def __init__(self, device: RmcDevice, registers: Registers) -> None:
        self._device = device
        self._registers = registers
        self._connection: Connection | None = Connection()

    def read(self, address: int, count: int) -> list[int]:
        """Read words."""
        words: list[int] = self._ask(f"reading {count} words at {address + 1}", self._registers.read, address, count)
        return words

    def write(self, address: int, words: Sequence[int]) -> None:
        """Write words."""
        self._ask(f"writing {len(words)} words at {address + 1}", self._registers.write, address, words)

    def _ask(self, doing: str, function: Callable[..., Any], address: int, what: Any) -> Any:
        if self._connection is None:
            raise RmcLost(f"{doing}: the connection is closed")
        try:
            answer = function(address, what, self._connection)
        except BadAddress:
            raise RmcRefused(doing, ILLEGAL_ADDRESS) from None
        self._device.advance(self._device.now_ns + REQUEST_NS)
        return answer

    def now_s(self) -> float:
        """Virtual time."""
        return self._device.now_ns / NS_PER_S

    def pause(self) -> None:
        """The requests themselves take time."""

    def close(self) -> None:
        """End the connection."""
        self._connection = None


class EmulatedRmc:
    """A device, its registers and a connected client.

    Args:
        machine: a Machine, the text of a machine file or the path of one; None is the default machine.
    """

    def __init__(self, machine: Machine | str | Path | None = None) -> None:
        self.device = RmcDevice(machine_of(machine))
        self.registers = Registers(self.device)
        self.client = self.connect()
        self._served: list[_Served] = []

    def __enter__(self) -> EmulatedRmc:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End every connection and port."""
        self.client.close()
        while self._served:
            self._served.pop().close()

    @property
    def axis(self) -> list[RmcAxis]:
        """The axes of the client."""
        return self.client.axis

    @property
    def now_s(self) -> float:
        """Virtual time, s."""
        return self.device.now_ns / NS_PER_S

    def connect(self) -> RMC:
        """A client with a connection of its own."""
        rmc = self.device.rmc
        link = VirtualRmcLink(self.device, self.registers)
        return RMC(link, axes=rmc.axes, register_map=rmc.map, word_order=rmc.word_order)

    def advance(self, seconds: float) -> None:
        """Let virtual time pass; not while a port is open (`serve` has the device then)."""
        self.device.advance(self.device.now_ns + round(seconds * NS_PER_S))

    def serve(self, *, request_s: float = REQUEST_NS / NS_PER_S) -> tuple[str, int]:
        """Open a Modbus/TCP port; host and port. Each request lets `request_s` of virtual time pass.

        From then on the device belongs to the port: look at it through a client of your own.
        """
        self._served.append(_Served(self.device, self.registers, round(request_s * NS_PER_S)))
        return ("127.0.0.1", self._served[-1].port)


class _Served:
    """A port in a thread of its own, which has the device as long as it is open."""

    def __init__(self, device: RmcDevice, registers: Registers, request_ns: int) -> None:
        from emulator.rmc.modbus import ModbusServer

        self._device = device
        self._request_ns = request_ns
        self._loop = asyncio.new_event_loop()
        self._server: ModbusServer = ModbusServer("127.0.0.1", 0)
        self.port = self._server.port
        self._thread = threading.Thread(target=self._loop.run_forever, name="rmc port", daemon=True)
        self._thread.start()
        asyncio.run_coroutine_threadsafe(self._server.start(registers, self._step), self._loop).result()

    async def _step(self, function: Callable[[], Any]) -> Any:
        answer = function()
        self._device.advance(self._device.now_ns + self._request_ns)
        return answer

    def close(self) -> None:
        asyncio.run_coroutine_threadsafe(self._end(), self._loop).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _end(self) -> None:
        await self._server.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

"""How words get to and from an RMC: over TCP, or within the process of a test."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any, Protocol

from clients.rmc.errors import RmcLost, RmcRefused

MOST_READ = 125
MOST_WRITTEN = 123
"""Words of a request (Modbus)."""
POLL_S = 0.01
"""Time between two looks while something is waited for."""


class RmcLink(Protocol):
    """Words at wire addresses (counted from 0), and the time in which one waits for them to change."""

    def read(self, address: int, count: int) -> list[int]:
        """Read words; RmcRefused, RmcLost."""

    def write(self, address: int, words: Sequence[int]) -> None:
        """Write words in one request; RmcRefused, RmcLost."""

    def now_s(self) -> float:
        """The time by which timeouts count."""

    def pause(self) -> None:
        """Let a little time pass before looking again."""

    def close(self) -> None:
        """End the connection."""


class TcpLink:
    """A pymodbus client. RmcLost if there is no connection."""

    def __init__(self, host: str, port: int = 502, *, device_id: int = 0, timeout_s: float = 3.0) -> None:
        from pymodbus.client import ModbusTcpClient

        self._name = f"{host}:{port}"
        self._device_id = device_id
        self._client = ModbusTcpClient(host, port=port, timeout=timeout_s)
        if not self._client.connect():
            raise RmcLost(f"{self._name}: no connection")

    def read(self, address: int, count: int) -> list[int]:
        """Read holding registers."""
        answer = self._ask(
            f"reading {count} words at {address + 1}",
            lambda: self._client.read_holding_registers(address, count=count, device_id=self._device_id),
        )
        return [int(word) for word in answer.registers]

    def write(self, address: int, words: Sequence[int]) -> None:
        """Write several registers."""
        self._ask(
            f"writing {len(words)} words at {address + 1}",
            lambda: self._client.write_registers(address, list(words), device_id=self._device_id),
        )

    def now_s(self) -> float:
        """The wall's time."""
        return time.monotonic()

    def pause(self) -> None:
        """Sleep a little."""
        time.sleep(POLL_S)

    def close(self) -> None:
        """End the connection."""
        self._client.close()

    def _ask(self, doing: str, request: Any) -> Any:
        from pymodbus.exceptions import ModbusException

        try:
            answer = request()
        except ModbusException as error:
            raise RmcLost(f"{self._name}: {doing}: {error}") from None
        if answer.isError():
            raise RmcRefused(doing, int(answer.exception_code))
        return answer

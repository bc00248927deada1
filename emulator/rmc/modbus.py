"""Modbus/TCP in front of a device: pymodbus's server and frames, our registers behind them. No other module knows it.

pymodbus keeps one request a connection and answers a second that arrives meanwhile with the first one's data, so each
connection here has a queue, and requests of one master are answered in their order. Masters do not wait for each
other; `run` puts every request between two loops of the device, so a write is seen whole or not at all.
"""

from __future__ import annotations

import asyncio
import struct
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from typing import Any, TypeVar

from pymodbus.constants import ExcCodes
from pymodbus.exceptions import ModbusIOException
from pymodbus.pdu import ExceptionResponse
from pymodbus.server import ModbusTcpServer
from pymodbus.server.requesthandler import ServerRequestHandler
from pymodbus.simulator import DataType, SimData, SimDevice
from pymodbus.transaction import TransactionManager

from emulator.ports.listeners import address_text, bind_all

from .registers import BadAddress, Connection, Registers

T = TypeVar("T")
Run = Callable[[Callable[[], Any]], Awaitable[Any]]
"""Does something to the device at the present time, and brings back what came of it."""

READ_HOLDING, READ_INPUT, WRITE_ONE, DIAGNOSTICS, WRITE_MANY, READ_WRITE = 3, 4, 6, 8, 16, 23
FUNCTIONS = frozenset({READ_HOLDING, READ_INPUT, WRITE_ONE, DIAGNOSTICS, WRITE_MANY, READ_WRITE})
"""Functions of an RMC (M450); any other is refused with exception 1."""
HEADER = struct.Struct(">HHHBB")
"""Transaction, protocol, length, unit, function."""
LENGTH_FROM = 6
"""Where what the length counts begins."""
LONGEST_QUEUE = 64
"""Requests of a master that may wait; one that goes on without reading answers is cut off (design choice)."""


class Store:
    """The registers as pymodbus asks for them, for one connection."""

    def __init__(self, registers: Registers, run: Run) -> None:
        self._registers = registers
        self._run = run
        self._connection = Connection()
        self._written: dict[int, int] = {}

    async def async_getValues(
        self, device_id: int, func_code: int, address: int, count: int = 1
    ) -> list[int] | ExcCodes:
        """Words; any device id is this device (RMC101 p. 428). Function 6 is answered with what it wrote."""
        if func_code == WRITE_ONE:
            return [self._written.pop(address, 0)]
        return await self._attempt(lambda: self._registers.read(address, count, self._connection))

    async def async_setValues(
        self, device_id: int, func_code: int, address: int, values: Sequence[int]
    ) -> ExcCodes | None:
        """Write words, all or none."""
        words = [int(word) for word in values]
        if func_code == WRITE_ONE:
            self._written = {address: words[0]}
        return await self._attempt(lambda: self._registers.write(address, words, self._connection))

    async def _attempt(self, function: Callable[[], T]) -> T | ExcCodes:
        try:
            result: T = await self._run(function)
        except BadAddress:
            return ExcCodes.ILLEGAL_ADDRESS
        return result


def impossible_request(data: bytes) -> tuple[int, Any]:
    """The length of a frame whose request cannot be read, and its answer: a count or length that is not allowed is
    exception 3, an unknown function exception 1."""
    transaction, _, length, unit, function = HEADER.unpack_from(data)
    code = ExcCodes.ILLEGAL_VALUE if function in FUNCTIONS else ExcCodes.ILLEGAL_FUNCTION
    answer = ExceptionResponse(function & 0x7F, code, device_id=unit, transaction=transaction)
    return min(len(data), LENGTH_FROM + length), answer


class _Handler(ServerRequestHandler):
    """One connection, its requests in order."""

    def __init__(self, owner: Any, store: Store) -> None:
        super().__init__(owner, None, None, None)
        self._store = store
        self._queue: deque[tuple[Any, Any]] = deque()
        self._worker: asyncio.Task[None] | None = None

    def callback_data(self, data: bytes, addr: tuple | None = None) -> int:
        """Take every whole request out of what has arrived."""
        used = 0
        while used < len(data):
            taken, request = self._next_request(data[used:], addr)
            if request is not None:
                self._queue.append((request, addr))
            if not taken:
                break
            used += taken
        self.loop.call_soon(self.handle_later)
        if len(self._queue) > LONGEST_QUEUE:
            self.close()
        return used

    def _next_request(self, data: bytes, addr: tuple | None) -> tuple[int, Any]:
        """The bytes of the first request, and the request: an answer already, if it cannot be one."""
        try:
            taken = TransactionManager.callback_data(self, data, addr)
        except ModbusIOException:
            # pymodbus would answer with function 0 and throw away whatever else has arrived.
            return impossible_request(data)
        return taken, self.last_pdu

    def handle_later(self) -> None:
        """Work the queue off, unless that is being done."""
        if self._queue and (self._worker is None or self._worker.done()):
            self._worker = asyncio.ensure_future(self._work())

    def callback_disconnected(self, exc: Exception | None) -> None:
        """What was asked for before the end is still done; only answers are lost."""
        super().callback_disconnected(exc)
        self._queue.clear()

    async def _work(self) -> None:
        while self._queue:
            pdu, addr = self._queue.popleft()
            response = await self._answer(pdu)
            response.transaction_id, response.dev_id = pdu.transaction_id, pdu.dev_id
            if not self.is_closing:
                self.server_send(response, addr)

    async def _answer(self, pdu: Any) -> Any:
        if isinstance(pdu, ExceptionResponse):
            return pdu
        if pdu.function_code not in FUNCTIONS:
            return ExceptionResponse(pdu.function_code, ExcCodes.ILLEGAL_FUNCTION)
        try:
            return await pdu.datastore_update(self._store, pdu.dev_id)
        except Exception:
            return ExceptionResponse(pdu.function_code, ExcCodes.DEVICE_FAILURE)


class _Server(ModbusTcpServer):
    """pymodbus's server with a handler, and so a store, for each connection."""

    def __init__(self, make_store: Callable[[], Store]) -> None:
        super().__init__(SimDevice(0, [SimData(0, datatype=DataType.REGISTERS)]))
        self._make_store = make_store

    def callback_new_connection(self) -> ServerRequestHandler:
        """A master has connected."""
        return _Handler(self, self._make_store())


class ModbusServer:
    """A Modbus/TCP server of one device. Making one binds, `start` accepts, `close` ends everything."""

    def __init__(self, host: str, port: int, *, allow_remote: bool = False) -> None:
        """Raises PortError."""
        self._listeners = bind_all(host, port, option="--modbus", allow_remote=allow_remote)
        self._accepting: list[asyncio.Server] = []
        self._server: _Server | None = None

    @property
    def addresses(self) -> list[str]:
        """Where it listens, as `HOST:PORT` with the real port number."""
        return [address_text(listener.getsockname()) for listener in self._listeners]

    @property
    def port(self) -> int:
        """The real port number."""
        return int(self._listeners[0].getsockname()[1])

    async def start(self, registers: Registers, run: Run) -> None:
        """Accept masters from now on."""
        loop = asyncio.get_running_loop()
        self._server = _Server(lambda: Store(registers, run))
        for listener in self._listeners:
            self._accepting.append(await loop.create_server(self._connected, sock=listener))

    def _connected(self) -> asyncio.BaseProtocol:
        assert self._server is not None
        protocol: asyncio.BaseProtocol = self._server.handle_new_connection()
        return protocol

    async def close(self) -> None:
        """Let no one in any more and end all connections."""
        for server in self._accepting:
            server.close()
        if self._server is not None:
            for connection in list(self._server.active_connections.values()):
                connection.close()
            await self._server.shutdown()
        for listener in self._listeners:
            listener.close()

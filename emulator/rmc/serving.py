"""`oem6250 serve --device rmc151`: from options to a device behind Modbus/TCP, and back at a signal.

The engine thread owns the device; pymodbus and its connections live on the event loop and put every request to the
engine thread, where it meets the device at the present time.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, TypeVar

from emulator.clock import Clock
from emulator.logs import set_up_logging
from emulator.options import ServeOptions
from emulator.pacing import EngineThread
from emulator.ports import PortError

FALLBACK_HOST = "127.0.0.1"

T = TypeVar("T")


def serve_rmc(options: ServeOptions) -> int:
    """Serve until a signal. Exit status: 0, 1 after a crash of the engine thread, 2 for a user's mistake."""
    from emulator.machine import Machine, MachineError

    set_up_logging(options.verbosity)
    try:
        from emulator.rmc.modbus import ModbusServer
    except ImportError:
        return _mistake("--device rmc151 needs pymodbus: pip install 'oem6250[rmc]'")
    try:
        machine = Machine.load(Path(options.machine)) if options.machine else Machine.default()
        host, port = options.modbus or (FALLBACK_HOST, machine.rmc.port)
        server = ModbusServer(host, port, allow_remote=options.allow_remote)
    except (MachineError, PortError) as error:
        return _mistake(str(error))
    return asyncio.run(_serve(options, machine, server))


def _mistake(text: str) -> int:
    _say(text)
    return 2


async def _serve(options: ServeOptions, machine: Any, server: Any) -> int:
    from emulator.rmc.device import RmcDevice
    from emulator.rmc.registers import Registers
    from emulator.rmc.unit import RmcUnit

    stop = _stop_at_signals()
    device = await _unless_stopped(stop, asyncio.to_thread(RmcDevice, machine, on_build=_say))
    loop, crashes = asyncio.get_running_loop(), [0]

    def crashed() -> None:
        crashes[0] = 1
        loop.call_soon_threadsafe(stop.set)

    engine = EngineThread([RmcUnit(device)], Clock(options.speed), on_crash=crashed)
    await server.start(Registers(device), runs_on(engine))
    engine.start()
    _tell(options, server.addresses)
    await stop.wait()
    await server.close()
    engine.stop()
    return crashes[0]


def _say(text: str) -> None:
    print(f"oem6250: {text}", file=sys.stderr, flush=True)


async def _unless_stopped(stop: asyncio.Event, work: Coroutine[Any, Any, T]) -> T:
    """What some work brings, done in a thread; a signal meanwhile ends the process, building kernel or not."""
    done, stopped = asyncio.ensure_future(work), asyncio.ensure_future(stop.wait())
    await asyncio.wait((done, stopped), return_when=asyncio.FIRST_COMPLETED)
    if not done.done():
        sys.stderr.flush()
        os._exit(0)
    stopped.cancel()
    return done.result()


def runs_on(engine: EngineThread) -> Callable[[Callable[[], Any]], Any]:
    """Do something on the engine thread, awaited on the event loop."""

    async def run(function: Callable[[], Any]) -> Any:
        return await asyncio.wrap_future(engine.call(function))

    return run


def _stop_at_signals() -> asyncio.Event:
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        # Meant: the event loop of Windows has no signal handlers; there Ctrl-C ends the process.
        with contextlib.suppress(NotImplementedError):
            asyncio.get_running_loop().add_signal_handler(number, stop.set)
    return stop


def _tell(options: ServeOptions, addresses: list[str]) -> None:
    if options.announce is None:
        places = ", ".join(addresses)
        print(f"RMC151 is up; Ctrl-C ends it.\n  Modbus/TCP    {places}   (any unit id)", file=sys.stderr, flush=True)
        return
    from emulator.server import announce

    speed = "max" if options.speed is None else options.speed
    announce(options.announce, json.dumps({"modbus": addresses, "pid": os.getpid(), "speed": speed}))

"""An emulator behind real ports, for host code that opens a port itself: a virtual serial port and a TCP port.

It runs in threads of this process, so that a test can still look inside, inject faults and say how time passes; see
`emulator.host_paced` for the rules of time, and docs/testing.md for their limits.
"""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypeVar

from clients.testing.errors import NotPossible, NotReached
from clients.testing.machines import machine_of
from clients.testing.traffic import Traffic
from clients.testing.unit_control import UnitControl
from clients.testing.waiting import at_rest
from emulator.chain import build_chain
from emulator.clock import Clock
from emulator.host_paced import QUIET_NS, HostPacedClock, TimetabledUnit
from emulator.pacing import EngineThread
from emulator.parameters import Value
from emulator.ports import TcpPort
from emulator.recording.recorded import RecordedUnit

if TYPE_CHECKING:
    from clients import OEM6250
    from emulator.controller import Controller
    from emulator.machine import Machine

T = TypeVar("T")
Speed = float | Literal["waiting", "max"]
NS_PER_S = 1_000_000_000
START_PATIENCE_S = 30.0
ANSWER_PATIENCE_S = 30.0
"""Wall time within which the engine thread answers, or something is badly wrong."""
PATIENCE_S = 60.0


class _Bench:
    """A unit on the engine thread; everything done to it is done there."""

    def __init__(self, controller: Controller, call: Callable[[Callable[[], Any]], Any], unit: TimetabledUnit) -> None:
        self.controller = controller
        self._call = call
        self._unit = unit

    def do(self, action: str, values: Mapping[str, Value]) -> None:
        from emulator.registry import ACTIONS

        self._call(lambda: ACTIONS[action].carry_out(self.controller, values))

    def ask(self, function: Callable[[], T]) -> T:
        result: T = self._call(function)
        return result

    def at(self, at_ns: int, function: Callable[[], None]) -> None:
        self._call(lambda: self._unit.at(at_ns, function))


class Served:
    """A line of one unit, or of a daisy chain, behind a virtual serial port and a TCP port.

    Args:
        machine: a Machine, the text of a machine file or the path of one; None is the default machine.
        chain: units on the line, addressed 1, 2 ... if there are several.
        speed: ``waiting``: time moves only while the host waits; N: N times the wall's; ``max``: as fast as possible
            while anything is under way.
        names: names of your own for inputs and outputs.
        quiet_ms: silence of the host that counts as waiting, ms of the wall's time.
    """

    def __init__(
        self,
        machine: Machine | str | Path | None = None,
        *,
        chain: int = 1,
        speed: Speed = "waiting",
        names: Mapping[str, str] | None = None,
        quiet_ms: float = QUIET_NS / 1e6,
    ) -> None:
        self.machine = machine_of(machine)
        self.speed = speed
        line = build_chain(self.machine, chain)
        line.power_up()
        inner = line if chain > 1 else line.controllers[0]
        self._clock = _clock(speed, quiet_ms=quiet_ms, baud=self.machine.serial.baud)
        self.traffic = Traffic(
            [self.machine], collect=self._collect, now_ns=lambda: inner.now_ns, speed=str(speed), chain=chain
        )
        self._recorded = RecordedUnit(inner, self.traffic, unit=0)
        paced = self._clock if isinstance(self._clock, HostPacedClock) else None
        self._unit = TimetabledUnit(self._recorded, paced)
        self._engine = EngineThread([self._unit], self._clock)
        self.units = [
            UnitControl(_Bench(controller, self.call, self._unit), names or {}) for controller in line.controllers
        ]
        first = self.units[0]
        self.signals, self.inputs, self.outputs = first.signals, first.inputs, first.outputs
        self.update_transcripts = False
        self.do, self.faults = first.do, first.faults
        self._running = False
        self._clients: list[OEM6250] = []
        self._tcp = TcpPort("127.0.0.1", 0)
        self._pty = _pty()
        self._loop = asyncio.SelectorEventLoop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="oem6250 ports", daemon=True)

    def __enter__(self) -> Served:
        self._thread.start()
        self._in_loop(self._open)
        self._engine.start()
        self._running = True
        self._let_sign_on_go()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the ports; hosts that are connected see the end of their connection."""
        for client in self._clients:
            client.close()
        if not self._thread.is_alive():
            return
        self._in_loop(self._stop_accepting)
        self._engine.stop(timeout_s=ANSWER_PATIENCE_S)
        self._running = False
        self._in_loop(self._close_ports)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(START_PATIENCE_S)
        self._loop.close()

    # Where to connect

    @property
    def address(self) -> tuple[str, int]:
        """Host and port of the TCP port."""
        host, _, port = self._tcp.addresses[0].rpartition(":")
        return host, int(port)

    @property
    def tcp_url(self) -> str:
        """``tcp://127.0.0.1:PORT``, as ``OEM6250.open`` takes it; pyserial calls the same ``socket://``."""
        return f"tcp://{self._tcp.addresses[0]}"

    @property
    def port(self) -> str:
        """The virtual serial port, for pyserial; NotPossible where the system has none (Windows)."""
        if self._pty is None:
            raise NotPossible("this system has no virtual serial ports; use tcp_url")
        return str(self._pty.node)

    @property
    def client(self) -> OEM6250:
        """A client of our own over TCP, connected when it is first asked for."""
        if not self._clients:
            from clients import OEM6250

            self._clients.append(OEM6250.open(self.tcp_url))
        return self._clients[0]

    # Time

    @property
    def time_s(self) -> float:
        """Virtual time, s."""
        return self.call(lambda: self._unit.now_ns) / NS_PER_S

    def advance(self, seconds: float) -> None:
        """Let virtual time pass, at once, whatever the hosts do; ValueError for less than none."""
        if seconds < 0:
            raise ValueError(f"time does not run back by {-seconds} s")
        target_ns = self.call(lambda: self._skip(round(seconds * NS_PER_S)))
        while self.call(lambda: self._unit.now_ns) < target_ns:
            pass

    def run_until(self, condition: Callable[[], bool], *, timeout_s: float = PATIENCE_S, step_s: float = 0.01) -> None:
        """Let virtual time pass in small steps until a condition holds.

        Raises:
            NotReached: it did not within the time.
        """
        end_s = self.time_s + timeout_s
        while not condition():
            if self.time_s >= end_s:
                raise NotReached("the condition was", within_s=timeout_s, at_s=self.time_s)
            self.advance(step_s)

    def settle(self, *, timeout_s: float = PATIENCE_S) -> None:
        """Let virtual time pass until nothing is under way and every powered axis is in its target zone.

        Raises:
            NotReached: it did not within the time.
        """
        self.run_until(lambda: self.call(lambda: all(at_rest(unit.bench.controller) for unit in self.units)),
                       timeout_s=timeout_s)  # fmt: skip

    def at(self, at_s: float, function: Callable[[], None]) -> None:
        """Have a function called, on the engine thread, when virtual time reaches a moment (s)."""
        self.call(lambda: self._unit.at(round(at_s * NS_PER_S), function))

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """A block within which the host waits: while anything is under way time runs without any quiet time."""
        clock = self._host_paced()
        self.call(lambda: clock.declare_waiting(+1))
        try:
            yield
        finally:
            self.call(lambda: clock.declare_waiting(-1))

    @contextmanager
    def working(self) -> Iterator[None]:
        """A block within which the host does not wait: time stands still except for characters."""
        clock = self._host_paced()
        self.call(lambda: clock.declare_working(+1))
        try:
            yield
        finally:
            self.call(lambda: clock.declare_working(-1))

    @contextmanager
    def virtual_sleep(self) -> Iterator[None]:
        """A block within which ``time.sleep`` in this thread lets exactly that much virtual time pass, at once."""
        thread, before = threading.current_thread(), time.sleep

        def sleep(seconds: float | SupportsIndex) -> None:
            if threading.current_thread() is thread:
                self.advance(float(seconds))
            else:
                before(seconds)

        time.sleep = sleep
        try:
            yield
        finally:
            time.sleep = before

    # What has been said

    def transcript(self, title: str = "a test") -> str:
        """The session as a test transcript (docs/recording.md)."""
        return self.call(lambda: self.traffic.transcript(title))

    def assert_transcript(self, path: str | Path, *, title: str = "a test", update: bool | None = None) -> None:
        """Compare the session with a transcript that was kept in a file; with ``update`` (None: as --oem6250-update
        says) write the file instead. AssertionError if they differ."""
        from clients.testing.snapshots import assert_same_transcript

        said = self.transcript(title)
        assert_same_transcript(said, Path(path), update=self.update_transcripts if update is None else update)

    def recording(self) -> bytes:
        """The session as a recording that ``oem6250 replay`` takes."""
        return self.call(self.traffic.recording)

    def describe(self) -> str:
        """The state of all units in words."""
        return "\n".join(unit.describe() for unit in self.units)

    def call(self, function: Callable[[], T]) -> T:
        """Call a function where the machines are run, with nothing else working on them."""
        if not self._running:
            return function()
        return self._engine.call(function).result(ANSWER_PATIENCE_S)

    def _let_sign_on_go(self) -> None:
        """Two turns of the engine thread, the first of which tells the ports what power-up says: a TCP host that
        connects afterwards meets a unit that has been on for a while, whichever thread is the faster."""
        for _ in range(2):
            self.call(lambda: None)

    def _skip(self, ns: int) -> int:
        self._clock.skip(ns)
        return self._unit.now_ns + ns

    def _host_paced(self) -> HostPacedClock:
        if not isinstance(self._clock, HostPacedClock):
            raise NotPossible(f"time goes at speed {self.speed} here; that needs speed 'waiting'")
        return self._clock

    def _collect(self) -> None:
        self._recorded.finish(self._recorded.now_ns)

    # The loop's thread

    def _open(self) -> None:
        self._tcp.serve(self._loop, self._engine)
        if self._pty is not None:
            self._pty.serve(self._loop, self._engine)

    def _stop_accepting(self) -> None:
        self._tcp.stop_accepting()
        if self._pty is not None:
            self._pty.stop_accepting()

    def _close_ports(self) -> None:
        self._tcp.close()
        if self._pty is not None:
            self._pty.close()

    def _in_loop(self, function: Callable[[], None]) -> None:
        async def run() -> None:
            function()

        asyncio.run_coroutine_threadsafe(run(), self._loop).result(START_PATIENCE_S)


def served(
    machine: Machine | str | Path | None = None,
    *,
    chain: int = 1,
    speed: Speed = "waiting",
    names: Mapping[str, str] | None = None,
) -> Served:
    """An emulator behind ports of this machine, as a context manager; the arguments are those of Served."""
    return Served(machine, chain=chain, speed=speed, names=names)


def _clock(speed: Speed, *, quiet_ms: float, baud: int) -> Clock:
    if speed == "waiting":
        quiet_ns = round(quiet_ms * 1e6)
        return HostPacedClock(quiet_ns=quiet_ns, character_ns=0) if baud else HostPacedClock(quiet_ns=quiet_ns)
    return Clock(None if speed == "max" else float(speed))


def _pty() -> Any:
    if os.name == "nt":
        return None
    from emulator.ports.pty import PtyPort

    return PtyPort("auto")

"""An emulator in this process on virtual time, with a client: what the fixture ``oem6250`` gives and pytest-free code
gets from ``with emulated() as emu``.

Time stands still except inside ``advance``, ``run_until``, ``settle`` and whatever a client waits for.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from clients.testing.chained import ChainedEmulator, ChainEnd, EmulatorLike
from clients.testing.errors import NotReached
from clients.testing.machines import machine_of
from clients.testing.traffic import Traffic
from clients.testing.unit_control import UnitControl
from clients.testing.virtual_line import VirtualLine
from clients.testing.waiting import AT_REST_COUNTS, MotionWatch, at_rest, in_zone, listed
from emulator.emulator import NS_PER_S, Emulator, Unit
from emulator.parameters import Value

if TYPE_CHECKING:
    from clients import OEM6250, AsyncOEM6250
    from clients.testing.trace import Trace
    from emulator.controller import Controller
    from emulator.machine import Machine
    from emulator.recording.recorded import RecordedUnit

T = TypeVar("T")
PATIENCE_S = 60.0
"""Virtual time after which waiting for something fails, unless a test says otherwise (design choice)."""
LONGEST_S = 86_400.0
"""Virtual time after which a host that still waits is taken to wait for ever (design choice)."""


class _Bench:
    """A unit in this process: nothing else works on it between two calls."""

    def __init__(self, unit: Unit, emulator: EmulatorLike) -> None:
        self._unit = unit
        self._emulator = emulator
        self.controller = unit.controller

    def do(self, action: str, values: Mapping[str, Value]) -> None:
        self._unit.do(action, **values)

    def ask(self, function: Callable[[], T]) -> T:
        return function()

    def at(self, at_ns: int, function: Callable[[], None]) -> None:
        self._emulator.at_ns(at_ns, function)


class EmulatedUnit(UnitControl):
    """One unit of an emulator: what UnitControl has, its wire, and its client."""

    def __init__(self, owner: Emulated, index: int, names: Mapping[str, str]) -> None:
        self.unit = owner.emulator.unit(index)
        super().__init__(_Bench(self.unit, owner.emulator), names)
        self._owner = owner
        self._index = index
        self._lines: list[VirtualLine] = []
        self._client: OEM6250 | None = None

    @property
    def controller(self) -> Controller:
        """The unit's inside."""
        return self.unit.controller

    @property
    def client(self) -> OEM6250:
        """A client connected to the unit, made when it is first asked for."""
        if self._client is None:
            self._client = self._connect()
        return self._client

    def async_client(self) -> AsyncOEM6250:
        """A new asyncio client, for `async with`. In a host started with `run` it waits in virtual time as that whole
        event loop does; in any other loop time passes while it reads."""
        from clients import AsyncOEM6250
        from clients.async_lines import DirectLine
        from clients.testing.virtual_loop import AsyncVirtualLine, VirtualLoop

        virtual = isinstance(asyncio.get_running_loop(), VirtualLoop)
        line = AsyncVirtualLine(self.line()) if virtual else DirectLine(self.line())
        return AsyncOEM6250(line) if self._owner.chain is None else AsyncOEM6250(line, address=self._index + 1)

    def _connect(self) -> OEM6250:
        from clients import OEM6250

        if self._owner.chain is None:
            return OEM6250(self.line())
        if self._index:
            return self._owner.client.unit(self._index + 1)
        return OEM6250(self.line(), address=1)

    def line(self) -> VirtualLine:
        """A new connection to the unit, for a client of your own; all of them are on the one serial port."""
        if self._owner.chain is not None and self._index:
            return self._owner.line()
        end = self._owner.chain or self.unit
        number = len(self._lines)
        step = partial(self._owner.step, unit=self._index)
        self._lines.append(VirtualLine(end, step, channel=number, name=f"emulated unit {self._index}"))
        return self._lines[-1]


class Emulated:
    """Units on one virtual time; ``signals``, ``inputs``, ``outputs``, ``faults``, ``client`` ... are the first one's.

    Args:
        machine: a Machine, the text of a machine file or the path of one; None is the default machine.
        units: like units side by side, each with a line of its own.
        chain: like units on one line, a daisy chain, addressed 1, 2, 3 ...; ERRLVL1 in the machine's defaults first.
        names: names of your own for inputs and outputs: ``{"start": "input.3", "lamp": "output.2"}``.
    """

    def __init__(
        self,
        machine: Machine | str | Path | Sequence[Machine | str | Path] | None = None,
        *,
        units: int = 1,
        chain: int = 1,
        names: Mapping[str, str] | None = None,
    ) -> None:
        if units > 1 and chain > 1:
            raise ValueError("units stand side by side or on one line: give units or chain, not both")
        machines = _machines(machine, units)
        self.traffic = Traffic(machines[:1] if chain > 1 else machines, collect=self._collect,
                               now_ns=lambda: self.now_ns, chain=chain)  # fmt: skip
        self.emulator, self.chain, self._recorded = _begin(machines, chain, self.traffic)
        self.units = [EmulatedUnit(self, index, names or {}) for index in range(len(self.emulator.units))]
        self._traces: dict[int, Trace] = {}
        self._watches: list[Callable[[], None]] = []
        first = self.units[0]
        self.signals, self.inputs, self.outputs = first.signals, first.inputs, first.outputs
        self.update_transcripts = False
        self.do, self.line, self.faults = first.do, first.line, first.faults
        self.async_client = first.async_client

    def __enter__(self) -> Emulated:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """The end; nothing has to be released, since a unit is but memory."""
        self.emulator.close()

    @property
    def client(self) -> OEM6250:
        """A client of the first unit, connected when it is first asked for."""
        return self.units[0].client

    def unit(self, index: int = 0) -> EmulatedUnit:
        """A unit by its place, from 0."""
        return self.units[index]

    # Time

    @property
    def now_ns(self) -> int:
        """Virtual time, ns."""
        return self.units[0].controller.now_ns

    @property
    def time_s(self) -> float:
        """Virtual time, s."""
        return self.now_ns / NS_PER_S

    def advance(self, seconds: float) -> None:
        """Let virtual time pass; ValueError for less than none."""
        if seconds < 0:
            raise ValueError(f"time does not run back by {-seconds} s")
        self._advance_to(self.now_ns + round(seconds * NS_PER_S))

    def run_until(self, condition: Callable[[], bool], *, timeout_s: float = PATIENCE_S) -> None:
        """Let virtual time pass, one system update after another, until a condition holds.

        Raises:
            NotReached: it did not within the time.
        """
        end_ns = self.now_ns + round(timeout_s * NS_PER_S)
        while not condition():
            if self.now_ns >= end_ns:
                raise NotReached("the condition was", within_s=timeout_s, at_s=self.time_s)
            self._advance_to(min(self.units[0].controller.engine.next_system_update_ns, end_ns))

    def settle(self, *, timeout_s: float = PATIENCE_S) -> None:
        """Let virtual time pass until nothing is under way in any unit and every powered axis is in its target zone.

        Raises:
            NotReached: it did not within the time.
        """
        end_ns = self.now_ns + round(timeout_s * NS_PER_S)
        while not all(at_rest(unit.controller) for unit in self.units):
            if self.now_ns >= end_ns:
                raise NotReached("rest was", within_s=timeout_s, at_s=self.time_s)
            self._go_on(end_ns)

    def at(self, at_s: float, function: Callable[[], None]) -> None:
        """Have a function called when virtual time reaches a moment (s)."""
        self.emulator.at(at_s, function)

    def step(self, until_ns: int, *, unit: int = 0) -> None:
        """Let virtual time pass up to the next thing that happens in a unit, at most to a moment (ns).

        Raises:
            NotReached: a day has passed in which the host has been waiting.
        """
        if self.time_s > LONGEST_S:
            raise NotReached("the end of the host's waiting was", within_s=LONGEST_S, at_s=self.time_s)
        self.emulator.advance_to_event(until_ns, unit=unit)
        for look in self._watches:
            look()

    def run(self, host: Coroutine[Any, Any, T]) -> T:
        """Run an asyncio host in an event loop on virtual time, in which `asyncio.sleep` and time-outs are virtual too;
        its result. Its clients are `async_client()`s."""
        from clients.testing.virtual_loop import run_virtually

        return run_virtually(host, now_ns=lambda: self.now_ns, step=self._step_for_all)

    # Claims

    def trace(self, name: str, *, axis: int | None = 1, seconds: float | None = None, unit: int = 0) -> Trace:
        """Record a signal from now on, sample by sample; what it returns is an array of it whenever you look.

        Args:
            name: of the registry without the axis, blanks for dots: ``position error``, ``dac``, ``velocity true``.
            axis: 1 or 2; None for a signal of the unit.
            seconds: of the recording; None records until the memory for it is full.
            unit: the unit by its place. A unit has one scope: the next trace ends this one, which keeps what it has.
        """
        from clients.testing.trace import begin_trace

        if unit in self._traces:
            self._traces[unit].end()
        self._traces[unit] = begin_trace(self.units[unit].unit, name, axis=axis, seconds=seconds)
        return self._traces[unit]

    def assert_no_motion(
        self, seconds: float, *, axis: int | None = None, tolerance_counts: int = AT_REST_COUNTS
    ) -> None:
        """Let virtual time pass and see that no profile runs and no shaft moves, of one axis or of all."""
        with self.no_motion(axis=axis, tolerance_counts=tolerance_counts):
            self.advance(seconds)

    @contextmanager
    def no_motion(self, *, axis: int | None = None, tolerance_counts: int = AT_REST_COUNTS) -> Iterator[None]:
        """A block within which nothing may move: no profile, no shaft by more than the tolerance."""
        controller = self.units[0].controller
        axes = range(controller.settings.axes) if axis is None else [axis - 1]
        watch = MotionWatch(controller, axes, tolerance_counts=tolerance_counts)
        with listed(self._watches, watch.look):
            yield
        watch.complain()

    def assert_settles_within(self, seconds: float, *, axis: int | None = None) -> float:
        """Let virtual time pass until the axis (None: every powered one) has no profile running and is in its target
        zone (STRGTD, STRGTV; AS bit 24), and return how long that took, s.

        AssertionError if it takes longer.
        """
        began_ns, controller = self.now_ns, self.units[0].controller
        axes = (
            [axis - 1]
            if axis is not None
            else [i for i in range(controller.settings.axes) if controller.engine.is_enabled(i)]
        )
        try:
            self.run_until(lambda: all(in_zone(controller, i) for i in axes), timeout_s=seconds)
        except NotReached:
            state = self.units[0].describe()
            raise AssertionError(f"not settled within {seconds:g} s of virtual time:\n{state}") from None
        return (self.now_ns - began_ns) / NS_PER_S

    # What has been said

    def transcript(self, title: str = "a test") -> str:
        """The session as a test transcript (docs/recording.md)."""
        return self.traffic.transcript(title)

    def assert_transcript(self, path: str | Path, *, title: str = "a test", update: bool | None = None) -> None:
        """Compare the session with a transcript that was kept in a file; with ``update`` (None: as --oem6250-update
        says) write the file instead. AssertionError if they differ."""
        from clients.testing.snapshots import assert_same_transcript

        said = self.transcript(title)
        assert_same_transcript(said, Path(path), update=self.update_transcripts if update is None else update)

    def recording(self) -> bytes:
        """The session as a recording that ``oem6250 replay`` takes."""
        return self.traffic.recording()

    def describe(self) -> str:
        """The state of all units in words."""
        if len(self.units) == 1:
            return self.units[0].describe()
        return "\n".join(f"unit {index}: {unit.describe()}" for index, unit in enumerate(self.units))

    def _collect(self) -> None:
        for recorded in self._recorded:
            recorded.finish(recorded.now_ns)

    def _advance_to(self, at_ns: int) -> None:
        while self._watches and self.now_ns < at_ns:
            self.step(at_ns)
        self.emulator.advance_to(at_ns)

    def _step_for_all(self, until_ns: int) -> None:
        """Several units: one of them may say something before the next thing happens in another."""
        if len(self.units) > 1:
            until_ns = min(until_ns, self.units[0].controller.engine.next_system_update_ns)
        self.step(until_ns)

    def _go_on(self, end_ns: int) -> None:
        """While something is under way events tell of its end; after that only looking does."""
        busy = next((index for index, unit in enumerate(self.units) if unit.controller.busy), None)
        if busy is not None:
            self.step(end_ns, unit=busy)
        else:
            self._advance_to(min(self.units[0].controller.engine.next_system_update_ns, end_ns))


def emulated(
    machine: Machine | str | Path | Sequence[Machine | str | Path] | None = None,
    *,
    units: int = 1,
    chain: int = 1,
    names: Mapping[str, str] | None = None,
) -> Emulated:
    """An emulator in this process, as a context manager; the arguments are those of Emulated."""
    return Emulated(machine, units=units, chain=chain, names=names)


def _begin(
    machines: Sequence[Machine], chain: int, traffic: Traffic
) -> tuple[EmulatorLike, ChainEnd | None, list[RecordedUnit]]:
    """The units, the end of their line if they share one, and where what they say is written down."""
    if chain == 1:
        emulator = Emulator(machines)
        return emulator, None, [unit.record(traffic, unit=index) for index, unit in enumerate(emulator.units)]
    if len(machines) > 1:
        raise ValueError("the units of a chain are alike: give one machine")
    chained = ChainedEmulator(machines[0], chain)
    end = ChainEnd(chained.chain, traffic)
    return chained, end, [end.recorded]


def _machines(machine: Machine | str | Path | Sequence[Machine | str | Path] | None, units: int) -> list[Machine]:
    if machine is not None and not isinstance(machine, str) and isinstance(machine, Sequence):
        return [machine_of(each) for each in machine]
    return [machine_of(machine)] * units

"""The emulator as Python sees it: one or more units on one virtual time that only moves when told to.

    emu = Emulator()
    unit = emu.unit(0)
    unit.send(b"DRIVE11:D4000:GO11\\r")
    emu.advance(2.0)
    unit.signals["axis1.position.commanded"]

Everything that can be read or done from outside the wire comes from the registry (``emulator.registry``).
"""

from __future__ import annotations

import weakref
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, TypeVar

from emulator.agenda import Agenda
from emulator.channel import OutputLike
from emulator.controller import Controller
from emulator.engine.machine_code import OnBuild
from emulator.machine import Machine
from emulator.registry import ACTIONS, Value, describe_signals
from emulator.scope import UnitScope

if TYPE_CHECKING:
    from emulator.faults.injection import UnitFaults
    from emulator.recording.recorded import RecordedUnit, TakesLines
    from emulator.state.memory import Memory

NS_PER_S = 1_000_000_000

T = TypeVar("T")

LOOK_AT_LINE_NS = 1_000_000
"""How often to look for characters on a timed line: about one at 9600 baud."""

HOST_CHANNEL = 0
"""The connection meant when none is named."""


class Signals(Mapping[str, Value]):
    """The readable signals of one unit by name; iterating gives the names."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._signals = describe_signals(controller)

    def __getitem__(self, name: str) -> Value:
        if name not in self._signals:
            raise KeyError(f"no signal {name!r}; there are {', '.join(self._signals)}")
        return self._signals[name].read(self._controller)

    def __iter__(self) -> Iterator[str]:
        return iter(self._signals)

    def __len__(self) -> int:
        return len(self._signals)


class Unit:
    """One unit of an emulator: its wire end, its signals, its actions."""

    def __init__(self, controller: Controller, agenda: Agenda | None = None) -> None:
        self.controller = controller
        self._agenda = Agenda() if agenda is None else agenda
        self._wire: Controller | RecordedUnit = controller
        self.signals: Mapping[str, Value] = Signals(controller)
        self.scope = UnitScope(controller)
        """Records signals at servo rate."""
        self._unread: defaultdict[int, bytearray] = defaultdict(bytearray)
        self._log: list[OutputLike] = []
        self._memory: Memory | None = None

    def send(self, data: bytes, *, channel: int = HOST_CHANNEL) -> None:
        """Bytes from a host, now."""
        self._wire.receive(data, at_ns=self.controller.now_ns, channel=channel)
        self._unread.setdefault(channel, bytearray())

    def read(self, *, channel: int = HOST_CHANNEL) -> bytes:
        """What the unit has sent this channel since last read; output for everyone reaches every channel."""
        self._sort_output()
        data = bytes(self._unread[channel])
        self._unread[channel].clear()
        return data

    def hang_up(self, *, channel: int = HOST_CHANNEL) -> None:
        """A connection ends: half a command of it is forgotten, and what it had not read."""
        self._wire.detach(channel)
        self._unread.pop(channel, None)

    def take_output(self) -> list[OutputLike]:
        """The output since last asked with its virtual times, for every channel together."""
        self._sort_output()
        taken, self._log = self._log, []
        return taken

    def do(self, action: str, **parameters: Value) -> None:
        """Carry out an action of the registry: ``unit.do("set_wire", name="enable", closed=False)``.

        Raises:
            KeyError: no such action, wire or parameter.
        """
        if action not in ACTIONS:
            raise KeyError(f"no action {action!r}; there are {', '.join(ACTIONS)}")
        ACTIONS[action].carry_out(self.controller, parameters)

    @property
    def faults(self) -> UnitFaults:
        """The faults of the registry: ``with unit.faults.limit_open(axis=1) as fault:`` (docs/testing.md)."""
        from emulator.faults.injection import UnitFaults

        return UnitFaults(_FaultBench(self, self._agenda))

    def record(self, recorder: TakesLines, *, unit: int) -> RecordedUnit:
        """Write everything that goes in and out from now on into a recording, as its unit of that number."""
        from emulator.recording.recorded import RecordedUnit

        self._wire = RecordedUnit(self.controller, recorder, unit=unit)
        return self._wire

    def keep(self, memory: Memory | None) -> None:
        """Have what the unit keeps made durable before anything it says is heard; None: no longer."""
        self._memory = memory

    def _sort_output(self) -> None:
        if self._memory is not None:
            self._memory.save()
        for output in self._wire.take_output():
            self._log.append(output)
            channels = list(self._unread) or [HOST_CHANNEL] if output.channel is None else [output.channel]
            for channel in channels:
                self._unread[channel] += output.data


def _next_output_ns(controller: Controller) -> int:
    """When to look for output that no event tells of: held back by a fault, or characters on their way."""
    held_ns = max(controller.disturbances.next_ns, controller.now_ns + 1)
    return min(held_ns, controller.now_ns + LOOK_AT_LINE_NS) if controller.line.busy else held_ns


class _FaultBench:
    """A unit in this process whose time stands still between calls."""

    def __init__(self, unit: Unit, agenda: Agenda) -> None:
        self.controller = unit.controller
        self.at = agenda.enter
        self._unit = unit

    def do(self, action: str, values: Mapping[str, Value]) -> None:
        self._unit.do(action, **values)

    def ask(self, function: Callable[[], T]) -> T:
        return function()


class Emulator:
    """Units on one virtual time.  They are powered up; the sign-on waits to be read.

    With ``record`` the session goes into that file (docs/recording.md): what is sent and done through the units, and
    what they say.  ``close``, or leaving the emulator as a context manager, completes the file.

    With ``state`` the units' non-volatile memory is that file (docs/state.md).  It is written before what a unit says
    is read, and by ``close``, which also lets go of the file: another emulator on it finds everything.

    Raises:
        RecordingError: the file exists or cannot be written.
        StateError: the state file cannot be used.
        ValueError: the machine cannot be written as a machine file.
    """

    def __init__(
        self,
        machine: Machine | Sequence[Machine] | None = None,
        *,
        on_build: OnBuild | None = None,
        record: str | Path | None = None,
        state: str | Path | None = None,
    ) -> None:
        machines = [machine or Machine.default()] if machine is None or isinstance(machine, Machine) else list(machine)
        self._agenda = Agenda()
        self.units = [Unit(Controller(each, on_build=on_build), self._agenda) for each in machines]
        self._memory = None if state is None else self._open_memory(state)
        self._finish: Callable[[], None] | None = None if record is None else self._record(record, machines)
        for unit in self.units:
            unit.controller.power_up()

    def __enter__(self) -> Emulator:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Complete the recording and the state file, if there are any."""
        if self._finish is not None:
            self._finish()
        if self._memory is not None:
            memory, self._memory = self._memory, None
            for unit in self.units:
                unit.keep(None)
            try:
                memory.save()
            finally:
                memory.close()

    def _open_memory(self, path: str | Path) -> Memory:
        """The state file with its contents in the units, which are not switched on yet."""
        from emulator.state.memory import Memory

        memory = Memory(path)
        weakref.finalize(self, memory.close)
        memory.restore([unit.controller for unit in self.units])
        for unit in self.units:
            unit.keep(memory)
        return memory

    def _record(self, path: str | Path, machines: Sequence[Machine]) -> Callable[[], None]:
        """Begin a recording; what to call when the session is over."""
        from emulator.recording.machine_text import machine_text
        from emulator.recording.recorded import finish
        from emulator.recording.recorder import Recorder
        from emulator.recording.session import describe

        recorder = Recorder(path, describe([machine_text(each) for each in machines], speed="virtual"))
        weakref.finalize(self, recorder.close)
        return partial(finish, recorder, [unit.record(recorder, unit=index) for index, unit in enumerate(self.units)])

    def unit(self, index: int = 0) -> Unit:
        """A unit by its place, from 0."""
        return self.units[index]

    @property
    def time_s(self) -> float:
        """Virtual time since the emulator was made."""
        return self.units[0].controller.now_ns / NS_PER_S

    def advance(self, seconds: float) -> None:
        """Let virtual time pass in all units."""
        self.advance_to(self.units[0].controller.now_ns + round(seconds * NS_PER_S))

    def advance_to(self, at_ns: int) -> None:
        """Let virtual time pass up to a moment (ns)."""
        while self._agenda.next_ns <= at_ns:
            due_ns = self._agenda.next_ns
            self._run_to(due_ns)
            self._agenda.carry_out(due_ns)
        self._run_to(at_ns)

    def at(self, at_s: float, function: Callable[[], None]) -> None:
        """Have a function called when virtual time reaches a moment (s)."""
        self.at_ns(round(at_s * NS_PER_S), function)

    def at_ns(self, at_ns: int, function: Callable[[], None]) -> None:
        """The same with the moment in ns."""
        self._agenda.enter(at_ns, function)

    def advance_to_event(self, until_ns: int, *, unit: int = 0) -> None:
        """Let virtual time pass up to the next thing that happens in one unit, at most to a moment (ns).

        A thing that happens is one that Python sees: a move ends, a limit trips, a wait is over, a reply is said.
        """
        first = self.units[unit].controller
        if self._agenda.next_ns <= first.now_ns:
            self._agenda.carry_out(first.now_ns)
        if first.now_ns < until_ns:
            first.advance_to_event(min(until_ns, self._agenda.next_ns, _next_output_ns(first)))
        self.advance_to(first.now_ns)

    def _run_to(self, at_ns: int) -> None:
        for unit in self.units:
            unit.controller.advance(at_ns)

    def run_until(self, condition: Callable[[], bool], *, timeout_s: float = 60.0) -> bool:
        """Advance one system update after another until a condition holds; False if it never did within the time."""
        controller = self.units[0].controller
        end_ns = controller.now_ns + round(timeout_s * NS_PER_S)
        while not condition():
            if controller.now_ns >= end_ns:
                return False
            self.advance_to(min(controller.engine.next_system_update_ns, end_ns))
        return True

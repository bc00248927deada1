"""Units of a daisy chain in this process: one virtual time, one line, on which the first hears and the last speaks.

Has the face of `emulator.emulator.Emulator`, so that everything else of a test works on it. What a unit says goes to
the next one at the virtual time it is said, so time runs in steps of a system update, which costs a tenth of the speed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from emulator.agenda import Agenda
from emulator.chain import Chain, build_chain
from emulator.emulator import Unit
from emulator.recording.recorded import RecordedUnit, TakesLines

if TYPE_CHECKING:
    from emulator.machine import Machine


class EmulatorLike(Protocol):
    """What a test needs of an emulator."""

    units: list[Unit]

    def unit(self, index: int = 0) -> Unit: ...
    def at(self, at_s: float, function: Callable[[], None]) -> None: ...
    def at_ns(self, at_ns: int, function: Callable[[], None]) -> None: ...
    def advance_to(self, at_ns: int) -> None: ...
    def advance_to_event(self, until_ns: int, *, unit: int = 0) -> None: ...
    def close(self) -> None: ...


class ChainedEmulator:
    """Like units in a row, addressed 1, 2, 3 ..., powered up.

    Args:
        machine: of each unit; the address is added to its defaults.
        count: 2 to 99.
    """

    def __init__(self, machine: Machine, count: int) -> None:
        self._agenda = Agenda()
        self.chain = build_chain(machine, count)
        self.units = [Unit(controller, self._agenda) for controller in self.chain.controllers]
        self.chain.power_up()

    def unit(self, index: int = 0) -> Unit:
        """A unit by its place, from 0."""
        return self.units[index]

    def at(self, at_s: float, function: Callable[[], None]) -> None:
        """Have a function called when virtual time reaches a moment (s)."""
        self.at_ns(round(at_s * 1e9), function)

    def at_ns(self, at_ns: int, function: Callable[[], None]) -> None:
        """The same with the moment in ns."""
        self._agenda.enter(at_ns, function)

    def advance_to(self, at_ns: int) -> None:
        """Let virtual time pass in all units up to a moment (ns)."""
        while self._agenda.next_ns <= at_ns:
            due_ns = self._agenda.next_ns
            self.chain.advance(due_ns)
            self._agenda.carry_out(due_ns)
        self.chain.advance(at_ns)

    def advance_to_event(self, until_ns: int, *, unit: int = 0) -> None:
        """Let virtual time pass to the next system update, at most to a moment (ns): the next unit may have heard
        something by then."""
        controller = self.units[unit].controller
        self.advance_to(max(controller.now_ns, min(until_ns, controller.engine.next_system_update_ns)))

    def close(self) -> None:
        """The end; nothing has to be released."""


class ChainEnd:
    """The host's end of the line of a chain."""

    def __init__(self, chain: Chain, recorder: TakesLines) -> None:
        self.controller = chain
        self.recorded = RecordedUnit(chain, recorder, unit=0)
        self._unread: defaultdict[int, bytearray] = defaultdict(bytearray)

    def send(self, data: bytes, *, channel: int = 0) -> None:
        """Bytes from a host, now."""
        self.recorded.receive(data, at_ns=self.controller.now_ns, channel=channel)
        self._unread.setdefault(channel, bytearray())

    def read(self, *, channel: int = 0) -> bytes:
        """What has come out of the last unit for this channel since last read."""
        for output in self.recorded.take_output():
            channels = list(self._unread) or [channel] if output.channel is None else [output.channel]
            for each in channels:
                self._unread[each] += output.data
        data = bytes(self._unread[channel])
        self._unread[channel].clear()
        return data

    def hang_up(self, *, channel: int = 0) -> None:
        """A connection ends: half a command of it is forgotten everywhere."""
        self.recorded.detach(channel)
        self._unread.pop(channel, None)

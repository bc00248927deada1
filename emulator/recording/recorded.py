"""A unit that is being recorded: stands between whoever talks to it and the controller or chain itself.

What comes in is written down with the time at which the controller takes it, after everything the unit had said by
then; so the file is in order of time, and each answer stands below what caused it. How a session is cut into calls does
not matter to a unit, so looking after its output more often than otherwise changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Protocol, cast

from emulator.channel import ControllerLike, OutputLike
from emulator.recording.format import Attached, Detached, Done, Entry, Value, received_line, sent_line
from emulator.recording.machine_text import machine_text
from emulator.recording.recorder import Recorder

if TYPE_CHECKING:
    from emulator.controller import Controller
    from emulator.machine import Machine

RELOAD = "reload_machine_file"
"""How a machine file that was read again stands among the actions; its parameter is the new file's text."""


class TakesLines(Protocol):
    """Where the lines of a recording go: a Recorder, or whoever wants to look at them."""

    def put(self, line: bytes) -> None:
        """A line, its line feed included."""
        ...

    def note(self, entry: Entry) -> None:
        """An entry, to be formatted."""
        ...


class RecordedUnit:
    """Has the face of a controller; `unit` is its number in the recording."""

    def __init__(self, inner: ControllerLike, recorder: TakesLines, *, unit: int) -> None:
        self._inner = inner
        self._recorder = recorder
        self._unit = unit
        self._outputs: list[OutputLike] = []
        self.controllers = members_of(inner)
        """The units of a daisy chain, or the one there is."""
        for member, controller in enumerate(self.controllers):
            controller.around_action = partial(self._around_action, member)

    @property
    def now_ns(self) -> int:
        return self._inner.now_ns

    @property
    def busy(self) -> bool:
        return self._inner.busy

    def input_full(self, channel: int) -> bool:
        return self._inner.input_full(channel)

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        """Bytes from a connection. They count as received once the unit has come to that time."""
        inner = self._inner
        if at_ns > inner.now_ns:
            inner.advance(at_ns)
        self._collect()
        self._recorder.put(received_line(inner.now_ns, self._unit, channel, data))
        inner.receive(data, at_ns=at_ns, channel=channel)

    def advance(self, until_ns: int) -> None:
        self._inner.advance(until_ns)

    def take_output(self) -> Sequence[OutputLike]:
        self._collect()
        if not self._outputs:
            return ()
        taken, self._outputs = self._outputs, []
        return taken

    def attach(self, channel: int) -> None:
        """A connection was made."""
        self._collect()
        self._recorder.note(Attached(self.now_ns, self._unit, channel))

    def detach(self, channel: int) -> None:
        self._collect()
        self._recorder.note(Detached(self.now_ns, self._unit, channel))
        self._inner.detach(channel)

    def machine_changes(self, machine: Machine) -> None:
        """The unit is about to take over what it can of a machine file that was read again."""
        self._collect()
        parameters: dict[str, Value] = {"text": machine_text(machine)}
        self._recorder.note(Done(self.now_ns, self._unit, 0, RELOAD, parameters))

    def finish(self, at_ns: int) -> None:
        """Run to the time at which the recording ends, and write down what was still said."""
        if at_ns > self.now_ns:
            self._inner.advance(at_ns)
        self._collect()

    @contextmanager
    def _around_action(self, member: int, name: str, values: Mapping[str, Value]) -> Iterator[None]:
        """An action that is refused leaves no trace."""
        self._collect()
        at_ns = self.controllers[member].now_ns
        yield
        self._recorder.note(Done(at_ns, self._unit, member, name, values))

    def _collect(self) -> None:
        for output in self._inner.take_output():
            self._recorder.put(sent_line(output.at_ns, self._unit, output.channel, output.data))
            self._outputs.append(output)


def members_of(unit: ControllerLike) -> Sequence[Controller]:
    """The units of a daisy chain, or the one there is."""
    return cast("Sequence[Controller]", getattr(unit, "controllers", (unit,)))


def finish(recorder: Recorder, units: Sequence[RecordedUnit]) -> None:
    """Close a recording at the time its units have reached."""
    at_ns = max((unit.now_ns for unit in units), default=0)
    for unit in units:
        unit.finish(at_ns)
    recorder.close(at_ns)

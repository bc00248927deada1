"""Several units on one serial line: each hears what the one before it sends, the host hears the last.

A daisy chain has no bus.  The host's transmit line goes to the first unit, that unit's transmit line to the second, and
so on; the last unit's goes back to the host.  What one unit echoes is what the next one receives, which is why every
unit of a chain needs ECHO1, and why prompts (ERRLVL2 to 4) spoil the neighbours' next command: they arrive as input.
None of that is acted out here, it follows from passing bytes on at the virtual time they leave the unit before.

There is no way back up the line, so the units are run one after another over the same stretch of time, each fed with
what the one before it said during it.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence

import msgspec

from emulator.controller import Controller, Output
from emulator.engine.machine_code import OnBuild
from emulator.machine import Machine

MAX_UNITS = 99
"""Units on one line (6000 PG p.72)."""

EVERYONE = -1
"""The channel on which a later unit hears what an earlier one says without being asked (STARTP, sign-on)."""

_DELIMITERS = frozenset(b"\r\n:;")
_ADDRESSING = re.compile(rb"!?ADDR([0-9]{1,2})")
_KEPT = 16
"""More of a line than this need not be looked at to know that it is not an ADDR command."""


class Renumbering:
    """Turns the echo of ``ADDR<i>`` into ``ADDR<i+1>`` on its way to the next unit, so that one command numbers the
    whole chain (6000 PG p.72).  ADDR0 and addressed or other commands pass as they are."""

    def __init__(self) -> None:
        self._line = bytearray()
        self._held = bytearray()

    def passed_on(self, data: bytes) -> bytes:
        """What of ``data`` and of what was held back goes to the next unit now."""
        return b"".join(self._step(byte) for byte in data)

    def _step(self, byte: int) -> bytes:
        if byte in _DELIMITERS:
            said = self._renumbered() + bytes((byte,))
            self._line.clear()
            self._held.clear()
            return said
        if len(self._line) < _KEPT:
            self._line.append(byte)
        if len(self._line) < _KEPT and _ADDRESSING.fullmatch(_compact(self._line)):
            self._held.append(byte)
            return b""
        said = bytes(self._held) + bytes((byte,))
        self._held.clear()
        return said

    def _renumbered(self) -> bytes:
        found = _ADDRESSING.fullmatch(_compact(self._line)) if self._held else None
        if found is None or int(found[1]) == 0:
            return bytes(self._held)
        return b"%d" % (int(found[1]) + 1)


def _compact(line: bytearray) -> bytes:
    return bytes(line).translate(None, b" \t").upper()


class Chain:
    """Units in a row, as one: bytes in at the first, bytes out from the last.  Has the face of a controller.

    Args:
        controllers: first to last, not powered up yet, at the same virtual time.
    """

    def __init__(self, controllers: Sequence[Controller]) -> None:
        _check_size(len(controllers))
        self.controllers = tuple(controllers)
        for controller in self.controllers:
            controller.chained = len(controllers) > 1
        self._renumbering: list[defaultdict[int, Renumbering]] = [defaultdict(Renumbering) for _ in controllers]
        self._outputs: list[Output] = []

    @property
    def now_ns(self) -> int:
        """The virtual time the units have reached, all of them."""
        return self.controllers[-1].now_ns

    @property
    def busy(self) -> bool:
        """Whether anything is under way in any unit."""
        return any(controller.busy for controller in self.controllers)

    def input_full(self, channel: int) -> bool:
        """Whether some unit has so much of this connection waiting that more should stay on the wire."""
        return any(controller.input_full(channel) for controller in self.controllers)

    def power_up(self) -> None:
        """Switch all units on together.

        A unit that is just starting hears nothing: of the sign-ons (address 0 only) the host sees the last unit's.
        """
        for controller in self.controllers:
            controller.power_up()
        for controller in self.controllers[:-1]:
            controller.take_output()
            controller.line.power_down()

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        """Bytes from the host at a virtual time."""
        at_ns = max(at_ns, self.now_ns)
        self.controllers[0].receive(data, at_ns=at_ns, channel=channel)
        self._pass_down(at_ns)

    def advance(self, until_ns: int) -> None:
        """Run all units to a virtual time."""
        self.controllers[0].advance(until_ns)
        self._pass_down(until_ns)

    def take_output(self) -> list[Output]:
        """What the host has been sent since last asked."""
        self._pass_down(self.now_ns)
        taken, self._outputs = self._outputs, []
        return taken

    def detach(self, channel: int) -> None:
        """A connection of the host is gone; half a command of it is forgotten everywhere."""
        for controller, renumbering in zip(self.controllers, self._renumbering, strict=True):
            controller.detach(channel)
            renumbering.pop(channel, None)

    def _pass_down(self, until_ns: int) -> None:
        """Feed every unit with what the one before it has said, and run it up to the same time."""
        for index, controller in enumerate(self.controllers[1:]):
            self._feed(index, controller)
            controller.advance(until_ns)
        outputs = self.controllers[-1].take_output()
        self._outputs += [out._replace(channel=None) if out.channel == EVERYONE else out for out in outputs]

    def _feed(self, index: int, receiver: Controller) -> None:
        """Give a unit what unit ``index`` (from 0), the one before it, has said.

        At one moment a unit takes as much as its input buffer holds; the rest is lost, as it is on a line on which
        prompts beget prompts.
        """
        room, moment_ns = 0, -1
        for at_ns, data, channel in self.controllers[index].take_output():
            if at_ns != moment_ns:
                room, moment_ns = receiver.machine.serial.buffer.size, at_ns
            number = EVERYONE if channel is None else channel
            heard = self._renumbering[index][number].passed_on(data)[:room]
            room -= len(heard)
            if heard:
                receiver.receive(heard, at_ns=at_ns, channel=number, passed_on=True)


def build_chain(machine: Machine, units: int, *, on_build: OnBuild | None = None) -> Chain:
    """A chain of like units, not powered up, with the addresses 1, 2, 3 ... as if numbered in an earlier session (ADDR
    is kept over power-off; design choice).  A chain of one is the machine as it is.

    Raises:
        ValueError: not 1 to 99 units.
    """
    _check_size(units)
    if units == 1:
        return Chain([Controller(machine, on_build=on_build)])
    return Chain([Controller(addressed(machine, 1 + index), on_build=on_build) for index in range(units)])


def _check_size(units: int) -> None:
    if not 1 <= units <= MAX_UNITS:
        raise ValueError(f"a chain has 1 to {MAX_UNITS} units, not {units}")


def addressed(machine: Machine, address: int) -> Machine:
    """The machine of a unit that keeps an address over power-off."""
    others = {name: text for name, text in machine.defaults.items() if name != "ADDR"}
    return msgspec.structs.replace(machine, defaults={"ADDR": str(address), **others})

"""The line without a speed: characters take no time, and nothing is ever lost.

XOFF from a host still works, for the connection it came from: what is said to it waits until its XON.  Output for
everyone waits while any connection has stopped it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.output import Transmitter
from emulator.controller.waits import NEVER
from protocol.line import XOFF, XON

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class InstantLine:
    """What arrives is acted on at once, what is said has left."""

    next_ns = NEVER
    holds_hosts = False
    busy = False
    overruns = 0
    buffered = 0

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._limit = controller.machine.serial.output_buffer
        self._handshake = True
        self.transmitter = Transmitter()
        self.take = self.transmitter.take
        self.received: int = 0
        """Characters that have reached the unit."""

    @property
    def sent(self) -> int:
        """Characters that have left the unit."""
        return self.transmitter.sent

    @property
    def may_block(self) -> bool:
        """Commands may have to wait for the line."""
        return self.transmitter.stopped

    @property
    def held(self) -> bool:
        """A host's XOFF holds output back."""
        return self.transmitter.stopped

    def receive(self, data: bytes, channel: int, from_ns: int) -> None:
        """Characters from a connection, acted on at once."""
        self.hear_apart(data, channel)

    def began_ns(self, at_ns: int) -> int:
        """When a character began that ended at a time."""
        return at_ns

    def hear_apart(self, data: bytes, channel: int) -> None:
        """Characters with XON or XOFF among them, which are never part of a command."""
        start = 0
        for index, byte in enumerate(data):
            if byte in (XON, XOFF):
                self._controller.hear(data[start:index], channel)
                self._obey(byte, channel)
                start = index + 1
        self._controller.hear(data[start:], channel)

    def _obey(self, byte: int, channel: int) -> None:
        if not self._handshake:
            return
        if byte == XOFF:
            self.transmitter.stop(channel)
            self._controller.interpreter.mind_the_line()
        else:
            self._let_go(channel)

    def _let_go(self, channel: int) -> None:
        if channel in self.transmitter.stopped_channels:
            self.transmitter.go_on(channel, self._controller.now_ns)
            self._controller.interpreter.mind_the_line()
            self._controller.interpreter.run()

    def set_handshake(self, on: bool) -> None:
        """XONOFF."""
        self._handshake = on
        if not on:
            for channel in self.transmitter.stopped_channels:
                self.transmitter.go_on(channel, self._controller.now_ns)
            self._controller.interpreter.mind_the_line()

    def carry_out(self, now_ns: int) -> None:
        """Nothing is ever due."""

    def look(self) -> None:
        """No host is ever held."""

    def blocks(self, channel: int | None) -> bool:
        """So much output waits for this connection that what makes more must wait too."""
        return self.transmitter.stopped and self.transmitter.waiting(channel) >= self._limit

    def full(self, channel: int) -> bool:
        """More input of this connection should stay on the wire."""
        return self.blocks(channel)

    def forget(self, channel: int) -> None:
        """A connection is gone: half a command of it is forgotten, and what was kept for it."""
        self._controller.forget_line(channel)
        self.transmitter.forget(channel)
        self._let_go(channel)

    def power_down(self) -> None:
        """Nothing that was kept back will be said."""
        self.transmitter.clear()

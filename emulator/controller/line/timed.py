"""The line with a speed: an input buffer that can fill, and a transmitter that takes its time.

The unit hangs on one wire.  What it sends to several connections follows one after the other, and the XOFF of one of
them stops it for all.  Its input buffer holds what has arrived and has not been carried out: commands that wait, a
command half typed, and characters that could not be looked at yet.  Characters that find it full are lost.
"""

from __future__ import annotations

import logging
from collections import deque
from typing import TYPE_CHECKING

from emulator.controller.line.direction import Direction, character_bits
from emulator.controller.line.leads import Leads
from emulator.controller.line.transmitter import TimedTransmitter
from emulator.controller.output import Output
from emulator.controller.waits import NEVER
from emulator.logs import event_line
from protocol.line import XOFF, XON

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

MAX_UNSENT_BY_HOST = 512
"""Characters of one connection that may wait to be sent to the unit before no more is read from it (ours: what a
computer's driver keeps)."""

DEAF_BEYOND = 2
"""Output buffers full of unsent characters at which the unit looks at no further character, immediate commands and
their echo included (assumed L: it has to stop somewhere)."""

_log = logging.getLogger("oem6250.line")


class TimedLine:
    """Characters take their time both ways; XON/XOFF; a finite input buffer."""

    may_block = True

    def __init__(self, controller: Controller) -> None:
        serial = controller.machine.serial
        bits = character_bits(serial.framing)
        self._controller = controller
        self._buffer = serial.buffer
        self._output_limit = serial.output_buffer
        self._host_obeys = serial.host_obeys_xoff
        self._handshake = True
        self._leads = Leads(baud=serial.baud, bits=bits)
        wire = Direction(baud=serial.baud, bits=bits)
        self._character_ns = wire.character_ns
        self.transmitter = TimedTransmitter(wire, limit=self._output_limit, on_full=self._plan_output)
        self._unread: deque[tuple[int, int]] = deque()
        self._room_ns = NEVER
        self._losing = False
        self.holds_hosts: bool = False
        """The unit has sent XOFF and not yet XON."""
        self.received: int = 0
        """Characters that have reached the unit, lost ones included."""
        self.overruns: int = 0
        """Characters that found the input buffer full."""

    @property
    def next_ns(self) -> int:
        """When something is due by itself."""
        return min(self._leads.next_ns, self._room_ns)

    @property
    def busy(self) -> bool:
        """Characters are under way in either direction."""
        return self.transmitter.sending or self._leads.next_ns != NEVER

    @property
    def sent(self) -> int:
        """Characters that have left the unit."""
        self.transmitter.run_to(self._controller.now_ns)
        return self.transmitter.sent

    @property
    def held(self) -> bool:
        """A host's XOFF holds the transmitter."""
        return self.transmitter.stopped

    @property
    def buffered(self) -> int:
        """Characters in the input buffer."""
        return self._controller.half_typed + self._controller.interpreter.waiting_characters + len(self._unread)

    def receive(self, data: bytes, channel: int, from_ns: int) -> None:
        """A connection sends characters, the first one not before a time."""
        self._leads.put(data, channel, from_ns)
        now_ns = self._controller.now_ns
        if self.next_ns <= now_ns:
            self.carry_out(now_ns)

    def began_ns(self, at_ns: int) -> int:
        """When a character began that ended at a time."""
        return at_ns - self._character_ns

    def take(self) -> list[Output]:
        """What has left the unit since last asked, character by character."""
        return self.transmitter.take(self._controller.now_ns)

    def carry_out(self, now_ns: int) -> None:
        """Take in what has arrived, and go on with what waited for the transmitter."""
        for channel, byte in self._leads.arrived(now_ns):
            if byte is None:
                self._gone(channel)
            elif self._controller.powered:
                self._arrive(byte, channel, now_ns)
        if now_ns >= self._room_ns:
            self._look_at_output()
        self.look()

    def look(self) -> None:
        """Let the hosts go on when the buffer has room again."""
        if not self.holds_hosts or not self._controller.powered:
            return
        if self._buffer.size - self.buffered >= self._buffer.xon_at_left:
            self.holds_hosts = False
            heard_ns = self._send_ahead(XON)
            if self._host_obeys:
                self._leads.go_on(heard_ns)

    def set_handshake(self, on: bool) -> None:
        """XONOFF."""
        self._handshake = on
        if not on:
            self.transmitter.go_on_for_all(self._controller.now_ns)
            self._plan_output()

    def blocks(self, channel: int | None) -> bool:
        """So much output waits that what makes more must wait too."""
        return self._unsent >= self._output_limit

    def full(self, channel: int) -> bool:
        """More of what this connection sends should stay in the host's computer."""
        return self._leads.waiting(channel) > MAX_UNSENT_BY_HOST

    def forget(self, channel: int) -> None:
        """A connection is gone; what it has sent still arrives."""
        if self._leads.leave(channel):
            self._gone(channel)

    def power_down(self) -> None:
        """The buffers lose what they hold; hosts that were held are let go when there is power again."""
        self._unread.clear()
        self.transmitter.clear()
        self._room_ns = NEVER

    def _gone(self, channel: int) -> None:
        self._controller.forget_line(channel)
        self.transmitter.go_on(channel, self._controller.now_ns)
        self._plan_output()

    # Characters that arrive.

    def _arrive(self, byte: int, channel: int, now_ns: int) -> None:
        self.received += 1
        if self._handshake and byte in (XON, XOFF):
            self._obey(byte, channel, now_ns)
        elif self.buffered >= self._buffer.size:
            self._lose(channel, now_ns)
        else:
            self._losing = False
            self._take_in(byte, channel)
            if self._handshake and not self.holds_hosts:
                self._hold_hosts_if_nearly_full()

    def _obey(self, byte: int, channel: int, now_ns: int) -> None:
        if byte == XOFF:
            self.transmitter.stop(channel, now_ns)
        else:
            self.transmitter.go_on(channel, now_ns)
        self._plan_output()

    def _lose(self, channel: int, now_ns: int) -> None:
        self.overruns += 1
        if not self._losing:
            self._losing = True
            at_s = f"{now_ns * 1e-9:.6f}"
            _log.warning(event_line("input buffer full, characters lost", at_s=at_s, channel=channel))

    def _take_in(self, byte: int, channel: int) -> None:
        if self._unread or self._deaf:
            self._unread.append((channel, byte))
            self._plan_output()
        else:
            self._controller.hear(bytes((byte,)), channel)

    def _hold_hosts_if_nearly_full(self) -> None:
        if self._buffer.size - self.buffered <= self._buffer.xoff_at_left:
            self.holds_hosts = True
            heard_ns = self._send_ahead(XOFF)
            if self._host_obeys:
                self._leads.stop(heard_ns)

    def _send_ahead(self, byte: int) -> int:
        now_ns = self._controller.now_ns
        return self.transmitter.send_ahead(now_ns, byte, heard_by_hosts=not self._host_obeys)

    # Output that has to wait.

    @property
    def _deaf(self) -> bool:
        return self._unsent >= DEAF_BEYOND * self._output_limit

    @property
    def _unsent(self) -> int:
        self.transmitter.run_to(self._controller.now_ns)
        return self.transmitter.waiting

    def _plan_output(self) -> None:
        """Look again when the transmitter has room for what waits."""
        if self._unread:
            self._room_ns = self.transmitter.room_ns(DEAF_BEYOND * self._output_limit) if self._deaf else 0
        elif self._unsent >= self._output_limit:
            self._room_ns = self.transmitter.room_ns(self._output_limit)

    def _look_at_output(self) -> None:
        self._room_ns = NEVER
        while self._unread and not self._deaf:
            channel, byte = self._unread.popleft()
            self._controller.hear(bytes((byte,)), channel)
        self._controller.interpreter.run()
        self._plan_output()

"""A connection that speaks telnet: what its options mean to us, and what becomes of its commands.

Echo: we always offer it (WILL ECHO) and suppress go-ahead, which together make a telnet client send each character as
it is typed and show only what we send. So the unit's own echo, on or off by its ECHO command, is what the person
sees, as at a serial terminal.

Commands of one byte: ARE YOU THERE is answered at once, whatever the unit does. ERASE CHARACTER is the unit's
backspace. The others, BREAK and INTERRUPT PROCESS among them, have no counterpart on the unit's line and do nothing;
motion is stopped by Ctrl-K or `!K`, which are bytes like any others.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

from emulator.logs import event_line
from emulator.ports.outlet import OUTPUT_LIMIT_BYTES
from emulator.ports.telnet import (
    ARE_YOU_THERE,
    BINARY,
    COM_PORT,
    DO,
    ECHO,
    ERASE_CHARACTER,
    IAC,
    SUPPRESS_GO_AHEAD,
    TIMING_MARK,
    WILL,
    Command,
    Decoder,
    Negotiate,
    Options,
    Subnegotiation,
    encode,
)

if TYPE_CHECKING:
    from emulator.ports.com_port import ComPort

HERE_I_AM = b"\r\n[oem6250: yes]\r\n"
BACKSPACE = b"\b"

_OURS = frozenset((BINARY, ECHO, SUPPRESS_GO_AHEAD))
_THEIRS = frozenset((BINARY, SUPPRESS_GO_AHEAD))
_log = logging.getLogger("oem6250.port")


class TelnetSession:
    """The telnet side of one connection; used by the engine thread alone, after `open`.

    `write` takes bytes for the socket and neither blocks nor raises. `strict_baud` is the unit's rate, when a client
    that set another one shall exchange nothing but garbage with it (RFC 2217 only); None understands every rate.
    """

    def __init__(self, write: Callable[[bytes], None], *, name: str, strict_baud: int | None = None) -> None:
        self._write = write
        self._name = name
        self._strict_baud = strict_baud
        self._decoder = Decoder()
        self._options = Options(ours=_OURS, theirs=_THEIRS)
        self._binary = False
        self._com_port: ComPort | None = None
        self._replies = bytearray()
        self._held = bytearray()

    def open(self) -> None:
        """Say what we would have the client do: show what we send, send each character."""
        self._replies += self._options.offer(ECHO)
        self._replies += self._options.offer(SUPPRESS_GO_AHEAD)
        self._replies += self._options.ask(SUPPRESS_GO_AHEAD)
        self._answer()

    def receive(self, data: bytes) -> bytes:
        """What of `data` is for the unit; the rest is acted on and answered, in one write."""
        text = b"".join(map(self._take, self._decoder.feed(data)))
        self._answer()
        if self._held and not self._suspended:
            held, self._held = bytes(self._held), bytearray()
            self._write(held)
        return text

    def send(self, data: bytes) -> None:
        """Output of the unit."""
        data = encode(self._through_line(data, outward=True), binary=self._binary)
        if not self._suspended:
            self._write(data)
        elif len(self._held) + len(data) <= OUTPUT_LIMIT_BYTES:
            self._held += data

    def _take(self, event: bytes | Negotiate | Subnegotiation | Command) -> bytes:
        """What an event is to the unit."""
        match event:
            case bytes():
                return self._through_line(event, outward=False)
            case Negotiate(verb, option):
                self._negotiate(verb, option)
            case Subnegotiation(data):
                if data[0] == COM_PORT:
                    self._com_port_of_client().subnegotiate(data[1:])
            case Command(code):
                return self._command(code)
        return b""

    def _command(self, code: int) -> bytes:
        if code == ARE_YOU_THERE:
            self._replies += HERE_I_AM
        return BACKSPACE if code == ERASE_CHARACTER else b""

    def _negotiate(self, verb: int, option: int) -> None:
        if option == COM_PORT:
            if self._com_port is not None or verb in (WILL, DO):
                self._com_port_of_client().negotiate(verb)
        elif option == TIMING_MARK and verb == DO:
            self._replies += bytes((IAC, WILL, TIMING_MARK))
        else:
            self._replies += self._options.answer(verb, option)
            if option == BINARY:
                self._decoder.binary = self._options.they_do(BINARY)
                self._binary = self._options.we_do(BINARY)

    def _com_port_of_client(self) -> ComPort:
        """RFC 2217 is for eight-bit data, and its clients take CR NUL for two bytes: so binary from the first moment,
        not only once it is agreed."""
        if self._com_port is None:
            from emulator.ports.baud import FACTORY_BAUD
            from emulator.ports.com_port import ComPort

            _log.info(event_line("RFC 2217 client", port=self._name))
            self._replies += self._options.offer(BINARY) + self._options.ask(BINARY)
            self._decoder.binary = self._binary = True
            baud = self._strict_baud or FACTORY_BAUD
            self._com_port = ComPort(self._replies.extend, name=self._name, baud=baud, on_purge=self._held.clear)
        return self._com_port

    @property
    def _suspended(self) -> bool:
        return self._com_port is not None and self._com_port.suspended

    def _through_line(self, data: bytes, *, outward: bool) -> bytes:
        """What arrives when the two ends of the line may differ in rate."""
        if self._strict_baud is None or self._com_port is None:
            return data
        client, unit = self._com_port.line.baudrate, self._strict_baud
        if client == unit:
            return data
        from emulator.ports.baud import garbled

        return garbled(data, sent_at=unit, read_at=client) if outward else garbled(data, sent_at=client, read_at=unit)

    def _answer(self) -> None:
        if self._replies:
            self._write(bytes(self._replies))
            self._replies.clear()

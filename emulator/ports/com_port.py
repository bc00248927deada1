"""RFC 2217: a telnet client that sets the baud rate, the frame and the lines of a serial port, as pyserial's does.

pyserial's `PortManager` reads and answers the COM-PORT-OPTION. It gets nothing else of the stream: its own reading of
telnet lets malformed input raise and keeps a subnegotiation of any length. What RFC 2217 asks for and it leaves
unanswered (signature, state of BREAK, DTR, RTS and inbound flow control, masks) is answered here.

This module is imported when the first client negotiates the option, because only then pyserial is needed.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from struct import error as StructError
from typing import Any

from serial.rfc2217 import PortManager

from emulator import __version__
from emulator.logs import event_line
from emulator.ports.baud import FACTORY_BAUD
from emulator.ports.telnet import COM_PORT, IAC, SB, SE, encode

SIGNATURE = f"oem6250 {__version__}".encode()
MAX_BAUD = 4_000_000
"""Beyond it no serial port is to be had (design choice)."""

_SIGNATURE, _SET_CONTROL, _SUSPEND, _RESUME, _LINESTATE_MASK, _MODEMSTATE_MASK = 0, 5, 8, 9, 10, 11
_SETTINGS = range(1, 5)
"""Baud rate, data size, parity, stop size: each is answered with the value in force."""
_ANSWER = 100
"""The server's codes are the client's plus this (RFC 2217 section 2)."""
_INBOUND_FLOW_CONTROL = range(13, 20)
_NO_INBOUND_FLOW_CONTROL = 14

_log = logging.getLogger("oem6250.port")


class VirtualLine:
    """What `PortManager` takes for a serial port: it remembers, and refuses what no port can do with ValueError.

    The unit's wire has three conductors (assumed, hardware notes); so the lines a host waits for are as a cable has
    them that is wired for such a unit: CTS, DSR and CD active.
    """

    cts = dsr = cd = True
    ri = False

    def __init__(self, *, baud: int = FACTORY_BAUD, on_purge: Callable[[], None]) -> None:
        self._baudrate, self._bytesize, self._parity, self._stopbits = baud, 8, "N", 1.0
        self._on_purge = on_purge
        self.xonxoff = self.rtscts = False
        self.rts = self.dtr = True
        self.break_condition = False

    @property
    def baudrate(self) -> int:
        return self._baudrate

    @baudrate.setter
    def baudrate(self, value: int) -> None:
        self._baudrate = _checked(value, range(1, MAX_BAUD + 1))

    @property
    def bytesize(self) -> int:
        return self._bytesize

    @bytesize.setter
    def bytesize(self, value: int) -> None:
        self._bytesize = _checked(value, range(5, 9))

    @property
    def parity(self) -> str:
        return self._parity

    @parity.setter
    def parity(self, value: str) -> None:
        self._parity = _checked(value, "NEOMS")

    @property
    def stopbits(self) -> float:
        return self._stopbits

    @stopbits.setter
    def stopbits(self, value: float) -> None:
        self._stopbits = _checked(value, (1, 1.5, 2))

    @property
    def settings(self) -> str:
        """`9600 8N1`."""
        return f"{self._baudrate} {self._bytesize}{self._parity}{self._stopbits:g}"

    def reset_input_buffer(self) -> None:
        """Discard what the unit has sent and the client has not fetched."""
        self._on_purge()

    def reset_output_buffer(self) -> None:
        """Nothing to do: what a client sent is on the unit's wire at once."""


def _checked(value: Any, allowed: Sequence[Any]) -> Any:
    if value not in allowed:
        raise ValueError(f"{value!r} is not possible")
    return value


class ComPort:
    """The COM-PORT-OPTION of one connection; nothing here blocks or raises.

    `send` takes bytes for the client, `on_purge` discards what the unit sent and the client has not got, `baud` is the
    rate before the client sets one.
    """

    def __init__(
        self, send: Callable[[bytes], None], *, name: str, baud: int = FACTORY_BAUD, on_purge: Callable[[], None]
    ) -> None:
        self._send = send
        self._name = name
        self.line = VirtualLine(baud=baud, on_purge=on_purge)
        self.suspended = False
        """The client asked us to hold back what the unit sends."""
        self._manager = PortManager(self.line, self)

    def write(self, data: bytes) -> None:
        """For `PortManager`: what it has to say about this option; the others are negotiated elsewhere."""
        if data[2:3] == bytes((COM_PORT,)):
            self._send(data)

    def negotiate(self, verb: int) -> None:
        """WILL, WONT, DO or DONT of this option has come."""
        self._manage((IAC, verb, COM_PORT))

    def subnegotiate(self, data: bytes) -> None:
        """A subnegotiation of this option has come; `data` is what follows the option's number."""
        code, value = data[:1], data[1:]
        before = self.line.settings
        if code == bytes((_SIGNATURE,)):
            self._sign(value)
        elif code in (bytes((_SUSPEND,)), bytes((_RESUME,))):
            self.suspended = code[0] == _SUSPEND
        elif code == bytes((_SET_CONTROL,)) and self._answer_state(value[:1]):
            return
        else:
            self._set(code, value)
        if self.line.settings != before:
            _log.info(event_line("line set by the client", port=self._name, settings=self.line.settings))

    def _sign(self, asked: bytes) -> None:
        if not asked:
            self._answer(_SIGNATURE, SIGNATURE)

    def _answer_state(self, asked: bytes) -> bool:
        """Answer the questions about lines that `PortManager` does not; False for all others."""
        line = self.line
        states = {4: 5 if line.break_condition else 6, 7: 8 if line.dtr else 9, 10: 11 if line.rts else 12}
        number = asked[0] if asked else -1
        if number in _INBOUND_FLOW_CONTROL:
            self._answer(_SET_CONTROL, bytes((_NO_INBOUND_FLOW_CONTROL,)))
        elif number in states:
            self._answer(_SET_CONTROL, bytes((states[number],)))
        else:
            return False
        return True

    def _set(self, code: bytes, value: bytes) -> None:
        understood = self._manage(_subnegotiation(code + value))
        number = code[0] if code else -1
        if not understood and number in _SETTINGS:
            self._manage(_subnegotiation(code + bytes(4)))
        if understood and number in (_LINESTATE_MASK, _MODEMSTATE_MASK):
            self._answer(number, value[:1])

    def _manage(self, data: Iterable[int]) -> bool:
        """Have `PortManager` act on it; False if it choked on what the client sent."""
        try:
            for _ in self._manager.filter(bytes(data)):
                pass
        except (ValueError, LookupError, TypeError, AttributeError, StructError) as error:
            _log.info(event_line("RFC 2217 request not understood", port=self._name, data=bytes(data), error=error))
            self._manager.suboption, self._manager.mode = None, 0
            return False
        return True

    def _answer(self, code: int, value: bytes) -> None:
        self._send(_subnegotiation(bytes((code + _ANSWER,)) + value))


def _subnegotiation(data: bytes) -> bytes:
    return bytes((IAC, SB, COM_PORT)) + encode(data, binary=True) + bytes((IAC, SE))

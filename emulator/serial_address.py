"""How a serial port is written on the command line: `DEVICE[:BAUD[:FRAMING]]`.

The separator also occurs inside device names (`/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0`) and addresses
(`rfc2217://host:4001`), so the settings are looked for from the right and only where they look like settings. A name
that exists as it stands is a device, whatever it ends in.
"""

from __future__ import annotations

import os
import re
from typing import NamedTuple

DEFAULT_BAUD = 9600
DEFAULT_FRAMING = "8N1"
"""Speed and framing of a port named without them (assumed H, the 6000 Series' factory setting)."""
BAUD_RANGE = range(110, 921_601)

_FRAMING = re.compile(r"([5-8])([NEOMS])(1\.5|1|2)", re.IGNORECASE)
_URL = re.compile(r"[a-z0-9+]+://(?:\[[^]]*\]|[^:/]*)(?::[0-9]+)?[^:]*", re.IGNORECASE)


class SerialAddress(NamedTuple):
    """A serial port and how it is set."""

    device: str
    """A device (`/dev/ttyUSB0`, `COM3`) or an address pyserial knows (`rfc2217://host:port`)."""
    baud: int = DEFAULT_BAUD
    data_bits: int = 8
    parity: str = "N"
    """N, E, O, M or S."""
    stop_bits: float = 1

    @property
    def settings(self) -> str:
        """`9600 8N1`."""
        return f"{self.baud} {self.data_bits}{self.parity}{self.stop_bits:g}"

    @property
    def is_url(self) -> bool:
        """Whether pyserial reaches it over a protocol of its own rather than through the system's driver."""
        return "://" in self.device


def parse_serial(text: str) -> SerialAddress:
    """Read `DEVICE[:BAUD[:FRAMING]]`; ValueError says in one line what is wrong."""
    device, baud, framing = _split(text)
    if not device:
        raise ValueError(f"{text!r} names no device (DEVICE[:BAUD[:FRAMING]], like /dev/ttyUSB0:9600:8N1)")
    if int(baud) not in BAUD_RANGE:
        raise ValueError(f"{text!r}: {baud} is not a baud rate from {BAUD_RANGE[0]} to {BAUD_RANGE[-1]}")
    found = _FRAMING.fullmatch(framing)
    if found is None:
        raise ValueError(f"{text!r}: {framing!r} is not a framing like 8N1, 7E1 or 8N2")
    return SerialAddress(device, int(baud), int(found[1]), found[2].upper(), float(found[3]))


def _split(text: str) -> tuple[str, str, str]:
    """Device, baud and framing as written, the latter two with their defaults."""
    if os.path.exists(text):
        return text, str(DEFAULT_BAUD), DEFAULT_FRAMING
    url = _URL.match(text)
    head, rest = (url[0], text[url.end() :]) if url else ("", text)
    device, baud, framing = _settings(rest)
    return head + device, baud, framing


def _settings(text: str) -> tuple[str, str, str]:
    device, colon, last = text.rpartition(":")
    if not colon:
        return text, str(DEFAULT_BAUD), DEFAULT_FRAMING
    if _is_number(last):
        return device, last, DEFAULT_FRAMING
    shorter, colon, baud = device.rpartition(":")
    if colon and _is_number(baud) and int(baud) in BAUD_RANGE:
        return shorter, baud, last
    if _FRAMING.fullmatch(last):
        raise ValueError(f"{text!r}: a framing comes after a baud rate (DEVICE:BAUD:FRAMING)")
    return text, str(DEFAULT_BAUD), DEFAULT_FRAMING


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdigit()

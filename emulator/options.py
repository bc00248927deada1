"""What `oem6250 serve` was asked to do, as plain values."""

from __future__ import annotations

from dataclasses import dataclass

from emulator.serial_address import SerialAddress


@dataclass(frozen=True, kw_only=True)
class ServeOptions:
    """The options of one server; the defaults are those of the command line."""

    device: str = "oem6250"
    """`oem6250` or `rmc151`."""
    modbus: tuple[str, int] | None = None
    """Where an RMC listens; None is the port of the machine file on this machine."""
    machine: str | None = None
    """Path of the machine file; None is the default machine."""
    tcp: tuple[tuple[str, int], ...] = (("127.0.0.1", 6250),)
    telnet: tuple[tuple[str, int], ...] = ()
    """Where to listen and speak telnet first."""
    allow_remote: bool = False
    """Listening on addresses that other machines reach is allowed."""
    pty: str | None = "auto"
    """Where the link goes, `auto`, or None."""
    speed: float | None = 1.0
    """Virtual over wall time; None runs as fast as possible while anything is under way."""
    line_baud: int | None = None
    """Speed of the line, 0 for instant; None leaves it to the machine file."""
    state: str | None = None
    """File of the non-volatile memory."""
    announce: str | None = None
    """`-` or a file for the line of JSON."""
    verbosity: int = 0
    serial: tuple[SerialAddress, ...] = ()
    """Real serial ports with hosts on the other ends of their cables."""
    shared_line: bool = False
    """Every connection hears everything the unit sends."""
    record: str | None = None
    """File for a recording of the session."""
    units: int = 1
    """Units in the daisy chain on the one line; 1 is a unit by itself."""

"""What `oem6250 serve` was asked to do, as plain values."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ServeOptions:
    """The options of one server; the defaults are those of the command line."""

    machine: str | None = None
    """Path of the machine file; None is the default machine."""
    tcp: tuple[tuple[str, int], ...] = (("127.0.0.1", 6250),)
    pty: str | None = "auto"
    """Where the link goes, `auto`, or None."""
    speed: float | None = 1.0
    """Virtual over wall time; None runs as fast as possible while anything is under way."""
    line_baud: int | None = None
    """None answers at once."""
    state: str | None = None
    """File of the non-volatile memory."""
    announce: str | None = None
    """`-` or a file for the line of JSON."""
    verbosity: int = 0
    units: int = 1
    """Units in the daisy chain on the one line; 1 is a unit by itself."""

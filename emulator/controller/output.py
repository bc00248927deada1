"""What leaves the unit: bytes, the virtual time they leave at, and which connection they are for."""

from __future__ import annotations

from typing import NamedTuple


class Output(NamedTuple):
    """Bytes leaving the unit at ``at_ns`` for one channel; None means every connection of the unit."""

    at_ns: int
    data: bytes
    channel: int | None


class Transmitter:
    """Collects output until it is taken; neighbours for the same channel at the same time become one."""

    def __init__(self) -> None:
        self._finished: list[Output] = []
        self._at_ns = 0
        self._channel: int | None = None
        self._pieces: list[bytes] = []

    def send(self, at_ns: int, data: bytes, channel: int | None) -> None:
        """Add output; empty data (a prompt that ERRLVL suppresses) adds nothing."""
        if not data:
            return
        if channel != self._channel or at_ns != self._at_ns:
            self._finish()
            self._at_ns, self._channel = at_ns, channel
        self._pieces.append(data)

    def _finish(self) -> None:
        if self._pieces:
            self._finished.append(Output(self._at_ns, b"".join(self._pieces), self._channel))
            self._pieces.clear()

    def take(self) -> list[Output]:
        """Everything sent since last asked, in order."""
        self._finish()
        taken, self._finished = self._finished, []
        return taken

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
        self._waiting: list[Output] = []

    def send(self, at_ns: int, data: bytes, channel: int | None) -> None:
        """Add output; empty data (a prompt that ERRLVL suppresses) adds nothing."""
        if not data:
            return
        waiting = self._waiting
        if waiting:
            last = waiting[-1]
            if last.channel == channel and last.at_ns == at_ns:
                waiting[-1] = Output(at_ns, last.data + data, channel)
                return
        waiting.append(Output(at_ns, data, channel))

    def take(self) -> list[Output]:
        """Everything sent since last asked, in order."""
        taken, self._waiting = self._waiting, []
        return taken

"""What leaves the unit: bytes, the virtual time they leave at, and which connection they are for."""

from __future__ import annotations

from typing import NamedTuple


class Output(NamedTuple):
    """Bytes leaving the unit at ``at_ns`` for one channel; None means every connection of the unit."""

    at_ns: int
    data: bytes
    channel: int | None


class Transmitter:
    """Collects output until it is taken; neighbours for the same channel at the same time become one.

    Output for a channel that has stopped it (XOFF) is kept; output for everyone is, while any has.
    """

    def __init__(self) -> None:
        self._finished: list[Output] = []
        self._at_ns = 0
        self._channel: int | None = None
        self._pieces: list[bytes] = []
        self._stopped: dict[int, None] = {}
        self._kept: list[tuple[bytes, int | None]] = []
        self._sent = 0

    def send(self, at_ns: int, data: bytes, channel: int | None) -> None:
        """Add output; empty data (a prompt that ERRLVL suppresses) adds nothing."""
        if not data:
            return
        if self._stopped and (channel is None or channel in self._stopped):
            self._kept.append((data, channel))
            return
        if channel != self._channel or at_ns != self._at_ns:
            self._finish()
            self._at_ns, self._channel = at_ns, channel
        self._pieces.append(data)

    def _finish(self) -> None:
        if self._pieces:
            data = b"".join(self._pieces)
            self._sent += len(data)
            self._finished.append(Output(self._at_ns, data, self._channel))
            self._pieces.clear()

    @property
    def sent(self) -> int:
        """Characters that have left the unit."""
        return self._sent + sum(map(len, self._pieces))

    def take(self) -> list[Output]:
        """Everything sent since last asked, in order."""
        self._finish()
        taken, self._finished = self._finished, []
        return taken

    # XOFF and XON.

    @property
    def stopped(self) -> bool:
        """Some channel has stopped its output."""
        return bool(self._stopped)

    @property
    def stopped_channels(self) -> tuple[int, ...]:
        """The channels that have stopped their output."""
        return tuple(self._stopped)

    def waiting(self, channel: int | None) -> int:
        """Characters kept for a channel (None: for everyone)."""
        return sum(len(data) for data, number in self._kept if number == channel)

    def stop(self, channel: int) -> None:
        """Keep what is for this channel from now on."""
        self._stopped[channel] = None

    def go_on(self, channel: int, at_ns: int) -> None:
        """Send what was kept for this channel, and for everyone if it was the last that had stopped it."""
        self._stopped.pop(channel, None)
        kept, self._kept = self._kept, []
        for data, number in kept:
            self.send(at_ns, data, number)

    def forget(self, channel: int) -> None:
        """Drop what was kept for a channel."""
        self._kept = [(data, number) for data, number in self._kept if number != channel]

    def clear(self) -> None:
        """Drop all that was kept; no channel is stopped."""
        self._stopped.clear()
        self._kept.clear()

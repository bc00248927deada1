"""One direction of a wire: characters follow one another, each as long as its bits.

The arithmetic is exact.  Within a stretch without pause the n-th character ends n times its bits over the baud rate
after the start, whatever that is in nanoseconds; only the stamp is rounded, up, to a whole one.
"""

from __future__ import annotations

NS_PER_S = 1_000_000_000


def character_bits(framing: str) -> int:
    """Bits on the wire for one character of a framing like ``8N1``: start, data, parity, stop."""
    return 1 + int(framing[0]) + (framing[1] != "N") + int(framing[2])


class Direction:
    """When characters end that are sent one after the other in one direction."""

    def __init__(self, *, baud: int, bits: int) -> None:
        self._baud = baud
        self._ticks_per_character = bits * NS_PER_S
        self._free_ticks = 0
        """When the wire falls silent, in ns / baud."""

    @property
    def free_ns(self) -> int:
        """When the last stop bit ends."""
        return self._in_ns(self._free_ticks)

    @property
    def character_ns(self) -> int:
        """How long a character takes, rounded up."""
        return self._in_ns(self._ticks_per_character)

    def send(self, from_ns: int) -> int:
        """Put a character on the wire, not before a time; when its stop bit ends."""
        self._free_ticks = max(self._free_ticks, from_ns * self._baud) + self._ticks_per_character
        return self._in_ns(self._free_ticks)

    def after(self, characters: int) -> int:
        """When the wire will have carried that many more characters, if they follow without pause."""
        return self._in_ns(self._free_ticks + characters * self._ticks_per_character)

    def _in_ns(self, ticks: int) -> int:
        return -(-ticks // self._baud)

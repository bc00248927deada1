"""What a receiver makes of characters that were sent at another baud rate.

A port that knows both rates (RFC 2217, a real serial port) can show a host at the wrong rate what it would see on a
real line.  The line is drawn as a waveform, idle high, start bit low, eight data bits lowest first, stop bit high, one
character straight after the other; the receiver waits for a falling edge and looks at the middle of each of its bits.

Times are whole ticks of 1 / (2 * sent_at * read_at) seconds, in which half a bit of either side is a whole number: no
rounding, the same bytes on every machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from emulator.machine import Machine

FACTORY_BAUD = 9600
"""The rate of a unit whose line is not timed (hardware notes: 9600 8N1, assumed H)."""

CHARACTER_BITS = 10
DATA_BITS = 8


def unit_baud(machine: Machine) -> int:
    """The rate the unit's own serial port is set to, baud."""
    return machine.serial.baud or FACTORY_BAUD


def garbled(data: bytes, *, sent_at: int, read_at: int) -> bytes:
    """What a UART at ``read_at`` baud reads of ``data`` sent without pause at ``sent_at`` baud, both 8N1.

    A start bit that is high again at its middle is taken for noise.  A character whose stop bit is low (a framing
    error) is delivered as sampled, as a UART does; then the line must go high before the next start bit counts.  Rates
    within about 4 % of each other leave the data as it is.

    Raises:
        ValueError: a rate that is not positive.
    """
    if sent_at <= 0 or read_at <= 0:
        raise ValueError(f"baud rates must be positive, not {sent_at} and {read_at}")
    if sent_at == read_at or not data:
        return data
    return bytes(_Receiver(_waveform(data), sent_bit=2 * read_at, half_bit=sent_at).characters())


def _waveform(data: bytes) -> bytearray:
    """The level of the line in each bit of the sender; after the last one it idles."""
    levels = bytearray()
    for byte in data:
        levels.append(0)
        levels.extend((byte >> bit) & 1 for bit in range(DATA_BITS))
        levels.append(1)
    return levels


class _Receiver:
    """Samples a waveform; times in ticks, ``sent_bit`` long for the sender's bit, ``half_bit`` for half of ours."""

    def __init__(self, levels: bytearray, *, sent_bit: int, half_bit: int) -> None:
        self._levels = levels
        self._sent_bit = sent_bit
        self._half_bit = half_bit

    def characters(self) -> bytearray:
        read = bytearray()
        edge = self._falling_edge(0)
        while edge is not None:
            looked_until = edge + self._half_bit
            if not self._level(looked_until):
                read.append(self._sample(edge))
                looked_until = edge + (2 * CHARACTER_BITS - 1) * self._half_bit
            edge = self._falling_edge(looked_until)
        return read

    def _level(self, at: int) -> int:
        index = at // self._sent_bit
        return self._levels[index] if index < len(self._levels) else 1

    def _sample(self, edge: int) -> int:
        middles = (edge + (2 * bit + 3) * self._half_bit for bit in range(DATA_BITS))
        return sum(self._level(middle) << bit for bit, middle in enumerate(middles))

    def _falling_edge(self, after: int) -> int | None:
        """When the line next goes low after having been high; None if it never does."""
        index = after // self._sent_bit
        if index == 0 and after == 0:
            return 0
        high = self._levels.find(1, index)
        low = self._levels.find(0, high) if high >= 0 else -1
        return low * self._sent_bit if low >= 0 else None

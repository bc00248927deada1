"""A 32-bit RMC register as two 16-bit Modbus registers.

Every RMC register is 32 bits wide (M1041). Which half comes first is not stated for Modbus: the least significant one
first is inferred from the manual's FINS example (M453) and from Modicon's own convention.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Sequence
from typing import Literal

WordOrder = Literal["low_first", "high_first"]
RegisterType = Literal["REAL", "DINT", "DWORD"]
Number = int | float

LARGEST_REAL = 3.4028234663852886e38
_WORD = 0xFFFF


def bits_of(value: Number, kind: RegisterType = "REAL") -> int:
    """The 32 bits of a value; a REAL beyond single precision becomes the largest, a DINT is held to 32 bits."""
    if kind != "REAL":
        return int(value) & 0xFFFF_FFFF
    if math.isfinite(value):
        value = max(-LARGEST_REAL, min(LARGEST_REAL, value))
    bits: int = struct.unpack("<I", struct.pack("<f", value))[0]
    return bits


def value_of(bits: int, kind: RegisterType = "REAL") -> Number:
    """The value of 32 bits."""
    if kind == "REAL":
        real: float = struct.unpack("<f", struct.pack("<I", bits))[0]
        return real
    if kind == "DINT" and bits >= 1 << 31:
        return bits - (1 << 32)
    return bits


def halves(bits: int, order: WordOrder = "low_first") -> tuple[int, int]:
    """The two Modbus registers of 32 bits, in the order they have on the wire."""
    low, high = bits & _WORD, bits >> 16
    return (low, high) if order == "low_first" else (high, low)


def joined(first: int, second: int, order: WordOrder = "low_first") -> int:
    """32 bits from two Modbus registers in wire order."""
    return first | second << 16 if order == "low_first" else first << 16 | second


def to_words(values: Iterable[int], order: WordOrder = "low_first") -> list[int]:
    """Modbus registers of several 32-bit patterns."""
    return [word for bits in values for word in halves(bits, order)]


def from_words(words: Sequence[int], order: WordOrder = "low_first") -> list[int]:
    """32-bit patterns of an even number of Modbus registers; ValueError for an odd one."""
    if len(words) % 2:
        raise ValueError(f"{len(words)} Modbus registers are no whole number of 32-bit registers")
    return [joined(words[place], words[place + 1], order) for place in range(0, len(words), 2)]


def reals(*values: float) -> list[int]:
    """The 32-bit patterns of REALs."""
    return [bits_of(value) for value in values]

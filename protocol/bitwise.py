"""Bit patterns: texts of 0, 1 and X (not set, or don't care), bit 1 first.

A binary variable has 32 of them.  Operators know the third value: a bit that both possible values of X would give is
certain, every other is X again (table of Parker's knowledge base, VARB page).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal

from protocol.errors import INVALID_DATA, CommandError

WORD = 32

_AND = {"00": "0", "01": "0", "0X": "0", "10": "0", "11": "1", "1X": "X", "X0": "X", "X1": "X", "XX": "X"}
"""The table prints X & 0 as X although 0 & X is 0; it is kept as printed."""

_OR = {"00": "0", "01": "1", "0X": "X", "10": "1", "11": "1", "1X": "1", "X0": "X", "X1": "1", "XX": "X"}
_XOR = {"00": "0", "01": "1", "0X": "X", "10": "1", "11": "0", "1X": "X", "X0": "X", "X1": "X", "XX": "X"}
_NOT = str.maketrans("01", "10")


def padded(bits: str) -> str:
    """A pattern of a variable's length: bits nobody gave are X (Gem6K PG p.32)."""
    return bits.ljust(WORD, "X")


def _worked(table: Mapping[str, str], left: str, right: str) -> str:
    pairs = zip(padded(left), padded(right), strict=True)
    return "".join([table[a + b] for a, b in pairs])


def both(left: str, right: str) -> str:
    """``&``."""
    return _worked(_AND, left, right)


def either(left: str, right: str) -> str:
    """``|``."""
    return _worked(_OR, left, right)


def one_of(left: str, right: str) -> str:
    """``^``."""
    return _worked(_XOR, left, right)


OPERATORS: Mapping[str, Callable[[str, str], str]] = {"&": both, "|": either, "^": one_of}
"""What each sign does to two patterns."""


def complement(bits: str) -> str:
    """``~``: X stays X."""
    return padded(bits).translate(_NOT)


def shifted_left(bits: str, places: Decimal) -> str:
    """``<<``: towards bit 1, zeros come in at bit 32 (direction and filling assumed M).

    Raises:
        CommandError: INVALID DATA for a negative count.
    """
    count = _places(places)
    return padded(bits)[count:].ljust(WORD, "0")


def shifted_right(bits: str, places: Decimal) -> str:
    """``>>``: towards bit 32, zeros come in at bit 1.

    Raises:
        CommandError: INVALID DATA for a negative count.
    """
    count = _places(places)
    return padded(bits)[: WORD - count].rjust(WORD, "0")


SHIFTS: Mapping[str, Callable[[str, Decimal], str]] = {"<<": shifted_left, ">>": shifted_right}


def _places(places: Decimal) -> int:
    if places < 0:
        raise CommandError(INVALID_DATA)
    return min(int(places), WORD)


def hex_bits(digits: str) -> str:
    """``7FAD`` as bits, bit 1 first: each digit has its own four bits reversed (Gem6K PG p.32)."""
    return "".join(format(int(digit, 16), "04b")[::-1] for digit in digits).ljust(WORD, "0")


def number_of(bits: str) -> Decimal:
    """VCVT of a pattern: two's complement, bit 1 least significant, X counted as 0 (6250 UG p.74, GemCR p.334)."""
    word = int(bits.replace("X", "0")[::-1], 2)
    sign = 1 << (WORD - 1)
    return Decimal((word ^ sign) - sign)


def bits_of(number: Decimal) -> str:
    """VCVT of a number: its whole part as two's complement (cutting the fraction off is assumed M)."""
    return format(int(number) & ((1 << WORD) - 1), f"0{WORD}b")[::-1]


def matches(bits: str, pattern: str) -> bool:
    """Whether bits agree with a pattern; X in the pattern agrees with anything, and so does what it does not reach."""
    return all(wanted in ("X", bit) for wanted, bit in zip(pattern, bits, strict=False))

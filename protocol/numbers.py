"""Numbers as the unit reads and prints them: exact decimals, truncated, never rounded.

Values arrive as C ``%f`` text, are truncated to the resolution in force and multiplied by the scale factor; reports
divide by the factor again.  Binary floating point would lose the last digit on the way, so everything here is
``Decimal``.
"""

from __future__ import annotations

import re
from decimal import MAX_EMAX, MAX_PREC, MIN_EMIN, ROUND_DOWN, Context, Decimal
from functools import cache

from protocol.errors import ReplyError

_DIVISION = Context(prec=40, rounding=ROUND_DOWN)
_TRUNCATION = Context(prec=MAX_PREC, Emax=MAX_EMAX, Emin=MIN_EMIN, rounding=ROUND_DOWN)
"""Truncation is exact whatever the host types: a field may have as many digits as a command has characters."""

_NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?", re.ASCII)

GAIN_PLACES = 8
RATIO_PLACES = 5


@cache
def _quantum(places: int) -> Decimal:
    return Decimal(1).scaleb(-places)


def truncate(value: Decimal, places: int) -> Decimal:
    """Cut off everything beyond ``places`` decimals (6250 UG p.47: excess digits are truncated)."""
    return value.quantize(_quantum(places), context=_TRUNCATION)


def decimals_of_factor(factor: int) -> int:
    """Decimals usable with a scale factor: 0 for 1-9, 1 for 10-99 ... 5 for 100000-999999 (6250 UG p.47)."""
    return min(len(str(factor)) - 1, 5)


def divide(value: Decimal, factor: int) -> Decimal:
    """``value / factor`` with more digits than any report shows."""
    return _DIVISION.divide(value, Decimal(factor))


def format_fixed(value: Decimal, places: int) -> str:
    """``places`` decimals, a sign only when negative: ``1.0000``, ``-0.500``; minus zero prints as zero."""
    cut = truncate(value, places)
    return f"{abs(cut) if cut == 0 else cut:f}"


def format_signed(value: Decimal, places: int) -> str:
    """``places`` decimals, sign always: ``+0``, ``-12``, ``+1.2500``."""
    text = format_fixed(value, places)
    return text if text.startswith("-") else f"+{text}"


def format_shortest(value: Decimal, places: int) -> str:
    """Up to ``places`` decimals without trailing zeros, leading zero kept: ``0.1``, ``200``."""
    text = format_fixed(value, places)
    return text.rstrip("0").rstrip(".") if "." in text else text


def format_variable(value: Decimal, places: int = 8) -> str:
    """A VAR report: sign always, at least one decimal, trailing zeros trimmed (assumed M): ``+35.0``."""
    text = format_signed(value, places).rstrip("0")
    return f"{text}0" if text.endswith(".") else text


def parse_number(text: str) -> Decimal:
    """The number in a reply, whatever its decimals.

    Raises:
        ReplyError: the text is not a number.
    """
    if _NUMBER.fullmatch(text) is None:
        raise ReplyError(f"not a number: {text!r}")
    return Decimal(text)


def format_columns(value: Decimal, *, whole_digits: int, decimals: int, signed: bool) -> str:
    """WRVAR and DVAR: exactly so many digits before and after the point, ``+012.50`` (leading zeros, and digits that
    do not fit cut off at the left: assumed L)."""
    whole, _, fraction = format_fixed(abs(value), decimals).partition(".")
    digits = whole.rjust(whole_digits, "0")[-whole_digits:] if whole_digits else ""
    sign = ("-" if value < 0 else "+") if signed else ""
    return f"{sign}{digits}{'.' if decimals else ''}{fraction}"

"""The arithmetic of numeric variables: exact decimals, each result rounded to five places.

A VAR keeps eight decimals of what is entered, but what an operator or a function yields is rounded to five; so
10 / 15.5 is 0.64516, and 75 divided by that is 116.25023.  Binary floating point enters only in the trigonometric
functions, whose results are rounded to the same five places.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from decimal import ROUND_HALF_UP, Context, Decimal

from protocol.errors import INVALID_DATA, CommandError

LARGEST = Decimal("999999999.99999999")
"""Range of a VAR either side of zero (6250 UG p.74)."""

ENTERED_PLACES = 8
RESULT_PLACES = 5
"""Decimals kept of what is typed, and of what is computed (assumed M, from the guide's worked division)."""

PI = Decimal("3.14159265")
"""PI as the unit knows it (assumed M)."""

_QUANTUM = Decimal(1).scaleb(-RESULT_PLACES)
_CONTEXT = Context(prec=60, rounding=ROUND_HALF_UP)
"""Enough digits for the exact product of any two variables; a tie is rounded away from zero (assumed L)."""

_FULL_TURN = Decimal(360)
_HALF_TURN = Decimal(180)
_QUARTER_TURN = Decimal(90)
_TRUE = Decimal(1)
_FALSE = Decimal(0)


def rounded(value: Decimal) -> Decimal:
    """A result as a variable keeps it.

    Raises:
        CommandError: INVALID DATA, it does not fit into a variable.
    """
    result = value.quantize(_QUANTUM, context=_CONTEXT)
    if -LARGEST <= result <= LARGEST:
        return result
    raise CommandError(INVALID_DATA)


def add(left: Decimal, right: Decimal) -> Decimal:
    """``+``."""
    return rounded(_CONTEXT.add(left, right))


def subtract(left: Decimal, right: Decimal) -> Decimal:
    """``-``."""
    return rounded(_CONTEXT.subtract(left, right))


def multiply(left: Decimal, right: Decimal) -> Decimal:
    """``*``."""
    return rounded(_CONTEXT.multiply(left, right))


def divide(left: Decimal, right: Decimal) -> Decimal:
    """``/``; by zero it is INVALID DATA."""
    if right == 0:
        raise CommandError(INVALID_DATA)
    return rounded(_CONTEXT.divide(left, right))


def both(left: Decimal, right: Decimal) -> Decimal:
    """``&`` of numbers: what is above zero counts as true, the result is 1 or 0."""
    return _truth(left > 0 and right > 0)


def either(left: Decimal, right: Decimal) -> Decimal:
    """``|`` of numbers."""
    return _truth(left > 0 or right > 0)


def one_of(left: Decimal, right: Decimal) -> Decimal:
    """``^`` of numbers."""
    return _truth((left > 0) != (right > 0))


def complement(value: Decimal) -> Decimal:
    """``~`` of a number."""
    return _truth(value <= 0)


def _truth(holds: bool) -> Decimal:
    return _TRUE if holds else _FALSE


OPERATORS: Mapping[str, Callable[[Decimal, Decimal], Decimal]] = {
    "+": add,
    "-": subtract,
    "*": multiply,
    "/": divide,
    "&": both,
    "|": either,
    "^": one_of,
}
"""What each sign does to two numbers."""


def square_root(value: Decimal) -> Decimal:
    """``SQRT``; of a negative number it is INVALID DATA."""
    if value < 0:
        raise CommandError(INVALID_DATA)
    return rounded(_CONTEXT.sqrt(value))


def sine(angle: Decimal, *, radians: bool) -> Decimal:
    """``SIN``, in degrees or radians."""
    return _from_float(math.sin(_radians(angle, radians)))


def cosine(angle: Decimal, *, radians: bool) -> Decimal:
    """``COS``, in degrees or radians."""
    return _from_float(math.cos(_radians(angle, radians)))


def tangent(angle: Decimal, *, radians: bool) -> Decimal:
    """``TAN``, in degrees or radians; where it is undefined it is INVALID DATA."""
    if not radians and abs(_CONTEXT.remainder(angle, _HALF_TURN)) == _QUARTER_TURN:
        raise CommandError(INVALID_DATA)
    return _from_float(math.tan(_radians(angle, radians)))


def arc_tangent(value: Decimal, *, radians: bool) -> Decimal:
    """``ATAN``, the angle in degrees or radians."""
    angle = math.atan(float(value))
    return _from_float(angle if radians else math.degrees(angle))


def _radians(angle: Decimal, already: bool) -> float:
    """Whole turns are taken off degrees exactly, so a large angle loses no digit."""
    return float(angle) if already else math.radians(float(_CONTEXT.remainder(angle, _FULL_TURN)))


def _from_float(value: float) -> Decimal:
    if abs(value) > LARGEST:
        raise CommandError(INVALID_DATA)
    return rounded(Decimal(value))


TRIGONOMETRY: Mapping[str, Callable[..., Decimal]] = {
    "SIN": sine,
    "COS": cosine,
    "TAN": tangent,
    "ATAN": arc_tangent,
}
"""The functions that look at RADIAN."""

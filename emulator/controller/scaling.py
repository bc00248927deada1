"""User units and counts.

With SCALE0 accelerations and velocities are in encoder revolutions (ERES counts), distances in counts; with SCALE1
each kind has its scale factor (SCLA, SCLV, SCLD ...).  A value keeps the factor it was entered with, so changing
SCALE or a factor later neither moves a stored target nor costs a digit: counts = value x factor, exactly (6000 PG
p.197: values are scaled when they are entered)."""

from __future__ import annotations

from decimal import Decimal
from typing import NamedTuple

from protocol.catalogue import Scale
from protocol.fields import Range
from protocol.numbers import decimals_of_factor, divide

ENCODER_REVOLUTIONS = 0
"""Factor of a value entered in revolutions: ERES as it is when the value is used."""

MAX_REVOLUTIONS_PER_SECOND = 200
"""Top speed in encoder revolutions per second (6250 UG p.47)."""

LARGEST_DISTANCE = 999_999_999
"""Unscaled distance limit; with SCALE1 divided by ten for each decimal of the factor (6250 UG p.47)."""

FACTOR_COMMANDS: dict[Scale, str] = {
    "acceleration": "SCLA",
    "velocity": "SCLV",
    "distance": "SCLD",
    "master": "SCLMAS",
    "path_acceleration": "PSCLA",
    "path_velocity": "PSCLV",
    "path_distance": "PSCLD",
}

RATE_SCALES = frozenset({"acceleration", "velocity", "path_acceleration", "path_velocity"})
VELOCITY_SCALES = frozenset({"velocity", "path_velocity"})
DISTANCE_SCALES = frozenset({"distance", "master", "path_distance"})


class Quantity(NamedTuple):
    """A value in the user units it was entered in and the counts per unit then in force."""

    value: Decimal
    factor: int

    def counts(self, encoder_resolution: int) -> Decimal:
        """The value in counts, counts/s or counts/s2."""
        return self.value * (self.factor or encoder_resolution)


def in_user_units(quantity: Quantity, factor: int, encoder_resolution: int) -> Decimal:
    """A stored value in the units of the factor now in force."""
    if quantity.factor == factor:
        return quantity.value
    return divide(quantity.counts(encoder_resolution), factor or encoder_resolution)


def places_in_force(scale: Scale, factor: int, *, scaled: bool, unscaled_places: int) -> int:
    """Decimals typed and printed: those of the factor's decade with SCALE1, else the command's own."""
    if scaled:
        return decimals_of_factor(factor)
    return 0 if scale in DISTANCE_SCALES else unscaled_places


def largest_distance(places: int) -> Decimal:
    """The distance range at ``places`` decimals: nine digits in all."""
    return Decimal(LARGEST_DISTANCE).scaleb(-places)


def distance_range(allowed: Range, factor: int, places: int) -> Range:
    """What a distance may be in user units: nine digits either way, and at least as many counts as its row asks for."""
    largest = largest_distance(places)
    low = Decimal(0)
    if allowed.minimum is not None and allowed.minimum != 0:
        low = -largest if allowed.minimum < 0 else divide(allowed.minimum, factor)
    return Range(low, min(largest, allowed.maximum or largest), places)


def largest_velocity(factor: int, encoder_resolution: int) -> Decimal:
    """The velocity cap in user units (6250 UG p.47)."""
    if factor == ENCODER_REVOLUTIONS:
        return Decimal(MAX_REVOLUTIONS_PER_SECOND)
    return divide(Decimal(MAX_REVOLUTIONS_PER_SECOND * encoder_resolution), factor)

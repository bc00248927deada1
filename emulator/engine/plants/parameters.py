"""What a plant's parameters may be: refused by name, with what was found and what is allowed.

A plant with impossible parameters would not fail at once but fill the servo with infinities some samples later, so
each is checked when the plant is made. The bounds on size are design choices, far beyond any machine, that keep every
product of two parameters and a clamped output finite.
"""

from __future__ import annotations

import math

SMALLEST = 1e-12
LARGEST = 1e12
"""Smallest and largest magnitude of any plant parameter that is not 0 or infinite (design choice)."""


class PlantError(ValueError):
    """A plant that cannot exist: `parameter` was `found`, `allowed` says what it may be."""

    def __init__(self, parameter: str, found: float | str, allowed: str) -> None:
        self.parameter, self.allowed = parameter, allowed
        self.found = found if isinstance(found, str) else f"{found:g}"
        super().__init__(f"{parameter} must be {allowed}, not {self.found}")


def require_positive(**values: float) -> None:
    """PlantError for a value that is not above 0 and finite."""
    for name, value in values.items():
        if not SMALLEST <= value <= LARGEST:
            raise PlantError(name, value, f"above 0, from {SMALLEST:g} to {LARGEST:g}")


def require_positive_or_infinite(**values: float) -> None:
    """PlantError for a value that is not above 0."""
    for name, value in values.items():
        if not (SMALLEST <= value <= LARGEST or value == math.inf):
            raise PlantError(name, value, f"above 0, from {SMALLEST:g} to {LARGEST:g}, or inf")


def require_not_negative(**values: float) -> None:
    """PlantError for a value that is below 0 or not finite; values too small to matter are allowed as 0 is."""
    for name, value in values.items():
        if not 0.0 <= value <= LARGEST:
            raise PlantError(name, value, f"0 or above, up to {LARGEST:g}")


def require_finite(**values: float) -> None:
    """PlantError for a value that is not a finite number of sensible size."""
    for name, value in values.items():
        if not -LARGEST <= value <= LARGEST:
            raise PlantError(name, value, f"from {-LARGEST:g} to {LARGEST:g}")

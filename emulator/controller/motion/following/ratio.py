"""The ratio of a slave to its master and the master distances, exactly: FOLRN, FOLRD and FOLMD in counts.

Scale factors turn what was entered into whole counts, the rest cut off (6000 PG p.197); what was entered unscaled is
counts already, and a ratio of 2.5 to 1 stays that.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from protocol.errors import INVALID_RATIO, CommandError

if TYPE_CHECKING:
    from emulator.controller.scaling import Quantity
    from emulator.controller.settings import Settings

LARGEST_RATIO = 127
"""Most slave counts per master count, after scaling (6000 PG p.198)."""


def whole_counts(quantity: Quantity) -> int:
    """A distance in whole counts."""
    return int(quantity.value * quantity.factor)


def ratio_counts(quantity: Quantity) -> Fraction:
    """One side of a ratio in counts: whole ones if it was scaled."""
    return Fraction(quantity.value) if quantity.factor == 1 else Fraction(whole_counts(quantity))


def ratio_in_force(settings: Settings, axis_index: int) -> Fraction:
    """FOLRN/FOLRD of an axis, slave counts per master count.

    Raises:
        CommandError: INVALID RATIO above 127.
    """
    numerator = ratio_counts(settings.setting("FOLRN", axis_index))
    ratio = numerator / ratio_counts(settings.setting("FOLRD", axis_index))
    if ratio > LARGEST_RATIO:
        raise CommandError(INVALID_RATIO)
    return ratio


def master_counts(settings: Settings, name: str, axis_index: int) -> int:
    """FOLMD, FMCLEN or FMCP of an axis in whole master counts."""
    return whole_counts(settings.setting(name, axis_index))

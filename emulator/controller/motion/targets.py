"""Where a preset move is to end."""

from __future__ import annotations

from decimal import ROUND_DOWN
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def preset_target(controller: Controller, axis_index: int) -> int:
    """Where a preset move ends, whole counts: D x SCLD truncated; relative to the commanded position with MA0.

    A move that pre-empts another counts from where the axis is commanded to be at that moment (assumed).
    """
    counts = int(controller.settings.counts("D", axis_index).to_integral_value(ROUND_DOWN))
    if controller.settings.flag("MA", axis_index):
        return counts
    return controller.engine.commanded_position(axis_index) + counts

"""How a master is sampled: FFILT smooths its position, FPPEN tells where it will be (6000 PG p.214, p.215)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from protocol.command import Command

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

FILTER_CORNER_HZ = {0: None, 1: 120.0, 2: 80.0, 3: 50.0, 4: 20.0}
"""Bandwidth of the low-pass filter by FFILT; None for no filter (6000 PG p.215)."""


@applies("FFILT")
def apply_filter(controller: Controller, command: Command, changed: list[int]) -> None:
    """The filter on the master position of a slave."""
    for axis_index in changed:
        controller.engine.set_master_filter(
            axis_index, FILTER_CORNER_HZ[controller.settings.integer("FFILT", axis_index)]
        )


@applies("FPPEN")
def apply_prediction(controller: Controller, command: Command, changed: list[int]) -> None:
    """Prediction of the master position of a slave."""
    for axis_index in changed:
        controller.engine.set_prediction(axis_index, controller.settings.flag("FPPEN", axis_index))

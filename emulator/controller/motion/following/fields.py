"""The fields of the Following actions, which are no settings: FSHFC, FSHFD, FGADV."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.motion.following.ratio import whole_counts
from emulator.controller.scaling import Quantity
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, CommandError
from protocol.fields import checked_number, place_values

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def given_numbers(controller: Controller, command: Command) -> dict[int, Decimal]:
    """The numbers given, by axis index, in user units.

    Raises:
        CommandError: INCORRECT DATA where none is given, INVALID DATA-FIELD n out of range.
    """
    row, settings = command.row, controller.settings
    assert row is not None
    given = {
        index: checked_number(value, settings.range_in_force(row, index), field=index + 1, fields=row.fields.count)
        for index, value in enumerate(place_values(command, settings.axes_in_use))
        if value is not None
    }
    if not given:
        raise CommandError(INCORRECT_DATA)
    return given


def given_counts(controller: Controller, command: Command) -> dict[int, int]:
    """Slave distances given, by axis index, in whole counts."""
    return {
        index: whole_counts(Quantity(value, controller.settings.factor("distance", index)))
        for index, value in given_numbers(controller, command).items()
    }

"""Gain sets: SGSET saves what is in force, SGENB recalls it axis by axis, TGAIN and TSGSET show it.

A set holds the gains, SGILIM, SOFFS and SMPER of both axes as they are under the feedback source each axis has
(OEM6250 IG p.38). It is recalled into the settings of the source then in force, whichever that is: enabling one saved
under the other source is the mistake the guide warns of. In motion too a set takes effect with the next servo sample;
the integrator's voltage goes over.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.servo import GAIN_COMMANDS, apply_gains, apply_output, apply_position_error_limit
from emulator.controller.scaling import Quantity
from emulator.engine.encoder import ENCODER_SOURCE
from protocol.catalogue import commands
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, CommandError
from protocol.fields import checked_number, place_values, range_of
from protocol.reply import ReplyLine
from protocol.reply_shapes import numbers_line, places_of

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings

SET_COMMANDS = (*GAIN_COMMANDS, "SOFFS", "SMPER")
"""What a gain set holds (OEM6250 IG p.38)."""


@dataclass(frozen=True, slots=True)
class SavedGains:
    """What a gain set holds of one axis: the settings by name, and the feedback source (SFB) they were saved under."""

    source: int
    values: dict[str, Quantity]


def _set_number(controller: Controller, command: Command) -> int:
    row = command.row
    values = controller.substitute(command).values
    if row is None or len(values) != 1 or values[0] is None:
        raise CommandError(INCORRECT_DATA)
    return int(checked_number(values[0], range_of(row), field=1, fields=1))


@handles("SGSET")
def save_gain_set(controller: Controller, command: Command) -> Lines:
    """SGSETn: save the active values of both axes as set n."""
    number = _set_number(controller, command)
    controller.changes.note()
    settings = controller.settings
    controller.gain_sets[number] = [_in_force(settings, axis_index) for axis_index in range(settings.axes)]
    return None


def _in_force(settings: Settings, axis_index: int) -> SavedGains:
    values = {name: settings.setting(name, axis_index) for name in SET_COMMANDS}
    return SavedGains(settings.integer("SFB", axis_index), values)


@handles("SGENB")
def enable_gain_set(controller: Controller, command: Command) -> Lines:
    """SGENBi,j: recall set i on axis 1 and j on axis 2, at rest or in motion.

    A set that was never saved is refused: INVALID CONDITIONS FOR COMMAND (text assumed).
    """
    row = command.row
    if row is None or not command.argument:
        raise CommandError(INCORRECT_DATA)
    placed = place_values(controller.substitute(command), controller.settings.axes_in_use)
    numbers = {
        index: int(checked_number(value, range_of(row), field=index + 1, fields=2))
        for index, value in enumerate(placed)
        if value is not None
    }
    if any(number not in controller.gain_sets for number in numbers.values()):
        raise CommandError(INVALID_CONDITIONS)
    for axis_index, number in numbers.items():
        for name, quantity in controller.gain_sets[number][axis_index].values.items():
            controller.settings.store(name, axis_index, quantity)
    changed = list(numbers)
    for apply in (apply_gains, apply_output, apply_position_error_limit):
        apply(controller, command, changed)
    return None


@handles("TGAIN")
def report_gains(controller: Controller, command: Command) -> Lines:
    """TGAIN: each active gain as its own query would print it (layout assumed L)."""
    settings = controller.settings
    return [
        _line(name, [settings.setting(name, axis_index).value for axis_index in range(settings.axes_in_use)])
        for name in GAIN_COMMANDS
    ]


@handles("TSGSET")
def report_gain_set(controller: Controller, command: Command) -> Lines:
    """TSGSETn: a saved set with SOFFS and SMPER; one never saved shows the defaults."""
    number = _set_number(controller, command)
    saved = controller.gain_sets.get(number)
    axes = range(controller.settings.axes_in_use)
    shown = [(saved[axis_index] if saved else never_saved()).values for axis_index in axes]
    return [_line(name, [values[name].value for values in shown]) for name in SET_COMMANDS]


def never_saved() -> SavedGains:
    """What a set shows that was never saved: the settings as at power-up."""
    values = {name: Quantity(Decimal(str(commands()[name].fields.default)), 1) for name in SET_COMMANDS}
    return SavedGains(ENCODER_SOURCE, values)


def _line(name: str, values: list[Decimal]) -> ReplyLine:
    row = commands()[name]
    return numbers_line(row, None, values, [places_of(row)] * len(values))

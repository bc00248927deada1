"""Analogue inputs: the three joystick channels through their 8-bit converter.

ANVO puts a programmed voltage in place of a channel's wire, in front of the converter, for the channels ANVOEN names;
it then acts wherever the channel is used.
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from emulator.controller.readings import VOLT_PLACES
from protocol.catalogue import CommandRow
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, CommandError
from protocol.fields import checked_number, range_of
from protocol.numbers import format_fixed
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

CHANNELS = 3
FULL_SCALE_V = 2.5
CODES = 256
STEP_V = FULL_SCALE_V / CODES
"""Resolution of the joystick inputs: 8 bits over 0 to 2.5 V (6250 UG p.67)."""

_ROUNDING_V = 1e-9
"""Keeps a voltage typed as a decimal fraction of a step from falling into the step below."""


def code_of(volts: float) -> int:
    """The converter's code, 0 to 255."""
    return max(0, min(int((volts + _ROUNDING_V) / STEP_V), CODES - 1))


class Analog:
    """The analogue inputs of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.override_volts = [0.0] * CHANNELS

    def power_up(self) -> None:
        """No override voltages (0 V assumed)."""
        self.override_volts = [0.0] * CHANNELS

    def code(self, channel_index: int) -> int:
        """What the converter reads on a channel, 0 to 255."""
        if self._controller.settings.flag("ANVOEN", channel_index):
            return code_of(self.override_volts[channel_index])
        return code_of(self._controller.wiring.analog_volts[channel_index])

    def volts(self, channel_index: int) -> float:
        """The voltage of a channel as the converter reads it."""
        return self.code(channel_index) * STEP_V


@handles("TANV")
def report_analog_voltages(controller: Controller, command: Command) -> Lines:
    """TANV: the joystick channels in volts."""
    values = [round(Decimal(controller.analog.volts(channel)), VOLT_PLACES) for channel in range(CHANNELS)]
    return [ReplyLine("TANV", ",".join(format_fixed(value, VOLT_PLACES) for value in values))]


@handles("ANVO")
def override_analog(controller: Controller, command: Command) -> Lines:
    """ANVO volts,volts,volts."""
    row = _row(command)
    values = controller.substitute(command).values
    if not values or len(values) > CHANNELS:
        raise CommandError(INCORRECT_DATA)
    allowed = range_of(row)
    given = {
        channel: float(checked_number(value, allowed, field=channel + 1, fields=CHANNELS))
        for channel, value in enumerate(values)
        if value is not None
    }
    for channel, volts in given.items():
        controller.analog.override_volts[channel] = volts
    controller.engine.report_wires()
    return None


@applies("ANVOEN")
def apply_analog_override(controller: Controller, command: Command, changed: list[int]) -> None:
    """A channel may read another voltage now: whoever follows it looks at the next system update."""
    controller.engine.report_wires()


def _row(command: Command) -> CommandRow:
    assert command.row is not None
    return command.row

"""Joystick mode: the voltage of an analogue channel is the velocity of an axis.

The channel's 8-bit code is what counts.  Between the dead band in the middle and the one at each end velocity is linear
in the code (6250 UG p.67): no motion in the middle, full speed from the end on.  The joystick's digital inputs choose
the channel (axes select: JOYAXL or JOYAXH) and full speed (velocity select: JOYVL or JOYVH), a closed contact being
"high", and release ends the mode; INFNC N, O and M do the same on any input.

Nothing is looked at while the stick rests: whatever moves a voltage or a contact asks for a report at the next system
update, and there the velocities are worked out anew.
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, handles
from emulator.controller.motion.by_hand import in_mode, run_at, set_mode
from emulator.controller.motion.go import check_ready, check_s_curve
from emulator.controller.scaling import Quantity
from emulator.controller.wires.input_functions import InputFunction, acts_on
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, MOTION_IN_PROGRESS, CommandError
from protocol.fields import place_bits, place_mask
from protocol.status import OtherInputs

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

CODES_PER_VOLT = Decimal("102.4")
"""The converter: 256 codes over 0 to 2.5 V (6250 UG p.67)."""

HIGHEST_CODE = 255

NOT_A_JOYSTICK_INPUT = "INPUT(S) NOT DEFINED AS JOYSTICK INPUT"
"""JOY1 without a channel in JOYAXH or JOYAXL."""

VOLTAGE_PLACES = Decimal("0.01")
"""What JOYCTR keeps of a voltage (assumed L)."""

RELEASE, AXES_SELECT, VELOCITY_SELECT = "M", "N", "O"
"""INFNC letters."""


def deflection(code: int, *, centre_v: Decimal, centre_band_v: Decimal, end_band_v: Decimal) -> float:
    """Share of full speed, -1 to 1, for a converter code.

    The edges lie between codes; with JOYCTR1, JOYCDB.1, JOYEDB.2 they are 20 | 92 | 112 | 234 (6250 UG p.67, whose
    printed last edge, 232, does not agree with its own count of 122 codes).  The end bands are equally many codes wide.
    """
    lowest = int(end_band_v * CODES_PER_VOLT)
    highest = HIGHEST_CODE - 1 - lowest
    lower = _code(centre_v - centre_band_v)
    upper = _code(centre_v + centre_band_v)
    if code > upper:
        return min((code - upper) / (highest - upper), 1.0) if highest > upper else 0.0
    if code <= lower:
        return -min((lower + 1 - code) / (lower - lowest), 1.0) if lower > lowest else 0.0
    return 0.0


def _code(volts: Decimal) -> int:
    return int(volts * CODES_PER_VOLT // 1)


class Joystick:
    """What the joystick asks of each axis of a unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._asked = [0.0] * controller.settings.axes
        self._any = False

    def reset(self) -> None:
        """Power-up: no axis is in joystick mode."""
        self._asked = [0.0] * self._controller.settings.axes
        self._any = False

    def refresh(self) -> None:
        """A voltage, a contact or a setting may have changed: change what velocities that changes."""
        if not self._any:
            return
        for axis_index in range(self._controller.settings.axes_in_use):
            if in_mode(self._controller, "JOY", axis_index):
                self._refresh_axis(axis_index)

    def enter(self, axis_index: int) -> None:
        """Hand an axis to the stick."""
        set_mode(self._controller, "JOY", axis_index, on=True)
        self._any = True
        self._refresh_axis(axis_index)

    def leave(self, axis_index: int) -> None:
        """Take an axis back; whoever calls brings it to rest."""
        if in_mode(self._controller, "JOY", axis_index):
            set_mode(self._controller, "JOY", axis_index, on=False)
            self._asked[axis_index] = 0.0
            self._any = "1" in self._controller.settings.bits("JOY")

    def release(self, axis_index: int) -> None:
        """End the mode and come to rest at JOYAD."""
        run_at(self._controller, axis_index, 0.0, "JOY")
        self.leave(axis_index)

    def _refresh_axis(self, axis_index: int) -> None:
        if self._selected(OtherInputs.JOYSTICK_RELEASE, RELEASE):
            self.release(axis_index)
            return
        asked = self._velocity_counts_s(axis_index)
        if asked != self._asked[axis_index]:
            self._asked[axis_index] = asked
            run_at(self._controller, axis_index, asked, "JOY")

    def _selected(self, contact: OtherInputs, letter: str) -> bool:
        inputs = self._controller.inputs
        return inputs.joystick(contact) or inputs.function_active(letter)

    def _velocity_counts_s(self, axis_index: int) -> float:
        settings = self._controller.settings
        high = self._selected(OtherInputs.JOYSTICK_AXES_SELECT, AXES_SELECT)
        channel = settings.integer("JOYAXH" if high else "JOYAXL", axis_index)
        if channel == 0:
            return 0.0
        share = deflection(
            self._controller.analog.code(channel - 1),
            centre_v=settings.number("JOYCTR", channel - 1),
            centre_band_v=settings.number("JOYCDB", channel - 1),
            end_band_v=settings.number("JOYEDB", channel - 1),
        )
        fast = self._selected(OtherInputs.JOYSTICK_VELOCITY_SELECT, VELOCITY_SELECT)
        return share * float(settings.counts("JOYVH" if fast else "JOYVL", axis_index))


@acts_on(RELEASE, AXES_SELECT, VELOCITY_SELECT)
def joystick_input(controller: Controller, function: InputFunction, active: bool) -> None:
    """A select or release input has changed."""
    controller.joystick.refresh()


@applies("JOYAXH", "JOYAXL", "JOYVH", "JOYVL", "JOYCTR", "JOYCDB", "JOYEDB")
def apply_joystick_settings(controller: Controller, command: Command, changed: list[int]) -> None:
    """A setting that may change what the stick's present position means."""
    controller.joystick.refresh()


@handles("JOY")
def joystick_mode(controller: Controller, command: Command) -> Lines:
    """JOY: 1 hands an axis at rest to the joystick, 0 takes it back and brings it to rest at JOYAD."""
    if command.is_query:
        return controller.settings.report(command)
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    placed = place_mask(command, controller.settings.axes_in_use, lenient=controller.machine.lenient_masks)
    entering = [index for index, digit in enumerate(placed) if digit == "1" and not in_mode(controller, "JOY", index)]
    for axis_index in entering:
        _check_enter(controller, axis_index)
    for axis_index in entering:
        controller.joystick.enter(axis_index)
    for axis_index, digit in enumerate(placed):
        if digit == "0" and in_mode(controller, "JOY", axis_index):
            controller.joystick.release(axis_index)
    return None


def _check_enter(controller: Controller, axis_index: int) -> None:
    """Refuse joystick mode.

    Raises:
        CommandError: INVALID CONDITIONS in jog mode (assumed L), MOTION IN PROGRESS, no channel, what GO is refused
            for, an S-curve that is none.
    """
    settings = controller.settings
    if in_mode(controller, "JOG", axis_index):
        raise CommandError(INVALID_CONDITIONS)
    if controller.engine.is_moving(axis_index):
        raise CommandError(MOTION_IN_PROGRESS)
    check_ready(controller, (axis_index,))
    if not settings.integer("JOYAXH", axis_index) and not settings.integer("JOYAXL", axis_index):
        raise CommandError(NOT_A_JOYSTICK_INPUT)
    check_s_curve(controller, axis_index, "JOY")


@handles("JOYZ")
def zero_joystick(controller: Controller, command: Command) -> Lines:
    """JOYZ: take the present voltage of the channels marked 1 as their centre."""
    row = command.row
    assert row is not None
    if not command.mask:
        raise CommandError(INCORRECT_DATA)
    for channel_index, digit in enumerate(place_bits(command.mask, row.fields.count)):
        if digit == "1":
            volts = Decimal(controller.analog.code(channel_index)) / CODES_PER_VOLT
            controller.settings.store("JOYCTR", channel_index, Quantity(volts.quantize(VOLTAGE_PLACES), 1))
    controller.joystick.refresh()
    return None

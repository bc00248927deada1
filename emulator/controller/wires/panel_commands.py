"""The commands of the operator panel, and what its keys do to the unit.

Without a panel the commands are accepted and nobody sees them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, applies, carry_out, handles
from emulator.controller.variables.store import Store, supplies
from emulator.controller.waits import NEVER
from emulator.controller.wires.panel import (
    ARROW_KEYS,
    COLUMNS,
    CONTINUE,
    ENTRY_KEYS,
    FUNCTION_KEYS,
    KEYS,
    LINES,
    PAUSE,
    STOP,
)
from protocol.command import Command, parse_command
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError, invalid_data_field
from protocol.expression import Operand
from protocol.numbers import format_fixed, truncate
from protocol.status import SystemStatus
from protocol.strings import unquoted

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

MOST_WHOLE_DIGITS, MOST_DECIMALS = 9, 8
"""Digits DVAR can show (the range of VAR)."""

OVERFLOW_MARK = "*"
"""Fills the place of a number that does not fit its digits (assumed L)."""

LARGEST_PASSWORD = 9999
DEFAULT_PASSWORD = 6250
"""The product number (assumed L)."""


def press(controller: Controller, key: str) -> None:
    """Press a key of the panel.

    Raises:
        KeyError: no such key, or no panel is fitted.
    """
    if not controller.panel.fitted:
        raise KeyError("no operator panel is fitted (rp240.fitted in the machine file)")
    if key not in KEYS:
        raise KeyError(f"no key {key!r}; there are {', '.join(KEYS)}")
    if not controller.powered:
        return
    if key in ENTRY_KEYS:
        controller.panel.press_entry_key(key)
    elif key in FUNCTION_KEYS:
        controller.panel.press_function_key(key)
    elif key == STOP and controller.settings.flag("DSTP"):
        carry_out(controller, parse_command("!S"))
    elif key == PAUSE:
        controller.pausing.pause()
    elif key == CONTINUE:
        controller.pausing.go_on()
    elif key in ARROW_KEYS and controller.settings.flag("DJOG"):
        _jog(controller, key, held=True)
    controller.interpreter.run()


def release(controller: Controller, key: str) -> None:
    """Let go of an arrow key: what it jogs comes to rest."""
    if key in ARROW_KEYS and controller.powered:
        _jog(controller, key, held=False)


def _jog(controller: Controller, key: str, *, held: bool) -> None:
    """Arrow keys do in jog mode what the jog inputs of the axis do (assumed)."""
    controller.panel.hold(key, held=held)
    axis_index, _ = ARROW_KEYS[key]
    if axis_index < controller.settings.axes_in_use:
        controller.jogging.refresh(axis_index)


# Writing.


@handles("DCLEAR")
def clear_display(controller: Controller, command: Command) -> Lines:
    """DCLEAR 0 all, 1 or 2 one line."""
    (line,) = _whole_fields(controller, command, 1)
    if not 0 <= line <= LINES:
        raise CommandError(INVALID_DATA)
    controller.panel.clear(line)
    return None


@handles("DPCUR")
def place_cursor(controller: Controller, command: Command) -> Lines:
    """DPCUR line,column."""
    line, column = _whole_fields(controller, command, 2)
    if not 1 <= line <= LINES:
        raise invalid_data_field(1)
    if not 0 <= column < COLUMNS:
        raise invalid_data_field(2)
    controller.panel.move_cursor(line, column)
    return None


@handles("DWRITE")
def write_text(controller: Controller, command: Command) -> Lines:
    """DWRITE"text", up to 40 characters."""
    text = unquoted(command.argument)
    if len(text) > COLUMNS:
        raise CommandError(INVALID_DATA)
    controller.panel.write(text)
    return None


@handles("DVAR")
def write_variable(controller: Controller, command: Command) -> Lines:
    """DVAR variable,whole digits,decimals,sign: a VAR in a field of fixed width."""
    number, whole, decimals, sign = _whole_fields(controller, command, 4)
    value = controller.variables.number(number)
    if not 1 <= whole <= MOST_WHOLE_DIGITS:
        raise invalid_data_field(2)
    if not 0 <= decimals <= MOST_DECIMALS:
        raise invalid_data_field(3)
    if sign not in (0, 1):
        raise invalid_data_field(4)
    controller.panel.write(field_text(value, whole=whole, decimals=decimals, signed=bool(sign)))
    return None


def field_text(value: Decimal, *, whole: int, decimals: int, signed: bool) -> str:
    """A number in a field of fixed width, blanks in front, truncated to its decimals; the sign takes one place more."""
    shown = truncate(value, decimals)
    text = format_fixed(abs(shown), decimals)
    width = whole + (decimals + 1 if decimals else 0)
    if len(text) > width:
        text = OVERFLOW_MARK * width
    if signed:
        text = ("-" if shown < 0 else "+") + text
        width += 1
    return text.rjust(width)


@applies("DLED")
def light_lamps(controller: Controller, command: Command, changed: list[int]) -> None:
    """DLED changed."""
    controller.panel.leds = controller.settings.bits("DLED")


@handles("DPASS")
def set_password(controller: Controller, command: Command) -> Lines:
    """DPASS: one to four digits; kept over power-off."""
    (password,) = _whole_fields(controller, command, 1)
    if not 0 <= password <= LARGEST_PASSWORD:
        raise CommandError(INVALID_DATA)
    controller.panel_password = password
    controller.changes.note()
    return None


def _whole_fields(controller: Controller, command: Command, count: int) -> list[int]:
    values = controller.substitute(command).values
    numbers = [value for value in values if isinstance(value, Decimal)]
    if len(values) != count or len(numbers) != count:
        raise CommandError(INCORRECT_DATA)
    if any(number % 1 for number in numbers):
        raise CommandError(INVALID_DATA)
    return [int(number) for number in numbers]


# Reading.


@dataclass(slots=True)
class PanelWait:
    """DREAD, DREADF: until the operator has entered a number or pressed a function key."""

    answered: bool = field(default=False)
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = SystemStatus.WAITING_FOR_RP240

    def over(self, controller: Controller) -> bool:
        return self.answered


@supplies("DREAD")
def read_number(controller: Controller, operand: Operand, store: Store) -> None:
    """VARn=DREAD: wait for a number and ENTER; with DREADI1 take the number last entered, 0 before the first."""
    panel = controller.panel
    if controller.settings.flag("DREADI"):
        store(Decimal(panel.entered_number or 0))
        return
    wait = PanelWait()

    def deliver(text: str) -> None:
        if controller.interpreter.wait is wait:
            store(Decimal(text))
            wait.answered = True

    panel.on_number = deliver
    controller.interpreter.wait_for(wait)


@supplies("DREADF")
def read_function_key(controller: Controller, operand: Operand, store: Store) -> None:
    """VARn=DREADF: wait for a function key; with DREADI1 take the one last pressed, 0 before the first."""
    panel = controller.panel
    if controller.settings.flag("DREADI"):
        store(Decimal(panel.function_key))
        return
    wait = PanelWait()

    def deliver(number: int) -> None:
        if controller.interpreter.wait is wait:
            store(Decimal(number))
            wait.answered = True

    panel.on_function_key = deliver
    controller.interpreter.wait_for(wait)

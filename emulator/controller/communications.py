"""The serial port's settings: framing, echo, error level, addresses."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from emulator.controller.scaling import Quantity
from protocol.command import Command
from protocol.reply import Framing, LevelRules, character_codes

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.machine import Machine

FRAMING_COMMANDS = ("BOT", "EOL", "EOT", "ERROK", "ERRBAD", "ERRDEF", "ERRLVL")

EVERY_UNIT = 0
"""The ``0_`` prefix is obeyed by every unit (assumed H)."""


def framing_in_force(controller: Controller) -> Framing:
    """What surrounds replies, from the settings of the host's port."""
    codes = controller.settings.codes
    error_lead = b"\r\n" if controller.machine.serial.error_lead == "crlf" else b""
    return Framing(
        bot=character_codes(codes("BOT")),
        eol=character_codes(codes("EOL")),
        eot=character_codes(codes("EOT")),
        good_prompt=character_codes(codes("ERROK")),
        bad_prompt=character_codes(codes("ERRBAD")),
        defining_prompt=character_codes(codes("ERRDEF")),
        error_lead=error_lead,
        rules=level_rules(controller.machine, controller.settings.host_integer("ERRLVL")),
    )


def level_rules(machine: Machine, level: int) -> LevelRules:
    """What an error level sends, as the machine file has it."""
    form = machine.errlvl.form(level)
    return LevelRules(
        names=form.names,
        asterisk=form.star,
        error_text=form.error_text,
        good_prompt=form.ok_prompt,
        bad_prompt=form.bad_prompt,
        defining_prompt=form.define_prompt,
    )


@applies(*FRAMING_COMMANDS)
def apply_framing(controller: Controller, command: Command, changed: list[int]) -> None:
    """Framing takes effect from the next answer on: the prompt of this command already has it."""
    controller.framing = framing_in_force(controller)


@applies("ECHO", "E")
def apply_echo(controller: Controller, command: Command, changed: list[int]) -> None:
    """ECHO and E act on the next character."""
    controller.echo = controller.settings.host_flag("ECHO")
    controller.listening = controller.settings.host_flag("E")


def answers_to(controller: Controller, address: int | None) -> bool:
    """Whether a command with this unit address (None: without one) is for this unit."""
    return address is None or address in (EVERY_UNIT, controller.settings.integer("ADDR"))


@applies("ADDR")
def apply_address(controller: Controller, command: Command, changed: list[int]) -> None:
    """ADDR0 returns to the address set by the switches (6000 PG p.72): the one the machine file starts with."""
    if controller.settings.integer("ADDR") == 0:
        switches = Quantity(Decimal(controller.machine.defaults.get("ADDR", "0")), 1)
        controller.settings.store("ADDR", 0, switches)


def is_neighbours_reply(text: str) -> bool:
    """Whether a line that reaches a chained unit is what another unit said: passed on by the echo, but no command, and
    no bad command either (assumed L: else every reply would set ER bit 16 in all units behind)."""
    return text.startswith("*")

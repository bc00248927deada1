"""Programmable outputs: OUT and OUTALL.  What the functions of OUTFNC make of them is in ``output_functions``."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller import words
from emulator.controller.dispatch import Lines, handles
from emulator.controller.settings import bit_of
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, INVALID_DATA, OUTPUT_BIT_USED_AS_OUTFNC, CommandError
from protocol.reply_shapes import bit_line, word_line

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

OUTALL_FIELDS = 3


@handles("OUT")
def out(controller: Controller, command: Command) -> Lines:
    """OUT: set outputs left to right from output 1; alone it reports like TOUT."""
    row = command.row
    assert row is not None
    if command.is_query:
        bits = words.outputs(controller)
        return [bit_line(bit_of(bits, command.bit)) if command.bit is not None else word_line(row, None, bits)]
    switch_outputs(controller, output_pattern(controller, controller.substitute(command)))
    return None


def output_pattern(controller: Controller, command: Command) -> str:
    """What OUT or a POUT makes of the outputs, output 1 first: 0, 1, or X for one that stays as it is.

    Raises:
        CommandError: an output the unit does not have, or one with a function.
    """
    count = controller.output_functions.count
    if command.bit is not None:
        if not 1 <= command.bit <= count:
            raise CommandError(INVALID_DATA)
        if command.bit_value not in ("0", "1", "X"):
            raise CommandError(INCORRECT_DATA)
        pattern = "X" * (command.bit - 1) + command.bit_value
    else:
        pattern = command.mask
    if "1" in pattern[count:]:
        raise CommandError(INCORRECT_DATA)
    _refuse_assigned(controller, {n for n, digit in enumerate(pattern, start=1) if digit in "01"})
    return pattern[:count].ljust(count, "X")


def switch_outputs(controller: Controller, pattern: str) -> None:
    """Switch outputs as ``output_pattern`` says."""
    bits = controller.settings.bits("OUT")
    switched = "".join(old if new == "X" else new for old, new in zip(bits, pattern, strict=False))
    controller.settings.store_bits("OUT", switched + bits[len(switched) :])


def _refuse_assigned(controller: Controller, numbers: set[int]) -> None:
    """An output with a function is not the program's to switch, whatever OUTFEN says (assumed).

    Raises:
        CommandError: OUTPUT BIT USED AS OUTFNC.
    """
    if numbers & controller.output_functions.assigned_numbers:
        raise CommandError(OUTPUT_BIT_USED_AS_OUTFNC)


@handles("OUTALL")
def out_all(controller: Controller, command: Command) -> Lines:
    """OUTALL first,last,state."""
    values = [value for value in controller.substitute(command).values if isinstance(value, Decimal)]
    if len(values) != OUTALL_FIELDS or len(command.values) != OUTALL_FIELDS:
        raise CommandError(INCORRECT_DATA)
    first, last, state = (int(value) for value in values)
    if not 1 <= first <= last <= controller.output_functions.count or state not in (0, 1):
        raise CommandError(INVALID_DATA)
    _refuse_assigned(controller, set(range(first, last + 1)))
    bits = controller.settings.bits("OUT")
    controller.settings.store_bits("OUT", bits[: first - 1] + str(state) * (last - first + 1) + bits[last:])
    return None

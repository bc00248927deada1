"""Commands that make the buffer wait or go on: T, WAIT, PS, C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.following.cycles import cycle_start
from emulator.controller.waits import ConditionWait, Dwell
from protocol.command import Command
from protocol.condition import evaluate, parse_condition
from protocol.errors import INCORRECT_DATA, CommandError
from protocol.fields import checked_number, range_of

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NS_PER_S = 1_000_000_000


@handles("T")
def dwell(controller: Controller, command: Command) -> Lines:
    """T: seconds; over at the first system update at or after the time."""
    row = command.row
    values = controller.substitute(command).values
    if row is None or len(values) != 1 or values[0] is None:
        raise CommandError(INCORRECT_DATA)
    seconds = checked_number(values[0], range_of(row), field=1, fields=1)
    controller.interpreter.wait_for(Dwell(controller.system_update_at(controller.now_ns + int(seconds * NS_PER_S))))
    return None


@handles("WAIT")
def wait(controller: Controller, command: Command) -> Lines:
    """WAIT: hold the buffer, whatever COMEXC says, until the condition is true.

    A master position beyond the cycle length is one of a later cycle (6000 PG p.223).
    """
    condition = parse_condition(command.argument[1:-1])
    evaluate(condition, controller.operands.read)
    cycles = {axis_index: cycle_start(controller, axis_index) for axis_index in range(controller.settings.axes)}
    controller.interpreter.wait_for(ConditionWait(condition, cycles))
    return None


@handles("PS")
def pause(controller: Controller, command: Command) -> Lines:
    """PS: nothing more leaves the buffer until C (SS bit 13)."""
    controller.interpreter.pause()
    return None


@handles("C")
def go_on(controller: Controller, command: Command) -> Lines:
    """C: resume after PS, or after a stop under COMEXS1."""
    controller.pausing.go_on()
    return None

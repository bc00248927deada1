"""GOWHEN: what the next start of an axis waits for.

The form is the reference's (assumed M): one relation an axis, on its left an input, a time or a position.  Assumed
where it is silent: an operand without a digit is of the axis that waits; what stands on the right is worked when GOWHEN
is given; T counts from the start that waits; ``=`` on a position means reached or passed, from whichever side it is
approached, because an update could miss the very count; a time is over when it is reached, whatever the sign.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.readings import READINGS
from emulator.controller.registration.master_reached import COMPARE, MasterReached, master_reached
from emulator.engine import Signal
from emulator.engine.engine import FIRST_LASTING_WATCH
from protocol.command import Command
from protocol.condition import Operand, Relation, parse_condition
from protocol.errors import COMMAND_NOT_IMPLEMENTED, INCORRECT_AXIS, INCORRECT_DATA, CommandError, invalid_data_field
from protocol.expression import Expression, evaluator, operands_in
from protocol.expression_text import parse_number_expression

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NAME = "GOWHEN"
NS_PER_MS = 1_000_000

POSITIONS = frozenset({"FB", "PC", "PE", "PANI", "PMAS", "PSLV", "PSHF"})
"""Readings of an axis that may stand on the left."""

_TIME = re.compile(r"\d?T(=|>=|<=|>|<)(.+)", re.ASCII)


@dataclass(slots=True)
class PositionReached:
    """A position of an axis, compared in counts."""

    name: str
    axis_index: int
    sign: str
    counts: Decimal

    def holds(self, controller: Controller) -> bool:
        """``sign`` may be = only until the start waits, then it is the side from which the position is approached."""
        return COMPARE[self.sign](self._present(controller), self.counts)

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """The servo watches it, in the slot of the axis that waits."""
        if self.sign == "=":
            self.sign = ">=" if self._present(controller) < self.counts else "<="
        slot = FIRST_LASTING_WATCH + axis_index
        controller.engine.watch_value(slot, self.axis_index, self.name, self.sign, float(self.counts))

    def _present(self, controller: Controller) -> float:
        return READINGS[self.name].read(controller.engine, self.axis_index)


@dataclass(slots=True)
class TimePassed:
    """Milliseconds since the start that waits was commanded."""

    after_ns: int
    due_ns: int | None = None

    def holds(self, controller: Controller) -> bool:
        """The first time it is asked, which is when the start is commanded, the time begins."""
        if self.due_ns is None:
            self.due_ns = controller.now_ns + self.after_ns
        return controller.now_ns >= self.due_ns

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """An alarm of the unit stands for it."""
        assert self.due_ns is not None  # it has been asked whether it holds
        controller.alarms.at(self.due_ns, controller.held_starts.look)


@dataclass(frozen=True, slots=True)
class InputsMatch:
    """A pattern of the programmable inputs."""

    relation: Relation

    def holds(self, controller: Controller) -> bool:
        """As the unit sees its inputs: debounced."""
        return self.relation.test(controller.operands.read)

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """Inputs tell when they change."""


Condition = PositionReached | MasterReached | TimePassed | InputsMatch


@handles(NAME)
def gowhen(controller: Controller, command: Command) -> Lines:
    """GOWHEN: one condition an axis; empty fields leave an axis alone."""
    for axis_index, condition in conditions_of(controller, command).items():
        controller.held_starts.set_condition(axis_index, NAME, condition)
    return None


def conditions_of(controller: Controller, command: Command) -> dict[int, Condition]:
    """The conditions of a GOWHEN by axis index.

    Raises:
        CommandError: INCORRECT AXIS for more conditions than axes, INCORRECT DATA for what cannot be read, INVALID
            DATA-FIELD n for a condition GOWHEN does not take.
    """
    fields = list(_fields(command.argument))
    axes = controller.settings.axes_in_use
    if command.axis is not None or command.all_axes:
        first = 0 if command.axis is None else command.axis - 1
        if len(fields) != 1:
            raise CommandError(INCORRECT_AXIS)
        fields = ["" for _ in range(first)] + fields * (axes if command.all_axes else 1)
    if any(fields[axes:]):
        raise CommandError(INCORRECT_AXIS)
    return {index: read_condition(controller, text, index) for index, text in enumerate(fields) if text}


def _fields(argument: str) -> Iterator[str]:
    """The texts between the parentheses of each field; an empty field is an empty text.

    Raises:
        CommandError: INCORRECT DATA for what is not parenthesised.
    """
    depth, begin = 0, 0
    for place, character in enumerate(argument + ","):
        depth += (character == "(") - (character == ")")
        if character == "," and depth == 0:
            yield _inside(argument[begin:place])
            begin = place + 1
    if depth != 0:
        raise CommandError(INCORRECT_DATA)


def _inside(field: str) -> str:
    if not field:
        return ""
    if len(field) < 3 or field[0] != "(" or field[-1] != ")":
        raise CommandError(INCORRECT_DATA)
    return field[1:-1]


def read_condition(controller: Controller, text: str, axis_index: int) -> Condition:
    """The condition of one axis.

    Raises:
        CommandError: INCORRECT DATA, INVALID DATA-FIELD n, COMMAND NOT IMPLEMENTED for an operand the unit cannot read.
    """
    time = _TIME.fullmatch(text)
    if time is not None:
        after_ms = _fixed(controller, parse_number_expression(time[2]), axis_index)
        return TimePassed(int(after_ms * NS_PER_MS))
    relation = parse_condition(text)
    if not isinstance(relation, Relation) or not isinstance(relation.left, Operand):
        raise invalid_data_field(axis_index + 1)
    if relation.left.name == "IN":
        relation.test(controller.operands.read)
        return InputsMatch(relation)
    return _position(controller, relation, relation.left, axis_index)


def _position(
    controller: Controller, relation: Relation, operand: Operand, axis_index: int
) -> PositionReached | MasterReached:
    if operand.name not in POSITIONS or relation.sign not in COMPARE:
        raise invalid_data_field(axis_index + 1)
    if operand.name not in READINGS or operand.name not in Signal.__members__:
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    watched = axis_index if operand.axis is None else operand.axis - 1
    if not 0 <= watched < controller.settings.axes_in_use:
        raise CommandError(INCORRECT_AXIS)
    value = _fixed(controller, relation.right, axis_index)
    scale = READINGS[operand.name].scale
    factor = controller.settings.reading_factor(scale, watched) if scale else 1
    if operand.name == "PMAS":
        return master_reached(controller, watched, relation.sign, value * factor)
    return PositionReached(operand.name, watched, relation.sign, value * factor)


def _fixed(controller: Controller, expression: Expression, axis_index: int) -> Decimal:
    """What a right side is worth now; of operands only variables may stand there."""
    if any(operand.name != "VAR" for operand in operands_in(expression)):
        raise invalid_data_field(axis_index + 1)
    value = evaluator(expression)(controller.operands.read)
    if not isinstance(value, Decimal):
        raise invalid_data_field(axis_index + 1)
    return value

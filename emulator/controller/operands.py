"""What the operands of a condition read, and what in the engine can change them.

While a condition is waited for nobody looks at it until something it depends on changes: AS bits are watched by the
servo kernel, numeric relations become value watches armed for the opposite of what holds now, and everything else
changes only through events and commands that wake the interpreter anyway.
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller import words
from emulator.controller.readings import READINGS, SETTING_OPERANDS, reading_in_user_units
from emulator.engine import Signal
from protocol.catalogue import operands
from protocol.condition import Condition, Operand, Relation, Value, evaluate, relations
from protocol.errors import COMMAND_NOT_IMPLEMENTED, INCORRECT_AXIS, INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.status import AxisStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

UNPREFIXED_AXIS = 1
"""Axis meant by ``AS`` or ``PE`` without a digit (assumed; single-axis hosts write it so)."""

VALUE_WATCH_SLOTS = 8

_UNIT_WORDS = {
    "SS": words.system_status,
    "ER": words.error_status,
    "LIM": words.limit_inputs,
    "IN": words.inputs,
    "INO": words.other_inputs,
    "OUT": words.outputs,
    "MOV": words.moving,
}
_AXIS_WORDS = {"AS": words.axis_status, "ASX": words.extended_axis_status}
_OPPOSITE = {"=": "<>", "<>": "=", "<": ">=", ">": "<=", "<=": ">", ">=": "<"}


class Operands:
    """Reads the operands of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller

    def read(self, operand: Operand) -> Value:
        """The present value: a bit text for words, a number otherwise.

        Raises:
            CommandError: an axis or bit the unit does not have, an operand it cannot read.
        """
        name = operand.name
        if name in _AXIS_WORDS:
            return _bit(_AXIS_WORDS[name](self._controller, self._axis_index(operand)), operand.bit)
        if name in _UNIT_WORDS:
            return _bit(_UNIT_WORDS[name](self._controller), operand.bit)
        axis_index = self._axis_index(operand)
        if name in READINGS:
            return reading_in_user_units(self._controller, name, axis_index)
        if name in SETTING_OPERANDS:
            return self._controller.settings.value_in_user_units(name, axis_index)
        raise CommandError(COMMAND_NOT_IMPLEMENTED if name in operands() else INCORRECT_DATA)

    def _axis_index(self, operand: Operand) -> int:
        axis = operand.axis or UNPREFIXED_AXIS
        if not 1 <= axis <= self._controller.settings.axes_in_use:
            raise CommandError(INCORRECT_AXIS)
        return axis - 1

    def arm_watches(self, condition: Condition) -> None:
        """Have the engine report when anything the condition depends on changes."""
        engine = self._controller.engine
        engine.clear_watches()
        masks: dict[int, int] = {}
        slots = iter(range(VALUE_WATCH_SLOTS))
        for relation in relations(condition):
            sides = [relation.left, relation.right] if isinstance(relation.right, Operand) else [relation.left]
            for operand in sides:
                self._add_status_bits(masks, operand)
                if operand.name in Signal.__members__ and (slot := next(slots, None)) is not None:
                    self._arm(slot, relation, operand)
        for axis_index, mask in masks.items():
            engine.watch_status(axis_index, mask)

    def _add_status_bits(self, masks: dict[int, int], operand: Operand) -> None:
        if operand.name == "AS":
            axis_index = self._axis_index(operand)
            masks[axis_index] = masks.get(axis_index, 0) | (1 << (operand.bit - 1) if operand.bit else 0xFFFFFFFF)
        elif operand.name == "MOV":
            for axis_index in range(self._controller.settings.axes_in_use):
                masks[axis_index] = masks.get(axis_index, 0) | AxisStatus.MOVING.mask

    def _arm(self, slot: int, relation: Relation, operand: Operand) -> None:
        """Against a number the crossing counts; of two operands either may move, so any change of either."""
        if isinstance(relation.right, Operand):
            axis_index = self._axis_index(operand)
            present = READINGS[operand.name].read(self._controller.engine, axis_index)
            self._controller.engine.watch_value(slot, axis_index, operand.name, "<>", float(present))
        else:
            self._arm_crossing(slot, relation, relation.right)

    def _arm_crossing(self, slot: int, relation: Relation, threshold: Decimal | str) -> None:
        sign = _OPPOSITE[relation.sign] if evaluate(relation, self.read) else relation.sign
        axis_index = self._axis_index(relation.left)
        scale = READINGS[relation.left.name].scale
        factor = self._controller.settings.reading_factor(scale, axis_index) if scale else 1
        counts = Decimal(threshold) * factor
        self._controller.engine.watch_value(slot, axis_index, relation.left.name, sign, float(counts))


def _bit(bits: str, number: int | None) -> str:
    if number is None:
        return bits
    if not 1 <= number <= len(bits):
        raise CommandError(INVALID_DATA)
    return bits[number - 1]

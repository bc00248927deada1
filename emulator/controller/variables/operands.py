"""What the operands of a condition read, and what in the engine can change them.

While a condition is waited for nobody looks at it until something it depends on changes: AS bits are watched by the
servo kernel, numeric relations become value watches armed for the opposite of what holds now, and everything else
changes only through events and commands that wake the interpreter anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller import words
from emulator.controller.motion.following.cycles import CycleStart, position_since, travel_at
from emulator.controller.motion.following.status import bits_to_watch, following_status
from emulator.controller.readings import READINGS, SETTING_OPERANDS, VOLT_PLACES, reading_in_user_units
from emulator.controller.variables.data_statements import MAX_DATA_PROGRAMS
from emulator.controller.variables.store import WAITED_FOR
from emulator.controller.waits import NEVER
from emulator.engine import Signal
from emulator.engine.engine import FIRST_LASTING_WATCH
from protocol.condition import Condition, Operand, Relation, Value, evaluate, relations
from protocol.errors import COMMAND_NOT_IMPLEMENTED, INCORRECT_AXIS, INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.expression import RADIAN_MODE, Expression, Read, evaluator, operands_in
from protocol.numbers import divide
from protocol.status import AxisStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

Reader = Callable[["Controller", Operand], Value]

UNPREFIXED_AXIS = 1
"""Axis meant by ``AS`` or ``PE`` without a digit (assumed; single-axis hosts write it so)."""

VALUE_WATCH_SLOTS = FIRST_LASTING_WATCH

_readers: dict[str, Reader] = {}


def reads(*names: str) -> Callable[[Reader], Reader]:
    """Register what reads these operands."""

    def register(function: Reader) -> Reader:
        for name in names:
            _readers[name] = function
        return function

    return register


_UNIT_WORDS: dict[str, Callable[[Controller], str]] = {
    "SS": words.system_status,
    "ER": words.error_status,
    "LIM": words.limit_inputs,
    "IN": words.inputs,
    "INO": words.other_inputs,
    "OUT": words.outputs,
    "MOV": words.moving,
    "US": words.user_status,
    "SC": lambda controller: "0" * words.WORD,
}
_AXIS_WORDS = {"AS": words.axis_status, "ASX": words.extended_axis_status, "FS": following_status}
_OPPOSITE = {"=": "<>", "<>": "=", "<": ">=", ">": "<=", "<=": ">", ">=": "<"}


class Operands:
    """Reads the operands of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._timer_look_ns = NEVER
        self._cycles: Mapping[int, CycleStart] = {}

    def read(self, operand: Operand) -> Value:
        """The present value: a bit text for words, a number otherwise.

        Raises:
            CommandError: an axis or bit the unit does not have, an operand it cannot read.
        """
        name = operand.name
        if name == "VAR":
            return self._controller.variables.number(operand.index or 0)
        if name in _AXIS_WORDS:
            return _bit(_AXIS_WORDS[name](self._controller, self._axis_index(operand)), operand.bit)
        if name in _UNIT_WORDS:
            return _bit(_UNIT_WORDS[name](self._controller), operand.bit)
        reader = _readers.get(name)
        if reader is not None:
            return reader(self._controller, operand)
        if name in READINGS:
            return reading_in_user_units(self._controller, name, self._axis_index(operand))
        if name in SETTING_OPERANDS:
            return self._controller.settings.value_in_user_units(name, self._axis_index(operand))
        raise CommandError(INCORRECT_DATA if name in WAITED_FOR else COMMAND_NOT_IMPLEMENTED)

    def reader(self, cycles: Mapping[int, CycleStart]) -> Read:
        """As ``read``, with PMAS counted on from these master cycles, by axis index."""

        def read(operand: Operand) -> Value:
            if operand.name != "PMAS":
                return self.read(operand)
            axis_index = self._axis_index(operand)
            controller = self._controller
            factor = controller.settings.reading_factor("master", axis_index)
            return divide(Decimal(position_since(controller, axis_index, cycles[axis_index])), factor)

        return read

    def _axis_index(self, operand: Operand) -> int:
        axis = operand.axis or UNPREFIXED_AXIS
        if not 1 <= axis <= self._controller.settings.axes_in_use:
            raise CommandError(INCORRECT_AXIS)
        return axis - 1

    def arm_watches(self, condition: Condition, cycles: Mapping[int, CycleStart]) -> None:
        """Have the unit look again when anything the condition depends on has changed.

        The engine has a few value watches; a condition with more readings is looked at again at the next system update.
        """
        engine = self._controller.engine
        engine.clear_watches()
        self._cycles = cycles
        masks: dict[int, int] = {}
        following: dict[int, int] = {}
        slots = iter(range(VALUE_WATCH_SLOTS))
        for relation in relations(condition):
            depends_on = [*operands_in(relation.left), *operands_in(relation.right)]
            for operand in depends_on:
                self._add_status_bits(masks, operand)
                if operand.name == "FS":
                    axis_index = self._axis_index(operand)
                    following[axis_index] = following.get(axis_index, 0) | bits_to_watch(operand.bit)
                    if self._controller.ratio_moves.advancing(axis_index):
                        self._look_at_next_update()
                if operand.name in Signal.__members__:
                    self._watch_reading(next(slots, None), relation, operand)
            if any(operand.name == "TIM" for operand in depends_on):
                self._arm_timer(relation)
        for axis_index, mask in masks.items():
            engine.watch_status(axis_index, mask)
        for axis_index, mask in following.items():
            engine.watch_following(axis_index, mask)

    def _add_status_bits(self, masks: dict[int, int], operand: Operand) -> None:
        if operand.name == "AS":
            axis_index = self._axis_index(operand)
            masks[axis_index] = masks.get(axis_index, 0) | _mask(operand.bit)
        elif operand.name == "MOV":
            for axis_index in range(self._controller.settings.axes_in_use):
                masks[axis_index] = masks.get(axis_index, 0) | AxisStatus.MOVING.mask

    def _watch_reading(self, slot: int | None, relation: Relation, operand: Operand) -> None:
        if slot is None:
            self._look_at_next_update()
        else:
            self._arm(slot, relation, operand)

    def _look_at_next_update(self) -> None:
        controller = self._controller
        controller.alarms.at(controller.engine.next_system_update_ns, _look_again)

    def _arm(self, slot: int, relation: Relation, operand: Operand) -> None:
        """A lone reading against what stands still: the crossing counts; otherwise any change of it may."""
        moving = [other for other in operands_in(relation.right) if other.name in Signal.__members__]
        if relation.left == operand and not moving:
            self._arm_crossing(slot, relation, operand)
        else:
            axis_index = self._axis_index(operand)
            present = READINGS[operand.name].read(self._controller.engine, axis_index)
            self._controller.engine.watch_value(slot, axis_index, operand.name, "<>", float(present))

    def _arm_crossing(self, slot: int, relation: Relation, operand: Operand) -> None:
        controller = self._controller
        sign = _OPPOSITE[relation.sign] if evaluate(relation, self.reader(self._cycles)) else relation.sign
        axis_index = self._axis_index(operand)
        scale = READINGS[operand.name].scale
        factor = controller.settings.reading_factor(scale, axis_index) if scale else 1
        counts = self._number(relation.right) * factor
        if operand.name == "PMAS":
            cycle_began = travel_at(controller, axis_index, self._cycles[axis_index], 0)
            controller.engine.watch_value(slot, axis_index, Signal.MASTER, sign, float(cycle_began + counts))
        else:
            controller.engine.watch_value(slot, axis_index, operand.name, sign, float(counts))

    def _number(self, expression: Expression) -> Decimal:
        value = evaluator(expression)(self.read)
        assert isinstance(value, Decimal)  # operands compared with numbers were read as numbers
        return value

    def _arm_timer(self, relation: Relation) -> None:
        """Look again when TIM comes to what it is compared with; in anything more involved, at the next update."""
        controller = self._controller
        now_ns = controller.now_ns
        lone = isinstance(relation.left, Operand) and relation.left.name == "TIM"
        if lone and not any(operand.name == "TIM" for operand in operands_in(relation.right)):
            whole = int(self._number(relation.right))
            turns = [controller.timer.reaches_ns(max(0, elapsed_ms)) for elapsed_ms in (whole, whole + 1)]
        else:
            turns = [controller.timer.reaches_ns(controller.timer.elapsed_ms(now_ns) + 1)]
        look_ns = min((turn for turn in turns if turn > now_ns), default=NEVER)
        if look_ns != NEVER:
            look_ns = max(controller.system_update_at(look_ns), controller.engine.next_system_update_ns)
        if look_ns not in (NEVER, self._timer_look_ns):
            self._timer_look_ns = look_ns
            controller.alarms.at(look_ns, _look_again)


def _look_again() -> None:
    """The alarm alone makes the unit look at what it waits for."""


def _mask(bit: int | None) -> int:
    """The bit of a word, or all of them."""
    return 0xFFFFFFFF if bit is None else 1 << (bit - 1)


def _bit(bits: str, number: int | None) -> str:
    if number is None:
        return bits
    if not 1 <= number <= len(bits):
        raise CommandError(INVALID_DATA)
    return bits[number - 1]


@reads("VARB")
def _read_pattern(controller: Controller, operand: Operand) -> Value:
    return _bit(controller.variables.bits(operand.index or 0), operand.bit)


@reads("DAT")
def _read_data(controller: Controller, operand: Operand) -> Value:
    """DATn reads on: each look at it is the next number."""
    number = operand.index or 0
    if not 1 <= number <= MAX_DATA_PROGRAMS:
        raise CommandError(INVALID_DATA)
    return controller.data_programs.read(number)


@reads("DPTR")
def _read_data_pointer(controller: Controller, operand: Operand) -> Value:
    data_programs = controller.data_programs
    return Decimal(data_programs.pointer(data_programs.active).element)


@reads("TIM")
def _read_timer(controller: Controller, operand: Operand) -> Value:
    return Decimal(controller.timer.elapsed_ms(controller.now_ns))


@reads("SEG")
def _read_free_segments(controller: Controller, operand: Operand) -> Value:
    """Free segments of compiled memory."""
    return Decimal(controller.compiled.free)


@reads("ANV")
def _read_analog_voltage(controller: Controller, operand: Operand) -> Value:
    """nANV: joystick channel n in volts; the digit in front counts channels, not axes (assumed L)."""
    channel_index = (operand.axis or UNPREFIXED_AXIS) - 1
    if not 0 <= channel_index < len(controller.wiring.analog_volts):
        raise CommandError(INCORRECT_AXIS)
    return round(Decimal(controller.analog.volts(channel_index)), VOLT_PLACES)


@reads(RADIAN_MODE.name)
def _read_radian_mode(controller: Controller, operand: Operand) -> Value:
    return Decimal(int(controller.settings.flag(RADIAN_MODE.name)))


@reads("DKEY")
def _read_last_key(controller: Controller, operand: Operand) -> Value:
    """The number of the function key pressed last, 0 before the first; other keys are not told (assumed L)."""
    return Decimal(controller.panel.function_key)

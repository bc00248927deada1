"""Data programs: numbers a program reads in turn with DAT and teaches with DATTCH.

The numbers live in stored programs (``data_statements``), so DEF, DEL, TPROG and the memory reports know them; here are
the pointers and the commands that move them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from emulator.controller.dispatch import Lines, handles
from emulator.controller.variables.data_statements import (
    BYTES_PER_STATEMENT,
    MAX_DATA_PROGRAMS,
    numbers_of,
    program_name,
    statement_of,
    statements_of,
)
from protocol.command import Command, parse_command
from protocol.errors import (
    INCORRECT_DATA,
    INSUFFICIENT_MEMORY,
    INVALID_CONDITIONS,
    INVALID_DATA,
    CommandError,
    invalid_data_field,
)
from protocol.reply_shapes import numbers_line

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

MAX_ELEMENTS = 6500
MAX_INCREMENT = 100
"""Ranges of DATPTR (assumed M)."""

WRAPPED = "WARNING: POINTER HAS WRAPPED AROUND TO DATA POINT 1"
"""Sent when DAT or DATTCH has used the last element; the command itself is carried out (form assumed L)."""

TAUGHT_AT_ONCE = 4


@dataclass(slots=True)
class Pointer:
    """Where one data program is read next, counting from 1, and by how much that goes on each time."""

    element: int = 1
    increment: int = 1


class Elements(NamedTuple):
    """The numbers of a data program as last read from its statements."""

    statements: list[str]
    lines: int
    numbers: list[Decimal]


class DataPrograms:
    """The pointers into the data programs of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._pointers: dict[int, Pointer] = {}
        self._pointed_into: dict[int, Sequence[str] | None] = {}
        self._read: dict[int, Elements] = {}
        self.active = 1
        """The data program DATPTR, DATRST or DATSIZ named last: DATTCH, DPTR and TDPTR work on it."""

    def pointer(self, number: int) -> Pointer:
        """The pointer into a data program; it may be moved.  A program defined anew starts at its first element."""
        name = program_name(number)
        programs = self._controller.programs
        statements = programs.lines(name) if name in programs.names else None
        if statements is not self._pointed_into.get(number):
            self._pointed_into[number] = statements
            self._pointers.pop(number, None)
        return self._pointers.setdefault(number, Pointer())

    def reset(self) -> None:
        """RESET and power-up: the pointers stand at the first elements again (assumed)."""
        self._pointers.clear()
        self._pointed_into.clear()
        self.active = 1

    def numbers(self, number: int) -> Sequence[Decimal]:
        """All numbers of a data program.

        Raises:
            CommandError: UNDEFINED LABEL, there is no such program.
        """
        statements = self._controller.programs.lines(program_name(number))
        kept = self._read.get(number)
        if kept is None or kept.statements is not statements or kept.lines != len(statements):
            values = [value for statement in statements for value in numbers_of(statement)]
            kept = self._read[number] = Elements(statements, len(statements), values)
        return kept.numbers

    def size(self, number: int) -> int:
        """Elements of a data program; 0 when there is none."""
        exists = program_name(number) in self._controller.programs.names
        return len(self.numbers(number)) if exists else 0

    def read(self, number: int) -> Decimal:
        """DATn: the number at the pointer, which goes on.

        Raises:
            CommandError: UNDEFINED LABEL; INVALID DATA when the program holds no data.
        """
        numbers = self.numbers(number)
        pointer = self.pointer(number)
        if pointer.element > len(numbers):
            raise CommandError(INVALID_DATA)
        value = numbers[pointer.element - 1]
        self._go_on(number)
        return value

    def teach(self, values: Sequence[Decimal]) -> None:
        """DATTCH: put numbers where the active pointer stands.

        Raises:
            CommandError: UNDEFINED LABEL, INVALID DATA as ``read``.
        """
        numbers = list(self.numbers(self.active))
        for value in values:
            element = self.pointer(self.active).element
            if element > len(numbers):
                raise CommandError(INVALID_DATA)
            numbers[element - 1] = value
            self._replace(element, value)
            self._go_on(self.active)

    def _replace(self, element: int, value: Decimal) -> None:
        programs, name = self._controller.programs, program_name(self.active)
        before = 0
        for line, statement in enumerate(programs.lines(name)):
            numbers = list(numbers_of(statement))
            if before < element <= before + len(numbers):
                numbers[element - before - 1] = value
                programs.replace_line(name, line, statement_of(numbers))
                break
            before += len(numbers)
        self._read.pop(self.active, None)

    def _go_on(self, number: int) -> None:
        pointer = self.pointer(number)
        pointer.element += pointer.increment
        if pointer.element > len(self.numbers(number)):
            pointer.element = 1
            controller = self._controller
            controller.send(controller.framing.error(WRAPPED), controller.interpreter.channel)

    def create(self, number: int, elements: int) -> None:
        """DATSIZ: a data program of zeros in place of the one there was.

        Raises:
            CommandError: INSUFFICIENT MEMORY, and nothing has changed.
        """
        programs, name = self._controller.programs, program_name(number)
        statements = statements_of([Decimal(0)] * elements)
        freed = programs.bytes_used(name) if name in programs.names else 0
        if len(statements) * BYTES_PER_STATEMENT > programs.bytes_free + freed:
            raise CommandError(INSUFFICIENT_MEMORY)
        programs.delete(name)
        programs.begin(name)
        for statement in statements:
            programs.store(parse_command(statement))
        programs.end()
        self._pointers[number] = Pointer()
        self.active = number


def _whole_fields(command: Command, limits: Sequence[int]) -> list[int | None]:
    """The comma fields as whole numbers from 1 to their limits; None for those left out."""
    if len(command.values) > len(limits):
        raise CommandError(INCORRECT_DATA)
    fields: list[int | None] = []
    for number, (value, most) in enumerate(zip(command.values, limits, strict=False), start=1):
        if value is not None and not (isinstance(value, Decimal) and 1 <= int(value) <= most):
            raise invalid_data_field(number)
        fields.append(int(value) if isinstance(value, Decimal) else None)
    return fields + [None] * (len(limits) - len(fields))


@handles("DATA")
def data(controller: Controller, command: Command) -> Lines:
    """DATA=...: stored by DEF; a data program that is run as a program does nothing (assumed).

    Raises:
        CommandError: INVALID CONDITIONS FOR COMMAND outside a definition.
    """
    if not controller.programs.running:
        raise CommandError(INVALID_CONDITIONS)
    return None


@handles("DATSIZ")
def size(controller: Controller, command: Command) -> Lines:
    """DATSIZ program,elements; alone it reports the active data program and its size."""
    assert command.row is not None
    data_programs = controller.data_programs
    if command.is_query:
        active = data_programs.active
        return [numbers_line(command.row, None, [Decimal(active), Decimal(data_programs.size(active))], [0, 0])]
    number, elements = _whole_fields(command, (MAX_DATA_PROGRAMS, MAX_ELEMENTS))
    if number is None or elements is None:
        raise CommandError(INCORRECT_DATA)
    if controller.programs.running or controller.programs.defining is not None:
        raise CommandError(INVALID_CONDITIONS)
    data_programs.create(number, elements)
    return None


@handles("DATPTR")
def set_pointer(controller: Controller, command: Command) -> Lines:
    """DATPTR program,element,increment; a field left out stays as it is (assumed)."""
    number, element, increment = _whole_fields(command, (MAX_DATA_PROGRAMS, MAX_ELEMENTS, MAX_INCREMENT))
    _move_pointer(controller, number, element, increment)
    return None


@handles("DATRST")
def reset_pointer(controller: Controller, command: Command) -> Lines:
    """DATRST program,element; without the element to the first (assumed)."""
    number, element = _whole_fields(command, (MAX_DATA_PROGRAMS, MAX_ELEMENTS))
    _move_pointer(controller, number, element or 1, None)
    return None


def _move_pointer(controller: Controller, number: int | None, element: int | None, increment: int | None) -> None:
    if number is None:
        raise CommandError(INCORRECT_DATA)
    data_programs = controller.data_programs
    if element is not None and element > len(data_programs.numbers(number)):
        raise invalid_data_field(2)
    pointer = data_programs.pointer(number)
    pointer.element = element or pointer.element
    pointer.increment = increment or pointer.increment
    data_programs.active = number


@handles("DATTCH")
def teach(controller: Controller, command: Command) -> Lines:
    """DATTCH var,var,var,var: store up to four VAR at the pointer."""
    if not command.values or not all(isinstance(value, Decimal) for value in command.values):
        raise CommandError(INCORRECT_DATA)
    if len(command.values) > TAUGHT_AT_ONCE:
        raise CommandError(INCORRECT_DATA)
    values = [controller.variables.number(int(value)) for value in command.values if isinstance(value, Decimal)]
    controller.data_programs.teach(values)
    return None


@handles("TDPTR")
def report_pointer(controller: Controller, command: Command) -> Lines:
    """TDPTR: active data program, element, increment."""
    assert command.row is not None
    data_programs = controller.data_programs
    pointer = data_programs.pointer(data_programs.active)
    values = (data_programs.active, pointer.element, pointer.increment)
    return [numbers_line(command.row, None, [Decimal(value) for value in values], [0, 0, 0])]

"""Stored programs: DEF, END, DEL, ERASE and MEMORY, and which program is called by which name.

Programs keep their commands as text, as TPROG prints them; before one runs it is prepared once (``preparation``).
What runs is on the stack of ``execution``.  A definition belongs to the unit, not to the connection that began it: if
the line goes dead in the middle, it stays open until END, and whoever types next goes on with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from emulator.controller.changes import Changes
from emulator.controller.dispatch import Lines, applies, handles, is_implemented, store_setting
from emulator.controller.programs.execution import Execution
from emulator.controller.programs.preparation import Prepared, condition_of, prepare
from emulator.controller.scaling import Quantity
from emulator.controller.settings import Quantities
from emulator.controller.variables.data_statements import BYTES_PER_STATEMENT, check_place
from emulator.state.contents import Number, ProgramText, ScaledLine
from protocol.command import Command, check_program_name, is_command_name, parse_command
from protocol.errors import (
    COMMAND_NOT_ALLOWED_IN_PROGRAM,
    COMMAND_NOT_IMPLEMENTED,
    INCORRECT_DATA,
    INSUFFICIENT_MEMORY,
    INVALID_CONDITIONS,
    LABEL_ALREADY_DEFINED,
    NO_PROGRAM_BEING_DEFINED,
    STRING_ALREADY_DEFINED,
    STRING_IS_A_COMMAND,
    UNDEFINED_LABEL,
    CommandError,
    invalid_data_field,
)

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

BYTES_PER_COMMAND = 1
"""Program memory a command takes beyond its text (assumed L)."""

NOT_STORABLE = frozenset({"DEF", "ERASE", "MEMORY", "RESET", "'", "#"})
"""Commands refused between DEF and END (assumed L)."""

ACCESS_DENIED = "ACCESS DENIED"
"""What the guarded commands answer while the program security input is inactive."""

NO_NAME = "CLR"
"""The word that clears STARTP, ERRORP and ONP, and so names no program."""


@dataclass(slots=True)
class Program:
    """One stored program: its text, the memory it takes, and its prepared form once it has been needed.

    ``quantities`` keeps the values of scaled settings, by line, as they were scaled when they were stored; ``scaled``
    has the same for non-volatile memory, and ``kept`` is the program as that has it, until it changes.
    """

    texts: list[str] = field(default_factory=list)
    quantities: dict[int, Quantities] = field(default_factory=dict)
    scaled: list[ScaledLine] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    size: int = 0
    prepared: Prepared | None = None
    kept: ProgramText | None = None


class Programs:
    """The programs of one unit."""

    def __init__(
        self, *, capacity_bytes: int, max_programs: int, max_nesting: int, max_labels: int, changes: Changes
    ) -> None:
        self._changes = changes
        self.capacity_bytes = capacity_bytes
        self._max_programs = max_programs
        self._max_labels = max_labels
        self._stored: dict[str, Program] = {}
        self._used = 0
        self.execution = Execution(max_nesting)
        self.defining: str | None = None

    @property
    def names(self) -> list[str]:
        """The stored programs in the order they were defined."""
        return list(self._stored)

    @property
    def running(self) -> bool:
        """A program is being carried out (SS bit 3)."""
        return bool(self.execution.frames)

    def exists(self, name: str) -> bool:
        """Whether a program of this name is stored."""
        return name in self._stored

    def lines(self, name: str) -> list[str]:
        """The commands of a program.

        Raises:
            CommandError: UNDEFINED LABEL.
        """
        return self._find(name).texts

    def _find(self, name: str) -> Program:
        try:
            return self._stored[name]
        except KeyError:
            raise CommandError(UNDEFINED_LABEL) from None

    def bytes_used(self, name: str) -> int:
        """Program memory one program takes."""
        return self._stored[name].size

    @property
    def bytes_free(self) -> int:
        """Program memory left."""
        return self.capacity_bytes - self._used

    def labels(self) -> list[tuple[str, str]]:
        """Every label and the program it is in."""
        return [(label, name) for name, program in self._stored.items() for label in program.labels]

    def owner_of_label(self, label: str) -> str | None:
        """The first program with this label."""
        return next((name for name, program in self._stored.items() if label in program.labels), None)

    # Defining.

    def begin(self, name: str) -> None:
        """DEF: what follows is stored under ``name``.

        Raises:
            CommandError: the name is no name, a command, taken, or there are too many programs.
        """
        _check_name(name)
        if name in self._stored:
            raise CommandError(STRING_ALREADY_DEFINED)
        if len(self._stored) >= self._max_programs:
            raise CommandError(INSUFFICIENT_MEMORY)
        self._stored[name] = Program()
        self.defining = name
        self._changes.note()

    def stores(self, command: Command) -> bool:
        """Whether a buffered command goes into the program being defined rather than being carried out."""
        return self.defining is not None and command.name != "END"

    def store(self, command: Command, quantities: Quantities | None = None) -> None:
        """Add a command to the program being defined, with its scaled values if it has any.

        Raises:
            CommandError: it cannot be stored, or memory is full.
        """
        assert self.defining is not None
        check_storable(command)
        program = self._stored[self.defining]
        check_place(self.defining, command)
        self._add(program, command, quantities)
        self._changed(program)

    def _add(self, program: Program, command: Command, quantities: Quantities | None) -> None:
        size = BYTES_PER_STATEMENT if command.name == "DATA" else len(command.text) + BYTES_PER_COMMAND
        if self.bytes_free < size:
            raise CommandError(INSUFFICIENT_MEMORY)
        if command.name == "$":
            self._add_label(program, command.argument)
        if quantities:
            program.quantities[len(program.texts)] = quantities
            program.scaled.append((len(program.texts), tuple(quantities.items())))
        program.texts.append(command.text)
        program.size += size
        self._used += size

    def _changed(self, program: Program) -> None:
        program.prepared = program.kept = None
        self._changes.note()

    def replace_line(self, name: str, line: int, text: str) -> None:
        """Put another command of the same size in the place of one (teaching a data program)."""
        program = self._stored[name]
        program.texts[line] = text
        self._changed(program)

    def _add_label(self, program: Program, label: str) -> None:
        _check_name(label)
        if label in program.labels:
            raise CommandError(LABEL_ALREADY_DEFINED)
        if len(self.labels()) >= self._max_labels:
            raise CommandError(INSUFFICIENT_MEMORY)
        program.labels.append(label)

    def end(self) -> None:
        """END: close the definition.

        Raises:
            CommandError: NO PROGRAM BEING DEFINED.
        """
        if self.defining is None:
            raise CommandError(NO_PROGRAM_BEING_DEFINED)
        self.defining = None

    def abandon_definition(self) -> None:
        """Power-down in the middle of DEF: what was stored so far stays (assumed)."""
        self.defining = None

    def delete(self, name: str) -> bool:
        """DEL: remove a program; False when there is none of that name.

        Raises:
            CommandError: it is being carried out, or defined.
        """
        if self.execution.uses(name) or name == self.defining:
            raise CommandError(INVALID_CONDITIONS)
        program = self._stored.pop(name, None)
        if program is not None:
            self._used -= program.size
            self._changes.note()
        return program is not None

    def erase(self) -> None:
        """ERASE: no program is left; the caller has ended what runs."""
        self._stored.clear()
        self._used = 0
        self.defining = None
        self._changes.note()

    # Non-volatile memory.

    def snapshot(self) -> tuple[ProgramText, ...]:
        """All programs, in the order they were defined; one that has not changed is the same object as before."""
        return tuple(_kept(name, program) for name, program in self._stored.items())

    def restore(self, kept: Sequence[ProgramText]) -> list[str]:
        """Store what ``snapshot`` gave, in place of everything; what finds no room, in words."""
        self.erase()
        return [f"program {text.name}" for text in kept if not self._restore(text)]

    def _restore(self, kept: ProgramText) -> bool:
        used, program = self._used, Program()
        scaled = {line: _quantities(values) for line, values in kept.scaled}
        try:
            if len(self._stored) >= self._max_programs:
                raise CommandError(INSUFFICIENT_MEMORY)
            for line, text in enumerate(kept.lines):
                self._add(program, parse_command(text), scaled.get(line))
        except CommandError:
            self._used = used
            return False
        program.kept = kept
        self._stored[kept.name] = program
        return True

    # Carrying out.

    def prepared(self, name: str) -> Prepared:
        """A program ready to run.

        Raises:
            CommandError: UNDEFINED LABEL.
        """
        program = self._find(name)
        if program.prepared is None:
            program.prepared = prepare(program.texts, program.quantities)
        return program.prepared

    def call(self, name: str) -> None:
        """Carry a program out; inside a program this is a subroutine call.

        Raises:
            CommandError: UNDEFINED LABEL, NEST LEVEL TOO DEEP.
        """
        self.execution.call(name, self.prepared(name))

    @property
    def executing(self) -> tuple[str, str] | None:
        """Name of the program under way and the command that comes next, for TEX; a typed block is no program."""
        frame = next((frame for frame in reversed(self.execution.frames) if frame.name), None)
        if frame is None:
            return None
        following = frame.code[frame.next].command.text if frame.next < len(frame.code) else "END"
        return frame.name, following


def _kept(name: str, program: Program) -> ProgramText:
    if program.kept is None:
        program.kept = ProgramText(name, tuple(program.texts), tuple(program.scaled))
    return program.kept


def _quantities(values: Sequence[tuple[int, Number]]) -> Quantities:
    return {index: Quantity(value, factor) for index, (value, factor) in values}


def check_storable(command: Command) -> None:
    """Whether a command may stand in a program, or in a loop typed at the buffer.

    Raises:
        CommandError: it may not, this unit does not have it, or its condition cannot be read.
    """
    if command.name in NOT_STORABLE:
        raise CommandError(COMMAND_NOT_ALLOWED_IN_PROGRAM)
    if not is_implemented(command):
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    condition_of(command)


def _check_name(name: str) -> None:
    check_program_name(name)
    if is_command_name(name) or name == NO_NAME:
        raise CommandError(STRING_IS_A_COMMAND)


def name_of(command: Command) -> str:
    """The program a command names.

    Raises:
        CommandError: INCORRECT DATA when it names none.
    """
    if not command.argument:
        raise CommandError(INCORRECT_DATA)
    return command.argument.removeprefix("$")


def require_access(controller: Controller) -> None:
    """Programs may be looked at and changed: no program security, or its input is active.

    Raises:
        CommandError: ACCESS DENIED.
    """
    if controller.security_locked:
        raise CommandError(ACCESS_DENIED)


@handles("DEF")
def define(controller: Controller, command: Command) -> Lines:
    """DEF name."""
    require_access(controller)
    controller.programs.begin(name_of(command))
    return None


@handles("END")
def end(controller: Controller, command: Command) -> Lines:
    """END."""
    controller.programs.end()
    return None


@handles("DEL")
def delete(controller: Controller, command: Command) -> Lines:
    """DEL name; a name that does not exist is accepted, because scripts send DEL before DEF."""
    require_access(controller)
    name = name_of(command)
    if controller.compiled.running(name):
        raise CommandError(INVALID_CONDITIONS)
    deleted = controller.programs.delete(name)
    controller.compiled.remove(name)
    if not deleted and controller.machine.del_missing_is_error:
        raise CommandError(UNDEFINED_LABEL)
    return None


@handles("ERASE")
def erase(controller: Controller, command: Command) -> Lines:
    """ERASE: what runs ends first (assumed), but compiled motion under way keeps its segments: it is refused then."""
    require_access(controller)
    if controller.compiled.any_running:
        raise CommandError(INVALID_CONDITIONS)
    controller.compiled.clear()
    controller.interpreter.halt()
    controller.programs.erase()
    return None


@handles("RUN")
def run(controller: Controller, command: Command) -> Lines:
    """RUN name; inside a program a subroutine call."""
    controller.programs.call(name_of(command))
    return None


@handles("HALT")
def halt(controller: Controller, command: Command) -> Lines:
    """HALT: program execution ends, motion goes on (assumed H)."""
    controller.interpreter.halt()
    return None


@handles("STARTP", "ERRORP", "ONP")
def name_program(controller: Controller, command: Command) -> Lines:
    """STARTP, ERRORP, ONP: a stored program's name, CLR for none, bare to ask."""
    if command.is_query:
        return controller.settings.report(command)
    if command.argument != NO_NAME:
        controller.programs.lines(command.argument)
    controller.settings.assign(command)
    return None


@handles("MEMORY")
def divide_memory(controller: Controller, command: Command) -> Lines:
    """MEMORY programs,compiled: erases every program; bare it only reports (Gem6K PG p.22).

    Raises:
        CommandError: an odd size or a part outside its range, more than there is, motion, or a program under way.
    """
    if command.is_query:
        return controller.settings.report(command)
    require_access(controller)
    _check_sizes(controller, controller.substitute(command))
    if controller.programs.running:
        raise CommandError(INVALID_CONDITIONS)
    store_setting(controller, command)
    controller.compiled.clear()
    controller.programs.erase()
    return None


def _check_sizes(controller: Controller, command: Command) -> None:
    present = [controller.settings.integer("MEMORY", index) for index in range(2)]
    given = dict(enumerate(command.values[:2]))
    for index, value in given.items():
        if value is not None:
            present[index] = int(str(value).partition(".")[0])
            if present[index] % 2:
                raise invalid_data_field(index + 1)
    if sum(present) > controller.machine.memory.total_bytes:
        raise invalid_data_field(len(given))


@applies("MEMORY")
def apply_memory(controller: Controller, command: Command, changed: list[int]) -> None:
    """The program part of memory changed."""
    controller.programs.capacity_bytes = controller.settings.integer("MEMORY")

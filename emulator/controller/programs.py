"""Stored programs: DEF, END, DEL, the listing commands, and which program runs.

Programs keep their commands as text, as TPROG prints them, and each is read when it is carried out.  The flow commands
inside programs (IF, loops, GOTO ...) are not part of this module.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles, is_implemented
from protocol.command import Command, check_program_name, is_command_name, parse_command
from protocol.errors import (
    COMMAND_NOT_ALLOWED_IN_PROGRAM,
    COMMAND_NOT_IMPLEMENTED,
    INCORRECT_DATA,
    INSUFFICIENT_MEMORY,
    INVALID_CONDITIONS,
    NEST_LEVEL_TOO_DEEP,
    NO_PROGRAM_BEING_DEFINED,
    STRING_ALREADY_DEFINED,
    STRING_IS_A_COMMAND,
    UNDEFINED_LABEL,
    CommandError,
)
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

BYTES_PER_COMMAND = 1
"""Program memory a command takes beyond its text (assumed L)."""

NOT_STORABLE = frozenset({"DEF", "ERASE", "MEMORY", "RESET", "'", "#"})
"""Commands refused between DEF and END (assumed L)."""


@dataclass(slots=True)
class Frame:
    """A program being carried out and the command that comes next."""

    name: str
    lines: list[str]
    next_line: int = 0


class Programs:
    """The programs of one unit and the stack of those being carried out."""

    def __init__(self, *, capacity_bytes: int, max_programs: int, max_nesting: int) -> None:
        self.capacity_bytes = capacity_bytes
        self._max_programs = max_programs
        self._max_nesting = max_nesting
        self._stored: dict[str, list[str]] = {}
        self._frames: list[Frame] = []
        self.defining: str | None = None
        self.running = False
        """A program is being carried out (SS bit 3)."""
        self.channel: int | None = None
        """The connection that started what runs, and hears what it says."""

    @property
    def names(self) -> list[str]:
        """The stored programs in the order they were defined."""
        return list(self._stored)

    def lines(self, name: str) -> list[str]:
        """The commands of a program.

        Raises:
            CommandError: UNDEFINED LABEL.
        """
        try:
            return self._stored[name]
        except KeyError:
            raise CommandError(UNDEFINED_LABEL) from None

    def bytes_used(self, name: str) -> int:
        """Program memory one program takes."""
        return sum(len(line) + BYTES_PER_COMMAND for line in self._stored[name])

    @property
    def bytes_free(self) -> int:
        """Program memory left."""
        return self.capacity_bytes - sum(self.bytes_used(name) for name in self._stored)

    # Defining.

    def begin(self, name: str) -> None:
        """DEF: what follows is stored under ``name``.

        Raises:
            CommandError: the name is no name, a command, taken, or there are too many programs.
        """
        check_program_name(name)
        if is_command_name(name) or name == "CLR":
            raise CommandError(STRING_IS_A_COMMAND)
        if name in self._stored:
            raise CommandError(STRING_ALREADY_DEFINED)
        if len(self._stored) >= self._max_programs:
            raise CommandError(INSUFFICIENT_MEMORY)
        self._stored[name] = []
        self.defining = name

    def stores(self, command: Command) -> bool:
        """Whether a buffered command goes into the program being defined rather than being carried out."""
        return self.defining is not None and command.name != "END"

    def store(self, command: Command) -> None:
        """Add a command to the program being defined.

        Raises:
            CommandError: it cannot be stored, or memory is full.
        """
        if command.name in NOT_STORABLE:
            raise CommandError(COMMAND_NOT_ALLOWED_IN_PROGRAM)
        if not is_implemented(command):
            raise CommandError(COMMAND_NOT_IMPLEMENTED)
        if self.bytes_free < len(command.text) + BYTES_PER_COMMAND:
            raise CommandError(INSUFFICIENT_MEMORY)
        assert self.defining is not None
        self._stored[self.defining].append(command.text)

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
            CommandError: it is being carried out.
        """
        if any(frame.name == name for frame in self._frames):
            raise CommandError(INVALID_CONDITIONS)
        return self._stored.pop(name, None) is not None

    def erase(self) -> None:
        """ERASE: remove all programs and end what runs."""
        self.halt()
        self._stored.clear()

    # Carrying out.

    def call(self, name: str) -> None:
        """Carry a program out; inside a program this is a subroutine call.

        Raises:
            CommandError: UNDEFINED LABEL, NEST LEVEL TOO DEEP.
        """
        lines = self.lines(name)
        if len(self._frames) >= self._max_nesting:
            raise CommandError(NEST_LEVEL_TOO_DEEP)
        self._frames.append(Frame(name, list(lines)))
        self.running = True

    def next_command(self) -> Command | None:
        """The next command of what runs; None when a program has come to its end (its caller goes on)."""
        frame = self._frames[-1]
        if frame.next_line >= len(frame.lines):
            self._frames.pop()
            self.running = bool(self._frames)
            return None
        text = frame.lines[frame.next_line]
        frame.next_line += 1
        return parse_command(text)

    def halt(self) -> None:
        """End all program execution."""
        self._frames.clear()
        self.running = False

    @property
    def executing(self) -> tuple[str, str] | None:
        """Name of the program under way and the command that comes next, for TEX."""
        if not self._frames:
            return None
        frame = self._frames[-1]
        following = frame.lines[frame.next_line] if frame.next_line < len(frame.lines) else "END"
        return frame.name, following


def _name(command: Command) -> str:
    if not command.argument:
        raise CommandError(INCORRECT_DATA)
    return command.argument


@handles("DEF")
def define(controller: Controller, command: Command) -> Lines:
    """DEF name."""
    controller.programs.begin(_name(command))
    return None


@handles("END")
def end(controller: Controller, command: Command) -> Lines:
    """END."""
    controller.programs.end()
    return None


@handles("DEL")
def delete(controller: Controller, command: Command) -> Lines:
    """DEL name; a name that does not exist is accepted, because scripts send DEL before DEF."""
    if not controller.programs.delete(_name(command)) and controller.machine.del_missing_is_error:
        raise CommandError(UNDEFINED_LABEL)
    return None


@handles("ERASE")
def erase(controller: Controller, command: Command) -> Lines:
    """ERASE."""
    controller.programs.erase()
    return None


@handles("RUN", "GOSUB")
def run(controller: Controller, command: Command) -> Lines:
    """RUN name, GOSUB name."""
    controller.programs.call(_name(command))
    return None


@handles("HALT")
def halt(controller: Controller, command: Command) -> Lines:
    """HALT: program execution ends, motion goes on (assumed H)."""
    controller.programs.halt()
    return None


@handles("STARTP")
def start_up_program(controller: Controller, command: Command) -> Lines:
    """STARTP name, STARTP CLR, STARTP."""
    if command.is_query:
        return controller.settings.report(command)
    if command.argument != "CLR":
        controller.programs.lines(command.argument)
    controller.settings.assign(command)
    return None


@handles("TPROG")
def list_program(controller: Controller, command: Command) -> Lines:
    """TPROG name: each stored command on its own line."""
    return [ReplyLine("", line) for line in controller.programs.lines(_name(command))] or [ReplyLine("", "")]


@handles("TMEM")
def memory_free(controller: Controller, command: Command) -> Lines:
    """TMEM: the two memory lines (text assumed M)."""
    return memory_lines(controller)


@handles("TDIR")
def directory(controller: Controller, command: Command) -> Lines:
    """TDIR: the programs, then the memory lines (text assumed M)."""
    programs = controller.programs
    lines = [
        ReplyLine("", f"{number} - {name} USES {programs.bytes_used(name)} BYTES")
        for number, name in enumerate(programs.names, start=1)
    ]
    return [*(lines or [ReplyLine("", "NO PROGRAMS DEFINED")]), *memory_lines(controller)]


@handles("TEX")
def executing(controller: Controller, command: Command) -> Lines:
    """TEX: what is being carried out (text assumed L)."""
    found = controller.programs.executing
    if found is None:
        return [ReplyLine("", "PROGRAM NOT EXECUTING")]
    return [ReplyLine("", f"PROGRAM={found[0]} COMMAND={found[1]}")]


def memory_lines(controller: Controller) -> list[ReplyLine]:
    """Free program bytes and compiled segments; percent rounded."""
    memory = controller.machine.memory
    free, capacity = controller.programs.bytes_free, controller.programs.capacity_bytes
    segments = memory.compiled_bytes // memory.segment_bytes
    return [
        ReplyLine("", f"{free} OF {capacity} BYTES ({round(100 * free / capacity)}%) PROGRAM MEMORY REMAINING"),
        ReplyLine("", f"{segments} OF {segments} SEGMENTS (100%) COMPILED MEMORY REMAINING"),
    ]

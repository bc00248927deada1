"""The interpreter: which command is carried out when, and what the host is told about it.

Input goes to the command buffer and leaves it in order; ``!`` commands jump the queue and are carried out as they
arrive, even while the buffer waits.  The buffer waits for motion (COMEXC0), for T, for WAIT, for PS, and while a
program runs.  Every command ends with one prompt: a command that made the buffer wait gets its prompt when the wait
is over, an immediate one at once.

The states of the buffer, and what ends each:

===============  ======================================================
ready            takes the next command, from the program if one runs
waiting          ``wait.over()``, looked at after every engine event
paused           C (after PS, or after a stop under COMEXS1)
===============  ======================================================
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.controller import dispatch
from emulator.controller.waits import NEVER, MotionWait, UpdateWait, Wait
from protocol.command import Command, addressed_unit, is_immediate_text, parse_command
from protocol.errors import (
    INVALID_CONDITIONS,
    MAXIMUM_COMMAND_LENGTH_EXCEEDED,
    UNDEFINED_LABEL,
    CommandError,
)
from protocol.reply import ReplyLine
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

PROGRAM_COMMANDS_PER_UPDATE = 8
"""Commands a program carries out in one system update (assumed L: a few tenths of a millisecond each)."""

MAX_BUFFERED_CHARACTERS = 65_536
"""Characters of waiting commands of one connection beyond which more of its input stays on the wire (ours; the unit's
own buffer of 2000 bytes belongs to the timed serial line)."""


ENTRY_CHARACTERS = 8
"""What a waiting command counts beyond its text, so that a flood of empty lines is held back too (ours)."""


@dataclass(slots=True)
class Entry:
    """A command on its way through the unit: what was typed, what it was read as, and who hears the answer."""

    text: str
    command: Command | None
    error: CommandError | None
    channel: int | None
    prompted: bool

    @property
    def size(self) -> int:
        """Characters it takes in the buffer, its delimiter included: empty lines wait their turn too."""
        return len(self.text) + 1


class Interpreter:
    """The command buffer of one unit and what it is waiting for."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._prompt_per_command = controller.machine.serial.prompt_per == "command"
        self._buffer: deque[Entry] = deque()
        self._buffered_characters: Counter[int | None] = Counter()
        self._program_budget = PROGRAM_COMMANDS_PER_UPDATE
        self._waiting_entry: Entry | None = None
        self._program_entry: Entry | None = None
        self._abandoned = 0
        self.wait: Wait | None = None
        self.paused = False
        self.immediate_now = False
        self.channel: int | None = None

    # State others look at.

    @property
    def look_again_ns(self) -> int:
        """When the interpreter wants to go on by itself; NEVER while only an event or the host can make it."""
        return NEVER if self.wait is None or self.paused else self.wait.look_again_ns

    @property
    def busy(self) -> bool:
        """Something is under way that ends by itself."""
        return self.wait is not None or self._controller.programs.running

    @property
    def idle(self) -> bool:
        """Nothing waits, runs or is held: a command can be carried out as it arrives."""
        return (
            self.wait is None
            and not self._buffer
            and not self.paused
            and self._program_entry is None
            and not self._controller.programs.running
        )

    def full(self, channel: int) -> bool:
        """More commands of this connection wait than is good for memory."""
        return self._buffered_characters[channel] > MAX_BUFFERED_CHARACTERS

    # Commands coming in.

    def accept(self, text: str, channel: int, *, ends_line: bool) -> None:
        """Take one command from a connection: carry it out now if it is immediate, else queue it."""
        entry = self._read(text, channel, ends_line)
        if entry is None:
            return
        if is_immediate_text(text) if entry.command is None else entry.command.immediate:
            self._carry_out_immediate(entry)
            return
        self._enqueue(entry)

    def refuse_too_long(self, channel: int) -> None:
        """A command over the length limit takes its turn like any other and ends in an error."""
        self._enqueue(Entry("", None, CommandError(MAXIMUM_COMMAND_LENGTH_EXCEEDED), channel, prompted=True))

    def accept_empty(self, channel: int) -> None:
        """An empty line draws a prompt, in its turn."""
        self._enqueue(Entry("", None, None, channel, prompted=True))

    def _enqueue(self, entry: Entry) -> None:
        if self.idle:
            self._carry_out(entry)
            if self.wait is not None or self._controller.programs.running:
                self.run()
            return
        self._buffer.append(entry)
        self._buffered_characters[entry.channel] += entry.size
        if self.wait is None:
            self.run()

    def _read(self, text: str, channel: int, ends_line: bool) -> Entry | None:
        """The entry for a command text; None when it is for another unit of the chain."""
        prompted = ends_line or self._prompt_per_command
        try:
            command = parse_command(text)
        except CommandError as error:
            if not self._controller.answers_to(addressed_unit(text)):
                return None
            return Entry(text, None, error, channel, prompted)
        if command.address is not None and not self._controller.answers_to(command.address):
            return None
        if command.spelled != command.name and command.spelled not in self._controller.machine.aliases:
            return Entry(text, None, CommandError(UNDEFINED_LABEL), channel, prompted)
        return Entry(text, command, None, channel, prompted)

    # Carrying out.

    def run(self) -> None:
        """Carry out what the buffer (or the running program) holds until something makes it wait."""
        while not self.paused:
            if self.wait is not None:
                if not self.wait.over(self._controller):
                    return
                self._end_wait()
            if not self._step():
                return

    def _step(self) -> bool:
        """Carry out one command; False when there is nothing to do or the buffer has to wait."""
        programs = self._controller.programs
        if programs.running:
            return self._step_program()
        if self._program_entry is not None:
            entry, self._program_entry = self._program_entry, None
            self._finish(entry, None)
            return True
        if not self._buffer:
            return False
        entry = self._buffer.popleft()
        self._buffered_characters[entry.channel] -= entry.size
        self._carry_out(entry)
        return True

    def _step_program(self) -> bool:
        if self._program_budget == 0:
            self._program_budget = PROGRAM_COMMANDS_PER_UPDATE
            self.wait = UpdateWait(self._controller.engine.next_system_update_ns)
            return True
        self._program_budget -= 1
        command = self._controller.programs.next_command()
        if command is not None:
            self._carry_out(Entry(command.text, command, None, self._controller.programs.channel, prompted=False))
        return True

    def _carry_out(self, entry: Entry) -> None:
        if entry.command is None:
            self._answer_unreadable(entry)
            return
        controller = self._controller
        was_running, abandoned = controller.programs.running, self._abandoned
        self.channel = entry.channel
        try:
            if controller.programs.defining and controller.programs.stores(entry.command):
                controller.programs.store(entry.command)
                lines = None
            else:
                lines = dispatch.carry_out(controller, entry.command)
        except CommandError as error:
            self._fail(entry, error)
            return
        if self._abandoned != abandoned:
            return
        if controller.programs.running and not was_running:
            self._program_entry = entry
            controller.programs.channel = entry.channel
            self._program_budget = PROGRAM_COMMANDS_PER_UPDATE
        elif self.wait is not None and not self._prompts_at_once(self.wait):
            self._waiting_entry = entry
        else:
            self._finish(entry, lines)

    def _prompts_at_once(self, wait: Wait) -> bool:
        """Machine option: the prompt of GO does not wait for the end of the move."""
        return self._controller.machine.serial.go_prompt == "at_once" and isinstance(wait, MotionWait)

    def _carry_out_immediate(self, entry: Entry) -> None:
        """Carry a command out ahead of everything that waits; it never waits itself."""
        if entry.command is None:
            self._answer_unreadable(entry)
            return
        self.immediate_now = True
        self.channel = entry.channel
        abandoned = self._abandoned
        try:
            if entry.command.row is None or entry.command.row.immediate == "buffered":
                raise CommandError(INVALID_CONDITIONS)
            lines = dispatch.carry_out(self._controller, entry.command)
        except CommandError as error:
            self._fail(entry, error)
        else:
            if self._abandoned == abandoned:
                self._finish(entry, lines)
        finally:
            self.immediate_now = False
        self.run()

    def _answer_unreadable(self, entry: Entry) -> None:
        if entry.error is not None:
            self._fail(entry, entry.error)
        else:
            self._finish(entry, None)

    def _end_wait(self) -> None:
        self.wait = None
        self._controller.engine.clear_watches()
        self._program_budget = PROGRAM_COMMANDS_PER_UPDATE
        entry, self._waiting_entry = self._waiting_entry, None
        if entry is not None:
            self._finish(entry, None)

    def _finish(self, entry: Entry, lines: dispatch.Lines) -> None:
        framing = self._controller.framing
        data = framing.reply(lines) if lines else b""
        if entry.prompted:
            data += framing.prompt(good=True, defining=self._controller.programs.defining is not None)
        self._controller.send(data, entry.channel)

    def _fail(self, entry: Entry, error: CommandError) -> None:
        controller = self._controller
        controller.faults.bad_command(entry.text)
        controller.faults.latch(ErrorStatus.BAD_COMMAND)
        framing = controller.framing
        controller.send(framing.error(error.text) + framing.prompt(good=False), entry.channel)

    # What other commands do to the buffer.

    def wait_for(self, wait: Wait) -> None:
        """Hold the buffer; the command being carried out gets its prompt when the wait is over.  Immediate commands
        hold nothing."""
        if not self.immediate_now:
            self.wait = wait

    def start_program(self, name: str) -> None:
        """Have a program that nobody typed (STARTP) carried out next; what it says goes to everyone."""
        self._controller.programs.channel = None
        self._controller.programs.call(name)

    def say(self, lines: list[ReplyLine]) -> None:
        """Send lines that no query asked for to whoever started what runs."""
        self._controller.send(self._controller.framing.reply(lines), self.channel)

    def discard(self) -> None:
        """Empty the buffer and end program execution.

        A move under way still ends with its prompt; a dwell, a condition or a pause ends here.
        """
        self.paused = False
        self._buffer.clear()
        self._buffered_characters.clear()
        self._controller.programs.halt()
        if self.wait is not None and not isinstance(self.wait, MotionWait):
            self._end_wait()

    def abandon(self) -> None:
        """Power-down or RESET: nothing of what waits will ever be answered, the command under way included."""
        self._abandoned += 1
        self._waiting_entry = None
        self._program_entry = None
        self.discard()
        self.wait = None

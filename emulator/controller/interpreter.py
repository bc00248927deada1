"""The interpreter: which command is carried out when, and what the host is told about it.

Input goes to the command buffer and leaves it in order; ``!`` commands jump the queue and are carried out as they
arrive, even while the buffer waits.  The buffer waits for motion (COMEXC0), for T, for WAIT, for PS, and while a
program runs.  Every command ends with one prompt: a command that made the buffer wait gets its prompt when the wait
is over, an immediate one at once.

The states of the buffer, and what ends each:

===============  ======================================================
ready            takes the next command, from the program if one runs
waiting          ``wait.over()``, looked at after every engine event
paused           C (after PS, BP, or a stop under COMEXS1)
stepping         ``!#n`` (STEP1, in front of each program command)
===============  ======================================================

In each of them an error (ERRORP) or an ON condition (ONP) may put a program on top: what the buffer was waiting for is
kept with that program and comes back at its end.  Programs take turns with time: a few commands a system update.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from emulator.controller import dispatch
from emulator.controller.command_times import CommandTimes
from emulator.controller.faults import branch_abandons
from emulator.controller.motion.following.go_wait import FollowingWait
from emulator.controller.programs.execution import Cause
from emulator.controller.programs.preparation import OPENERS, Prepared
from emulator.controller.programs.runner import Runner
from emulator.controller.programs.typed_block import TypedBlock
from emulator.controller.waits import NEVER, ConditionWait, Held, MotionWait, OutputWait, UpdateWait, Wait
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

MAX_BUFFERED_CHARACTERS = 65_536
"""Characters of waiting commands of one connection beyond which more of its input stays on the wire (ours; the unit's
own buffer of 2000 bytes belongs to the timed serial line)."""


@dataclass(slots=True)
class Entry:
    """A command on its way through the unit: what was typed, what it was read as, and who hears the answer."""

    text: str
    command: Command | None
    error: CommandError | None
    channel: int | None
    prompted: bool
    taken_up: bool = False
    """Its time has begun (``[timing]``)."""

    @property
    def size(self) -> int:
        """Characters it takes in the buffer, its delimiter included: empty lines wait their turn too."""
        return len(self.text) + 1


class Interpreter:
    """The command buffer of one unit and what it is waiting for."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._buffer: deque[Entry] = deque()
        self._buffered_characters: Counter[int | None] = Counter()
        self._execution = controller.programs.execution
        self._runner = Runner(controller)
        self._block: TypedBlock | None = None
        self._waiting_entry: Entry | None = None
        self._program_entry: Entry | None = None
        self.abandoned = 0
        """How often everything under way was given up by RESET or power-down."""
        self.wait: Wait | None = None
        self.paused = False
        self._at_break_point = False
        self.immediate_now = False
        self.channel: int | None = None
        self._times = CommandTimes(controller.machine.timing)
        self._immediate_done_ns = 0
        self.careful = False
        """Commands may have to wait for their time or for the line."""
        self.mind_the_line()

    # State others look at.

    @property
    def look_again_ns(self) -> int:
        """When the interpreter wants to go on by itself; NEVER while only an event or the host can make it."""
        return NEVER if self.wait is None or self.paused else self.wait.look_again_ns

    @property
    def busy(self) -> bool:
        """Something is under way that ends by itself."""
        return self.wait is not None or self._execution.running

    @property
    def idle(self) -> bool:
        """Nothing waits, runs or is held: a command can be carried out as it arrives."""
        return (
            self.wait is None
            and not self._buffer
            and not self.paused
            and self._program_entry is None
            and not self._execution.frames
        )

    @property
    def at_break_point(self) -> bool:
        """Paused by BP (SS bit 12)."""
        return self.paused and self._at_break_point

    @property
    def due(self) -> bool:
        """Errors or ON conditions have to be looked at."""
        return self._controller.faults.pending != 0 or self._controller.on_conditions.active

    def full(self, channel: int) -> bool:
        """More commands of this connection wait than is good for memory."""
        return self._buffered_characters[channel] > MAX_BUFFERED_CHARACTERS

    @property
    def waiting_characters(self) -> int:
        """Characters of the commands that wait."""
        return sum(self._buffered_characters.values())

    def mind_the_line(self) -> None:
        """Whether commands may have to wait for the line has changed."""
        self.careful = self._times.matter or self._controller.line.may_block

    # Commands coming in.

    def accept(self, text: str, channel: int, *, ends_line: bool) -> None:
        """Take one command from a connection: carry it out now if it is immediate, else queue it.

        ``!`` before a loop or IF is for the whole block, which a host sends on one line: it goes to the buffer.
        """
        entry = self._read(text, channel, ends_line)
        if entry is None:
            return
        command = entry.command
        if command is not None and command.immediate and command.name in OPENERS:
            entry.command = replace(command, immediate=False)
        elif is_immediate_text(text) if command is None else command.immediate:
            self._take_immediate(entry)
            return
        self._enqueue(entry)

    def refuse_too_long(self, channel: int) -> None:
        """A command over the length limit takes its turn like any other and ends in an error."""
        self._enqueue(Entry("", None, CommandError(MAXIMUM_COMMAND_LENGTH_EXCEEDED), channel, prompted=True))

    def accept_empty(self, channel: int) -> None:
        """An empty line draws a prompt, in its turn."""
        self._enqueue(Entry("", None, None, channel, prompted=True))

    def _enqueue(self, entry: Entry) -> None:
        if self.idle and not self.careful:
            self._carry_out(entry)
            if self.wait is not None or self._execution.frames or self.due:
                self.run()
            return
        self._buffer.append(entry)
        self._buffered_characters[entry.channel] += entry.size
        if self.wait is None:
            self.run()

    def _read(self, text: str, channel: int, ends_line: bool) -> Entry | None:
        """The entry for a command text; None when it is for another unit of the chain."""
        prompted = ends_line or self._controller.machine.serial.prompt_per == "command"
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
        while True:
            if self.due:
                self._interrupt()
            if self.paused:
                return
            self._at_break_point = False
            if self.wait is not None:
                if not self.wait.over(self._controller):
                    return
                self._end_wait()
            if not self._step():
                return

    def _step(self) -> bool:
        """Carry on where the unit is; False when there is nothing to do or the buffer has to wait."""
        if self._execution.frames:
            return self._runner.run()
        if self._program_entry is not None:
            entry, self._program_entry = self._program_entry, None
            self._finish(entry, None)
            return True
        if not self._buffer:
            return False
        if self.careful and self._has_to_wait(self._buffer[0]):
            return True
        entry = self._buffer.popleft()
        self._buffered_characters[entry.channel] -= entry.size
        self._carry_out(entry)
        return True

    def _carry_out(self, entry: Entry) -> None:
        if entry.command is None:
            self._answer_unreadable(entry)
            return
        execution = self._execution
        was_running, abandoned = execution.running, self.abandoned
        self.channel = entry.channel
        try:
            lines = self._act(entry.command)
        except CommandError as error:
            self._fail(entry, error)
            return
        if self.abandoned != abandoned:
            return
        if execution.frames and not was_running:
            self._program_entry = entry
            execution.channel = entry.channel
        elif self.wait is not None and not self._prompts_at_once(self.wait):
            self._waiting_entry = entry
        else:
            self._finish(entry, lines)

    def _act(self, command: Command) -> dispatch.Lines:
        """A buffered command is stored, collected, or carried out."""
        programs = self._controller.programs
        if programs.stores(command):
            programs.store(command, self._controller.settings.scaled_when_stored(command))
            return None
        block = TypedBlock() if self._block is None and command.name in OPENERS else self._block
        if block is None or command.name == "END":
            return dispatch.carry_out(self._controller, command)
        complete = block.add(command)
        self._block = block if complete is None else None
        if complete is not None:
            self._execution.call("", complete)
        return None

    def _has_to_wait(self, entry: Entry) -> bool:
        """Whether the next command of the buffer cannot be carried out yet; the wait is set."""
        if self.waits_for_output(entry.channel):
            return True
        if entry.taken_up or not self._times.matter:
            return False
        entry.taken_up = True
        return self.waits_for_its_time(entry.command)

    def waits_for_output(self, channel: int | None) -> bool:
        """Wait, if so much waits to be sent to a connection that nothing may be added."""
        if not self._controller.line.blocks(channel):
            return False
        self.wait = OutputWait(channel)
        return True

    def waits_for_its_time(self, command: Command | None) -> bool:
        """Wait, if a command that is taken up now acts later."""
        now_ns = self._controller.now_ns
        done_ns = self._times.done_ns(self._controller, command, from_ns=now_ns)
        if done_ns > now_ns:
            self.turn_over(done_ns)
        return done_ns > now_ns

    def _prompts_at_once(self, wait: Wait) -> bool:
        """Machine option: the prompt of GO does not wait for the end of the move."""
        return self._controller.machine.serial.go_prompt == "at_once" and isinstance(wait, MotionWait)

    def _take_immediate(self, entry: Entry) -> None:
        """Immediate commands act as they arrive, or one after the other when they take time."""
        if self._times.matter:
            controller = self._controller
            from_ns = max(controller.now_ns, self._immediate_done_ns)
            self._immediate_done_ns = self._times.done_ns(controller, entry.command, from_ns=from_ns)
            if self._immediate_done_ns > controller.now_ns:
                controller.alarms.at(self._immediate_done_ns, lambda: self._carry_out_immediate(entry))
                return
        self._carry_out_immediate(entry)

    def _carry_out_immediate(self, entry: Entry) -> None:
        """Carry a command out ahead of everything that waits; it never waits itself."""
        if entry.command is None:
            self._answer_unreadable(entry)
            self.run()
            return
        self.immediate_now = True
        self.channel = entry.channel
        abandoned = self.abandoned
        if not self._execution.frames:
            self._execution.channel = entry.channel
        try:
            if entry.command.row is None or entry.command.row.immediate == "buffered":
                raise CommandError(INVALID_CONDITIONS)
            lines = dispatch.carry_out(self._controller, entry.command)
        except CommandError as error:
            self._fail(entry, error)
        else:
            if self.abandoned == abandoned:
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
        self._disarm()
        self.wait = None
        entry, self._waiting_entry = self._waiting_entry, None
        if entry is not None:
            self._finish(entry, None)

    def _disarm(self) -> None:
        """The engine need not watch a condition that nobody waits for any longer."""
        if isinstance(self.wait, ConditionWait | FollowingWait):
            self._controller.engine.clear_watches()

    def _finish(self, entry: Entry, lines: dispatch.Lines) -> None:
        framing = self._controller.framing
        data = framing.reply(lines) if lines else b""
        if entry.prompted:
            data += framing.prompt(good=True, defining=self._controller.programs.defining is not None)
        self._controller.send(data, entry.channel)

    def _fail(self, entry: Entry, error: CommandError) -> None:
        self.refuse(entry.text, error, entry.channel)

    def refuse(self, text: str, error: CommandError, channel: int | None) -> None:
        """A command is refused: remember it for TCMDER, set ER bit 16, tell the host."""
        controller = self._controller
        controller.faults.bad_command(text)
        controller.faults.latch(ErrorStatus.BAD_COMMAND)
        framing = controller.framing
        controller.send(framing.error(error.text) + framing.prompt(good=False), channel)

    # Programs that interrupt.

    def _interrupt(self) -> None:
        """Put the ERRORP or ONP program on top of what is under way, if one is due."""
        execution, controller = self._execution, self._controller
        if controller.faults.pending and not execution.interrupted_by(Cause.ERROR):
            self._branch_on_error()
        conditions = controller.on_conditions
        if conditions.active:
            name = controller.settings.program_name("ONP")
            free = not self.paused and not execution.interrupted_by(Cause.ERROR, Cause.CONDITION)
            may_call = free and controller.programs.exists(name)
            if conditions.take_due(controller, may_call=may_call):
                self._put_on_top(name, Cause.CONDITION)

    def _branch_on_error(self) -> None:
        """ER: GOSUB keeps what is under way, GOTO gives the programs up (settled table); without ERRORP nothing
        happens."""
        bits, abandons = self._controller.faults.take_pending()
        name = self._controller.settings.program_name("ERRORP")
        if not self._controller.programs.exists(name):
            return
        if abandons or branch_abandons(self._controller, bits):
            self._end_programs()
        self._put_on_top(name, Cause.ERROR)

    def _put_on_top(self, name: str, cause: Cause) -> None:
        if not self._execution.frames:
            self._execution.channel = self.channel
        held = Held(self.wait, self._waiting_entry, self.paused, self._at_break_point)
        self._disarm()
        self.wait, self._waiting_entry, self.paused = None, None, False
        self._execution.interrupt(name, self._controller.programs.prepared(name), cause, held)

    def forget_channel(self, channel: int) -> None:
        """A connection is gone: what its program still has to say goes to everyone."""
        if self.channel == channel:
            self.channel = None
        if self._execution.channel == channel:
            self._execution.channel = None

    def leave_program(self) -> None:
        """The innermost program has come to its end."""
        frame = self._execution.leave()
        if frame.held is not None:
            self._take_back(frame.held)
        if frame.cause is Cause.ERROR:
            self._controller.faults.branch_again()

    def _take_back(self, held: Held) -> None:
        self.wait, self._waiting_entry = held.wait, held.entry
        self.paused, self._at_break_point = held.paused, held.break_point

    def jump(self, name: str, program: Prepared, at: int) -> None:
        """JUMP: nothing that is open stays open, calls and interrupts included."""
        held = self._execution.clear()
        self._execution.call(name, program, at=at)
        if held is not None and held.entry is not None:
            self._execution.frames[0].held = held

    # What other commands do to the buffer.

    def wait_for(self, wait: Wait) -> None:
        """Hold the buffer; the command being carried out gets its prompt when the wait is over.  Immediate commands
        hold nothing."""
        if not self.immediate_now:
            self.wait = wait

    def pause(self, *, break_point: bool = False) -> None:
        """PS, BP: nothing more leaves the buffer until C."""
        self.paused, self._at_break_point = True, break_point

    def turn_over(self, until_ns: int) -> None:
        """What comes next has its turn at a time (the next system update, or when its command has had its time)."""
        self.wait = UpdateWait(until_ns)

    def start_program(self, name: str) -> None:
        """Have a program that nobody typed (STARTP) carried out next; what it says goes to everyone."""
        self._execution.channel = None
        self._controller.programs.call(name)

    def say(self, lines: list[ReplyLine]) -> None:
        """Send lines that no query asked for to whoever started what runs."""
        self._controller.send(self._controller.framing.reply(lines), self.channel)

    def end_program_wait(self) -> None:
        """What waits inside a program waits no longer; a move, and what was typed, keep the buffer."""
        if self.wait is not None and self._waiting_entry is None and not isinstance(self.wait, MotionWait):
            self._end_wait()

    def _end_programs(self) -> None:
        """Every program is given up, and what waits inside them."""
        if not self._execution.frames:
            return
        held = self._execution.clear()
        if held is not None and held.entry is not None:
            self.wait, self._waiting_entry = held.wait, held.entry
        self.end_program_wait()
        self.paused = False

    def halt(self) -> None:
        """HALT: all program execution ends, and the error that an error program was called for with it."""
        self._controller.faults.take_pending()
        self._end_programs()

    def discard(self) -> None:
        """Empty the buffer and end program execution.

        A move under way still ends with its prompt; a dwell, a condition or a pause ends here.
        """
        self._end_programs()
        self.paused = False
        self._controller.pausing.forget()
        self._controller.thumbwheels.release()
        self._block = None
        self._buffer.clear()
        self._buffered_characters.clear()
        if self.wait is not None and not isinstance(self.wait, MotionWait):
            self._end_wait()

    def abandon(self) -> None:
        """Power-down or RESET: nothing of what waits will ever be answered, the command under way included."""
        self.abandoned += 1
        self._execution.clear()
        self._waiting_entry = None
        self._program_entry = None
        self.discard()
        self.wait = None

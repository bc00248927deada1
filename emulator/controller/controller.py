"""One OEM6250: bytes in at a virtual time, bytes out stamped with virtual time.

Inside there is no wall clock, no socket, no thread and no randomness.  ``receive`` and ``advance`` first run the servo
engine to the time given, acting on everything that happens on the way; so however a session is cut into calls, the
same bytes leave at the same times.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from contextlib import AbstractContextManager
from dataclasses import replace
from typing import TYPE_CHECKING

from emulator.controller import dispatch, nonvolatile, words
from emulator.controller.alarms import Alarms
from emulator.controller.build import build_engine, build_settings, rates_in_force
from emulator.controller.changes import KEPT_COMMANDS, Changes
from emulator.controller.communications import answers_to, framing_in_force, is_neighbours_reply
from emulator.controller.compiled.store import CompiledPrograms
from emulator.controller.dispatch import handles
from emulator.controller.faults import Faults
from emulator.controller.interpreter import Interpreter
from emulator.controller.line import InstantLine, build_line
from emulator.controller.line.disturbances import Disturbances
from emulator.controller.motion.feedback import FeedbackSources
from emulator.controller.motion.following.moves import RatioMoves
from emulator.controller.motion.gain_sets import SavedGains
from emulator.controller.motion.homing import Homing
from emulator.controller.motion.jogging import Jogging
from emulator.controller.motion.joystick import Joystick
from emulator.controller.motion.pausing import Pausing
from emulator.controller.motion.stopping import end_of_travel, stop_axes
from emulator.controller.output import Output
from emulator.controller.paths.motion import Paths
from emulator.controller.programs.debugging import Debugging
from emulator.controller.programs.on_conditions import OnConditions
from emulator.controller.programs.program_select import ProgramSelect, security_locked
from emulator.controller.programs.store import Programs
from emulator.controller.registration.captures import Captures
from emulator.controller.registration.held_starts import HeldStarts
from emulator.controller.registration.registering import Registration
from emulator.controller.registration.trigger_functions import TriggerFunctions
from emulator.controller.variables.data_programs import DataPrograms
from emulator.controller.variables.operands import Operands
from emulator.controller.variables.store import Variables
from emulator.controller.variables.timers import Timer
from emulator.controller.waits import NEVER
from emulator.controller.wires.analog import Analog
from emulator.controller.wires.input_functions import InputFunctions
from emulator.controller.wires.inputs import Inputs
from emulator.controller.wires.output_functions import OutputFunctions
from emulator.controller.wires.output_on_position import OutputOnPosition
from emulator.controller.wires.panel import OperatorPanel
from emulator.controller.wires.panel_commands import DEFAULT_PASSWORD
from emulator.controller.wires.thumbwheels import Thumbwheels
from emulator.controller.wires.user_status import UserStatus
from emulator.controller.wires.wiring import Wiring
from emulator.engine import Event
from emulator.engine.machine_code import OnBuild
from emulator.machine import Machine
from protocol.command import Command, VariableReference, parse_command
from protocol.errors import CommandError
from protocol.line import XOFF, XON, LineAssembler, Token, TokenKind
from protocol.reply import Framing
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.faults.fault import Effect

AroundAction = Callable[[str, Mapping[str, float | int | bool | str]], AbstractContextManager[None]]
"""Who wants to know of actions from outside: gets name and parameters, and is entered while one is carried out."""

COMMAND_WHILE_SILENT = "E"
"""The only command a unit obeys after E0."""


class Controller:
    """One unit and everything in it; the parts are public because its command handlers work on them."""

    def __init__(self, machine: Machine, *, on_build: OnBuild | None = None) -> None:
        self.machine = machine
        self.changes = Changes()
        self.settings = build_settings(machine, self.changes)
        self.engine = build_engine(machine, self.settings, on_build)
        self.wiring = Wiring(self.engine, machine)
        self.alarms = Alarms()
        self.line = build_line(self)
        self.inputs = Inputs(self)
        self.input_functions = InputFunctions(self)
        self.output_functions = OutputFunctions(self)
        self.on_position = [OutputOnPosition(self, axis_index) for axis_index in range(self.settings.axes)]
        self.program_select = ProgramSelect(self)
        self.thumbwheels = Thumbwheels(self)
        self.analog = Analog(self)
        self.user_status = UserStatus(self)
        self.pausing = Pausing(self)
        self.panel = OperatorPanel(fitted=machine.rp240.fitted)
        self.panel_password = DEFAULT_PASSWORD
        self.faults = Faults()
        self.programs = Programs(
            capacity_bytes=machine.memory.program_bytes,
            max_programs=machine.memory.programs,
            max_nesting=machine.memory.nest_levels,
            max_labels=machine.memory.labels,
            changes=self.changes,
        )
        self.compiled = CompiledPrograms(self)
        self.debugging = Debugging()
        self.on_conditions = OnConditions()
        self.variables = Variables(
            numbers=machine.memory.var,
            patterns=machine.memory.varb,
            texts=machine.memory.vars,
            text_length=machine.memory.string_characters,
            changes=self.changes,
        )
        self.data_programs = DataPrograms(self)
        self.timer = Timer()
        self.operands = Operands(self)
        self.interpreter = Interpreter(self)
        self.framing: Framing = framing_in_force(self)
        self.echo = True
        self.listening = True
        self.chained = False
        self.powered = False
        self.outputs_watched = False
        """The servo is told of every change of the outputs, for its scope."""
        self.around_action: AroundAction | None = None
        self.disturbances = Disturbances(self.line.take)
        self.injected: dict[Hashable, Effect] = {}
        """Faults that are or were in force (``emulator.faults``)."""
        self.memory_damaged = False
        """Non-volatile memory will be found bad at the next power-up."""
        self.memory_lost = False
        """It was at the last one (SS bit 22)."""
        self.drive_faulted = [False] * self.settings.axes
        self.gain_sets: dict[int, list[SavedGains]] = {}
        self.feedback = FeedbackSources(self.settings)
        self.ratio_moves = RatioMoves(self)
        self.homing = Homing(self)
        self.jogging = Jogging(self)
        self.joystick = Joystick(self)
        self.paths = Paths(self)
        self.held_starts = HeldStarts(self)
        self.captures = Captures(self)
        self.registration = Registration(self)
        self.trigger_functions = TriggerFunctions(self)
        self._enable_lost = False
        self._lines: dict[int, LineAssembler] = {}
        self._transmitter = self.line.transmitter
        self._instant = self.line if isinstance(self.line, InstantLine) else None
        dispatch.apply_all(self)

    # The face towards the engine thread, tests and recordings.

    @property
    def now_ns(self) -> int:
        """The virtual time the unit has reached."""
        return self.engine.time_ns

    @property
    def busy(self) -> bool:
        """Motion, dwell, wait, program or debounce under way: the next output or effect may come by itself."""
        moving = any(self.engine.is_moving(axis_index) for axis_index in range(self.settings.axes))
        held_back = self.engine.time_ns < self.disturbances.next_ns < NEVER
        waits = self.alarms.pending or self.line.busy or held_back
        return moving or self.interpreter.busy or waits or self.held_starts.pending

    def input_full(self, channel: int) -> bool:
        """So many commands of this connection wait that more of its input should stay on the wire."""
        return self.interpreter.full(channel) or self.line.full(channel)

    def power_up(self) -> None:
        """Switch on: volatile settings at their defaults, sign-on sent, start-up program begun."""
        self.powered = True
        self._check_memory()
        self._start()
        self.interpreter.run()

    def power_down(self) -> None:
        """Switch off: nothing is answered, drives are off, the motors coast."""
        self._stop_everything()
        self.alarms.clear()
        self.program_select.leave()
        self.powered = False
        self._lines.clear()
        self.line.power_down()
        self.disturbances.clear()

    def receive(self, data: bytes, *, at_ns: int, channel: int, passed_on: bool = False) -> None:
        """Bytes from a connection at a virtual time (not before ``now_ns``).

        On a timed line that is when the first of them begins; ``passed_on`` says it is when it ends, because another
        unit of a chain has sent it.
        """
        if at_ns > self.engine.time_ns:
            self.advance(at_ns)
        if self.disturbances.active:
            data = self.disturbances.hear(self.engine.time_ns, data)
        if self._instant is None:
            self.line.receive(data, channel, self.line.began_ns(at_ns) if passed_on else self.engine.time_ns)
        elif self.powered:
            self._instant.received += len(data)
            if XOFF in data or XON in data:
                self._instant.hear_apart(data, channel)
            else:
                self.hear(data, channel)

    def hear(self, data: bytes, channel: int) -> None:
        """Characters have reached the unit: echo them, and act on the commands they complete."""
        line = self._lines.get(channel)
        if line is None:
            line = self._lines[channel] = LineAssembler(self.machine.serial.max_command)
        for token in line.feed(data):
            self._take(token, channel)
        if self.outputs_watched:
            self.show_outputs()

    def advance(self, until_ns: int) -> None:
        """Run to a virtual time, carrying out what becomes due on the way."""
        if self.line.holds_hosts:
            self.line.look()
        while self.engine.time_ns < until_ns:
            self.advance_to_event(until_ns)

    def advance_to_event(self, until_ns: int) -> None:
        """Run to the next thing that happens, at most to a virtual time, and carry out what is due then."""
        engine, interpreter, alarms, line = self.engine, self.interpreter, self.alarms, self.line
        look_again_ns = min(interpreter.look_again_ns, alarms.next_ns, line.next_ns)
        events = engine.run(min(until_ns, look_again_ns))
        if engine.time_ns >= alarms.next_ns:
            alarms.carry_out(engine.time_ns)
        if events:
            self._act_on(events)
            interpreter.run()
        elif engine.time_ns >= look_again_ns:
            interpreter.run()
        if self.program_select.looking:
            self.program_select.look()
        if line.holds_hosts or engine.time_ns >= line.next_ns:
            line.carry_out(engine.time_ns)
        if self.outputs_watched:
            self.show_outputs()

    def show_outputs(self) -> None:
        """Tell the servo which outputs are on."""
        self.engine.set_outputs(int(self.output_functions.bits()[::-1], 2))

    def take_output(self) -> list[Output]:
        """What has left the unit since last asked."""
        if self.disturbances.active:
            return self.disturbances.say(self.engine.time_ns)
        return self.line.take()

    def detach(self, channel: int) -> None:
        """A connection is gone: half a command of it is forgotten, everything else goes on.

        What a program it started still has to say goes to everyone.
        """
        self.line.forget(channel)

    def forget_line(self, channel: int) -> None:
        """All that a connection which is gone has sent has been heard."""
        self._lines.pop(channel, None)
        self.interpreter.forget_channel(channel)

    @property
    def half_typed(self) -> int:
        """Characters of commands that are not complete."""
        return sum(line.pending for line in self._lines.values())

    # What handlers and the interpreter use.

    def send(self, data: bytes, channel: int | None) -> None:
        """Bytes leave the unit now."""
        self._transmitter.send(self.engine.time_ns, data, channel)

    def answers_to(self, address: int | None) -> bool:
        """Whether a command with this unit address is for this unit."""
        return answers_to(self, address)

    def substitute(self, command: Command) -> Command:
        """The command with every ``(VARn)`` and ``(VARBn)`` replaced by its value.

        A VARB has more bits than most masks; those the command has no use for are cut off (assumed).

        Raises:
            CommandError: INVALID DATA for a variable the unit does not have.
        """
        if not command.substituted:
            return command
        if command.variable is not None:
            bits = self.variables.bits(command.variable.number)
            return replace(command, mask=bits[: self._mask_length(command)], variable=None, substituted=False)
        values = tuple(
            self.variables.number(value.number) if isinstance(value, VariableReference) else value
            for value in command.values
        )
        return replace(command, values=values, substituted=False)

    def _mask_length(self, command: Command) -> int:
        assert command.row is not None
        if not command.row.fields.per_axis:
            return len(words.outputs(self)) if command.name == "OUT" else command.row.fields.count
        return 1 if command.axis is not None or command.all_axes else self.settings.axes_in_use

    def setting_command(self, name: str) -> Command:
        """A setting as a bare command (what ``applies`` functions are called with at power-up)."""
        return parse_command(name)

    def query_text(self, name: str) -> str:
        """The value part of a setting's report."""
        return self.settings.report(parse_command(name))[0].value

    @property
    def security_locked(self) -> bool:
        """Program security is in force: programs may be neither looked at nor changed."""
        return security_locked(self)

    def system_update_at(self, at_ns: int) -> int:
        """The first system update at or after a time."""
        following, period = self.engine.next_system_update_ns, self.engine.rates.system_ns
        return following + max(0, -((following - at_ns) // period)) * period

    def apply_rates(self) -> None:
        """SSFR or INDAX changed."""
        self.engine.set_rates(rates_in_force(self.machine, self.settings))

    def shut_down(self, axis_index: int) -> None:
        """Assert the shutdown output of an axis: loop open, motion given up."""
        self.homing.abort(axis_index)
        self.joystick.leave(axis_index)
        self.held_starts.forget((axis_index,))
        self.registration.forget(axis_index)
        self.engine.disable(axis_index)
        self.paths.lose_axis(axis_index)
        self.note_drive(axis_index, on=False)

    def note_drive(self, axis_index: int, *, on: bool) -> None:
        """Keep the DRIVE report in step with the drive."""
        bits = list(self.settings.bits("DRIVE"))
        bits[axis_index] = "1" if on else "0"
        self.settings.store_bits("DRIVE", "".join(bits))

    def refresh_axis_bits(self, axis_index: int) -> None:
        """Put the AS bits that belong to the controller into the axis's status word."""
        modes = {
            AxisStatus.HOME_SUCCESSFUL: self.homing.successful[axis_index],
            AxisStatus.MODE_ABSOLUTE: self.settings.flag("MA", axis_index),
            AxisStatus.MODE_CONTINUOUS: self.settings.flag("MC", axis_index),
            AxisStatus.JOG_MODE: self.settings.flag("JOG", axis_index),
            AxisStatus.JOYSTICK_MODE: self.settings.flag("JOY", axis_index),
            AxisStatus.DRIVE_FAULTED: self.drive_faulted[axis_index],
            AxisStatus.GOWHEN_PENDING: self.held_starts.holds(axis_index),
            AxisStatus.REGISTRATION_MOVE_COMMANDED: self.registration.commanded(axis_index),
        }
        self.engine.set_extra_status(axis_index, sum(bit.mask for bit, on in modes.items() if on))

    def drive_fault_active(self, axis_index: int) -> bool:
        """The drive-fault input is at its active level (DRFLVL0: low)."""
        return self.wiring.drive_fault_grounded(axis_index) != self.settings.flag("DRFLVL", axis_index)

    def check_drive_faults(self) -> None:
        """Act on drive-fault inputs that are active; they are watched only with INFEN1."""
        if not self.settings.flag("INFEN"):
            return
        for axis_index in range(self.settings.axes_in_use):
            if self.drive_fault_active(axis_index) and not self.drive_faulted[axis_index]:
                self._drive_fault(axis_index)

    # Characters.

    def _take(self, token: Token, channel: int) -> None:
        if self.echo and (self.listening or self.chained):
            self._echo(token, channel)
        if self.chained and is_neighbours_reply(token.text):
            return
        kind = token.kind
        if kind is TokenKind.COMMAND:
            if self.listening or _switches_communication(token.text):
                self.interpreter.accept(token.text, channel, ends_line=token.ends_line)
        elif not self.listening:
            return
        elif kind is TokenKind.KILL:
            self.interpreter.accept(token.text, channel, ends_line=True)
        elif kind is TokenKind.TOO_LONG:
            self.interpreter.refuse_too_long(channel)
        elif kind is TokenKind.EMPTY_LINE and self.machine.serial.empty_prompt:
            self.interpreter.accept_empty(channel)

    def _echo(self, token: Token, channel: int) -> None:
        ending = b""
        if token.ends_line:
            ending = self.framing.eol if self.machine.serial.echo_terminator == "eol" else token.delimiter
        elif token.delimiter:
            ending = token.delimiter
        self.send(token.echo + ending, channel)

    # Events of the engine.

    def _act_on(self, events: Event) -> None:
        if events & Event.WIRES:
            self._check_wires()
        for axis_index in range(self.settings.axes):
            axis_events = self.engine.axis_events(axis_index)
            if axis_events:
                self._act_on_axis(axis_index, axis_events)
        self.compiled.look()

    def _act_on_axis(self, axis_index: int, events: Event) -> None:
        events = self.homing.act_on(axis_index, events)
        if events & Event.VALUE:
            self.on_position[axis_index].check()
            self.held_starts.look()
        if events & Event.TRIGGER:
            self.captures.note(axis_index)
        if events & Event.HARD_LIMIT:
            end_of_travel(self, axis_index, "LHAD", ErrorStatus.HARD_LIMIT_HIT)
        if events & Event.SOFT_LIMIT:
            end_of_travel(self, axis_index, "LSAD", ErrorStatus.SOFT_LIMIT_HIT)
        if events & Event.POSITION_ERROR:
            self.paths.lose_axis(axis_index)
            self.held_starts.forget((axis_index,))
            self.note_drive(axis_index, on=False)
            self.faults.latch(ErrorStatus.POSITION_ERROR_EXCEEDED)
        if events & Event.SETTLE_TIMEOUT:
            self.faults.latch(ErrorStatus.TARGET_ZONE_TIMEOUT)

    def _check_wires(self) -> None:
        """ENABLE and drive faults; end-of-travel inputs are watched by the servo itself."""
        was_lost, self._enable_lost = self._enable_lost, not self.wiring.enable_grounded
        if self._enable_lost and not was_lost:
            self._lose_enable()
        self.check_drive_faults()
        self.inputs.sample()
        self.joystick.refresh()

    def _lose_enable(self) -> None:
        """ENABLE opened: every drive is shut down whatever KDRIVE says, programs end (assumed M)."""
        for axis_index in range(self.settings.axes):
            self.shut_down(axis_index)
        self.faults.latch(ErrorStatus.ENABLE_INPUT_OPEN)
        self.interpreter.discard()

    def _drive_fault(self, axis_index: int) -> None:
        """An active drive-fault input shuts its drive down and stops the program (6250 UG, symptom documented)."""
        self.drive_faulted[axis_index] = True
        self.shut_down(axis_index)
        self.refresh_axis_bits(axis_index)
        self.faults.latch(ErrorStatus.DRIVE_FAULT)
        self.interpreter.discard()

    # Power.

    def reset(self) -> None:
        """RESET: as power off and on, without losing what lies in non-volatile memory."""
        self._stop_everything()
        self._start()

    def _stop_everything(self) -> None:
        stop_axes(self, range(self.settings.axes), "LHAD")
        for axis_index in range(self.settings.axes):
            self.shut_down(axis_index)
        self.interpreter.abandon()
        self.programs.abandon_definition()

    def _check_memory(self) -> None:
        self.memory_lost, self.memory_damaged = self.memory_damaged, False
        if self.memory_lost:
            nonvolatile.clear(self)

    def _start(self) -> None:
        self.settings.reset(keep=KEPT_COMMANDS)
        self.faults = Faults()
        self.on_conditions = OnConditions()
        self.timer = Timer()
        self.drive_faulted = [False] * self.settings.axes
        self._enable_lost = not self.wiring.enable_grounded
        self.compiled.clear()
        self.data_programs.reset()
        self.feedback.reset()
        self.ratio_moves.reset()
        self.homing.reset()
        self.jogging.reset()
        self.joystick.reset()
        self.paths.reset()
        self.held_starts.reset()
        self.captures.power_up()
        self.registration.reset()
        self.trigger_functions.reset()
        self._reset_inputs_and_outputs()
        self.engine.power_up()
        dispatch.apply_all(self)
        for axis_index in range(self.settings.axes):
            self.refresh_axis_bits(axis_index)
        self._enable_drives_by_default()
        if self.settings.integer("ADDR") == 0:
            self._sign_on()
        start_up = self.settings.program_name("STARTP")
        if self.programs.exists(start_up) and (self.wiring.enable_grounded or not self.machine.startp_needs_enable):
            self.interpreter.start_program(start_up)

    def _reset_inputs_and_outputs(self) -> None:
        self.alarms.clear()
        self.inputs.power_up()
        self.input_functions.power_up()
        self.output_functions.power_up()
        for on_position in self.on_position:
            on_position.power_up()
        self.thumbwheels.power_up()
        self.analog.power_up()
        self.user_status.power_up()
        self.pausing.forget()
        self.panel.power_up()

    def _enable_drives_by_default(self) -> None:
        """DRIVE1 as a power-up default of the machine file (a stepper host's unit comes up energised)."""
        for axis_index in range(self.settings.axes_in_use):
            if self.settings.flag("DRIVE", axis_index):
                if self.wiring.enable_grounded:
                    self.engine.enable(axis_index)
                else:
                    self.note_drive(axis_index, on=False)

    def _sign_on(self) -> None:
        """The power-up message keeps its asterisks at every error level."""
        framing = self.framing
        lines = framing.eol.join(line.encode("latin-1") for line in self.machine.sign_on_lines)
        self.send(framing.bot + lines + framing.eot + framing.prompt(good=True), None)


def _switches_communication(text: str) -> bool:
    try:
        return parse_command(text).name == COMMAND_WHILE_SILENT
    except CommandError:
        return False


@handles("RESET")
def reset(controller: Controller, command: Command) -> dispatch.Lines:
    """RESET."""
    controller.reset()
    return None

"""Carries out the commands of programs, a few in each system update.

A program may loop for ever: it never starves the servo, the ports or other units, because after its share of a system
update it waits for the next one, in virtual time like everything else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller import dispatch
from emulator.controller.programs.debugging import trace_line
from emulator.controller.programs.execution import Frame
from emulator.controller.programs.flow import FLOW
from emulator.controller.programs.preparation import Instruction
from protocol.errors import CommandError

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


class Runner:
    """The program side of the interpreter of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._execution = controller.programs.execution
        self._left = 0
        self._refill_ns = 0

    def run(self) -> bool:
        """Carry out program commands until something else has to be looked at; False when STEP mode holds."""
        self._refill()
        interpreter, frames, debugging = (
            self._controller.interpreter,
            self._execution.frames,
            self._controller.debugging,
        )
        while frames:
            if debugging.step and debugging.holds() and frames[-1].name:
                return False
            if self._left <= 0:
                interpreter.turn_over(self._refill_ns)
                return True
            if interpreter.careful and self._has_to_wait(frames[-1]):
                return True
            self._left -= 1
            self._next(frames[-1])
            if interpreter.wait is not None or interpreter.paused or interpreter.due:
                return True
        return True

    def _has_to_wait(self, frame: Frame) -> bool:
        """Whether the next command of a program cannot be carried out yet; the interpreter waits for it."""
        interpreter = self._controller.interpreter
        if interpreter.waits_for_output(self._execution.channel):
            return True
        if frame.taken_up == frame.next or frame.next >= len(frame.code):
            frame.taken_up = -1
            return False
        frame.taken_up = frame.next
        if interpreter.waits_for_its_time(frame.code[frame.next].command):
            return True
        frame.taken_up = -1
        return False

    def _refill(self) -> None:
        """The share of a system update is given once in it, however often the program is taken up again."""
        engine = self._controller.engine
        if engine.time_ns >= self._refill_ns:
            self._left = self._controller.machine.timing.commands_per_update
            self._refill_ns = engine.next_system_update_ns

    def _next(self, frame: Frame) -> None:
        code = frame.program.code
        if frame.next >= len(code):
            if frame.name:
                self._controller.debugging.took_step()
            self._controller.interpreter.leave_program()
            return
        instruction = code[frame.next]
        frame.next += 1
        debugging = self._controller.debugging
        if frame.name and (debugging.step or debugging.trace):
            self._show(frame, instruction)
        self._carry_out(frame, instruction)

    def _show(self, frame: Frame, instruction: Instruction) -> None:
        debugging = self._controller.debugging
        debugging.took_step()
        if debugging.trace:
            self._controller.interpreter.channel = self._execution.channel
            self._controller.interpreter.say([trace_line(frame.name, instruction.command)])

    def _carry_out(self, frame: Frame, instruction: Instruction) -> None:
        controller, interpreter = self._controller, self._controller.interpreter
        channel = interpreter.channel = self._execution.channel
        try:
            if instruction.flow:
                FLOW[instruction.flow](controller, frame, instruction)
                return
            if instruction.quantities is not None:
                dispatch.store_scaled(controller, instruction.command, instruction.quantities)
                return
            lines = dispatch.carry_out(controller, instruction.command)
        except CommandError as error:
            interpreter.refuse(instruction.command.text, error, channel)
            return
        if lines:
            controller.send(controller.framing.reply(lines), channel)

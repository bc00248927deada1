"""The flow commands inside programs: IF, the loops, GOTO and its kin.

Each is a function of the unit, the program under way and the instruction; the place of execution already stands on
the command after it.  Typed at the buffer, IF and the loops are collected up to their end and then run the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from emulator.controller.programs.execution import ENDLESS, Execution, Frame
from emulator.controller.programs.preparation import CLOSERS, NO_PARTNER, OPENERS, Instruction, Prepared
from protocol.command import Command
from protocol.condition import evaluate
from protocol.errors import INCORRECT_DATA, INVALID_CONDITIONS, UNDEFINED_LABEL, CommandError
from protocol.fields import checked_number, range_of

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

Flow = Callable[["Controller", Frame, Instruction], None]


def _holds(controller: Controller, instruction: Instruction) -> bool:
    if instruction.condition is None:
        raise CommandError(INCORRECT_DATA)
    return evaluate(instruction.condition, controller.operands.read)


def _execution(controller: Controller) -> Execution:
    return controller.programs.execution


def begin_if(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """IF: to ELSE or NIF when the condition does not hold."""
    start = frame.next - 1
    holds = _holds(controller, instruction)
    _execution(controller).open(start)
    if not holds:
        frame.next = instruction.target


def otherwise(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """ELSE at the end of the true branch: on to NIF.

    Raises:
        CommandError: there is no IF before it.
    """
    if instruction.target == NO_PARTNER:
        raise CommandError(INVALID_CONDITIONS)
    frame.next = instruction.target


def end_if(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """NIF: reached by a GOTO from outside it closes nothing and harms nothing (assumed)."""
    execution = _execution(controller)
    index = execution.find(instruction.target)
    if index is not None:
        execution.close(index)


def begin_while(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """WHILE: past NWHILE when the condition does not hold."""
    start = frame.next - 1
    if _holds(controller, instruction):
        _execution(controller).open(start)
    else:
        frame.next = instruction.target


def begin_repeat(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """REPEAT."""
    _execution(controller).open(frame.next - 1)


def begin_loop(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """L: a count of 0, or none, loops without end."""
    passes = loop_count(controller, instruction.command)
    _execution(controller).open(frame.next - 1, passes or ENDLESS)


def loop_count(controller: Controller, command: Command) -> int:
    """The count of L, 0 to 999,999,999.

    Raises:
        CommandError: INVALID DATA, INCORRECT DATA.
    """
    values = controller.substitute(command).values
    if len(values) > 1:
        raise CommandError(INCORRECT_DATA)
    row = command.row
    if row is None or not values or values[0] is None:
        return 0
    return int(checked_number(values[0], range_of(row), field=1, fields=1))


def end_while(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """NWHILE: another pass while the condition of WHILE holds."""
    index = _open_loop(controller, instruction)
    execution = _execution(controller)
    again = not execution.levels[index].leaving and _holds(controller, frame.code[instruction.target])
    _repeat_or_close(execution, frame, index, again=again)


def end_repeat(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """UNTIL: another pass until its condition holds."""
    index = _open_loop(controller, instruction)
    execution = _execution(controller)
    again = not execution.levels[index].leaving and not _holds(controller, instruction)
    _repeat_or_close(execution, frame, index, again=again)


def end_loop(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """LN: another pass while passes are left."""
    index = _open_loop(controller, instruction)
    execution = _execution(controller)
    level = execution.levels[index]
    if level.passes_left != ENDLESS:
        level.passes_left -= 1
    _repeat_or_close(execution, frame, index, again=not level.leaving and level.passes_left != 0)


def _open_loop(controller: Controller, instruction: Instruction) -> int:
    """The loop a closing command belongs to.

    Raises:
        CommandError: it is not open; the program was led into the middle of it (text assumed).
    """
    index = _execution(controller).find(instruction.target)
    if index is None or instruction.target == NO_PARTNER:
        raise CommandError(INVALID_CONDITIONS)
    return index


def _repeat_or_close(execution: Execution, frame: Frame, index: int, *, again: bool) -> None:
    if again:
        frame.next = execution.levels[index].start + 1
    else:
        execution.close(index)


def leave_loop(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """LX in a program."""
    mark_leaving(controller)


def mark_leaving(controller: Controller) -> None:
    """LX: the innermost loop ends with the present pass.

    Raises:
        CommandError: no loop is open.
    """
    for level in reversed(_execution(controller).levels):
        if level.code[level.start].flow != "IF":
            level.leaving = True
            return
    raise CommandError(INVALID_CONDITIONS)


def mark_label(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """$: a place to go to; nothing happens here."""


def go_to(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """GOTO: no return; open IFs and loops stay open."""
    _execution(controller).go_to(*find_target(controller, instruction.command.argument, frame))


def call(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """GOSUB: a label or program, and back."""
    name, program, at = find_target(controller, instruction.command.argument, frame)
    _execution(controller).call(name, program, at=at)


def jump(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """JUMP: as GOTO, and every open IF, loop and call is forgotten."""
    controller.interpreter.jump(*find_target(controller, instruction.command.argument, frame))


def leave_program(controller: Controller, frame: Frame, instruction: Instruction) -> None:
    """BREAK in a program: as if its end were reached."""
    frame.next = len(frame.code)


def find_target(controller: Controller, word: str, frame: Frame | None) -> tuple[str, Prepared, int]:
    """Where GOTO, GOSUB and JUMP lead: a label of the present program, a program, a label of any program (order
    assumed); program name, program, index.

    Raises:
        CommandError: UNDEFINED LABEL.
    """
    word = word.removeprefix("$")
    if not word:
        raise CommandError(INCORRECT_DATA)
    if frame is not None and word in frame.program.labels:
        return frame.name, frame.program, frame.program.labels[word]
    programs = controller.programs
    owner = word if programs.exists(word) else programs.owner_of_label(word)
    if owner is None:
        raise CommandError(UNDEFINED_LABEL)
    program = programs.prepared(owner)
    return owner, program, 0 if owner == word else program.labels[word]


FLOW: dict[str, Flow] = {
    "IF": begin_if,
    "ELSE": otherwise,
    "NIF": end_if,
    "WHILE": begin_while,
    "NWHILE": end_while,
    "REPEAT": begin_repeat,
    "UNTIL": end_repeat,
    "L": begin_loop,
    "LN": end_loop,
    "LX": leave_loop,
    "GOTO": go_to,
    "GOSUB": call,
    "JUMP": jump,
    "BREAK": leave_program,
    "$": mark_label,
}
"""What each flow command does inside a program."""


# Typed at the buffer, outside a program.


@handles("ELSE", "$", *OPENERS, *CLOSERS)
def out_of_place(controller: Controller, command: Command) -> Lines:
    """A flow command where nothing is open that it could belong to."""
    raise CommandError(INVALID_CONDITIONS)


@handles("GOTO", "GOSUB", "JUMP")
def branch_from_buffer(controller: Controller, command: Command) -> Lines:
    """GOTO, GOSUB, JUMP as typed: they start a program."""
    name, program, at = find_target(controller, command.argument, None)
    _execution(controller).call(name, program, at=at)
    return None


@handles("LX")
def leave_loop_now(controller: Controller, command: Command) -> Lines:
    """!LX: the loop that is being carried out ends with its present pass."""
    mark_leaving(controller)
    return None


@handles("BREAK")
def leave_program_now(controller: Controller, command: Command) -> Lines:
    """!BREAK: the program under way ends, its caller goes on; nothing under way is no error (assumed)."""
    frames = _execution(controller).frames
    if frames:
        leave_program(controller, frames[-1], Instruction(command, "BREAK"))
        controller.interpreter.end_program_wait()
    return None

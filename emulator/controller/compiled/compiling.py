"""PCOMP's way through a stored program: each command once, in order, into the builder of the program's kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.compiled.kinds import Compilation, CompiledMotion, Kind, kind_of
from protocol.errors import NO_PATH_SEGMENTS_DEFINED, NOT_ALLOWED_IN_PATH, CommandError
from protocol.fields import check_axis

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.programs.preparation import Code, Instruction


def compile_program(controller: Controller, name: str) -> CompiledMotion:
    """The compiled form of a stored program; the unit itself is not changed.

    Raises:
        CommandError: the text for what makes it impossible.
    """
    code = controller.programs.prepared(name).code
    kind = _kind_of_program(code)
    compilation = Compilation(controller, controller.settings.copy())
    builder = kind.build(compilation)
    for instruction in code:
        command = instruction.command
        check_axis(command, compilation.settings.axes_in_use)
        if kind.takes(command.name):
            builder.take(controller.substitute(command))
        elif command.name in kind.settings and not command.is_query:
            _set(compilation, instruction)
        else:
            raise CommandError(NOT_ALLOWED_IN_PATH)
    return builder.finish()


def _kind_of_program(code: Code) -> Kind:
    kinds = (kind_of(instruction.command.name) for instruction in code)
    kind = next((kind for kind in kinds if kind is not None), None)
    if kind is None:
        raise CommandError(NO_PATH_SEGMENTS_DEFINED)
    return kind


def _set(compilation: Compilation, instruction: Instruction) -> None:
    if instruction.quantities is not None:
        compilation.settings.assign_stored(instruction.command, instruction.quantities)
    else:
        compilation.settings.assign(compilation.controller.substitute(instruction.command))

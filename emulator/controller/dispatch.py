"""Which function carries out which command: handlers register themselves by name.

A handler is called with the controller and the command and returns the lines of its reply, or None.  A setting
without a handler is stored and reported straight from its catalogue row; afterwards the function registered with
``applies`` carries the new value to where it acts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from protocol.command import Command
from protocol.errors import COMMAND_NOT_IMPLEMENTED, INCORRECT_DATA, MOTION_IN_PROGRESS, CommandError
from protocol.fields import check_axis
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Quantities

Lines = Sequence[ReplyLine] | None
Handler = Callable[["Controller", Command], Lines]
Apply = Callable[["Controller", Command, list[int]], None]

_handlers: dict[str, Handler] = {}
_appliers: dict[str, Apply] = {}


def handles(*names: str) -> Callable[[Handler], Handler]:
    """Register the function that carries out these commands."""

    def register(function: Handler) -> Handler:
        for name in names:
            _handlers[name] = function
        return function

    return register


def applies(*names: str) -> Callable[[Apply], Apply]:
    """Register the function that puts these settings into force once they are stored (field indexes that changed)."""

    def register(function: Apply) -> Apply:
        for name in names:
            _appliers[name] = function
        return function

    return register


def handled_names() -> frozenset[str]:
    """The commands that have a handler of their own."""
    return frozenset(_handlers)


def is_implemented(command: Command) -> bool:
    """Whether this unit can carry the command out."""
    row = command.row
    if row is None or command.name in _handlers:
        return True
    return row.kind == "setting" and row.reply in SETTING_REPLIES


SETTING_REPLIES = frozenset({"numbers", "mask", "word", "name"})

SWITCHES_WITHOUT_FUNCTION = frozenset(
    {
        "TRANS",
    }
)
"""Settings that switch on what this unit does not do yet: their defaults are accepted, anything else is refused rather
than silently without effect."""


def carry_out(controller: Controller, command: Command) -> Lines:
    """Carry out one command and return its reply.

    Raises:
        CommandError: with the unit's text.
    """
    row = command.row
    if row is None:
        controller.programs.call(command.name)
        return None
    if row.name == "TPM" and not controller.machine.answer_tpm:
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    if row.group == "following" and not controller.machine.options.following:
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    check_axis(command, controller.settings.axes_in_use)
    if command.substituted:
        command = controller.substitute(command)
    handler = _handlers.get(row.name)
    if handler is not None:
        return handler(controller, command)
    if is_implemented(command):
        return _setting(controller, command)
    raise CommandError(COMMAND_NOT_IMPLEMENTED)


def _setting(controller: Controller, command: Command) -> Lines:
    if command.is_query:
        return controller.settings.report(command)
    if command.name in SWITCHES_WITHOUT_FUNCTION and not controller.settings.leaves_default(command):
        raise CommandError(COMMAND_NOT_IMPLEMENTED)
    store_setting(controller, command)
    return None


def store_setting(controller: Controller, command: Command) -> list[int]:
    """Store a setting and put it into force; the indexes that changed.

    Raises:
        CommandError: the value is refused, or the axis must be at rest for it.
    """
    row = command.row
    assert row is not None
    if row.at_rest:
        require_rest(controller, command)
    command = controller.substitute(command)
    changed = controller.settings.assign(command)
    _put_into_force(controller, command, changed)
    return changed


def store_scaled(controller: Controller, command: Command, quantities: Quantities) -> None:
    """Carry out a setting command of a program with the values it was stored with."""
    _put_into_force(controller, command, controller.settings.assign_stored(command, quantities))


def _put_into_force(controller: Controller, command: Command, changed: list[int]) -> None:
    apply = _appliers.get(command.name)
    if apply is not None and changed:
        apply(controller, command, changed)


def require_rest(controller: Controller, command: Command) -> None:
    """Refuse a command that needs the axes it speaks of at rest.

    Raises:
        CommandError: MOTION IN PROGRESS.
    """
    per_axis = command.row is not None and command.row.fields.per_axis
    axes = range(controller.settings.axes_in_use)
    if per_axis and command.axis is not None:
        axes = range(command.axis - 1, command.axis)
    if any(controller.engine.is_moving(axis_index) for axis_index in axes):
        raise CommandError(MOTION_IN_PROGRESS)


def apply_all(controller: Controller) -> None:
    """Put every stored setting into force (power-up)."""
    for name, apply in _appliers.items():
        count = controller.settings.field_count(name)
        apply(controller, controller.setting_command(name), list(range(count)))


def require_no_fields(command: Command) -> None:
    """Refuse fields where none belong.

    Raises:
        CommandError: INCORRECT DATA.
    """
    if command.argument:
        raise CommandError(INCORRECT_DATA)

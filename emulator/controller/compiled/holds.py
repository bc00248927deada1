"""Conditions that hold a segment of a compiled profile: GOWHEN and TRGFN between GOBUFs.

A command that makes such conditions registers with ``makes_holds``.  The profile waits for them at the velocity its
last segment ended with (at rest, if that is 0) from the time the held segment is reached; the segment begins at the
first trajectory update after ``release``.  A condition that holds already when the segment is reached delays it by no
more than that (assumed).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Protocol

from protocol.errors import NOT_ALLOWED_IN_PATH, CommandError

if TYPE_CHECKING:
    from emulator.controller.compiled.kinds import Compilation
    from emulator.controller.controller import Controller
    from protocol.command import Command


class SegmentHold(Protocol):
    """A condition a segment waits for, frozen at PCOMP; it may be waited for many times."""

    def begin(self, controller: Controller, axis_index: int, release: Callable[[], None]) -> None:
        """The segment has been reached: call ``release`` once when the condition holds, at once if it does already."""
        ...

    def cancel(self, controller: Controller, axis_index: int) -> None:
        """The profile was given up while it waited; ``release`` must not be called any more."""
        ...


MakeHolds = Callable[["Compilation", "Command"], Mapping[int, SegmentHold]]
"""From a command to the conditions of the axes it speaks of, by axis index."""

HOLDING_COMMANDS = frozenset({"GOWHEN", "TRGFN"})
"""Commands that may hold a segment."""

_makers: dict[str, MakeHolds] = {}


def makes_holds(name: str) -> Callable[[MakeHolds], MakeHolds]:
    """Register what makes the conditions of a command."""

    def register(function: MakeHolds) -> MakeHolds:
        _makers[name] = function
        return function

    return register


def holds_of(compilation: Compilation, command: Command) -> Mapping[int, SegmentHold]:
    """The conditions a command sets for the next segment of each axis.

    Raises:
        CommandError: its fields are wrong, or nothing makes holds of it.
    """
    maker = _makers.get(command.name)
    if maker is None:
        raise CommandError(NOT_ALLOWED_IN_PATH)
    return maker(compilation, command)

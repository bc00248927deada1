"""What a kind of compiled motion offers to PCOMP and PRUN, and the kinds there are.

A kind registers itself once, at import, with ``register``.  PCOMP recognises the kind of a program by the first command
in it that makes segments (GOBUF, PLIN ...), makes a builder and hands it the program's commands one by one.  Commands
of ``Kind.settings`` change a copy of the unit's settings that lives as long as the compilation: a program is compiled
with the values in force at PCOMP as its own commands change them, and the unit's settings stay as they are (assumed).
All other commands go to ``MotionBuilder.take``, if they are the kind's; the rest is NOT ALLOWED IN PATH.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings
    from protocol.command import Command


@dataclass(frozen=True, slots=True)
class Compilation:
    """What a builder works with: the unit, and the settings as the program has changed them so far."""

    controller: Controller
    settings: Settings


class MotionRun(Protocol):
    """Compiled motion under way."""

    @property
    def axes(self) -> tuple[int, ...]:
        """The axes it was started on."""
        ...

    def moves(self, axis_index: int) -> bool:
        """Whether it still has an axis: false once its last segment is over, or something else moves or stopped it."""
        ...

    @property
    def paused(self) -> bool:
        """It has been brought to rest and will be taken up again."""
        ...

    def end(self) -> None:
        """It has lost all its axes; nothing of it may act any more."""
        ...


class CompiledMotion(Protocol):
    """What PCOMP makes of a program: segments with all values frozen, ready to be started again and again."""

    @property
    def axes(self) -> tuple[int, ...]:
        """The axes it moves."""
        ...

    @property
    def segments(self) -> int:
        """Segments of compiled memory it takes."""
        ...

    def start(self, controller: Controller) -> MotionRun:
        """Start it at the next trajectory update; PRUN has made sure that its axes are ready."""
        ...


class MotionBuilder(Protocol):
    """Takes the commands of one program in turn."""

    def take(self, command: Command) -> None:
        """A command of the kind, variables already replaced by their values.

        Raises:
            CommandError: the program cannot be compiled.
        """
        ...

    def finish(self) -> CompiledMotion:
        """The program has come to its end.

        Raises:
            CommandError: the program cannot be compiled.
        """
        ...


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of compiled motion.

    ``segment_commands`` tell a program of this kind; they and ``other_commands`` go to the builder that ``build``
    makes; ``settings`` act on the settings of the compilation.
    """

    name: str
    segment_commands: frozenset[str]
    other_commands: frozenset[str]
    settings: frozenset[str]
    build: Callable[[Compilation], MotionBuilder]

    def takes(self, command_name: str) -> bool:
        """Whether a command goes to the builder."""
        return command_name in self.segment_commands or command_name in self.other_commands


_kinds: list[Kind] = []


def register(kind: Kind) -> None:
    """Make a kind of compiled motion known to PCOMP."""
    _kinds.append(kind)


def kind_of(command_name: str) -> Kind | None:
    """The kind of which a command makes segments; None for other commands."""
    return next((kind for kind in _kinds if command_name in kind.segment_commands), None)

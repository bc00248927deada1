"""What is being carried out: the stack of programs and the IFs and loops open in them.

One stack of levels serves all programs, because IF, loops and calls share the sixteen levels of nesting.  Each
program on the stack remembers where its levels begin; its end closes them.  GOTO leaves levels open (a program that
leaves loops by GOTO again and again runs out of them), JUMP closes everything.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from emulator.controller.programs.preparation import Code, Prepared
from emulator.controller.waits import Held
from protocol.errors import NEST_LEVEL_TOO_DEEP, CommandError

ENDLESS = -1
"""Passes left of a loop without count."""


class Cause(Enum):
    """Why a program is on the stack."""

    CALL = "called, run or typed"
    ERROR = "ERRORP"
    CONDITION = "ONP"


@dataclass(slots=True)
class Level:
    """An IF or a loop that is open: whose code, where it was opened, what is left of it."""

    code: Code
    start: int
    passes_left: int = ENDLESS
    leaving: bool = False


@dataclass(slots=True)
class Frame:
    """A program under way; ``name`` is empty for a block typed at the buffer."""

    name: str
    program: Prepared
    base: int
    next: int = 0
    cause: Cause = Cause.CALL
    held: Held | None = None
    """What the buffer was waiting for when an ERRORP or ONP program interrupted it."""
    taken_up: int = -1
    """The instruction whose time has begun (``[timing]``); -1 while none has."""

    @property
    def code(self) -> Code:
        """The instructions of the program."""
        return self.program.code


class Execution:
    """The programs under way, the innermost last."""

    def __init__(self, max_nesting: int) -> None:
        self._max_nesting = max_nesting
        self.frames: list[Frame] = []
        self.levels: list[Level] = []
        self.channel: int | None = None
        """The connection that started what runs, and hears what it says."""

    @property
    def running(self) -> bool:
        """A program is being carried out (SS bit 3)."""
        return bool(self.frames)

    def uses(self, name: str) -> bool:
        """Whether a program is under way."""
        return any(frame.name == name for frame in self.frames)

    def interrupted_by(self, *causes: Cause) -> bool:
        """Whether an error or condition program is under way."""
        return any(frame.cause in causes for frame in self.frames)

    # Programs.

    def call(self, name: str, program: Prepared, *, at: int = 0) -> None:
        """Put a program on the stack; what is under way goes on when it has ended.

        Raises:
            CommandError: NEST LEVEL TOO DEEP.
        """
        self._require_room()
        self.frames.append(Frame(name, program, len(self.levels), at))

    def interrupt(self, name: str, program: Prepared, cause: Cause, held: Held | None) -> None:
        """Have an error or condition program carried out now; ``held`` comes back at its end.

        Nesting does not count here: an interrupt is never lost (assumed).
        """
        self.frames.append(Frame(name, program, len(self.levels), cause=cause, held=held))

    def go_to(self, name: str, program: Prepared, at: int) -> None:
        """GOTO: the innermost program gives way to another place; its levels stay open."""
        frame = self.frames[-1]
        frame.name, frame.program, frame.next = name, program, at

    def leave(self) -> Frame:
        """The innermost program has ended; its levels close with it."""
        frame = self.frames.pop()
        del self.levels[frame.base :]
        return frame

    def clear(self) -> Held | None:
        """End everything; what the outermost interrupt had put aside."""
        held = next((frame.held for frame in self.frames if frame.held is not None), None)
        self.frames.clear()
        self.levels.clear()
        return held

    # Levels.

    def open(self, start: int, passes: int = ENDLESS) -> None:
        """An IF or loop begins in the innermost program.

        Raises:
            CommandError: NEST LEVEL TOO DEEP.
        """
        self._require_room()
        self.levels.append(Level(self.frames[-1].code, start, passes))

    def _require_room(self) -> None:
        if len(self.frames) + len(self.levels) >= self._max_nesting:
            raise CommandError(NEST_LEVEL_TOO_DEEP)

    def find(self, start: int) -> int | None:
        """The innermost open level that was opened at ``start`` of the present program; None when there is none."""
        frame = self.frames[-1]
        for index in range(len(self.levels) - 1, frame.base - 1, -1):
            level = self.levels[index]
            if level.start == start and level.code is frame.program.code:
                return index
        return None

    def close(self, index: int) -> None:
        """A level ends, and with it those left open inside it."""
        del self.levels[index:]

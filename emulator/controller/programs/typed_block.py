"""A loop or IF typed at the buffer: collected up to its end, then run like a program without a name.

Each command gets its prompt as it is collected, the last one when the block has been carried out (assumed).
"""

from __future__ import annotations

from emulator.controller.programs.preparation import CLOSERS, OPENERS, Prepared, prepare
from emulator.controller.programs.store import check_storable
from protocol.command import Command
from protocol.errors import INSUFFICIENT_MEMORY, INVALID_CONDITIONS, CommandError

BLOCK_BYTES = 2000
"""Characters a typed block may have: the unit's command buffer (assumed L)."""


class TypedBlock:
    """The commands of a block so far and what in it is still open."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._open: list[str] = []
        self._size = 0

    def add(self, command: Command) -> Prepared | None:
        """Take the next command; the whole block once it is complete.

        Raises:
            CommandError: the command cannot stand here, closes nothing, or the block is too long; it is left out.
        """
        check_storable(command)
        if command.name == "$" or (command.name in CLOSERS and self._open[-1] != CLOSERS[command.name]):
            raise CommandError(INVALID_CONDITIONS)
        if command.name not in CLOSERS and self._size + len(command.text) > BLOCK_BYTES:
            raise CommandError(INSUFFICIENT_MEMORY)
        self._texts.append(command.text)
        self._size += len(command.text) + 1
        if command.name in OPENERS:
            self._open.append(command.name)
        elif command.name in CLOSERS:
            self._open.pop()
        return None if self._open else prepare(self._texts)

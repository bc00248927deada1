"""How long commands take before they act and answer: the ``[timing]`` table of the machine file.

A buffered command, of a host or of a program, is taken up when it is its turn and acts when its time has passed, with
``at_updates`` at the system update after that.  Immediate commands do not wait for buffered ones, only for each other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.machine_tables import Timing
from protocol.command import Command

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NS_PER_US = 1000


class CommandTimes:
    """The times of one unit's commands."""

    def __init__(self, timing: Timing) -> None:
        self._usual_ns = timing.command_us * NS_PER_US
        self._of_ns = {name: time_us * NS_PER_US for name, time_us in timing.commands.items()}
        self._at_updates = timing.at_updates
        self.matter = bool(self._usual_ns or any(self._of_ns.values()) or self._at_updates)
        """Some command takes time."""

    def done_ns(self, controller: Controller, command: Command | None, *, from_ns: int) -> int:
        """When a command (None: an empty or unreadable one) acts that is taken up at a time."""
        name = command.name if command is not None and command.row is not None else ""
        done_ns = from_ns + self._of_ns.get(name, self._usual_ns)
        return controller.system_update_at(done_ns) if self._at_updates else done_ns

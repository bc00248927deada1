"""The serial line at the unit's end: how long characters take, where they wait, who may stop whom.

Without a speed the line is instant: what arrives is acted on at once, what is said has been heard, and nothing is ever
lost.  With a speed every character takes its time in each direction, waits in a buffer that can fill, and XON/XOFF work
both ways.  All of it in virtual time, like everything inside a controller.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from emulator.controller.line.instant import InstantLine
from emulator.controller.line.timed import TimedLine
from protocol.command import Command

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

__all__ = ["InstantLine", "Line", "TimedLine", "build_line"]

Line = InstantLine | TimedLine


def build_line(controller: Controller) -> Line:
    """The line the machine file asks for."""
    return TimedLine(controller) if controller.machine.serial.baud else InstantLine(controller)


@applies("XONOFF")
def apply_handshake(controller: Controller, command: Command, changed: list[int]) -> None:
    """XONOFF acts on the next character; XONOFF0 lets go of a transmitter that a host has stopped."""
    controller.line.set_handshake(controller.settings.host_flag("XONOFF"))

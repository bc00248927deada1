"""What the command buffer can be waiting for: each wait knows whether it is over, and when at the latest to look.

The interpreter holds at most one; while it does, buffered commands stay where they are and immediate ones go on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from protocol.condition import Condition, evaluate
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.interpreter import Entry
    from emulator.controller.motion.following.cycles import CycleStart

NEVER = 1 << 62
"""A virtual time that does not come."""


class Wait(Protocol):
    """Something that holds the command buffer."""

    def over(self, controller: Controller) -> bool:
        """Whether the buffer may go on now."""
        ...

    @property
    def look_again_ns(self) -> int:
        """When to look again if no event of the engine comes first."""
        ...

    @property
    def status_bit(self) -> SystemStatus | None:
        """The SS bit that shows this wait."""
        ...


@dataclass(frozen=True, slots=True)
class MotionWait:
    """COMEXC0: until the commanded motion of these axes is over and, with STRGTE1, settled or timed out.

    Motion that GOWHEN holds back is still to come (assumed: GOWHEN itself does not hold the buffer, its GO does).
    """

    axes: tuple[int, ...]
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = None

    def over(self, controller: Controller) -> bool:
        engine = controller.engine
        if any(engine.is_moving(axis) or engine.is_settling(axis) for axis in self.axes):
            return False
        return not any(controller.held_starts.holds(axis) for axis in self.axes)


@dataclass(frozen=True, slots=True)
class Dwell:
    """T: until a virtual time."""

    look_again_ns: int
    status_bit: SystemStatus | None = SystemStatus.DWELL_IN_PROGRESS

    def over(self, controller: Controller) -> bool:
        return controller.now_ns >= self.look_again_ns


@dataclass(frozen=True, slots=True)
class ConditionWait:
    """WAIT: until a condition holds, looked at whenever an operand in it can have changed.

    ``cycles`` holds, by axis index, the master cycle that PMAS counts from.
    """

    condition: Condition
    cycles: Mapping[int, CycleStart]
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = SystemStatus.WAIT_ACTIVE

    def over(self, controller: Controller) -> bool:
        if evaluate(self.condition, controller.operands.reader(self.cycles)):
            return True
        controller.operands.arm_watches(self.condition, self.cycles)
        return False


@dataclass(frozen=True, slots=True)
class UpdateWait:
    """A program has done what it may in this system update."""

    look_again_ns: int
    status_bit: SystemStatus | None = None

    def over(self, controller: Controller) -> bool:
        return controller.now_ns >= self.look_again_ns


@dataclass(frozen=True, slots=True)
class OutputWait:
    """What a connection is to hear cannot leave: its XOFF, or a slow line, has filled the output buffer."""

    channel: int | None
    look_again_ns: int = NEVER
    status_bit: SystemStatus | None = None

    def over(self, controller: Controller) -> bool:
        return not controller.line.blocks(self.channel)


@dataclass(frozen=True, slots=True)
class Held:
    """What the buffer was waiting for when a program interrupted it, and the command that gets its prompt then."""

    wait: Wait | None
    entry: Entry | None
    paused: bool
    break_point: bool

"""One axis of a profile while PCOMP reads it: its segments over time, or over master travel if it is a slave."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from emulator.controller.compiled.axis_builder import AxisBuilder
from emulator.controller.compiled.holds import SegmentHold
from emulator.controller.compiled.marks import Marks
from emulator.controller.compiled.profile import AxisProfile
from emulator.controller.settings import Settings
from protocol.errors import ends_moving

SEGMENTS_EACH = 1
"""Segments of compiled memory that a GOBUF, PLOOP, PLN or POUT takes on each axis it is for (assumed L)."""


class ProfileAxis(ABC):
    """What GOBUF, PLOOP, PLN and what stands before a GOBUF do to one axis.

    ``ends_at_rest``, ``outputs`` and ``hold`` hold for the next GOBUF only.
    """

    def __init__(self, axis_index: int, builder: AxisBuilder[Any, Any, Any]) -> None:
        self.axis_index = axis_index
        self.builder = builder
        self.ends_at_rest = False
        self.outputs: str | None = None
        self.hold: SegmentHold | None = None
        self.direction = 0
        self.segments = 0
        self._last_is_preset = False

    @abstractmethod
    def add_segment(self, settings: Settings, marks: Marks, *, ends_at_rest: bool) -> int:
        """A segment made of the settings in force; its direction.  Raises what planning raises."""

    @abstractmethod
    def profile(self) -> AxisProfile:
        """All segments."""

    def switch_outputs(self, pattern: str) -> None:
        """POUT: outputs at the beginning of the next segment."""
        self.outputs = pattern
        self.segments += SEGMENTS_EACH

    def gobuf(self, settings: Settings) -> None:
        """GOBUF: the next segment."""
        marks, ends_at_rest = Marks(self.outputs, self.hold), self.ends_at_rest
        self.outputs, self.hold, self.ends_at_rest = None, None, False
        direction = self.add_segment(settings, marks, ends_at_rest=ends_at_rest)
        self.direction = self.direction or direction
        self._last_is_preset = not settings.flag("MC", self.axis_index)

    def finish(self) -> AxisProfile:
        """END.

        Raises:
            CommandError: MOTION ENDS IN NON-ZERO VELOCITY, or an open loop.
        """
        self.builder.finish()
        if self._last_is_preset and self.builder.ends_moving:
            raise ends_moving(self.axis_index + 1)
        return self.profile()

"""Compiled individual-axis profiles, and what they are while they run."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from emulator.controller.compiled.marks import Held, Marks, Over
from emulator.controller.motion.go import may_start
from emulator.controller.wires.outputs import switch_outputs

if TYPE_CHECKING:
    from emulator.controller.compiled.holds import SegmentHold
    from emulator.controller.controller import Controller

OUTPUTS_AHEAD = (3, 4)
"""Outputs switch at the system update before which their segment begins less than this share of a period later: from
1.5 ms before to 0.5 ms after it at a period of 2 ms (6000 PG p.160; the share is inferred)."""


class Motion(Protocol):
    """One axis of a profile under way in the servo."""

    def in_force(self) -> bool:
        """Whether it moves the axis: it has neither ended nor been replaced."""
        ...

    def resume(self) -> None:
        """Leave the endless piece it waits in."""
        ...


class AxisProfile(Protocol):
    """The compiled profile of one axis."""

    @property
    def axis_index(self) -> int:
        """The axis."""
        ...

    @property
    def direction(self) -> int:
        """Which way its first motion goes: 1, -1, or 0 for none."""
        ...

    def start(self, controller: Controller, on_mark: Callable[[int, object], None]) -> Motion:
        """Start it; ``on_mark`` gets the time and the marks of pieces ahead of their beginning."""
        ...


class CompiledProfile:
    """The profiles of a program, each axis on its own."""

    def __init__(self, profiles: tuple[AxisProfile, ...], segments: int) -> None:
        self._profiles = profiles
        self.segments = segments
        self.axes = tuple(profile.axis_index for profile in profiles)

    def start(self, controller: Controller) -> ProfileRun:
        """Start every axis that no limit holds back."""
        free = [profile for profile in self._profiles if may_start(controller, profile.axis_index, profile.direction)]
        return ProfileRun({profile.axis_index: AxisRun(controller, profile) for profile in free})


class ProfileRun:
    """A program's profiles under way."""

    def __init__(self, runs: dict[int, AxisRun]) -> None:
        self._runs = runs
        self.axes = tuple(runs)

    def moves(self, axis_index: int) -> bool:
        """Whether a profile still has its axis."""
        return axis_index in self._runs and self._runs[axis_index].moves

    def end(self) -> None:
        """No condition is waited for any longer."""
        for run in self._runs.values():
            run.end()


class AxisRun:
    """One axis under way: switches outputs, waits for conditions, and knows when the last segment is over."""

    def __init__(self, controller: Controller, profile: AxisProfile) -> None:
        self._controller = controller
        self._axis_index = profile.axis_index
        self._over = False
        self._waits_for: SegmentHold | None = None
        self._motion: Motion | None = None
        self._motion = profile.start(controller, self._note)

    @property
    def moves(self) -> bool:
        """Whether the profile has the axis and its last segment is not over."""
        return not self._over and self._motion is not None and self._motion.in_force()

    def end(self) -> None:
        """Wait for nothing any more."""
        if self._waits_for is not None:
            self._waits_for.cancel(self._controller, self._axis_index)
            self._waits_for = None

    def _note(self, begins_ns: int, mark: object) -> None:
        due_ns = begins_ns
        if isinstance(mark, Marks):
            share, whole = OUTPUTS_AHEAD
            due_ns += 1 - share * self._controller.engine.rates.system_ns // whole
        at_ns = system_update_near(self._controller, due_ns)
        self._controller.alarms.at(at_ns, lambda: self._act_on(mark))

    def _act_on(self, mark: object) -> None:
        if not self.moves:
            return
        if isinstance(mark, Marks) and mark.outputs is not None:
            switch_outputs(self._controller, mark.outputs)
        elif isinstance(mark, Held):
            self._waits_for = mark.hold
            mark.hold.begin(self._controller, self._axis_index, self._release)
        elif isinstance(mark, Over):
            self._over = True

    def _release(self) -> None:
        self._waits_for = None
        if self.moves and self._motion is not None:
            self._motion.resume()


def system_update_near(controller: Controller, at_ns: int) -> int:
    """The first system update at or after a time; this moment if that has been already."""
    engine = controller.engine
    following, period = engine.next_system_update_ns, engine.rates.system_ns
    return max(engine.time_ns, following - (following - at_ns) // period * period)

"""Compiled individual-axis profiles, and what they are while they run."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from emulator.controller.compiled.marks import Held, Marks, Over
from emulator.controller.motion.go import allow_motion
from emulator.controller.wires.outputs import switch_outputs
from protocol.errors import AXES_NOT_READY, CommandError

if TYPE_CHECKING:
    from emulator.controller.compiled.holds import SegmentHold
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings


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

    @property
    def follows(self) -> bool:
        """It is a slave's."""
        ...

    def start(self, controller: Controller, act_at: Callable[[int, object], None]) -> Motion:
        """Start it; ``act_at`` is told of every mark and the time from which it is to be acted on."""
        ...


def is_slave(settings: Settings, axis_index: int) -> bool:
    """Whether an axis moves over master travel and not in time."""
    return settings.flag("FOLEN", axis_index)


class CompiledProfile:
    """The profiles of a program, each axis on its own."""

    def __init__(self, profiles: tuple[AxisProfile, ...], segments: int) -> None:
        self._profiles = profiles
        self.segments = segments
        self.axes = tuple(profile.axis_index for profile in profiles)

    def start(self, controller: Controller) -> ProfileRun:
        """Start every axis that no limit holds back.

        Raises:
            CommandError: AXES NOT READY, a slave's profile without Following enabled or the other way round (assumed).
        """
        for profile in self._profiles:
            if profile.follows != is_slave(controller.settings, profile.axis_index):
                raise CommandError(AXES_NOT_READY)
        free = [
            profile for profile in self._profiles if allow_motion(controller, profile.axis_index, profile.direction)
        ]
        return ProfileRun({profile.axis_index: AxisRun(controller, profile) for profile in free})


class ProfileRun:
    """A program's profiles under way."""

    def __init__(self, runs: dict[int, AxisRun]) -> None:
        self._runs = runs
        self.axes = tuple(runs)

    def moves(self, axis_index: int) -> bool:
        """Whether a profile still has its axis."""
        return axis_index in self._runs and self._runs[axis_index].moves

    @property
    def paused(self) -> bool:
        """Never: after a pause a profile does not go on (assumed)."""
        return False

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

    def _note(self, due_ns: int, mark: object) -> None:
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

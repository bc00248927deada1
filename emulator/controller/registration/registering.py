"""Registration: a trigger in the middle of a move starts another one, measured from where the axis was at the edge.

The page is missing; from the reference's summary: REGA and REGB set the distance and keep the ramps and velocity in
force when they are entered; a trigger with function H starts the move on every axis with RE1 that is moving after GO.
Assumed where it is silent: the position it is measured from is that of the selected feedback; it goes on in the
direction of the motion; a distance of 0 is none; REGLOD counts from where the axis was at GO; a registration move may
be registered again (REGSS0); after S, K or a limit a trigger starts nothing until the next GO.

The trigger is acted on at the next system update and the move begins with the trajectory update after it; where it ends
is exact all the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_DOWN
from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from emulator.controller.motion.go import ramps
from emulator.engine import InvalidSCurve, Segments, TargetOvershot, plan_preset
from emulator.engine.encoder import ANI_SOURCE
from protocol.command import Command
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

DISTANCES = ("REGA", "REGB")
"""The setting of each trigger."""


@dataclass(frozen=True, slots=True)
class RegistrationMove:
    """What REGA or REGB has frozen, in counts."""

    distance_counts: int
    velocity_counts_s: float
    ramps: tuple[float, float, float, float]


@dataclass(slots=True)
class Watched:
    """A move started by GO that triggers may change."""

    from_counts: int
    registered: bool = False
    over: bool = False


class Registration:
    """The registration moves of one unit."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._moves: dict[tuple[int, int], RegistrationMove] = {}
        self._watched: dict[int, Watched] = {}

    def reset(self) -> None:
        """Power-up: no distance, no move."""
        self._moves.clear()
        self._watched.clear()

    def define(self, trigger_index: int, axis_index: int) -> None:
        """REGA or REGB was entered: keep what makes the move."""
        settings = self._controller.settings
        distance = settings.counts(DISTANCES[trigger_index], axis_index).to_integral_value(ROUND_DOWN)
        self._moves[trigger_index, axis_index] = RegistrationMove(
            int(distance), float(settings.counts("V", axis_index)), ramps(self._controller, axis_index)
        )

    def commanded(self, axis_index: int) -> bool:
        """A trigger has started a registration move since the last GO (AS bit 28)."""
        return axis_index in self._watched and self._watched[axis_index].registered

    def watch(self, axis_index: int) -> None:
        """GO starts the axis: triggers count from here."""
        self._watched[axis_index] = Watched(self._controller.engine.feedback_position(axis_index))
        self._controller.refresh_axis_bits(axis_index)

    def capture(self, trigger_index: int) -> None:
        """A trigger has latched positions: start what it registers."""
        for axis_index in range(self._controller.settings.axes_in_use):
            if self._may_register(trigger_index, axis_index):
                self._register(trigger_index, axis_index)

    def _may_register(self, trigger_index: int, axis_index: int) -> bool:
        controller = self._controller
        watched, move = self._watched.get(axis_index), self._moves.get((trigger_index, axis_index))
        if watched is None or watched.over or move is None or move.distance_counts == 0:
            return False
        settings = controller.settings
        if controller.homing.active(axis_index) or settings.flag("JOG", axis_index) or settings.flag("JOY", axis_index):
            return False
        if not settings.flag("RE", axis_index) or not controller.engine.is_moving(axis_index):
            return False
        if watched.registered and settings.flag("REGSS", axis_index):
            return False
        travelled = abs(self._captured(trigger_index, axis_index) - watched.from_counts)
        return travelled >= settings.counts("REGLOD", axis_index)

    def _captured(self, trigger_index: int, axis_index: int) -> int:
        """Where the selected feedback was."""
        captured = self._controller.engine.captured_positions(trigger_index, axis_index)
        by_ani = self._controller.settings.integer("SFB", axis_index) == ANI_SOURCE
        return captured.ani if by_ani else captured.encoder

    def _register(self, trigger_index: int, axis_index: int) -> None:
        engine = self._controller.engine
        try:
            segments = self._plan(trigger_index, axis_index)
        except (TargetOvershot, InvalidSCurve, ValueError):
            engine.latch_status(axis_index, AxisStatus.PRESET_MOVE_OVERSHOT.mask)
            self._controller.faults.latch(ErrorStatus.PRESET_MOVE_OVERSHOT)
            return
        engine.start_profile(axis_index, segments)
        self._watched[axis_index].registered = True
        self._controller.refresh_axis_bits(axis_index)

    def _plan(self, trigger_index: int, axis_index: int) -> Segments:
        """The move from the present motion to the captured position and the distance.

        Raises:
            TargetOvershot: the braking distance is longer.
            InvalidSCurve, ValueError: ramps or velocity that make no move.
        """
        move, state = self._moves[trigger_index, axis_index], self._controller.engine.profile_state(axis_index)
        direction = -1 if (state.velocity or state.acceleration) < 0 else 1
        target = self._captured(trigger_index, axis_index) + direction * move.distance_counts
        return plan_preset(state.position, state.velocity, target, move.velocity_counts_s, *move.ramps)

    def forget(self, axis_index: int) -> None:
        """Stopped, killed or shut down: triggers start nothing until the next GO; AS bit 28 stays until then."""
        if axis_index in self._watched:
            self._watched[axis_index].over = True


@applies(*DISTANCES)
def apply_distance(controller: Controller, command: Command, changed: list[int]) -> None:
    """REGA, REGB: the move is made of what is in force now."""
    for axis_index in changed:
        controller.registration.define(DISTANCES.index(command.name), axis_index)

"""Motion under an operator's hand: an axis in jog or joystick mode runs at a velocity that changes as it goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.faults import clear_without_cause
from emulator.controller.motion.go import CLEARED_BY_LEGAL_GO, OPEN_LOOP, ramps
from emulator.controller.motion.limits import limit_in_the_way
from emulator.engine import plan_continuous
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def run_at(controller: Controller, axis_index: int, velocity_counts_s: float, family: str) -> None:
    """Change to a velocity (0: to rest) with the ramps of a family, JOG or JOY; never into an active limit.

    Without a drive that is on, or in open loop, nothing moves and nobody is told: no command asked for it (assumed).
    """
    engine = controller.engine
    if not engine.is_enabled(axis_index) or controller.settings.integer("SFB", axis_index) == OPEN_LOOP:
        return
    direction = (velocity_counts_s > 0) - (velocity_counts_s < 0)
    hit = limit_in_the_way(controller, axis_index, direction)
    if hit is not None:
        engine.latch_status(axis_index, hit.axis_bit.mask)
        controller.faults.latch(hit.error_bit)
    elif direction:
        engine.clear_status(axis_index, CLEARED_BY_LEGAL_GO)
        clear_without_cause(controller, ErrorStatus.HARD_LIMIT_HIT, ErrorStatus.SOFT_LIMIT_HIT)
        _start(controller, axis_index, velocity_counts_s, family)
    elif engine.is_moving(axis_index):
        _start(controller, axis_index, 0.0, family)


def _start(controller: Controller, axis_index: int, velocity_counts_s: float, family: str) -> None:
    state = controller.engine.profile_state(axis_index)
    segments = plan_continuous(
        state.position, state.velocity, velocity_counts_s, *_ramps(controller, axis_index, family)
    )
    controller.engine.start_profile(axis_index, segments)


def _ramps(controller: Controller, axis_index: int, family: str) -> tuple[float, float, float, float]:
    """The ramps in force; an average changed to outside the S-curve rule since the mode began is left out (assumed)."""
    up, down, average_up, average_down = ramps(controller, axis_index, family)
    return up, down, _average(up, average_up), _average(down, average_down)


def _average(maximum: float, average: float) -> float:
    return average if maximum <= 2 * average <= 2 * maximum else maximum


def in_mode(controller: Controller, name: str, axis_index: int) -> bool:
    """Whether an axis is in a mode, JOG or JOY."""
    return controller.settings.flag(name, axis_index)


def set_mode(controller: Controller, name: str, axis_index: int, *, on: bool) -> None:
    """Enter or leave a mode; AS bit 8 or 9 follows."""
    bits = list(controller.settings.bits(name))
    bits[axis_index] = "1" if on else "0"
    controller.settings.store_bits(name, "".join(bits))
    controller.refresh_axis_bits(axis_index)

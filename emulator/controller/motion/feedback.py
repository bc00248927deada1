"""Feedback sources: SFB, the settings that each source has of its own, and the polarities.

Gains count in the units of their sensor, a count of the encoder or one of the ANI converter, so each source keeps its
own gains, SMPER, SOFFS and soft limits (OEM6250 IG p.38; soft limits and PSET offset assumed).  What the commands set
and report is always what belongs to the source in force; the other source's values wait here.  Open loop has no set of
its own and shows the encoder's (assumed).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.dispatch import applies
from emulator.controller.motion.limits import apply_soft_limits
from emulator.controller.motion.servo import (
    GAIN_COMMANDS,
    apply_gains,
    apply_output,
    apply_position_error_limit,
    apply_target_zone,
)
from emulator.controller.scaling import Quantity
from protocol.command import Command

if TYPE_CHECKING:
    from emulator.controller.controller import Controller
    from emulator.controller.settings import Settings

OPEN_LOOP, ENCODER, ANI = 0, 1, 2
"""SFB codes."""

SOURCES_WITH_SETTINGS = (ENCODER, ANI)

KEPT_PER_SOURCE = (*GAIN_COMMANDS, "SOFFS", "SMPER", "LSPOS", "LSNEG")
"""Settings that each feedback source has of its own; the PSET offset, which is no setting, the servo keeps."""


def source_of_settings(sfb: int) -> int:
    """The source whose settings are in force with an SFB code."""
    return ENCODER if sfb == OPEN_LOOP else sfb


class FeedbackSources:
    """The settings of the feedback sources of a unit's axes."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._values: dict[tuple[int, int], dict[str, Quantity]] = {}
        self._in_force: list[int] = []
        self.reset()

    def reset(self) -> None:
        """Power-up: every source of an axis has the axis's power-up values."""
        axes = range(self._settings.axes)
        self._values = {(axis, source): self._present(axis) for axis in axes for source in SOURCES_WITH_SETTINGS}
        self._in_force = [source_of_settings(self._settings.integer("SFB", axis)) for axis in axes]

    def select(self, axis_index: int) -> bool:
        """SFB of an axis was set: bring its source's settings into force; False if they already are."""
        source = source_of_settings(self._settings.integer("SFB", axis_index))
        if source == self._in_force[axis_index]:
            return False
        self._values[axis_index, self._in_force[axis_index]] = self._present(axis_index)
        self._in_force[axis_index] = source
        for name, quantity in self._values[axis_index, source].items():
            self._settings.store(name, axis_index, quantity)
        return True

    def _present(self, axis_index: int) -> dict[str, Quantity]:
        return {name: self._settings.setting(name, axis_index) for name in KEPT_PER_SOURCE}


@applies("SFB")
def apply_feedback(controller: Controller, command: Command, changed: list[int]) -> None:
    """Feedback source: the commanded position takes over the new feedback, the source's settings come into force.

    STRGTV is put into force anew because its unit, revolutions or volts a second, is that of the source.
    """
    for axis_index in changed:
        controller.engine.set_feedback(axis_index, controller.settings.integer("SFB", axis_index))
    swapped = [axis_index for axis_index in changed if controller.feedback.select(axis_index)]
    for apply in (apply_gains, apply_output, apply_position_error_limit, apply_soft_limits, apply_target_zone):
        apply(controller, command, swapped)


@applies("ENCPOL", "CMDDIR", "ANIPOL")
def apply_polarity(controller: Controller, command: Command, changed: list[int]) -> None:
    """Polarity of the encoder, of the command with every feedback, and of the ANI input."""
    for axis_index in changed:
        controller.engine.set_polarity(
            axis_index,
            encoder=int(controller.settings.flag("ENCPOL", axis_index)),
            command=int(controller.settings.flag("CMDDIR", axis_index)),
            ani=int(controller.settings.flag("ANIPOL", axis_index)),
        )

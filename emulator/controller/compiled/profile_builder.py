"""Individual-axis profiles: what PCOMP makes of a program of GOBUFs, and the refusal of their commands elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from emulator.controller.compiled.blending import CannotBlend
from emulator.controller.compiled.holds import HOLDING_COMMANDS, holds_of
from emulator.controller.compiled.kinds import Compilation, Kind, register
from emulator.controller.compiled.loops import Unsteady
from emulator.controller.compiled.profile import CompiledProfile, is_slave
from emulator.controller.compiled.profile_axis import SEGMENTS_EACH, ProfileAxis
from emulator.controller.compiled.ratio_axis import RatioAxis
from emulator.controller.compiled.timed_axis import TimedAxis
from emulator.controller.dispatch import Lines, handles
from emulator.controller.motion.go import named_axes
from emulator.controller.wires.outputs import output_pattern
from emulator.engine.ratio_profile import DistanceMismatch
from protocol.command import Command
from protocol.errors import (
    INCORRECT_DATA,
    MASTER_SLAVE_DISTANCE_MISMATCH,
    NOT_DEFINING_A_PATH,
    CommandError,
    invalid_conditions,
)
from protocol.fields import checked_number, place_values, range_of

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

PROFILE_SETTINGS = frozenset({"A", "AA", "AD", "ADA", "V", "D", "MA", "MC", "FOLRN", "FOLRD", "FOLMD"})
"""Settings that may change between the segments of a profile (assumed)."""

AXIS_OUTPUTS = {"POUTA": 0, "POUTB": 1}


class ProfileBuilder:
    """The profiles of a program, axis by axis."""

    def __init__(self, compilation: Compilation) -> None:
        self._compilation = compilation
        self._controller = compilation.controller
        self._settings = compilation.settings
        self._axes: dict[int, ProfileAxis] = {}
        self._with_segments: set[int] = set()
        self._outputs: str | None = None

    def take(self, command: Command) -> None:
        """One of the profile's own commands."""
        name = command.name
        if name == "GOBUF":
            self._gobuf(command)
        elif name == "PLOOP":
            self._open_loops(command)
        elif name == "PLN":
            self._close_loops(command)
        elif name in ("POUT", *AXIS_OUTPUTS):
            self._switch_outputs(command)
        elif name in HOLDING_COMMANDS:
            for axis_index, hold in holds_of(self._compilation, command).items():
                self._axis(axis_index).hold = hold
        else:
            self._end_at_rest(command)

    def finish(self) -> CompiledProfile:
        """The whole program."""
        used = [self._axes[axis_index] for axis_index in sorted(self._with_segments)]
        return CompiledProfile(tuple(axis.finish() for axis in used), sum(axis.segments for axis in used))

    def _axis(self, axis_index: int) -> ProfileAxis:
        if axis_index not in self._axes:
            kind = RatioAxis if is_slave(self._settings, axis_index) else TimedAxis
            self._axes[axis_index] = kind(self._controller, axis_index)
        return self._axes[axis_index]

    def _named(self, command: Command) -> list[int]:
        named = named_axes(self._controller, command)
        return list(range(self._settings.axes_in_use)) if named is None else named

    def _gobuf(self, command: Command) -> None:
        for axis_index in self._named(command):
            axis = self._axis(axis_index)
            if self._outputs is not None:
                axis.switch_outputs(self._outputs)
                self._outputs = None
            with refusals(axis_index):
                axis.gobuf(self._settings)
            self._with_segments.add(axis_index)
            axis.segments += SEGMENTS_EACH

    def _open_loops(self, command: Command) -> None:
        for axis_index, passes in _passes(command, self._settings.axes_in_use).items():
            axis = self._axis(axis_index)
            axis.builder.open_loop(passes)
            axis.segments += SEGMENTS_EACH

    def _close_loops(self, command: Command) -> None:
        named = self._named(command)
        if command.is_query and command.axis is None:
            named = [axis_index for axis_index in named if self._axis(axis_index).builder.in_loop] or named
        for axis_index in named:
            axis = self._axis(axis_index)
            with refusals(axis_index):
                axis.builder.close_loop(keep=axis_index in self._with_segments)
            axis.segments += SEGMENTS_EACH

    def _switch_outputs(self, command: Command) -> None:
        if command.is_query:
            raise CommandError(INCORRECT_DATA)
        pattern = output_pattern(self._controller, command)
        if command.name == "POUT":
            self._outputs = pattern
        else:
            self._axis(AXIS_OUTPUTS[command.name]).switch_outputs(pattern)

    def _end_at_rest(self, command: Command) -> None:
        """VF0, FOLRNF0: 0 is the only value there is."""
        if command.is_query:
            raise CommandError(INCORRECT_DATA)
        for axis_index in self._settings.assign(command):
            self._axis(axis_index).ends_at_rest = True


@contextmanager
def refusals(axis_index: int) -> Iterator[None]:
    """What planning cannot do, in the unit's words.

    Raises:
        CommandError: INVALID CONDITIONS FOR COMMAND-AXIS n, MASTER SLAVE DISTANCE MISMATCH.
    """
    try:
        yield
    except DistanceMismatch:
        raise CommandError(MASTER_SLAVE_DISTANCE_MISMATCH) from None
    except (CannotBlend, Unsteady):
        raise invalid_conditions(axis_index + 1) from None


def _passes(command: Command, axes: int) -> dict[int, int | None]:
    """PLOOP: passes of the axes it names; 0 is endless, and so is no field at all (assumed for all axes)."""
    assert command.row is not None
    if command.is_query:
        named = range(axes) if command.axis is None else range(command.axis - 1, command.axis)
        return dict.fromkeys(named)
    allowed = range_of(command.row)
    return {
        index: int(checked_number(value, allowed, field=index + 1, fields=axes)) or None
        for index, value in enumerate(place_values(command, axes))
        if value is not None
    }


@handles("GOBUF", "PLOOP", "PLN", "POUT", *AXIS_OUTPUTS)
def outside_a_profile(controller: Controller, command: Command) -> Lines:
    """The commands of a profile do nothing by themselves (assumed).

    Raises:
        CommandError: NOT DEFINING A PATH.
    """
    raise CommandError(NOT_DEFINING_A_PATH)


register(
    Kind(
        "profile",
        segment_commands=frozenset({"GOBUF"}),
        other_commands=frozenset({"PLOOP", "PLN", "POUT", *AXIS_OUTPUTS, "VF", "FOLRNF", *HOLDING_COMMANDS}),
        settings=PROFILE_SETTINGS,
        build=ProfileBuilder,
    )
)

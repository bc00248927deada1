"""A contour path as its program defines it: from PLIN, PARCM ... and what goes with them to lines and arcs.

Coordinates are counts from where the path begins, wherever its axes stand at PRUN.  With PAB0 (assumed the default)
end points are steps from the end of the piece before; with PAB1 they are coordinates, of the work system or, after PL1,
of the local one.  PWC and PLC say which coordinates the present point has in these systems (PWC assumed, its page is
missing); before them a path begins at 0,0 in both.

A piece keeps the PV, PA and PAD that stand in front of it.  Values are scaled by PSCLD when the program is compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import ROUND_DOWN, Decimal
from typing import TYPE_CHECKING

from emulator.controller.compiled.kinds import Compilation, Kind, register
from emulator.controller.dispatch import Lines, handles
from emulator.controller.paths.contour import ContourPath
from emulator.controller.paths.geometry import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    Line,
    Piece,
    Point,
    arc_by_centre,
    arc_by_radius,
)
from emulator.controller.paths.outputs import merged
from emulator.controller.paths.speed import Stretch
from emulator.controller.wires.outputs import output_pattern
from protocol.command import Command
from protocol.errors import (
    INCORRECT_AXIS,
    INCORRECT_DATA,
    INVALID_CONDITIONS,
    NO_PATH_SEGMENTS_DEFINED,
    NOT_DEFINING_A_PATH,
    PATH_VELOCITY_ZERO,
    CommandError,
    invalid_data_field,
)
from protocol.fields import checked_number

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

SEGMENT_COMMANDS = frozenset({"PLIN", "PARCM", "PARCP", "PARCOM", "PARCOP"})
COORDINATE_COMMANDS = frozenset({"PAXES", "PAB", "PL", "PLC", "PWC", "PRTOL"})
RATE_SETTINGS = frozenset({"PV", "PA", "PAD", "PAA", "PADA"})
"""Settings that may stand in a path.  PAA and PADA are taken and have no effect: contours have no S-curves (6000 PG
p. 146)."""

DEFAULT_AXES = (0, 1)
"""X and Y before any PAXES (the guide's program has none)."""


@dataclass(slots=True)
class Coordinates:
    """Where a definition has come to, and how the coordinates that follow are meant."""

    point: Point = (0, 0)
    absolute: bool = False
    local: bool = False
    work_shift: Point = (0, 0)
    local_shift: Point = (0, 0)

    def name_point(self, coordinates: tuple[int, int]) -> Point:
        """The shift of a system in which the present point has these coordinates."""
        return (coordinates[0] - self.point[0], coordinates[1] - self.point[1])

    def reached(self, fields: tuple[int | None, int | None]) -> Point:
        """The point that X and Y fields mean; an empty one leaves its axis where it is (assumed)."""
        shift = self.local_shift if self.local else self.work_shift
        from_here = [-shift[i] if self.absolute else self.point[i] for i in range(2)]
        return tuple(self.point[i] if field is None else from_here[i] + field for i, field in enumerate(fields))


class PathBuilder:
    """Takes the commands of one path definition in turn."""

    def __init__(self, compilation: Compilation) -> None:
        self._controller = compilation.controller
        self._settings = compilation.settings
        self._axes = DEFAULT_AXES
        self._at = Coordinates()
        self._tolerance = compilation.controller.machine.paths.radius_tolerance
        self._pieces: list[Piece] = []
        self._stretches: list[Stretch] = []
        self._outputs: dict[int, str] = {}
        self._take: dict[str, Callable[[Command], None]] = {
            "PAXES": self._choose_axes,
            "PAB": self._choose_mode,
            "PL": self._choose_system,
            "PWC": self._name_work_point,
            "PLC": self._name_local_point,
            "PRTOL": self._set_tolerance,
            "POUT": self._switch_outputs,
            "PLIN": self._line,
            "PARCM": lambda command: self._arc_by_radius(command, CLOCKWISE),
            "PARCP": lambda command: self._arc_by_radius(command, COUNTER_CLOCKWISE),
            "PARCOM": lambda command: self._arc_by_centre(command, CLOCKWISE),
            "PARCOP": lambda command: self._arc_by_centre(command, COUNTER_CLOCKWISE),
        }

    def take(self, command: Command) -> None:
        """A command of the definition.

        Raises:
            CommandError: fields missing or out of range, an impossible arc, PV0, an output with a function.
        """
        self._take[command.name](command)

    def finish(self) -> ContourPath:
        """The path defined.

        Raises:
            CommandError: it has no length, or an axis that is not in use.
        """
        if not self._pieces:
            raise CommandError(NO_PATH_SEGMENTS_DEFINED)
        if max(self._axes) >= self._settings.axes_in_use:
            raise CommandError(INCORRECT_AXIS)
        return ContourPath(self._axes, tuple(self._pieces), tuple(self._stretches), self._outputs)

    # Coordinates.

    def _choose_axes(self, command: Command) -> None:
        """PAXES x,y: once, before the first segment (assumed)."""
        if self._pieces:
            raise CommandError(INVALID_CONDITIONS)
        x, y = (int(number) for number in self._all_numbers(command))
        if x == y:
            raise invalid_data_field(2)
        self._axes = (x - 1, y - 1)

    def _choose_mode(self, command: Command) -> None:
        self._at.absolute = bool(self._all_numbers(command)[0])

    def _choose_system(self, command: Command) -> None:
        self._at.local = bool(self._all_numbers(command)[0])

    def _name_work_point(self, command: Command) -> None:
        self._at.work_shift = self._at.name_point(self._both_counts(command))

    def _name_local_point(self, command: Command) -> None:
        self._at.local_shift = self._at.name_point(self._both_counts(command))

    def _set_tolerance(self, command: Command) -> None:
        self._tolerance = float(self._all_numbers(command)[0] * self._factor)

    def _switch_outputs(self, command: Command) -> None:
        """POUT: for the segment that comes next; several in front of one add up (assumed)."""
        if not command.mask and command.bit is None:
            raise CommandError(INCORRECT_DATA)
        pattern = output_pattern(self._controller, command)
        following = len(self._pieces)
        self._outputs[following] = merged(self._outputs.get(following, ""), pattern)

    # Segments.

    def _line(self, command: Command) -> None:
        x, y = self._numbers(command)
        if x is None and y is None:
            raise CommandError(INCORRECT_DATA)
        self._add(Line(self._at.point, self._end(x, y)))

    def _arc_by_radius(self, command: Command, turn: int) -> None:
        x, y, radius = self._numbers(command)
        if radius is None:
            raise CommandError(INCORRECT_DATA)
        self._add(arc_by_radius(self._at.point, self._end(x, y), float(radius * self._factor), turn, self._tolerance))

    def _arc_by_centre(self, command: Command, turn: int) -> None:
        """The centre is given from the start of the arc, whatever PAB says (assumed)."""
        x, y, *offset = self._numbers(command)
        across, up = (float((number or 0) * self._factor) for number in offset)
        self._add(arc_by_centre(self._at.point, self._end(x, y), (across, up), turn, self._tolerance))

    def _end(self, x: Decimal | None, y: Decimal | None) -> Point:
        return self._at.reached((self._counts(x), self._counts(y)))

    def _add(self, piece: Piece) -> None:
        """A segment, with the speeds now in force; one of no length does nothing (assumed)."""
        counts = self._settings.counts
        velocity, up, down = (float(counts(name)) for name in ("PV", "PA", "PAD"))
        if velocity == 0.0:
            raise CommandError(PATH_VELOCITY_ZERO)
        if piece.length > 0.0:
            self._pieces.append(piece)
            self._stretches.append(Stretch(piece.length, velocity, up, down))
            self._at.point = piece.end

    # Fields.

    @property
    def _factor(self) -> int:
        return self._settings.factor("path_distance", 0)

    def _numbers(self, command: Command) -> list[Decimal | None]:
        """Every field, checked and truncated; None where one is empty or left out."""
        row = command.row
        assert row is not None
        count = row.fields.count
        if not command.values or any(value is not None for value in command.values[count:]):
            raise CommandError(INCORRECT_DATA)
        allowed = self._settings.range_in_force(row, 0)
        return [
            None if value is None else checked_number(value, allowed, field=field, fields=count)
            for field, value in enumerate((*command.values, *(None,) * count)[:count], start=1)
        ]

    def _all_numbers(self, command: Command) -> list[Decimal]:
        """Every field of a command that needs all of them."""
        numbers = [number for number in self._numbers(command) if number is not None]
        assert command.row is not None
        if len(numbers) != command.row.fields.count:
            raise CommandError(INCORRECT_DATA)
        return numbers

    def _both_counts(self, command: Command) -> tuple[int, int]:
        x, y = self._all_numbers(command)
        return int(x * self._factor), int(y * self._factor)

    def _counts(self, number: Decimal | None) -> int | None:
        """Whole counts, truncated like a distance (6250 UG p. 47)."""
        return None if number is None else int((number * self._factor).to_integral_value(ROUND_DOWN))


register(
    Kind(
        name="contour path",
        segment_commands=SEGMENT_COMMANDS,
        other_commands=COORDINATE_COMMANDS | {"POUT"},
        settings=RATE_SETTINGS,
        build=PathBuilder,
    )
)


@handles(*SEGMENT_COMMANDS, *COORDINATE_COMMANDS, "POUT")
def not_defining(controller: Controller, command: Command) -> Lines:
    """Path commands mean something to PCOMP only: typed, or run instead of compiled, they are refused (assumed).

    Raises:
        CommandError: NOT DEFINING A PATH.
    """
    raise CommandError(NOT_DEFINING_A_PATH)

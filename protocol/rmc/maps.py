"""Where registers are: files, elements, and the Modbus address made of them.

`address = 2 (256 file + element) + 1`, counted from 1 (M1041); the wire counts from 0. A register given as a command's
parameter is `4096 file + element` (M747).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

MapName = Literal["rmc75", "rmc150"]

ELEMENTS: Final = 256
STATUS_FILE: Final = 8
VARIABLE_FILES: Final = range(56, 60)
VARIABLES: Final = ELEMENTS * len(VARIABLE_FILES)
INFO_FILE: Final = 7
COMMAND_REGISTERS: Final = 10
"""Registers of an axis's command block: the number and nine parameters."""
SMALL_COMMAND_REGISTERS: Final = 6
WORDS: Final = 2
"""Modbus registers of an RMC register."""

_DUPLICATE_DATA, _DUPLICATE_DEFINITION, _DUPLICATE_COMMANDS, _DUPLICATE_VARIABLES = 0, 1, 2, 3


class Place(NamedTuple):
    """A register: file and element, `%MDfile.element` on the pages."""

    file: int
    element: int

    @property
    def number(self) -> int:
        """As a command's parameter names it."""
        return self.file * 4096 + self.element

    @classmethod
    def of_number(cls, number: int) -> Place:
        """The register that a command's parameter names."""
        return cls(number // 4096, number % 4096)


@dataclass(frozen=True, slots=True)
class RegisterMap:
    """The files of one family."""

    name: MapName
    axes: int
    parameter_file: int
    command_file: int
    small_command_file: int | None
    definition_file: int
    data_file: int
    system_files: tuple[int, ...]
    """Axis assignment, controller, communication, event log, discrete I/O, tasks: known by name only, read as 0."""

    def status(self, axis: int, element: int) -> Place:
        """A status register of an axis, counted from 0."""
        return Place(STATUS_FILE + axis, element)

    def parameter(self, axis: int, element: int) -> Place:
        """A parameter of an axis."""
        return Place(self.parameter_file + axis, element)

    def command(self, axis: int, offset: int = 0) -> Place:
        """A register of an axis's command block: 0 the number, 1 to 9 its parameters."""
        return Place(self.command_file, COMMAND_REGISTERS * axis + offset)

    def original(self, place: Place) -> Place:
        """The register that a register of the low, duplicate files stands for; any other itself."""
        if place.file == _DUPLICATE_DATA:
            return Place(self.data_file, place.element)
        if place.file == _DUPLICATE_DEFINITION:
            return Place(self.definition_file, place.element)
        if place.file == _DUPLICATE_COMMANDS:
            return Place(self.command_file, place.element)
        if _DUPLICATE_VARIABLES <= place.file < INFO_FILE:
            return Place(VARIABLE_FILES[place.file - _DUPLICATE_VARIABLES], place.element)
        return place


MAPS: Final[dict[MapName, RegisterMap]] = {
    "rmc75": RegisterMap("rmc75", 4, 12, 25, 16, 17, 18, (7, 19, 20, 21, 22, 23, 24)),
    "rmc150": RegisterMap("rmc150", 16, 24, 40, None, 41, 42, (7, 43, 44, 45, 46, 47, 48)),
}
"""The register maps by family (M1041); the RMC151 has that of the RMC150 (inferred)."""


def address_of(place: Place) -> int:
    """Modbus address of a register's first half, counted from 1 as the manual prints it."""
    return WORDS * (ELEMENTS * place.file + place.element) + 1


def place_at(wire_address: int) -> tuple[Place, int]:
    """The register at a wire address (counted from 0), and which of its halves."""
    register, half = divmod(wire_address, WORDS)
    return Place(*divmod(register, ELEMENTS)), half

"""Fields checked against the catalogue: which axis each belongs to, whether it is in range, how far it is truncated.

Pure functions from a ``Command`` to values per axis.  What is surplus is judged as hosts need it: surplus ``X`` and
``0`` in masks and surplus empty comma fields are ignored, because hosts written for eight axes send them to every unit;
anything else beyond the unit's axes is INCORRECT AXIS and the command is refused whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from protocol.catalogue import CommandRow
from protocol.command import Command, Direction, FieldValue, VariableReference
from protocol.errors import INCORRECT_AXIS, INCORRECT_DATA, INVALID_DATA, CommandError, invalid_data_field
from protocol.numbers import truncate


@dataclass(frozen=True, slots=True)
class Range:
    """What one field may hold: limits in user units (None = open) and the decimals kept of what is typed."""

    minimum: Decimal | None
    maximum: Decimal | None
    places: int


def as_decimal(value: float | int | str) -> Decimal:
    """A catalogue number, exactly as written there."""
    return Decimal(str(value))


def range_of(row: CommandRow) -> Range:
    """The unscaled range of a numeric command, from its row."""
    fields = row.fields
    places = fields.decimals if fields.decimals is not None else 0
    if fields.type == "real" and fields.decimals is None:
        places = 5
    return Range(
        minimum=None if fields.min is None else as_decimal(fields.min),
        maximum=None if fields.max is None else as_decimal(fields.max),
        places=places,
    )


def default_values(row: CommandRow) -> tuple[Decimal, ...]:
    """The power-up value of each field in user units; 0 where the row gives none."""
    default = row.fields.default
    count = row.fields.count
    if isinstance(default, str) and "," in default:
        return tuple(Decimal(part) for part in default.split(","))
    value = Decimal(0) if default is None else as_decimal(default)
    return (value,) * count


def in_range(value: Decimal, allowed: Range) -> bool:
    """Whether a (truncated) value lies within the range."""
    if allowed.minimum is not None and value < allowed.minimum:
        return False
    return allowed.maximum is None or value <= allowed.maximum


def check_axis(command: Command, axes: int) -> None:
    """Refuse an axis prefix the unit does not have (0 and above the last).

    Raises:
        CommandError: INCORRECT AXIS.
    """
    if command.axis is not None and not 1 <= command.axis <= axes:
        raise CommandError(INCORRECT_AXIS)


def axis_indexes(command: Command, axes: int) -> Sequence[int]:
    """The 0-based axes a command without fields speaks of: the prefixed one, else all.

    Raises:
        CommandError: INCORRECT AXIS for a prefix the unit does not have.
    """
    check_axis(command, axes)
    if command.axis is not None:
        return (command.axis - 1,)
    return range(axes)


def place_values(command: Command, axes: int) -> list[FieldValue]:
    """Comma fields laid out one an axis; None leaves that axis unchanged.

    Raises:
        CommandError: INCORRECT AXIS for a surplus field that is not empty, or a prefix the unit does not have.
    """
    check_axis(command, axes)
    values = command.values
    placed: list[FieldValue] = [None] * axes
    if command.all_axes:
        first, surplus = values[0], values[1:]
        placed = [first] * axes
    elif command.axis is not None:
        first, surplus = values[0], values[1:]
        placed[command.axis - 1] = first
    else:
        placed[: len(values)] = values[:axes]
        surplus = values[axes:]
    if any(value is not None for value in surplus):
        raise CommandError(INCORRECT_AXIS)
    return placed


def place_mask(command: Command, axes: int, *, lenient: bool = True) -> list[str]:
    """Packed binary digits laid out one an axis: "0", "1" or "X" (unchanged).

    Raises:
        CommandError: INCORRECT AXIS for a surplus 1 (any surplus digit when not ``lenient``), or a prefix the unit does
            not have.
    """
    check_axis(command, axes)
    mask = command.mask
    placed = ["X"] * axes
    if command.all_axes:
        surplus = mask[1:]
        placed = [mask[0]] * axes if mask else placed
    elif command.axis is not None:
        surplus = mask[1:]
        placed[command.axis - 1] = mask[0] if mask else "X"
    else:
        kept = mask[:axes]
        placed[: len(kept)] = list(kept)
        surplus = mask[axes:]
    if "1" in surplus or (surplus and not lenient):
        raise CommandError(INCORRECT_AXIS)
    return placed


def place_bits(mask: str, count: int) -> str:
    """A bit pattern padded with X to ``count`` bits; surplus 0 and X are ignored.

    Raises:
        CommandError: INCORRECT DATA for a surplus bit that says something.
    """
    if mask[count:].strip("0X"):
        raise CommandError(INCORRECT_DATA)
    return mask[:count].ljust(count, "X")


def checked_number(value: FieldValue, allowed: Range, *, field: int, fields: int) -> Decimal:
    """A field as a number, truncated to the places kept and within range.

    ``field`` counts from 1; commands with a single field name no field in the error.

    Raises:
        CommandError: INVALID DATA, INVALID DATA-FIELD n; INCORRECT DATA for a direction sign where none belongs.
    """
    if isinstance(value, Direction):
        raise CommandError(INCORRECT_DATA)
    if isinstance(value, VariableReference) or value is None:
        raise TypeError("substitute variables and skip empty fields before checking")
    number = truncate(value, allowed.places)
    if not in_range(number, allowed):
        raise CommandError(INVALID_DATA) if fields == 1 else invalid_data_field(field)
    return number

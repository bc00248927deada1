"""Every setting of the unit: what the host has set, in the units it was set in, and how it is reported.

All of it follows from the catalogue: a row that only stores and reports needs nothing here.  Settings of the serial
port exist once for each port (PORT chooses which one is meant)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from decimal import Decimal

from emulator.controller.changes import KEPT_COMMANDS, Changes
from emulator.controller.motion.ramps import FOLLOWED, followed_setting
from emulator.controller.scaling import (
    DISTANCE_SCALES,
    ENCODER_REVOLUTIONS,
    FACTOR_COMMANDS,
    RATE_SCALES,
    VELOCITY_SCALES,
    Quantity,
    distance_range,
    in_user_units,
    largest_velocity,
    places_in_force,
)
from protocol.catalogue import CommandRow, Scale, commands
from protocol.command import Command, Direction, FieldValue, parse_command
from protocol.errors import INCORRECT_DATA, INVALID_DATA, CommandError
from protocol.fields import (
    Range,
    axis_indexes,
    checked_number,
    default_values,
    place_bits,
    place_mask,
    place_values,
    range_of,
)
from protocol.reply import ReplyLine
from protocol.reply_shapes import bit_line, mask_line, name_line, numbers_line, places_of, word_line

PORT_SETTINGS = frozenset({"ECHO", "EOT", "BOT", "EOL", "ERROK", "ERRBAD", "ERRDEF", "ERRLVL", "E", "XONOFF", "DRPCHK"})
"""Settings that exist for each serial port (Gem6K CR p.112, p.116)."""

HOST_PORT = 1

DISCRETE_VALUES: Mapping[str, frozenset[int]] = {
    "SSFR": frozenset({1, 2, 4, 8}),
    "VF": frozenset({0}),
    "FOLRNF": frozenset({0}),
}
"""Settings whose range has holes (SSFR: APEX p.83; FOLRNF: 6000 PG p.166, VF taken as the same)."""

ANI_FEEDBACK = 2

ANI_COUNTS_PER_VOLT = 819
"""Unit of velocities and accelerations of an axis with ANI feedback (6000 PG p.211)."""

RATIO_SIDES = frozenset({"FOLRN", "FOLRD"})
"""Settings that are 1 of whatever unit is in force until they are entered (assumed; FOLRD: 6000 PG p.198)."""

Quantities = Mapping[int, Quantity]
"""Values by field index, each with the scale factor it was entered with."""


class Settings:
    """The settings of one unit, at power-up defaults until changed."""

    def __init__(
        self,
        overrides: Mapping[str, str],
        *,
        acceleration_range: tuple[Decimal, Decimal],
        ani_fitted: bool,
        lenient_masks: bool,
        changes: Changes,
    ) -> None:
        self._changes = changes
        self._acceleration_range = acceleration_range
        self._ani_fitted = ani_fitted
        self._lenient_masks = lenient_masks
        self._overrides = dict(overrides)
        self._numbers: dict[str, list[Quantity]] = {}
        self._bits: dict[str, list[str]] = {}
        self._names: dict[str, str] = {}
        self._entered: set[tuple[str, int]] = set()
        self.axes_in_use = 0
        """INDAX: axes that take part and show in reports."""
        self.scaled = False
        """SCALE1."""
        self.reset(keep=())

    # What the rest of the controller reads.

    def integer(self, name: str, index: int = 0) -> int:
        """A whole-number setting (first field, or the axis's)."""
        return int(self._numbers[self._key(name)][index].value)

    def setting(self, name: str, index: int = 0) -> Quantity:
        """A numeric setting as it was entered."""
        quantity = self._numbers[self._key(name)][index]
        if name in RATIO_SIDES and (name, index) not in self._entered:
            return Quantity(quantity.value, self.factor("master" if name == "FOLRD" else "distance", index))
        return quantity

    def number(self, name: str, index: int = 0) -> Decimal:
        """An unscaled setting as entered."""
        return self._numbers[self._key(name)][index].value

    def codes(self, name: str, port: int = HOST_PORT) -> tuple[int, ...]:
        """The character codes of a framing setting of a serial port."""
        return tuple(int(quantity.value) for quantity in self._numbers[_port_key(name, port)])

    def host_flag(self, name: str) -> bool:
        """A binary setting of the host's serial port, whatever PORT says."""
        return self._bits[_port_key(name, HOST_PORT)][0] == "1"

    def host_integer(self, name: str) -> int:
        """A whole-number setting of the host's serial port, whatever PORT says."""
        return int(self._numbers[_port_key(name, HOST_PORT)][0].value)

    def flag(self, name: str, index: int = 0) -> bool:
        """A binary setting (of an axis)."""
        return self._bits[self._key(name)][index] == "1"

    def bits(self, name: str) -> str:
        """A bit pattern, bit 1 first."""
        return "".join(self._bits[self._key(name)])

    def program_name(self, name: str) -> str:
        """The program a setting names (STARTP, ERRORP, ONP); empty when none."""
        return self._names[name]

    def counts(self, name: str, axis_index: int = 0) -> Decimal:
        """A scaled setting in counts, counts/s or counts/s2, not yet truncated to whole counts.

        Ramps that have not been entered follow their partner (AD follows A ...).
        """
        source = followed_setting(name, lambda ramp: (ramp, axis_index) in self._entered)
        return self._numbers[source][axis_index].counts(self.encoder_resolution(axis_index))

    def encoder_resolution(self, axis_index: int) -> int:
        """Counts in a unit of unscaled velocity and acceleration: a revolution of ERES counts, with ANI feedback a volt
        (6000 PG p.196)."""
        if self._numbers["SFB"][axis_index].value == ANI_FEEDBACK:
            return ANI_COUNTS_PER_VOLT
        return int(self._numbers["ERES"][axis_index].value)

    @property
    def axes(self) -> int:
        """Axes the unit has."""
        return len(self._numbers["ERES"])

    def factor(self, scale: Scale, axis_index: int) -> int:
        """Counts per user unit for values of this kind; ENCODER_REVOLUTIONS (0) means ERES."""
        if self.scaled:
            factors = self._numbers[FACTOR_COMMANDS[scale]]
            return int(factors[axis_index if len(factors) > 1 else 0].value)
        return ENCODER_REVOLUTIONS if scale in RATE_SCALES else 1

    def places(self, scale: Scale, axis_index: int, unscaled_places: int) -> int:
        """Decimals in force for values of this kind."""
        factor = self.factor(scale, axis_index)
        return places_in_force(scale, factor, scaled=self.scaled, unscaled_places=unscaled_places)

    def reading_factor(self, scale: Scale, axis_index: int) -> int:
        """Counts per user unit for measured values of this kind."""
        return self.factor(scale, axis_index) or self.encoder_resolution(axis_index)

    def value_in_user_units(self, name: str, index: int) -> Decimal:
        """The setting in force in the units reports use now; ramps not entered show what they follow."""
        row = commands()[name]
        if row.fields.scale is None:
            return self._numbers[self._key(name)][index].value
        source = followed_setting(name, lambda ramp: (ramp, index) in self._entered)
        factor = self.factor(row.fields.scale, index)
        return in_user_units(self.setting(source, index), factor, self.encoder_resolution(index))

    def field_count(self, name: str) -> int:
        """Fields a setting has."""
        return commands()[name].fields.count

    # What commands do.

    def assign(self, command: Command) -> list[int]:
        """Carry out a setting command; the indexes of the fields that were given.

        All fields are checked before any is stored: a line with one bad field is refused whole (assumed M).

        Raises:
            CommandError: the unit's text for what is wrong.
        """
        row = _row_of(command)
        if row.reply in ("mask", "word"):
            changed = self._assign_bits(row, command)
        elif row.reply == "name":
            self._names[row.name] = "" if command.argument == "CLR" else command.argument
            changed = [0]
        else:
            changed = self._assign_numbers(row, command)
        if row.name in KEPT_COMMANDS:
            self._changes.note()
        self._note_modes()
        return changed

    def _note_modes(self) -> None:
        """Keep at hand what every report asks for."""
        self.axes_in_use = int(self._numbers["INDAX"][0].value)
        self.scaled = self._bits["SCALE"][0] == "1"

    def leaves_default(self, command: Command) -> bool:
        """Whether a setting command gives nothing but power-up values.

        Raises:
            CommandError: the values are refused anyway.
        """
        row = _row_of(command)
        if row.reply == "name":
            return command.argument == "CLR"
        if row.reply == "numbers":
            given = (value for value in command.values if value is not None)
            return all(value == default for value, default in zip(given, default_values(row), strict=False))
        return not set(command.mask or command.bit_value) - {"0", "X"}

    def report(self, command: Command) -> list[ReplyLine]:
        """The answer to a setting command without fields."""
        row = _row_of(command)
        key = self._key(row.name)
        if row.reply == "name":
            return [name_line(row, self._names[row.name])]
        if row.reply == "word":
            bits = "".join(self._bits[key])
            return [bit_line(bit_of(bits, command.bit)) if command.bit else word_line(row, None, bits)]
        indexes = self._indexes(row, command)
        axis = command.axis if row.fields.per_axis else None
        if row.reply == "mask":
            return [mask_line(row, axis, "".join(self._bits[key][index] for index in indexes))]
        values = [self.value_in_user_units(row.name, index) for index in indexes]
        places = [self._places_to_report(row, index) for index in indexes]
        return [numbers_line(row, axis, values, places)]

    def store_bits(self, name: str, bits: str) -> None:
        """Set a bit pattern from inside (a fault that shuts a drive down changes DRIVE)."""
        self._bits[name] = list(bits)

    def store(self, name: str, index: int, quantity: Quantity) -> None:
        """Put back a number that was read with ``setting`` (recalling a gain set)."""
        self._numbers[name][index] = quantity

    def kept_text(self, key: str) -> str:
        """The fields of a setting as text, for non-volatile memory; ``key`` names the port where there is one
        (``DRPCHK@2``)."""
        if key in self._names:
            return self._names[key]
        if key in self._bits:
            return "".join(self._bits[key])
        return ",".join(str(quantity.value) for quantity in self._numbers[key])

    def keep(self, key: str, fields: str | list[Decimal]) -> None:
        """Put back what ``kept_text`` gave, read into its fields; it comes into force at power-up."""
        if key in self._names:
            self._names[key] = str(fields)
        elif key in self._bits:
            self._bits[key] = list(str(fields))
        else:
            self._numbers[key] = [Quantity(Decimal(field), 1) for field in fields]

    def reset(self, *, keep: Iterable[str]) -> None:
        """Everything to power-up defaults, but the settings named in ``keep``; no change of what is kept."""
        changes = self._changes.count
        kept_keys = {key for name in keep for key in _keys_of(name)}
        kept_numbers = {key: self._numbers[key] for key in kept_keys if key in self._numbers}
        kept_bits = {key: self._bits[key] for key in kept_keys if key in self._bits}
        kept_names = {key: self._names[key] for key in kept_keys if key in self._names}
        self._entered.clear()
        for row in commands().values():
            if row.kind == "setting":
                self._set_default(row)
        self._note_modes()
        for name, fields in self._overrides.items():
            self._override(name, fields)
        self._numbers.update(kept_numbers)
        self._bits.update(kept_bits)
        self._names.update(kept_names)
        self._note_modes()
        self._changes.count = changes

    def copy(self) -> Settings:
        """Settings of their own with the same values: what PCOMP lets the commands of a program change."""
        twin = copy(self)
        twin._numbers = {key: list(values) for key, values in self._numbers.items()}
        twin._bits = {key: list(bits) for key, bits in self._bits.items()}
        twin._names = dict(self._names)
        twin._entered = set(self._entered)
        return twin

    def _override(self, name: str, fields: str) -> None:
        row = commands().get(name)
        if row is not None and row.kind == "setting":
            self.assign(parse_command(f"{name}{fields}"))

    def _set_default(self, row: CommandRow) -> None:
        for key in _keys_of(row.name):
            if row.reply == "numbers":
                values = default_values(row)
                self._numbers[key] = [Quantity(value, self._default_factor(row)) for value in values]
            elif row.reply in ("mask", "word"):
                default = str(row.fields.default if row.fields.default is not None else 0)
                self._bits[key] = [default] * row.fields.count
            elif row.reply == "name":
                self._names.setdefault(row.name, "")
                self._names[row.name] = ""

    @staticmethod
    def _default_factor(row: CommandRow) -> int:
        return ENCODER_REVOLUTIONS if row.fields.scale in RATE_SCALES else 1

    def _key(self, name: str) -> str:
        if name not in PORT_SETTINGS:
            return name
        return _port_key(name, int(self._numbers["PORT"][0].value))

    def _indexes(self, row: CommandRow, command: Command) -> Sequence[int]:
        if row.fields.per_axis:
            return axis_indexes(command, self.axes_in_use)
        return range(row.fields.count)

    def _assign_bits(self, row: CommandRow, command: Command) -> list[int]:
        stored = self._bits[self._key(row.name)]
        if command.bit is not None:
            if not 1 <= command.bit <= row.fields.count or command.bit_value not in ("0", "1", "X", "E"):
                raise CommandError(INVALID_DATA)
            placed = ["X"] * row.fields.count
            placed[command.bit - 1] = command.bit_value
        elif row.fields.per_axis:
            placed = place_mask(command, self.axes_in_use, lenient=self._lenient_masks)
        else:
            placed = list(place_bits(command.mask, row.fields.count))
        if "E" in placed and row.fields.default != "E":
            raise CommandError(INCORRECT_DATA)
        keeps_x = row.fields.default == "X"
        changed = [index for index, digit in enumerate(placed) if digit != "X" or (keeps_x and command.bit is None)]
        for index in changed:
            stored[index] = placed[index]
        return changed

    def _assign_numbers(self, row: CommandRow, command: Command) -> list[int]:
        return self._put(row, self._read_numbers(row, command))

    def _read_numbers(self, row: CommandRow, command: Command) -> Quantities:
        placed = self._place(row, command)
        return {index: self._quantity(row, value, index) for index, value in enumerate(placed) if value is not None}

    def _put(self, row: CommandRow, quantities: Quantities) -> list[int]:
        stored = self._numbers[self._key(row.name)]
        for index, quantity in quantities.items():
            stored[index] = quantity
            if row.name in FOLLOWED or row.name in RATIO_SIDES:
                self._note_entered(row.name, index, quantity)
        return list(quantities)

    def scaled_when_stored(self, command: Command) -> Quantities | None:
        """The values of a scaled setting with the scaling in force now: a program keeps them as they were stored
        (6000 PG p.197).  None for a command whose values are not fixed, or that is not scaled.

        Raises:
            CommandError: a value the setting does not take.
        """
        row = command.row
        if row is None or row.kind != "setting" or row.fields.scale is None or not command.values:
            return None
        if command.substituted or any(isinstance(value, Direction) for value in command.values):
            return None
        return self._read_numbers(row, command)

    def assign_stored(self, command: Command, quantities: Quantities) -> list[int]:
        """Carry out a setting command of a program with the values ``scaled_when_stored`` gave."""
        return self._put(_row_of(command), quantities)

    def _note_entered(self, name: str, index: int, quantity: Quantity) -> None:
        """Zero returns a ramp to following its partner (AD0, AA0)."""
        if quantity.value == 0 and name in FOLLOWED:
            self._entered.discard((name, index))
        else:
            self._entered.add((name, index))

    def _place(self, row: CommandRow, command: Command) -> list[FieldValue]:
        if row.fields.per_axis:
            return place_values(command, self.axes_in_use)
        surplus = command.values[row.fields.count :]
        if any(value is not None for value in surplus):
            raise CommandError(INCORRECT_DATA)
        return list(command.values[: row.fields.count])

    def _quantity(self, row: CommandRow, value: FieldValue, index: int) -> Quantity:
        scale = row.fields.scale
        if isinstance(value, Direction):
            return self._turned(row.name, value, index)
        allowed = self.range_in_force(row, index)
        fields = row.fields.count
        number = checked_number(value, allowed, field=index + 1, fields=fields)
        self._check_discrete(row.name, number, index, fields)
        return Quantity(number, self.factor(scale, index) if scale else 1)

    def _check_discrete(self, name: str, number: Decimal, index: int, fields: int) -> None:
        allowed = DISCRETE_VALUES.get(name)
        no_ani = name == "SFB" and number == ANI_FEEDBACK and not self._ani_fitted
        too_slow = name in FOLLOWED and 0 < number < self._acceleration_range[0]
        if no_ani or too_slow or (allowed is not None and number not in allowed):
            raise CommandError(INVALID_DATA if fields == 1 else f"{INVALID_DATA}-FIELD {index + 1}")

    def _turned(self, name: str, direction: Direction, index: int) -> Quantity:
        """``D+``, ``D-``, ``D~``: the distance keeps its magnitude."""
        value, factor = self._numbers[name][index]
        positive = value < 0 if direction is Direction.TOGGLE else direction is Direction.POSITIVE
        return Quantity(abs(value) if positive else -abs(value), factor)

    def range_in_force(self, row: CommandRow, index: int) -> Range:
        """What a field of a numeric command may hold now, in user units."""
        allowed = range_of(row)
        scale = row.fields.scale
        if scale is None:
            return allowed
        places = self.places_of(row, index, allowed.places)
        factor = self.factor(scale, index)
        if scale in DISTANCE_SCALES:
            own_range = row.fields.number_format == "shortest" and not self.scaled
            return allowed if own_range else distance_range(allowed, factor, places)
        if scale in VELOCITY_SCALES:
            return Range(Decimal(0), largest_velocity(factor, self.encoder_resolution(index)), places)
        low, high = self._acceleration_range
        return Range(Decimal(0) if row.name in FOLLOWED else low, high, max(places, 5) if not self.scaled else places)

    def _places_to_report(self, row: CommandRow, index: int) -> int:
        return self.places_of(row, index, places_of(row))

    def places_of(self, row: CommandRow, index: int, unscaled_places: int) -> int:
        """Decimals a field of this command has now; ratios and master distances keep their own while unscaled."""
        scale = row.fields.scale
        if scale is None or (row.fields.number_format == "shortest" and not self.scaled):
            return unscaled_places
        return self.places(scale, index, unscaled_places)


def bit_of(bits: str, number: int | None) -> str:
    """Bit ``number`` (from 1) of a bit text.

    Raises:
        CommandError: INVALID DATA for a bit the word does not have.
    """
    if number is None or not 1 <= number <= len(bits):
        raise CommandError(INVALID_DATA)
    return bits[number - 1]


def _port_key(name: str, port: int) -> str:
    return f"{name}@{port}"


def _keys_of(name: str) -> Sequence[str]:
    """Where a setting is kept: once, or once for each serial port."""
    return [_port_key(name, port) for port in (1, 2)] if name in PORT_SETTINGS else [name]


def _row_of(command: Command) -> CommandRow:
    if command.row is None:
        raise TypeError(f"{command.name} is not a command")
    return command.row

"""What a master sees of a device: registers by Modbus address, read and written as words.

A write is looked at as a whole before anything of it takes effect: if any of its registers does not exist or may not be
written, none is. Otherwise all of it takes effect between two loops, parameters and variables first, then the command
blocks it touches, together. A lone half of a register waits for its partner (assumed L), per connection.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Sequence

from protocol.rmc.bits import StatusBits
from protocol.rmc.commands import REQUEST
from protocol.rmc.maps import (
    COMMAND_REGISTERS,
    ELEMENTS,
    INFO_FILE,
    SMALL_COMMAND_REGISTERS,
    STATUS_FILE,
    VARIABLE_FILES,
    WORDS,
    Place,
    place_at,
)
from protocol.rmc.registers import STATUS_BY_TAG, STATUS_REGISTERS
from protocol.rmc.words import bits_of, halves, joined, value_of

from .axis import Axis
from .device import RmcDevice
from .memory import axis_word

STATUS_FIELDS = {
    "ErrorBits": "errors",
    "CurrentControlMode": "mode",
    "ActPos": "shown_position",
    "ActVel": "shown_velocity",
    "ActAcc": "shown_acceleration",
    "Counts": "raw_counts",
    "RawCounts": "raw_counts",
    "ControlOutput": "control_v",
    "PosError": "position_error",
    "VelError": "velocity_error",
    "TermP": "term_p",
    "TermI": "term_i",
    "TermD": "term_d",
    "TermVFF": "term_vff",
    "TermAFF": "term_aff",
    "TermJFF": "term_jff",
    "TermDoubleDiff": "term_double",
    "TermTripleDiff": "term_triple",
    "PFIDOutput": "pfid",
    "TarPos": "target_position",
    "TarVel": "target_velocity",
    "TarAcc": "target_acceleration",
    "CmdPos": "command_position",
    "CmdVel": "command_velocity",
}
"""Status registers that are a field of the axis record."""

_FLOAT, _BITS = struct.Struct("<f"), struct.Struct("<I")
Reader = Callable[[int], int]


class BadAddress(Exception):
    """A register that does not exist, or may not be written: Modbus exception 2."""


class Connection:
    """One master: its REQ bits, and halves of registers it has written alone."""

    def __init__(self) -> None:
        self.requests: set[int] = set()
        """Axes whose last command came with REQ; their Status Bits show ACK to this master (M424)."""
        self.halves: dict[tuple[Place, int], int] = {}


class Registers:
    """The register map of one device."""

    def __init__(self, device: RmcDevice) -> None:
        self._device = device
        self._map = device.map
        self._order = device.rmc.word_order
        self._axes = len(device.axes)
        self._definitions = [0] * ELEMENTS
        self._status = [self._status_readers(axis) for axis in device.axes]

    # Reading

    def read(self, wire_address: int, count: int, connection: Connection) -> list[int]:
        """`count` words from a wire address (counted from 0); BadAddress for a register that does not exist."""
        first, half = place_at(wire_address)
        place = first
        words: list[int] = []
        while len(words) < count + half:
            words += halves(self.bits(place, connection), self._order)
            place = following(place)
        return words[half : half + count]

    def bits(self, place: Place, connection: Connection) -> int:
        """The 32 bits of a register; BadAddress if it does not exist."""
        place = self._map.original(place)
        index = place.file - STATUS_FILE
        if 0 <= index < self._axes:
            return self._status_bits(index, place.element, connection)
        index = place.file - self._map.parameter_file
        if 0 <= index < self._axes:
            return self._device.parameters[index].bits(place.element)
        if place.file in VARIABLE_FILES:
            return bits_of(float(self._device.memory.variables[_variable(place)]))
        if place.file == self._map.data_file:
            return self._indirect(place.element, connection)
        if place.file == self._map.definition_file:
            return self._definitions[place.element]
        if self._command_axis(place) is not None or place.file == INFO_FILE or place.file in self._map.system_files:
            return 0
        raise BadAddress

    def _status_bits(self, axis_index: int, element: int, connection: Connection) -> int:
        bits = self._status[axis_index][element](axis_index)
        if element == 0 and axis_index in connection.requests:
            bits |= StatusBits.ACKNOWLEDGE
        return bits

    def _status_readers(self, axis: Axis) -> list[Reader]:
        """What reads each element of an axis's status file; those no page names read as 0."""
        elements = {register.tag: register.element for register in STATUS_REGISTERS} | self._device.rmc.register_names
        readers: list[Reader] = [_nothing] * ELEMENTS
        for tag, field in STATUS_FIELDS.items():
            readers[elements[tag]] = _reader(axis, field, raw=STATUS_BY_TAG[tag].kind != "REAL")
        readers[elements["StatusBits"]] = _reader(axis, "status", raw=True)
        readers[elements["LastErrorNumber"]] = lambda index: bits_of(self._device.axes[index].last_error)
        readers[elements["NextControlMode"]] = self._next_mode_bits
        return readers

    def _next_mode_bits(self, axis_index: int) -> int:
        return bits_of(self._device.code_of_mode(self._device.axes[axis_index].next_mode))

    def _indirect(self, element: int, connection: Connection) -> int:
        """A register of the Indirect Data Map: what its definition names; 0 for none, or one that is indirect too."""
        target = self._target(element)
        return 0 if target is None else self.bits(target, connection)

    def _target(self, element: int) -> Place | None:
        place = Place.of_number(self._definitions[element])
        beyond = place.element >= ELEMENTS or self._map.original(place).file == self._map.data_file
        return None if not self._definitions[element] or beyond else place

    def _command_axis(self, place: Place) -> tuple[int, int] | None:
        """Axis and offset within its block of a command register."""
        size = COMMAND_REGISTERS
        if place.file == self._map.small_command_file:
            size = SMALL_COMMAND_REGISTERS
        elif place.file != self._map.command_file:
            return None
        axis, offset = divmod(place.element, size)
        return (axis, offset) if axis < self._axes else None

    # Writing

    def write(self, wire_address: int, words: Sequence[int], connection: Connection) -> None:
        """Write words from a wire address; BadAddress, and nothing of it written, if any register may not be."""
        pieces = list(self._pieces(wire_address, words))
        for place, _ in pieces:
            if not self.writable(place):
                raise BadAddress
        whole = [
            (place, bits) for place, piece in pieces if (bits := self._whole(place, piece, connection)) is not None
        ]
        self._put(whole, connection)

    def _pieces(self, wire_address: int, words: Sequence[int]) -> Iterator[tuple[Place, tuple[int | None, int | None]]]:
        """The registers of some words, with both halves in wire order or one of them missing."""
        place, half = place_at(wire_address)
        rest: list[int | None] = [*([None] * half), *words]
        for start in range(0, len(rest), WORDS):
            pair = rest[start : start + WORDS]
            yield place, (pair[0], pair[1] if len(pair) == WORDS else None)
            place = following(place)

    def _whole(self, place: Place, piece: tuple[int | None, int | None], connection: Connection) -> int | None:
        """A register's bits, if both halves are there now."""
        waiting = connection.halves
        found = [waiting.pop((place, half), None) if word is None else word for half, word in enumerate(piece)]
        for half, word in enumerate(found):
            if word is not None and piece[half] is not None:
                waiting.pop((place, half), None)
        first, second = found
        if first is not None and second is not None:
            return joined(first, second, self._order)
        for half, word in enumerate(found):
            if word is not None:
                waiting[place, half] = word
        return None

    def writable(self, place: Place) -> bool:
        """Whether a register exists and may be written."""
        place = self._map.original(place)
        if 0 <= place.file - self._map.parameter_file < self._axes:
            return True
        if place.file in VARIABLE_FILES or place.file == self._map.definition_file:
            return True
        if place.file == self._map.data_file:
            target = self._target(place.element)
            return target is not None and self.writable(target)
        return self._command_axis(place) is not None

    def _put(self, registers: Sequence[tuple[Place, int]], connection: Connection) -> None:
        """Let whole registers take effect."""
        blocks: dict[int, dict[int, float]] = {}
        for place, bits in registers:
            self._put_one(self._map.original(place), bits, blocks)
        commands = {axis: _numbers(block) for axis, block in blocks.items() if 0 in block}
        for axis, numbers in commands.items():
            (connection.requests.add if numbers[0] >= REQUEST else connection.requests.discard)(axis)
        if commands:
            self._device.execute(commands)

    def _put_one(self, place: Place, bits: int, blocks: dict[int, dict[int, float]]) -> None:
        command = self._command_axis(place)
        if command is not None:
            axis, offset = command
            blocks.setdefault(axis, {})[offset] = float(value_of(bits))
        elif place.file in VARIABLE_FILES:
            self._device.memory.variables[_variable(place)] = value_of(bits)
        elif place.file == self._map.definition_file:
            self._definitions[place.element] = bits
        elif place.file == self._map.data_file:
            target = self._target(place.element)
            assert target is not None, "it was found to be writable"
            self._put_one(self._map.original(target), bits, blocks)
        else:
            self._device.write_parameter(place.file - self._map.parameter_file, place.element, bits)


def following(place: Place) -> Place:
    """The next register; files follow one another without a gap."""
    return Place(place.file, place.element + 1) if place.element + 1 < ELEMENTS else Place(place.file + 1, 0)


def _variable(place: Place) -> int:
    return (place.file - VARIABLE_FILES[0]) * ELEMENTS + place.element


def _numbers(block: dict[int, float]) -> list[float]:
    """A command block as a list; parameters that were not written are 0."""
    return [block.get(offset, 0.0) for offset in range(max(block) + 1)]


def _nothing(axis_index: int) -> int:
    return 0


def _reader(axis: Axis, field: str, *, raw: bool) -> Reader:
    """What reads a field of an axis: its bits as they are, or as a REAL."""
    words = axis.memory.axis[axis.index]
    place, is_int = axis_word(field)
    if raw:
        return lambda _: words.ints[place] & 0xFFFF_FFFF
    if is_int:
        return lambda _: bits_of(words.ints[place])

    def read(_: int) -> int:
        try:
            bits: int = _BITS.unpack(_FLOAT.pack(words.floats[place]))[0]
        except OverflowError:
            bits = bits_of(words.floats[place])
        return bits

    return read

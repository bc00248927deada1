"""The controller: registers by place, axes, and commands that start several axes together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import TracebackType

from clients.rmc.axis import RmcAxis
from clients.rmc.link import RmcLink, TcpLink
from protocol.rmc.maps import COMMAND_REGISTERS, MAPS, VARIABLE_FILES, WORDS, MapName, Place, address_of
from protocol.rmc.words import Number, RegisterType, WordOrder, bits_of, from_words, reals, to_words, value_of


class RMC:
    """One controller.

    Args:
        where: a host name or address, or a link of your own.
        port: of Modbus/TCP.
        axes: how many axes it has.
        register_map: ``rmc150`` (also the RMC151's) or ``rmc75``.
        word_order: which half of a register comes first.
    """

    def __init__(
        self,
        where: str | RmcLink,
        port: int = 502,
        *,
        axes: int = 2,
        register_map: MapName = "rmc150",
        word_order: WordOrder = "low_first",
    ) -> None:
        self.link: RmcLink = TcpLink(where, port) if isinstance(where, str) else where
        self.map = MAPS[register_map]
        self._order: WordOrder = word_order
        self._collected: dict[int, list[float]] | None = None
        self.axis = [RmcAxis(self, index) for index in range(axes)]

    def __enter__(self) -> RMC:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End the connection."""
        self.link.close()

    # Registers

    def read(self, place: Place, kind: RegisterType = "REAL") -> Number:
        """One register."""
        return value_of(self.read_bits(place, 1)[0], kind)

    def read_bits(self, place: Place, count: int) -> list[int]:
        """The 32 bits of several registers in a row, at one moment."""
        return from_words(self.link.read(address_of(place) - 1, WORDS * count), self._order)

    def write(self, place: Place, value: Number, kind: RegisterType = "REAL") -> None:
        """One register."""
        self.write_bits(place, [bits_of(value, kind)])

    def write_bits(self, place: Place, bits: Sequence[int]) -> None:
        """Several registers in a row, in one request."""
        self.link.write(address_of(place) - 1, to_words(bits, self._order))

    def variable(self, number: int) -> float:
        """A variable, 0 to 1023."""
        return float(self.read(_variable(number)))

    def set_variable(self, number: int, value: float) -> None:
        """Set a variable."""
        self.write(_variable(number), value)

    # Commands

    def send(self, axis_index: int, numbers: Sequence[float]) -> None:
        """Write a command block; within `together` it waits for the others."""
        if self._collected is None:
            self.write_bits(self.map.command(axis_index), reals(*numbers))
        elif axis_index in self._collected:
            raise ValueError(f"axis {axis_index} already has a command in this write")
        else:
            self._collected[axis_index] = list(numbers)

    @contextmanager
    def together(self) -> Iterator[None]:
        """Commands given within go out in one write when it ends: all axes start at the same loop."""
        self._collected = {}
        try:
            yield
            collected = self._collected
        finally:
            self._collected = None
        if collected:
            self._send_block(collected)

    def _send_block(self, collected: dict[int, list[float]]) -> None:
        """One write over all axes from the first to the last; No-op skips those between."""
        first, last = min(collected), max(collected)
        block: list[float] = []
        for index in range(first, last + 1):
            numbers = collected.get(index, [0.0])
            block += numbers if index == last else [*numbers, *[0.0] * (COMMAND_REGISTERS - len(numbers))]
        self.write_bits(self.map.command(first), reals(*block))


def _variable(number: int) -> Place:
    file, element = divmod(number, 256)
    if not 0 <= file < len(VARIABLE_FILES):
        raise ValueError(f"variables are 0 to {256 * len(VARIABLE_FILES) - 1}, not {number}")
    return Place(VARIABLE_FILES[file], element)

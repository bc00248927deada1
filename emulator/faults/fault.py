"""What a fault is: declared once as data, put into force and lifted, and able to prove that it has acted.

A test that injects a fault nobody ran into proves nothing. So a fault in force is an ``Effect`` that counts what it has
done (a contact that changed, characters that were lost, counts that were not counted) and says since when.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from emulator.parameters import Parameter, Value

if TYPE_CHECKING:
    from emulator.controller import Controller


class FaultError(ValueError):
    """A fault that cannot be had, or is in force already; the text is one line."""


def _nothing() -> None:
    """There is nothing to put back."""


class Effect:
    """A fault in force at one place, or one that was.

    Args:
        since_ns: when it was put into force, virtual ns.
        count: what it did by being put into force.
        lift: puts back what it changed.
        measure: what it has done since, for effects that the servo alone brings about.
    """

    def __init__(
        self,
        since_ns: int,
        *,
        count: int = 0,
        lift: Callable[[], None] = _nothing,
        measure: Callable[[], int] | None = None,
    ) -> None:
        self.since_ns = since_ns
        self.in_force = True
        self._first_ns = since_ns if count else None
        self._count = count
        self._lift = lift
        self._measure = measure

    def note(self, at_ns: int, amount: int = 1) -> None:
        """It has acted."""
        if amount:
            self._first_ns = at_ns if self._first_ns is None else self._first_ns
            self._count += amount

    @property
    def count(self) -> int:
        """How much it has done, in the unit that its registration names."""
        return self._count + (self._measure() if self._measure is not None else 0)

    @property
    def first_ns(self) -> int | None:
        """When it first acted, virtual ns; of what the servo brings about, since when it could."""
        return self.since_ns if self._first_ns is None and self.count else self._first_ns

    def end(self) -> None:
        """Put back what it changed and keep the count."""
        self._count, self._measure = self.count, None
        self.in_force = False
        self._lift()


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """One fault of the control surface.

    ``shows`` says what the unit shows of it (status bits as the manuals count them), ``counts`` what ``Effect.count``
    counts. Of one fault there can be one at each ``place``, which is made of the parameters named so.
    """

    name: str
    sentence: str
    shows: str
    counts: str
    begin: Callable[..., Effect]
    parameters: tuple[Parameter, ...] = ()
    place: tuple[str, ...] = ()
    lasting: bool = True
    """It stays until it is lifted; else it happens once."""

    def key(self, values: Mapping[str, Value]) -> Hashable:
        """What tells it from others in force."""
        return (self.name, *(values[name] for name in self.place))

    def apply(self, controller: Controller, values: Mapping[str, Value]) -> None:
        """Put it into force.

        Raises:
            FaultError: it is in force there already, or this unit cannot have it.
        """
        key = self.key(values)
        present = controller.injected.get(key)
        if self.lasting and present is not None and present.in_force:
            raise FaultError(f"{self.name} is in force there already")
        controller.injected[key] = self.begin(controller, **values)

    def lift(self, controller: Controller, values: Mapping[str, Value]) -> None:
        """Put right what it spoiled.

        Raises:
            FaultError: it is not in force there.
        """
        effect = controller.injected.get(self.key(values))
        if effect is None or not effect.in_force:
            raise FaultError(f"{self.name} is not in force there")
        effect.end()

    def place_parameters(self) -> tuple[Parameter, ...]:
        """Those that say where."""
        return tuple(each for each in self.parameters if each.name in self.place)


AXIS = Parameter("axis", int, "1 or 2")


def axis_index_of(controller: Controller, axis: int) -> int:
    """The index of an axis by its number; FaultError if there is none."""
    if not 1 <= axis <= controller.settings.axes:
        raise FaultError(f"axis must be 1 to {controller.settings.axes}, not {axis}")
    return axis - 1

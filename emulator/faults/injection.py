"""Faults as Python code uses them: a context manager, a pair of calls, or an appointment at a virtual time.

with unit.faults.limit_open(axis=1) as fault:
    ...
assert fault.fired

unit.faults.drive_fault(axis=2).at(2.5, lasting_s=0.1)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Protocol, TypeVar

from emulator.faults import FAULTS, Effect, Fault, FaultError
from emulator.parameters import Value, checked

if TYPE_CHECKING:
    from emulator.controller import Controller

NS_PER_S = 1_000_000_000
T = TypeVar("T")


class Bench(Protocol):
    """Where the unit is: how to do something to it, and how to have something done at a virtual time."""

    controller: Controller

    def do(self, action: str, values: Mapping[str, Value]) -> None:
        """Carry out an action of the registry on the unit."""
        ...

    def ask(self, function: Callable[[], T]) -> T:
        """Call a function that looks at the unit, while nothing else works on it."""
        ...

    def at(self, at_ns: int, function: Callable[[], None]) -> None:
        """Have a function called at a virtual time, where the units are run."""
        ...


class Injection:
    """One fault with its parameters: not in force until ``apply``, ``at`` or ``with`` says so."""

    def __init__(self, bench: Bench, fault: Fault, values: Mapping[str, Value]) -> None:
        self._bench = bench
        self._fault = fault
        self._values = checked(fault.name, fault.parameters, values)
        self._place = {name: self._values[name] for name in fault.place}
        self._effect: Effect | None = None

    @property
    def name(self) -> str:
        """The fault's."""
        return self._fault.name

    def apply(self) -> Injection:
        """Put it into force now.

        Raises:
            FaultError: it is in force there already, or this unit cannot have it.
        """
        self._bench.do(f"fault_{self.name}", self._values)
        self._effect = self._bench.ask(lambda: self._bench.controller.injected[self._fault.key(self._values)])
        return self

    def lift(self) -> None:
        """Put right what it spoiled; a fault that is not in force, or happens only once, has nothing to put right."""
        if self.in_force and self._fault.lasting:
            self._bench.do(f"lift_{self.name}", self._place)

    def at(self, at_s: float, *, lasting_s: float | None = None) -> Injection:
        """Put it into force at a virtual time (s), and lift it after a while if that is given.

        An error at that time is raised to whoever lets time pass.
        """
        at_ns = round(at_s * NS_PER_S)
        self._bench.at(at_ns, self._apply_there)
        if lasting_s is not None:
            self._bench.at(at_ns + round(lasting_s * NS_PER_S), self._lift_there)
        return self

    @property
    def in_force(self) -> bool:
        """It has been put into force and not been lifted."""
        return self._effect is not None and self._effect.in_force

    @property
    def fired(self) -> bool:
        """It has done something; a fault that did nothing tests nothing."""
        return self.count > 0

    @property
    def count(self) -> int:
        """How much it has done, in the unit that its registration names."""
        effect = self._effect
        return 0 if effect is None else self._bench.ask(lambda: effect.count)

    @property
    def first_s(self) -> float | None:
        """When it first acted, virtual seconds; None if it has not."""
        effect = self._effect
        first_ns = None if effect is None else self._bench.ask(lambda: effect.first_ns)
        return None if first_ns is None else first_ns / NS_PER_S

    def assert_fired(self) -> None:
        """AssertionError if it has done nothing."""
        if not self.fired:
            state = "was never put into force" if self._effect is None else "has done nothing"
            raise AssertionError(f"the fault {self} {state}: this test proves nothing about it")

    def __enter__(self) -> Injection:
        return self.apply()

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        self.lift()

    def __repr__(self) -> str:
        return f"{self.name}({', '.join(f'{name}={value!r}' for name, value in self._values.items())})"

    def _apply_there(self) -> None:
        """As ``apply``, called where the units are run."""
        self._carry_out(f"fault_{self.name}", self._values)
        self._effect = self._bench.controller.injected[self._fault.key(self._values)]

    def _lift_there(self) -> None:
        if self.in_force and self._fault.lasting:
            self._carry_out(f"lift_{self.name}", self._place)

    def _carry_out(self, action: str, values: Mapping[str, Value]) -> None:
        from emulator.registry import ACTIONS

        ACTIONS[action].carry_out(self._bench.controller, values)


class UnitFaults:
    """The faults of one unit by name: ``faults.limit_open(axis=1)`` is an Injection; iterating gives the names."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench

    def __getattr__(self, name: str) -> Callable[..., Injection]:
        if name not in FAULTS:
            raise AttributeError(f"no fault {name!r}; there are {', '.join(FAULTS)}")
        return lambda **values: self.inject(name, **values)

    def inject(self, name: str, **values: Value) -> Injection:
        """A fault by its name; not in force yet.

        Raises:
            FaultError: there is no such fault.
            KeyError: a parameter is missing or unknown.
            TypeError: a parameter has the wrong type.
        """
        if name not in FAULTS:
            raise FaultError(f"no fault {name!r}; there are {', '.join(FAULTS)}")
        return Injection(self._bench, FAULTS[name], values)

    def __iter__(self) -> Iterator[str]:
        return iter(FAULTS)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *FAULTS]

"""One unit as a test handles it: signals, inputs and outputs by name, actions, faults, and its state in words.

The same for a unit in this process and for one behind ports: where it lives is the bench's business.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from typing import TYPE_CHECKING

from emulator.faults.injection import Bench, UnitFaults
from emulator.parameters import Value
from emulator.registry import ACTIONS, describe_signals
from protocol.status import AxisStatus, ErrorStatus

if TYPE_CHECKING:
    from emulator.controller import Controller

NS_PER_S = 1_000_000_000


class UnitSignals(Mapping[str, Value]):
    """The signals of the registry by name."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._signals = describe_signals(bench.controller)

    def __getitem__(self, name: str) -> Value:
        if name not in self._signals:
            raise KeyError(f"no signal {name!r}; there are {', '.join(self._signals)}")
        return self._bench.ask(lambda: self._signals[name].read(self._bench.controller))

    def __iter__(self) -> Iterator[str]:
        return iter(self._signals)

    def __len__(self) -> int:
        return len(self._signals)


class Inputs(MutableMapping[str, bool]):
    """Contacts by name; True is closed (grounded).  ``inputs["input.3"] = True``, or a name of the test's own."""

    def __init__(self, bench: Bench, names: Mapping[str, str]) -> None:
        self._bench = bench
        self._names = names

    def __getitem__(self, name: str) -> bool:
        wire = self._wire(name)
        return self._bench.ask(lambda: self._bench.controller.wiring.closed(wire))

    def __setitem__(self, name: str, closed: bool) -> None:
        self._bench.do("set_wire", {"name": self._wire(name), "closed": closed})

    def __delitem__(self, name: str) -> None:
        raise TypeError("a contact cannot be removed; set it to True or False")

    def __iter__(self) -> Iterator[str]:
        return iter(self._bench.controller.wiring.names)

    def __len__(self) -> int:
        return len(self._bench.controller.wiring.names)

    def _wire(self, name: str) -> str:
        wire = self._names.get(name, name)
        known = self._bench.controller.wiring.names
        if wire not in known:
            raise KeyError(f"no input {name!r}; there are {', '.join([*self._names, *known])}")
        return wire


class Outputs(Mapping[str, bool]):
    """Outputs by name; True is on.  ``outputs["output.2"]``, or a name of the test's own."""

    def __init__(self, bench: Bench, names: Mapping[str, str]) -> None:
        self._bench = bench
        self._names = names
        count = bench.controller.output_functions.count
        self._numbers = {f"output.{number}": number for number in range(1, count + 1)}

    def __getitem__(self, name: str) -> bool:
        number = self._numbers.get(self._names.get(name, name))
        if number is None:
            raise KeyError(f"no output {name!r}; there are {', '.join([*self._names, *self._numbers])}")
        return self._bench.ask(lambda: self._bench.controller.output_functions.bits()[number - 1] == "1")

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)


class UnitControl:
    """What a test sees of and does to one unit beside its wire.

    Args:
        bench: where the unit is.
        names: names of the test's own for inputs and outputs: ``{"start": "input.3", "lamp": "output.2"}``.
    """

    def __init__(self, bench: Bench, names: Mapping[str, str]) -> None:
        self.bench = bench
        self.signals = UnitSignals(bench)
        self.inputs = Inputs(bench, names)
        self.outputs = Outputs(bench, names)

    @property
    def faults(self) -> UnitFaults:
        """``with unit.faults.limit_open(axis=1) as fault:`` (docs/testing.md)."""
        return UnitFaults(self.bench)

    def do(self, action: str, **parameters: Value) -> None:
        """Carry out an action of the registry; KeyError if there is none of that name."""
        if action not in ACTIONS:
            raise KeyError(f"no action {action!r}; there are {', '.join(ACTIONS)}")
        self.bench.do(action, parameters)

    def describe(self) -> str:
        """The state in words: both axes, the error word, contacts that stop motion, faults in force."""
        return self.bench.ask(lambda: describe(self.bench.controller))


def describe(controller: Controller) -> str:
    """The state of a unit, a few lines."""
    lines = [f"virtual time {controller.now_ns / NS_PER_S:.9f} s" + ("" if controller.powered else ", switched off")]
    lines += [_axis(controller, axis_index) for axis_index in range(controller.settings.axes)]
    error = controller.faults.word
    lines.append(f"ER: {_bits(ErrorStatus, error)}; ENABLE {'closed' if controller.wiring.enable_grounded else 'open'}")
    if controller.faults.command_text:
        lines.append(f"last refused command: {controller.faults.command_text}")
    names = [str(key[0]) for key, effect in controller.injected.items() if effect.in_force and isinstance(key, tuple)]
    if names:
        lines.append(f"faults in force: {', '.join(names)}")
    return "\n".join(lines)


def _axis(controller: Controller, axis_index: int) -> str:
    engine = controller.engine
    drive = "on" if engine.is_enabled(axis_index) else "off"
    return (
        f"axis {axis_index + 1}: commanded {engine.commanded_position(axis_index):+d}"
        f" encoder {engine.encoder_position(axis_index):+d} error {engine.position_error(axis_index):+d} counts,"
        f" {engine.true_velocity_rev_s(axis_index):+.4f} rev/s, output {engine.dac_volts(axis_index):+.3f} V,"
        f" drive {drive}; AS: {_bits(AxisStatus, engine.status(axis_index))}"
    )


def _bits(word: type[AxisStatus] | type[ErrorStatus], value: int) -> str:
    """`1 moving, 24 in target zone`."""
    return ", ".join(f"{bit.value} {bit.name.lower().replace('_', ' ')}" for bit in word if value & bit.mask) or "none"

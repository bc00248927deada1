"""The wires at the unit's terminals: contacts that are closed (grounded) or open, and the analogue voltages.

This is the one interface through which the outside (machine file, Python, later a panel) drives inputs.  A change is
seen by the unit at its next system update."""

from __future__ import annotations

from collections.abc import Sequence

from emulator.engine import ENABLE_MASK, Engine, Wire, wire_mask
from emulator.machine import Machine

TRIGGERS = 2
"""TRG-A and TRG-B, the bits after the programmable inputs."""

ANALOG_CHANNELS = 3
ANALOG_STEP_V = 2.5 / 256
"""Resolution of the joystick inputs: 8 bits over 0 to 2.5 V (6250 UG p.67)."""


class Wiring:
    """The terminals of one unit; wire names are ``enable``, ``axis1.positive_limit`` ... ``input.1`` ...
    ``trigger.a``."""

    def __init__(self, engine: Engine, machine: Machine) -> None:
        self._engine = engine
        self.inputs = machine.io.inputs
        self.input_count = machine.io.inputs + TRIGGERS
        self._masks = self._name_wires(len(machine.axes))
        self._input_masks = self._name_inputs()
        self.analog_volts = list(machine.wires.analog)
        self._connect(machine)

    def _name_wires(self, axes: int) -> dict[str, int]:
        masks = {"enable": ENABLE_MASK}
        for axis_index in range(axes):
            for wire in Wire:
                masks[f"axis{axis_index + 1}.{wire.name.lower()}"] = wire_mask(wire, axis_index)
        return masks

    def _name_inputs(self) -> dict[str, int]:
        masks = {f"input.{number}": 1 << (number - 1) for number in range(1, self.inputs + 1)}
        masks["trigger.a"] = 1 << self.inputs
        masks["trigger.b"] = 1 << (self.inputs + 1)
        return masks

    def _connect(self, machine: Machine) -> None:
        closed = {"enable": machine.wires.enable == "closed"}
        for number, axis in enumerate(machine.axes, start=1):
            for wire in Wire:
                closed[f"axis{number}.{wire.name.lower()}"] = getattr(axis.wires, wire.name.lower()) == "closed"
        for name, is_closed in closed.items():
            self.set(name, closed=is_closed)
        self._engine.set_inputs(sum(1 << (number - 1) for number in set(machine.wires.inputs)))

    @property
    def names(self) -> Sequence[str]:
        """Every contact that can be closed or opened."""
        return (*self._masks, *self._input_masks)

    def closed(self, name: str) -> bool:
        """Whether a contact is closed; KeyError for a name the unit does not have."""
        if name in self._masks:
            return bool(self._engine.wires & self._masks[name])
        return bool(self._engine.inputs & self._input_masks[name])

    def set(self, name: str, *, closed: bool) -> None:
        """Close or open a contact; KeyError for a name the unit does not have."""
        if name in self._masks:
            self._engine.set_wires(_with(self._engine.wires, self._masks[name], closed))
        else:
            self._engine.set_inputs(_with(self._engine.inputs, self._input_masks[name], closed))

    @property
    def enable_grounded(self) -> bool:
        """The ENABLE input allows motion."""
        return bool(self._engine.wires & ENABLE_MASK)

    def limit_grounded(self, axis_index: int, direction: int) -> bool:
        """The end-of-travel input of a direction (+1, -1) is closed."""
        wire = Wire.POSITIVE_LIMIT if direction > 0 else Wire.NEGATIVE_LIMIT
        return bool(self._engine.wires & wire_mask(wire, axis_index))

    def drive_fault_grounded(self, axis_index: int) -> bool:
        """The drive-fault input of an axis is pulled low."""
        return bool(self._engine.wires & wire_mask(Wire.DRIVE_FAULT, axis_index))

    def limit_bits(self, axes: int) -> str:
        """TLIM: positive end, negative end, home of each axis; 1 = closed, whatever the level commands say."""
        wires = (Wire.POSITIVE_LIMIT, Wire.NEGATIVE_LIMIT, Wire.HOME)
        return "".join(
            "1" if self._engine.wires & wire_mask(wire, axis_index) else "0"
            for axis_index in range(axes)
            for wire in wires
        )

    def input_bits(self, *, active_levels: str, overrides: str) -> str:
        """TIN: 1 = active after INLVL; INEN digits 0 and 1 force an input, E leaves it real."""
        return "".join(
            override if override in "01" else str((self._engine.inputs >> index & 1) ^ int(level))
            for index, (level, override) in enumerate(zip(active_levels, overrides, strict=True))
        )

    def analog_reading(self, channel_index: int) -> float:
        """Voltage of a joystick channel as the converter reads it."""
        volts = self.analog_volts[channel_index]
        return min(int(volts / ANALOG_STEP_V), 255) * ANALOG_STEP_V


def _with(bits: int, mask: int, on: bool) -> int:
    return bits | mask if on else bits & ~mask

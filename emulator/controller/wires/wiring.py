"""The wires at the unit's terminals: contacts that are closed (grounded) or open, and the analogue voltages.

This is the one interface through which the outside (machine file, Python, later a panel) drives inputs: ``set`` for
contacts by name, ``set_analog`` for voltages.  A change is noticed by the unit at its next system update; programmable
inputs then have to keep it for the time of INDEB, ENABLE, limits and drive faults act at once.  Outputs are read from
``output_functions``.
"""

from __future__ import annotations

from collections.abc import Sequence

from emulator.engine import ENABLE_MASK, AnalogSensor, Engine, Wire, wire_mask
from emulator.machine import Machine
from protocol.status import OtherInputs

TRIGGERS = 2
"""TRG-A and TRG-B, the bits after the programmable inputs."""

FIRST_JOYSTICK_BIT = 32
"""Contacts of the joystick connector lie above the programmable inputs in the word the servo watches."""

JOYSTICK_CONTACTS = {
    "joystick.auxiliary": OtherInputs.JOYSTICK_AUXILIARY,
    "joystick.trigger": OtherInputs.JOYSTICK_TRIGGER,
    "joystick.axes_select": OtherInputs.JOYSTICK_AXES_SELECT,
    "joystick.velocity_select": OtherInputs.JOYSTICK_VELOCITY_SELECT,
    "joystick.release": OtherInputs.JOYSTICK_RELEASE,
}
"""The digital inputs of the joystick connector by wire name; closed = sinking current = 1 in INO."""

LOWEST_ANALOG_V, HIGHEST_ANALOG_V = 0.0, 2.5
"""Range of the joystick channels (6250 UG p.67)."""

ANI_RANGE_V = 10.0
"""Range of the ANI feedback inputs, +-V (assumed M)."""


class Wiring:
    """The terminals of one unit; wire names are ``enable``, ``axis1.positive_limit`` ... ``input.1`` ...
    ``trigger.a``, ``joystick.release`` ..."""

    def __init__(self, engine: Engine, machine: Machine) -> None:
        self._engine = engine
        self.inputs = machine.io.inputs
        self.input_count = machine.io.inputs + TRIGGERS
        self._masks = self._name_wires(len(machine.axes))
        self._input_masks = self._name_inputs()
        self.analog_volts = list(machine.wires.analog)
        self._ani_sensors = [AnalogSensor(axis.ani.volts_at_zero, axis.ani.volts_per_rev) for axis in machine.axes]
        for trigger_index in range(TRIGGERS):
            engine.connect_trigger(trigger_index, 1 << (self.inputs + trigger_index))
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
        return masks | {name: self.joystick_mask(contact) for name, contact in JOYSTICK_CONTACTS.items()}

    @staticmethod
    def joystick_mask(contact: OtherInputs) -> int:
        """The bit of a joystick contact in the engine's input word."""
        return 1 << (FIRST_JOYSTICK_BIT + contact.value - 1)

    def input_name(self, number: int) -> str:
        """The wire of an input by its number in IN: the triggers come after the programmable inputs."""
        if number <= self.inputs:
            return f"input.{number}"
        return ("trigger.a", "trigger.b")[number - self.inputs - 1]

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

    def word(self, name: str) -> tuple[str, int]:
        """Where the servo keeps a contact: the field of its unit record, and the bit; KeyError for an unknown name."""
        if name in self._masks:
            return "wires", self._masks[name]
        return "inputs", self._input_masks[name]

    def closed(self, name: str) -> bool:
        """Whether a contact is closed; KeyError for a name the unit does not have."""
        if name in self._masks:
            return bool(self._engine.wires & self._masks[name])
        return bool(self._engine.inputs & self._input_masks[name])

    def closed_at_rest(self, name: str) -> bool:
        """Whether a contact is closed while no switch along the travel, and no mark sensor, is operated;
        KeyError as ``closed``."""
        if name in self._masks:
            return bool(self._engine.resting_wires & self._masks[name])
        return bool(self._engine.resting_inputs & self._input_masks[name])

    def set(self, name: str, *, closed: bool) -> None:
        """Close or open a contact; KeyError for a name the unit does not have.

        A contact with a switch along the travel, or a mark sensor, is given the state it has while that is not
        operated.
        """
        if name in self._masks:
            self._engine.set_wires(_with(self._engine.resting_wires, self._masks[name], closed))
        else:
            self._engine.set_inputs(_with(self._engine.resting_inputs, self._input_masks[name], closed))

    def set_analog(self, channel: int, *, volts: float) -> None:
        """Set the voltage of a joystick channel (1 to 3).

        Raises:
            KeyError: no such channel.
            ValueError: a voltage outside 0 to 2.5 V.
        """
        if not 1 <= channel <= len(self.analog_volts):
            raise KeyError(f"no analogue channel {channel}; there are 1 to {len(self.analog_volts)}")
        if not LOWEST_ANALOG_V <= volts <= HIGHEST_ANALOG_V:
            raise ValueError(f"a joystick channel takes 0 to 2.5 V, not {volts}")
        self.analog_volts[channel - 1] = volts
        self._engine.report_wires()

    def force_ani(self, axis: int, *, volts: float) -> None:
        """Hold the ANI feedback input of an axis (1 ...) at a voltage.

        Raises:
            KeyError: no such axis.
            ValueError: a voltage outside +-10 V, or the option is not fitted.
        """
        if not -ANI_RANGE_V <= volts <= ANI_RANGE_V:
            raise ValueError(f"an ANI feedback input takes -10 to 10 V, not {volts}")
        self._connect_ani(axis, AnalogSensor(volts_at_zero=volts))

    def release_ani(self, axis: int) -> None:
        """Connect the ANI feedback input of an axis (1 ...) to its sensor again; errors as ``force_ani``."""
        self._connect_ani(axis, self._ani_sensors[axis - 1] if 1 <= axis <= len(self._ani_sensors) else None)

    def _connect_ani(self, axis: int, sensor: AnalogSensor | None) -> None:
        if sensor is None or not 1 <= axis <= len(self._ani_sensors):
            raise KeyError(f"no axis {axis}; there are 1 to {len(self._ani_sensors)}")
        self._engine.set_analog_sensor(axis - 1, sensor)

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

    @staticmethod
    def input_bits(contacts: int, *, active_levels: str, overrides: str) -> str:
        """IN of a state of the contacts: 1 = active after INLVL; INEN digits 0 and 1 force an input, E leaves it
        real."""
        return "".join(
            override if override in "01" else str((contacts >> index & 1) ^ int(level))
            for index, (level, override) in enumerate(zip(active_levels, overrides, strict=True))
        )


def _with(bits: int, mask: int, on: bool) -> int:
    return bits | mask if on else bits & ~mask

"""The parameters of an axis: kept as written, checked, and put to work.

An element that no page at hand names is kept and shown and does nothing. A value that is not allowed is refused with
the Configuration Error bit; so is one that may only be changed while the axis is disabled or in Direct Output (M908).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Literal

from emulator.engine.plants import Plant, PlantError, load_fields, plant_fields
from protocol.rmc.bits import AUTOSTOP_BITS, AUTOSTOP_FIELDS, AutoStop, ControlMode, ErrorBits
from protocol.rmc.maps import ELEMENTS, MapName
from protocol.rmc.registers import (
    LAST_SIMULATOR_ELEMENT,
    PARAMETER_BY_ELEMENT,
    PARAMETERS,
    SIMULATOR_ELEMENTS,
)
from protocol.rmc.words import Number, RegisterType, bits_of, value_of

from .axis import Axis, Complaint
from .filters import LOWEST_HZ, sections
from .layout import BODIES_PER_AXIS, MODEL, SECTIONS
from .simulator import DEFAULT_TIME_CONSTANT_S, first_order, second_order

Simulate = Literal["off", "first_order", "second_order"]

FIELDS: Mapping[int, str] = {
    5: "stop_threshold",
    33: "output_bias",
    38: "output_scale",
    41: "deadband_tolerance",
    42: "output_deadband",
    56: "in_position_tolerance",
    57: "position_error_tolerance",
    58: "at_velocity_tolerance",
    59: "velocity_error_tolerance",
    61: "proportional",
    62: "integral",
    63: "differential",
    65: "velocity_ff_positive",
    66: "acceleration_ff",
    67: "jerk_ff",
    68: "velocity_ff_negative",
    69: "double_differential",
    70: "triple_differential",
    92: "positive_travel_limit",
    93: "negative_travel_limit",
}
"""Parameters that are a field of the axis record as they are."""

FILTER_TYPE_BITS: Mapping[MapName, tuple[int, int]] = {"rmc150": (4, 6), "rmc75": (13, 15)}
"""Lowest bits of the velocity and acceleration filter types in PriInputBits (M924, M927)."""
STATUS_ONLY, LOW_PASS = 0, 1
ROTARY = 1
SYMMETRICAL_BIT = 1 << 4
INTEGRATOR_MODE_MASK = 0xF
HIGHEST_INTEGRATOR_MODE = 2
NO_TRANSDUCER = 6
"""Error bit whose AutoStop may not be Status Only (M1018)."""


class Parameters:
    """The 256 elements of an axis's parameter file, as bits, and what they do."""

    def __init__(self, axis: Axis, *, map_name: MapName, simulate: Simulate = "off") -> None:
        self._axis = axis
        self._map = map_name
        self._simulate = simulate
        self._bits = [0] * ELEMENTS
        for parameter in PARAMETERS:
            self._bits[parameter.element] = bits_of(parameter.default, parameter.kind)
        if simulate == "first_order":
            self._bits[118] = bits_of(DEFAULT_TIME_CONSTANT_S)

    def bits(self, element: int) -> int:
        """A register as it is read."""
        return self._bits[element]

    def __getitem__(self, element: int) -> Number:
        return value_of(self._bits[element], kind_of(element))

    def load(self, values: Mapping[int, float]) -> None:
        """Put all into force at power-up, with `values` in place of defaults."""
        for element, value in values.items():
            self._bits[element] = bits_of(value, kind_of(element))
        for parameter in PARAMETERS:
            if parameter.element not in SIMULATOR_ELEMENTS:
                self._apply(parameter.element)
        self._renew_model()

    def write(self, element: int, bits: int) -> bool:
        """Write a register as a master does; False if it was refused, with the error bit set."""
        complaint = self._complaint(element, value_of(bits, kind_of(element)))
        if complaint is not None:
            self._axis.complain(ErrorBits.CONFIGURATION, complaint)
            return False
        self._bits[element] = bits
        if element in SIMULATOR_ELEMENTS:
            self._touch_model(element)
        else:
            self._apply(element)
        return True

    def keep(self, element: int, value: float) -> None:
        """Let a parameter show what is already in force."""
        self._bits[element] = bits_of(value, kind_of(element))

    def set(self, element: int, value: float) -> None:
        """Change a parameter from inside the controller, which no rule stops."""
        self._bits[element] = bits_of(value, kind_of(element))
        self._apply(element)

    def _complaint(self, element: int, value: Number) -> Complaint | None:
        parameter = PARAMETER_BY_ELEMENT.get(element)
        if parameter is None:
            return None
        if not parameter.allows(value) or not self._consistent(element, value):
            return Complaint.VALUE_OUT_OF_RANGE
        free = not self._axis.integer("enabled") or self._axis.mode == ControlMode.DIRECT_OUTPUT
        return Complaint.WRITTEN_WHILE_ENABLED if parameter.frozen_while_enabled and not free else None

    def _consistent(self, element: int, value: Number) -> bool:
        """What a range cannot say."""
        if element in _CONSISTENT:
            return _CONSISTENT[element](self, value)
        if element == 9:
            types = [int(value) >> bit & 3 for bit in FILTER_TYPE_BITS[self._map]]
            return not int(value) & ROTARY and set(types) <= {STATUS_ONLY, LOW_PASS}
        if 106 <= element <= 108:
            return _levels_are_known(int(value)) and not (element == 106 and _level(int(value), NO_TRANSDUCER) == 0)
        if element in SIMULATOR_ELEMENTS:
            return self._model_of({**self._model_values(), element: float(value)}) is not None
        return True

    def _apply(self, element: int) -> None:
        if element in FIELDS:
            self._axis.write(**{FIELDS[element]: self[element]})
        elif element in _APPLIED:
            _APPLIED[element](self)

    def _apply_scale(self) -> None:
        """Position scale and offset: the axis stands somewhere else in pu from one loop to the next, at rest."""
        scale, offset = float(self[0]), float(self[1])
        self._axis.write(position_scale=scale, position_offset=offset, half_count=0.5 * abs(scale))
        self._count_model(scale)
        position = self._axis.integer("raw_counts") * scale + offset
        names = ("actual_position", "previous_position", "shown_position", "target_position", "command_position")
        self._axis.write(**dict.fromkeys(names, position))

    def _count_model(self, scale: float) -> None:
        """The model's counts, a position-unit being 1 / scale of them."""
        if self._simulate == "off":
            return
        memory, index = self._axis.memory, BODIES_PER_AXIS * self._axis.index + MODEL
        sign = 1 if scale > 0.0 else -1
        reading = math.floor(float(memory.bodies[index]["true_position"]) / abs(scale))
        fields = {"counts_per_rev": 1.0 / abs(scale), "encoder_sign": sign, "encoder_reading": reading}
        memory.write_body(index, {**fields, "encoder_counts": sign * reading})
        self._axis.write(raw_counts=sign * reading)

    def _apply_filter(self, element: int) -> None:
        loop_s = float(self._axis.memory.device["loop_s"][0])
        first = (element - 2) * SECTIONS
        self._axis.memory.write_filter(self._axis.index, first, sections(float(self[element]), loop_s))

    def _apply_input_bits(self) -> None:
        velocity, acceleration = (int(self[9]) >> bit & 3 for bit in FILTER_TYPE_BITS[self._map])
        self._axis.write(low_pass_velocity=velocity == LOW_PASS, low_pass_acceleration=acceleration == LOW_PASS)

    def _apply_control_bits(self) -> None:
        bits = int(self[60])
        self._axis.write(integrator_mode=bits & INTEGRATOR_MODE_MASK, symmetrical=bool(bits & SYMMETRICAL_BIT))

    def _apply_autostops(self) -> None:
        masks = dict.fromkeys(AutoStop, 0)
        for register in range(3):
            for field in range(AUTOSTOP_FIELDS):
                bit = register * AUTOSTOP_FIELDS + field
                masks[AutoStop(_level(int(self[106 + register]), field))] |= 1 << bit
        self._axis.write(
            external_mask=masks[AutoStop.EXTERNAL_HALT],
            closed_loop_mask=masks[AutoStop.CLOSED_LOOP_HALT],
            open_loop_mask=masks[AutoStop.OPEN_LOOP_HALT],
            direct_output_mask=masks[AutoStop.DIRECT_OUTPUT_HALT],
        )

    # Simulate mode

    def _touch_model(self, element: int) -> None:
        """Writing a parameter of the simulator suspends the model until the last of them is written (M965)."""
        self._axis.write(model_held=element != LAST_SIMULATOR_ELEMENT)
        if element == LAST_SIMULATOR_ELEMENT:
            self._renew_model()

    def _model_values(self) -> dict[int, float]:
        return {element: float(self[element]) for element in (117, 118, 119)}

    def _model_of(self, values: Mapping[int, float]) -> Plant | None:
        """The model of these parameters; None for what cannot be."""
        loop_s = float(self._axis.memory.device["loop_s"][0])
        try:
            if self._simulate == "first_order":
                return first_order(values[117], values[118]) if values[118] >= loop_s else None
            return second_order(values[117], values[118], values[119])
        except PlantError:
            return None

    def _renew_model(self) -> None:
        if self._simulate == "off":
            return
        plant = self._model_of(self._model_values())
        assert plant is not None, "every value was checked when it was written"
        memory, index = self._axis.memory, BODIES_PER_AXIS * self._axis.index + MODEL
        memory.write_plant(index, plant_fields(plant, float(memory.device["loop_s"][0])))
        memory.write_body(index, load_fields(plant))


def kind_of(element: int) -> RegisterType:
    """Type of a parameter register; unnamed ones are REAL."""
    parameter = PARAMETER_BY_ELEMENT.get(element)
    return parameter.kind if parameter is not None else "REAL"


def _level(word: int, field: int) -> int:
    return word >> AUTOSTOP_BITS * field & (1 << AUTOSTOP_BITS) - 1


def _levels_are_known(word: int) -> bool:
    return all(_level(word, field) in set(AutoStop) for field in range(AUTOSTOP_FIELDS))


_CONSISTENT: dict[int, Callable[[Parameters, Number], bool]] = {
    0: lambda _, value: value != 0.0,
    38: lambda _, value: value != 0.0,
    2: lambda _, value: value == 0.0 or value > LOWEST_HZ,
    3: lambda _, value: value == 0.0 or value > LOWEST_HZ,
    4: lambda _, value: value == 0.0 or value > LOWEST_HZ,
    60: lambda _, value: (int(value) & INTEGRATOR_MODE_MASK) <= HIGHEST_INTEGRATOR_MODE,
    92: lambda parameters, value: value >= parameters[93],
    93: lambda parameters, value: value <= parameters[92],
}

_APPLIED: dict[int, Callable[[Parameters], None]] = {
    0: Parameters._apply_scale,
    1: Parameters._apply_scale,
    2: lambda parameters: parameters._apply_filter(2),
    3: lambda parameters: parameters._apply_filter(3),
    4: lambda parameters: parameters._apply_filter(4),
    9: Parameters._apply_input_bits,
    32: lambda parameters: parameters._axis.write(invert_output=int(parameters[32]) & 1),
    60: Parameters._apply_control_bits,
    94: lambda parameters: parameters._axis.write(s_curve=parameters[94] != 0.0),
    106: Parameters._apply_autostops,
    107: Parameters._apply_autostops,
    108: Parameters._apply_autostops,
}

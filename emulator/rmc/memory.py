"""The arrays one RMC lives in, and windows on their words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from emulator.engine.kernels import Floats, Records
from emulator.engine.layout import PLANT, WORD_BYTES, places_of, word_of
from emulator.engine.memory import words_of, write_fields
from protocol.rmc.maps import VARIABLES

from .layout import AXIS, BODIES_PER_AXIS, BODY, DEVICE, FILTER, FILTERS_PER_AXIS, RAMP, RAMPS_PER_AXIS
from .ramps import Ramp

AXIS_WORDS = AXIS.itemsize // WORD_BYTES


class Memory:
    """Records of one device with `axis_count` axes; nothing in it ever moves."""

    def __init__(self, axis_count: int, loop_ns: int) -> None:
        self.device: Records = np.zeros(1, DEVICE)
        self.axes: Records = np.zeros(axis_count, AXIS)
        self.bodies: Records = np.zeros(axis_count * BODIES_PER_AXIS, BODY)
        self.plants: Records = np.zeros(axis_count * BODIES_PER_AXIS, PLANT)
        self.ramps: Records = np.zeros(axis_count * RAMPS_PER_AXIS, RAMP)
        self.filters: Records = np.zeros(axis_count * FILTERS_PER_AXIS, FILTER)
        self.variables: Floats = np.zeros(VARIABLES)
        self.axis_floats: Floats = self.axes.view(np.float64)
        self.device_words = words_of(self.device, 0)
        self.axis = [words_of(self.axes, index) for index in range(axis_count)]
        self.body = [words_of(self.bodies, index) for index in range(len(self.bodies))]
        self.axes["ramp_first"] = np.arange(axis_count) * RAMPS_PER_AXIS
        loop_s = loop_ns * 1e-9
        fields = {"axis_count": axis_count, "loop_ns": loop_ns, "loop_s": loop_s, "loops_per_s": 1.0 / loop_s}
        write_fields(self.device_words, DEVICE, {**fields, "next_loop_ns": loop_ns})

    def addresses(self) -> npt.NDArray[np.uintp]:
        """Where the arrays lie, in the order in which the compiled kernel expects them."""
        return np.array([array.ctypes.data for array in self.arrays()], np.uintp)

    def arrays(self) -> Sequence[npt.NDArray[Any]]:
        """All arrays in the kernel's order, the words of the axes left out."""
        return (self.device, self.axes, self.bodies, self.plants, self.ramps, self.filters, self.variables)

    def write(self, axis_index: int, **fields: float) -> None:
        """Set fields of an axis; KeyError for an unknown name."""
        write_fields(self.axis[axis_index], AXIS, fields)

    def write_body(self, body_index: int, fields: Mapping[str, float]) -> None:
        """Set fields of a body; those a servo axis has and a body has not are left out."""
        known = BODY.names or ()
        write_fields(self.body[body_index], BODY, {name: value for name, value in fields.items() if name in known})

    def write_plant(self, body_index: int, fields: Mapping[str, float]) -> None:
        """Replace what drives a body."""
        write_fields(words_of(self.plants, body_index), PLANT, fields)

    def write_filter(self, axis_index: int, first: int, sections: Sequence[Mapping[str, float]]) -> None:
        """Set the sections of a filter, the first at place `first` of the axis's."""
        for offset, fields in enumerate(sections):
            write_fields(words_of(self.filters, axis_index * FILTERS_PER_AXIS + first + offset), FILTER, fields)

    def store_plan(self, axis_index: int, plan: Sequence[Ramp]) -> None:
        """Write a plan into the ramps of an axis; ValueError if it has more than there are."""
        if len(plan) > RAMPS_PER_AXIS:
            raise ValueError(f"a plan of {len(plan)} ramps, {RAMPS_PER_AXIS} at most")
        start_s = position = 0.0
        for row, ramp in enumerate(plan, start=axis_index * RAMPS_PER_AXIS):
            c2, c3, c4, c5 = ramp.higher
            fields = (start_s, ramp.duration_s, position, ramp.velocity, ramp.change, ramp.shape, c2, c3, c4, c5)
            self.ramps[row] = fields
            start_s += ramp.duration_s
            position += ramp.distance
        self.write(axis_index, ramp_count=len(plan), ramp_index=0, generator_loops=0)

    def snapshot(self) -> bytes:
        """Every byte of the state; equal for equal states."""
        return b"".join(array.tobytes() for array in self.arrays())


def master_word(axis_index: int, field: str) -> int:
    """Place of an axis's field among the words of all axes."""
    return axis_index * AXIS_WORDS + word_of(AXIS, field)


def axis_word(field: str) -> tuple[int, bool]:
    """Place of a field in an axis record, and whether it is an integer."""
    return places_of(AXIS)[field]

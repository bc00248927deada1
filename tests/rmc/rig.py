"""Devices and axis records for tests of the RMC."""

from __future__ import annotations

from typing import Any

import numpy as np

from emulator.machine import Machine
from emulator.rmc.device import RmcDevice
from emulator.rmc.layout import AXIS

NS_PER_S = 1_000_000_000

CYLINDER = """
[rmc]
axes = 1
enabled_at_start = true
[axis1]
plant = { preset = "documented_cylinder", valve_hz = 200.0 }
encoder = { counts_per_unit = 100_000 }
[axis1.rmc.parameters]
PosScale = 0.00001
PositionErrorTolerance = 1000.0
VelocityErrorTolerance = 1000.0
RequestedJerk = 0.0
"""
"""The cylinder of the manual's example: 3 in/s a volt outwards, 2.3 inwards."""


def axis_record(**fields: float) -> Any:
    """An axis in Position PID with the defaults of its parameters that the law needs."""
    record = np.zeros(1, AXIS)[0]
    values = {"mode": 3, "integrator_mode": 1, "output_scale": 10.0, "output_limit": 10.0, "gain_ratio": 1.0, **fields}
    for name, value in values.items():
        record[name] = value
    return record


def device(text: str = CYLINDER, **parameters: float) -> RmcDevice:
    """A device of a machine file's text, with parameters of its first axis set besides."""
    built = RmcDevice(Machine.parse(text))
    set_parameters(built, **parameters)
    return built


def set_parameters(built: RmcDevice, axis_index: int = 0, **parameters: float) -> None:
    """Set parameters by tag as if they had been written in the machine file."""
    from protocol.rmc.registers import PARAMETER_BY_TAG

    for tag, value in parameters.items():
        built.parameters[axis_index].set(PARAMETER_BY_TAG[tag].element, value)


def command(built: RmcDevice, *numbers: float, axis: int = 0) -> None:
    """One command to one axis."""
    built.execute({axis: list(numbers)})


def run(built: RmcDevice, seconds: float) -> None:
    """Advance virtual time."""
    built.advance(built.now_ns + round(seconds * NS_PER_S))


def trace(built: RmcDevice, seconds: float, *fields: str, axis: int = 0) -> dict[str, Any]:
    """Fields of an axis after every loop of some time."""
    loops = round(seconds * NS_PER_S / built.loop_ns)
    rows = np.empty((loops, len(fields)))
    for row in rows:
        built.advance(built.now_ns + built.loop_ns)
        row[:] = [built.axes[axis][field] for field in fields]
    return dict(zip(fields, rows.T, strict=True))

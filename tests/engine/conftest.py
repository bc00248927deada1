"""Engines as the proofs need them: default plants on the two-axis default rates, or whatever a test asks for."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from emulator.engine import AxisHardware, Engine, Plant, ServoRates, VelocityDrive, rates_for

ALL_CLOSED = 0xFFF
"""Every wire of two axes grounded: ENABLE, limits, homes."""

MakeEngine = Callable[..., Engine]


def build_engine(
    *plants: Plant,
    rates: ServoRates | None = None,
    enabled: bool = True,
    output_delay_s: float = 0.0,
    **options: float,
) -> Engine:
    hardware = [AxisHardware(plant, **options) for plant in plants or (VelocityDrive(),)]  # type: ignore[arg-type]
    engine = Engine(hardware, rates=rates or rates_for(2, 4), output_delay_s=output_delay_s)
    engine.set_wires(ALL_CLOSED)
    engine.run(engine.next_system_update_ns)
    for axis_index in range(len(hardware)):
        if enabled:
            engine.enable(axis_index)
    return engine


@pytest.fixture
def make_engine() -> MakeEngine:
    return build_engine

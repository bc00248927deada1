"""Quantisation of the analogue output."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from emulator.engine.converter import convert_output, dac_fields
from emulator.engine.layout import UNIT


def converter(bits: int) -> Any:
    unit = np.zeros(1, UNIT)[0]
    for name, value in dac_fields(bits).items():
        unit[name] = value
    return unit


@pytest.mark.parametrize(("bits", "step_v"), [(16, 20 / 65536), (12, 20 / 4096)])
def test_every_voltage_becomes_the_nearest_step(bits: int, step_v: float) -> None:
    unit = converter(bits)
    for volts in np.linspace(-9.99, 9.98, 997):
        given_v = convert_output(unit, float(volts))
        assert abs(given_v - volts) <= step_v / 2 + 1e-12
        assert given_v / step_v == round(given_v / step_v)


def test_the_range_is_that_of_twos_complement() -> None:
    unit = converter(16)
    assert convert_output(unit, 10.0) == 10.0 - 20 / 65536
    assert convert_output(unit, -10.0) == -10.0


def test_zero_is_zero() -> None:
    assert convert_output(converter(12), 0.0) == 0.0


@pytest.mark.parametrize("bits", [0, 1, 33])
def test_impossible_converters_are_refused(bits: int) -> None:
    with pytest.raises(ValueError, match="bits"):
        dac_fields(bits)

"""Quantisation of the analogue output and of the encoder."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.engine.converter import convert_output, dac_fields, read_encoder, take_feedback
from emulator.engine.layout import AXIS, UNIT


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


@given(st.lists(st.floats(-1000.0, 1000.0), min_size=1), st.floats(0.0, 0.999))
def test_the_encoder_counts_whole_edges_passed(positions: list[float], phase: float) -> None:
    axis = np.zeros(1, AXIS)[0]
    axis["counts_per_rev"], axis["encoder_phase"], axis["encoder_sign"] = 4000.0, phase, 1
    for position in positions:
        before = int(axis["encoder_counts"])
        axis["true_position"] = position
        take_feedback(axis)
        assert axis["encoder_counts"] == axis["feedback_counts"] == math.floor(position * 4000.0 + phase)
        assert axis["previous_feedback_counts"] == before


def test_turning_the_polarity_round_does_not_move_the_position() -> None:
    axis = np.zeros(1, AXIS)[0]
    axis["counts_per_rev"], axis["encoder_sign"], axis["true_position"] = 4000.0, 1, 1.0
    read_encoder(axis)
    axis["encoder_sign"] = -1
    read_encoder(axis)
    assert axis["encoder_counts"] == 4000
    axis["true_position"] = 1.25
    read_encoder(axis)
    assert axis["encoder_counts"] == 3000

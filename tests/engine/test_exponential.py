"""The matrix exponential against scipy's."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from emulator.engine.plants.exponential import exponential, held_step

entries = st.floats(-30.0, 30.0)


@given(st.lists(st.lists(entries, min_size=4, max_size=4), min_size=4, max_size=4))
def test_it_is_scipys(matrix: list[list[float]]) -> None:
    expected = expm(np.array(matrix))
    assert np.abs(np.array(exponential(matrix)) - expected).max() <= 1e-9 * max(1.0, np.abs(expected).max())


def test_of_nothing_is_the_identity() -> None:
    assert exponential([[0.0, 0.0], [0.0, 0.0]]) == [[1.0, 0.0], [0.0, 1.0]]


@pytest.mark.parametrize("angle", [1e-9, 0.3, 2.0, 70.0])
def test_a_rotation_keeps_its_length(angle: float) -> None:
    (cosine, sine), _ = exponential([[0.0, angle], [-angle, 0.0]])
    assert (cosine, sine) == pytest.approx((math.cos(angle), math.sin(angle)), abs=1e-12)


def test_a_held_input_is_integrated() -> None:
    (row,) = held_step([[-3.0]], [[2.0]], 0.5)
    assert row == pytest.approx([math.exp(-1.5), 2.0 / 3.0 * (1 - math.exp(-1.5))], rel=1e-14)

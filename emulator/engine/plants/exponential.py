"""The matrix exponential: the exact step of a linear system with its input held.

Worked out in plain Python, so that scipy is no dependency and the coefficients of a plant do not depend on which
linear algebra library numpy was built with.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum, log2

Matrix = list[list[float]]

TERMS = 18
"""Terms of the Taylor series; with a norm of at most 1/2 the first one left out is below 1e-21."""


def exponential(matrix: Sequence[Sequence[float]]) -> Matrix:
    """exp of a square matrix of finite numbers, by Taylor series, scaling and squaring."""
    size = len(matrix)
    norm = max(fsum(abs(entry) for entry in row) for row in matrix)
    halvings = max(0, int(log2(norm)) + 2) if norm > 0.0 else 0
    scaled = [[entry / 2.0**halvings for entry in row] for row in matrix]
    result = _identity(size)
    for term in range(TERMS, 0, -1):
        result = [[entry / term for entry in row] for row in _product(scaled, result)]
        for place in range(size):
            result[place][place] += 1.0
    for _ in range(halvings):
        result = _product(result, result)
    return result


def held_step(system: Sequence[Sequence[float]], inputs: Sequence[Sequence[float]], period_s: float) -> Matrix:
    """One row a state: what each state, then each input, at the beginning of a period contributes to it at the end.

    `system` is square (states by states, 1/s), `inputs` states by inputs; the inputs are held over the period.
    """
    states, width = len(system), len(system) + len(inputs[0])
    rows = [[entry * period_s for entry in (*row, *extra)] for row, extra in zip(system, inputs, strict=True)]
    rows += [[0.0] * width for _ in range(width - states)]
    return exponential(rows)[:states]


def _identity(size: int) -> Matrix:
    return [[float(row == column) for column in range(size)] for row in range(size)]


def _product(left: Matrix, right: Matrix) -> Matrix:
    columns = list(zip(*right, strict=True))
    return [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in left]

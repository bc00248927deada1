"""A yardstick for figures in processor time: what this Python, on this machine, now, needs for one multiply-add.

A ratio to it can be compared between machines and between minutes; a figure in nanoseconds cannot.
"""

from __future__ import annotations

import time

NAME = "Python multiply-add, ns"
ITERATIONS = 300_000


def multiply_add_ns() -> float:
    """Processor nanoseconds of one turn of a bare loop."""
    value = 1.0
    began_ns = time.process_time_ns()
    for _ in range(ITERATIONS):
        value = value * 0.999 + 0.001
    return (time.process_time_ns() - began_ns) / ITERATIONS

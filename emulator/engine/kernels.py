"""The mark that puts a function into the servo kernel.

The servo cycle is written once, as plain Python over structured numpy records, and used in two ways: compiled to
machine code for real work, and interpreted where a test wants to compare the two. Python must therefore be able to
import these functions without numba; they are only *registered* here, in the order of their definition (a callee
before its caller), and `machine_code` compiles the register when no compiled copy is at hand.

Rules for a kernel function: records are indexed with string literals, values are integers and floats, the arithmetic
is + - * /, comparison and floor (the operations IEEE 754 fixes to the last bit), nothing is raised and nothing is
allocated.

A sample of an axis takes as long as the chain from one output to the next, in which every operation waits for the one
before it; what lies beside the chain is nearly free. So the values in the chain are handed from function to function
instead of being read back from a record, stay floats where they can, and what holds them within limits is a branch to a
seldom function: a processor foresees a branch and goes on, but waits for a selection.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

Record: TypeAlias = np.void
Records: TypeAlias = npt.NDArray[np.void]
Words: TypeAlias = npt.NDArray[np.int64]
Floats: TypeAlias = npt.NDArray[np.float64]

Function = TypeVar("Function", bound=Callable[..., Any])

KERNEL_FUNCTIONS: list[Callable[..., Any]] = []

CALLED_FUNCTIONS: set[Callable[..., Any]] = set()
"""Those of KERNEL_FUNCTIONS that stay functions of their own in the machine code."""


def kernel(function: Function) -> Function:
    """Register `function` as part of the servo kernel and return it unchanged, callable as plain Python.

    In the machine code it becomes part of its callers: what a sample always does runs a quarter faster that way.
    """
    KERNEL_FUNCTIONS.append(function)
    return function


def seldom(function: Function) -> Function:
    """As `kernel`, for what few samples do or what is long: a function of its own, which keeps the build short."""
    CALLED_FUNCTIONS.add(function)
    return kernel(function)

"""The mark that puts a function into the kernel of the RMC.

Beside it stand the functions of the servo kernel that both use: plants and encoder. The rules are those of
`emulator.engine.kernels`; the registers are two, so that each kernel's machine code depends on its own sources alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from emulator.engine import kernels as servo

__all__ = ["RMC_CALLED", "RMC_FUNCTIONS", "functions_of_kernel", "kernel", "seldom"]

Function = TypeVar("Function", bound=Callable[..., Any])

RMC_FUNCTIONS: list[Callable[..., Any]] = []
RMC_CALLED: set[Callable[..., Any]] = set()

_SHARED_MODULES = ("emulator.engine.plants.", "emulator.engine.plants", "emulator.engine.encoder")


def kernel(function: Function) -> Function:
    """Register `function` as part of the RMC's kernel and return it unchanged."""
    RMC_FUNCTIONS.append(function)
    return function


def seldom(function: Function) -> Function:
    """As `kernel`, for what few loops do or what is long: a function of its own in the machine code."""
    RMC_CALLED.add(function)
    return kernel(function)


def functions_of_kernel() -> tuple[list[Callable[..., Any]], set[Callable[..., Any]]]:
    """Every function of the RMC's kernel, callees first, and those that stay functions of their own."""
    shared = [function for function in servo.KERNEL_FUNCTIONS if function.__module__.startswith(_SHARED_MODULES)]
    return [*shared, *RMC_FUNCTIONS], {*servo.CALLED_FUNCTIONS, *RMC_CALLED}

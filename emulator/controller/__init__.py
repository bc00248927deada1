"""One OEM6250: interpreter, programs, settings, motion commands, faults, reports.  A controller knows nothing of
ports."""

from emulator.controller import (
    communications,
    faults,
    gain_sets,
    limits,
    motion,
    outputs,
    programs,
    reports,
    servo,
    stopping,
    timing,
)
from emulator.controller.controller import Controller
from emulator.controller.output import Output

__all__ = [
    "Controller",
    "Output",
    "communications",
    "faults",
    "gain_sets",
    "limits",
    "motion",
    "outputs",
    "programs",
    "reports",
    "servo",
    "stopping",
    "timing",
]

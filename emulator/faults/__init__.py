"""Faults on demand: everything that can go wrong around a unit, each declared once as data.

From this table come the actions ``fault_NAME`` and ``lift_NAME`` of the registry (so recordings replay them), the
fixtures of the pytest plugin, and ``oem6250 faults``.
"""

from __future__ import annotations

from collections.abc import Mapping

from emulator.faults.axes import AXIS_FAULTS
from emulator.faults.contacts import CONTACT_FAULTS
from emulator.faults.fault import Effect, Fault, FaultError
from emulator.faults.line import LINE_FAULTS

__all__ = ["FAULTS", "Effect", "Fault", "FaultError"]

FAULTS: Mapping[str, Fault] = {fault.name: fault for fault in (*CONTACT_FAULTS, *AXIS_FAULTS, *LINE_FAULTS)}
"""Every fault by name."""

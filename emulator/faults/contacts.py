"""Faults at the unit's contacts: a limit switch, the ENABLE circuit, a drive that reports a fault.

A contact gets its state back when the fault is lifted, whatever was done to it meanwhile.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.faults.fault import AXIS, Effect, Fault, FaultError, axis_index_of
from emulator.parameters import Parameter

if TYPE_CHECKING:
    from emulator.controller import Controller

DIRECTIONS = ("positive", "negative")


def _hold(controller: Controller, wire: str, *, closed: bool) -> Effect:
    """Keep a contact closed or open."""
    wiring = controller.wiring
    before, resting = wiring.closed(wire), wiring.closed_at_rest(wire)
    wiring.set(wire, closed=closed)
    changed = wiring.closed(wire) != before
    return Effect(controller.now_ns, count=int(changed), lift=lambda: wiring.set(wire, closed=resting))


def _open_limit(controller: Controller, axis: int, direction: str) -> Effect:
    if direction not in DIRECTIONS:
        raise FaultError(f"direction must be {' or '.join(DIRECTIONS)}, not {direction!r}")
    return _hold(controller, f"axis{axis_index_of(controller, axis) + 1}.{direction}_limit", closed=False)


def _open_enable(controller: Controller) -> Effect:
    return _hold(controller, "enable", closed=False)


def _report_drive_fault(controller: Controller, axis: int) -> Effect:
    """The level that DRFLVL calls active at the moment."""
    axis_index = axis_index_of(controller, axis)
    active_closed = not controller.settings.flag("DRFLVL", axis_index)
    return _hold(controller, f"axis{axis}.drive_fault", closed=active_closed)


CONTACT_FAULTS = (
    Fault(
        name="limit_open",
        sentence="an end-of-travel switch opens, or its wire breaks",
        shows="with LHLVL0: AS bit 15 (positive) or 16 (negative) and ER bit 2 when the axis moves that way",
        counts="contacts that changed",
        begin=_open_limit,
        parameters=(AXIS, Parameter("direction", str, "positive or negative", default="positive")),
        place=("axis", "direction"),
    ),
    Fault(
        name="enable_open",
        sentence="the ENABLE circuit opens",
        shows="both drives off (AS bit 13), ER bit 9, programs end; DRIVE1 and GO are refused until it closes",
        counts="contacts that changed",
        begin=_open_enable,
    ),
    Fault(
        name="drive_fault",
        sentence="a drive reports a fault",
        shows="with INFEN1: AS bits 13 and 14, ER bit 4, drive off, program ends; without, ASX bit 4 only",
        counts="contacts that changed",
        begin=_report_drive_fault,
        parameters=(AXIS,),
        place=("axis",),
    ),
)

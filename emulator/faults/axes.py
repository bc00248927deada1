"""Faults of an axis's machinery: encoder, load, the analogue output."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.engine import EncoderWiring
from emulator.faults import machinery
from emulator.faults.fault import AXIS, Effect, Fault, FaultError, axis_index_of
from emulator.parameters import Parameter

if TYPE_CHECKING:
    from emulator.controller import Controller

HIGHEST_OUTPUT_V = 10.0
"""Range of the analogue output, +-V. Documented (6250 User Guide PDF p. 31)."""


def _travelled(controller: Controller, axis_index: int, from_counts: int) -> int:
    return abs(machinery.encoder_travel(controller, axis_index) - from_counts)


def _miswire_encoder(controller: Controller, axis: int, wiring: EncoderWiring) -> Effect:
    """Wire an encoder wrongly; one encoder is wired wrongly in one way at a time."""
    axis_index = axis_index_of(controller, axis)
    start = machinery.encoder_travel(controller, axis_index)
    machinery.wire_encoder(controller, axis_index, wiring)
    return Effect(
        controller.now_ns,
        lift=lambda: machinery.wire_encoder(controller, axis_index, EncoderWiring.NORMAL),
        measure=lambda: _travelled(controller, axis_index, start),
    )


def _lose_encoder(controller: Controller, axis: int) -> Effect:
    return _miswire_encoder(controller, axis, EncoderWiring.OPEN)


def _reverse_encoder(controller: Controller, axis: int) -> Effect:
    return _miswire_encoder(controller, axis, EncoderWiring.REVERSED)


def _slip_encoder(controller: Controller, axis: int, counts: int) -> Effect:
    machinery.slip_encoder(controller, axis_index_of(controller, axis), counts)
    return Effect(controller.now_ns, count=abs(counts))


def _change_plant(controller: Controller, axis: int, *, friction_nm: float = 0.0, load_nm: float = 0.0) -> Effect:
    """Add to what acts on the shaft now, and take the same away in the end: two such faults may overlap."""
    axis_index = axis_index_of(controller, axis)
    changed = machinery.with_torque(controller, axis_index, friction_nm=friction_nm, load_nm=load_nm)
    machinery.set_plant(controller, axis_index, changed)

    def lift() -> None:
        less = machinery.with_torque(controller, axis_index, friction_nm=-friction_nm, load_nm=-load_nm)
        machinery.set_plant(controller, axis_index, less)

    return Effect(controller.now_ns, count=int(bool(friction_nm or load_nm)), lift=lift)


def _raise_friction(controller: Controller, axis: int, torque_nm: float) -> Effect:
    return _change_plant(controller, axis, friction_nm=torque_nm)


def _step_load(controller: Controller, axis: int, torque_nm: float) -> Effect:
    return _change_plant(controller, axis, load_nm=torque_nm)


def _stick_output(controller: Controller, axis: int, volts: float) -> Effect:
    axis_index = axis_index_of(controller, axis)
    if not abs(volts) <= HIGHEST_OUTPUT_V:
        raise FaultError(f"an output sticks at -10 to 10 V, not {volts}")
    engine = controller.engine
    engine.stick_output(axis_index, volts)
    return Effect(controller.now_ns, count=1, lift=lambda: engine.stick_output(axis_index, None))


AXIS_FAULTS = (
    Fault(
        name="encoder_lost",
        sentence="an encoder's cable comes off: nothing is counted any more",
        shows="the position stands still; in motion the error passes SMPER: AS bits 13 and 23, ER bit 12, drive off",
        counts="counts the encoder moved unseen",
        begin=_lose_encoder,
        parameters=(AXIS,),
        place=("axis",),
    ),
    Fault(
        name="encoder_reversed",
        sentence="an encoder's channels are exchanged: it counts backwards",
        shows="the loop runs away until the error passes SMPER: AS bits 13 and 23, ER bit 12, drive off",
        counts="counts the encoder moved the wrong way",
        begin=_reverse_encoder,
        parameters=(AXIS,),
        place=("axis",),
    ),
    Fault(
        name="encoder_slip",
        sentence="an encoder slips on its shaft",
        shows="the servo moves the shaft by as much the other way; no status bit, unless the slip is beyond SMPER",
        counts="counts slipped",
        begin=_slip_encoder,
        parameters=(AXIS, Parameter("counts", int, "forwards positive", unit="counts")),
        place=("axis",),
        lasting=False,
    ),
    Fault(
        name="friction_up",
        sentence="dry friction rises (torque-mode drives)",
        shows="a larger position error; past SMPER AS bits 13 and 23, ER bit 12; outside the zone AS bit 25, ER bit 11",
        counts="changes of the load",
        begin=_raise_friction,
        parameters=(AXIS, Parameter("torque_nm", float, "added to the friction there is", unit="Nm")),
        place=("axis",),
    ),
    Fault(
        name="load_step",
        sentence="a load is put on a shaft; positive acts against positive motion, as gravity (torque-mode drives)",
        shows="a standing position error without SGI; past SMPER AS bits 13 and 23, ER bit 12",
        counts="changes of the load",
        begin=_step_load,
        parameters=(AXIS, Parameter("torque_nm", float, "added to the load there is", unit="Nm")),
        place=("axis",),
    ),
    Fault(
        name="output_stuck",
        sentence="the analogue output sticks at a voltage",
        shows="TDAC shows it; the axis runs away from its command until the error passes SMPER: AS 13, 23 and ER 12",
        counts="outputs stuck",
        begin=_stick_output,
        parameters=(AXIS, Parameter("volts", float, "-10 to 10", unit="V")),
        place=("axis",),
    ),
)

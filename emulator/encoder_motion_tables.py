"""The tables of a machine file that say what turns an encoder, one a kind; by default the shaft of its own axis.

Every value is a design choice: not a claim about the unit, but what is connected to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias

from emulator.table_fields import Table, known

if TYPE_CHECKING:
    from emulator.engine import EncoderMotion

Velocity = Annotated[float, known("velocity, counts/s; negative = backwards", "design", ge=-1e9, le=1e9)]
Start = Annotated[float, known("virtual time at which it starts, s; at rest until then", "design", ge=0, le=1e9)]


class Shaft(Table, frozen=True, tag_field="kind", tag="shaft"):
    """The axis's own motor or load turns it."""


class Driven(Table, frozen=True, tag_field="kind", tag="driven"):
    """Something that a test has in its hand: at rest until one of the actions turns it."""


class Constant(Table, frozen=True, tag_field="kind", tag="constant"):
    """Something of constant velocity, there at once."""

    velocity_counts_s: Velocity = 25_000.0
    start_s: Start = 0.0


class Ramp(Table, frozen=True, tag_field="kind", tag="ramp"):
    """Something that speeds up evenly from rest and then keeps its velocity."""

    velocity_counts_s: Velocity = 25_000.0
    ramp_s: Annotated[float, known("time from rest to that velocity, s", "design", ge=0, le=1e9)] = 1.0
    start_s: Start = 0.0


class Sine(Table, frozen=True, tag_field="kind", tag="sine"):
    """Something that swings to and fro, about rest or about a constant velocity."""

    swing_counts: Annotated[float, known("to either side, counts", "design", ge=0, le=1e12)] = 1000.0
    frequency_hz: Annotated[float, known("swings a second, Hz", "design", ge=0, le=10_000)] = 1.0
    velocity_counts_s: Velocity = 0.0
    start_s: Start = 0.0


EncoderMotionTable: TypeAlias = Shaft | Driven | Constant | Ramp | Sine

MOTION_KINDS: Final[Mapping[str, type[Table]]] = {
    "driven": Driven,
    "constant": Constant,
    "ramp": Ramp,
    "sine": Sine,
}
"""The kinds that are not the default."""


def engine_motion(table: EncoderMotionTable) -> EncoderMotion | None:
    """The motion in the engine's terms; None: the axis's own shaft turns the encoder."""
    from emulator.engine import EncoderMotion

    if isinstance(table, Shaft):
        return None
    if isinstance(table, Constant):
        return EncoderMotion(table.velocity_counts_s, start_s=table.start_s)
    if isinstance(table, Ramp):
        return EncoderMotion(table.velocity_counts_s, ramp_s=table.ramp_s, start_s=table.start_s)
    if isinstance(table, Sine):
        return EncoderMotion(
            table.velocity_counts_s,
            start_velocity_counts_s=table.velocity_counts_s,
            swing_counts=table.swing_counts,
            frequency_hz=table.frequency_hz,
            start_s=table.start_s,
        )
    return EncoderMotion()

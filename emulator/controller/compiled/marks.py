"""What goes with the beginning of a segment besides motion: outputs that switch, and conditions that hold it."""

from __future__ import annotations

from typing import NamedTuple

from emulator.controller.compiled.holds import SegmentHold


class Marks(NamedTuple):
    """Outputs of a POUT before the segment (output 1 first; 0, 1 or X), and a condition of GOWHEN or TRGFN."""

    outputs: str | None = None
    hold: SegmentHold | None = None


class Held(NamedTuple):
    """The profile waits here for a condition."""

    hold: SegmentHold


class Over(NamedTuple):
    """The profile's last segment is over, and motion runs on."""

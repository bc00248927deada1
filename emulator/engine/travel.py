"""Where the switches sit along an axis's travel, and how the servo catches a home edge or an index pulse.

End-of-travel and home switches follow the true position of the load, not the counter: a slipped encoder does not move
a switch. A switch that is operated changes its contact over from the state its wire has at rest, so a normally closed
limit opens and a normally open home closes, and either can be wired the other way.

The home input and the index channel are looked at in every servo sample while a capture is armed; the position is the
one the encoder had then, and Python hears of it at the next system update.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from .events import EVENT_HOME_EDGE, EVENT_INDEX
from .kernels import Record, kernel, seldom
from .plants import place_of_load

CAPTURE_NONE = 0
CAPTURE_HOME_ON = 1
CAPTURE_HOME_OFF = 2
CAPTURE_INDEX = 3


class Capture(IntEnum):
    """What an armed capture waits for."""

    NONE = CAPTURE_NONE
    HOME_ON = CAPTURE_HOME_ON
    HOME_OFF = CAPTURE_HOME_OFF
    INDEX = CAPTURE_INDEX


@dataclass(frozen=True, slots=True)
class Travel:
    """Switch positions, rev of the load's true position; infinite where there is no switch.

    A limit switch is operated from its position outwards, the home switch between its two edges.
    """

    positive_limit_rev: float = math.inf
    negative_limit_rev: float = -math.inf
    home_from_rev: float = math.inf
    home_to_rev: float = -math.inf

    def __post_init__(self) -> None:
        if not self.negative_limit_rev < self.positive_limit_rev:
            raise ValueError("the negative limit switch must lie below the positive one")
        if self.has_home and not self.home_from_rev < self.home_to_rev:
            raise ValueError("the home switch must begin below its end")

    @property
    def has_home(self) -> bool:
        """There is a home switch on this axis."""
        return self.home_from_rev != math.inf or self.home_to_rev != -math.inf

    def fields(self) -> dict[str, float]:
        """Fields of the axis record."""
        switches = (self.positive_limit_rev, -self.negative_limit_rev)
        return {
            "switches_fitted": self.has_home or any(position != math.inf for position in switches),
            "positive_switch_rev": self.positive_limit_rev,
            "negative_switch_rev": self.negative_limit_rev,
            "home_from_rev": self.home_from_rev,
            "home_to_rev": self.home_to_rev,
        }


@seldom
def operate_switches(unit: Record, axis: Record) -> None:
    """Change over the contacts of the switches that the load has moved onto or off."""
    position = place_of_load(axis)
    operated = 0
    if position >= axis["positive_switch_rev"]:
        operated |= axis["positive_limit_mask"]
    if position <= axis["negative_switch_rev"]:
        operated |= axis["negative_limit_mask"]
    if position >= axis["home_from_rev"] and position <= axis["home_to_rev"]:
        operated |= axis["home_mask"]
    changed = operated ^ axis["operated_switches"]
    if changed != 0:
        unit["wires"] ^= changed
        axis["operated_switches"] = operated


@kernel
def home_active(unit: Record, axis: Record) -> int:
    """1 while the home input is at its active level."""
    grounded = 1 if (unit["wires"] & axis["home_mask"]) != 0 else 0
    return 1 if grounded == axis["home_active_level"] else 0


@kernel
def index_turn(axis: Record, reading: int) -> int:
    """Which revolution, counted from index pulse to index pulse, an encoder reading lies in."""
    return math.floor((reading - axis["index_reading"]) / axis["counts_per_rev"])


@kernel
def capture_index(axis: Record) -> None:
    """Take the exact count of an index pulse passed since the last sample."""
    moved = axis["feedback_counts"] - axis["previous_feedback_counts"]
    reading = axis["encoder_reading"]
    turn = index_turn(axis, reading)
    previous_turn = index_turn(axis, reading - axis["encoder_sign"] * moved)
    if turn == previous_turn:
        return
    pulse = math.floor(max(turn, previous_turn) * axis["counts_per_rev"] + 0.5) + axis["index_reading"]
    axis["captured_counts"] = axis["feedback_counts"] + axis["encoder_sign"] * (pulse - reading)
    axis["capture_mode"] = CAPTURE_NONE
    axis["pending_events"] |= EVENT_INDEX


@kernel
def capture_home(axis: Record, active: int) -> None:
    """Take the position of the home edge waited for, unless the axis has so far moved the wrong way."""
    wanted = 1 if axis["capture_mode"] == CAPTURE_HOME_ON else 0
    changed = active != axis["home_was_active"]
    axis["home_was_active"] = active
    moved = (axis["feedback_counts"] - axis["capture_origin_counts"]) * axis["capture_direction"]
    if changed and active == wanted and moved >= 0:
        axis["captured_counts"] = axis["feedback_counts"]
        axis["capture_mode"] = CAPTURE_NONE
        axis["pending_events"] |= EVENT_HOME_EDGE


@seldom
def capture(unit: Record, axis: Record) -> None:
    """One servo sample of an armed capture; an index pulse counts only while the home input is active."""
    active = home_active(unit, axis)
    if axis["capture_mode"] != CAPTURE_INDEX:
        capture_home(axis, active)
    elif active != 0:
        capture_index(axis)

"""Sync moves: axes of one group that are sent off in one write arrive together.

The axis whose own move takes longest is not changed; the moves of the others are stretched to its time, so that none
exceeds the speed and accelerations it was given. Only axes that start from rest are stretched (design choice); an axis
that is in motion already makes its own move.
"""

from __future__ import annotations

from collections.abc import Sequence

from .axis import Axis
from .commands import DeviceLike, Values, base_of, carries_out
from .motion_commands import move_to
from .ramps import plan_duration, stretched
from .target import begin_stop


@carries_out("sync_move_absolute")
def sync_move_absolute(device: DeviceLike, axis: Axis, values: Values) -> None:
    """To a position, together with the others of the group."""
    begin(axis, values[0], values[1:4], group=values[4])


@carries_out("sync_move_relative")
def sync_move_relative(device: DeviceLike, axis: Axis, values: Values) -> None:
    """By a distance, together with the others of the group."""
    begin(axis, base_of(axis, values[4]) + values[0], values[1:4], group=values[5])


@carries_out("sync_stop")
def sync_stop(device: DeviceLike, axis: Axis, values: Values) -> None:
    """Ramp every axis to rest that is on a sync move of the group."""
    decel, group = values
    for each in device.axes:
        if (each is axis or each.sync_group == group) and each.mode.closed_loop:
            begin_stop(each.record, each.memory.ramps, decel)


def begin(axis: Axis, position: float, values: Values, *, group: float) -> None:
    """A move that `match_times` may stretch."""
    move_to(axis, position, values)
    axis.sync_group = int(group)


def match_times(axes: Sequence[Axis]) -> None:
    """Stretch the sync moves just begun, group by group, to the longest of each."""
    begun = [axis for axis in axes if axis.sync_group is not None and axis.plan and not axis.plan[0].velocity]
    for group in {axis.sync_group for axis in begun}:
        members = [axis for axis in begun if axis.sync_group == group and not axis.integer("generator_loops")]
        longest = max((plan_duration(axis.plan) for axis in members), default=0.0)
        for axis in members:
            axis.follow(stretched(axis.plan, longest / plan_duration(axis.plan)), end=axis["plan_end"])

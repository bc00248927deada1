"""Many like units run side by side in one call: what a sweep over gains and plants is made of.

A lane is a unit with its own state, plant and scope; all lanes share the tables of profiles and no watches. Events are
of no interest there: a lane runs straight to the time asked for.
"""

from __future__ import annotations

from .cycle import advance
from .kernels import Records, kernel, seldom
from .scope import ScopeArrays


@kernel
def lane_scope(whole: ScopeArrays, lane: int, lanes: int) -> ScopeArrays:
    """The scope of one lane: its record and its share of the words and of the ring."""
    unit_words = len(whole.unit_words) // lanes
    axis_words = len(whole.axis_words) // lanes
    ring_words = len(whole.ring) // lanes
    return ScopeArrays(
        whole.records[lane : lane + 1],
        whole.channels,
        whole.unit_channels,
        whole.unit_words[lane * unit_words : (lane + 1) * unit_words],
        whole.unit_floats[lane * unit_words : (lane + 1) * unit_words],
        whole.axis_words[lane * axis_words : (lane + 1) * axis_words],
        whole.axis_floats[lane * axis_words : (lane + 1) * axis_words],
        whole.ring[lane * ring_words : (lane + 1) * ring_words],
    )


@seldom
def advance_lanes(
    units: Records,
    axes: Records,
    plants: Records,
    segments: Records,
    ratios: Records,
    watches: Records,
    scope: ScopeArrays,
    until_ns: int,
) -> int:
    """Run every lane to `until_ns`; `scope` spans the records, words and rings of all of them. Returns 0."""
    lanes = len(units)
    axis_count = units[0]["axis_count"]
    for lane in range(lanes):
        unit = units[lane]
        lane_axes = axes[lane * axis_count : (lane + 1) * axis_count]
        lane_plants = plants[2 * lane * axis_count : 2 * (lane + 1) * axis_count]
        scope_here = lane_scope(scope, lane, lanes)
        while unit["time_ns"] < until_ns:
            advance(unit, lane_axes, lane_plants, segments, ratios, watches, scope_here, until_ns)
    return 0

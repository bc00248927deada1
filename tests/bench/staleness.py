"""How old a position is when a host reads it at x1, by the exact trajectory.

During a move at constant velocity a lag is a distance: the exact position at the middle of the request, less the
position read, over the velocity. Part of it is the unit's own nature (the commanded position stands still between
trajectory updates: period / sqrt(3), rms), part the half round trip by which the middle may miss the moment of
reading. Both are given beside the whole.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import NamedTuple

from tests.bench.figures import Effort, Figure, Reach, Reference
from tests.bench.processes import Load
from tests.bench.session import Exchange, Session, hold

CONSTANT_VELOCITY = b"DRIVE11\rCOMEXC1\rA100,100\rV5,5\rMC11\rGO11\r"
RAMP_S = 0.2
"""Time enough to be at constant velocity: the ramp itself takes 0.05 s."""
HOSTS = (("polled 100/s", 0.01), ("polled flat out", 0.0))
STAIRCASE = "unit's own staircase"

_POSITION = re.compile(r"TPC([+-]\d+)")


class Staleness(NamedTuple):
    """Of one session, ms."""

    rms_ms: float
    mean_ms: float
    own_rms_ms: float
    """Against the exact trajectory at the virtual time the answer left: the unit's own staircase."""
    half_round_trip_rms_ms: float


def measure(effort: Effort) -> list[Figure]:
    """Position reads of a leisurely and of a hasty host."""
    with Load() as load:
        return [figure for name, interval_s in HOSTS for figure in _figures(name, interval_s, load, effort)]


def _figures(name: str, interval_s: float, load: Load, effort: Effort) -> list[Figure]:
    found = []
    for _ in range(effort.times(1, 3)):
        session = hold(
            load,
            set_up=CONSTANT_VELOCITY,
            pause_s=RAMP_S,
            question=b"1TPC\r",
            seconds=effort.of(1.5, 3.0),
            interval_s=interval_s,
        )
        found.append(staleness(session))
    own = Reference(name=STAIRCASE, samples=[one.own_rms_ms for one in found])
    return [
        Figure(
            name=f"position read, {name}, rms",
            unit="ms",
            samples=[one.rms_ms for one in found],
            reference=own,
            reach=Reach(bound=1.0),
        ),
        Figure(name=f"position read, {name}, mean", unit="ms", samples=[one.mean_ms for one in found]),
        Figure(
            name=f"half a round trip, {name}, rms", unit="ms", samples=[one.half_round_trip_rms_ms for one in found]
        ),
    ]


def staleness(session: Session) -> Staleness:
    """The ages of all positions read in a session at constant velocity."""
    line, ahead_ns = session.record["line"], session.record["virtual_ahead_ns"]
    if line is None or not session.exchanges:
        raise RuntimeError("the axis never moved at constant velocity")
    whole = [age_ms(each, (each.sent_ns + each.answered_ns) / 2 + ahead_ns, line) for each in session.exchanges]
    own = [age_ms(each, each.left_at_ns, line) for each in session.exchanges]
    half_ms = [(each.answered_ns - each.sent_ns) / 2e6 for each in session.exchanges]
    return Staleness(rms(whole), sum(whole) / len(whole), rms(own), rms(half_ms))


def age_ms(exchange: Exchange, at_ns: float, line: tuple[int, float, float]) -> float:
    """How long before the virtual time `at_ns` the axis was where the answer says."""
    found = _POSITION.search(exchange.answer)
    if found is None:
        raise RuntimeError(f"not a position: {exchange.answer!r}")
    line_ns, position, velocity = line
    return (at_ns - line_ns) / 1e6 - (int(found[1]) - position) / velocity * 1e3


def rms(values: Iterable[float]) -> float:
    """Root of the mean square; `values` must not be empty."""
    squares = [value * value for value in values]
    return math.sqrt(sum(squares) / len(squares))

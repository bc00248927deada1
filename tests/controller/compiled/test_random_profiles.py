"""Random legal profiles in the running unit: they end where and when the equations of motion say.

The equations are written out once more here, segment by segment, in plain kinematics (following-and-profiles 5.2) with
the rules of blending: a preset segment ramps to V and keeps it to the end of its distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.controller.compiled.rig import COUNTS, define, run_time
from tests.controller.session import ONE_UPDATE_EACH_NS, S, both_on


@dataclass(frozen=True)
class Gobuf:
    """Distance in counts, V in rev/s, A and AD in rev/s2."""

    distance: int
    velocity: float
    acceleration: float
    deceleration: float

    def commands(self, *, last: bool, sign: int) -> list[str]:
        values = (f"A{self.acceleration}", f"AD{self.deceleration}", f"V{self.velocity}", f"D{sign * self.distance}")
        return [*values, *(["VF0"] if last else []), "GOBUF1"]


def duration(segments: list[Gobuf]) -> float | None:
    """Seconds of the whole profile; None if one of its segments is too short for its velocity."""
    total, v = 0.0, 0.0
    for index, segment in enumerate(segments):
        goal, rev = segment.velocity, segment.distance / COUNTS
        rate = segment.acceleration if goal >= v else segment.deceleration
        ramp_s, ramp_rev = abs(goal - v) / rate, abs(goal**2 - v**2) / (2 * rate)
        last = index == len(segments) - 1
        stop_rev = goal**2 / (2 * segment.deceleration) if last else 0.0
        if ramp_rev + stop_rev > rev:
            return None
        total += ramp_s + (rev - ramp_rev - stop_rev) / goal + (goal / segment.deceleration if last else 0.0)
        v = goal
    return total


tenths = st.integers(2, 40).map(lambda n: n / 10)
gobufs = st.builds(Gobuf, st.integers(2000, 40_000), tenths, st.sampled_from([5, 10, 80]), st.sampled_from([5, 20, 99]))


@given(st.lists(gobufs, min_size=1, max_size=8), st.sampled_from([1, -1]), st.integers(1, 3))
@settings(deadline=None, max_examples=25, suppress_health_check=[HealthCheck.filter_too_much])
def test_a_profile_ends_where_and_when_the_equations_say(segments: list[Gobuf], sign: int, passes: int) -> None:
    expected_s = duration(segments)
    session = both_on("SMPER0,0")
    lines = [line for i, one in enumerate(segments) for line in one.commands(last=i == len(segments) - 1, sign=sign)]
    define(session, f"PLOOP{passes}", *lines, "PLN1")
    answer = session.ask("PCOMP P")
    if expected_s is None and "INVALID CONDITIONS" in answer:
        return
    assert answer == "\r\n> "
    took_s = run_time(session)
    assert session.position() == sign * passes * sum(segment.distance for segment in segments)
    if expected_s is not None:
        assert took_s == pytest.approx(passes * expected_s, abs=ONE_UPDATE_EACH_NS / S)

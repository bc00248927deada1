"""Compiled profiles as a host sees them: where they go, how long they take, what stands between their segments."""

from __future__ import annotations

import pytest

from tests.controller.compiled.rig import COUNTS, compiled, run_time, unit_with
from tests.controller.session import MS, ONE_UPDATE_EACH_NS, S

SETTLES_WITHIN = ONE_UPDATE_EACH_NS / S


@pytest.mark.parametrize(
    ("distance", "velocity", "acceleration", "deceleration", "duration_s"),
    [
        (25, 1, 10, 10, 25.1),
        (6.25, 1, 10, 10, 6.35),
        (1, 10, 10, 10, 0.632456),
        (10, 5, 25, 20, 2.225),
        (8, 10, 100, 50, 0.95),
        (1, 2, 10, 5, 0.8),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_segment_with_vf0_is_a_preset_move(
    distance: float, velocity: float, acceleration: float, deceleration: float, duration_s: float, sign: int
) -> None:
    counts = int(sign * distance * COUNTS)
    session = compiled(f"A{acceleration}", f"AD{deceleration}", f"V{velocity}", f"D{counts}", "VF0", "GOBUF1")
    assert run_time(session) == pytest.approx(duration_s, abs=SETTLES_WITHIN)
    assert session.position() == counts


@pytest.mark.parametrize(
    ("velocity", "acceleration", "average", "ramp_s", "ramp_rev"),
    [
        (5, 10, 5, 1.0, 2.5),
        (5, 10, 7.5, 0.66667, 1.66667),
        (1, 10, 5, 0.2, 0.1),
        (10, 100, 75, 0.13333, 0.66667),
        (20, 40, 30, 0.66667, 6.66667),
    ],
)
def test_s_curve_ramps_between_segments(
    velocity: float, acceleration: float, average: float, ramp_s: float, ramp_rev: float
) -> None:
    distance = int(2 * ramp_rev * COUNTS + velocity * COUNTS)
    session = compiled(
        *(f"A{acceleration}", f"AD{acceleration}", f"AA{average}", f"ADA{average}", f"V{velocity}"),
        *("MC1", "GOBUF1", "MC0", f"D{int(velocity * COUNTS)}", "GOBUF1", "MC1", "V0", "GOBUF1"),
    )
    assert run_time(session) == pytest.approx(2 * ramp_s + 1.0, abs=SETTLES_WITHIN)
    assert session.position() == pytest.approx(distance, abs=1)


def test_a_preset_segment_ends_at_its_velocity_and_the_next_blends_from_there() -> None:
    session = compiled(
        *("A10", "AD10", "V2", f"D{2 * COUNTS}", "GOBUF1"),
        *("V4", f"D{4 * COUNTS}", "GOBUF1"),
        *("V1", f"D{2 * COUNTS}", "VF0", "GOBUF1"),
    )
    first = 0.2 + (2 - 0.2) / 2
    second = 0.2 + (4 - 0.6) / 4
    third = 0.3 + (2 - 0.75 - 0.05) / 1 + 0.1
    assert run_time(session) == pytest.approx(first + second + third, abs=SETTLES_WITHIN)
    assert session.position() == 8 * COUNTS


def test_velocity_at_the_end_of_each_segment() -> None:
    session = compiled(
        *("A10", "AD10", "V2", f"D{2 * COUNTS}", "GOBUF1", "V4", f"D{4 * COUNTS}", "GOBUF1"),
        *("V1", f"D{2 * COUNTS}", "VF0", "GOBUF1"),
    )
    session.ok("COMEXC1", "PRUN P")
    session.advance(1.1 - 0.003)
    assert session.look("1TVEL") == "1TVEL+2.0000"
    session.advance(1.05)
    assert session.look("1TVEL") == "1TVEL+4.0000"


def test_the_axes_of_a_profile_start_together_and_go_their_own_way() -> None:
    session = compiled("A10,20", "AD10,20", "V1,2", "D4000,-16000", "VF0,0", "GOBUF11")
    session.unit.send(b"PRUN P\r")
    session.advance(0.5)
    assert session.position(1) > 0 > session.position(2)
    session.until_rest(2)
    assert (session.position(1), session.position(2)) == (4000, -16000)


def test_a_last_continuous_segment_runs_on_after_the_profile() -> None:
    session = compiled("A10", "V2", "MC1", "GOBUF1", COMEXC="0")
    answers = session.timed("PRUN P", wait_s=2.0)
    assert [answer.text for answer in answers] == ["\r\n> "], "the prompt comes as the profile is over"
    assert answers[0].at_ns == pytest.approx(200 * MS, abs=ONE_UPDATE_EACH_NS)
    assert session.axis_bit(1)
    assert session.look("1TVEL") == "1TVEL+2.0000"
    session.ok("COMEXC1", "AD10", "S1")
    session.until_rest()
    assert session.position() == pytest.approx(COUNTS * (0.2 + 2 * 1.8 + 0.2), abs=2 * COUNTS * 0.01)


def test_segments_keep_the_values_of_the_time_they_were_compiled() -> None:
    session = compiled("V1", "D4000", "VF0", "GOBUF1")
    session.ok("V9", "A999", "D77", "MA1")
    assert run_time(session) == pytest.approx(1.1, abs=SETTLES_WITHIN)
    assert session.position() == 4000
    assert session.query("1V") == "1V9.0000"


def test_compiling_changes_no_setting() -> None:
    session = compiled("A5", "V3", "D77", "MA1", "MC1", "GOBUF1")
    reports = [session.query(f"1{name}") for name in ("A", "V", "D", "MA", "MC")]
    assert reports == ["1A10.0000", "1V1.0000", "1D+4000", "1MA0", "1MC0"]


def test_variables_are_read_at_pcomp() -> None:
    session = unit_with("D(VAR1)", "V(VAR2)", "VF0", "GOBUF1")
    session.ok("VAR1=8000", "VAR2=2", "PCOMP P", "VAR1=1", "VAR2=1")
    assert run_time(session) == pytest.approx(2 / 2 + 0.2, abs=SETTLES_WITHIN)
    assert session.position() == 8000


def test_absolute_positions_count_from_where_the_axis_stands_at_pcomp() -> None:
    session = compiled("MA1", "V1", "D6000", "GOBUF1", "D10000", "VF0", "GOBUF1")
    session.ok("PSET2000", "PCOMP P")
    session.ask("PRUN P", wait_s=5.0)
    assert session.position() == 10000
    session.ask("PRUN P", wait_s=5.0)
    assert session.position() == 18000, "the distances are frozen"

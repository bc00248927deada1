"""Following moves of the running unit against the equations: where the slave is for where its master is."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.following.rig import ARRIVE, FollowingRig

IN_RATIO_MOVE, NEGATIVE, CHANGING, AT_RATIO = 1, 2, 3, 4


def continuous(ratio: str, folmd: int, *commands: str) -> FollowingRig:
    return FollowingRig("MC1", ratio, f"FOLMD{folmd}", *commands)


def start_at_ratio(ratio: str, *commands: str) -> FollowingRig:
    """A slave that has come to a constant ratio without having moved."""
    rig = continuous(ratio, 0, *commands)
    rig.ok("1GO")
    return rig


def test_the_constructed_session_of_the_reference() -> None:
    """Ratio 0.5 over 4000 master counts, 10000 at ratio, over 4000 back to 0."""
    rig = continuous("FOLRN1", 4000, "FOLRD2", "D+", "1GO1")
    assert rig.travel(4000) == 1000
    assert rig.following_bits()[:4] == "1001"
    assert rig.travel(10_000) == 6000
    rig.ok("FOLRN0", "1GO1")
    assert rig.travel(4000) == 7000
    assert rig.following_bits()[:4] == "0000"
    assert rig.travel(1000) == 7000


PRESET = [
    (8000, 10_000, 1, [(2000, 1000), (8000, 7000), (10_000, 8000)]),
    (25_000, 10_000, 3, [(1667, 2500), (8333, 22_500), (10_000, 25_000)]),
    (5000, 10_000, 1, [(5000, 2500), (10_000, 5000)]),
    (3000, 10_000, 1, [(5000, 1500), (10_000, 3000)]),
    (10_000, 10_000, 1, [(1, 1), (5000, 5000), (10_000, 10_000)]),
]
"""D, FOLMD, FOLRN, and where the slave is at the corners of the ratio: trapezoids, triangles, a rectangle."""


@pytest.mark.parametrize(("distance", "folmd", "ratio", "corners"), PRESET)
@pytest.mark.parametrize("sign", [1, -1])
def test_preset_moves_have_the_geometry_of_the_guide(
    distance: int, folmd: int, ratio: int, corners: list[tuple[int, int]], sign: int
) -> None:
    rig = FollowingRig("MC0", f"FOLRN{ratio}", f"FOLMD{folmd}", f"D{sign * distance}", "1GO1")
    for master, slave in corners:
        assert abs(rig.travel(master - rig.master_counts) - sign * slave) <= 1
    assert rig.travel(500) == sign * distance
    assert rig.following_bits()[:4] == "0000"
    assert not rig.axis_bit(1)


def test_the_triangle_reaches_the_ratio_its_distance_asks_for() -> None:
    """3000 over 10000: at the top the slave goes 0.6 counts a master count."""
    rig = FollowingRig("MC0", "FOLMD10000", "D3000", "1GO1")
    below = rig.travel(4900)
    assert rig.travel(200) - below == pytest.approx(0.6 * 200, abs=2)


@pytest.mark.parametrize(
    ("first", "second", "folmd", "travel"),
    [("0", "1", 4000, 2000), ("1", "3", 10_000, 20_000), ("2", "0.5", 8000, 10_000), ("3", "0", 5000, 7500)],
)
def test_a_change_of_ratio_travels_the_mean_ratio(first: str, second: str, folmd: int, travel: int) -> None:
    rig = start_at_ratio(f"FOLRN{first}")
    began = rig.travel(1000)
    rig.ok(f"FOLRN{second}", f"FOLMD{folmd}", "1GO1")
    assert rig.travel(folmd) - began == travel
    assert not rig.following_bit(CHANGING)
    assert rig.travel(1000) - began - travel == 1000 * Fraction(second)


def test_the_ramp_is_a_parabola_of_master_travel() -> None:
    rig = continuous("FOLRN3", 4000, "1GO1")
    for master in range(250, 4001, 250):
        assert rig.travel(250) == pytest.approx(3 * master**2 / 8000, abs=1)


def test_scaled_ratio_of_the_guide() -> None:
    """SCLD25000, SCLMAS4000, FOLRN5, FOLRD3: 125 slave counts in 12 of the master."""
    rig = FollowingRig("SCLD25000", "SCLMAS4000", "SCALE1", "MC1", "FOLRN5", "FOLRD3", "FOLMD0", "SMPER0", "1GO1")
    assert rig.travel(1200) == 12_500
    assert rig.look("1TPSLV") == "1TPSLV+0.5000"
    assert rig.look("1TPMAS") == "1TPMAS+0.300"


def test_master_distances_are_cut_to_whole_counts() -> None:
    """SCLMAS25 and 0.3 units are 7.5 counts: 7."""
    rig = FollowingRig("SCLMAS25", "SCALE1", "MC1", "FOLRN100", "FOLRD1", "FOLMD0.3", "1GO1")
    assert rig.travel(7) == round(7 * (100 / 25) / 2)


def test_a_variable_gives_ratio_and_distance() -> None:
    rig = FollowingRig("VAR1=2.5", "VAR6=4000", "MC1", "FOLRN(VAR1)", "FOLRD5", "FOLMD(VAR6)", "1GO1")
    assert rig.travel(4000) == 1000
    assert rig.travel(4000) == 3000


def test_immediate_commands_change_the_ratio_in_motion() -> None:
    rig = FollowingRig("MC1", "FOLMD1000", "1GO1", COMEXC=1)
    rig.travel(1500)
    rig.ok("!FOLRN2", "!1GO")
    began = rig.travel(0)
    assert rig.travel(1000) - began == 1500
    assert rig.travel(1000) - began == 3500


def test_a_preset_move_waits_for_the_positive_direction() -> None:
    """What the master backs up before the move has begun does not count."""
    rig = FollowingRig("MC0", "FOLMD1000", "D-500", "1GO1")
    assert rig.travel(-3000) == 0
    assert rig.following_bits()[:3] == "100"
    assert rig.travel(1000) == -500


def test_a_preset_move_that_has_begun_retraces_when_the_master_backs_up() -> None:
    rig = FollowingRig("MC0", "FOLMD1000", "D500", "1GO1")
    assert rig.travel(500) == 250
    assert rig.travel(-250) == pytest.approx(62.5, abs=1)
    assert rig.travel(-5000) == 0
    assert rig.travel(5750) == 500


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("sign", ["+", "-"])
@pytest.mark.parametrize("folmas", [1, -1])
def test_continuous_moves_start_in_either_direction(direction: int, sign: str, folmas: int) -> None:
    """Commanded + and counting up: +; counting down: -; mirrored for commanded -; FOLMAS- negates the counts."""
    rig = FollowingRig("1FOLEN0", f"1FOLMAS{folmas * 21:+d}", "1FOLEN1", "MC1", "FOLMD1000", f"D{sign}", "1GO1")
    slave = direction * folmas * (1 if sign == "+" else -1)
    assert rig.travel(direction * 1000) == 500 * slave
    assert rig.travel(direction * 1000) == 1500 * slave
    assert rig.following_bits()[:4] == ("1101" if sign == "-" else "1001")
    assert rig.travel(-direction * 2000) == -500 * slave


def test_a_ratio_of_zero_moves_nothing() -> None:
    rig = FollowingRig("MC1", "FOLRN0", "FOLMD1000", "1GO1")
    assert rig.travel(2000) == 0
    assert rig.following_bits()[:4] == "0000"


def test_a_step_to_zero_ends_the_move_where_it_is() -> None:
    rig = start_at_ratio("FOLRN1")
    assert rig.travel(700) == 700
    rig.ok("FOLRN0", "1GO1")
    assert rig.travel(700) == 700
    assert rig.following_bits()[:4] == "0000"


def test_the_time_of_a_ramp_under_a_constant_master() -> None:
    """22321 counts/s and FOLMD 4000: with prediction the slave is on its parabola at every update, and at ratio after
    4000/50 system updates."""
    rig = continuous("FOLRN2", 4000, "1GO1")
    positions = list(rig.turn([50] * 200))
    for update, position in enumerate(positions, start=1):
        master = 50 * update
        expected = master**2 / 4000 if master <= 4000 else 4000 + 2 * (master - 4000)
        assert position == pytest.approx(expected, abs=1 if update > 4 and abs(master - 4000) > 150 else 200)


def test_a_billion_counts_either_way_drift_by_nothing() -> None:
    """355/113 of a billion and back: the exact rational, to the count."""
    rig = start_at_ratio("FOLRN355", "FOLRD113", "LS0", "SMPER0")
    for counts in (10**9, -2 * 10**9):
        assert rig.travel(counts, step=10**7) == math.floor(Fraction(355 * rig.master_counts, 113) + Fraction(1, 2))


@settings(deadline=None, max_examples=25)
@given(
    numerator=st.integers(1, 99_999),
    denominator=st.integers(1, 99_999),
    sign=st.sampled_from("+-"),
    steps=st.lists(st.integers(-3000, 3000), min_size=1, max_size=30),
)
def test_at_constant_ratio_the_slave_is_an_exact_rational_of_its_master(
    numerator: int, denominator: int, sign: str, steps: list[int]
) -> None:
    if numerator > 127 * denominator:
        denominator = numerator
    rig = start_at_ratio(f"FOLRN{numerator}", f"FOLRD{denominator}", f"D{sign}", "SMPER0")
    *_, position = rig.turn([*steps, *ARRIVE])
    exact = Fraction(numerator, denominator) * sum(steps) * (1 if sign == "+" else -1)
    assert position == math.floor(exact + Fraction(1, 2))


@settings(deadline=None, max_examples=25)
@given(
    folmd=st.integers(1, 5000),
    ratio=st.integers(1, 127),
    share=st.fractions(0, 1),
    sign=st.sampled_from([1, -1]),
    steps=st.lists(st.integers(-400, 400), max_size=15),
)
def test_a_preset_move_lands_exactly(folmd: int, ratio: int, share: Fraction, sign: int, steps: list[int]) -> None:
    """However its master stops and reverses on the way."""
    distance = sign * int(share * folmd * ratio)
    rig = FollowingRig("MC0", f"FOLRN{ratio}", f"FOLMD{folmd}", f"D{distance}", "SMPER0", "1GO1")
    for _ in rig.turn(steps):
        pass
    backed_up = -min(0, *steps, sum(steps)) if steps else 0
    assert rig.travel(folmd + backed_up + sum(abs(step) for step in steps)) == distance
    assert not rig.following_bit(IN_RATIO_MOVE)

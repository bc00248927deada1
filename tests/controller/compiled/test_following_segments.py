"""GOBUF segments of a slave: geometry, legality, loops, outputs."""

from __future__ import annotations

from fractions import Fraction

import pytest

from tests.controller.compiled.rig import define
from tests.controller.following.rig import FollowingRig

CONDITIONS = "INVALID CONDITIONS FOR COMMAND-AXIS 1"
BOUND = "MASTER SLAVE DISTANCE MISMATCH"


def slave(*program: str, folen: bool = True) -> FollowingRig:
    rig = FollowingRig("SMPER0,0")
    define(rig, *program)
    if not folen:
        rig.ok("1FOLEN0")
    return rig


def running(*program: str) -> FollowingRig:
    rig = slave(*program)
    rig.ok("PCOMP P", "PRUN P")
    return rig


@pytest.mark.parametrize(
    ("distance", "master", "ratio", "ends"),
    [(8000, 10000, 1, 8000), (5000, 10000, 1, 5000), (3000, 10000, 1, 3000), (10000, 10000, 1, 10000)],
)
def test_a_preset_segment_with_folrnf0_is_a_preset_move(distance: int, master: int, ratio: int, ends: int) -> None:
    rig = running("MC0", f"FOLRN{ratio}", f"FOLMD{master}", f"D{distance}", "FOLRNF0", "GOBUF1")
    half = rig.travel(master // 2)
    assert half == pytest.approx(ends / 2, abs=1)
    assert rig.travel(master // 2 + 500) == ends
    assert not rig.axis_bit(1)


@pytest.mark.parametrize(
    ("start", "goal", "master", "travel"), [(0, "1", 4000, 2000), (1, "3", 10000, 20000), (2, ".5", 8000, 10000)]
)
def test_a_continuous_segment_is_one_ramp(start: int, goal: str, master: int, travel: int) -> None:
    first = (f"FOLRN{start}", "FOLMD1000", "GOBUF1") if start else ()
    rig = running("MC1", *first, f"FOLRN{goal}", f"FOLMD{master}", "GOBUF1", "FOLRN0", "FOLMD1000", "GOBUF1")
    before = start * 500
    position = rig.travel((1000 if start else 0) + master)
    assert position == pytest.approx(before + travel, abs=1)
    assert rig.travel(2000) == pytest.approx(before + travel + 500 * Fraction(goal), abs=1)


@pytest.mark.parametrize("distance", [1000, 1250, 1500, 1750, 2000])
def test_a_preset_segment_between_two_ratios(distance: int) -> None:
    """From 1 to 2 over 1000: the mean ratio D/FOLMD lies between, the distance is exact."""
    rig = running(
        *("MC1", "FOLRN1", "FOLMD1000", "GOBUF1", "MC0", "FOLRN2", f"D{distance}", "GOBUF1"),
        *("MC1", "FOLRN0", "FOLMD1000", "GOBUF1"),
    )
    assert rig.travel(2000) == 500 + distance
    assert rig.travel(1500) == 500 + distance + 1000


@pytest.mark.parametrize("program", [("D999",), ("D2001",)])
def test_a_mean_ratio_outside_the_two_is_refused(program: tuple[str, ...]) -> None:
    rig = slave("MC1", "FOLRN1", "FOLMD1000", "GOBUF1", "MC0", "FOLRN2", *program, "GOBUF1")
    assert rig.error("PCOMP P") == BOUND
    assert rig.system_bit(31)


@pytest.mark.parametrize(
    ("program", "text"),
    [
        (("MC0", "FOLRN1", "FOLMD10000", "D12000", "FOLRNF0", "GOBUF1"), BOUND),
        (
            ("MC1", "FOLRN1", "FOLMD100", "GOBUF1", "MC0", "D50", "FOLRNF0", "GOBUF1"),
            CONDITIONS,
        ),
        (("MC1", "FOLRN1", "FOLMD100", "GOBUF1", "D-1", "GOBUF1"), CONDITIONS),
        (("MC1", "FOLRN128", "FOLMD100", "GOBUF1"), "INVALID RATIO"),
        (("MC0", "FOLRN1", "FOLMD100", "D50", "GOBUF1"), "ERROR:  MOTION ENDS IN NON-ZERO VELOCITY-AXIS 1"),
    ],
)
def test_refusals(program: tuple[str, ...], text: str) -> None:
    rig = slave(*program)
    assert rig.error("PCOMP P") == text
    assert rig.error("PRUN P") == "PATH NOT COMPILED"
    assert rig.travel(1000) == 0


def test_a_loop_longer_than_the_kernels_table_ends_exactly() -> None:
    rig = running("MC0", "FOLRN3", "FOLRD2", "FOLMD10", "PLOOP300", "D7", "FOLRNF0", "GOBUF1", "PLN1")
    assert rig.travel(2900, step=37) == 7 * 290
    assert rig.travel(500) == 2100


def test_an_endless_loop_of_segments_stays_exact_for_a_thousand_cycles() -> None:
    """Ratio 1/3 for a while and back: 1000 cycles of 300 master counts are 60 slave counts each."""
    segments = ("MC1", "FOLRN1", "FOLRD3", "FOLMD120", "GOBUF1", "FOLMD60", "GOBUF1", "FOLRN0", "FOLMD120", "GOBUF1")
    rig = running("PLOOP", *segments, "PLN1")
    assert rig.travel(300 * 1000, step=97) == 60 * 1000
    assert rig.travel(-150) == 60 * 1000 - 30
    assert rig.travel(150) == 60 * 1000


def test_outputs_switch_at_their_segment() -> None:
    rig = running(
        *("MC1", "FOLRN1", "FOLMD1000", "POUTA1", "GOBUF1", "POUTAX1", "FOLMD500", "GOBUF1"),
        *("POUTA00", "FOLRN0", "GOBUF1"),
    )
    rig.travel(800)
    assert rig.number("output.1") == 1
    assert rig.number("output.2") == 0
    rig.travel(300)
    assert rig.number("output.2") == 1
    rig.travel(500)
    assert rig.number("output.1") == rig.number("output.2") == 0


def test_a_profile_of_a_slave_needs_following_at_prun() -> None:
    rig = slave("MC1", "FOLRN1", "FOLMD1000", "GOBUF1")
    rig.ok("PCOMP P", "1FOLEN0")
    assert rig.error("PRUN P") == "AXES NOT READY"
    rig.ok("1FOLEN1", "PRUN P")


def test_a_last_continuous_segment_keeps_its_ratio() -> None:
    rig = running("MC1", "FOLRN1", "FOLMD1000", "GOBUF1")
    assert rig.travel(3000) == 2500
    rig.ok("MC1", "FOLMD1000", "FOLRN0", "1GO1")
    assert rig.travel(2000) == pytest.approx(2500 + 500, abs=2)


def test_a_scaled_ratio_is_the_same_compiled_as_by_go() -> None:
    """FOLRN 1.25 at SCLD 2 is 2 counts, the rest cut off (6000 PG p.197), FOLRD 1 at SCLMAS 1 is one: ratio 2."""
    program = ("MC1", "FOLRN1.25", "FOLRD1", "FOLMD0", "GOBUF1")
    rig = FollowingRig("SMPER0,0", "SCALE1", "SCLD2,2", "SCLMAS1,1")
    define(rig, *program)
    rig.ok("PCOMP P", "PRUN P")
    compiled = rig.travel(1000)
    rig.ok("!K")
    rig.advance(1.0)
    before = rig.travel(0)
    rig.ok(*program[:-1], "1GO1")
    assert rig.travel(1000) - before == compiled

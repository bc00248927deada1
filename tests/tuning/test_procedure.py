"""The walked procedure: the guide's rules on drives whose right gains are known, bounded and repeatable."""

from __future__ import annotations

import pytest

from emulator.engine import Gains
from emulator.machine import Machine
from emulator.tuning.gains import gain_commands, parse_gains, short, tidy, value_of
from emulator.tuning.procedure import START_SGP, START_SGV, NotTunable, Search, Try, Walk
from emulator.tuning.rig import Rig, RigError
from emulator.tuning.verdict import Verdict

CALM = {Verdict.WELL_DAMPED, Verdict.SLIGHTLY_UNDER_DAMPED, Verdict.OVER_DAMPED}

TORQUE = """
[axis1.plant]
kind = "torque_drive"
viscous_nm_s_per_rev = 0.01
load_torque_nm = {load}
"""


def walked(text: str, axis_index: int = 0) -> tuple[Walk, list[Try]]:
    walk = Walk(Rig(Machine.parse(text), axis_index), Gains())
    return walk, list(walk.tries())


@pytest.mark.parametrize("axis_index", [0, 1])
def test_the_default_drive_ends_well_damped_and_faster_than_with_sgp_alone(axis_index: int) -> None:
    walk, tries = walked("", axis_index)
    final = Rig(Machine.default(), axis_index).step(walk.gains)
    assert tries[-1].verdict == Verdict.WELL_DAMPED
    alone = next(each for each in tries if each.verdict == Verdict.SLIGHTLY_UNDER_DAMPED)
    assert final.measures.time_to_90_s <= alone.measures.time_to_90_s
    assert final.measures.overshoot_percent <= 3.0
    assert final.measures.settled


def test_the_walk_begins_as_the_guide_says() -> None:
    """SGP.5 alone, raised until slightly under-damped; then SGV.1 with that SGP."""
    _, tries = walked("")
    first_sgv = next(index for index, each in enumerate(tries) if value_of(each.gains, "SGV") > 0.0)
    assert value_of(tries[0].gains, "SGP") == START_SGP
    assert [value_of(each.gains, "SGV") for each in tries[:first_sgv]] == [0.0] * first_sgv
    assert value_of(tries[first_sgv].gains, "SGV") == START_SGV
    assert tries[first_sgv - 1].verdict == Verdict.SLIGHTLY_UNDER_DAMPED
    assert all(each.verdict in {Verdict.OVER_DAMPED, Verdict.WELL_DAMPED} for each in tries[: first_sgv - 1])


def test_a_walk_is_always_the_same() -> None:
    one, other = walked(""), walked("")
    assert one[0].gains == other[0].gains
    assert [each.measures for each in one[1]] == [each.measures for each in other[1]]


def test_a_load_calls_for_integral_action_and_a_torque_drive_for_velocity_feedback() -> None:
    walk, tries = walked(TORQUE.format(load=0.1))
    assert value_of(walk.gains, "SGV") > 0.0
    assert value_of(walk.gains, "SGI") > 0.0
    without = next(each for each in tries if value_of(each.gains, "SGI") > 0.0)
    final = Rig(Machine.parse(TORQUE.format(load=0.1)), 0).step(walk.gains)
    assert abs(final.measures.steady_error_counts) < 0.1 * abs(without.measures.steady_error_counts)
    assert len(tries) < 120


def test_without_load_integral_action_stays_off_and_is_said_to() -> None:
    walk, _ = walked("")
    assert value_of(walk.gains, "SGI") == 0.0
    assert any("SGI stays 0" in note for note in walk.notes)


def test_feedforward_takes_the_error_out_of_a_move_at_constant_velocity() -> None:
    rig = Rig(Machine.default(), 0)
    walk = Walk(rig, Gains())
    list(walk.tries())
    assert value_of(walk.gains, "SGVF") > 0.0
    assert abs(rig.cruise(walk.gains).cruise_error_counts) < 2.0


def test_reversed_feedback_cannot_be_tuned_and_that_is_said_in_one_line() -> None:
    walk = Walk(Rig(Machine.parse('[defaults]\nENCPOL = "1,0"\n'), 0), Gains())
    with pytest.raises(NotTunable, match="polarity"):
        list(walk.tries())


def test_a_unit_that_refuses_is_quoted() -> None:
    with pytest.raises(RigError, match=r"refuses DRIVE1: .*ENABLE"):
        Rig(Machine.parse("bare = true\n"), 0).step(Gains())


def test_a_search_doubles_until_too_much_and_then_halves_the_ratio() -> None:
    search = Search(1.0, 2.0)
    tried = []
    while not search.closed:
        tried.append(search.value)
        search.too_much() if search.value > 5.5 else search.too_little()
    assert tried[:5] == [1.0, 2.0, 4.0, 8.0, 5.66]
    assert search.low is not None and search.high is not None
    assert search.low <= 5.5 < search.high <= 1.1 * search.low


def test_gains_as_typed() -> None:
    assert parse_gains("SGP=15,sgv=2") == {"SGP": 15.0, "SGV": 2.0}
    gains = Gains(15.0, 0.1, 2.0)
    assert gain_commands(gains, 0)[:3] == ["SGP15", "SGI0.1", "SGV2"]
    assert gain_commands(gains, 1)[0] == "SGP,15"
    assert short(gains) == "SGP 15  SGI 0.1  SGV 2"
    assert tidy(1e-7) == "0.0000001"
    for text in ("SGP", "SGP=x", "XYZ=1", "SGP=-1", "SGP=nan", "SGP=1,SGP=2"):
        with pytest.raises(ValueError):
            parse_gains(text)

"""Phase shifts and geared advances: they add exactly to what the master asks of its slave."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.following.rig import ARRIVE, FollowingRig
from tests.controller.session import both_on

SHIFTING, CONTINUOUS, NEGATIVE = 10, 11, 12


def at_ratio(*commands: str) -> FollowingRig:
    rig = FollowingRig("MC1", "FOLMD0", "SMPER0", *commands, "1GO1")
    rig.travel(100)
    return rig


def shift_of(rig: FollowingRig) -> int:
    return int(rig.look("1TPSHF").removeprefix("1TPSHF"))


@pytest.mark.parametrize("distance", [500, -500])
def test_a_preset_shift_adds_its_distance_while_the_master_rests(distance: int) -> None:
    rig = at_ratio()
    rig.ok(f"1FSHFD{distance}")
    rig.advance(0.05)
    assert rig.following_bits()[9:12] == ("100" if distance > 0 else "101")
    rig.advance(1.0)
    assert rig.position() == 100 + distance
    assert shift_of(rig) == distance
    assert rig.following_bits()[9:12] == "000"
    assert rig.travel(1000) == 1100 + distance


@settings(deadline=None, max_examples=20)
@given(
    shifts=st.lists(st.integers(-5000, 5000).filter(bool), min_size=1, max_size=4),
    steps=st.lists(st.integers(-60, 60), min_size=1, max_size=8),
)
def test_shifts_add_exactly_under_a_moving_master(shifts: list[int], steps: list[int]) -> None:
    rig = at_ratio("FOLRN3", "FOLRD2", "V20", "A200")
    for shift in shifts:
        rig.ok(f"1FSHFD{shift}")
        for _ in rig.turn(steps * 40):
            pass
        rig.advance(1.0)
    *_, position = rig.turn(ARRIVE)
    assert position == (3 * rig.master_counts + 1) // 2 + sum(shifts)
    assert shift_of(rig) == sum(shifts)


def test_the_shift_takes_its_time_from_v_a_and_ad() -> None:
    """1 rev at V1 A10 AD10: 0.1 + 0.9 + 0.1 s, within a system update."""
    rig = at_ratio("V1", "A10", "AD10")
    rig.ok("1FSHFD4000")
    began = rig.now_ns
    assert rig.emulator.run_until(lambda: not rig.following_bit(SHIFTING), timeout_s=5.0)
    assert (rig.now_ns - began) / 1e9 == pytest.approx(1.1, abs=2 * rig.update_ns / 1e9)


def test_an_s_curve_shift_takes_the_average_acceleration() -> None:
    """V1, AA5: ramps of 0.2 s, so 1.2 s for a revolution."""
    rig = at_ratio("V1", "A10", "AA5")
    rig.ok("1FSHFD4000")
    began = rig.now_ns
    assert rig.emulator.run_until(lambda: not rig.following_bit(SHIFTING), timeout_s=5.0)
    assert (rig.now_ns - began) / 1e9 == pytest.approx(1.2, abs=2 * rig.update_ns / 1e9)


@pytest.mark.parametrize(("field", "sign", "bits"), [(1, 1, "110"), (2, -1, "111")])
def test_a_continuous_shift_goes_on_until_it_is_stopped(field: int, sign: int, bits: str) -> None:
    rig = at_ratio("V2", "A20", "AD20")
    rig.ok(f"1FSHFC{field}")
    rig.advance(1.1)
    assert rig.following_bits()[9:12] == bits
    assert shift_of(rig) == pytest.approx(sign * 2 * 4000 * 1.05, abs=30)
    before = shift_of(rig)
    rig.ok("1FSHFC0")
    rig.advance(0.5)
    assert abs(shift_of(rig) - before) == pytest.approx(400, abs=20), "V^2 / 2 AD"
    assert rig.following_bits()[9:12] == "000"
    assert rig.position() == 100 + shift_of(rig)


def test_a_killed_shift_stops_dead() -> None:
    rig = at_ratio("V2", "A20")
    rig.ok("1FSHFC1")
    rig.advance(1.0)
    before = rig.position()
    rig.ok("1FSHFC3")
    rig.advance(0.5)
    assert 0 <= rig.position() - before <= 40


def test_a_slave_at_rest_may_be_shifted() -> None:
    """Following is enabled, no move has been commanded."""
    rig = FollowingRig()
    assert rig.following_bit(9)
    rig.ok("1FSHFD250")
    rig.advance(1.0)
    assert rig.position() == 250
    assert not rig.axis_bit(1)
    assert rig.travel(1000) == 250


def test_the_next_ratio_move_takes_the_shift_over() -> None:
    rig = at_ratio()
    rig.ok("1FSHFD333")
    rig.advance(1.0)
    rig.ok("FOLRN2", "1GO")
    rig.travel(0)
    assert shift_of(rig) == 0
    assert rig.travel(100) == 100 + 333 + 200


def test_a_shift_distance_is_scaled() -> None:
    rig = at_ratio()
    rig.ok("!1S")
    rig.advance(0.5)
    rig.ok("1PSET0", "SCLD1000", "SCALE1", "1FSHFD1.2345")
    rig.advance(1.0)
    assert rig.look("1TPSHF") == "1TPSHF+1.234"


def test_with_comexc0_a_preset_shift_holds_the_buffer() -> None:
    rig = FollowingRig("V1", "A10", COMEXC=0)
    answers = rig.timed("1FSHFD4000:OUT1", wait_s=2.0)
    assert answers[-1].at_ns / 1e9 == pytest.approx(1.1, abs=0.01)


class TestGearedAdvance:
    @pytest.mark.parametrize(("distance", "step"), [(300, 50), (-300, 50), (300, -50), (-300, -50), (1000, 50)])
    def test_adds_its_distance_over_folmd(self, distance: int, step: int) -> None:
        """Whichever way the master goes, and also where it needs the full ratio all the way."""
        rig = at_ratio()
        rig.ok("FOLMD1000")
        for _ in rig.turn([step] * 4):
            pass
        assert rig.following_bits()[22:24] == "10"
        rig.ok(f"1FGADV{distance}")
        assert rig.following_bits()[22:24] == "01"
        *_, position = rig.turn([step] * 10)
        *_, position = rig.turn([step] * 30 + list(ARRIVE))
        assert position == rig.master_counts + distance
        assert rig.following_bits()[22:24] == "10"
        assert rig.following_bits()[:4] == "1001"

    def test_is_half_way_in_the_middle(self) -> None:
        rig = at_ratio()
        rig.ok("FOLMD1000", "1FGADV400")
        assert rig.travel(500) == 600 + 200

    def test_refuses_others_while_it_is_under_way(self) -> None:
        rig = at_ratio()
        rig.ok("FOLMD1000", "1FGADV1000")
        rig.travel(500)
        for text in ("1FGADV1", "1FSHFD1", "1GO1"):
            assert rig.error(text) == "NOT VALID DURING FOLLOWING MOTION"
        assert rig.travel(500) == 2100

    def test_with_comexc0_it_holds_the_buffer_until_it_is_over(self) -> None:
        rig = at_ratio()
        rig.ok("FOLMD1000", "COMEXC0")
        for _ in rig.turn([50] * 3):
            pass
        assert rig.ask("1FGADV1000") == ""
        for _ in rig.turn([50] * 10):
            pass
        assert rig.read() == ""
        for _ in rig.turn([50] * 15):
            pass
        assert rig.read() == "\r\n> "


def test_a_shift_does_not_start_into_a_limit() -> None:
    session = both_on("COMEXC1", "1FOLMAS+21", "1FOLEN1")
    session.set_wire("axis1.positive_limit", closed=False)
    session.ok("1FSHFD100")
    session.advance(0.5)
    assert session.position() == 0
    assert session.axis_bit(15)
    session.ok("1FSHFD-100")
    session.advance(0.5)
    assert session.position() == -100
    assert not session.axis_bit(15)

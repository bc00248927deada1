"""Homing against an independent statement of where the axis must come to rest, for every setting and start.

The shaft starts at 0 rev; the home switch lies before, around or behind it, the limit switches 3 rev away.  What is
checked is the true position of the shaft, which no counter and no PSET can move.
"""

from __future__ import annotations

import math
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.session import SYSTEM_NS, TRAJECTORY_NS, Session

COUNTS = 4000
LIMIT_REV = 3.0

HOMV_COUNTS_S = 4000.0
HOMA_COUNTS_S2 = 40_000.0
LOOP_GAIN_PER_S = 0.5e-3 * 10 * COUNTS
"""SGP 0.5 mV/count times 10 rev/s per volt: how far the shaft trails is velocity over this."""

BRAKING = HOMV_COUNTS_S**2 / (2 * HOMA_COUNTS_S2)
TRAILING = HOMV_COUNTS_S / LOOP_GAIN_PER_S
PER_UPDATE = HOMV_COUNTS_S * (SYSTEM_NS + TRAJECTORY_NS) / 1e9

ZONES = {"before": (1.0, 1.5), "inside": (-0.25, 0.25), "behind": (-1.5, -1.0)}
INDEX_PHASE = {"before": 0.3, "inside": 0.1, "behind": 0.8}
"""One pulse a revolution, inside each zone."""


def unit(
    home: tuple[float, float] | None,
    *commands: str,
    index_phase: float = 0.0,
    limits: tuple[float, float] = (-LIMIT_REV, LIMIT_REV),
) -> Session:
    switches = f"home_from_rev = {home[0]}\nhome_to_rev = {home[1]}" if home else ""
    session = Session(
        f"[axis1.encoder]\nindex_phase = {index_phase}\n[axis1.travel]\n"
        f"positive_limit_rev = {limits[1]}\nnegative_limit_rev = {limits[0]}\n{switches}\n"
    )
    session.ok("DRIVE10", "COMEXC1", "ERROR11111111", *commands)
    return session


def at_home(session: Session, command: str) -> int:
    """Home, wait for rest and settling; the true position of the shaft in whole counts."""
    session.ok(command)
    session.until_rest(timeout_s=120)
    session.advance(0.6)
    return shaft(session)


def shaft(session: Session) -> int:
    return math.floor(session.number("axis1.position.true") * COUNTS + 1e-6)


def counts(revolutions: float) -> int:
    return round(revolutions * COUNTS)


@pytest.mark.parametrize(("zone", "way", "edge", "final"), list(product(ZONES, (0, 1), (0, 1), (0, 1))), ids=str)
def test_backing_up_ends_on_the_chosen_edge(zone: str, way: int, edge: int, final: int) -> None:
    session = unit(ZONES[zone], "HOMBAC1", f"HOMEDG{edge}", f"HOMDF{final}")
    rest = at_home(session, f"HOM{way}")
    assert abs(rest - counts(ZONES[zone][0 if edge else 1])) <= 1
    assert session.axis_bit(5)
    assert session.position() == 0
    assert not session.axis_bit(15) and not session.axis_bit(16)
    assert not session.error_bit(2)


@pytest.mark.parametrize(("zone", "way"), list(product(ZONES, (0, 1))), ids=str)
def test_without_backing_up_the_axis_rests_behind_the_first_edge(zone: str, way: int) -> None:
    rest = at_home(session := unit(ZONES[zone]), f"HOM{way}")
    if zone == "inside":
        assert rest in (0, -1)
    else:
        edge, direction = (counts(1.0), 1) if zone == "before" else (counts(-1.0), -1)
        beyond = (rest - edge) * direction
        assert BRAKING + TRAILING * 0.5 <= beyond <= BRAKING + TRAILING + PER_UPDATE + 2
    assert session.axis_bit(5)
    assert session.position() == 0


@pytest.mark.parametrize(("zone", "way", "edge"), list(product(ZONES, (0, 1), (0, 1))), ids=str)
def test_the_index_pulse_is_found_where_the_approach_enters_the_zone(zone: str, way: int, edge: int) -> None:
    phase = INDEX_PHASE[zone]
    session = unit(ZONES[zone], "HOMZ1", f"HOMEDG{edge}", f"HOMDF{1 - edge}", index_phase=phase)
    rest = at_home(session, f"HOM{way}")
    low, high = ZONES[zone]
    pulse = next(turn + phase for turn in range(-2, 3) if low < turn + phase < high)
    assert abs(rest - counts(pulse)) <= 1
    assert session.axis_bit(5)
    assert session.look("1TASX.6") == "1"


@pytest.mark.parametrize("edge", (0, 1))
def test_an_approach_out_of_the_zone_finds_no_index_pulse(edge: int) -> None:
    session = unit(ZONES["before"], "HOMZ1", f"HOMEDG{edge}", f"HOMDF{edge}", index_phase=0.3)
    at_home(session, "HOM0")
    assert not session.axis_bit(5)
    assert session.axis_bit(15 if edge == 0 else 16)
    assert session.error_bit(2)


def test_without_a_home_switch_both_limits_end_the_search() -> None:
    session = unit(None)
    session.ok("HOM0")
    session.advance(3.5)
    assert session.number("axis1.velocity.commanded") < 0
    assert not session.error_bit(2)
    session.until_rest()
    session.advance(0.5)
    assert -LIMIT_REV * COUNTS - 600 <= shaft(session) <= -LIMIT_REV * COUNTS
    assert not session.axis_bit(5)
    assert session.axis_bit(16) and not session.axis_bit(15)
    assert session.error_bit(2)


def test_on_a_limit_the_search_begins_the_other_way() -> None:
    session = unit((-1.5, -1.0), limits=(-LIMIT_REV, 0.0))
    rest = at_home(session, "HOM0")
    assert rest < counts(-1.0)
    assert session.axis_bit(5)
    assert not session.axis_bit(15)


def test_on_both_limits_nothing_moves() -> None:
    session = Session("[axis1.wires]\npositive_limit = 'open'\nnegative_limit = 'open'\n")
    session.ok("DRIVE10", "ERROR.2-1")
    session.ok("HOM0")
    assert not session.signal("axis1.moving")
    assert session.axis_bit(16) and not session.axis_bit(5)
    assert session.error_bit(2)


def test_a_disabled_end_is_not_seen() -> None:
    session = unit((3.5, 4.0), "LH0,3")
    rest = at_home(session, "HOM0")
    assert counts(3.5) < rest < counts(4.0)
    assert session.axis_bit(5)


def test_home_level_turns_the_switch_round() -> None:
    """HOMLVL1: an open input is active, so the axis starts at home."""
    session = unit((1.0, 1.5), "HOMLVL1")
    assert at_home(session, "HOM0") in (0, -1)
    assert session.axis_bit(5)


def test_the_switch_can_be_a_plain_contact() -> None:
    session = unit(None)
    session.ok("HOM0")
    session.advance(0.5)
    session.set_wire("axis1.home", closed=True)
    session.until_rest()
    session.advance(0.5)
    assert session.axis_bit(5)
    assert 0 < shaft(session) < counts(1)


def test_duration_is_that_of_the_profile() -> None:
    """Ramp, constant velocity until the shaft (which trails) is at the edge, ramp: 1 + 0.05 + 0.05 + 0.1 s."""
    session = unit((1.0, 1.5), "COMEXC0")
    ideal_s = (
        COUNTS / HOMV_COUNTS_S
        + HOMV_COUNTS_S / (2 * HOMA_COUNTS_S2)
        + 1 / LOOP_GAIN_PER_S
        + HOMV_COUNTS_S / HOMA_COUNTS_S2
    )
    prompts = session.timed("HOM0", wait_s=2)
    assert [stamped.text for stamped in prompts] == ["\r\n> "]
    late_s = prompts[0].at_ns / 1e9 - ideal_s
    assert 0 <= late_s <= (3 * SYSTEM_NS + TRAJECTORY_NS) / 1e9


def test_the_prompt_comes_when_homing_is_over_and_commands_wait() -> None:
    session = unit((1.0, 1.5), "COMEXC0", "HOMBAC1")
    assert session.ask("HOM0") == ""
    assert session.ask("TPC", wait_s=1.5) == ""
    session.advance(4)
    assert session.read() == "\r\n> *TPC+0,+0\r\r\n> "


def test_go_during_homing_is_refused_and_homing_goes_on() -> None:
    session = unit((1.0, 1.5))
    session.ok("HOM0")
    session.advance(0.3)
    for text in ("1GO", "GO", "GO10", "!1GO", "HOM1"):
        assert session.error(text) == "MOTION IN PROGRESS"
    session.until_rest()
    assert session.axis_bit(5)


@pytest.mark.parametrize("stop", ("!S", "!K", "!1S", "!1K1", "\x0b", "!DRIVE0"))
def test_stop_and_kill_abort(stop: str) -> None:
    session = unit((1.0, 1.5))
    session.ok("HOM0")
    session.advance(0.4)
    session.ask(stop)
    session.advance(1.0)
    assert not session.signal("axis1.moving")
    assert not session.axis_bit(5)
    assert shaft(session) < counts(1.0)
    session.ok("DRIVE10")
    at_home(session, "HOM0")
    assert session.axis_bit(5)


def test_home_successful_is_lost_when_homing_begins_again() -> None:
    session = unit((1.0, 1.5))
    at_home(session, "HOM0")
    session.ok("1D-8000", "1GO")
    session.until_rest()
    assert session.axis_bit(5)
    session.ok("HOM0")
    assert not session.axis_bit(5)
    session.ask("RESET")
    assert not session.axis_bit(5)


def test_a_standing_error_is_kept() -> None:
    """A load the loop holds with an error: the command is zero, the encoder is not."""
    session = Session(
        '[axis1.plant]\nkind = "torque_drive"\nload_torque_nm = 0.5\nviscous_nm_s_per_rev = 0.02\n'
        "[axis1.travel]\nhome_from_rev = 0.5\nhome_to_rev = 0.8\n"
    )
    session.ok("SGP20", "SGV200", "DRIVE10", "COMEXC1")
    at_home(session, "HOM0")
    error = int(session.look("1TPER").removeprefix("1TPER"))
    assert session.axis_bit(5)
    assert session.position() == 0
    assert error > 10
    assert session.look("1TPE") == f"1TPE{-error:+d}"


@pytest.mark.parametrize(
    ("settings_given", "text"),
    (
        (("HOMA10", "HOMAA4"), "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
        (("HOMA10", "HOMAD10", "HOMADA11"), "INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD 1"),
        (("HOMV0",), "INVALID CONDITIONS FOR COMMAND"),
        (("HOMBAC1", "HOMVF0"), "INVALID CONDITIONS FOR COMMAND"),
        (("DRIVE0",), "DRIVE SHUTDOWN"),
        (("1SFB0",), "NOT ALLOWED IF SFB0"),
    ),
)
def test_refusals(settings_given: tuple[str, ...], text: str) -> None:
    session = unit((1.0, 1.5))
    session.ok(*settings_given)
    assert session.error("HOM0") == text
    assert not session.signal("axis1.moving")


def test_enable_open_refuses() -> None:
    session = unit((1.0, 1.5))
    session.set_wire("enable", closed=False)
    session.read()
    assert session.error("HOM0") == "WARNING: ENABLE INPUT INACTIVE"


def test_hom_needs_a_direction_and_x_leaves_an_axis_alone() -> None:
    session = unit((1.0, 1.5))
    assert session.error("HOM") == "INCORRECT DATA"
    session.ok("HOMX")
    assert not session.signal("axis1.moving")
    session.ok("1HOM0")
    assert session.signal("axis1.moving")
    assert not session.signal("axis2.moving")


def test_s_curve_homing_ends_on_the_same_edge() -> None:
    session = unit((1.0, 1.5), "HOMA20", "HOMAA10", "HOMAD20", "HOMADA10", "HOMBAC1")
    assert abs(at_home(session, "HOM0") - counts(1.5)) <= 1


@settings(max_examples=40, deadline=None)
@given(
    low=st.integers(-8000, 7000),
    width=st.integers(100, 3000),
    way=st.integers(0, 1),
    edge=st.integers(0, 1),
    final=st.integers(0, 1),
    fast=st.sampled_from(("HOMV0.5", "HOMV2", "HOMV1")),
)
def test_any_geometry_ends_on_the_chosen_edge(low: int, width: int, way: int, edge: int, final: int, fast: str) -> None:
    zone = (low / COUNTS, (low + width) / COUNTS)
    session = unit(zone, "HOMBAC1", f"HOMEDG{edge}", f"HOMDF{final}", fast, "HOMA20", "LHAD200", limits=(-3.5, 3.5))
    rest = at_home(session, f"HOM{way}")
    assert abs(rest - counts(zone[0 if edge else 1])) <= 1
    assert session.axis_bit(5)

"""GOL as a host sees it: a straight line in counts and time, what stops it, and what is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.session import OK, ONE_UPDATE_EACH_NS, SYSTEM_NS, TRAJECTORY_NS, S, Session, both_on

COUNTS_PER_REV = 4000


def liner(*commands: str, **defaults: str | int) -> Session:
    """Both drives on, position errors not watched."""
    return both_on("SMPER0,0", *commands, **defaults)


def track(session: Session, *, timeout_s: float = 60.0) -> list[tuple[int, int, int]]:
    """Time and both commanded positions at every trajectory update until both axes are at rest."""
    rows = []
    end_ns = session.now_ns + round(timeout_s * S)
    while session.signal("axis1.moving") or session.signal("axis2.moving"):
        session.unit.controller.advance(session.unit.controller.engine.next_trajectory_ns)
        rows.append((session.now_ns, *positions(session)))
        assert session.now_ns < end_ns
    return rows


def positions(session: Session) -> tuple[int, int]:
    engine = session.unit.controller.engine
    return engine.commanded_position(0), engine.commanded_position(1)


def speeds(session: Session) -> tuple[float, float]:
    return session.number("axis1.velocity.commanded"), session.number("axis2.velocity.commanded")


def off_line(here: tuple[int, int], start: tuple[int, int], target: tuple[int, int]) -> float:
    """Distance of a point from a line, counts."""
    along = (target[0] - start[0], target[1] - start[1])
    step = (here[0] - start[0], here[1] - start[1])
    return abs(along[0] * step[1] - along[1] * step[0]) / math.hypot(*along)


@pytest.mark.parametrize(
    ("distances", "pv", "pa", "pad", "seconds", "axis_speeds", "axis_ramps"),
    [
        # the two-axis rows of following-and-profiles 6.1, in revolutions
        ((3, 4), 5, 50, 50, 1.1, (3, 4), (30, 40)),
        ((10, 5), 5, 25, 20, 2.461068, (4.472136, 2.236068), (22.36068, 11.18034)),
        ((-3, 4), 5, 50, 50, 1.1, (-3, 4), (-30, 40)),
        ((0, -5), 5, 50, 50, 1.1, (0, -5), (0, -50)),
    ],
)
def test_the_table_of_the_reference(
    distances: tuple[int, int],
    pv: int,
    pa: int,
    pad: int,
    seconds: float,
    axis_speeds: tuple[float, float],
    axis_ramps: tuple[float, float],
) -> None:
    counts = tuple(distance * COUNTS_PER_REV for distance in distances)
    session = liner(f"PV{pv}", f"PA{pa}", f"PAD{pad}", f"D{counts[0]},{counts[1]}", "COMEXC1", "GOL11")
    assert session.axis_bit(1, axis=1) and session.axis_bit(1, axis=2)
    start_ns = session.unit.controller.engine.next_trajectory_ns
    session.advance(0.05)
    for axis in (1, 2):
        ramp = session.number(f"axis{axis}.acceleration.commanded")
        assert ramp == pytest.approx(axis_ramps[axis - 1] * COUNTS_PER_REV, abs=0.01)
    session.advance(0.5)
    assert speeds(session) == pytest.approx([speed * COUNTS_PER_REV for speed in axis_speeds], abs=0.01)
    rows = track(session)
    assert positions(session) == counts
    assert 0 <= rows[-1][0] - start_ns - round(seconds * S) <= TRAJECTORY_NS
    assert all(off_line(here, (0, 0), counts) <= 1.0 for _, *here in rows)  # type: ignore[arg-type]


def test_the_prompt_waits_for_the_end() -> None:
    session = liner("PV5", "PA50", "PAD50", "D12000,16000")
    prompts = session.timed("GOL", wait_s=2)
    assert [text for _, text in prompts] == [OK]
    assert 0 < prompts[0].at_ns - round(1.1 * S) <= ONE_UPDATE_EACH_NS


@given(
    st.tuples(st.integers(-200_000, 200_000), st.integers(-200_000, 200_000)).filter(any),
    st.sampled_from(["0", "5", "7.5"]),
    st.booleans(),
)
@settings(max_examples=25, deadline=None)
def test_both_axes_are_on_the_line_all_the_time(target: tuple[int, int], average: str, absolute: bool) -> None:
    session = liner("COMEXC1", "D-1234,777", "GO", "PA10", f"PAA{average}", "PV20")
    session.until_rest(1)
    session.until_rest(2)
    start = positions(session)
    goal = target if absolute else (start[0] + target[0], start[1] + target[1])
    if goal == start:
        return
    session.ok(f"MA{int(absolute) * 11:02d}", f"D{target[0]},{target[1]}", "GOL")
    rows = track(session)
    assert positions(session) == goal
    assert all(off_line(here, start, goal) <= 1.0 for _, *here in rows)  # type: ignore[arg-type]
    travelled = [math.dist(start, here) for _, *here in rows]
    assert all(one <= other + 1.5 for one, other in pairwise(travelled))


@pytest.mark.parametrize(("average", "seconds"), [("0", 2.461068), ("25", 2.461068)])
def test_no_s_curve_with_the_average_off_or_equal(average: str, seconds: float) -> None:
    session = liner("PV5", "PA25", f"PAA{average}", "PAD20", "D40000,20000")
    prompts = session.timed("GOL", wait_s=3)
    assert 0 < prompts[0].at_ns - round(seconds * S) <= ONE_UPDATE_EACH_NS


def test_s_curves_last_as_long_as_ramps_at_the_average() -> None:
    session = liner("PV5", "PA50", "PAA25", "D12000,16000")
    prompts = session.timed("GOL", wait_s=3)
    assert 0 < prompts[0].at_ns - round(1.2 * S) <= ONE_UPDATE_EACH_NS
    assert positions(session) == (12000, 16000)
    session.ok("COMEXC1", "GOL")
    session.advance(0.05)
    assert math.hypot(*(session.number(f"axis{axis}.acceleration.commanded") for axis in (1, 2))) == pytest.approx(
        0.05 * 500 * COUNTS_PER_REV, rel=0.07
    )


def test_scaling() -> None:
    """SCLD scales the distances, PSCLV and PSCLA the path: 3 and 4 units of 8000 counts at 5 of 4000."""
    session = liner("SCALE1", "SCLD8000,8000", "PSCLV4000", "PSCLA2000", "PV5", "PA50", "PAD100", "D3,4", "COMEXC1")
    session.ok("GOL")
    session.advance(1.0)
    assert speeds(session) == pytest.approx((12000, 16000))
    track(session)
    assert positions(session) == (24000, 32000)


def test_one_axis_by_mask_and_by_prefix() -> None:
    session = liner("PV5", "PA50", "D4000,4000")
    session.ok("COMEXC1", "GOL10")
    session.advance(2)
    assert positions(session) == (4000, 0)
    session.ok("2GOL")
    session.advance(2)
    assert positions(session) == (4000, 4000)
    session.ok("GOL00", "GOLXX")
    assert not session.signal("axis1.moving")


def test_two_single_lines_at_once() -> None:
    session = liner("COMEXC1", "PV1", "D4000,4000", "GOL10", "PV2", "GOL01")
    session.advance(0.5)
    assert speeds(session) == pytest.approx((4000, 8000))
    session.ok("!1S")
    session.advance(2)
    x, y = positions(session)
    assert x < 4000 and y == 4000


def test_no_distance_no_motion() -> None:
    session = liner("D0,0")
    session.ok("GOL")
    assert not session.signal("axis1.moving")
    session.ok("MA11", "D0,0", "GOL", "MA10", "D0,4000", "GOL", wait_s=2)
    assert positions(session) == (0, 4000)


# What is refused: nothing moves, and the next command works.


@pytest.mark.parametrize(
    ("commands", "command", "text"),
    [
        (("MC01",), "GOL", "INVALID CONDITIONS FOR COMMAND-AXIS 2"),
        (("MC10",), "GOL10", "INVALID CONDITIONS FOR COMMAND-AXIS 1"),
        (("FOLMAS+24", "FOLEN1"), "GOL", "INVALID CONDITIONS FOR COMMAND-AXIS 1"),
        (("PV0",), "GOL", "PATH VELOCITY ZERO"),
        (("PA10", "PAA4.9"), "GOL", "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
        (("PAD10", "PADA10.1"), "GOL", "INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD 1"),
        (("DRIVE01",), "GOL", "DRIVE SHUTDOWN"),
        (("DRIVE10",), "GOL11", "DRIVE SHUTDOWN"),
        (("DRIVE00", "SFB0,1", "DRIVE11"), "GOL", "NOT ALLOWED IF SFB0"),
        ((), "3GOL", "INCORRECT AXIS"),
        ((), "GOL111", "INCORRECT AXIS"),
    ],
)
def test_what_is_refused(commands: tuple[str, ...], command: str, text: str) -> None:
    session = liner("D4000,4000")
    session.ok(*commands)
    assert session.error(command) == text
    session.advance(0.5)
    assert positions(session) == (0, 0)
    assert session.query("1D") == "1D+4000"


def test_enable_open() -> None:
    session = liner("D4000,4000")
    session.set_wire("enable", closed=False)
    assert session.error("GOL") == "WARNING: ENABLE INPUT INACTIVE"


def test_neither_gol_nor_go_pre_empts_a_line() -> None:
    session = liner("COMEXC1", "PV1", "D8000,4000", "GOL")
    session.advance(0.3)
    assert session.error("GOL") == "MOTION IN PROGRESS"
    assert session.error("!GO1") == "MOTION IN PROGRESS"
    assert session.error("HOM0X") == "MOTION IN PROGRESS"
    track(session)
    assert positions(session) == (8000, 4000)
    session.ok("GO1")
    session.advance(0.1)
    assert session.error("GOL") == "MOTION IN PROGRESS"


# What stops it.


@pytest.mark.parametrize("command", ["!S", "!S10", "!2S", "!S01"])
def test_a_stop_of_either_axis_stops_both_along_the_line(command: str) -> None:
    session = liner("COMEXC1", "PV5", "PA50", "PAD25", "PADA25", "AD999,999", "D120000,160000", "GOL")
    session.advance(1.0)
    before = positions(session)
    assert speeds(session) == pytest.approx((12000, 16000))
    session.ok(command)
    rows = track(session)
    # 5 rev/s at 25 rev/s2: 0.2 s and half a revolution
    assert len(rows) * TRAJECTORY_NS / S == pytest.approx(0.2, abs=0.003)
    assert math.dist(before, positions(session)) == pytest.approx(0.5 * COUNTS_PER_REV, abs=25)
    assert all(off_line(here, (0, 0), (3, 4)) <= 1.0 for _, *here in rows)  # type: ignore[arg-type]
    session.ok("D100,100", "GOL")


def test_a_stop_on_an_s_curve() -> None:
    session = liner("COMEXC1", "PV5", "PA50", "PAD25", "PADA12.5", "D120000,160000", "GOL")
    session.advance(1.0)
    session.ok("!S")
    rows = track(session)
    assert len(rows) * TRAJECTORY_NS / S == pytest.approx(0.4, abs=0.003)
    assert off_line(positions(session), (0, 0), (3, 4)) <= 1.0


@pytest.mark.parametrize("command", ["!K", "!K1", "!2K"])
def test_a_kill_takes_the_lowest_lhad(command: str) -> None:
    session = liner("COMEXC1", "PV5", "PA50", "PAD5", "LHAD50,100", "D120000,160000", "GOL")
    session.advance(1.0)
    session.ok(command)
    rows = track(session)
    assert len(rows) * TRAJECTORY_NS / S == pytest.approx(0.1, abs=0.003)
    assert off_line(positions(session), (0, 0), (3, 4)) <= 1.0


def test_a_kill_while_stopping_is_harder() -> None:
    session = liner("COMEXC1", "PV5", "PA50", "PAD5", "LHAD50,50", "D120000,160000", "GOL")
    session.advance(1.0)
    session.ok("!S")
    session.advance(0.1)
    session.ok("!K")
    assert len(track(session)) * TRAJECTORY_NS / S == pytest.approx(4.5 / 50, abs=0.003)
    assert off_line(positions(session), (0, 0), (3, 4)) <= 1.0


def test_a_stop_near_the_end_ends_at_the_target() -> None:
    session = liner("COMEXC1", "PV5", "PA50", "PAD50", "D12000,16000", "GOL")
    session.advance(1.05)
    session.ok("PAD5", "!S")
    track(session)
    assert positions(session) == (12000, 16000)


def test_a_stop_before_the_first_update() -> None:
    session = liner("COMEXC1", "PV5", "D12000,16000", "GOL", "!S")
    track(session)
    assert positions(session) == (0, 0)


def test_a_limit_stops_both_axes_along_the_line() -> None:
    session = liner("COMEXC1", "COMEXL11", "PV5", "PA50", "LHAD100,100", "D120000,160000", "GOL")
    session.advance(1.0)
    session.set_wire("axis2.positive_limit", closed=False)
    rows = track(session)
    assert len(rows) * TRAJECTORY_NS / S <= 0.055
    assert off_line(positions(session), (0, 0), (3, 4)) <= 1.0
    assert session.axis_bit(15, axis=2) and not session.axis_bit(15, axis=1)


def test_a_soft_limit_stops_both_axes_along_the_line() -> None:
    session = liner("COMEXC1", "LS3,0", "LSPOS20000", "LSAD50,50", "PV5", "PA50", "D120000,160000", "GOL")
    track(session)
    x, y = positions(session)
    assert 20000 < x < 20000 + 0.25 * COUNTS_PER_REV + 2 * 5 * COUNTS_PER_REV * SYSTEM_NS / S
    assert off_line((x, y), (0, 0), (3, 4)) <= 1.0


def test_no_axis_starts_into_the_limit_of_one() -> None:
    session = liner("COMEXC1", "D4000,-4000")
    session.set_wire("axis2.negative_limit", closed=False)
    session.ok("GOL")
    session.advance(0.5)
    assert positions(session) == (0, 0)
    assert session.axis_bit(16, axis=2) and not session.axis_bit(16, axis=1)
    session.ok("D4000,4000", "GOL")
    session.advance(2)
    assert positions(session) == (4000, 4000)
    assert not session.axis_bit(16, axis=2)


@pytest.mark.parametrize("kill", ["kill", "position error"])
def test_a_drive_that_drops_out_stops_the_other_axis(kill: str) -> None:
    session = liner("COMEXC1", "PV5", "PA50", "KDRIVE10", "LHAD50,50", "D120000,160000", "GOL")
    session.advance(1.0)
    session.ok("!1K" if kill == "kill" else "SMPER1,0")
    rows = track(session)
    assert len(rows) * TRAJECTORY_NS / S == pytest.approx(0.1, abs=0.01)
    assert session.query("DRIVE") == "DRIVE01"
    session.advance(0.5)
    session.ok("DRIVE11", "D100,100", "SMPER0", "GOL")


def test_enable_opened_on_the_way() -> None:
    session = liner("COMEXC1", "PV5", "PA50", "D120000,160000", "GOL")
    session.advance(1.0)
    session.set_wire("enable", closed=False)
    assert not session.signal("axis1.moving") and not session.signal("axis2.moving")
    session.set_wire("enable", closed=True)
    session.advance(0.5)
    session.ok("@DRIVE1", "D100,100", "GOL")


def test_a_pause_takes_the_line_up_again() -> None:
    session = liner("COMEXC1", "COMEXR1", "INFNC1-E", "INFEN1", "PV5", "PA50", "D120000,160000", "GOL")
    session.advance(1.0)
    session.set_wire("input.1", closed=True)
    session.advance(1.0)
    assert not session.signal("axis1.moving")
    held = positions(session)
    assert held[0] < 60000
    session.set_wire("input.1", closed=False)
    session.advance(0.02)
    assert session.signal("axis1.moving") and session.signal("axis2.moving")
    assert math.dist(positions(session), held) < 100, "from where it stood"
    rows = track(session)
    assert positions(session) == (120000, 160000)
    assert all(off_line(here, (0, 0), (3, 4)) <= 1.0 for _, *here in rows)  # type: ignore[arg-type]


@pytest.mark.parametrize("meanwhile", ["!GO1", "!DRIVE10"])
def test_a_line_is_not_taken_up_from_elsewhere(meanwhile: str) -> None:
    session = liner("COMEXC1", "COMEXR1", "INFNC1-E", "INFEN1", "PV5", "PA50", "D120000,160000", "GOL")
    session.advance(1.0)
    session.set_wire("input.1", closed=True)
    session.advance(1.0)
    session.ok("!D100,100", meanwhile)
    session.advance(1.0)
    held = positions(session)
    session.set_wire("input.1", closed=False)
    session.advance(0.5)
    assert positions(session) == held


def test_reset_forgets_a_line_under_way() -> None:
    session = liner("COMEXC1", "PV5", "D120000,160000", "GOL")
    session.advance(0.5)
    session.unit.send(b"RESET\r")
    session.advance(0.5)
    session.read()
    session.ok("SMPER0,0", "DRIVE11", "D100,100", "GO", wait_s=1)


def test_gowhen_of_any_axis_holds_the_line() -> None:
    """GOWHEN holds the next GO or GOL: a line sets out when the conditions of all its axes have come true."""
    session = liner("COMEXC1", "PV5", "PA50", "D4000,3000", "GOWHEN(T=100),(T=300)", "GOL11")
    assert session.axis_bit(26, axis=1) and session.axis_bit(26, axis=2)
    session.advance(0.2)
    assert positions(session) == (0, 0), "the second axis still waits"
    session.advance(0.2)
    assert session.axis_bit(1, axis=1) and session.axis_bit(1, axis=2)
    track(session)
    assert positions(session) == (4000, 3000)


def test_a_stop_forgets_a_line_that_waits() -> None:
    session = liner("COMEXC1", "D4000,3000", "GOWHEN(T=100)", "GOL11", "!S")
    session.advance(1.0)
    assert positions(session) == (0, 0)
    assert not session.axis_bit(26, axis=1) and not session.axis_bit(26, axis=2)

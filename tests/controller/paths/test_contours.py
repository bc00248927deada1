"""Contours as a host sees them: lines and arcs compiled by PCOMP and travelled by PRUN."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.controller.session import OK, ONE_UPDATE_EACH_NS, SYSTEM_NS, TRAJECTORY_NS, S, Session, both_on

DEFINING = "\r\n- "
UNITS = ("SCALE1", "PSCLD4000", "PSCLV4000", "PSCLA4000")
Track = list[tuple[int, int, int]]


def contour(*commands: str, before: Sequence[str] = (), **options: str | int) -> Session:
    """A unit with both drives on, and the path P compiled from some commands."""
    session = both_on("SMPER0,0", *before, **options)
    define(session, *commands)
    session.ok("PCOMP P")
    return session


def define(session: Session, *commands: str, name: str = "P") -> None:
    session.ok(f"DEL {name}")
    for command in (f"DEF {name}", *commands):
        assert session.ask(command) == DEFINING, command
    session.ok("END")


def positions(session: Session) -> tuple[int, int]:
    engine = session.unit.controller.engine
    return engine.commanded_position(0), engine.commanded_position(1)


def velocities(session: Session) -> tuple[float, float]:
    return session.number("axis1.velocity.commanded"), session.number("axis2.velocity.commanded")


def update(session: Session) -> None:
    """On to the next trajectory update."""
    session.unit.controller.advance(session.unit.controller.engine.next_trajectory_ns)


def start(session: Session, command: str = "PRUN P") -> int:
    """Start with COMEXC1; the time at which the path begins."""
    session.ok("COMEXC1")
    begin_ns = session.unit.controller.engine.next_trajectory_ns
    session.ok(command)
    return begin_ns


def moving(session: Session) -> bool:
    return bool(session.signal("axis1.moving") or session.signal("axis2.moving"))


def trapezoid(t: float, length: float, velocity: float, up: float, down: float) -> float:
    """Length travelled after a time, by plain kinematics."""
    rise_s, fall_s = velocity / up, velocity / down
    level_s = (length - velocity * (rise_s + fall_s) / 2) / velocity
    if t < rise_s:
        return up * t * t / 2
    if t < rise_s + level_s:
        return velocity * (t - rise_s / 2)
    left_s = rise_s + level_s + fall_s - t
    return length - (down * left_s * left_s / 2 if left_s > 0 else 0.0)


# The guide's program (following-and-profiles 6.2), in units of 4000 counts.

R = 20_000.0


def joined(s: float) -> tuple[float, float]:
    """A quarter circle counter-clockwise to (5, 5), then three quarters clockwise to (10, 0)."""
    if s < R * math.pi / 2:
        return R * math.sin(s / R), R - R * math.cos(s / R)
    angle = math.pi - (s / R - math.pi / 2)
    return 2 * R + R * math.cos(angle), R + R * math.sin(angle)


def as_printed(s: float) -> tuple[float, float]:
    """Both clockwise: the path turns a corner between them."""
    if s < R * math.pi / 2:
        angle = math.pi - s / R
        return R + R * math.cos(angle), R * math.sin(angle)
    return joined(s)


@pytest.mark.parametrize(("first", "course"), [("PARCP5,5,5", joined), ("PARCM5,5,5", as_printed)])
def test_the_program_of_the_guide(first: str, course) -> None:  # type: ignore[no-untyped-def]
    session = contour("POUT1001", first, "POUT1100", "PARCM5,-5,-5", before=(*UNITS, "PV5", "PA50", "PAD25"))
    length, velocity = 2 * math.pi * R, 5 * 4000.0
    begin_ns = start(session)
    while moving(session):
        update(session)
        s = trapezoid((session.now_ns - begin_ns) / S, length, velocity, 200_000.0, 100_000.0)
        x, y = course(s)
        assert abs(positions(session)[0] - x) <= 1.0 and abs(positions(session)[1] - y) <= 1.0
    assert positions(session) == (40_000, 0)
    seconds = length / velocity + velocity / 400_000.0 + velocity / 200_000.0
    assert 0 <= session.now_ns - begin_ns - round(seconds * S) <= TRAJECTORY_NS


def test_its_outputs_change_in_the_window_of_the_guide() -> None:
    """3/4 of an update before to 1/4 after the start of a segment; outputs 1 to 4 are cleared afterwards."""
    session = contour("POUT1001", "PARCP5,5,5", "POUT1100", "PARCM5,-5,-5", before=(*UNITS, "PV5", "PA50"))
    begin_ns = start(session)
    bits, seen = session.unit.controller.output_functions.bits, {}
    while moving(session):
        session.unit.controller.advance(session.now_ns + 10_000)
        seen.setdefault(bits()[:4], session.now_ns)
    second_ns = begin_ns + round((R * math.pi / 2 / 20_000.0 + 0.05) * S)
    assert list(seen) == ["1001", "1100"]
    assert seen["1001"] <= begin_ns
    assert -0.75 * SYSTEM_NS < seen["1100"] - second_ns <= 0.25 * SYSTEM_NS + 10_000
    session.ok("OUT0000")
    assert bits()[:4] == "0000"


def test_the_prompt_waits_for_the_end() -> None:
    session = contour("PLIN3,4", before=(*UNITS, "PV5", "PA50"))
    prompts = session.timed("PRUN P", wait_s=2)
    assert [text for _, text in prompts] == [OK]
    assert 0 < prompts[0].at_ns - round(1.1 * S) <= ONE_UPDATE_EACH_NS
    assert positions(session) == (12_000, 16_000)


def run(session: Session, command: str = "PRUN P") -> Track:
    """Time and positions at every trajectory update of a path, the last one at rest."""
    start(session, command)
    rows = []
    while moving(session):
        update(session)
        rows.append((session.now_ns, *positions(session)))
    return rows


# Coordinates.


@pytest.mark.parametrize(
    ("commands", "end"),
    [
        (("PLIN100,200", "PLIN-50,10"), (50, 210)),
        (("PAB0", "PLIN100,200", "PLIN,10"), (100, 210)),
        (("PAB1", "PLIN100,200", "PLIN-50,10"), (-50, 10)),
        (("PAB1", "PLIN100,200", "PLIN50"), (50, 200)),
        (("PAB1", "PWC1000,2000", "PLIN1100,2200", "PLIN0,0"), (-1000, -2000)),
        (("PAB1", "PLIN100,200", "PWC0,0", "PLIN50,50"), (150, 250)),
        (("PAB1", "PLIN100,200", "PLC0,0", "PLIN50,50"), (50, 50)),
        (("PAB1", "PLIN100,200", "PLC0,0", "PL1", "PLIN50,50"), (150, 250)),
        (("PAB1", "PLIN100,200", "PLC0,0", "PL1", "PLIN50,50", "PL0", "PLIN7,8"), (7, 8)),
        (("PAB1", "PLC10,10", "PL1", "PLIN50,50", "PAB0", "PLIN1,1"), (41, 41)),
        (("PLIN100,100", "PLIN0,0", "PLIN,"), None),
        (("PAB1", "PARCP100,0,-50", "PARCOM200,0,50,0"), (200, 0)),
    ],
)
def test_where_a_path_ends(commands: tuple[str, ...], end: tuple[int, int] | None) -> None:
    if end is None:
        session = both_on("SMPER0,0")
        define(session, *commands)
        assert session.error("PCOMP P") == "INCORRECT DATA"
        return
    session = contour(*commands)
    run(session)
    assert positions(session) == end


def test_a_path_begins_where_the_axes_stand_and_can_be_run_again() -> None:
    session = contour("PAB1", "PLIN1000,0", "PLIN1000,500")
    session.ok("D300,-40", "GO", wait_s=1)
    for run_number in (1, 2, 3):
        run(session)
        assert positions(session) == (300 + 1000 * run_number, -40 + 500 * run_number)


def test_paxes_exchanged() -> None:
    session = contour("PAXES2,1", "PARCP4000,4000,4000", before=("PV1",))
    start(session)
    session.advance(0.1)
    x, y = velocities(session)[1], velocities(session)[0]
    assert x > 5 * abs(y)
    run_out(session)
    assert positions(session) == (4000, 4000)


def run_out(session: Session) -> None:
    while moving(session):
        update(session)


def test_scaled_distances_are_truncated() -> None:
    """PSCLD25: one decimal, whole counts: 1.1 of 25 are 27.5 counts."""
    session = contour("PLIN1.19,0", "PLIN-3.1,1.1", before=("SCALE1", "PSCLD25"))
    run(session)
    assert positions(session) == (27 - 77, 27)


def test_variables() -> None:
    session = contour("PLIN(VAR1),(VAR2)", "PV(VAR3)", "PLIN1,1", before=("VAR1=100", "VAR2=-7", "VAR3=2"))
    session.ok("VAR1=5")
    run(session)
    assert positions(session) == (101, -6)


# Speed.


def test_each_segment_runs_at_its_own_velocity() -> None:
    session = contour("PV1", "PLIN8000,0", "PV2", "PLIN8000,0", "PV0.5", "PLIN0,4000", before=("PA10", "PAD20", "PV9"))
    assert session.query("PV") == "PV9.0000", "the unit's own settings stay"
    begin_ns = start(session)
    speeds = {}
    while moving(session):
        update(session)
        speeds[(session.now_ns - begin_ns) / S] = (velocities(session), positions(session))
    for (x, y), here in speeds.values():
        limit = 4000 if here[0] < 8000 else 8000 if here[0] < 16_000 else 2000
        assert math.hypot(x, y) <= limit * 1.0001
    levels = {round(math.hypot(*velocity)) for velocity, _ in speeds.values()}
    assert {4000, 8000, 2000} <= levels
    assert positions(session) == (16_000, 4000)
    # 0.1 s up and 1.95 s level; 0.1 s up, 0.075 s down and 0.8 s level between; 0.025 s down and 1.9875 s level
    rise = 0.1 * 6000 + 0.075 * 5000
    seconds = (0.1 + 1.95) + (0.1 + 0.075 + (8000 - rise) / 8000) + (1.9875 + 0.025)
    assert 0 <= session.now_ns - begin_ns - round(seconds * S) <= TRAJECTORY_NS


def test_values_are_those_of_pcomp() -> None:
    session = contour("PLIN4000,0", before=("PV2", "PA100"))
    session.ok("PV0.1", "PA1")
    begin_ns = start(session)
    run_out(session)
    assert 0 <= session.now_ns - begin_ns - round(0.52 * S) <= TRAJECTORY_NS


def test_s_curves_have_no_effect_on_contours() -> None:
    session = contour("PAA5", "PLIN3,4", before=(*UNITS, "PV5", "PA50", "PAA30", "PADA40"))
    begin_ns = start(session)
    run_out(session)
    assert 0 <= session.now_ns - begin_ns - round(1.1 * S) <= TRAJECTORY_NS


def test_one_axis_line_in_a_path() -> None:
    session = contour("PLIN0,4000")
    session.ok("COMEXC1", "PRUN P")
    assert session.axis_bit(1, axis=1) and session.axis_bit(1, axis=2)
    run_out(session)
    assert positions(session) == (0, 4000)


# Any path.

coordinates = st.integers(-40_000, 40_000)
rates = st.fixed_dictionaries({"PV": st.integers(1, 20), "PA": st.integers(5, 100), "PAD": st.integers(5, 100)})
ends = st.tuples(coordinates, coordinates).filter(lambda end: math.hypot(*end) > 500)
lines = st.builds(lambda end: f"PLIN{end[0]},{end[1]}", ends)


def by_radius(end: tuple[int, int], ratio: float, name: str, more: bool) -> str:
    radius = math.ceil(ratio * math.hypot(*end))
    return f"{name}{end[0]},{end[1]},{-radius if more else radius}"


arcs = st.builds(by_radius, ends, st.floats(0.51, 3.0), st.sampled_from(["PARCM", "PARCP"]), st.booleans())
circles = st.builds(
    lambda centre, name: f"{name}0,0,{centre[0]},{centre[1]}", ends, st.sampled_from(["PARCOM", "PARCOP"])
)
segments = st.tuples(rates, st.one_of(lines, arcs, circles))


def spread(path: Sequence[tuple[dict[str, int], str]]) -> list[str]:
    return [text for rate, segment in path for text in (*(f"{name}{value}" for name, value in rate.items()), segment)]


def length_of(segment: str) -> float:
    """By school geometry: no line of the emulator's."""
    name = segment.rstrip("-0123456789,")
    x, y, *more = (float(field) for field in segment.removeprefix(name).split(","))
    if name == "PLIN":
        return math.hypot(x, y)
    if name.startswith("PARCO"):
        return 2 * math.pi * math.hypot(*more)
    half = math.asin(math.hypot(x, y) / 2 / abs(more[0]))
    return 2 * abs(more[0]) * (half if more[0] > 0 else math.pi - half)


@given(st.lists(segments, min_size=1, max_size=4))
@settings(max_examples=25, deadline=None)
def test_any_path_has_its_length_and_ends_where_it_should(path: list[tuple[dict[str, int], str]]) -> None:
    session = contour(*spread(path))
    start(session)
    last, travelled, end = positions(session), 0.0, [0, 0]
    period_s = TRAJECTORY_NS / S
    while moving(session):
        update(session)
        here = positions(session)
        fastest = 4000.0 * max(rate["PV"] for rate, _ in path)
        assert math.dist(here, last) <= fastest * period_s + 2.0
        travelled += math.hypot(*velocities(session)) * period_s
        last = here
    for _, segment in path:
        fields = segment.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ").split(",")
        end = [end[0] + int(fields[0]), end[1] + int(fields[1])]
    assert positions(session) == tuple(end)
    length = sum(length_of(segment) for _, segment in path)
    assert travelled == pytest.approx(length, rel=0.01, abs=2 * fastest * period_s)


@given(st.one_of(arcs, circles), st.integers(1, 20))
@settings(max_examples=20, deadline=None)
def test_radius_and_speed_are_constant_on_an_arc(segment: str, pv: int) -> None:
    session = contour(segment, before=(f"PV{pv}", "PA200"))
    course = session.unit.controller.compiled.motion("P")
    arc = course.pieces[0]  # type: ignore[union-attr]
    start(session)
    level = []
    while moving(session):
        update(session)
        assert abs(math.dist(positions(session), arc.centre) - arc.radius) <= 1.0
        speed = math.hypot(*velocities(session))
        assert speed <= pv * 4000.0 * (1 + 1e-9)
        level.append(speed)
    if length_of(segment) > 1.1 * pv * pv * 4000 / 200:
        assert max(level) == pytest.approx(pv * 4000.0)


@given(st.integers(1000, 30_000), st.sampled_from([1, -1]), st.integers(1, 10))
@settings(max_examples=15, deadline=None)
def test_tangential_joins_have_no_step_in_velocity(radius: int, side: int, pv: int) -> None:
    """A straight, a quarter circle either way and a straight: velocity turns and never jumps."""
    arc = "PARCP" if side > 0 else "PARCM"
    session = contour(
        "PLIN9000,0", f"{arc}{radius},{side * radius},{radius}", f"PLIN0,{side * 9000}", before=(f"PV{pv}", "PA20")
    )
    start(session)
    last = (0.0, 0.0)
    most = (20 * 4000.0 + (pv * 4000.0) ** 2 / radius) * TRAJECTORY_NS / S
    while moving(session):
        update(session)
        here = velocities(session)
        assert math.dist(here, last) <= most * 1.01
        last = here
    assert positions(session) == (9000 + radius, side * (9000 + radius))


# What stops it.

RING = ("PARCOP0,0,-40000,0", "PARCOP0,0,-40000,0")


def off_ring(session: Session) -> float:
    x, y = positions(session)
    return abs(math.hypot(x + 40_000, y) - 40_000)


@pytest.mark.parametrize(
    ("command", "seconds"), [("!S", 0.2), ("!S10", 0.2), ("!2S", 0.2), ("!K", 0.1), ("!1K", 0.1), ("!K01", 0.1)]
)
def test_stops_and_kills_stay_on_the_path(command: str, seconds: float) -> None:
    session = contour(*RING, before=("PV5", "PA50", "PAD25", "LHAD50,80"))
    start(session)
    session.advance(3.0)
    session.ok(command)
    rows = 0
    while moving(session):
        update(session)
        rows += 1
        assert off_ring(session) <= 1.0
    assert rows * TRAJECTORY_NS / S == pytest.approx(seconds, abs=0.003)
    session.ok("PRUN P")
    session.advance(0.2)
    assert moving(session)


def test_a_stop_across_a_corner() -> None:
    """The brake goes on along the next segments, and outputs of those it reaches change, later than planned."""
    session = contour(
        *("PLIN8000,0", "POUT1", "PLIN0,2000", "POUTX1", "PLIN2000,0", "PLIN80000,0"),
        before=("PV4", "PA100", "PAD20"),
    )
    start(session)
    while positions(session)[0] < 7500:
        update(session)
    session.ok("!S")
    while moving(session):
        update(session)
        x, y = positions(session)
        assert (y == 0 and x <= 8000) or (x == 8000 and y < 2000)
    # 16000 counts/s at 80000 counts/s2: 1600 counts
    x, y = positions(session)
    assert x == 8000 and y == pytest.approx(1600 - 500, abs=40)
    assert session.unit.controller.output_functions.bits()[:2] == "10"
    assert session.error("PRUN Q") == "UNDEFINED LABEL"
    session.ok("PRUN P")


def test_a_limit_stops_the_path() -> None:
    session = contour(*RING, before=("COMEXL11", "PV5", "PA50", "LHAD100,100"))
    start(session)
    session.advance(1.0)
    session.set_wire("axis2.positive_limit", closed=False)
    while moving(session):
        update(session)
        assert off_ring(session) <= 1.0
    assert session.axis_bit(15, axis=2)
    session.ok("PRUN P")
    session.advance(0.3)
    assert not moving(session), "it sets out in the positive direction of axis 2"
    session.set_wire("axis2.positive_limit", closed=True)
    session.ok("PRUN P")
    session.advance(0.3)
    assert moving(session)


def test_a_drive_that_drops_out() -> None:
    session = contour(*RING, before=("PV5", "PA50", "KDRIVE10", "LHAD50,50"))
    start(session)
    session.advance(1.0)
    session.ok("!1K")
    assert not session.signal("axis1.moving") and session.signal("axis2.moving")
    assert session.error("PRUN P") in ("AXES NOT READY", "PATH ALREADY MOVING")
    run_out(session)
    assert session.error("PRUN P") == "AXES NOT READY"
    session.ok("DRIVE11", "PRUN P")


def test_a_pause_takes_the_path_up_again() -> None:
    session = contour(
        "PLIN8000,0", "POUT1", "PARCP8000,8000,8000", "POUT01", "PLIN0,8000", before=("PV2", "PA50", "PAD50")
    )
    session.ok("COMEXR1", "INFNC1-E", "INFEN1")
    start(session)
    session.advance(1.3)
    assert session.unit.controller.output_functions.bits()[:2] == "10"
    session.set_wire("input.1", closed=True)
    session.advance(1.0)
    assert not moving(session)
    session.ok("!OUT0")
    held = positions(session)
    session.set_wire("input.1", closed=False)
    session.advance(0.01)
    assert math.dist(positions(session), held) < 50, "from where it stood"
    while moving(session):
        update(session)
        x, y = positions(session)
        if x > 8000 and y < 8000:
            assert abs(math.dist((x, y), (8000, 8000)) - 8000) <= 1.0
    assert positions(session) == (16_000, 16_000)
    assert session.unit.controller.output_functions.bits()[:2] == "01", "the first one is not switched again"


@pytest.mark.parametrize("ends", ["path", "kill", "meanwhile"])
def test_a_paused_path_is_under_way(ends: str) -> None:
    """It keeps its segments in the pause and after it, until it is over or cannot be taken up again."""
    session = contour(*RING, before=("PV2", "PA50", "PAD50"))
    session.ok("COMEXR1", "INFNC1-E", "INFEN1")
    start(session)
    session.advance(1.0)
    session.set_wire("input.1", closed=True)
    session.advance(1.0)
    assert not moving(session)
    refused = {"!PUCOMP P": "INVALID CONDITIONS FOR COMMAND", "!PRUN P": "PATH ALREADY MOVING"}
    for command, text in refused.items():
        assert session.error(command) == text
    if ends == "meanwhile":
        session.ok("!D100,100", "!GO1")
    elif ends == "kill":
        session.ok("!K")
    session.set_wire("input.1", closed=False)
    session.advance(0.5)
    if ends == "path":
        assert moving(session)
        for command, text in refused.items():
            assert session.error(command) == text
        run_out(session)
    session.advance(0.5)
    session.ok("PRUN P", "!K", wait_s=0.5)
    session.ok("PUCOMP P")


# What is refused: the text, SS bit 31 where it is PCOMP, no motion, and everything works after it.


@pytest.mark.parametrize(
    ("commands", "text"),
    [
        (("PARCM5,5,0",), "PATH RADIUS ZERO"),
        (("PARCOP5,5,0,0",), "PATH RADIUS ZERO"),
        (("PARCP1000,0,400",), "PATH RADIUS TOO SMALL"),
        (("PARCP1000,0,-400",), "PATH RADIUS TOO SMALL"),
        (("PARCOM1000,0,400,0",), "EXCESSIVE PATH RADIUS DIFFERENCE"),
        (("PRTOL0", "PARCOM1001,0,500,0"), "EXCESSIVE PATH RADIUS DIFFERENCE"),
        (("PARCM0,0,50",), "INVALID DATA"),
        (("PV0", "PLIN1,1"), "PATH VELOCITY ZERO"),
        (("PLIN0,0",), "NO PATH SEGMENTS DEFINED"),
        (("PAXES1,2",), "NO PATH SEGMENTS DEFINED"),
        ((), "NO PATH SEGMENTS DEFINED"),
        (("PLIN1,1", "GO"), "NOT ALLOWED IN PATH"),
        (("T1", "PLIN1,1"), "NOT ALLOWED IN PATH"),
        (("PLIN1,1", "A10"), "NOT ALLOWED IN PATH"),
        (("PLIN1,1", "OUT1"), "NOT ALLOWED IN PATH"),
        (("PLIN1,1", "PV"), "NOT ALLOWED IN PATH"),
        (("PLIN1,2,3",), "INCORRECT DATA"),
        (("PLIN",), "INCORRECT DATA"),
        (("PARCM1,2",), "INCORRECT DATA"),
        (("PAXES1", "PLIN1,1"), "INCORRECT DATA"),
        (("PAXES1,1", "PLIN1,1"), "INVALID DATA-FIELD 2"),
        (("PAXES1,3", "PLIN1,1"), "INVALID DATA-FIELD 2"),
        (("PAXES0,1", "PLIN1,1"), "INVALID DATA-FIELD 1"),
        (("PLIN1,1", "PAXES1,2"), "INVALID CONDITIONS FOR COMMAND"),
        (("PAB2", "PLIN1,1"), "INVALID DATA"),
        (("PL-1", "PLIN1,1"), "INVALID DATA"),
        (("PWC1", "PLIN1,1"), "INCORRECT DATA"),
        (("PRTOL-1", "PLIN1,1"), "INVALID DATA"),
        (("PLIN1000000000,1",), "INVALID DATA-FIELD 1"),
        (("PLIN(VAR1),(VAR999)",), "INVALID DATA"),
        (("POUT", "PLIN1,1"), "INCORRECT DATA"),
        (("POUT.99-1", "PLIN1,1"), "INVALID DATA"),
    ],
)
def test_paths_that_cannot_be_compiled(commands: tuple[str, ...], text: str) -> None:
    session = both_on()
    define(session, *commands)
    assert session.error("PCOMP P") == text
    assert session.system_bit(31)
    assert session.error("PRUN P") == "PATH NOT COMPILED"
    session.advance(0.1)
    assert positions(session) == (0, 0)
    define(session, "PLIN100,100")
    session.ok("PCOMP P", "PRUN P", wait_s=1)
    assert not session.system_bit(31)
    assert positions(session) == (100, 100)


def test_an_output_with_a_function() -> None:
    session = both_on("OUTFNC2-B")
    define(session, "POUT11", "PLIN1,1")
    assert session.error("PCOMP P") == "OUTPUT BIT USED AS OUTFNC"


@pytest.mark.parametrize(
    "command",
    [
        *("PLIN1,1", "PARCM5,5,5", "PARCP5,5,5", "PARCOM5,5,5,5", "PARCOP5,5,5,5", "PAXES1,2", "PAB1", "PL1"),
        *("PLC1,1", "PWC1,1", "PRTOL1", "POUT1001", "PLIN", "PAB", "!PAB1"),
    ],
)
def test_path_commands_outside_a_definition(command: str) -> None:
    session = both_on()
    assert session.error(command) == "NOT DEFINING A PATH"
    assert positions(session) == (0, 0)


def test_a_path_that_is_run_and_not_prun() -> None:
    session = contour("PLIN100,100")
    answer = session.ask("RUN P", wait_s=0.1)
    assert "*NOT DEFINING A PATH\r" in answer
    assert positions(session) == (0, 0)


def test_paths_need_two_axes() -> None:
    session = both_on(INDAX=2)
    session.ok("INDAX1")
    define(session, "PLIN100,100")
    assert session.error("PCOMP P") == "INCORRECT AXIS"


@pytest.mark.parametrize(
    ("commands", "text"),
    [
        (("DRIVE10",), "AXES NOT READY"),
        (("COMEXC1", "MC1", "GO1"), "AXES NOT READY"),
        (("FOLMAS,+14", "FOLEN01"), "AXES NOT READY"),
        (("DRIVE00", "SFB,0", "DRIVE11"), "NOT ALLOWED IF SFB0"),
    ],
)
def test_axes_that_are_not_ready(commands: tuple[str, ...], text: str) -> None:
    session = contour("PLIN100,100")
    session.ok(*commands)
    assert session.error("PRUN P") == text
    session.ok("!K")


def test_a_path_under_way() -> None:
    session = contour("PLIN80000,0")
    define(session, "PLIN1,1", name="Q")
    session.ok("PCOMP Q")
    start(session)
    assert session.error("PRUN P") == "PATH ALREADY MOVING"
    assert session.error("PRUN Q") == "AXES NOT READY"
    assert session.error("!GO1") == "MOTION IN PROGRESS"
    assert session.error("GOL") == "MOTION IN PROGRESS"
    assert session.error("PUCOMP P") == "INVALID CONDITIONS FOR COMMAND"
    assert session.error("PCOMP Q") == "MOTION IN PROGRESS"


def test_pucomp_frees_the_segments() -> None:
    session = both_on()
    before = int(session.query("TSEG").removeprefix("TSEG"))
    define(session, "POUT1", "PLIN100,100", "PV2", "PARCP5,5,5", "PLIN1,1")
    session.ok("PCOMP P")
    assert int(session.query("TSEG").removeprefix("TSEG")) == before - 3
    session.ok("PUCOMP P")
    assert int(session.query("TSEG").removeprefix("TSEG")) == before
    assert session.error("PRUN P") == "PATH NOT COMPILED"


def test_the_tolerance_of_the_machine_file() -> None:
    for tolerance, text in ((0, "EXCESSIVE PATH RADIUS DIFFERENCE"), (5, None)):
        session = Session(f"[paths]\nradius_tolerance = {tolerance}\n")
        define(session, "PARCOM1003,0,500,0")
        if text is None:
            session.ok("PCOMP P")
        else:
            assert session.error("PCOMP P") == text

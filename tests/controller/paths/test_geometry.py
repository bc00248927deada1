"""Lines and arcs as geometry knows them, and what the axes do along them."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from emulator.controller.paths.geometry import CLOCKWISE, COUNTER_CLOCKWISE, Line, Piece, arc_by_centre, arc_by_radius
from emulator.engine import Segment
from emulator.engine.profile import segment_state
from protocol.errors import CommandError

coordinates = st.integers(-1_000_000, 1_000_000)
points = st.tuples(coordinates, coordinates)
turns = st.sampled_from([CLOCKWISE, COUNTER_CLOCKWISE])

QUARTER = math.pi / 2


def at(piece: Piece, length: float) -> tuple[float, float]:
    return piece.coordinate(0, length), piece.coordinate(1, length)


def heading(piece: Piece, length: float) -> tuple[float, float]:
    return piece.heading(0, length), piece.heading(1, length)


@pytest.mark.parametrize(
    ("turn", "radius", "centre", "sweep", "leaves", "arrives"),
    [
        # a quarter circle from (0, 0) to (5, 5); then three quarters of one
        (COUNTER_CLOCKWISE, 5.0, (0, 5), QUARTER, (1, 0), (0, 1)),
        (CLOCKWISE, 5.0, (5, 0), QUARTER, (0, 1), (1, 0)),
        (COUNTER_CLOCKWISE, -5.0, (5, 0), 3 * QUARTER, (0, -1), (-1, 0)),
        (CLOCKWISE, -5.0, (0, 5), 3 * QUARTER, (-1, 0), (0, -1)),
    ],
)
def test_the_four_arcs_through_two_points(
    turn: int,
    radius: float,
    centre: tuple[int, int],
    sweep: float,
    leaves: tuple[int, int],
    arrives: tuple[int, int],
) -> None:
    arc = arc_by_radius((0, 0), (5, 5), radius, turn, 0.0)
    assert arc.centre == pytest.approx(centre, abs=1e-12)
    assert arc.sweep == pytest.approx(sweep)
    assert arc.length == pytest.approx(5 * sweep)
    assert heading(arc, 0.0) == pytest.approx(leaves, abs=1e-12)
    assert heading(arc, arc.length) == pytest.approx(arrives, abs=1e-12)


def test_the_two_arcs_of_the_guide_join_smoothly_only_counter_clockwise_then_clockwise() -> None:
    first = arc_by_radius((0, 0), (5, 5), 5.0, COUNTER_CLOCKWISE, 0.0)
    second = arc_by_radius((5, 5), (10, 0), -5.0, CLOCKWISE, 0.0)
    assert heading(first, first.length) == pytest.approx(heading(second, 0.0), abs=1e-12)
    assert second.sweep == pytest.approx(3 * QUARTER)
    as_printed = arc_by_radius((0, 0), (5, 5), 5.0, CLOCKWISE, 0.0)
    assert heading(as_printed, as_printed.length) != pytest.approx(heading(second, 0.0), abs=0.5)


@given(points, points, st.floats(0.5, 50.0), turns, st.booleans())
def test_arcs_by_radius(start: tuple[int, int], end: tuple[int, int], ratio: float, turn: int, more: bool) -> None:
    assume(start != end)
    radius = ratio * math.dist(start, end)
    arc = arc_by_radius(start, end, -radius if more else radius, turn, 0.0)
    assert arc.radius == pytest.approx(radius, rel=1e-6)
    assert (arc.sweep > math.pi) == more or arc.sweep == pytest.approx(math.pi, abs=1e-6)
    assert at(arc, 0.0) == pytest.approx(start, abs=1e-3)
    assert at(arc, arc.length) == pytest.approx(end, abs=1e-3)
    for share in (0.1, 0.5, 0.9):
        assert math.dist(at(arc, share * arc.length), arc.centre) == pytest.approx(arc.radius)
        ahead = at(arc, share * arc.length + 1e-3 * arc.length)
        middle = at(arc, share * arc.length)
        outwards = (middle[0] - arc.centre[0], middle[1] - arc.centre[1])
        onwards = (ahead[0] - middle[0], ahead[1] - middle[1])
        assert (outwards[0] * onwards[1] - outwards[1] * onwards[0]) * turn > 0


@given(points, st.tuples(coordinates, coordinates), st.floats(0.01, 2 * math.pi - 0.01), turns)
def test_arcs_by_centre(start: tuple[int, int], offset: tuple[int, int], sweep: float, turn: int) -> None:
    radius = math.hypot(*offset)
    assume(radius > 1000)
    centre = (start[0] + offset[0], start[1] + offset[1])
    angle = math.atan2(-offset[1], -offset[0]) + turn * sweep
    end = (round(centre[0] + radius * math.cos(angle)), round(centre[1] + radius * math.sin(angle)))
    assume(math.dist(start, end) > 2.0)
    arc = arc_by_centre(start, end, offset, turn, 2.0)
    assert arc.sweep == pytest.approx(sweep, abs=4.0 / math.dist(start, end) + 4.0 / radius)
    assert math.dist(start, arc.centre) == pytest.approx(math.dist(end, arc.centre), abs=1e-6)
    assert math.dist(arc.centre, centre) <= 2.0 * radius / math.dist(start, end) + 1.0
    assert at(arc, arc.length) == pytest.approx(end, abs=1e-3)


@pytest.mark.parametrize("turn", [CLOCKWISE, COUNTER_CLOCKWISE])
def test_a_full_circle(turn: int) -> None:
    arc = arc_by_centre((100, 0), (100, 0), (-100.0, 0.0), turn, 2.0)
    assert arc.sweep == 2 * math.pi
    assert at(arc, arc.length / 4) == pytest.approx((0, turn * 100), abs=1e-9)


def test_the_shares_of_four_axes() -> None:
    """The four-axis row of following-and-profiles 6.1; a path is not limited to two axes by its arithmetic."""
    line = Line((0, 0, 0, 0), (10, 5, 2, 11))
    assert line.length == pytest.approx(15.811388, abs=1e-6)
    speeds = [line.share(Segment(1.0, 0.0, 5.0, 0.0, 0.0), axis).velocity for axis in range(4)]
    assert speeds == pytest.approx([3.162278, 1.581139, 0.632456, 3.478505], abs=1e-6)


def test_radii_that_are_refused() -> None:
    for radius, text in ((0.0, "PATH RADIUS ZERO"), (49.0, "PATH RADIUS TOO SMALL"), (-49.0, "PATH RADIUS TOO SMALL")):
        with pytest.raises(CommandError, match=rf"^{text}$"):
            arc_by_radius((0, 0), (100, 0), radius, CLOCKWISE, 0.5)
    with pytest.raises(CommandError, match=r"^INVALID DATA$"):
        arc_by_radius((7, 7), (7, 7), 5.0, CLOCKWISE, 2.0)
    with pytest.raises(CommandError, match=r"^PATH RADIUS ZERO$"):
        arc_by_centre((7, 7), (9, 7), (0.0, 0.0), CLOCKWISE, 5.0)
    with pytest.raises(CommandError, match=r"^EXCESSIVE PATH RADIUS DIFFERENCE$"):
        arc_by_centre((0, 0), (100, 0), (47.0, 0.0), CLOCKWISE, 5.0)


def test_a_radius_a_little_too_small_makes_half_a_circle() -> None:
    arc = arc_by_radius((0, 0), (100, 0), 49.6, COUNTER_CLOCKWISE, 0.5)
    assert (arc.radius, arc.sweep) == (50.0, math.pi)


def test_radii_that_differ_a_little_move_the_centre() -> None:
    arc = arc_by_centre((0, 0), (100, 0), (48.0, 30.0), COUNTER_CLOCKWISE, 5.0)
    assert arc.centre == (50.0, 30.0)


pieces = st.one_of(
    st.builds(Line, points, points),
    st.builds(
        lambda start, end, ratio, turn: arc_by_radius(start, end, ratio * math.dist(start, end), turn, 1.0),
        *(points, points.map(lambda point: (point[0] + 2_000_001, point[1])), st.floats(0.6, 9.0), turns),
    ),
)


@given(pieces, st.floats(0.0, 1.0), st.floats(1.0, 1e6), st.floats(-1e6, 1e6))
def test_a_share_is_the_projection_of_the_path(piece: Piece, share: float, speed: float, rate: float) -> None:
    """Position from geometry, velocity along the tangent, acceleration along it and towards the centre."""
    along = Segment(1.0, share * piece.length, speed, rate, 0.0)
    states = [segment_state(piece.share(along, axis), 0.0) for axis in range(2)]
    assert [state.position for state in states] == pytest.approx(at(piece, along.position), abs=1e-6)
    if piece.length:
        tangent = heading(piece, along.position)
        assert [state.velocity for state in states] == pytest.approx([speed * each for each in tangent], abs=1e-6)
        assert states[0].acceleration * tangent[0] + states[1].acceleration * tangent[1] == pytest.approx(
            rate, abs=1e-3
        )


@given(pieces, points, st.floats(0.0, 1.0))
def test_moving_a_piece(piece: Piece, by: tuple[int, int], share: float) -> None:
    moved = piece.moved(by)
    length = share * piece.length
    assert moved.length == pytest.approx(piece.length)
    expected = [coordinate + step for coordinate, step in zip(at(piece, length), by, strict=True)]
    assert at(moved, length) == pytest.approx(expected, abs=1e-6)
    assert [moved.start[axis] - piece.start[axis] for axis in range(2)] == list(by)

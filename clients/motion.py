"""Motion as procedures: moves, jogging, homing, stopping, and when a move is over.

Everything is sent with `!`, so that it acts at once and is answered at once, whether the unit executes commands
continuously (COMEXC1) or holds its buffer behind a move (COMEXC0, the power-up setting).

A move is over by the rule of the EPICS driver for this family: AS bit 1 (moving) off, bit 24 (in target zone) on, bit
25 (target zone time-out) off. Bit 24 is live: it counts whether or not STRGTE is on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal

from clients.effects import Pause, Procedure
from clients.errors import MotionError, NoAnswer
from clients.plan import Answer
from clients.session import Session
from clients.status import AxisFlags
from clients.typed.words import AxisWord
from clients.values import Number, ask, mask, number_text, write

POLL_S = 0.02
MOVE_TIMEOUT_S = 60.0

FAILURES = (
    AxisFlags.DRIVE_SHUTDOWN
    | AxisFlags.DRIVE_FAULTED
    | AxisFlags.POSITIVE_HARD_LIMIT_HIT
    | AxisFlags.NEGATIVE_HARD_LIMIT_HIT
    | AxisFlags.POSITIVE_SOFT_LIMIT_HIT
    | AxisFlags.NEGATIVE_SOFT_LIMIT_HIT
    | AxisFlags.POSITION_ERROR_EXCEEDED
    | AxisFlags.TARGET_ZONE_TIMEOUT
)
"""What says that an axis at rest is not where a move should have brought it; cleared by the next legal GO or DRIVE1."""


def axis_status(session: Session, axis: int) -> Procedure[AxisWord]:
    """AS of an axis."""
    answer = yield from ask(session, "TAS", axis)
    return AxisWord(answer.parsed().bits, AxisFlags)


def set_profile(
    session: Session,
    axis: int,
    *,
    velocity: Number | None = None,
    acceleration: Number | None = None,
    deceleration: Number | None = None,
) -> Procedure[None]:
    """V, A and AD, those that are given."""
    for name, value in (("V", velocity), ("A", acceleration), ("AD", deceleration)):
        if value is not None:
            yield from write(session, name, axis, value)


def begin_moves(session: Session, targets: Mapping[int, Number], *, absolute: bool) -> Procedure[None]:
    """Preset moves of one or more axes, started together; sets MC0, MA and D of these axes.

    Raises:
        UnitError: refused, DRIVE SHUTDOWN for example.
    """
    for axis, target in targets.items():
        yield from write(session, "MC", axis, "0")
        yield from write(session, "MA", axis, "1" if absolute else "0")
        yield from write(session, "D", axis, target)
    yield from start(session, list(targets))


def begin_move(
    session: Session,
    axis: int,
    target: Number,
    *,
    absolute: bool,
    velocity: Number | None = None,
    acceleration: Number | None = None,
    deceleration: Number | None = None,
) -> Procedure[None]:
    """The same for one axis, with what is given of its profile."""
    yield from set_profile(session, axis, velocity=velocity, acceleration=acceleration, deceleration=deceleration)
    yield from begin_moves(session, {axis: target}, absolute=absolute)


def start(session: Session, axes: Sequence[int]) -> Procedure[Answer]:
    """GO for these axes."""
    line = f"{axes[0]}GO" if len(axes) == 1 else f"GO{mask(axes)}"
    answer = yield from session.immediate(line)
    return answer


def jog(
    session: Session,
    axis: int,
    velocity: Number,
    *,
    acceleration: Number | None = None,
    deceleration: Number | None = None,
) -> Procedure[None]:
    """Run on at a velocity, signed, until stopped; sets MC1, V and the direction of D."""
    text = number_text(velocity)
    speed = Decimal(text).copy_abs()
    yield from set_profile(session, axis, velocity=speed, acceleration=acceleration, deceleration=deceleration)
    yield from write(session, "MC", axis, "1")
    yield from write(session, "D", axis, "-" if text.startswith("-") else "+")
    yield from start(session, [axis])


def stop(session: Session, axes: Sequence[int] | None) -> Procedure[None]:
    """S: decelerate and stop; None is everything, and ends the program (COMEXS0)."""
    yield from session.immediate("S" if axes is None else f"S{mask(axes)}")


def kill(session: Session, axes: Sequence[int] | None) -> Procedure[None]:
    """K: stop at once, at LHAD; None is everything, and ends the program."""
    yield from session.immediate("K" if axes is None else f"K{mask(axes)}")


def wait_until_stopped(session: Session, axis: int, *, timeout_s: float, poll_s: float = POLL_S) -> Procedure[AxisWord]:
    """Until bit 1 is off.

    Raises:
        NoAnswer: still moving after `timeout_s`.
    """
    status = yield from _wait(session, axis, AxisFlags(0), AxisFlags.MOVING, timeout_s, poll_s)
    return status


def wait_until_settled(session: Session, axis: int, *, timeout_s: float, poll_s: float = POLL_S) -> Procedure[AxisWord]:
    """Until the move is over and the axis in its target zone.

    Raises:
        MotionError: it came to rest elsewhere: limit, fault, target zone time-out.
        NoAnswer: still under way after `timeout_s`.
    """
    wanted, unwanted = AxisFlags.IN_TARGET_ZONE, AxisFlags.MOVING | AxisFlags.TARGET_ZONE_TIMEOUT
    status = yield from _wait(session, axis, wanted, unwanted, timeout_s, poll_s)
    if status.flags & FAILURES:
        raise MotionError(axis, "the move did not end where it should", status.flags)
    return status


def home(session: Session, axis: int, *, negative: bool, timeout_s: float | None) -> Procedure[None]:
    """HOM, and with a time-out wait for it.

    Raises:
        MotionError: the search ended without success (AS bit 5 off).
    """
    yield from write(session, "HOM", axis, "1" if negative else "0")
    if timeout_s is None:
        return
    status = yield from _wait(session, axis, AxisFlags(0), AxisFlags.MOVING, timeout_s, POLL_S)
    if not status.home_successful:
        raise MotionError(axis, "home was not found", status.flags)


def _wait(
    session: Session, axis: int, wanted: AxisFlags, unwanted: AxisFlags, timeout_s: float, poll_s: float
) -> Procedure[AxisWord]:
    clock = session.wire.clock
    deadline = clock() + timeout_s
    while True:
        status = yield from axis_status(session, axis)
        if status.flags & wanted == wanted and not status.flags & unwanted:
            return status
        if not status.moving and status.flags & FAILURES:
            raise MotionError(axis, "the move did not end where it should", status.flags)
        if clock() >= deadline:
            advice = f"stop() it, or allow more than {timeout_s:g} s"
            raise NoAnswer(f"the end of the move of axis {axis}", repr(status).encode("ascii"), advice)
        session.idle((yield Pause(poll_s)))

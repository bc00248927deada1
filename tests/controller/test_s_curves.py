"""S-curves of every kind of motion, measured by the scope: jerk, duration and distance are those of the equations.

With maximum A and average AA a change of velocity dv takes dv / AA, of which dv / AA - dv / A on each end have constant
jerk (following-and-profiles 5.2); a stop covers v2 / (2 AA) as a straight ramp at AA would.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pytest

from emulator.engine.trace import Source, Trace
from tests.controller.session import TRAJECTORY_NS, Session

COUNTS = 4000
TRAJECTORY_S = TRAJECTORY_NS / 1e9
SAMPLES_PER_TRAJECTORY = 4

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Ramp:
    """A change of velocity, rev/s, with its maximum and average acceleration, rev/s2."""

    start: float
    end: float
    maximum: float
    average: float

    @property
    def duration_s(self) -> float:
        return abs(self.end - self.start) / self.average

    def acceleration(self, t: Floats) -> Floats:
        """counts/s2 at `t` s: up with constant jerk, flat, down again."""
        jerk_s = self.duration_s - abs(self.end - self.start) / self.maximum
        from_an_end = np.minimum(t, self.duration_s - t)
        share = np.clip(from_an_end / jerk_s, 0.0, 1.0) if jerk_s > 0 else np.ones_like(t)
        return np.asarray(np.sign(self.end - self.start) * self.maximum * COUNTS * share)

    @property
    def distance_counts(self) -> float:
        return (self.start + self.end) / 2 * self.duration_s * COUNTS


def record(session: Session, act: Callable[[], None], *, for_s: float) -> Trace:
    """Commanded acceleration, velocity and position of axis 1 at every trajectory update around an action."""
    engine = session.unit.controller.engine
    # Rows begin on the sample of a trajectory update.
    session.emulator.advance_to(engine.next_trajectory_ns)
    names = ("commanded_acceleration", "commanded_velocity", "commanded_counts")
    rows = round(for_s / TRAJECTORY_S)
    engine.scope.arm([Source(name, 0) for name in names], rows=rows, every=SAMPLES_PER_TRAJECTORY)
    act()
    session.advance(for_s + 0.1)
    trace = engine.scope.read()
    assert trace.complete
    return trace


def assert_ramp(trace: Trace, ramp: Ramp) -> None:
    """The first change of velocity in a trace is this ramp: begun at a trajectory update, exact at every other."""
    acceleration, velocity, position = (np.asarray(column, float) for column in trace.columns)
    times = trace.times_ns * 1e-9
    # A ramp with a jerk begins with no acceleration, a straight one with all of it.
    first = int(np.flatnonzero(acceleration)[0]) - (1 if ramp.average < ramp.maximum else 0)
    t = times - times[first]
    during = (t >= 0) & (t < ramp.duration_s - 1e-9)
    assert np.count_nonzero(during) > 20
    assert acceleration[during] == pytest.approx(ramp.acceleration(t[during]), rel=1e-6, abs=1e-3 * COUNTS)
    over = int(np.flatnonzero(t >= ramp.duration_s - 1e-9)[0])
    assert velocity[first] == pytest.approx(ramp.start * COUNTS)
    assert velocity[over] == pytest.approx(ramp.end * COUNTS, abs=1e-6)
    assert acceleration[over] == 0.0
    beyond = (t[over] - ramp.duration_s) * ramp.end * COUNTS
    assert position[over] - position[first] == pytest.approx(ramp.distance_counts + beyond, abs=1)


def cruising(*commands: str, machine: str = "", velocity: float = 2.0) -> Session:
    session = Session(machine)
    session.ok("DRIVE10", "COMEXC1", "MC1", "SMPER0", f"V{velocity}", "A100", *commands, "GO1")
    session.advance(0.5)
    return session


SHAPES = pytest.mark.parametrize(("maximum", "average"), [(20, 10), (20, 13), (20, 20)], ids=["pure", "middle", "none"])


@SHAPES
class TestEveryKind:
    def test_go(self, maximum: float, average: float) -> None:
        session = Session()
        session.ok("DRIVE10", "COMEXC1", "SMPER0", f"A{maximum}", f"AA{average}", "V2", "D40000")
        assert_ramp(record(session, lambda: session.ok("GO1"), for_s=0.5), Ramp(0, 2, maximum, average))
        session.until_rest()
        assert session.position() == 40_000

    def test_go_on_the_fly(self, maximum: float, average: float) -> None:
        session = cruising(f"AA{average}", f"A{maximum}", velocity=1.0)
        trace = record(session, lambda: session.ok("V3", "GO1"), for_s=0.5)
        assert_ramp(trace, Ramp(1, 3, maximum, average))

    @pytest.mark.parametrize("stop", ["!S", "!S1", "V0:GO1"])
    def test_stop(self, maximum: float, average: float, stop: str) -> None:
        session = cruising(f"AD{maximum}", f"ADA{average}")
        assert_ramp(record(session, lambda: _send(session, stop), for_s=0.5), Ramp(2, 0, maximum, average))

    @pytest.mark.parametrize("kill", ["!K", "!K1", "\x0b"])
    def test_kill(self, maximum: float, average: float, kill: str) -> None:
        session = cruising(f"LHAD{maximum}", f"LHADA{average}")
        assert_ramp(record(session, lambda: _send(session, kill), for_s=0.5), Ramp(2, 0, maximum, average))

    def test_hard_limit(self, maximum: float, average: float) -> None:
        session = cruising(f"LHAD{maximum}", f"LHADA{average}")
        trace = record(session, lambda: session.set_wire("axis1.positive_limit", closed=False), for_s=0.5)
        assert_ramp(trace, Ramp(2, 0, maximum, average))

    def test_soft_limit(self, maximum: float, average: float) -> None:
        session = cruising(f"LSAD{maximum}", f"LSADA{average}", "LSPOS6000", "LSNEG-1", "LS3")
        assert_ramp(record(session, lambda: None, for_s=1.0), Ramp(2, 0, maximum, average))
        assert session.axis_bit(17)

    def test_jog(self, maximum: float, average: float) -> None:
        session = Session()
        session.ok("DRIVE10", "COMEXC1", "SMPER0", "INFNC1-1J", "INDEB1", "INFEN1", "JOGVL2", f"JOGA{maximum}")
        session.ok(f"JOGAA{average}", f"JOGAD{maximum / 2}", f"JOGADA{average / 2}", "JOG1")
        trace = record(session, lambda: session.set_wire("input.1", closed=True), for_s=0.5)
        assert_ramp(trace, Ramp(0, 2, maximum, average))
        trace = record(session, lambda: session.set_wire("input.1", closed=False), for_s=0.7)
        assert_ramp(trace, Ramp(2, 0, maximum / 2, average / 2))

    def test_joystick(self, maximum: float, average: float) -> None:
        session = Session("[wires]\nanalog = [1.0, 1.0, 1.0]\n")
        session.ok("DRIVE10", "COMEXC1", "SMPER0", "JOYCTR1", "JOYCDB.1", "JOYEDB.2", "JOYAXL1", "JOYVH2", "JOYVL2")
        session.ok(f"JOYA{maximum}", f"JOYAA{average}", f"JOYAD{maximum / 2}", f"JOYADA{average / 2}", "JOY1")
        trace = record(session, lambda: session.unit.do("set_analog", channel=1, volts=2.4), for_s=0.5)
        assert_ramp(trace, Ramp(0, 2, maximum, average))
        trace = record(session, lambda: session.unit.do("set_analog", channel=1, volts=1.0), for_s=0.7)
        assert_ramp(trace, Ramp(2, 0, maximum / 2, average / 2))

    def test_home(self, maximum: float, average: float) -> None:
        session = Session("[axis1.travel]\nhome_from_rev = 3.0\nhome_to_rev = 4.0\n")
        session.ok("DRIVE10", "COMEXC1", "SMPER0", "HOMV2", f"HOMA{maximum}", f"HOMAA{average}")
        session.ok(f"HOMAD{maximum / 2}", f"HOMADA{average / 2}")
        trace = record(session, lambda: session.ok("HOM0"), for_s=0.5)
        assert_ramp(trace, Ramp(0, 2, maximum, average))
        assert_ramp(record(session, lambda: None, for_s=2.0), Ramp(2, 0, maximum / 2, average / 2))


def _send(session: Session, text: str) -> None:
    if text.startswith("\x0b"):
        session.unit.send(text.encode())
    else:
        session.ask(text)


class TestOnlyTheKindItWasEnteredFor:
    """Entering an average value enables S-curve only for that kind of move (6250 UG p.95)."""

    @pytest.mark.parametrize("other", ["JOGAA10", "HOMAA10", "JOYAA10", "LHADA60", "LSADA60"])
    def test_go_stays_straight(self, other: str) -> None:
        session = Session()
        session.ok(
            "DRIVE10",
            "COMEXC1",
            "SMPER0",
            "JOGA20",
            "HOMA20",
            "JOYA20",
            "A20",
            "LHAD100",
            "LSAD100",
            other,
            "V2",
            "D40000",
        )
        assert_ramp(record(session, lambda: session.ok("GO1"), for_s=0.5), Ramp(0, 2, 20, 20))

    def test_aa_leaves_the_limit_straight(self) -> None:
        session = cruising("AA60", "AD100", "LHAD20")
        assert_ramp(record(session, lambda: session.ok("!K"), for_s=0.5), Ramp(2, 0, 20, 20))


class TestWhatFollowsWhat:
    """AA follows A until entered, ADA copies AA until AD or ADA is; checked by what the ramps then are."""

    def test_deceleration_copies_the_ramp_of_a_and_aa(self) -> None:
        session = cruising("A20", "AA12")
        assert_ramp(record(session, lambda: session.ok("!S1"), for_s=0.5), Ramp(2, 0, 20, 12))

    def test_once_ad_is_entered_ada_follows_it(self) -> None:
        session = cruising("A20", "AA12", "AD16")
        assert session.query("1ADA") == "1ADA16.0000"
        assert_ramp(record(session, lambda: session.ok("!S1"), for_s=0.5), Ramp(2, 0, 16, 16))

    def test_aa0_is_straight_again(self) -> None:
        session = cruising("AA60", "AA0", "A20")
        assert_ramp(record(session, lambda: session.ok("!S1"), for_s=0.5), Ramp(2, 0, 20, 20))

    def test_a_stop_is_never_refused_for_its_average(self) -> None:
        """AD below ADA since the move began: a straight ramp at AD (assumed)."""
        session = cruising("AD60", "ADA60")
        session.ok("AD20")
        assert_ramp(record(session, lambda: session.ok("!S1"), for_s=0.5), Ramp(2, 0, 20, 20))


@pytest.mark.parametrize(
    ("names", "command", "way"),
    [
        (("A", "AA"), "GO1", "ACCELERATION"),
        (("AD", "ADA"), "GO1", "DECELERATION"),
        (("HOMA", "HOMAA"), "HOM0", "ACCELERATION"),
        (("HOMAD", "HOMADA"), "HOM0", "DECELERATION"),
        (("JOGA", "JOGAA"), "JOG1", "ACCELERATION"),
        (("JOGAD", "JOGADA"), "JOG1", "DECELERATION"),
        (("JOYA", "JOYAA"), "JOY1", "ACCELERATION"),
        (("JOYAD", "JOYADA"), "JOY1", "DECELERATION"),
    ],
)
@pytest.mark.parametrize(("average", "refused"), [("9.9", True), ("10", False), ("20", False), ("20.1", True)])
def test_the_rule_is_checked_when_motion_begins(
    names: tuple[str, str], command: str, way: str, average: str, refused: bool
) -> None:
    """A/2 <= AA <= A, never when entered: in between the two may disagree."""
    session = Session()
    session.ok("DRIVE10", "COMEXC1", "JOYAXL1", f"{names[1]}{average}", f"{names[0]}20")
    if refused:
        assert session.error(command) == f"INVALID CONDITIONS FOR S_CURVE {way}-FIELD 1"
        assert not session.axis_bit(1)
    else:
        session.ok(command)

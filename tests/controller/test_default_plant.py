"""The default machine as a servo: one revolution, the following error the loop must have, and what SMPER does."""

from __future__ import annotations

import pytest

from tests.controller.session import MS, S, Session

COUNTS_PER_REV = 4000
SPEED_PER_VOLT_REV_S = 10.0
"""Of the default velocity drive (machine file: axis1.plant.speed_per_volt_rev_s)."""

TRAJECTORY_S = 1120e-6


def gain_per_s(sgp_mv_per_count: float) -> float:
    """Velocity the plant is asked for per count of error: counts/s per count."""
    return sgp_mv_per_count * 1e-3 * SPEED_PER_VOLT_REV_S * COUNTS_PER_REV


def cruising(*commands: str, velocity: float = 1.0) -> Session:
    session = Session()
    session.ok("DRIVE10", "MC1", "COMEXC1", "A10", f"V{velocity}", *commands, "GO1")
    session.advance(velocity / 10 + 1.5)
    return session


def mean_error(session: Session) -> float:
    """TPER averaged over many system updates at readings that drift through the trajectory staircase."""
    errors = []
    for _ in range(300):
        session.advance(0.00301)
        errors.append(session.number("axis1.position.error"))
    return sum(errors) / len(errors)


def test_one_revolution() -> None:
    session = Session()
    session.ok("DRIVE11", "A10", "V1", "D4000")
    session.ok("GO11", wait_s=1.5)
    for axis in (1, 2):
        assert session.query(f"{axis}TPC") == f"{axis}TPC+4000"
        feedback = int(session.query(f"{axis}TPE").removeprefix(f"{axis}TPE"))
        assert abs(feedback - 4000) <= 2
        assert not session.axis_bit(1, axis)
        assert session.axis_bit(24, axis)


@pytest.mark.parametrize(("sgp", "velocity"), [(0.5, 1.0), (0.5, 3.0), (1.0, 2.0), (2.0, -1.0)])
def test_following_error_at_constant_velocity(sgp: float, velocity: float) -> None:
    """v / (K SGP): averaged over the trajectory staircase exactly that, but for one step of the converter."""
    session = Session()
    session.ok(
        "DRIVE10", "MC1", "COMEXC1", f"SGP{sgp}", f"V{abs(velocity)}", "D-" if velocity < 0 else "D+", "GO1", "SMPER0"
    )
    session.advance(abs(velocity) / 10 + 2.0)
    speed = velocity * COUNTS_PER_REV
    converter_step_counts = 20 / 2**16 / (sgp * 1e-3)
    assert mean_error(session) == pytest.approx(speed / gain_per_s(sgp), abs=converter_step_counts + 0.5)


def test_the_error_follows_the_staircase() -> None:
    """The commanded position moves once a trajectory update, so the error spreads over one step of it."""
    session = cruising(velocity=3.0)
    seen = set()
    for _ in range(300):
        session.advance(0.00301)
        seen.add(session.number("axis1.position.error"))
    assert max(seen) - min(seen) == pytest.approx(3 * COUNTS_PER_REV * TRAJECTORY_S, abs=4)


def test_velocity_feedforward_cancels_it() -> None:
    """1 rev/s needs 0.1 V = 4000 counts/s x 25 uV per count/s."""
    matched = 1 / (SPEED_PER_VOLT_REV_S * COUNTS_PER_REV) * 1e6
    assert matched == 25.0
    plain, cancelled = cruising(), cruising("SGVF25")
    assert mean_error(plain) == pytest.approx(200, abs=1.2)
    assert abs(mean_error(cancelled)) < 1.2
    assert cancelled.number("axis1.servo.velocity_feedforward") == pytest.approx(0.1)


def test_velocity_feedback_adds_what_feedforward_takes_away() -> None:
    """SGV opposes with its own voltage at speed, and SGVF of the same size cancels it (OEM guide p.44)."""
    assert mean_error(cruising("SGV25")) == pytest.approx(400, abs=8)
    assert mean_error(cruising("SGV25", "SGVF25")) == pytest.approx(200, abs=8)


def test_integral_removes_the_error_at_speed() -> None:
    session = cruising("SGI5")
    session.advance(3)
    assert abs(mean_error(session)) < 3


def test_no_gain_no_motion() -> None:
    """Every gain zero: the output is the offset (OEM guide p.40)."""
    session = Session()
    session.ok("DRIVE10", "SGP0", "SOFFS0.25", "SMPER0")
    session.advance(0.1)
    assert session.query("1TDAC") == "1TDAC+0.250"
    assert session.number("axis1.velocity.true") == pytest.approx(2.5, rel=0.01)


def test_output_limit() -> None:
    session = cruising("DACLIM0.05", "SMPER0")
    assert session.number("axis1.dac") == pytest.approx(0.05, abs=0.001)
    assert session.number("axis1.velocity.true") == pytest.approx(0.5, rel=0.02)


class TestPositionErrorLimit:
    """SMPER exceeded (hardware-and-servo 6.4, settled section 9)."""

    @staticmethod
    def tripped(*commands: str) -> Session:
        """1 rev/s needs 200 counts of error: SMPER100 trips on the way there."""
        session = Session()
        session.ok("DRIVE10", "MC1", "COMEXC1", "SMPER100", "SOFFS0.125", *commands, "GO1")
        session.advance(0.5)
        return session

    def test_shuts_the_drive_down(self) -> None:
        session = self.tripped()
        assert session.axis_bit(13)
        assert session.axis_bit(23)
        assert not session.axis_bit(1)
        assert session.query("DRIVE") == "DRIVE00"
        assert session.query("1TDAC") == "1TDAC+0.125", "the output is SOFFS until DRIVE1"
        assert session.error("GO1") == "DRIVE SHUTDOWN"

    def test_error_bit_only_where_error_enables_it(self) -> None:
        assert not self.tripped().error_bit(12)
        assert self.tripped("ERROR.12-1").error_bit(12)

    def test_drive_on_recovers(self) -> None:
        session = self.tripped("ERROR.12-1", "SOFFS0")
        session.advance(1.0)
        session.ok("DRIVE1")
        assert not session.axis_bit(13)
        assert not session.axis_bit(23)
        assert not session.error_bit(12)
        assert session.query("1TPC").removeprefix("1TPC") == session.query("1TPE").removeprefix("1TPE")
        assert session.query("1TPER") == "1TPER+0"
        session.ok("SMPER4000", "MC0", "D1000", "COMEXC0")
        before = session.position()
        session.ok("GO1", wait_s=1.0)
        assert session.position() - before == 1000

    def test_zero_is_not_watched(self) -> None:
        session = self.tripped("SMPER0")
        assert not session.axis_bit(23)
        assert session.axis_bit(1)

    def test_default_is_four_thousand(self) -> None:
        """Feedback that stands still: the trip comes with the first error over 4000 counts, at 1 rev/s after 1.05 s."""
        session = Session("[axis1.plant]\nkind = 'velocity_drive'\nspeed_per_volt_rev_s = 0.000001")
        session.ok("DRIVE10", "MC1", "COMEXC1", "GO1")
        start_ns = session.now_ns
        assert session.emulator.run_until(lambda: session.axis_bit(23))
        assert session.now_ns - start_ns == pytest.approx(1.05 * S, abs=8 * MS)

    def test_other_axis_goes_on(self) -> None:
        session = Session()
        session.ok("DRIVE11", "MC11", "COMEXC1", "SMPER100,0", "GO11")
        session.advance(0.5)
        assert session.query("DRIVE") == "DRIVE01"
        assert session.axis_bit(1, axis=2)
        assert not session.axis_bit(23, axis=2)


class TestEndOfAMove:
    def test_bit_1_falls_with_the_profile_bit_24_rises_in_the_zone(self) -> None:
        """STRGTD50: 5 rev/s leaves 1000 counts of lag, most of it still there when a steep profile ends."""
        session = Session()
        session.ok("DRIVE10", "V5", "A500", "AD500", "D8000", "COMEXC1", "GO1")
        session.advance(0.2)
        assert not session.axis_bit(24), "a running profile is never in the zone"
        session.until_rest()
        assert not session.axis_bit(1)
        assert not session.axis_bit(24)
        session.advance(0.5)
        assert session.axis_bit(24)
        assert abs(session.number("axis1.position.error")) <= 50

    def test_target_zone_holds_the_buffer(self) -> None:
        session = Session()
        session.ok("DRIVE10", "V5", "A500", "AD500", "D8000", "STRGTE1", "STRGTD5")
        prompts = session.timed("GO1", wait_s=2)
        profile_s = 5 / 500 + 2 / 5
        settling_s = prompts[-1].at_ns / S - profile_s
        assert 0.05 < settling_s < 0.5
        settled_ms = int(session.query("1TSTLT").removeprefix("1TSTLT"))
        assert settled_ms == pytest.approx(settling_s * 1000, abs=5)

    def test_target_zone_time_out(self) -> None:
        """SGP0 after the start: the axis never arrives; after STRGTT the buffer goes on, AS 25 and ER 11 tell."""
        session = Session()
        session.ok("DRIVE10", "SMPER0", "STRGTE1", "STRGTT300", "ERROR.11-1", "SGP0", "A100", "V5", "D1000")
        prompts = session.timed("GO1", wait_s=2)
        profile_s = 5 / 100 + 0.25 / 5
        assert prompts[-1].at_ns / S - profile_s == pytest.approx(0.3, abs=0.004)
        assert session.axis_bit(25)
        assert session.error_bit(11)
        assert not session.axis_bit(24)

    def test_time_out_is_cleared_by_the_next_go_or_strgte0(self) -> None:
        session = Session()
        commands = ("STRGTE1", "STRGTT300", "ERROR.11-1", "SGP0", "A100", "V5", "D1000")
        session.ok("DRIVE10", "SMPER0", *commands)
        session.ok("GO1", wait_s=2)
        assert session.error_bit(11)
        session.ok("STRGTE0")
        assert not session.axis_bit(25)
        assert not session.error_bit(11)
        session.ok("STRGTE1")
        session.ok("GO1", wait_s=2)
        assert session.error_bit(11)
        session.ok("SGP0.5", "DRIVE0")
        session.advance(1.0)
        session.ok("DRIVE1")
        session.ok("GO1", wait_s=2)
        assert not session.axis_bit(25)
        assert not session.error_bit(11)


class TestDriveOff:
    def test_commanded_position_follows_the_feedback(self) -> None:
        session = cruising()
        session.ok("!DRIVE0")
        at_once = session.position()
        session.advance(0.5)
        assert session.position() > at_once, "the motor coasts and TPC goes with it"
        assert session.query("1TPC").removeprefix("1TPC") == session.query("1TPE").removeprefix("1TPE")
        assert session.query("1TPER") == "1TPER+0"

    def test_output_is_the_offset(self) -> None:
        session = Session()
        session.ok("SOFFS-1.5,2")
        session.advance(0.01)
        assert session.query("TDAC") == "TDAC-1.500,+2.000"

    def test_idle_status(self) -> None:
        """The word of settled section 5."""
        assert Session().query("1TAS") == "1TAS0000_0000_0000_1000_0000_0001_0000_0000"

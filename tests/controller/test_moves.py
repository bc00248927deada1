"""Moves as commands make them: where they end, how long they take, what changes them and what ends them."""

from __future__ import annotations

import math

import pytest

from tests.controller.session import ERROR, OK, ONE_UPDATE_EACH_NS, SYSTEM_NS, S, Session

COUNTS_PER_REV = 4000
AT_REST = 0.0


def mover(*commands: str, machine: str = "", **defaults: str | int) -> Session:
    """A unit with axis 1 on."""
    session = Session(machine, **defaults)
    session.ok("DRIVE10", *commands)
    return session


def kinematics(distance: float, velocity: float, rise: float, fall: float) -> tuple[float, float]:
    """Peak velocity and duration of a preset move (following-and-profiles 5.2)."""
    if velocity**2 / (2 * rise) + velocity**2 / (2 * fall) <= distance:
        ramps = velocity**2 / (2 * rise) + velocity**2 / (2 * fall)
        return velocity, velocity / rise + velocity / fall + (distance - ramps) / velocity
    peak = math.sqrt(2 * distance * rise * fall / (rise + fall))
    return peak, peak / rise + peak / fall


TRAPEZOIDS = [
    # revolutions, V, A, AD, peak velocity, seconds: the table of following-and-profiles 5.3
    (25.0, 1, 10, 10, 1.0, 25.1),
    (6.25, 1, 10, 10, 1.0, 6.35),
    (1.0, 10, 10, 10, 3.16228, 0.632456),
    (10.0, 5, 25, 20, 5.0, 2.225),
    (8.0, 10, 100, 50, 10.0, 0.95),
    (1.0, 2, 10, 5, 2.0, 0.8),
]


@pytest.mark.parametrize(("revolutions", "v", "a", "ad", "peak", "seconds"), TRAPEZOIDS)
@pytest.mark.parametrize("sign", [1, -1])
def test_trapezoids_and_triangles(
    revolutions: float, v: float, a: float, ad: float, peak: float, seconds: float, sign: int
) -> None:
    session = mover(f"A{a}", f"AD{ad}", f"V{v}", "SMPER0", f"D{sign * round(revolutions * COUNTS_PER_REV)}")
    prompts = session.timed("GO1", wait_s=seconds + 0.1)
    assert [text for _, text in prompts] == [OK]
    assert 0 < prompts[0].at_ns - round(seconds * S) <= ONE_UPDATE_EACH_NS
    assert session.position() == sign * round(revolutions * COUNTS_PER_REV)
    assert not session.axis_bit(1)


@pytest.mark.parametrize(("revolutions", "v", "a", "ad", "peak", "seconds"), TRAPEZOIDS)
def test_peak_velocity_and_the_moving_bit(
    revolutions: float, v: float, a: float, ad: float, peak: float, seconds: float
) -> None:
    session = mover(f"A{a}", f"AD{ad}", f"V{v}", "SMPER0", f"D{round(revolutions * COUNTS_PER_REV)}", "COMEXC1", "GO1")
    start_ns = session.now_ns
    rise_s = peak / a
    session.advance(rise_s)
    assert session.number("axis1.velocity.commanded") == pytest.approx(
        peak * COUNTS_PER_REV, rel=0.005 + 0.0025 / rise_s
    )
    assert session.axis_bit(1)
    session.advance(seconds - rise_s - 0.001)
    assert session.axis_bit(1)
    session.until_rest()
    assert 0 < session.now_ns - start_ns - seconds * S <= ONE_UPDATE_EACH_NS + SYSTEM_NS


S_CURVES = [
    # V, A, AA, ramp time, jerk phase, jerk, ramp distance: the second table of 5.3
    (5, 10, 5, 1.0, 0.5, 20, 2.5),
    (5, 10, 7.5, 0.66667, 0.16667, 60, 1.66667),
    (1, 10, 5, 0.2, 0.1, 100, 0.1),
    (10, 100, 75, 0.13333, 0.03333, 3000, 0.66667),
    (20, 40, 30, 0.66667, 0.16667, 240, 6.66667),
]


@pytest.mark.parametrize(("v", "a", "aa", "ramp_s", "jerk_s", "jerk", "ramp_rev"), S_CURVES)
def test_s_curve_ramps(
    v: float, a: float, aa: float, ramp_s: float, jerk_s: float, jerk: float, ramp_rev: float
) -> None:
    """The ramp up: acceleration at the end of the first jerk phase, speed and distance at the end of the ramp."""
    session = mover("SMPER0", "MC1", f"A{a}", f"AA{aa}", f"V{v}", "COMEXC1", "GO1")
    session.advance(jerk_s / 2)
    late_s = ONE_UPDATE_EACH_NS / S
    assert session.number("axis1.acceleration.commanded") == pytest.approx(
        jerk * jerk_s / 2 * COUNTS_PER_REV, abs=jerk * late_s * COUNTS_PER_REV
    )
    session.advance(jerk_s / 2)
    assert session.number("axis1.acceleration.commanded") == pytest.approx(
        a * COUNTS_PER_REV, abs=jerk * late_s * COUNTS_PER_REV
    )
    session.advance(ramp_s - jerk_s + late_s)
    assert session.number("axis1.velocity.commanded") == pytest.approx(v * COUNTS_PER_REV)
    assert session.position() == pytest.approx(ramp_rev * COUNTS_PER_REV, abs=v * late_s * COUNTS_PER_REV + 1)
    assert session.axis_bit(4)


@pytest.mark.parametrize(("v", "a", "aa", "ramp_s", "jerk_s", "jerk", "ramp_rev"), S_CURVES)
@pytest.mark.parametrize("cruise_s", [0.0, 0.25])
def test_s_curve_moves_last_as_long_as_with_the_average(
    v: float, a: float, aa: float, ramp_s: float, jerk_s: float, jerk: float, ramp_rev: float, cruise_s: float
) -> None:
    """No AD and no ADA entered: the deceleration is a copy of the ramp (settled, section 7)."""
    counts = round((2 * v**2 / (2 * aa) + v * cruise_s) * COUNTS_PER_REV)
    session = mover("SMPER0", f"A{a}", f"AA{aa}", f"V{v}", f"D{counts}")
    _, seconds = kinematics(counts / COUNTS_PER_REV, v, aa, aa)
    prompts = session.timed("GO1", wait_s=seconds + 0.1)
    assert seconds == pytest.approx(2 * ramp_s + cruise_s, abs=1e-3)
    assert 0 < prompts[0].at_ns - round(seconds * S) <= ONE_UPDATE_EACH_NS
    assert session.position() == counts


def test_s_curve_deceleration_of_its_own() -> None:
    session = mover("SMPER0", "A10", "AD20", "ADA10", "V5", f"D{10 * COUNTS_PER_REV}")
    _, seconds = kinematics(10, 5, 10, 10)
    prompts = session.timed("GO1", wait_s=seconds + 0.1)
    assert 0 < prompts[0].at_ns - round(seconds * S) <= ONE_UPDATE_EACH_NS


@pytest.mark.parametrize(
    ("settings", "text"),
    [
        (("A10", "AA4.9"), "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
        (("A10", "AA10.1"), "INVALID CONDITIONS FOR S_CURVE ACCELERATION-FIELD 1"),
        (("AD10", "ADA4.9"), "INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD 1"),
        (("AD10", "ADA10.1"), "INVALID CONDITIONS FOR S_CURVE DECELERATION-FIELD 1"),
    ],
)
def test_s_curve_rule_is_checked_at_go(settings: tuple[str, ...], text: str) -> None:
    session = mover(*settings)
    assert session.error("GO1") == text
    session.advance(0.1)
    assert session.position() == 0
    assert not session.axis_bit(1)


@pytest.mark.parametrize("average", ["AA5", "AA10", "AA0"])
def test_s_curve_rule_ends(average: str) -> None:
    session = mover("A10", average)
    session.ok("GO1", wait_s=2)


def test_incremental_and_absolute() -> None:
    session = mover("D1000", "V5", "A100")
    session.ok("GO1", "GO1", wait_s=0.5)
    assert session.position() == 2000
    session.ok("MA10", "D-500")
    session.ok("GO1", wait_s=0.8)
    assert session.position() == -500
    assert session.timed("GO1", wait_s=0.1)[0].at_ns <= SYSTEM_NS, "an absolute move of no length is over at once"
    session.ok("PSET100")
    assert session.position() == 100
    session.ok("GO1", wait_s=0.5)
    assert session.position() == -500


def test_direction_signs() -> None:
    session = mover("D1000", "V5", "A100", "D-")
    session.ok("GO1", wait_s=0.5)
    assert session.position() == -1000
    session.ok("D~", "GO1", wait_s=0.5)
    assert session.position() == 0
    session.ok("1D-", "1D+")
    assert session.query("1D") == "1D+1000"


def test_continuous_motion_and_stop() -> None:
    session = mover("MC1", "V2", "A10", "AD20", "D-", "COMEXC1", "GO1")
    session.advance(0.5)
    bits = session.axis_bits()
    assert (bits[0], bits[1], bits[2], bits[3], bits[6]) == ("1", "1", "0", "1", "1")
    assert session.number("axis1.velocity.commanded") == -2 * COUNTS_PER_REV
    session.ok("!D+", "!V1", "!GO1")
    session.advance(0.2 + 0.1 + 0.1)
    assert session.number("axis1.velocity.commanded") == COUNTS_PER_REV
    assert not session.axis_bit(2)
    before, start_ns = session.position(), session.now_ns
    session.ok("!S1")
    session.until_rest()
    assert 0 < session.now_ns - start_ns - 0.05 * S <= ONE_UPDATE_EACH_NS + SYSTEM_NS
    assert session.position() - before == pytest.approx(1 / 40 * COUNTS_PER_REV, abs=COUNTS_PER_REV * 0.0035)


@pytest.mark.parametrize("prefix", ["", "!"])
def test_velocity_changed_on_the_fly(prefix: str) -> None:
    """Both routes: ``!V !GO``, or COMEXC1 and plain commands."""
    session = mover("V1", "A10", f"D{3 * COUNTS_PER_REV}", "MA1", "COMEXC1", "GO1")
    session.advance(1.0)
    session.ok(f"{prefix}V2", f"{prefix}GO1")
    session.advance(0.2)
    assert session.number("axis1.velocity.commanded") == 2 * COUNTS_PER_REV
    session.until_rest(timeout_s=5)
    assert session.position() == 3 * COUNTS_PER_REV
    assert not session.axis_bit(30)


def test_target_changed_on_the_fly() -> None:
    session = mover("V1", "A10", "D8000", "MA1", "COMEXC1", "GO1")
    session.advance(1.0)
    session.ok("!D6000", "!GO1")
    session.until_rest(timeout_s=5)
    assert session.position() == 6000
    assert not session.axis_bit(30)


@pytest.mark.parametrize("target", [3900, -1000])
def test_pre_emptive_go_that_cannot_reach(target: int) -> None:
    """Braking distance, or a target behind: AS 30 and ER 10, the original move continues (following-and-profiles 4.2,
    5.4); the next legal GO clears both."""
    session = mover("V1", "A10", "D8000", "MA1", "COMEXC1", "ERROR.10-1", "GO1")
    session.advance(1.0)
    where = session.position()
    assert 3780 < where < 3820
    session.ok(f"!D{target}", "!GO1")
    assert session.axis_bit(30)
    assert session.error_bit(10)
    session.until_rest(timeout_s=5)
    assert session.position() == 8000
    session.ok("D0", "GO1")
    assert not session.axis_bit(30)
    assert not session.error_bit(10)


def test_velocity_zero_goes_nowhere() -> None:
    session = mover("V0")
    assert session.timed("GO1", wait_s=0.1)[0].at_ns <= SYSTEM_NS
    assert session.position() == 0
    session.ok("V1", "MC1", "COMEXC1", "GO1")
    session.advance(0.5)
    session.ok("!V0", "!GO1")
    session.until_rest(timeout_s=1)
    assert session.number("axis1.velocity.commanded") == AT_REST


def test_both_axes_start_together_and_end_by_themselves() -> None:
    session = Session()
    session.ok("DRIVE11", "D1000,-4000", "V5,1", "A100,10")
    prompts = session.timed("GO11", wait_s=1.5)
    assert [text for _, text in prompts] == [OK]
    assert 0 < prompts[0].at_ns - round(1.1 * S) <= ONE_UPDATE_EACH_NS, "the prompt waits for the longer move"
    assert (session.position(1), session.position(2)) == (1000, -4000)


class TestDriveOff:
    def test_named_axis_off(self) -> None:
        session = mover()
        for command in ("GO11", "GO01", "2GO", "2GO1"):
            assert session.error(command) == "DRIVE SHUTDOWN"
        session.advance(0.1)
        assert session.position() == 0, "nothing starts"

    def test_bare_go_starts_what_is_on(self) -> None:
        session = mover()
        session.ok("GO", wait_s=1.5)
        assert (session.position(1), session.position(2)) == (4000, 0)

    def test_bare_go_with_none_on(self) -> None:
        assert Session().error("GO") == "DRIVE SHUTDOWN"

    def test_drive_off_in_motion_is_refused(self) -> None:
        session = mover("COMEXC1", "GO1")
        session.advance(0.5)
        assert session.error("DRIVE0") == "MOTION IN PROGRESS"
        assert session.query("DRIVE") == "DRIVE10"


class TestStopAndKill:
    """S decelerates at AD, K at LHAD; bare they end buffer and program too (settled, section 7)."""

    @pytest.mark.parametrize(
        ("command", "deceleration"),
        [("!S", 20), ("!S1", 20), ("!1S", 20), ("!S10000000", 20), ("!K", 50), ("!K1", 50), ("!K1XXXXXXX", 50)],
    )
    def test_deceleration(self, command: str, deceleration: float) -> None:
        session = mover("MC1", "V2", "A10", "AD20", "LHAD50", "COMEXC1", "GO1")
        session.advance(0.5)
        before, start_ns = session.position(), session.now_ns
        session.ok(command)
        session.until_rest(timeout_s=1)
        seconds = 2 / deceleration
        assert 0 < session.now_ns - start_ns - seconds * S <= ONE_UPDATE_EACH_NS + SYSTEM_NS
        late_counts = 2 * COUNTS_PER_REV * 0.0034
        expected = 4 / (2 * deceleration) * COUNTS_PER_REV
        assert session.position() - before == pytest.approx(expected, abs=late_counts)

    def test_control_k_needs_no_delimiter(self) -> None:
        session = mover("MC1", "V2", "A10", "LHAD50", "COMEXC1", "GO1")
        session.advance(0.5)
        session.unit.send(b"\x0b")
        session.until_rest(timeout_s=1)
        assert session.read() == OK
        assert session.number("axis1.velocity.commanded") == AT_REST

    @pytest.mark.parametrize("command", ["!S", "!K", "\x0b"])
    def test_bare_empties_the_buffer(self, command: str) -> None:
        session = mover("D40000")
        session.ask("GO1")
        session.ask("A77:V7")
        session.advance(0.5)
        session.ask(command)
        session.until_rest(timeout_s=1)
        session.read()
        assert session.query("1A") == "1A10.0000"
        assert session.query("1V") == "1V1.0000"

    @pytest.mark.parametrize("command", ["!S1", "!K1", "!1S", "!1K"])
    def test_with_axes_the_buffer_goes_on(self, command: str) -> None:
        session = mover("D40000")
        session.ask("GO1")
        session.ask("A77:V7")
        session.advance(0.5)
        session.ask(command)
        session.until_rest(timeout_s=1)
        session.read()
        assert session.query("1A") == "1A77.0000"

    @pytest.mark.parametrize(("command", "goes_on"), [("!S", False), ("!K", False), ("!S1", True), ("!K1", True)])
    def test_programs(self, command: str, goes_on: bool) -> None:
        session = mover("D40000")
        session.ask("DEF P:GO1:A55:END")
        session.ask("RUN P")
        session.advance(0.5)
        assert session.system_bit(3)
        session.ask(command)
        session.until_rest(timeout_s=1)
        session.advance(0.1)
        assert not session.system_bit(3)
        session.read()
        assert session.query("1A") == ("1A55.0000" if goes_on else "1A10.0000")

    def test_other_axis_goes_on(self) -> None:
        session = Session()
        session.ok("DRIVE11", "MC11", "COMEXC1", "GO11")
        session.advance(0.5)
        session.ok("!S01000000")
        session.until_rest(2, timeout_s=1)
        assert session.axis_bit(1, axis=1)
        assert not session.axis_bit(1, axis=2)

    @pytest.mark.parametrize(("kdrive", "drive"), [("KDRIVE1", "DRIVE00"), ("KDRIVE0", "DRIVE10")])
    def test_kdrive(self, kdrive: str, drive: str) -> None:
        session = mover(kdrive, "MC1", "COMEXC1", "GO1")
        session.advance(0.5)
        session.ok("!K")
        session.advance(0.5)
        assert session.query("DRIVE") == drive
        assert session.axis_bit(13) == (drive == "DRIVE00")
        assert not session.axis_bit(1)

    @pytest.mark.parametrize("command", ["!S", "!K", "!S1", "!K1"])
    def test_error_bit_five(self, command: str) -> None:
        session = mover("MC1", "COMEXC1", "ERROR.5-1", "GO1")
        session.advance(0.5)
        assert not session.error_bit(5)
        session.ok(command)
        assert session.error_bit(5)
        session.until_rest(timeout_s=1)
        session.ok("GO1")
        assert not session.error_bit(5), "the next GO clears it"

    def test_kill_of_an_idle_unit(self) -> None:
        session = mover()
        session.ok("!K", "K", "!S", "S", "!K11", "!S00")
        assert ERROR.fullmatch(session.ask("GO2"))

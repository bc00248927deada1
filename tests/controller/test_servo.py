"""The law in the running controller: dither, hand-over of the drive, KDRIVE, offset, windup, limits of the gains."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator.engine.trace import Source
from tests.controller.session import Session

SERVO_S = 280e-6
STEP_V = 20 / 65536
NUMBERS = "+-.0123456789,"
REPORTS = ("TPC", "TPE", "TFB", "TPER", "TDAC", "TVEL", "TVELA", "TSTLT", "TANI", "TGAIN", "TAS")


def recorded(session: Session, *fields: str, rows: int, axis: int = 0) -> list[np.ndarray]:
    engine = session.unit.controller.engine
    engine.scope.arm([Source(name, axis) for name in fields], rows=rows)
    session.advance(rows * SERVO_S + 0.01)
    return [np.asarray(column) for column in engine.scope.read().columns]


@pytest.mark.parametrize(
    ("commands", "servo_us", "ssfr"),
    [
        ((), 280, 4),
        (("SSFR1",), 580, 1),
        (("SSFR8",), 265, 8),
        (("INDAX1",), 160, 4),
        (("INDAX1", "SSFR2"), 185, 2),
    ],
)
def test_ssfr_and_indax_set_the_rates(commands: tuple[str, ...], servo_us: int, ssfr: int) -> None:
    """The scope's rows come at the servo rate of the table, the command's stairs every SSFR of them."""
    session = Session()
    session.ok(*commands, "1DRIVE1", "COMEXC1", "1MC1", "1V10", "1A500", "1SMPER0", "1GO")
    session.advance(0.2)
    engine = session.unit.controller.engine
    engine.scope.arm([Source("commanded_counts", 0)], rows=400)
    session.advance(0.3)
    trace = engine.scope.read()
    assert np.all(np.diff(trace.times_ns) == servo_us * 1000)
    assert np.all(np.diff(np.flatnonzero(np.diff(trace.columns[0]))) == ssfr)


class TestDither:
    @pytest.mark.parametrize(("amplitude", "ratio"), [(0.5, 1), (1.0, 4), (2.0, 50)])
    def test_amplitude_and_frequency_at_the_output(self, amplitude: float, ratio: int) -> None:
        """A square wave of +-SDTAMP that turns every SDTFR servo samples: 1 / (2 SDTFR Ts)."""
        session = Session()
        session.ok("SGP0,0", f"SDTAMP{amplitude},0", f"SDTFR{ratio},0", "DRIVE11")
        (volts,) = recorded(session, "dac_v", rows=40 * ratio)
        assert set(np.round(volts, 3)) == {amplitude, -amplitude}
        turns = np.flatnonzero(np.diff(volts))
        assert np.all(np.diff(turns) == ratio)
        assert session.query("2TDAC") == "2TDAC+0.000"

    @pytest.mark.parametrize("off", ["SDTAMP0", "SDTFR0", "DRIVE0"])
    def test_off(self, off: str) -> None:
        session = Session()
        session.ok("SGP0", "SDTAMP1", "SDTFR2", "DRIVE1", off)
        (volts,) = recorded(session, "dac_v", rows=50)
        assert not np.any(volts)

    def test_on_an_axis_that_holds_its_position(self) -> None:
        """Fast dither leaves the shaft where it is, to a count."""
        session = Session()
        session.ok("DRIVE10", "SDTAMP1", "SDTFR1", "D4000", "COMEXC1", "GO1")
        session.advance(2)
        assert session.query("1TPE").removeprefix("1TPE") in {"+3999", "+4000", "+4001"}


class TestHandOver:
    def test_drive_off_and_on_with_the_integrator_wound(self) -> None:
        session = Session()
        session.ok("DRIVE10", "SOFFS0.5", "SGP2", "SGI20")
        session.advance(3)
        assert abs(session.number("axis1.servo.integral")) > 0.45
        session.ok("DRIVE0")
        session.advance(0.01)
        assert session.number("axis1.servo.integral") == 0.0
        session.ok("SOFFS0")
        session.advance(1)
        session.ok("DRIVE1")
        volts, commanded, feedback = recorded(session, "dac_v", "commanded_counts", "feedback_counts", rows=500)
        assert float(np.max(np.abs(volts))) <= STEP_V
        assert not np.any(commanded - feedback)

    def test_while_coasting(self) -> None:
        """The command takes over where the shaft is at that sample; the error begins with one sample's travel."""
        session = Session()
        session.ok("DRIVE10", "COMEXC1", "MC1", "V10", "A500", "GO1")
        session.advance(1)
        session.ok("!DRIVE0")
        session.advance(0.02)
        speed = session.number("axis1.velocity.true") * 4000
        assert speed > 10_000
        session.ok("DRIVE1")
        commanded, feedback, volts = recorded(session, "commanded_counts", "feedback_counts", "dac_v", rows=1)
        assert commanded[0] - feedback[0] == pytest.approx(-speed * SERVO_S, abs=2)
        assert volts[0] == pytest.approx(0.5e-3 * (commanded[0] - feedback[0]), abs=STEP_V)
        session.advance(0.5)
        assert session.query("1TPER").removeprefix("1TPER") in {"+0", "-1", "+1"}
        assert not session.axis_bit(23)

    def test_drive1_on_a_drive_that_is_on_changes_nothing(self) -> None:
        session = Session()
        session.ok("DRIVE10", "SOFFS0.1", "SGI2")
        session.advance(3)
        before = (session.position(), session.number("axis1.servo.integral"))
        session.ok("DRIVE1")
        assert (session.position(), session.number("axis1.servo.integral")) == before

    @pytest.mark.parametrize(("kdrive", "on"), [(0, True), (1, False)])
    def test_kdrive(self, kdrive: int, on: bool) -> None:
        session = Session()
        session.ok("DRIVE10", f"KDRIVE{kdrive}", "COMEXC1", "MC1", "GO1")
        session.advance(0.3)
        session.ok("!K")
        session.advance(0.5)
        assert session.axis_bit(13) is not on
        assert not session.axis_bit(1)
        at = session.number("axis1.position.true")
        session.advance(0.5)
        assert session.number("axis1.position.true") == pytest.approx(at, abs=1e-3)


def test_all_gains_zero_is_the_offset_alone() -> None:
    session = Session()
    session.ok("SGP0", "SOFFS0.3", "SMPER0", "DRIVE10")
    session.advance(0.2)
    assert session.query("1TDAC") == "1TDAC+0.300"
    assert session.number("axis1.velocity.true") == pytest.approx(3.0, rel=0.01)
    assert session.position() == 0, "the command stands still while the shaft turns: the loop is closed on nothing"


@pytest.mark.parametrize(("sgilim", "held"), [("0.2", 0.2), ("200", 0.5)])
def test_sgilim_holds_the_integral(sgilim: str, held: float) -> None:
    """An offset of -0.5 V to be made up: the integral up to SGILIM, the rest is error x SGP."""
    session = Session()
    session.ok("DRIVE10", "SOFFS-0.5", "SGP2", "SGI20", f"SGILIM{sgilim}")
    session.advance(5)
    assert session.number("axis1.servo.integral") == pytest.approx(held, abs=0.003)
    assert session.number("axis1.position.error") == pytest.approx((0.5 - held) / 2e-3, abs=1.5)


class TestLimitsOfTheGains:
    @pytest.mark.parametrize("name", ["SGP", "SGI", "SGV", "SGVF", "SGAF"])
    def test_the_largest_value_is_taken_and_one_more_is_not(self, name: str) -> None:
        session = Session()
        session.ok(f"1{name}2800000")
        assert session.query(f"1{name}") == f"1{name}2800000"
        assert session.error(f"1{name}2800000.1") == "INVALID DATA-FIELD 1"
        assert session.error(f"1{name}-1") == "INVALID DATA-FIELD 1"
        session.ok("DRIVE10", "COMEXC1", "GO1")
        session.advance(2)
        assert_sound(session)

    @settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
    @given(
        values=st.tuples(*[st.sampled_from(["0", "0.00000001", "0.5", "15", "300", "99999", "2800000"])] * 5),
        smper=st.sampled_from(["0", "4000"]),
        soffs=st.sampled_from(["0", "-10", "3.3"]),
        kind=st.sampled_from(["velocity_drive", "torque_drive"]),
    )
    def test_no_report_ever_shows_what_is_no_number(
        self, values: tuple[str, ...], smper: str, soffs: str, kind: str
    ) -> None:
        session = Session(f"[axis1.plant]\nkind = '{kind}'\n")
        names = ("SGP", "SGI", "SGV", "SGVF", "SGAF")
        session.ok(*(f"1{name}{text}" for name, text in zip(names, values, strict=True)))
        session.ok(f"1SMPER{smper}", f"1SOFFS{soffs}", "LH0,0", "DRIVE10", "COMEXC1", "D20000", "V5", "A100", "GO1")
        for _ in range(4):
            session.advance(0.5)
            assert_sound(session)
        assert smper == "0" or session.axis_bit(23) or abs(session.number("axis1.position.error")) <= 4000


def assert_sound(session: Session) -> None:
    """Every report of the axis is made of digits, and the output stays within its range."""
    for report in REPORTS:
        session.read()
        text = session.ask(f"!{report}").upper()
        assert "NAN" not in text
        assert "INF" not in text
        assert text.endswith("\r\n> ")
    assert abs(session.number("axis1.dac")) <= 10.0

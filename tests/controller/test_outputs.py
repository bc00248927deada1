"""Output functions, output on position, thumbwheels."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.controller.programs.program_select import line_weight
from emulator.controller.wires.analog import code_of
from emulator.controller.wires.thumbwheels import read_digits
from tests.controller.session import Session


def test_sinking_outputs_are_those_on_unless_outlvl_turns_them() -> None:
    session = Session()
    session.ok("OUT1100", "OUTLVLX1X1")
    assert str(session.signal("outputs"))[:4] == "1100"
    assert str(session.signal("outputs.sinking"))[:4] == "1001"
    assert session.signal("output.1") is True
    assert session.signal("output.3") is False


def test_fault_output_follows_a_drive_fault() -> None:
    session = Session()
    session.ok("DRIVE1", "OUTFNC1-F", "OUTFEN1", "INFEN1")
    assert session.signal("output.1") is False
    session.set_wire("axis1.drive_fault", closed=True)
    assert session.signal("output.1") is True


def test_limit_output_shows_its_axis() -> None:
    session = Session(COMEXC=1, COMEXL="11")
    session.ok("DRIVE11", "OUTFNC1-1D", "OUTFNC2-2D", "OUTFNC3-D", "OUTFEN1", "MC11", "GO1", wait_s=0.3)
    session.set_wire("axis1.positive_limit", closed=False)
    assert str(session.signal("outputs"))[:3] == "101"


def test_position_error_output() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC1-G", "OUTFEN1", "SMPER10", "SGP0", "D40000", "GO1", wait_s=1)
    assert session.signal("output.1") is True
    session.ok("DRIVE1")
    assert session.signal("output.1") is False


def test_moving_output_waits_for_the_target_zone() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC1-B", "OUTFEN1", "STRGTE1", "STRGTD0", "STRGTT300", "SGP.01", "SMPER0", "GO1")
    session.until_rest()
    assert session.signal("output.1") is True
    session.advance(1)
    assert session.signal("output.1") is False


def on_times_s(session: Session, number: int, *, until_s: float) -> list[float]:
    """When an output came on, to a millisecond."""
    times, was_on = [], bool(session.signal(f"output.{number}"))
    for step in range(int(until_s * 1000)):
        session.advance(0.001)
        is_on = bool(session.signal(f"output.{number}"))
        if is_on and not was_on:
            times.append(step / 1000)
        was_on = is_on
    return times


def test_output_on_position_pulses_once_a_passing() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC25-H", "OUTFEN1", "OUTPA1,0,4000,30", "MC1", "A100", "V1", "SGP5", "SGVF20", "GO1")
    times = on_times_s(session, 25, until_s=2)
    # constant 4000 counts/s after a ramp of 10 ms, which covers half of what full speed would
    assert times == [pytest.approx(1.005, abs=0.01)]
    assert session.signal("output.25") is False


def test_the_passing_has_an_exact_time() -> None:
    """It lies in the servo sample in which the counter reached the position."""
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC25-H", "OUTFEN1", "OUTPA1,0,4000,30", "MC1", "A100", "V5", "GO1")
    assert session.number("output_on_position.1.time") == -1
    while session.number("axis1.position.encoder") < 4000:
        session.emulator.advance_to(session.now_ns + 280_000 - session.now_ns % 280_000)
    sample_s = session.now_ns / 1e9
    session.advance(0.01)
    assert sample_s - 280e-6 <= session.number("output_on_position.1.time") <= sample_s
    assert session.signal("output.25") is True
    end_s = session.number("output_on_position.1.time") + 0.03
    session.advance(end_s - session.now_ns / 1e9 - 1e-6)
    assert session.signal("output.25") is True
    session.advance(2e-6)
    assert session.signal("output.25") is False


def test_incremental_output_on_position_repeats() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC25-H", "OUTFEN1", "OUTPA1,1,1000,50", "MC1", "A100", "V1", "SGP5", "SGVF20", "GO1")
    times = on_times_s(session, 25, until_s=1.9)
    assert times == [pytest.approx(0.255 + 0.25 * n, abs=0.01) for n in range(7)]


def test_a_wait_does_not_disarm_output_on_position() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "OUTFNC25-H", "OUTFEN1", "OUTPA1,0,4000,500", "MC1", "A100", "V1", "GO1")
    session.ask("WAIT(1PC>1000)", wait_s=1.3)
    assert session.signal("output.25") is True


def test_outpb_belongs_to_axis_two() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE11", "OUTFNC26-H", "OUTFEN1", "OUTPB1,0,2000,0", "D4000,4000", "GO1", wait_s=2)
    assert session.signal("output.26") is False
    session.ok("GOX1", wait_s=2)
    assert session.signal("output.26") is True


class TestThumbwheels:
    @settings(max_examples=8, deadline=None)
    @given(st.integers(-99_999_999, 99_999_999))
    def test_what_is_dialled_is_read(self, value: int) -> None:
        session = Session()
        session.ok("INSTW1,1-4,5", "OUTTW1,1-3,4,5")
        session.unit.do("dial_thumbwheels", set_number=1, value=value)
        session.ask("VAR1=TW1", wait_s=0.2)
        assert float(session.look("VAR1").removeprefix("VAR1=")) == value
        assert "1" not in str(session.signal("outputs"))

    def test_two_digits_at_once(self) -> None:
        session = Session()
        session.ok("INSTW2,1-8,9", "OUTTW2,5-6,0,5")
        session.unit.do("dial_thumbwheels", set_number=2, value=-12_345_678)
        session.ask("VAR1=TW2", wait_s=0.2)
        assert session.look("VAR1") == "VAR1=-12345678.0"

    def test_reading_takes_a_strobe_a_digit(self) -> None:
        session = Session()
        session.ok("INSTW1,1-4,5", "OUTTW1,1-3,4,50")
        taken = session.timed("VAR1=TW1", wait_s=1)
        assert 8 * 50e6 <= taken[-1].at_ns <= 8 * (50e6 + 2 * 2.24e6)

    def test_kill_switches_the_strobes_off(self) -> None:
        session = Session()
        session.ok("INSTW1,1-4,5", "OUTTW1,1-3,4,50")
        session.ask("VAR1=TW1", wait_s=0.2)
        assert session.signal("output.4") is True
        session.ask("!K")
        assert "1" not in str(session.signal("outputs"))

    def test_data_valid_is_waited_for(self) -> None:
        session = Session()
        session.ok("INPLC1,1-4,0,6", "OUTPLC1,1-1,0,10", "VAR1=1")
        session.ask("VAR1=TW5", wait_s=1)
        assert session.system_bit(17)
        session.ask("!INEN1XXXX1", wait_s=0.1)
        assert session.look("VAR1") == "VAR1=+1.0"
        assert not session.system_bit(17)


def test_digits_highest_first_lowest_line_worth_one() -> None:
    assert read_digits("1000" + "0100", [1, 2, 3, 4, 5, 6, 7, 8]) == "21"
    assert read_digits("1001", [1, 2, 3, 4]) == "9"
    assert read_digits("1111", [1, 2, 3, 4]) == "0"


def test_bcd_weights() -> None:
    assert [line_weight(place) for place in range(8)] == [1, 2, 4, 8, 10, 20, 40, 80]


@pytest.mark.parametrize(("volts", "code"), [(0.0, 0), (0.2, 20), (0.9, 92), (1.25, 128), (2.3, 235), (2.5, 255)])
def test_the_converter_has_256_steps_over_2_5_volts(volts: float, code: int) -> None:
    assert code_of(volts) == code


def test_analog_action_and_its_range() -> None:
    session = Session()
    session.unit.do("set_analog", channel=2, volts=0.5)
    assert session.query("TANV") == "TANV1.250,0.498,1.250"
    with pytest.raises(ValueError, match=r"2\.5 V"):
        session.unit.do("set_analog", channel=1, volts=3.0)
    with pytest.raises(KeyError):
        session.unit.do("set_analog", channel=4, volts=1.0)

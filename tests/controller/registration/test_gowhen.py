"""GOWHEN and TRGFN: when a start that waits begins, and what ends the waiting."""

from __future__ import annotations

import pytest

from tests.controller.session import ONE_UPDATE_EACH_NS, SYSTEM_NS, TRAJECTORY_NS, S, Session, both_on

EVERYTHING = "ERROR" + "1" * 16


def mover(*commands: str) -> Session:
    """Both axes on; axis 2 is the one that others wait for."""
    return both_on("COMEXC1", EVERYTHING, "SMPER0,0", "A100,100", "V2,1", "D4000,40000", *commands)


def begin_ns(session: Session, axis: int = 1, *, timeout_s: float = 10.0) -> int:
    """Run until the profile of an axis begins, to the nearest servo sample."""
    end_ns = session.now_ns + round(timeout_s * S)
    while not session.signal(f"axis{axis}.moving"):
        assert session.now_ns < end_ns
        session.emulator.advance_to(session.now_ns + 280_000)
    return session.now_ns


@pytest.mark.parametrize(
    ("condition", "signal"),
    [
        ("2PC>=10000", "axis2.position.commanded"),
        ("2PE>=10000", "axis2.position.encoder"),
        ("2FB=10000", "axis2.position.actual"),
        ("2FB>9999.5", "axis2.position.actual"),
    ],
)
def test_a_position_is_seen_within_a_system_update(condition: str, signal: str) -> None:
    session = mover(f"GOWHEN({condition})", "GO11")
    assert session.axis_bit(26)
    before = -1.0
    while not session.signal("axis1.moving"):
        before = session.number(signal)
        session.emulator.advance_to(session.now_ns + SYSTEM_NS)
    assert before < 10_000 <= session.number(signal)
    assert session.number(signal) - before <= 4000 * SYSTEM_NS / S + 1
    assert not session.axis_bit(26)
    assert not session.error_bit(14)


def test_a_position_from_above() -> None:
    session = mover("D4000,-40000", "GOWHEN(2PC<-8000)", "GO11")
    begin_ns(session)
    assert -8000 - 4000 * SYSTEM_NS / S - 1 <= session.position(2) < -8000


def test_the_ani_position() -> None:
    session = Session("[options]\nani = true\n[axis2.ani]\nvolts_per_rev = 0.5\n")
    session.ok("DRIVE11", "COMEXC1", "SMPER0,0", "V2,1", "A100,100", "D4000,40000", "GOWHEN(2PANI>2000)", "GO11")
    begin_ns(session)
    assert 2000 < session.number("axis2.position.ani") <= 2000 + 0.5 * 819.2 * SYSTEM_NS / S + 2


@pytest.mark.parametrize("ms", [1, 7, 250])
def test_a_time_counts_from_the_go(ms: int) -> None:
    session = mover(f"GOWHEN(T={ms})")
    session.advance(0.5)
    session.ok("GO1")
    start_ns = session.now_ns
    assert session.axis_bit(26)
    session.emulator.advance_to(start_ns + ms * 1_000_000 - 1)
    assert session.axis_bit(26)
    session.emulator.advance_to(start_ns + ms * 1_000_000)
    assert not session.axis_bit(26)
    session.advance(TRAJECTORY_NS / S)
    assert session.axis_bit(1)


def test_inputs_are_seen_debounced() -> None:
    session = mover("GOWHEN(IN.2=b1)", "GO1")
    at_ns = session.now_ns
    session.unit.do("set_wire", name="input.2", closed=True)
    assert begin_ns(session) - at_ns <= 4_000_000 + ONE_UPDATE_EACH_NS + SYSTEM_NS


def test_variables_are_read_when_the_condition_is_given() -> None:
    session = mover("VAR1=5000", "GOWHEN(2PC>(VAR1+1000))", "VAR1=0", "GO11")
    begin_ns(session)
    assert session.position(2) > 6000


def test_without_a_digit_the_position_is_of_the_axis_that_waits() -> None:
    session = mover("2GOWHEN(PC>100)", "GOX1")
    assert session.axis_bit(26, 2)
    assert not session.axis_bit(26, 1)


def test_scaled_positions() -> None:
    session = mover("SCALE1", "SCLD4000,4000", "SCLV4000,4000", "SCLA4000,4000", "D1,10", "GOWHEN(2PC>2.5)", "GO11")
    begin_ns(session)
    assert session.look("!2TPC") >= "2TPC+2.5"


def test_both_conditions_of_one_line() -> None:
    session = mover("GOWHEN(T=50),(1PC>2000)", "GO11")
    assert session.axis_bits(1)[25] + session.axis_bits(2)[25] == "11"
    session.advance(0.06)
    assert session.axis_bits(1)[25] + session.axis_bits(2)[25] == "01"
    begin_ns(session, 2)
    assert session.position(1) > 2000


def test_already_true() -> None:
    session = mover("GOWHEN(1PC>=0)", "GO1")
    assert session.error_bit(14)
    assert session.axis_bit(1)
    session.until_rest()
    session.ok("GO1")
    assert not session.error_bit(14), "the condition was for one GO, and the next clears the bit"


@pytest.mark.parametrize("ending", ["!S", "!K", "!1S", "!1K", "DRIVE0"])
def test_what_ends_the_waiting(ending: str) -> None:
    session = mover("GOWHEN(2PC>10000)", "GO1")
    session.ok(ending)
    assert not session.axis_bit(26)
    session.ok("DRIVE11", "GOX1")
    session.until_rest(2)
    assert session.position(1) == 0
    session.ok("D100", "GO1")
    assert session.axis_bit(1), "nothing is left of the condition"


def test_a_condition_that_no_go_has_used_is_forgotten_by_a_kill() -> None:
    session = mover("GOWHEN(2PC>10000)", "!1K", "GO1")
    assert session.axis_bit(1)


def test_a_new_go_takes_the_place_of_one_that_waits() -> None:
    session = mover("GOWHEN(2PC>10000)", "GO1", "D777", "GO1")
    assert not session.axis_bit(26)
    session.until_rest()
    session.ok("GOX1")
    session.until_rest(2)
    assert session.position(1) == 777


def test_a_move_that_waits_may_change_one_that_runs() -> None:
    session = mover("MC10", "V1,1", "GO1", "V2", "GOWHEN(1PC>8000)", "GO1")
    assert session.axis_bit(1)
    assert session.axis_bit(26)
    session.advance(1.0)
    assert session.number("axis1.velocity.commanded") == 4000
    session.advance(1.2)
    assert session.number("axis1.velocity.commanded") == 8000


def test_the_go_holds_the_buffer_with_comexc0() -> None:
    session = mover("COMEXC0", "GOWHEN(T=500)")
    assert session.ask("GO1", wait_s=0.4) == ""
    assert session.ask("", wait_s=1.5).startswith("\r\n> ")


def test_in_a_program_the_next_commands_run_on() -> None:
    session = mover()
    for text in ("DEF PROG", "GOWHEN(2PC>10000)", "GO11", "VAR5=7", "END"):
        session.ask(text)
    session.ask("PROG")
    assert session.look("VAR5") == "VAR5=+7.0"
    assert session.axis_bit(26)
    begin_ns(session)


def test_the_unit_is_busy_while_a_start_waits() -> None:
    """So that a paced emulator looks at what comes by itself."""
    session = mover("GOWHEN(2PC>10000)", "GO1")
    assert session.unit.controller.busy
    session.ok("!1K")
    session.advance(0.1)
    assert not session.unit.controller.busy


@pytest.mark.parametrize("after_ns", [0, 1, 139_999, 1_119_999, 2_000_000])
def test_a_trigger_lets_a_start_go_at_the_next_update(after_ns: int) -> None:
    session = mover("INFNC25-H", "INFEN1", "1TRGFNA1", "GO1")
    session.advance(0.1)
    edge_ns = session.now_ns + after_ns
    session.unit.do("press_trigger", trigger="A", at=edge_ns / S)
    assert begin_ns(session) - edge_ns <= ONE_UPDATE_EACH_NS
    assert session.number("capture.a.time") == pytest.approx(edge_ns / S, abs=1e-12)
    assert session.query("1TRGFNA") == "1TRGFNA00"


def test_a_trigger_before_the_go_is_not_the_one_waited_for() -> None:
    session = mover("INFNC25-H", "INFEN1", "1TRGFNA1")
    session.unit.do("press_trigger", trigger="A")
    session.advance(0.1)
    session.ok("GO1")
    assert session.axis_bit(26)


def test_trigger_and_condition_together() -> None:
    session = mover("INFNC25-H", "INFEN1", "1TRGFNA1", "GOWHEN(T=200)", "GO1")
    session.unit.do("press_trigger", trigger="A")
    session.advance(0.1)
    assert session.axis_bit(26)
    session.advance(0.15)
    assert session.axis_bit(1)


@pytest.mark.parametrize(
    ("parameters", "error"),
    [
        ({"trigger": "C"}, KeyError),
        ({"trigger": "A", "at": 0.001}, ValueError),
        ({"trigger": "A", "hold": 0.0}, ValueError),
    ],
)
def test_a_trigger_that_cannot_be_pressed(parameters: dict[str, str | float], error: type[Exception]) -> None:
    session = mover()
    session.advance(0.1)
    with pytest.raises(error):
        session.unit.do("press_trigger", **parameters)

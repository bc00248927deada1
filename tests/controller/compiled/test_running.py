"""What happens to a profile under way: stops, limits, outputs, programs that start it, segments that wait."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from emulator.controller import Controller, dispatch
from emulator.controller.compiled import holds
from emulator.controller.compiled.kinds import Compilation
from protocol.command import Command
from tests.controller.compiled.rig import COUNTS, compiled, define, unit_with
from tests.controller.session import MS, ONE_UPDATE_EACH_NS, SYSTEM_NS, TRAJECTORY_NS, S

ENDLESS = ("PLOOP", "A10", "AD10", "V2", f"D{4 * COUNTS}", "GOBUF1", "PLN1")
MOVE = ("A10", "AD10", "V1", "D4000", "VF0", "GOBUF1")


@pytest.mark.parametrize(("command", "deceleration"), [("!S1", 5.0), ("!K1", 100.0)])
def test_stop_and_kill_brake_with_their_own_ramps(command: str, deceleration: float) -> None:
    session = compiled(*ENDLESS, COMEXC="1")
    session.ok("AD5", "LHAD100", "PRUN P")
    session.advance(1.0)
    before, start_ns = session.position(), session.now_ns
    session.ok(command)
    session.until_rest()
    braking_s = 2 / deceleration
    assert (session.now_ns - start_ns) / S == pytest.approx(braking_s, abs=ONE_UPDATE_EACH_NS / S)
    assert session.position() - before == pytest.approx(
        2 * COUNTS * braking_s / 2, abs=1 + 2 * COUNTS * ONE_UPDATE_EACH_NS / S
    )
    session.ok("PUCOMP P")


def test_a_stop_of_one_axis_leaves_the_other_its_profile() -> None:
    session = compiled("A10,10", "V1,1", "D40000,40000", "VF0,0", "GOBUF11", COMEXC="1")
    session.ok("PRUN P")
    session.advance(1.0)
    session.ok("!S1")
    session.until_rest(2)
    assert session.position(1) < 6000
    assert session.position(2) == 40000


def test_a_limit_stops_the_profile() -> None:
    session = compiled(*ENDLESS, COMEXC="1")
    session.ok("PRUN P")
    session.advance(1.0)
    session.set_wire("axis1.positive_limit", closed=False)
    session.until_rest()
    assert session.axis_bit(15)
    assert session.query("TSEG") == "TSEG241"
    session.ok("PUCOMP P")


def test_prun_holds_the_buffer_until_the_profile_is_over() -> None:
    session = compiled(*MOVE)
    answers = session.timed("PRUN P", wait_s=2.0)
    assert [answer.text for answer in answers] == ["\r\n> "]
    assert answers[0].at_ns == pytest.approx(1100 * MS, abs=ONE_UPDATE_EACH_NS)


def test_with_comexc1_the_buffer_goes_on() -> None:
    session = compiled(*MOVE, COMEXC="1")
    assert session.ask("PRUN P") == "\r\n> "
    assert session.axis_bit(1)


def test_prun_in_a_program() -> None:
    session = compiled(*MOVE)
    define(session, "PRUN P", "PRUN P", "OUT1", name="MAIN")
    session.unit.send(b"MAIN\r")
    session.advance(2.1)
    assert session.number("output.1") == 0
    session.advance(0.2)
    assert session.position() == 8000
    assert session.number("output.1") == 1


def test_a_compiled_program_can_still_be_run_as_a_program() -> None:
    session = unit_with("V3", "GOBUF1", "V4")
    assert "NOT DEFINING A PATH" in session.ask("RUN P")
    assert session.look("1V") == "1V4.0000"


@pytest.mark.parametrize("delay_ms", range(0, 12))
def test_outputs_switch_inside_the_window(delay_ms: int) -> None:
    """From 3/4 of a system update before the segment begins to 1/4 after it (-1.5 .. +0.5 ms at 2 ms)."""
    session = compiled(
        "POUTA1",
        "A10",
        "AD10",
        "V1",
        f"D{2000 + 40 * delay_ms}",
        "GOBUF1",
        "POUTA01",
        "VF0",
        "D4000",
        "GOBUF1",
        COMEXC="1",
    )
    session.advance(delay_ms * MS / S)
    session.ok("PRUN P")
    begin_ns = session.unit.controller.engine.next_trajectory_ns
    first_s = 0.1 + ((2000 + 40 * delay_ms) / COUNTS - 0.05)
    for output, segment_ns in ((1, begin_ns), (2, begin_ns + first_s * S)):
        while not session.number(f"output.{output}"):
            session.emulator.advance_to(session.now_ns + TRAJECTORY_NS // 8)
        early = segment_ns - session.now_ns
        assert -0.25 * SYSTEM_NS - TRAJECTORY_NS // 8 <= early <= 0.75 * SYSTEM_NS
    assert session.number("output.1") == 0


def test_each_pass_of_a_loop_switches_its_outputs() -> None:
    session = compiled("PLOOP3", "POUTA1", *MOVE, "POUTA0", *MOVE, "PLN1", COMEXC="1")
    session.ok("PRUN P")
    seen = []
    for _ in range(6):
        session.advance(0.55)
        seen.append(session.number("output.1"))
        session.advance(0.55)
    assert seen == [1, 0, 1, 0, 1, 0]


def test_outputs_of_a_stopped_profile_stay() -> None:
    session = compiled("POUTA1", *MOVE, "POUTA0", *MOVE, COMEXC="1")
    session.ok("PRUN P")
    session.advance(0.5)
    session.ok("!K1")
    session.advance(3.0)
    assert session.number("output.1") == 1


@pytest.mark.parametrize("pattern", ["POUT1", "POUTA1", "POUTA.1-1"])
def test_ways_to_write_a_pattern(pattern: str) -> None:
    session = compiled(pattern, *MOVE, COMEXC="1")
    session.ok("PRUN P")
    session.advance(0.01)
    assert session.number("output.1") == 1


class _Switch:
    """A condition that a test fulfils."""

    def __init__(self) -> None:
        self.release: Callable[[], None] | None = None
        self.cancelled = 0

    def begin(self, controller: Controller, axis_index: int, release: Callable[[], None]) -> None:
        self.release = release

    def cancel(self, controller: Controller, axis_index: int) -> None:
        self.cancelled += 1


@pytest.fixture
def switch(monkeypatch: pytest.MonkeyPatch) -> _Switch:
    """GOWHEN makes this condition for axis 1."""
    made = _Switch()

    def maker(compilation: Compilation, command: Command) -> Mapping[int, holds.SegmentHold]:
        return {0: made}

    monkeypatch.setitem(holds._makers, "GOWHEN", maker)
    monkeypatch.setitem(dispatch._handlers, "GOWHEN", lambda controller, command: None)
    return made


def test_a_segment_waits_at_rest_for_its_condition(switch: _Switch) -> None:
    controller_hold_program = (*MOVE, "GOWHEN(1PC>0)", "D-1000", "VF0", "GOBUF1")
    session = compiled(*controller_hold_program, COMEXC="1")
    session.ok("PRUN P")
    session.advance(5.0)
    assert session.position() == 4000
    assert switch.release is not None
    assert session.error("PRUN P") == "PATH ALREADY MOVING"
    switch.release()
    session.until_rest()
    assert session.position() == 3000


def test_a_segment_waits_in_motion_for_its_condition(switch: _Switch) -> None:
    session = compiled("V1", "MC1", "GOBUF1", "GOWHEN(1PC>0)", "MC0", "D4000", "VF0", "GOBUF1", COMEXC="1")
    session.ok("PRUN P")
    session.advance(3.0)
    before = session.position()
    assert before == pytest.approx(COUNTS * (3.0 - 0.05), abs=20)
    assert switch.release is not None
    switch.release()
    session.until_rest()
    assert session.position() - before == pytest.approx(4000, abs=1 + COUNTS * ONE_UPDATE_EACH_NS / S)


def test_a_condition_of_a_stopped_profile_is_forgotten(switch: _Switch) -> None:
    session = compiled(*MOVE, "GOWHEN(1PC>0)", "D-1000", "VF0", "GOBUF1", COMEXC="1")
    session.ok("PRUN P")
    session.advance(2.0)
    session.ok("!K1")
    session.advance(0.1)
    assert switch.cancelled == 1
    assert switch.release is not None
    switch.release()
    session.advance(1.0)
    assert session.position() == 4000


def test_gowhen_on_the_other_axis() -> None:
    session = compiled("V1", "MC1", "GOBUF1", "GOWHEN(2PC>=8000)", "MC0", "D4000", "VF0", "GOBUF1", COMEXC="1")
    session.ok("PRUN P")
    session.advance(2.0)
    assert session.axis_bit(26)
    session.ok("2D8000", "2V8", "2A100", "2GO1")
    session.until_rest(2)
    here = session.position()
    session.advance(0.1)
    assert not session.axis_bit(26)
    session.until_rest()
    assert session.position() - here == pytest.approx(4000, abs=1 + COUNTS * 2 * ONE_UPDATE_EACH_NS / S)
    session.ok("PUCOMP P")


def test_a_time_begins_anew_at_each_pass() -> None:
    session = compiled("PLOOP3", "GOWHEN(T=500)", *MOVE, "PLN1", COMEXC="1")
    session.ok("PRUN P")
    for passed in range(3):
        session.advance(0.45)
        assert session.position() == passed * 4000
        session.until_rest() if passed == 2 else session.advance(1.165)
    assert session.position() == 12000


def test_a_trigger_lets_each_segment_go() -> None:
    session = unit_with("PLOOP2", "1TRGFNA1", *MOVE, "PLN1", COMEXC="1")
    assert session.error("PCOMP P") == "INVALID CONDITIONS FOR COMMAND"
    session.ok("INFNC25-H", "INFEN1", "PCOMP P", "PRUN P")
    for passed in (1, 2):
        session.advance(0.5)
        assert session.position() == 4000 * (passed - 1)
        session.unit.do("press_trigger", trigger="A")
        session.advance(1.5)
        assert session.position() == 4000 * passed
    assert not session.axis_bit(1)


def test_a_stop_forgets_what_a_segment_waits_for() -> None:
    session = compiled(*MOVE, "GOWHEN(2PC>1)", "GOBUF1", "VF0", "GOBUF1", COMEXC="1")
    session.ok("PRUN P")
    session.advance(2.0)
    assert session.axis_bit(26)
    session.ok("!K1")
    session.advance(0.1)
    assert not session.axis_bit(26)
    session.ok("2GO1")
    session.until_rest(2)
    assert session.position() == 4000

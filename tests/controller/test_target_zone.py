"""The target zone: when a move is finished with STRGTE1, what TSTLT measures, what happens when it is never reached."""

from __future__ import annotations

import numpy as np
import pytest

from emulator.engine.trace import Source
from tests.controller.session import OK, SYSTEM_NS, S, Session

QUICK = ("A500", "AD500", "V5", "D8000")
PROFILE_S = 5 / 500 + 2 / 5

OSCILLATING = "[axis1.plant]\nkind = 'velocity_drive'\nloop_time_constant_s = 0.02\nmax_acceleration_rev_s2 = inf\n"
"""With SGP 10: Kv 400 on a lag of 20 ms, natural frequency 22 Hz, and the error rings through any zone many times."""


def zone_unit(*commands: str, machine: str = "") -> Session:
    session = Session(machine)
    session.ok("DRIVE10", "SMPER0", "STRGTE1", "STRGTD5", *QUICK, *commands)
    return session


def settling_ms(session: Session) -> int:
    return int(session.look("!1TSTLT").removeprefix("1TSTLT"))


def test_settling_of_a_first_order_lag() -> None:
    """The error left when the profile ends decays with the slow pole p of tau s2 + s + Kv, Kv = SGP K = 20 1/s, tau =
    2.3 ms: to 5.5 counts it takes ln(e0 / 5.5) / p. The velocity zone is wide: the error alone decides."""
    session = zone_unit("STRGTV200")
    engine = session.unit.controller.engine
    engine.scope.arm([Source("commanded_counts", 0, "feedback_counts"), Source("profile_active", 0)], rows=7000)
    session.ok("GO1", wait_s=2)
    error, active = engine.scope.read().columns
    at_end = float(error[int(np.flatnonzero(active)[-1]) + 1])
    pole = (1 - np.sqrt(1 - 4 * 20 * 0.0023)) / (2 * 0.0023)
    assert settling_ms(session) == pytest.approx(1000 * np.log(at_end / 5.5) / pole, abs=6)


def test_the_prompt_comes_with_the_zone() -> None:
    session = zone_unit()
    stamps = session.timed("GO1:1TAS.24", wait_s=2)
    assert "".join(stamp.text for stamp in stamps) == f"{OK}*1\r{OK}"
    assert stamps[0].at_ns / S - PROFILE_S == pytest.approx(settling_ms(session) / 1000, abs=0.004)


def test_both_criteria() -> None:
    """A wide distance does not help while the axis is too fast, a wide velocity not while it is too far."""
    distances = []
    for wide in ("STRGTD100000", "STRGTV200"):
        session = zone_unit("STRGTV0.05", wide)
        session.ok("GO1", wait_s=2)
        distances.append(settling_ms(session))
    assert min(distances) > 20


def test_settling_time_counts_up_to_the_last_entry() -> None:
    """A ringing axis runs through the zone: the move is over at the first crossing, TSTLT tells the last entry.

    Checked against the scope's recording of error and velocity at system updates.
    """
    session = zone_unit("STRGTV200", "STRGTD20", "STRGTT3000", "SGP10", machine=OSCILLATING)
    engine = session.unit.controller.engine
    session.emulator.advance_to(engine.next_system_update_ns)
    columns = [Source("commanded_counts", 0, "feedback_counts"), Source("profile_active", 0)]
    engine.scope.arm(columns, rows=1200, every=8)
    stamps = session.timed("GO1", wait_s=3.5)
    trace = engine.scope.read()
    error, active = trace.columns
    over = int(np.flatnonzero(active)[-1]) + 1
    outside = np.flatnonzero(np.abs(error[over:]) > 20)
    assert np.count_nonzero(np.diff(outside) > 1) >= 2, "the error leaves the zone and comes back more than once"
    last_entry_s = (outside[-1] + 1) * SYSTEM_NS / S
    assert settling_ms(session) / 1000 == pytest.approx(last_entry_s, abs=2 * SYSTEM_NS / S)
    assert stamps[-1].at_ns / S - PROFILE_S < last_entry_s - 0.01, "the prompt does not wait for it"


def test_leaving_later_than_the_time_out_does_not_count() -> None:
    session = zone_unit("STRGTT500")
    session.ok("GO1", wait_s=3)
    settled = settling_ms(session)
    session.ok("SOFFS0.5", wait_s=2)
    assert not session.axis_bit(24), "the zone is live"
    session.ok("SOFFS0", wait_s=2)
    assert session.axis_bit(24)
    assert settling_ms(session) == settled


def test_never_settling() -> None:
    session = zone_unit("SOFFS0.5", "STRGTT300", "ERROR.11-1")
    stamps = session.timed("GO1", wait_s=2)
    assert stamps[-1].at_ns / S - PROFILE_S == pytest.approx(0.3, abs=0.005)
    assert (session.axis_bit(24), session.axis_bit(25), session.error_bit(11)) == (False, True, True)
    assert not session.axis_bit(13), "the drive stays on"
    assert settling_ms(session) == 0


def test_without_error_bit_commands_go_on() -> None:
    session = zone_unit("SOFFS0.5", "STRGTT300")
    stamps = session.timed("GO1:GO1:1TPC", wait_s=4)
    assert stamps[-1].text.endswith(OK)
    assert session.position() == 16_000
    assert not session.error_bit(11)


def test_errorp_is_called_and_the_program_goes_on() -> None:
    """ER 11 is a GOSUB: the program named by ERRORP clears the bit with STRGTE0, and the interrupted one goes on."""
    session = zone_unit("STRGTT300", "ERROR.11-1")
    for line in ("DEF FIX", "VAR1=VAR1+1", "SOFFS0", "1STRGTE0", "END", "DEF MAIN", "SOFFS0.5", "GO1", "VAR2=1", "END"):
        session.ask(line)
    session.ok("ERRORP FIX", "VAR1=0", "VAR2=0")
    session.ask("RUN MAIN", wait_s=5)
    assert session.look("VAR1") == "VAR1=+1.0"
    assert session.look("VAR2") == "VAR2=+1.0"


def test_only_the_next_go_inside_the_zone_clears() -> None:
    session = zone_unit("SOFFS0.5", "STRGTT300", "ERROR.11-1")
    session.ok("GO1", wait_s=2)
    assert session.axis_bit(25)
    session.ok("SOFFS0", wait_s=2)
    assert session.axis_bit(25), "coming home late does not undo it"
    assert session.error_bit(11)
    session.ok("GO1", wait_s=2)
    assert not session.axis_bit(25)
    assert not session.error_bit(11)


def test_comexc1_does_not_wait_but_settles_all_the_same() -> None:
    session = zone_unit("COMEXC1")
    stamps = session.timed("GO1", wait_s=0.1)
    assert stamps[-1].at_ns == 0
    session.advance(2)
    assert settling_ms(session) > 20


def test_a_move_of_the_other_axis_does_not_disturb() -> None:
    session = Session()
    session.ok("DRIVE11", "SMPER0,0", "STRGTE11", "STRGTD5,5", "A500,500", "V5,1", "D8000,8000", "COMEXC1", "GO11")
    session.advance(4)
    first, second = (int(value) for value in session.look("TSTLT").removeprefix("TSTLT").split(","))
    assert first > second > 0


def test_the_velocity_zone_is_in_the_unit_of_the_feedback() -> None:
    """STRGTV1: a revolution of ERES counts a second, with ANI feedback a volt a second."""
    session = Session("[options]\nani = true\n")
    axes = session.unit.controller.engine.memory.axes
    assert axes["target_velocity"][0] == 4000
    session.ok("ERES8000")
    assert axes["target_velocity"][0] == 8000
    session.ok("SFB2")
    assert axes["target_velocity"][0] == 819
    session.ok("SFB1")
    assert axes["target_velocity"][0] == 8000

"""Debounce, levels and functions of the programmable inputs, by wires in virtual time."""

from __future__ import annotations

import pytest

from emulator.engine import Event
from tests.controller.session import OK, SYSTEM_NS, S, Session

WIRES = {"general": ("input.3", 3), "trigger": ("trigger.b", 26)}


def close(session: Session, wire: str, *, closed: bool = True) -> None:
    session.unit.do("set_wire", name=wire, closed=closed)


def recognised_after_ns(session: Session, wire: str, number: int) -> int:
    """Time from the change of a contact until IN shows it, looked at every system update."""
    start_ns = session.now_ns
    close(session, wire)
    while session.signal("inputs")[number - 1] == "0":  # type: ignore[index]
        assert session.now_ns - start_ns < S
        session.emulator.advance_to(session.unit.controller.engine.next_system_update_ns)
    return session.now_ns - start_ns


@pytest.mark.parametrize("kind", WIRES)
@pytest.mark.parametrize("debounce_ms", [1, 4, 7, 24, 250])
@pytest.mark.parametrize("ssfr", [1, 4])
def test_an_input_must_keep_its_state_for_indeb(kind: str, debounce_ms: int, ssfr: int) -> None:
    session = Session(INDEB=f"{debounce_ms},{debounce_ms}", SSFR=ssfr)
    session.advance(0.01)
    period_ns = session.unit.controller.engine.rates.system_ns
    wire, number = WIRES[kind]
    whole_updates_ns = -(-debounce_ms * 1_000_000 // period_ns) * period_ns
    taken_ns = recognised_after_ns(session, wire, number)
    assert whole_updates_ns < taken_ns <= whole_updates_ns + period_ns


def test_a_shorter_pulse_is_not_seen() -> None:
    session = Session(INDEB="50,50")
    close(session, "input.1")
    session.advance(0.045)
    close(session, "input.1", closed=False)
    session.advance(0.3)
    assert session.query("TIN.1") == "0"


def test_a_bouncing_contact_counts_from_its_last_change() -> None:
    session = Session(INDEB="20,20")
    for _ in range(5):
        close(session, "input.1")
        session.advance(0.01)
        close(session, "input.1", closed=False)
        session.advance(0.01)
    assert session.query("TIN.1") == "0"
    close(session, "input.1")
    session.advance(0.02)
    assert session.query("TIN.1") == "0"
    session.advance(0.01)
    assert session.query("TIN.1") == "1"


def test_contacts_at_power_up_count_at_once() -> None:
    session = Session("[wires]\ninputs = [2, 26]\n", INDEB="250,250")
    assert session.query("TIN") == "TIN0100_0000_0000_0000_0000_0000_01"


@pytest.mark.parametrize(
    ("contact", "bit"), [("auxiliary", 1), ("trigger", 2), ("axes_select", 3), ("velocity_select", 4), ("release", 5)]
)
def test_joystick_contacts_show_in_tino(contact: str, bit: int) -> None:
    session = Session()
    close(session, f"joystick.{contact}")
    session.advance(0.02)
    expected = "".join("1" if n in (bit, 6) else "0" for n in range(1, 9))
    assert session.query("TINO").replace("_", "") == f"TINO{expected}"


def test_the_wire_of_a_kill_input_acts_after_its_debounce() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "MC1", "INFNC4-C", "INFEN1", "GO1", wait_s=0.3)
    close(session, "input.4")
    session.advance(0.003)
    assert session.axis_bit(1)
    velocity = session.number("axis1.velocity.commanded")
    session.advance(0.1)
    assert velocity > 0
    assert not session.signal("axis1.moving")


def test_two_inputs_with_one_function_release_with_the_last() -> None:
    session = Session(ERROR="XXXXXX1")
    session.ok("INFNC1-F", "INFNC2-F", "INFEN1", "INEN11")
    assert session.error_bit(7)
    session.ok("INEN.1-0")
    assert session.error_bit(7)
    session.ok("INEN.2-0")
    assert not session.error_bit(7)


def test_a_held_kill_input_does_not_kill_again() -> None:
    session = Session(COMEXC=1)
    session.ok("DRIVE1", "MC1", "INFNC1-C", "INFEN1", "INEN1", "GO1", wait_s=0.2)
    assert session.axis_bit(1)


def test_kill_input_empties_the_buffer() -> None:
    session = Session(MC=0)
    session.ok("DRIVE1", "D40000", "INFNC1-C", "INFEN1")
    session.ask("GO1:OUT1", wait_s=0.2)
    session.ask("!INEN1", wait_s=1)
    assert session.look("!TOUT.1") == "0"


def test_pause_input_holds_a_program_between_commands() -> None:
    session = Session()
    session.ask("DEF P")
    for line in ("T.2", "OUT1", "END"):
        session.ask(line)
    session.ok("INFNC1-E", "INFEN1")
    session.ask("P", wait_s=0.05)
    session.ask("!INEN1", wait_s=1)
    assert session.look("!TOUT.1") == "0"
    session.ask("!INENE", wait_s=0.3)
    assert session.look("!TOUT.1") == "1"


def test_paused_continuous_motion_takes_its_speed_up_again() -> None:
    session = Session(COMEXC=1, COMEXR=1)
    session.ok("DRIVE1", "MC1", "V3", "INFNC1-E", "INFEN1", "GO1", wait_s=0.5)
    running = session.number("axis1.velocity.commanded")
    session.ok("!INEN1", wait_s=1)
    assert session.number("axis1.velocity.commanded") == 0
    session.ok("!INENE", wait_s=1)
    assert session.number("axis1.velocity.commanded") == running == 12_000


def test_a_stop_forgets_what_was_paused() -> None:
    session = Session(COMEXC=1, COMEXR=1)
    session.ok("DRIVE1", "MC1", "INFNC1-E", "INFEN1", "GO1", wait_s=0.5)
    session.ok("!INEN1", wait_s=1)
    session.ok("!S")
    session.ok("!PS", "!C", wait_s=0.5)
    assert not session.signal("axis1.moving")


def test_nothing_acts_while_the_unit_is_off() -> None:
    session = Session()
    session.ok("INFNC1-E", "INFEN1")
    session.unit.do("cut_power")
    close(session, "input.1")
    session.advance(0.1)
    session.unit.do("restore_power")
    session.read()
    assert not session.system_bit(13)
    assert session.ask("TIN.1") == "*1\r" + OK


def test_a_held_selection_repeats_its_program_and_ends_with_it() -> None:
    session = Session()
    for line in ("DEF P", "T.1", "VAR1=VAR1+1", "END"):
        session.ask(line)
    session.ok("INFNC1-PP", "INFEN1", "INSELP2,0", "!INEN1", wait_s=0.0)
    session.advance(1.05)
    session.ask("!INENE", wait_s=0.5)
    count = float(session.look("VAR1").removeprefix("VAR1="))
    assert 8 <= count <= 11
    session.advance(1)
    assert float(session.look("VAR1").removeprefix("VAR1=")) == count


def test_system_updates_pass_without_the_unit_being_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    session = Session(INDEB="250,250")
    close(session, "input.1")
    session.advance(0.01)
    engine = session.unit.controller.engine
    runs, run = [0], engine.run

    def counted(until_ns: int) -> Event:
        runs[0] += 1
        return run(until_ns)

    monkeypatch.setattr(engine, "run", counted)
    session.advance(1)
    assert runs[0] <= 3 < S // SYSTEM_NS

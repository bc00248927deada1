"""The [timing] table: a command acts and answers when its time has passed, of hosts and in programs alike."""

from __future__ import annotations

import pytest

from emulator.machine import Machine, MachineError
from tests.controller.session import MS, OK, SYSTEM_NS, Session, Stamped


def stamps(session: Session, text: str, *, wait_s: float = 1.0) -> list[Stamped]:
    return session.timed(text, wait_s=wait_s)


def test_commands_answer_at_once_by_default() -> None:
    assert stamps(Session(), "1TPE") == [(0, "*1TPE+0\r" + OK)]


def test_each_command_takes_the_usual_time_one_after_the_other() -> None:
    session = Session("[timing]\ncommand_us = 3000")
    assert stamps(session, "1TPE:V1:XYZZY") == [
        (3 * MS, "*1TPE+0\r" + OK),
        (6 * MS, OK),
        (9 * MS, "\r\n*UNDEFINED LABEL\r\r\n? "),
    ]


def test_single_commands_have_times_of_their_own() -> None:
    session = Session("[timing]\ncommand_us = 1000\n[timing.commands]\nTPE = 300\nV = 0")
    assert stamps(session, "1TPE:V1:A1") == [(300_000, "*1TPE+0\r" + OK + OK), (1_300_000, OK)]


def test_a_setting_acts_when_its_time_has_passed_and_no_earlier() -> None:
    session = Session("[timing.commands]\nVAR = 5000")
    session.unit.send(b"VAR1=7\r")
    session.emulator.advance_to(session.now_ns + 5 * MS - 1)
    assert session.unit.controller.variables.number(1) == 0
    session.emulator.advance_to(session.now_ns + 1)
    assert session.unit.controller.variables.number(1) == 7


def test_immediate_commands_jump_the_queue_and_take_their_time() -> None:
    session = Session("[timing]\ncommand_us = 10000\n[timing.commands]\nTPE = 2000")
    session.unit.take_output()
    start_ns = session.now_ns
    session.unit.send(b"V1\rV2\r!1TPE\r!2TPE\r")
    session.advance(1.0)
    assert [(output.at_ns - start_ns, output.data.decode()) for output in session.unit.take_output()] == [
        (2 * MS, "*1TPE+0\r" + OK),
        (4 * MS, "*2TPE+0\r" + OK),
        (10 * MS, OK),
        (20 * MS, OK),
    ]


def test_kill_ends_commands_that_had_not_their_time() -> None:
    session = Session("[timing]\ncommand_us = 10000\n[timing.commands]\nK = 0")
    session.unit.send(b"VAR1=1\rVAR1=2\r!K\r")
    session.advance(1.0)
    assert session.unit.controller.variables.number(1) == 0


def test_programs_take_the_same_times() -> None:
    session = Session("[timing.commands]\nVAR = 4000")
    for line in ("DEF P", "L10", "VAR1=VAR1+1", "LN", "END"):
        session.ask(line)
    session.ask("!1TPE")
    start_ns = session.now_ns
    session.unit.send(b"P\r")
    for count in range(1, 11):
        while session.unit.controller.variables.number(1) < count:
            session.emulator.advance_to(session.now_ns + 100_000)
        assert (session.now_ns - start_ns) // MS >= 4 * count
    assert session.now_ns - start_ns <= 10 * (4 * MS + SYSTEM_NS)


def test_a_loop_takes_its_time_every_round() -> None:
    session = Session("[timing.commands]\nGOTO = 10000")
    for line in ("DEF P", "$HERE", "VAR1=VAR1+1", "GOTO HERE", "END"):
        session.ask(line)
    session.ask("P", wait_s=1.0)
    assert 1.0 / (0.010 + 2 * SYSTEM_NS / 1e9) <= session.unit.controller.variables.number(1) <= 101


def test_the_realistic_preset_acts_at_system_updates_one_command_an_update() -> None:
    session = Session('[timing]\npreset = "realistic"')
    session.emulator.advance_to(session.unit.controller.engine.next_system_update_ns)
    outputs = stamps(session, "1TPE:V1:A1")
    assert [at_ns for at_ns, _ in outputs] == [SYSTEM_NS, 2 * SYSTEM_NS, 3 * SYSTEM_NS]


def test_given_keys_win_over_the_preset() -> None:
    timing = Machine.parse('[timing]\npreset = "realistic"\ncommand_us = 50').timing
    assert (timing.command_us, timing.at_updates, timing.commands_per_update) == (50, True, 8)


def test_an_error_program_does_not_take_the_time_of_another() -> None:
    session = Session("[timing.commands]\nVAR = 50000", ERROR="1")
    for line in ("DEF E1", "VAR2=VAR2+1", "END", "DEF P", "VAR1=VAR1+1", "VAR1=VAR1+1", "END"):
        session.ask(line, wait_s=0.1)
    session.ask("P")
    session.advance(0.2)
    assert session.unit.controller.variables.number(1) == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[timing.commands]\nTPEE = 3", "timing.commands.TPEE: found 'TPEE'; allowed: the name of a command"),
        ("[timing.commands]\ntpe = 3", "(did you mean TPE?)"),
        ("[timing.commands]\nTPE = -3", "a whole number >= 0"),
        ('[timing]\npreset = "real"', "'instant' or 'realistic'"),
        ("[serial]\nbaud = 50", "serial.baud: found 50; allowed: 0 (instant) or 110 to 921,600"),
        ("[serial]\nbaud = 1000000", "serial.baud: found 1000000"),
        ("[serial]\nbauds = 9600", "(did you mean baud?)"),
        ('[serial]\nframing = "9N1"', "serial.framing: found '9N1'"),
        ("[serial.buffer]\nxon_at_left = 100", "serial.buffer.xon_at_left: found 100; allowed: more than xoff_at_left"),
    ],
)
def test_mistakes_are_told_in_one_line(text: str, said: str) -> None:
    with pytest.raises(MachineError) as caught:
        Machine.parse(text, name="m.toml")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)

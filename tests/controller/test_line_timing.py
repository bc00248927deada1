"""A line with a speed, against the arithmetic of the wire: n characters take n times their bits over the baud rate."""

from __future__ import annotations

import logging

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.chain import build_chain
from emulator.controller import Controller, Output
from emulator.controller.line import TimedLine
from emulator.controller.line.direction import character_bits
from emulator.machine import Machine
from tests.controller.session import S

ROUNDING_NS = 2
"""Each stamp is rounded up to a whole nanosecond; echo starts at a rounded one."""

XON, XOFF = b"\x11", b"\x13"
LONG_NS = 60 * S


def timed_unit(baud: int = 9600, serial: str = "", **defaults: int) -> Controller:
    """A unit on a timed line, signed on and silent."""
    rows = "\n".join(f'{name} = "{value}"' for name, value in defaults.items())
    controller = Controller(Machine.parse(f"[serial]\nbaud = {baud}\n{serial}\n[defaults]\n{rows}\n"))
    controller.power_up()
    controller.advance(2 * S)
    controller.take_output()
    return controller


def say(controller: Controller, data: bytes, *, channel: int = 0) -> None:
    controller.receive(data, at_ns=controller.now_ns, channel=channel)


def heard(controller: Controller, *, for_ns: int = LONG_NS) -> list[Output]:
    """What leaves the unit within a time, stamped with the time since now."""
    start_ns = controller.now_ns
    controller.advance(start_ns + for_ns)
    return [Output(out.at_ns - start_ns, out.data, out.channel) for out in controller.take_output()]


def text(outputs: list[Output]) -> bytes:
    return b"".join(output.data for output in outputs)


def unsent(controller: Controller) -> int:
    """Characters that wait to be sent."""
    assert isinstance(controller.line, TimedLine)
    return controller.line.transmitter.waiting


def characters_ns(count: int, baud: int = 9600, bits: int = 10) -> int:
    return -(-count * bits * S // baud)


# The wire's time.


@pytest.mark.parametrize(("framing", "bits"), [("8N1", 10), ("8N2", 11), ("8E1", 11), ("7E1", 10), ("7N1", 9)])
def test_start_stop_and_parity_bits_count(framing: str, bits: int) -> None:
    assert character_bits(framing) == bits


@pytest.mark.parametrize("baud", [110, 1200, 9600, 19_200, 115_200, 921_600])
@pytest.mark.parametrize(("framing", "bits"), [("8N1", 10), ("8E2", 12)])
def test_characters_reach_the_unit_when_their_stop_bits_end(baud: int, framing: str, bits: int) -> None:
    unit = timed_unit(baud, f'framing = "{framing}"', ECHO=0)
    start_ns = unit.now_ns
    say(unit, b"VAR1=12345")
    before = unit.line.received
    for count in range(1, 11):
        unit.advance(start_ns + characters_ns(count, baud, bits) - 1)
        assert unit.line.received - before == count - 1
        unit.advance(start_ns + characters_ns(count, baud, bits))
        assert unit.line.received - before == count


@pytest.mark.parametrize("baud", [1200, 9600, 19_200, 115_200])
def test_characters_leave_one_after_the_other(baud: int) -> None:
    unit = timed_unit(baud, ECHO=0)
    say(unit, b"1TPE\r")
    outputs = heard(unit)
    assert text(outputs) == b"*1TPE+0\r\r\n> "
    for count, output in enumerate(outputs, start=6):
        assert len(output.data) == 1
        assert output.at_ns == pytest.approx(characters_ns(count, baud), abs=ROUNDING_NS)


def test_a_poll_with_echo_at_9600_baud_takes_nineteen_characters() -> None:
    """Five characters in; the echo of four has left by then; CR LF, *1TPE+0, CR and CR LF > blank are fourteen more."""
    unit = timed_unit()
    say(unit, b"1TPE\r")
    outputs = heard(unit)
    assert text(outputs) == b"1TPE\r\n*1TPE+0\r\r\n> "
    assert outputs[-1].at_ns == pytest.approx(19 * 10 * S / 9600, abs=ROUNDING_NS)


def test_a_hundred_polls_do_not_drift() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b"1TPE\r" * 100)
    outputs = heard(unit)
    assert text(outputs) == b"*1TPE+0\r\r\n> " * 100
    assert outputs[-1].at_ns == pytest.approx(characters_ns(5 + 100 * 12), abs=ROUNDING_NS)


def test_the_sign_on_takes_its_time() -> None:
    unit = Controller(Machine.parse("[serial]\nbaud = 9600"))
    unit.power_up()
    assert unit.take_output() == []
    assert unit.busy
    outputs = heard(unit)
    assert outputs[-1].at_ns == characters_ns(len(text(outputs)))
    assert not unit.busy


def test_nothing_is_released_before_its_time() -> None:
    unit = timed_unit()
    say(unit, b"1TPE\r")
    before_ns = unit.now_ns
    while unit.busy:
        unit.advance(unit.now_ns + 333_333)
        assert all(before_ns < output.at_ns <= unit.now_ns for output in unit.take_output())
        before_ns = unit.now_ns


def test_two_taps_type_at_once_and_share_the_transmitter() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b"1TPE\r", channel=1)
    say(unit, b"2TPE\r", channel=2)
    outputs = heard(unit)
    assert [output.channel for output in outputs] == [1] * 12 + [2] * 12
    assert outputs[-1].at_ns == pytest.approx(characters_ns(5 + 24), abs=ROUNDING_NS)


def test_what_a_host_sent_before_it_left_still_arrives() -> None:
    unit = timed_unit()
    say(unit, b"VAR1=5\rVAR2=")
    unit.detach(0)
    say(unit, b"VAR3=7\r")
    assert unit.busy
    heard(unit)
    assert [unit.variables.number(number) for number in (1, 2, 3)] == [5, 0, 7]


def test_a_unit_that_is_off_hears_nothing_and_says_no_more() -> None:
    unit = timed_unit()
    say(unit, b"1TPE\rVAR1=5\r")
    unit.advance(unit.now_ns + characters_ns(8))
    unit.take_output()
    unit.power_down()
    assert heard(unit) == []
    unit.power_up()
    heard(unit)
    assert unit.variables.number(1) == 0


# However the session is cut, and twice.

PIECES = [
    *(b"1TPE\r", b"VAR1=VAR1+1\r", b"!TSS\r", b"T0.02\r", b"XYZZY\r", b"V1:A2:V\r", b"ECHO0\r", b"ECHO1\r"),
    *(b"\r", b"!K\r", XON, XOFF, b'DEF P\rWRITE"HELLO"\rEND\rP\r', b"DEL P\r", b"XONOFF0\r", b"XONOFF1\r"),
    *(b"\x0b", b"TAS\r", b"!\x13TPE\r\x11"),
]
SESSIONS = st.lists(st.tuples(st.sampled_from(PIECES), st.integers(0, 40_000_000)), min_size=1, max_size=12)
SMALL_BUFFERS = "output_buffer = 40\nbuffer = { size = 120, xoff_at_left = 30, xon_at_left = 60 }"


def played(steps: list[tuple[bytes, int]], cuts: list[int], serial: str) -> list[Output]:
    unit = timed_unit(9600, serial)
    outputs: list[Output] = []
    for turn, (data, pause_ns) in enumerate([*steps, (XON, 3 * S)]):
        size = cuts[turn % len(cuts)]
        for start in range(0, len(data), size):
            say(unit, data[start : start + size], channel=turn % 2)
        until_ns = unit.now_ns + pause_ns
        for part in range(1, size + 1):
            unit.advance(until_ns - pause_ns + pause_ns * part // size)
            if turn % 3:
                outputs += unit.take_output()
    return outputs + unit.take_output()


@settings(max_examples=40, deadline=None)
@given(SESSIONS, st.lists(st.integers(1, 9), min_size=1, max_size=5), st.sampled_from(["", SMALL_BUFFERS]))
def test_any_cut_gives_the_same_bytes_at_the_same_times(
    steps: list[tuple[bytes, int]], cuts: list[int], serial: str
) -> None:
    assert played(steps, cuts, serial) == played(steps, [100], serial)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(PIECES[:10]), max_size=8))
def test_the_bytes_are_those_of_the_instant_line(pieces: list[bytes]) -> None:
    instant = Controller(Machine.default())
    instant.power_up()
    instant.take_output()
    unit = timed_unit(115_200)
    for piece in pieces:
        for each in (instant, unit):
            say(each, piece)
            each.advance(each.now_ns + S // 10)
    assert text(unit.take_output()) == text(instant.take_output())


# XON/XOFF.


def test_xoff_stops_the_transmitter_after_the_character_under_way() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b"1TPE\r")
    unit.advance(unit.now_ns + characters_ns(7) + 100)
    unit.take_output()
    say(unit, XOFF)
    outputs = heard(unit, for_ns=S)
    assert text(outputs) == b"TP"
    assert unit.line.held
    assert not unit.busy
    say(unit, XON)
    outputs = heard(unit)
    assert text(outputs) == b"E+0\r\r\n> "
    assert outputs[0].at_ns == pytest.approx(characters_ns(2), abs=ROUNDING_NS)


def test_with_xonoff0_nobody_is_stopped_and_the_characters_are_nothing() -> None:
    unit = timed_unit(ECHO=0, XONOFF=0)
    say(unit, b"T5\r")
    say(unit, b"1T" + XOFF + b"PE\r" + b"VAR1=1\r" * 270)
    outputs = heard(unit)
    assert text(outputs) == b"\r\n> *1TPE+0\r\r\n> " + b"\r\n> " * 270
    assert unit.line.overruns == 0


def test_xonoff0_lets_go_of_a_transmitter_that_is_held() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, XOFF + b"1TPE\r")
    assert text(heard(unit)) == b""
    say(unit, b"!XONOFF0\r")
    assert text(heard(unit)) == b"*1TPE+0\r\r\n> \r\n> "


def test_a_host_that_ignores_xoff_loses_what_the_buffer_cannot_hold(caplog: pytest.LogCaptureFixture) -> None:
    """2000 bytes hold 285 commands of seven characters and five of the next; the rest finds no room."""
    unit = timed_unit(ECHO=0)
    say(unit, b"T10\r")
    heard(unit, for_ns=S)
    say(unit, b"VAR1=1\r" * 500)
    with caplog.at_level(logging.WARNING, logger="oem6250.line"):
        outputs = heard(unit)
    assert unit.line.overruns == 3500 - 2000
    assert [record.getMessage().split(" at_s")[0] for record in caplog.records] == [
        'event="input buffer full, characters lost"'
    ]
    assert text(outputs).replace(XOFF, b"").replace(XON, b"") == b"\r\n> " * 286
    say(unit, b"1\r!TSS.1\r")
    heard(unit)
    assert unit.line.overruns == 1500


def test_xoff_goes_out_at_200_left_and_xon_at_1000_free() -> None:
    unit = timed_unit(ECHO=0)
    start_ns = unit.now_ns
    say(unit, b"T10\r" + b"VAR1=1\r" * 270)
    outputs = heard(unit, for_ns=9 * S)
    assert text(outputs) == XOFF
    assert outputs[0].at_ns == pytest.approx(characters_ns(4 + 1800 + 1), abs=ROUNDING_NS)
    assert unit.line.holds_hosts
    outputs = heard(unit)
    assert text(outputs).index(XON) < 10, "the buffer is worked off at once, so XON goes ahead of the prompts"
    assert not unit.line.holds_hosts
    assert unit.now_ns > start_ns


def flood(unit: Controller, data: bytes, *, obeying: bool) -> bytes:
    """A host that looks for XOFF before each character it sends."""
    said = bytearray()
    stopped = False
    position = 0
    while position < len(data) or unit.busy:
        if position < len(data) and not stopped:
            say(unit, data[position : position + 1])
            position += 1
        unit.advance(unit.now_ns + characters_ns(1))
        for output in unit.take_output():
            if output.data in (XON, XOFF):
                stopped = obeying and output.data == XOFF
            else:
                said += output.data
    return bytes(said)


@pytest.mark.parametrize("obeying", [True, False])
def test_a_flooding_host_loses_nothing_exactly_if_it_obeys(obeying: bool) -> None:
    unit = timed_unit(ECHO=0)
    said = flood(unit, b"T3\r" + b"VAR1=VAR1+1\r" * 250, obeying=obeying)
    lost = unit.line.overruns
    if obeying:
        assert (lost, said, int(unit.variables.number(1))) == (0, b"\r\n> " * 251, 250)
    else:
        assert 0 < lost < 3000
        assert unit.variables.number(1) < 250


def test_a_driver_that_obeys_xoff_keeps_the_rest_and_the_characters_to_itself() -> None:
    unit = timed_unit(serial="host_obeys_xoff = true", ECHO=0)
    say(unit, b"T10\r" + b"VAR1=VAR1+1\r" * 400)
    assert text(heard(unit)) == b"\r\n> " * 401
    assert unit.line.overruns == 0
    assert unit.variables.number(1) == 400


def test_a_full_buffer_never_keeps_an_immediate_command_of_a_patient_host_out() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b"T10\r" + b"VAR1=1\r" * 250)
    heard(unit, for_ns=3 * S)
    say(unit, b"!TSS.1\r")
    assert text(heard(unit, for_ns=S)) == b"*1\r\r\n> "


# More to say than the wire can carry.


def test_a_talking_program_goes_at_the_pace_of_the_line() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b'DEF P\rL100\rWRITE"ABCDEFGHIJ"\rVAR1=VAR1+1\rLN\rEND\rP\r')
    outputs = heard(unit, for_ns=S)
    assert unit.line.busy
    said_by_now = int(unit.variables.number(1))
    assert 0 < said_by_now <= (1000 + 960) // 10 + 2
    say(unit, b"!1TPE\r")
    outputs += heard(unit)
    assert text(outputs).count(b"ABCDEFGHIJ") == 100
    assert b"*1TPE+0" in text(outputs)


def test_a_program_that_talks_for_ever_is_bounded_and_can_be_killed() -> None:
    unit = timed_unit(ECHO=0)
    say(unit, b'DEF P\rL\rWRITE"ABCDEFGHIJ"\rLN\rEND\rP\r')
    heard(unit, for_ns=5 * S)
    assert unsent(unit) <= 1010
    say(unit, XOFF)
    heard(unit, for_ns=5 * S)
    assert unsent(unit) <= 1010
    say(unit, b"!K\r")
    heard(unit, for_ns=S)
    say(unit, XON)
    heard(unit, for_ns=3 * S)
    assert not unit.busy


def test_immediate_commands_beyond_measure_wait_in_the_input_buffer() -> None:
    """A host that stops the unit and goes on asking: the output stays bounded, then its characters are lost."""
    unit = timed_unit(ECHO=1, serial="output_buffer = 100")
    say(unit, XOFF + b"!1TPE\r" * 1000)
    heard(unit)
    assert unsent(unit) <= 250
    assert unit.line.overruns > 0
    say(unit, XON)
    said = text(heard(unit))
    assert said.count(b"*1TPE+0") == (6000 - unit.line.overruns) // 6
    assert not unit.busy


def test_more_than_a_driver_keeps_stays_with_the_host() -> None:
    unit = timed_unit()
    assert not unit.input_full(0)
    say(unit, b"VAR1=1\r" * 100)
    assert unit.input_full(0)
    assert not unit.input_full(1)
    heard(unit)
    assert not unit.input_full(0)


# Chains.


def chain_at(baud: int) -> bytes:
    chain = build_chain(Machine.parse(f"[serial]\nbaud = {baud}\n[defaults]\nERRLVL = 1"), 3)
    chain.power_up()
    chain.receive(b"2_1TPE\r3_VAR1=7\r3_VAR1\r", at_ns=0, channel=0)
    said = b""
    while chain.now_ns < S:
        chain.advance(chain.now_ns + 10_000_000)
        said += text(chain.take_output())
    return said


def test_a_chain_says_the_same_on_a_timed_line() -> None:
    assert chain_at(9600) == chain_at(0)


def test_each_unit_of_a_chain_passes_a_character_on_when_it_has_it() -> None:
    """The third unit's echo ends four characters' time after the first character began: in, and three times on."""
    chain = build_chain(Machine.parse("[serial]\nbaud = 9600\n[defaults]\nERRLVL = 1"), 3)
    chain.power_up()
    chain.receive(b"ABC", at_ns=0, channel=0)
    chain.advance(S)
    outputs = chain.take_output()
    assert text(outputs) == b"ABC"
    for count, output in enumerate(outputs, start=4):
        assert output.at_ns == pytest.approx(characters_ns(count), abs=8)

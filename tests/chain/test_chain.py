"""Daisy chains as the 6000 Series Programmer's Guide p.72 describes them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.chain import MAX_UNITS, Chain, Renumbering, build_chain
from emulator.machine import Machine

SILENT = Machine.parse("[defaults]\nERRLVL = 1")
"""Every unit of a chain needs ERRLVL1; here they start with it."""


def powered(units: int, machine: Machine = SILENT) -> Chain:
    chain = build_chain(machine, units)
    chain.power_up()
    chain.take_output()
    return chain


def say(chain: Chain, data: bytes) -> bytes:
    chain.receive(data, at_ns=chain.now_ns, channel=0)
    return heard(chain)


def heard(chain: Chain) -> bytes:
    return b"".join(output.data for output in chain.take_output())


def test_addressed_units_are_silent_at_power_up() -> None:
    chain = build_chain(Machine.default(), 3)
    chain.power_up()
    assert chain.take_output() == []


def test_only_the_addressed_unit_answers() -> None:
    chain = powered(3)
    say(chain, b"2_1D777\r")
    assert [say(chain, b"%d_1D\r" % unit).split(b"*")[1].strip() for unit in (1, 2, 3)] == [b"+4000", b"+777", b"+4000"]


def test_no_address_and_address_0_concern_all() -> None:
    chain = powered(3)
    assert say(chain, b"1TPE\r").count(b"*+0\r") == 3
    assert say(chain, b"0_1TPE\r").count(b"*+0\r") == 3


def test_one_addr_command_numbers_the_whole_chain() -> None:
    chain = powered(4)
    say(chain, b"ADDR11\r")
    assert [unit.settings.integer("ADDR") for unit in chain.controllers] == [11, 12, 13, 14]
    assert b"*13" in say(chain, b"13_ADDR\r")


def test_addr_ripples_also_when_it_arrives_character_by_character() -> None:
    chain = powered(3)
    for character in b" addr 9 9 \b\b\r":
        say(chain, bytes((character,)))
    for character in b"addr7\r":
        say(chain, bytes((character,)))
    assert [unit.settings.integer("ADDR") for unit in chain.controllers] == [7, 8, 9]


def test_an_addressed_addr_concerns_one_unit() -> None:
    chain = powered(3)
    say(chain, b"2_ADDR50\r")
    assert [unit.settings.integer("ADDR") for unit in chain.controllers] == [1, 50, 3]


def test_addr0_returns_to_the_switches() -> None:
    chain = powered(2)
    say(chain, b"ADDR20\rADDR0\r")
    assert [unit.settings.integer("ADDR") for unit in chain.controllers] == [1, 2]


def test_a_unit_off_line_passes_everything_on() -> None:
    chain = powered(3)
    say(chain, b"2_E0\r")
    assert b"*" not in say(chain, b"2_1TPE\r")
    assert b"*+0" in say(chain, b"3_1TPE\r")
    say(chain, b"2_E1\r")
    assert b"*+0" in say(chain, b"2_1TPE\r")


def test_a_unit_without_echo_cuts_the_line() -> None:
    chain = powered(3)
    say(chain, b"2_ECHO0\r")
    assert say(chain, b"3_1TPE\r") == b""
    assert b"*+0" in say(chain, b"2_1TPE\r"), "its own reply still goes down the line"


def test_the_host_sees_one_echo_then_the_reply() -> None:
    """The C host of ZETA6104 chains reads the echo up to LF, then the reply up to CR."""
    assert say(powered(2), b"1_1tpe\r") == b"1_1TPE\r\n*+0\r\n"


def test_prompts_spoil_the_neighbours_next_command() -> None:
    chain = powered(2, Machine.default())
    say(chain, b"1_TREV\r")
    assert b"*1TPE+0" not in say(chain, b"2_1TPE\r")
    for _ in range(4):
        say(chain, b"ERRLVL1\r")
    assert say(chain, b"2_1TPE\r") == b"2_1TPE\r\n*+0\r"


def test_a_reply_is_no_bad_command_to_the_units_behind() -> None:
    chain = powered(2)
    say(chain, b"ERROR.16-1\r1_1TPE\r")
    assert say(chain, b"2_TER.16\r").endswith(b"*0\r")


def test_a_dozen_units_with_prompts_stay_bounded() -> None:
    """Prompts beget prompts; the input buffers bound what becomes of one empty line."""
    chain = powered(12, Machine.default())
    assert len(say(chain, b"\r" * 50)) < 20_000


def test_units_move_at_the_same_time() -> None:
    chain = powered(2)
    say(chain, b"COMEXC1:DRIVE11:1V1:1A100:1D4000:1GO\r")
    chain.advance(2_000_000_000)
    heard(chain)
    assert [b"*+4000" in say(chain, b"%d_1TPC\r" % unit) for unit in (1, 2)] == [True, True]


def test_size() -> None:
    with pytest.raises(ValueError, match="1 to 99"):
        build_chain(SILENT, MAX_UNITS + 1)


@given(st.binary(max_size=60), st.lists(st.integers(1, 5), max_size=20))
def test_renumbering_does_not_depend_on_packets(data: bytes, sizes: list[int]) -> None:
    whole, cut, position, pieces = Renumbering(), Renumbering(), 0, []
    for size in [*sizes, len(data)]:
        pieces.append(cut.passed_on(data[position : position + size]))
        position += size
    assert b"".join(pieces) == whole.passed_on(data)


@given(st.binary(max_size=40).filter(lambda data: b"DD" not in data.upper()))
def test_renumbering_leaves_everything_else_alone(data: bytes) -> None:
    assert Renumbering().passed_on(data + b"\r") == data + b"\r"


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(1, 12), min_size=1, max_size=12))
def test_the_same_bytes_however_time_is_cut(slices_ms: list[int]) -> None:
    def run(slices: list[int]) -> list[tuple[int, bytes]]:
        chain = powered(3)
        chain.receive(b"DRIVE11:1D400:1V10:1GO:1TPC\r2_T.02:2_1TPE\r", at_ns=chain.now_ns, channel=0)
        for milliseconds in slices:
            chain.advance(chain.now_ns + milliseconds * 1_000_000)
        chain.advance(300_000_000)
        stamped: list[tuple[int, bytes]] = []
        for output in chain.take_output():
            if stamped and stamped[-1][0] == output.at_ns:
                stamped[-1] = (output.at_ns, stamped[-1][1] + output.data)
            else:
                stamped.append((output.at_ns, output.data))
        return stamped

    assert run(slices_ms) == run([])

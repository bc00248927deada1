"""The error word ER: one word for the unit, so a bit stays while any axis still has its cause (settled, section 6)."""

from __future__ import annotations

import pytest

from tests.controller.session import Session

HARD, SOFT, DRIVE_FAULT, STOPPED, TARGET_ZONE, POSITION_ERROR, BAD_COMMAND = 2, 3, 4, 5, 11, 12, 16


def watching(*commands: str) -> Session:
    session = Session(ERROR="1" * 32)
    session.ok("DRIVE11", *commands)
    return session


def test_only_what_error_enables() -> None:
    session = Session()
    session.error("XYZZY")
    assert not session.error_bit(BAD_COMMAND)
    session.ok("ERROR.16-1")
    assert not session.error_bit(BAD_COMMAND), "what was before does not count"
    session.error("XYZZY")
    assert session.error_bit(BAD_COMMAND)
    session.ok("ERROR.16-0")
    assert not session.error_bit(BAD_COMMAND)
    session.ok("ERROR.16-1")
    assert not session.error_bit(BAD_COMMAND)


def test_error_pattern() -> None:
    session = Session()
    assert session.query("ERROR") == "ERROR" + "_".join(["0000"] * 8)
    session.ok("ERROR1X01", "ERROR.32-1")
    assert session.query("ERROR") == "ERROR1001_" + "_".join(["0000"] * 6) + "_0001"
    assert session.query("ERROR.4") == "1"
    assert session.error("ERROR.33-1") == "INVALID DATA"


def test_reserved_bits_never_set() -> None:
    session = watching("MC11", "COMEXC1", "GO11")
    session.advance(0.3)
    session.ask("!K")
    session.error("XYZZY")
    session.set_wire("enable", closed=False)
    word = session.look("!TER").removeprefix("TER").replace("_", "")
    assert [n for n, digit in enumerate(word, start=1) if digit == "1"] == [STOPPED, 9, BAD_COMMAND]


@pytest.mark.parametrize("at_limit", [1, 2])
def test_limit_of_one_axis_and_free_way_of_the_other(at_limit: int) -> None:
    session = watching("COMEXC1")
    session.set_wire(f"axis{at_limit}.positive_limit", closed=False)
    session.ok("GO11")
    session.advance(1.5)
    assert session.position(3 - at_limit) == 4000
    assert session.position(at_limit) == 0
    assert session.error_bit(HARD)
    session.ok(f"{3 - at_limit}GO")
    assert session.error_bit(HARD), "the other axis's way does not matter"
    session.ok(f"{at_limit}D-", f"{at_limit}GO")
    assert not session.error_bit(HARD)


@pytest.mark.parametrize("name", ["LH", "LS"])
def test_limits_of_both_axes(name: str) -> None:
    bit = HARD if name == "LH" else SOFT
    session = watching("LSNEG-9,-9", "LS3,3")
    if name == "LH":
        session.set_wire("axis1.positive_limit", closed=False)
        session.set_wire("axis2.positive_limit", closed=False)
    session.ok("GO11", wait_s=0.1)
    assert session.error_bit(bit)
    session.ok(f"1{name}0")
    assert session.error_bit(bit)
    session.ok(f"2{name}0")
    assert not session.error_bit(bit)


def test_position_errors_of_both_axes() -> None:
    session = watching("SMPER20,20", "MC11", "COMEXC1", "GO11")
    session.advance(0.5)
    assert session.error_bit(POSITION_ERROR)
    session.ok("DRIVE1")
    assert session.error_bit(POSITION_ERROR)
    session.ok("2DRIVE1")
    assert not session.error_bit(POSITION_ERROR)


def test_drive_faults_of_both_axes() -> None:
    session = watching("INFEN1")
    for axis in (1, 2):
        session.set_wire(f"axis{axis}.drive_fault", closed=True)
    for axis in (1, 2):
        session.set_wire(f"axis{axis}.drive_fault", closed=False)
    session.ok("DRIVE1")
    assert session.error_bit(DRIVE_FAULT)
    session.ok("2DRIVE1")
    assert not session.error_bit(DRIVE_FAULT)


def test_target_zone_time_outs_of_both_axes() -> None:
    session = watching("SMPER0,0", "STRGTE11", "STRGTT10,10", "SGP0,0", "COMEXC1", "V9,9", "A900,900", "GO11")
    session.advance(2)
    assert session.error_bit(TARGET_ZONE)
    session.ok("1STRGTE0")
    assert session.error_bit(TARGET_ZONE)
    session.ok("2STRGTE0")
    assert not session.error_bit(TARGET_ZONE)


def test_nothing_branches_without_an_error_program() -> None:
    session = watching("COMEXC1", "MC1", "GO1")
    session.advance(0.3)
    session.error("XYZZY")
    assert session.axis_bit(1)
    assert not session.system_bit(3)

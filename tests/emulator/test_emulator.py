"""The emulator as Python sees it: several units on one time, reading and sending, running until something holds."""

from __future__ import annotations

import pytest

from emulator import Emulator, Machine

QUIET = "[defaults]\nECHO = 0\n"
SIGN_ON = b"*PARKER OEM6250 MOTION CONTROLLER\r\n*NO REMOTE PANEL\r\r\n> "
SYSTEM_NS = 2_240_000


def test_the_sign_on_waits_to_be_read() -> None:
    emulator = Emulator()
    assert emulator.unit(0).read() == SIGN_ON
    assert emulator.unit(0).read() == b""
    assert emulator.time_s == 0


def test_the_example_of_the_module() -> None:
    emulator = Emulator()
    unit = emulator.unit(0)
    unit.send(b"DRIVE11:D4000:GO11\r")
    emulator.advance(2.0)
    assert unit.signals["axis1.position.commanded"] == 4000


def test_time_moves_only_when_told() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    unit.send(b"DRIVE1:GO1\r")
    for _ in range(5):
        unit.send(b"!1TPC\r")
    assert emulator.time_s == 0
    assert unit.signals["axis1.position.commanded"] == 0
    emulator.advance(0.25)
    assert emulator.time_s == 0.25
    emulator.advance_to(1_000_000_000)
    assert emulator.time_s == 1.0


def test_units_share_time_and_nothing_else() -> None:
    emulator = Emulator(
        [Machine.parse(QUIET), Machine.parse(QUIET + "ADDR = 1\n"), Machine.parse("bare = true\n" + QUIET)]
    )
    first, second, bare = emulator.units
    assert second.read() == b"", "a unit with an address does not sign on"
    for unit in emulator.units:
        unit.read()
        unit.send(b"DRIVE11\r")
    first.send(b"GO1\r")
    emulator.advance(2.0)
    assert {unit.controller.now_ns for unit in emulator.units} == {2_000_000_000}
    assert first.signals["axis1.position.commanded"] == 4000
    assert second.signals["axis1.position.commanded"] == 0
    assert second.signals["axis1.drive"] is True
    assert bare.signals["axis1.drive"] is False
    assert b"ENABLE INPUT INACTIVE" in bare.read()


def test_output_carries_its_time() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    unit.take_output()
    unit.send(b"T.1:T.1\r")
    emulator.advance(1)
    stamps = [output.at_ns for output in unit.take_output()]
    assert len(stamps) == 2
    assert 0 <= stamps[0] - 100_000_000 < SYSTEM_NS
    assert 0 <= stamps[1] - stamps[0] - 100_000_000 <= SYSTEM_NS
    assert unit.take_output() == []
    assert unit.read() == SIGN_ON + b"\r\n> " * 2, "reading and taking do not rob each other"


def test_channels() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    unit.send(b"1V\r", channel=7)
    assert unit.read(channel=7).endswith(b"*1V1.0000\r\r\n> ")
    assert unit.read(channel=3) == b""


def test_run_until() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    unit.send(b"DRIVE1:GO1\r")
    assert emulator.run_until(lambda: unit.signals["axis1.position.commanded"] == 4000)
    assert emulator.time_s == pytest.approx(1.1, abs=0.005)
    assert not emulator.run_until(lambda: False, timeout_s=0.5)
    assert emulator.time_s == pytest.approx(1.6, abs=0.005)
    before = emulator.time_s
    assert emulator.run_until(lambda: True)
    assert emulator.time_s == before


def test_a_power_cut_forgets_half_a_command() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    unit.read()
    unit.send(b"1V")
    unit.do("cut_power")
    unit.send(b"9\r")
    unit.do("restore_power")
    unit.send(b"1V\r")
    assert unit.read() == SIGN_ON + b"*1V1.0000\r\r\n> "


def test_bytes_from_the_past_are_taken_now() -> None:
    emulator = Emulator(Machine.parse(QUIET))
    unit = emulator.unit(0)
    emulator.advance(1)
    unit.controller.receive(b"T.5\r", at_ns=0, channel=0)
    unit.take_output()
    emulator.advance(1)
    assert 1.5e9 <= unit.take_output()[0].at_ns <= 1.5e9 + SYSTEM_NS

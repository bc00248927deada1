"""The same without pytest's fixtures: context managers, unittest, and the parts by themselves."""

from __future__ import annotations

import unittest
from pathlib import Path

import pytest

from clients.lines import Line
from clients.testing import EmulatedMixin, NotReached, emulated, in_process
from emulator.machine import MachineError


class HomingCase(EmulatedMixin):
    """Run by hand below, as unittest would."""

    machine = "[axis1.encoder]\ncounts_per_rev = 8000\n"
    names = {"start": "input.1"}  # noqa: RUF012 - as a user would write it

    def runTest(self) -> None:
        self.emu.inputs["start"] = True
        self.emu.line().write(b"!1TPE\r")
        self.emu.advance(1.0)
        self.assertEqual(self.emu.unit().controller.machine.axis1.encoder.counts_per_rev, 8000)
        self.assertTrue(self.emu.inputs["input.1"])


def test_unittest() -> None:
    result = unittest.TestResult()
    HomingCase().run(result)
    assert result.wasSuccessful() and result.testsRun == 1


class TestVirtualLine:
    def test_it_is_a_line(self) -> None:
        with emulated() as emu:
            assert isinstance(emu.line(), Line)

    def test_reading_waits_in_virtual_time(self) -> None:
        with emulated("[defaults]\nECHO = 0\n") as emu:
            line = emu.line()
            line.write(b"T2.5\r")
            line.read(0.0)
            assert line.read(1.0) == b"" and line.clock() == 1.0
            assert line.read(60.0) == b"\r\n> "
            assert line.clock() == pytest.approx(2.5, abs=0.003), "it comes when it is said, not later"
            line.sleep(0.25)
            assert emu.time_s == pytest.approx(2.75, abs=0.003)

    def test_a_timed_line(self) -> None:
        with emulated("[serial]\nbaud = 9600\n[defaults]\nECHO = 0\n") as emu:
            line = emu.line()
            while line.read(0.2):
                pass
            began_s = line.clock()
            line.write(b"1TPE\r")
            answer = b""
            while not answer.endswith(b"> "):
                answer += line.read(1.0)
            assert answer == b"*1TPE+0\r\r\n> "
            assert line.clock() - began_s == pytest.approx((5 + len(answer)) / 960, abs=0.003)

    def test_a_fault_on_time_while_the_host_reads(self) -> None:
        with emulated("[defaults]\nECHO = 0\n") as emu:
            fault = emu.faults.enable_open().at(1.5)
            emu.line().read(10.0)
            line = emu.line()
            assert line.read(3.0) == b"" and fault.first_s == 1.5

    def test_closed(self) -> None:
        with emulated() as emu:
            line = emu.line()
            line.close()
            line.close()
            with pytest.raises(OSError, match="closed"):
                line.write(b"1TPE\r")

    def test_a_host_that_waits_for_ever(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(in_process, "LONGEST_S", 10.0)
        with emulated() as emu:
            line = emu.line()
            line.read(0.0)
            emu.emulator.advance_to(11_000_000_000)
            with pytest.raises(NotReached, match="waiting"):
                line.read(1.0)

    def test_two_units_keep_one_time(self) -> None:
        with emulated(units=2) as emu:
            first, second = (unit.line() for unit in emu.units)
            first.write(b"DRIVE1:GO1\r")
            second.write(b"T1\r")
            second.read(0.0)
            assert second.read(5.0) == b"\r\n> "
            assert emu.units[0].controller.now_ns == emu.units[1].controller.now_ns


class TestMachines:
    def test_given_in_any_form(self, tmp_path: Path) -> None:
        path = tmp_path / "bare.toml"
        path.write_text("bare = true\n")
        for given in (path, str(path), "bare = true"):
            with emulated(given) as emu:
                assert emu.inputs["enable"] is False
        with pytest.raises(MachineError):
            emulated(tmp_path / "none.toml")


def test_settle_gives_up() -> None:
    with emulated("[defaults]\nCOMEXC = 1\n") as emu:
        emu.line().write(b"DRIVE1:MC1:GO1\r")
        with pytest.raises(NotReached, match="rest was not reached within 2 s"):
            emu.settle(timeout_s=2.0)


def test_trace() -> None:
    """Position error on the scope: at constant velocity v / (gain in 1/s), 1 rev/s over 20 1/s."""
    pytest.importorskip("emulator.scope")
    with emulated("[defaults]\nCOMEXC = 1\n") as emu:
        emu.line().write(b"DRIVE1:A100:V1:D8000\r")
        trace = emu.trace("position error", axis=1, seconds=2.0)
        emu.line().write(b"GO1\r")
        emu.advance(1.5)
        assert len(trace) == len(trace.time_s) > 4000
        assert trace.values.max() == pytest.approx(200, abs=5)

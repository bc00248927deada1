"""The same without pytest's fixtures: context managers, unittest, and the parts by themselves."""

from __future__ import annotations

import asyncio
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clients import AsyncOEM6250, MotionError, NoAnswer
from clients.lines import Line
from clients.testing import Emulated, EmulatedMixin, NotReached, emulated, in_process
from clients.testing.virtual_loop import AsyncVirtualLine
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


def test_a_trace_is_an_array() -> None:
    with emulated() as emu:
        trace = emu.trace("position error", axis=1)
        emu.client.axis[1].drive_enabled = True
        emu.client.axis[1].move_to(-4000)
        assert np.asarray(trace).dtype.kind == "i"
        assert abs(trace).max() == np.max(abs(trace.values)) > 50
        assert (trace - trace[0]).shape == trace.shape == (len(trace),)
        assert np.all((trace < 50) | (trace >= 50))
        with pytest.raises(AttributeError):
            _ = trace.maximum


def test_a_trace_keeps_what_it_has_when_the_next_begins() -> None:
    with emulated() as emu:
        first = emu.trace("commanded position", axis=1)
        emu.client.axis[1].drive_enabled = True
        emu.client.axis[1].move_to(4000)
        kept = len(first)
        second = emu.trace("commanded position", axis=2)
        emu.advance(0.5)
        assert (len(first), first.max(), second.max()) == (kept, 4000, 0)
        assert len(second) > 0
        with pytest.raises(ValueError, match=r"no signal 'axis1.nonsense'"):
            emu.trace("nonsense")


class TestAChain:
    MACHINE = "[defaults]\nERRLVL = 1\n"

    def test_units_are_addressed_and_share_time_and_line(self) -> None:
        with emulated(self.MACHINE, chain=3) as emu:
            for number, unit in enumerate(emu.units, start=1):
                unit.client.axis[1].velocity = number + 0.5
            assert [unit.client.axis[1].velocity for unit in emu.units] == [1.5, 2.5, 3.5]
            second = emu.units[1]
            trace = emu.trace("commanded position", axis=1, unit=1)
            second.client.axis[1].drive_enabled = True
            second.client.axis[1].move_to(4000)
            assert [unit.signals["axis1.position.commanded"] for unit in emu.units] == [0, 4000, 0]
            assert trace.max() == 4000
            assert {unit.controller.now_ns for unit in emu.units} == {emu.now_ns}
            emu.settle()

    def test_one_line_bytes_in_at_the_first_out_of_the_last(self) -> None:
        with emulated(self.MACHINE, chain=2) as emu:
            line = emu.line()
            line.write(b"1_TREV\r2_1V7\r2_1V\r")
            said = b""
            while data := line.read(0.05):
                said += data
            assert b"*92-013" in said.upper() or b"OEM6250" in said
            assert b"*7.0000" in said
            assert said.startswith(b"1_TREV")
            assert "u0 c0" in emu.traffic.lines()[-1]
            line.close()

    def test_faults_inputs_and_times_belong_to_one_unit(self) -> None:
        with emulated(self.MACHINE, chain=2, names={"door": "enable"}) as emu:
            first, second = emu.units
            first.client.axis[1].drive_enabled = second.client.axis[1].drive_enabled = True
            fault = second.faults.limit_open(axis=1, direction="positive").at(emu.time_s + 0.5)
            with pytest.raises(MotionError, match="positive hard limit"):
                second.client.axis[1].move_to(400_000)
            fault.assert_fired()
            first.inputs["door"] = False
            assert second.inputs["door"]
            assert b"limit_open" in emu.recording()

    def test_a_program_s_words_come_when_they_are_said(self) -> None:
        with emulated(self.MACHINE, chain=2) as emu:
            emu.units[1].client.programs.download("SAY", ["T0.5", 'WRITE"HELLO"'])
            line = emu.line()
            began = emu.time_s
            line.write(b"2_!RUN SAY\r")
            said = b""
            while b"HELLO" not in said:
                said += line.read(1.0)
            assert emu.time_s - began == pytest.approx(0.5, abs=0.01)

    @pytest.mark.parametrize("wrong", [{"units": 2, "chain": 2}, {"chain": 100}, {"chain": 2, "machine": ["", ""]}])
    def test_what_cannot_be(self, wrong: dict[str, Any]) -> None:
        with pytest.raises(ValueError, match="chain"):
            emulated(**wrong)


class TestAsync:
    def test_a_host_s_sleeps_are_virtual(self) -> None:
        looks: list[float] = []

        async def host(emu: Emulated) -> float:
            async with emu.async_client() as ctl:
                await ctl.axis[1].set_drive_enabled(True)

                async def watch() -> None:
                    while True:
                        await asyncio.sleep(0.5)
                        looks.append(await ctl.axis[1].get_commanded_position())

                watching = asyncio.create_task(watch())
                await ctl.axis[1].move_to(40_000)
                watching.cancel()
                return asyncio.get_running_loop().time()

        with emulated() as emu:
            ended = emu.run(host(emu))
            assert ended == pytest.approx(emu.time_s)
        # 40000 counts at 1 rev/s (4000 counts/s), A10: 10.1 s; a look each 0.5 s.
        assert 19 <= len(looks) <= 21
        steps = np.diff(looks[1:18])
        assert steps == pytest.approx(2000, abs=20)

    def test_two_runs_are_the_same(self) -> None:
        async def host(emu: Emulated) -> None:
            async with emu.async_client() as ctl:
                await asyncio.gather(*(shuttle(ctl, axis) for axis in (1, 2)))

        async def shuttle(ctl: AsyncOEM6250, axis: int) -> None:
            await ctl.axis[axis].set_drive_enabled(True)
            for place in (500 * axis, 0):
                await ctl.axis[axis].move_to(place)
                await asyncio.sleep(0.3)

        told = []
        for _ in range(2):
            with emulated() as emu:
                emu.run(host(emu))
                told.append(emu.traffic.lines())
        assert told[0] == told[1]

    def test_time_outs_of_the_host_are_virtual(self) -> None:
        async def host(emu: Emulated) -> None:
            async with emu.async_client() as ctl:
                await ctl.axis[1].set_drive_enabled(True)
                with pytest.raises(TimeoutError):
                    async with asyncio.timeout(2.0):
                        await ctl.axis[1].move_to(400_000)
                await ctl.axis[1].stop(wait=True)
                with emu.faults.unit_silent(), pytest.raises(NoAnswer):
                    await ctl.axis[1].get_position()

        with emulated() as emu:
            emu.run(host(emu))
            assert 4.0 < emu.time_s < 15.0

    def test_two_units_and_a_chain(self) -> None:
        async def host(emu: Emulated) -> list[float]:
            found = []
            for number, unit in enumerate(emu.units):
                async with unit.async_client() as ctl:
                    await ctl.axis[2].set_velocity(number + 2)
                    found.append(await ctl.axis[2].get_velocity())
            return found

        for options in ({"units": 2}, {"chain": 2, "machine": "[defaults]\nERRLVL = 1"}):
            with emulated(**options) as emu:  # type: ignore[arg-type]
                assert emu.run(host(emu)) == [2.0, 3.0]

    async def test_in_any_other_loop_time_passes_while_it_reads(self) -> None:
        with emulated() as emu:
            async with emu.async_client() as ctl:
                await ctl.axis[1].set_drive_enabled(True)
                await ctl.axis[1].move_to(4000)
                assert await ctl.axis[1].get_commanded_position() == 4000

    def test_its_lines_belong_to_its_loop(self) -> None:
        with emulated() as emu:
            line = AsyncVirtualLine(emu.line())
            with pytest.raises(RuntimeError, match="start the host with"):
                asyncio.run(line.read(1.0))

    def test_a_mistake_of_the_host_comes_out(self) -> None:
        async def host() -> None:
            raise KeyError("mine")

        with emulated() as emu, pytest.raises(KeyError, match="mine"):
            emu.run(host())

    def test_a_thread_s_result_is_waited_for(self) -> None:
        async def host() -> int:
            return await asyncio.get_running_loop().run_in_executor(None, lambda: 7)

        with emulated() as emu:
            assert emu.run(host()) == 7
            assert emu.time_s == 0.0

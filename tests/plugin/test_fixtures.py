"""The pytest plugin as its users see it: fixtures, marker, options, reports; each in a pytest of its own."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest

from emulator.engine.machine_code import CACHE_VARIABLE, cache_path
from emulator.recording import read, replay

PLUGIN = ("-p", "no:cacheprovider", "-p", "clients.pytest_plugin")
REPOSITORY = Path(__file__).parents[2]


KERNELS = str(cache_path().parent)


@pytest.fixture(autouse=True)
def only_this_plugin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without what else is installed beside pytest, which takes longer to load than these tests to run; and with the
    compiled kernel, which a pytest with a home directory of its own would not find."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv(CACHE_VARIABLE, KERNELS)


def run(pytester: pytest.Pytester, source: str, *options: str) -> pytest.RunResult:
    """A pytest in this process on one test file."""
    pytester.makepyfile(source)
    return pytester.runpytest_inprocess(*PLUGIN, *options)


class TestFixtures:
    def test_a_chain_and_an_asyncio_host(self, pytester: pytest.Pytester) -> None:
        result = run(
            pytester,
            """
            import asyncio
            import pytest

            @pytest.mark.oem6250(chain=3, machine="[defaults]\\nERRLVL = 1")
            def test_chain(oem6250):
                oem6250.units[2].client.axis[1].velocity = 7
                assert [unit.client.axis[1].velocity for unit in oem6250.units] == [1, 1, 7]

            def test_asyncio(oem6250):
                async def host():
                    async with oem6250.async_client() as ctl:
                        await ctl.axis[1].set_drive_enabled(True)
                        await ctl.axis[1].move_to(4000)
                        await asyncio.sleep(30)
                oem6250.run(host())
                assert oem6250.time_s > 31
            """,
        )
        result.assert_outcomes(passed=2)

    def test_oem6250(self, pytester: pytest.Pytester) -> None:
        result = run(
            pytester,
            """
            import pytest
            from clients.testing import NotReached

            def test_client(oem6250):
                oem6250.client.send("DRIVE1")
                oem6250.client.axis[1].move_to(4000)
                assert oem6250.signals["axis1.position.encoder"] == pytest.approx(4000, abs=50)  # STRGTD

            def test_time(oem6250):
                assert oem6250.time_s == 0.0, "each test has its own"
                oem6250.advance(2.5)
                assert oem6250.time_s == 2.5
                oem6250.run_until(lambda: oem6250.time_s > 4.0)
                assert 4.0 < oem6250.time_s < 4.003
                with pytest.raises(NotReached):
                    oem6250.run_until(lambda: False, timeout_s=0.5)
                with pytest.raises(ValueError):
                    oem6250.advance(-1)

            def test_motion(oem6250):
                line = oem6250.line()
                line.write(b"COMEXC1:DRIVE1:A10:V1:D4000\\r")
                oem6250.assert_no_motion(1.0)
                line.write(b"GO1\\r")
                with pytest.raises(AssertionError, match="profile running"):
                    oem6250.assert_no_motion(0.1)
                oem6250.assert_no_motion(0.1, axis=2)
                with pytest.raises(AssertionError, match="not settled"):
                    oem6250.assert_settles_within(0.2)
                assert 0.5 < oem6250.assert_settles_within(2.0, axis=1) < 1.0
                with pytest.raises(AssertionError, match="no motion"), oem6250.no_motion(axis=1):
                    line.write(b"GO1\\r")
                    oem6250.settle()
                    line.write(b"D-4000:GO1\\r")
                    oem6250.settle()

            @pytest.mark.oem6250(names={"start": "input.3", "lamp": "output.2"})
            def test_inputs_and_outputs(oem6250):
                oem6250.inputs["start"] = True
                oem6250.inputs["enable"] = False
                oem6250.line().write(b"OUT01\\r")
                oem6250.advance(0.1)
                assert oem6250.inputs["input.3"] and not oem6250.inputs["enable"]
                assert oem6250.outputs["lamp"] and not oem6250.outputs["output.1"]
                assert oem6250.signals["inputs"].startswith("001")
                with pytest.raises(KeyError, match="start"):
                    oem6250.inputs["stop"]
                with pytest.raises(KeyError, match="lamp"):
                    oem6250.outputs["horn"]

            def test_faults(oem6250):
                with oem6250.faults.enable_open() as fault:
                    oem6250.advance(0.1)
                fault.assert_fired()
            """,
        )
        result.assert_outcomes(passed=5)

    def test_machine(self, pytester: pytest.Pytester) -> None:
        result = run(
            pytester,
            """
            import pytest
            from emulator import Machine

            @pytest.fixture
            def oem6250_machine():
                return "[axis1.encoder]\\ncounts_per_rev = 8000\\n"

            def test_of_the_module(oem6250):
                assert oem6250.unit().controller.machine.axis1.encoder.counts_per_rev == 8000

            @pytest.mark.oem6250(machine=Machine.parse("bare = true"), units=2)
            def test_of_the_marker(oem6250):
                assert [unit.inputs["enable"] for unit in oem6250.units] == [False, False]
                a, b = (unit.line() for unit in oem6250.units)
                a.write(b"!ECHO0:PSET7\\r"), b.write(b"!ECHO0:PSET8\\r")
                a.read(0), b.read(0)
                a.write(b"1TPE\\r"), b.write(b"1TPE\\r")
                assert a.read(1.0).startswith(b"*1TPE+7") and b.read(1.0).startswith(b"*1TPE+8")

            @pytest.mark.oem6250(units=2)
            class TestNearest:
                @pytest.mark.oem6250(machine="bare = true")
                def test_keys_add_up(self, oem6250):
                    assert len(oem6250.units) == 2 and not oem6250.inputs["enable"]

            class TestOverridden:
                @pytest.fixture
                def oem6250_machine(self):
                    return [Machine.default(), Machine.parse("bare = true")]

                def test_of_the_class(self, oem6250):
                    assert [unit.inputs["enable"] for unit in oem6250.units] == [True, False]
            """,
        )
        result.assert_outcomes(passed=4)

    def test_bad_marker(self, pytester: pytest.Pytester) -> None:
        source = "import pytest\n@pytest.mark.oem6250(machines=3)\ndef test(oem6250): pass\n"
        result = run(pytester, source)
        result.assert_outcomes(errors=1)
        result.stdout.fnmatch_lines(["*oem6250 takes chain, machine, names*"])

    def test_bad_machine(self, pytester: pytest.Pytester) -> None:
        result = run(pytester, "import pytest\n@pytest.mark.oem6250(machine='a = 1')\ndef test(oem6250): pass\n")
        result.assert_outcomes(errors=1)
        result.stdout.fnmatch_lines(["*MachineError: machine of the test: a:*"])

    def test_asyncio(self, pytester: pytest.Pytester) -> None:
        result = run(
            pytester,
            """
            import asyncio, time
            import pytest

            async def test_virtual(oem6250):
                oem6250.line().write(b"1TPE\\r")
                await asyncio.sleep(0)
                oem6250.advance(1.0)

            async def test_behind_ports(oem6250_server):
                reader, writer = await asyncio.open_connection(*oem6250_server.address)
                began = time.monotonic()
                writer.write(b"ECHO0:DRIVE1:A10:V1:D40000:GO1\\r")
                for _ in range(6):
                    await asyncio.wait_for(reader.readuntil(b"> "), 10)
                assert time.monotonic() - began < 5.0
                assert oem6250_server.time_s > 10.0
                writer.close()
                await writer.wait_closed()
            """,
            "-p", "pytest_asyncio.plugin", "-o", "asyncio_mode=auto",
            "-o", "asyncio_default_fixture_loop_scope=function",
        )  # fmt: skip
        result.assert_outcomes(passed=2)

    def test_xdist(self, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("PYTHONPATH", str(REPOSITORY))
        pytester.makepyfile(
            """
            import pytest

            @pytest.mark.parametrize("number", range(4))
            def test_each_worker(oem6250, oem6250_server, number):
                oem6250.line().write(b"1TPE\\r")
                assert oem6250_server.address
                assert number < 3
            """
        )
        result = pytester.runpytest_subprocess(*PLUGIN, "-p", "xdist", "-n", "2", "-q")
        result.assert_outcomes(passed=3, failed=1)
        result.stdout.fnmatch_lines(["*oem6250 traffic*", '*0.000000000 u0 c0 > "1TPE\\r"*', "*oem6250 axes*"])


class TestReports:
    FAILING = """
        import pytest

        @pytest.mark.parametrize("n", [1])
        def test_fails(oem6250, n):
            oem6250.line().write(b"1TPE:NONSENSE\\r")
            oem6250.advance(1.5)
            oem6250.faults.enable_open().apply()
            oem6250.advance(0.5)
            assert 0

        def test_passes(oem6250):
            oem6250.line().write(b"1TPE\\r")

        def test_has_none():
            assert 0
        """

    def test_traffic_and_axes(self, pytester: pytest.Pytester) -> None:
        result = run(pytester, self.FAILING)
        result.assert_outcomes(failed=2, passed=1)
        result.stdout.fnmatch_lines(
            [
                "*- oem6250 traffic -*",
                '0.000000000 u0 c0 > "1TPE:NONSENSE\\r"',
                "*UNDEFINED LABEL*",
                "1.500000000 u0 ! fault_enable_open",
                "*- oem6250 axes -*",
                "virtual time 2.000000000 s",
                "axis 1: commanded +0 encoder +0 error +0 counts,*drive off; AS: 13 drive shutdown, 24 in target zone",
                "ER: none; ENABLE open",
                "last refused command: NONSENSE",
                "faults in force: enable_open",
            ]
        )
        assert result.stdout.str().count("- oem6250 traffic -") == 1

    def test_how_much(self, pytester: pytest.Pytester) -> None:
        for options in (("--oem6250-lines", "2"), ("-o", "oem6250_lines=2")):
            text = run(pytester, self.FAILING, *options).stdout.str()
            assert "lines before" in text and "1.500000000 u0 ! fault" in text and 'c0 > "1TPE' not in text

    def test_recording(self, pytester: pytest.Pytester) -> None:
        run(pytester, self.FAILING, "--oem6250-record", "failed")
        (path,) = (pytester.path / "failed").iterdir()
        assert path.name == "test_recording.py-test_fails-1.rec"
        assert read(path).complete
        outcome = replay(path)
        assert outcome.difference is None and outcome.complete and outcome.inputs == 1
        path.unlink()
        run(pytester, self.FAILING, "-o", "oem6250_record=failed")
        assert path.exists()

    def test_a_session_that_cannot_be_recorded(self, pytester: pytest.Pytester) -> None:
        (pytester.path / "failed").write_text("a file, not a directory")
        result = run(pytester, self.FAILING, "--oem6250-record", "failed")
        result.assert_outcomes(failed=2, passed=1)
        result.stdout.fnmatch_lines(["*- oem6250 recording -*", "not to be had: *"])

    def test_behind_ports(self, pytester: pytest.Pytester) -> None:
        result = run(
            pytester,
            """
            import socket

            def test_fails(oem6250_server):
                with socket.create_connection(oem6250_server.address) as host:
                    host.sendall(b"1TPE\\r")
                    while b"> " not in host.recv(100):
                        pass
                assert 0
            """,
            "--oem6250-record", "failed",
        )  # fmt: skip
        result.stdout.fnmatch_lines(["*oem6250 traffic*", '*u0 c1 > "1TPE\\r"', "*oem6250 axes*", "virtual time*"])
        (path,) = (pytester.path / "failed").iterdir()
        assert replay(path).difference is None


class TestOptions:
    def test_help(self, pytester: pytest.Pytester) -> None:
        result = pytester.runpytest_inprocess(*PLUGIN, "--help")
        result.stdout.fnmatch_lines(["*--oem6250-speed=waiting|N|max*", "*--oem6250-record=DIR*", "*oem6250_speed*"])
        result = pytester.runpytest_inprocess(*PLUGIN, "--markers")
        result.stdout.fnmatch_lines(["@pytest.mark.oem6250(machine=None*"])

    @pytest.mark.parametrize("options", [("--oem6250-speed", "0"), ("-o", "oem6250_speed=fast")])
    def test_a_speed_that_is_none(self, pytester: pytest.Pytester, options: tuple[str, ...]) -> None:
        result = run(pytester, "def test(): pass", *options)
        assert result.ret == pytest.ExitCode.USAGE_ERROR
        result.stderr.fnmatch_lines(["*is not waiting, max or a number above 0*"])

    def test_speed(self, pytester: pytest.Pytester) -> None:
        source = """
            import pytest

            def test_as_asked(oem6250_server):
                assert oem6250_server.speed == 50

            @pytest.mark.oem6250(speed="max")
            def test_marked(oem6250_server):
                assert oem6250_server.speed == "max"
            """
        run(pytester, source, "--oem6250-speed", "50").assert_outcomes(passed=2)

    def test_transcripts(self, pytester: pytest.Pytester) -> None:
        source = """
            def test_said(oem6250):
                oem6250.line().write(b"{}\\r")
                oem6250.advance(0.5)
                oem6250.assert_transcript("kept/said.txt")
            """
        first = run(pytester, source.format("1TPE"))
        first.stdout.fnmatch_lines(["*no transcript*--oem6250-update*"])
        run(pytester, source.format("1TPE"), "--oem6250-update").assert_outcomes(passed=1)
        assert "> 1TPE\\r" in (pytester.path / "kept/said.txt").read_text()
        run(pytester, source.format("1TPE")).assert_outcomes(passed=1)
        other = run(pytester, source.format("1TPC"))
        other.assert_outcomes(failed=1)
        other.stdout.fnmatch_lines(["*-> 1TPE*", "*+> 1TPC*"])


def test_the_plugin_itself_loads_nothing() -> None:
    """pytest loads it everywhere: it must bring nothing along but pytest."""
    program = (
        "import sys, pytest, importlib.util as u; before = set(sys.modules); "
        "spec = u.spec_from_file_location('p', 'clients/pytest_plugin.py'); m = u.module_from_spec(spec); "
        "spec.loader.exec_module(m); print(sorted(set(sys.modules) - before - {'p'}))"
    )
    found = subprocess.run([sys.executable, "-c", program], cwd=REPOSITORY, capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_the_sample_project(pytester: pytest.Pytester) -> None:
    """More than ten minutes of machine time in less than two seconds (measured again by `make bench`)."""
    sample = REPOSITORY / "tests" / "sample_host"
    for path in sample.glob("*.py"):
        (pytester.path / path.name).write_text(path.read_text())
    pytester.makeconftest(
        """
        import pytest

        @pytest.fixture(autouse=True)
        def told(oem6250):
            yield
            with open("machine_time", "a") as file:
                print(oem6250.time_s, file=file)
        """
    )
    began_s = time.process_time()
    result = pytester.runpytest_inprocess(*PLUGIN)
    spent_s = time.process_time() - began_s
    result.assert_outcomes(passed=5)
    assert sum(map(float, (pytester.path / "machine_time").read_text().split())) > 600.0
    assert spent_s < 2.0

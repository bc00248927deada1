"""Every example is run as its reader would run it, against an emulator behind real ports."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from clients.testing import Served
from emulator.engine.machine_code import CACHE_VARIABLE, cache_path
from tests.ports.served import wait_until

REPOSITORY = Path(__file__).parents[2]
EXAMPLES = REPOSITORY / "examples"
PATIENCE_S = 60


def run(*command: str) -> subprocess.CompletedProcess[str]:
    environment = {
        **os.environ,
        "PYTHONPATH": str(REPOSITORY),
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        CACHE_VARIABLE: str(cache_path().parent),
    }
    return subprocess.run(
        [sys.executable, *command], env=environment, capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )


def position(done: subprocess.CompletedProcess[str]) -> int:
    assert done.returncode == 0, done.stderr
    return int(done.stdout.removeprefix("position:"))


@pytest.fixture
def server() -> Iterator[Served]:
    with Served() as server:
        yield server


def url_of(server: Served, kind: str) -> str:
    host, port = server.address
    if "pty" in kind and os.name == "nt":
        # Meant: Windows has no pseudo-terminals.
        pytest.skip("no pseudo-terminals here")
    if kind == "visa pty":
        return f"ASRL{server.port}::INSTR"
    if kind == "visa socket":
        return f"TCPIP::{host}::{port}::SOCKET"
    return server.port if kind == "pty" else f"socket://{host}:{port}"


@pytest.mark.parametrize("kind", ["pty", "socket"])
def test_pyserial(server: Served, kind: str) -> None:
    assert position(run(str(EXAMPLES / "pyserial_move.py"), url_of(server, kind))) == pytest.approx(8000, abs=50)
    assert server.signals["axis1.position.commanded"] == pytest.approx(8000, abs=50), "it follows a drive that is off"


def test_pyserial_tells_what_the_unit_refuses(server: Served) -> None:
    server.inputs["enable"] = False
    done = run(str(EXAMPLES / "pyserial_move.py"), url_of(server, "socket"))
    assert done.returncode == 1
    assert "WARNING: ENABLE INPUT INACTIVE" in done.stderr


@pytest.mark.parametrize("kind", ["visa pty", "visa socket"])
def test_pyvisa(server: Served, kind: str) -> None:
    assert position(run(str(EXAMPLES / "pyvisa_move.py"), url_of(server, kind))) == pytest.approx(8000, abs=50)
    assert server.client.query("ERRLVL") == "4"


def test_two_axes(server: Served) -> None:
    done = run(str(EXAMPLES / "two_axes.py"), server.tcp_url)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("axis 1 is at") == 9
    assert done.stdout.count("axis 2 is at") == 6


def test_two_axes_are_stopped_by_the_supervisor() -> None:
    with Served(speed=1) as server:
        opened = threading.Thread(target=open_enable_in_motion, args=(server,))
        opened.start()
        done = run(str(EXAMPLES / "two_axes.py"), server.tcp_url)
        opened.join()
        assert (done.returncode, done.stdout.splitlines()[-1:]) == (1, ["stopped: enable input open"]), done.stderr
        assert not server.signals["axis1.moving"]


def open_enable_in_motion(server: Served) -> None:
    wait_until(lambda: bool(server.signals["axis1.moving"]))
    server.faults.enable_open().apply()


PYTEST = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "clients.pytest_plugin", str(EXAMPLES / "host_tests"))


def test_the_host_tests_on_the_emulator() -> None:
    done = run(*PYTEST)
    assert "3 passed" in done.stdout, done.stdout


def test_the_host_tests_on_a_machine(server: Served) -> None:
    """The machine is an emulator behind a port, of which the tests know nothing."""
    done = run(*PYTEST, "--real", server.tcp_url)
    assert "2 passed, 1 skipped" in done.stdout, done.stdout
    assert server.signals["axis1.position.commanded"] == pytest.approx(0, abs=2)
    assert any("1D5000" in line for line in server.traffic.lines())


def test_unittest() -> None:
    done = run("-m", "unittest", "discover", str(EXAMPLES / "unittest_style"))
    assert done.returncode == 0, done.stderr
    assert "Ran 2 tests" in done.stderr


def test_every_example_is_run() -> None:
    source = Path(__file__).read_text("utf-8")
    for path in EXAMPLES.iterdir():
        if path.name != "README.md":
            assert path.name in source, path.name

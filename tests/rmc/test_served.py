"""`oem6250 serve --device rmc151` as a process: what it announces, how it is used and ended, what it refuses."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from clients import RMC
from emulator.cli import main
from protocol.rmc.maps import Place
from protocol.rmc.words import reals
from tests.ports.served import PATIENCE_S, REPOSITORY, START_PATIENCE_S, wait_until

MACHINE = """
[rmc]
axes = 1
[axis1]
plant = { preset = "documented_cylinder" }
encoder = { counts_per_unit = 10_000 }
[axis1.rmc.parameters]
PosScale = 0.0001
ProportionalGain = 50.0
VelocityFF = 3.33
VelocityFFNegative = 4.35
PositionErrorTolerance = 1.0
"""


@pytest.fixture
def served(tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """The process, twenty times faster than time, and its port."""
    machine, announce = tmp_path / "press.toml", tmp_path / "announce"
    machine.write_text(MACHINE)
    options = ["--device", "rmc151", "--modbus", "127.0.0.1:0", "--speed", "20", "--announce", str(announce)]
    command = [sys.executable, "-m", "emulator", "serve", str(machine), *options]
    process = subprocess.Popen(command, cwd=REPOSITORY, stderr=subprocess.PIPE, text=True)
    wait_until(lambda: announce.exists() or process.poll() is not None, START_PATIENCE_S)
    told = json.loads(announce.read_text())
    assert (told["pid"], told["speed"]) == (process.pid, 20.0)
    yield process, int(told["modbus"][0].rpartition(":")[2])
    process.kill()
    process.communicate()


def test_a_host_moves_an_axis_and_a_signal_ends_it(served: tuple[subprocess.Popen[str], int]) -> None:
    process, port = served
    began = time.monotonic()
    with RMC("127.0.0.1", port, axes=1) as rmc:
        axis = rmc.axis[0]
        axis.acknowledged("enable_axis", enable=1)
        axis.move_absolute(40.0, speed=5.0, accel=50.0)
        axis.wait_in_position(timeout_s=PATIENCE_S)
        assert axis.position == pytest.approx(40.0, abs=0.05)
        assert time.monotonic() - began > 8.1 / 20.0, "paced: 8.1 s at twenty times the speed"
        process.send_signal(signal.SIGTERM)
        assert process.communicate(timeout=PATIENCE_S)[1] == ""
        assert process.returncode == 0


def test_no_reader_ever_sees_half_a_write(served: tuple[subprocess.Popen[str], int]) -> None:
    """Two masters write fifty variables at a time, all alike; two others read them."""
    _, port = served
    until = time.monotonic() + 1.0
    torn, reads = [], []

    def write(value: float) -> None:
        with RMC("127.0.0.1", port, axes=1) as rmc:
            while time.monotonic() < until:
                rmc.write_bits(Place(56, 0), reals(*[value] * 50))

    def read() -> None:
        with RMC("127.0.0.1", port, axes=1) as rmc:
            while time.monotonic() < until:
                seen = set(rmc.read_bits(Place(56, 0), 50))
                reads.append(seen)
                torn.extend([seen] if len(seen) > 1 else [])

    threads = [threading.Thread(target=write, args=(value,)) for value in (1.0, -2.5)]
    threads += [threading.Thread(target=read) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert torn == []
    assert set().union(*reads) >= set(reals(1.0, -2.5)), "both were seen"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--modbus", "127.0.0.1:0"], "argument --modbus: only with --device rmc151"),
        (["--device", "rmc151", "--tcp", "127.0.0.1:0"], "argument --tcp: not allowed with --device rmc151"),
        (["--device", "rmc151", "--units", "2"], "argument --units: not allowed with --device rmc151"),
        (["--device", "rmc151", "--state", "memory"], "argument --state: not allowed with --device rmc151"),
        (["--device", "rmc151", "--modbus", "502"], "argument --modbus: '502' is not HOST:PORT"),
        (["--device", "rmc200"], "argument --device: invalid choice: 'rmc200'"),
    ],
)
def test_options_that_do_not_go_together(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["serve", *arguments])
    assert ended.value.code == 2
    errors = capsys.readouterr().err
    assert errors.startswith(f"oem6250: {said}")
    assert errors.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[rmc]\naxes = 9", "rmc.axes: found 9; allowed: a whole number >= 1 and <= 8"),
        ("[rmc]\naxes = 2\nloop_us = 250", "rmc.loop_us: found 250; allowed: 1000 or more with 2 axes (250 us: 1)"),
        ("[rmc]\nloop_us = 300", "rmc.loop_us: found 300; allowed: 250 or 500 or 1000 or 2000 or 4000"),
        ("[axis3]\nencoder = { counts_per_rev = 8 }", "axis3: found a table; allowed: nothing unless rmc.axes is 3"),
        (
            "[axis1.rmc.parameters]\nPosScal = 1.0",
            "axis1.rmc.parameters.PosScal: found 1; allowed: a parameter such as",
        ),
        (
            "[axis1.rmc.parameters]\nOutputBias = 11.0",
            "axis1.rmc.parameters.OutputBias: found 11; allowed: -10 to 10 V",
        ),
        ("[rmc.register_names]\nTermX = 1", "rmc.register_names.TermX: found 1; allowed: a tag such as Term"),
        ("[rmc.mode_codes]\nvelocity_pid = 0", "rmc.mode_codes: found two modes with one code"),
    ],
)
def test_mistakes_in_the_machine_file(tmp_path: Path, text: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(text)
    assert main(["serve", "--device", "rmc151", str(path)]) == 2
    errors = capsys.readouterr().err
    assert errors.startswith(f"oem6250: {path}: {said}")
    assert errors.count("\n") == 1


def test_one_file_is_good_for_both_devices(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE)
    assert main(["check", str(path)]) == 0
    assert "axis 1: hydraulic cylinder" in capsys.readouterr().out


def test_an_address_others_reach_needs_leave(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serve", "--device", "rmc151", "--modbus", "0.0.0.0:0"]) == 2
    assert "add --allow-remote" in capsys.readouterr().err


def test_an_oem6250_imports_nothing_of_it() -> None:
    code = "import sys; from emulator.emulator import Emulator; Emulator(); print([name for name in sys.modules " + (
        "if name.startswith(('pymodbus', 'emulator.rmc')) and name not in ('emulator.rmc', 'emulator.rmc.tables')])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_its_kernel_is_kept_and_loaded_without_numba() -> None:
    code = (
        "import sys; from emulator.rmc.device import RmcDevice; RmcDevice(); from emulator.rmc import machine_code; "
        "print(machine_code.load_kernel().origin, 'numba' in sys.modules)"
    )
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["cache", "False"]

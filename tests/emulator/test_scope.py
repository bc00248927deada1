"""The scope by signal names, from Python and from the command line."""

from __future__ import annotations

import csv
import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from emulator.cli import main
from emulator.emulator import Emulator
from emulator.scope import ScopeError

MOVE = "DRIVE11\nV5\nA100\nD400\nSGP20\nGO1\n"


def moving_unit() -> Emulator:
    emulator = Emulator()
    emulator.unit().send(b"DRIVE11:V5:A100:D400:SGP20\r")
    emulator.advance(0.1)
    return emulator


def test_every_axis_signal_can_be_recorded_and_agrees_with_its_reading() -> None:
    emulator = moving_unit()
    unit = emulator.unit()
    names = list(unit.scope.signals())
    unit.scope.record(names, seconds=0.05)
    unit.send(b"GO1\r")
    emulator.advance(0.05)
    recording = unit.scope.read()
    emulator.advance_to(round(recording.time_s[-1] * 1e9))
    for name in names:
        now = unit.signals[name]
        if isinstance(now, str):
            now = int(now[::-1], 2)
        assert recording[name][-1] == now, name


def test_a_recording_around_a_trigger() -> None:
    emulator = moving_unit()
    unit = emulator.unit()
    unit.scope.record(["axis1.position.commanded"], seconds=0.1, trigger="axis1.moving > 0", pre_trigger_s=0.02)
    emulator.advance(0.5)
    assert unit.scope.read().trigger_s is None
    unit.send(b"GO1\r")
    emulator.advance(0.5)
    recording = unit.scope.read()
    assert recording.complete
    assert recording.trigger_s is not None
    assert recording.trigger_s - recording.time_s[0] == pytest.approx(0.02, abs=0.0003)
    assert recording.time_s[-1] - recording.time_s[0] == pytest.approx(0.1, abs=0.0006)
    before = recording["axis1.position.commanded"][recording.time_s < recording.trigger_s]
    assert set(before.tolist()) == {0}


def test_outputs_are_seen_as_the_program_switches_them() -> None:
    emulator = moving_unit()
    unit = emulator.unit()
    unit.scope.record(["output.3", "axis1.moving"], seconds=0.6)
    unit.send(b"OUTXX1:GO1:OUTXX0\r")
    emulator.advance(0.7)
    recording = unit.scope.read()
    on = recording.time_s[recording["output.3"] == 1]
    moving = recording.time_s[recording["axis1.moving"] == 1]
    assert on[0] <= moving[0]
    assert moving[-1] <= on[-1] <= moving[-1] + 0.005
    assert set(recording["output.3"][-100:].tolist()) == {0}


@pytest.mark.parametrize(
    ("names", "how", "wrong"),
    [
        (
            ["axis1.positon.error"],
            {},
            "no signal 'axis1.positon.error' can be recorded; the nearest: axis1.position.error",
        ),
        (["panel.leds"], {}, "no signal 'panel.leds'"),
        ([], {}, "no signals"),
        (["axis1.dac"], {"trigger": "axis1.dac above 3"}, "not of the form"),
        (["axis1.dac"], {"trigger": "axis1.dac > nan"}, "not of the form"),
        (["axis1.dac"], {"trigger": "axis3.dac > 1"}, "no signal 'axis3.dac'"),
        (["axis1.dac"], {"seconds": 1e8}, "are possible"),
        (["axis1.dac"], {"seconds": -1.0}, "not possible"),
        (["axis1.dac"], {"pre_trigger_s": 2.0}, "before the trigger"),
        (["axis1.dac"], {"every": 0}, "every 0 samples"),
    ],
)
def test_what_cannot_be_recorded_is_told_in_one_line(names: list[str], how: dict[str, object], wrong: str) -> None:
    unit = Emulator().unit()
    with pytest.raises(ScopeError) as raised:
        unit.scope.record(names, **{"seconds": 1.0, **how})  # type: ignore[arg-type]
    assert wrong in str(raised.value)
    assert "\n" not in str(raised.value)


def test_reading_before_recording_is_told() -> None:
    with pytest.raises(ScopeError, match="not been started"):
        Emulator().unit().scope.read()


def test_units_record_for_themselves() -> None:
    from emulator.machine import Machine

    emulator = Emulator([Machine.default(), Machine.default()])
    first, second = emulator.units
    first.scope.record(["axis1.moving"], seconds=0.1)
    second.send(b"DRIVE11:GO11\r")
    emulator.advance(0.2)
    assert first.scope.read()["axis1.moving"].sum() == 0


class TestCommand:
    """`oem6250 scope`."""

    @pytest.fixture
    def commands(self, tmp_path: Path) -> Path:
        path = tmp_path / "move.txt"
        path.write_text(MOVE)
        return path

    def test_a_csv_reads_back_exactly(self, commands: Path, tmp_path: Path) -> None:
        out = tmp_path / "move.csv"
        assert main(["scope", "--run", str(commands), "--out", str(out)]) == 0
        lines = [line for line in out.read_text().splitlines() if not line.startswith("#")]
        rows = list(csv.DictReader(lines))
        emulator = Emulator()
        unit = emulator.unit()
        unit.scope.record(["axis1.dac", "axis1.position.actual"], seconds=len(rows) * 280e-6)
        unit.send(MOVE.replace("\n", "\r").encode())
        emulator.advance(1.0)
        recording = unit.scope.read()
        assert [float(row["axis1.dac"]) for row in rows] == recording["axis1.dac"].tolist()
        assert [int(row["axis1.position.actual"]) for row in rows] == recording["axis1.position.actual"].tolist()
        assert [float(row["time_s"]) for row in rows] == recording.time_s.tolist()

    def test_a_numpy_file_holds_the_trigger(self, commands: Path, tmp_path: Path) -> None:
        out = tmp_path / "move.npz"
        how = [
            "--trigger",
            "axis1.moving > 0",
            "--pre-trigger",
            "0.01",
            "--seconds",
            "0.05",
            "--signals",
            "axis1.moving",
        ]
        assert main(["scope", "--run", str(commands), "--out", str(out), *how]) == 0
        with np.load(out) as arrays:
            assert arrays["time_s"][0] == pytest.approx(float(arrays["trigger_s"]) - 0.01, abs=0.0003)
            assert set(arrays["axis1.moving"].tolist()) == {0, 1}

    def test_the_list_names_every_signal(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["scope", "--list"]) == 0
        listed = {line.split()[0] for line in capsys.readouterr().out.splitlines()}
        assert listed == set(Emulator().unit().scope.signals())

    @pytest.mark.parametrize(
        ("arguments", "wrong"),
        [
            (["--out", "x.csv"], "--run FILE is needed"),
            (["--run", "MOVE"], "--out FILE is needed"),
            (["--run", "MOVE", "--out", "x.xls"], "found '.xls'; allowed: .csv, .npz, .png, .svg"),
            (["--run", "/nowhere/x", "--out", "x.csv"], "--run /nowhere/x: cannot be read"),
            (["--run", "MOVE", "--out", "/nowhere/x.csv"], "--out /nowhere/x.csv: cannot be written"),
            (["--run", "MOVE", "--out", "x.csv", "--signals", "dac"], "no signal 'dac'"),
            (
                ["--run", "MOVE", "--out", "x.csv", "--trigger", "axis2.moving > 0", "--seconds", "1"],
                "did not come true",
            ),
            (["/nowhere/m.toml", "--run", "MOVE", "--out", "x.csv"], "/nowhere/m.toml"),
        ],
    )
    def test_mistakes_are_one_line_and_status_2(
        self,
        arguments: list[str],
        wrong: str,
        commands: Path,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
        capsys: pytest.CaptureFixture[str],
    ) -> None:
        monkeypatch.chdir(tmp_path)
        with pytest.raises(SystemExit) as raised:
            main(["scope", *(str(commands) if word == "MOVE" else word for word in arguments)])
        assert raised.value.code == 2
        told = capsys.readouterr().err
        assert wrong in told
        assert told.count("\n") == 1

    def test_a_reader_may_stop_reading(self) -> None:
        done = subprocess.run(
            f"{sys.executable} -m emulator scope --list | head -1",
            shell=True,
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.startswith("axis1.position.commanded")
        assert done.stderr == ""

    def test_it_draws_a_picture_or_says_what_is_missing(
        self, commands: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        out = tmp_path / "move.png"
        arguments = ["scope", "--run", str(commands), "--out", str(out)]
        if importlib.util.find_spec("matplotlib"):
            assert main(arguments) == 0
            assert out.read_bytes().startswith(b"\x89PNG")
            return
        with pytest.raises(SystemExit) as raised:
            main(arguments)
        assert raised.value.code == 2
        assert "oem6250[plot]" in capsys.readouterr().err

    def test_it_runs_as_a_program(self, tmp_path: Path) -> None:
        out = tmp_path / "x.csv"
        done = subprocess.run(
            [sys.executable, "-m", "emulator", "scope", "--run", "-", "--out", str(out), "--signals", "axis2.dac"],
            input=MOVE,
            capture_output=True,
            text=True,
            check=True,
        )
        assert "1 signals" in done.stdout
        assert out.read_text().startswith("# units: axis2.dac [V]\n")

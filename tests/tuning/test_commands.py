"""`oem6250 tune` and `oem6250 sweep` from the command line: tables, pictures, mistakes in one line, SIGINT."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from emulator.cli import main
from emulator.controller.motion.servo import GAIN_COMMANDS
from emulator.tuning import commands, pictures
from emulator.tuning.measures import measure_step
from emulator.tuning.pictures import NoPictures, Shown, draw_signals, draw_step
from emulator.tuning.sweep_table import SORTS, WRITERS

PNG = b"\x89PNG"


@pytest.fixture
def machine(tmp_path: Path) -> str:
    path = tmp_path / "axis.toml"
    path.write_text("")
    return str(path)


def run(*arguments: str) -> int:
    try:
        return main(arguments)
    except SystemExit as ended:
        return int(ended.code or 0)


def test_tune_prints_a_line_a_step_and_the_commands_to_type(machine: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("tune", machine, "--axis", "2") == 0
    out = capsys.readouterr().out
    assert "A999 AD999 V30 D100" in out
    assert "over-damped" in out
    assert out.splitlines()[-1].startswith("type:   SGP,")


def test_tune_shows_given_gains_in_the_order_given(machine: str, tmp_path: Path) -> None:
    out = tmp_path / "made"
    assert run("tune", machine, "--gains", "SGP=15,SGV=2", "SGP=0.5", "--out", str(out)) == 0
    with (out / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["SGP"], row["SGV"]) for row in rows] == [("15.0", "2.0"), ("0.5", "0.0")]
    assert rows[1]["verdict"] == "over-damped"
    if pictures.available():
        assert (out / "step-02.png").read_bytes().startswith(PNG)


def test_sweep_prints_the_best_and_writes_the_table(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "table.json"
    arguments = ("--sgp", "2:20:4", "--sgv", "0,10", "--duration", "0.2", "--best", "3", "--jobs", "2")
    assert run("sweep", machine, *arguments, "--out", str(out)) == 0
    printed = capsys.readouterr()
    assert "8 of 8 samples" in printed.out
    assert printed.err == ""
    stored = json.loads(out.read_text())
    assert stored["complete"] is True
    assert len(stored["columns"]["SGP"]) == 8


def test_progress_shows_when_asked_for(machine: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("sweep", machine, "--sgp", "2:20:4", "--duration", "0.2", "-v", "--jobs", "1") == 0
    assert "4 of 4 samples" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ("tune", "--axis", "3"),
        ("tune", "--gains", "SGP"),
        ("tune", "--gains", "SGQ=1"),
        ("tune", "--duration", "0"),
        ("tune", "--duration", "nan"),
        ("tune", "--distance", "0"),
        ("sweep",),
        ("sweep", "--axis", "0", "--sgp", "1"),
        ("sweep", "--sgp", "5:1"),
        ("sweep", "--sgp", "1:5"),
        ("sweep", "--sgp", "1e9"),
        ("sweep", "--sgp", "1", "--vary", "mass=1:2"),
        ("sweep", "--sgp", "1", "--vary", "plant.nothing=1"),
        ("sweep", "--sgp", "1", "--vary", "plant.loop_time_constant_s=-1"),
        ("sweep", "--sgp", "1", "--out", "table.xls"),
        ("sweep", "--sgp", "1", "--out", "/nowhere/at/all.csv"),
        ("sweep", "--sgp", "1", "--random", "0"),
        ("sweep", "--sgp", "1", "--jobs", "0"),
        ("sweep", "--sgp", "1", "--sort", "beauty"),
    ],
)
def test_mistakes_are_one_line_and_status_2(
    arguments: tuple[str, ...], machine: str, capsys: pytest.CaptureFixture[str]
) -> None:
    command, *options = arguments
    assert run(command, machine, *options) == 2
    err = capsys.readouterr().err
    assert err.startswith("oem6250: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize(("text", "told"), [("servo = 1", "servo"), ("bare = true", "ENABLE"), ("nonsense", "TOML")])
def test_machines_that_will_not_do_are_told_in_one_line(
    text: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(text)
    assert run("tune", str(path)) == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1


def test_a_cluster_without_dask_is_told_in_one_line(
    machine: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert run("sweep", machine, "--sgp", "1", "--cluster", "tcp://127.0.0.1:9") == 2
    assert "oem6250[cluster]" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT cannot be sent to another process there")
def test_sigint_ends_a_sweep_with_what_has_been_done(machine: str, tmp_path: Path) -> None:
    out = tmp_path / "table.json"
    command = [sys.executable, "-m", "emulator", "sweep", machine, "--sgp", "2:20:100", "--sgv", "0:20:100", "-v"]
    process = subprocess.Popen([*command, "--out", str(out)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stderr is not None
    seen = b""
    deadline = time.monotonic() + 60
    while b" s left" not in seen and time.monotonic() < deadline:
        seen += process.stderr.read1(200)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"Traceback" not in err
    stored = json.loads(out.read_text())
    assert stored["complete"] is False
    assert 0 < len(stored["columns"]["SGP"]) < stored["wanted"] == 10_000


def test_what_the_command_line_offers_is_what_there_is() -> None:
    """The names are written out where the options are made, so that `--help` need not import the rest."""
    assert set(commands.SORTS) == set(SORTS)
    assert commands.SWEPT_GAINS == GAIN_COMMANDS
    assert set(commands.TABLE_ENDINGS) == set(WRITERS)


def test_pictures_of_steps_and_of_any_signals(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    times = np.arange(0.0, 0.2, 1e-3)
    command = np.where(times > 0.0, 100, 0)
    actual = np.round(100 * (1 - np.exp(-times / 0.02) * np.cos(60 * times)))
    measures = measure_step(times, command, actual, times, start=0, setpoint=100)
    draw_step(tmp_path / "step.png", times, command, actual, times, measures, "a step")
    draw_signals(tmp_path / "some.svg", times, {"a": Shown(actual, "counts"), "b": Shown(times, "V")}, "two panels")
    assert (tmp_path / "step.png").read_bytes().startswith(PNG)
    text = (tmp_path / "some.svg").read_text()
    assert text.count('id="axes_') == 2
    with pytest.raises(ValueError, match="no signals"):
        draw_signals(tmp_path / "none.png", times, {}, "nothing")


def test_without_matplotlib_there_is_one_clear_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(NoPictures, match=r"oem6250\[plot\]"):
        draw_signals(tmp_path / "x.png", [0.0], {"a": Shown([1.0], "V")}, "x")

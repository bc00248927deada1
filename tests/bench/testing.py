"""What a test with the emulator costs: the fixture's start, and ten minutes of machine time."""

from __future__ import annotations

import importlib.util
import time
from pathlib import Path
from typing import Any

from tests.bench.figures import Effort, Figure, Reach

SAMPLE = Path(__file__).parents[1] / "sample_host" / "press.py"
MACHINE = "[axis1.travel]\nhome_from_rev = 25.0\nhome_to_rev = 26.0\n"
MACHINE_TIME_S = 600.0


def measure(effort: Effort) -> list[Figure]:
    """Both in this process, with everything imported and the kernel loaded."""
    start_s()
    starts = [1e3 * start_s() for _ in range(effort.times(10, 50))]
    sessions = [session_s() for _ in range(effort.times(1, 5))]
    return [
        Figure(name="test fixture, start", unit="ms", samples=starts, reach=Reach(bound=50)),
        Figure(
            name="ten minutes of machine time, host program polling",
            unit="s",
            samples=sessions,
            reach=Reach(bound=2.0),
            note="tests/sample_host: homing, download, strokes",
        ),
    ]


def start_s() -> float:
    """A new emulator with its line, up to its first answer."""
    from clients.testing import emulated

    began_s = time.perf_counter()
    with emulated() as emu:
        line = emu.line()
        line.write(b"!1TPE\r")
        if b"*1TPE+0" not in line.read(1.0):
            raise RuntimeError("no answer")
        return time.perf_counter() - began_s


def session_s() -> float:
    """Wall seconds of ten minutes in the life of the sample host's machine, scaled to exactly ten minutes."""
    from clients.testing import emulated

    began_s = time.perf_counter()
    with emulated(MACHINE) as emu:
        line = emu.line()
        press = _sample().Press(line, line.sleep)
        press.set_up()
        press.download("CYCLE", _sample().CYCLE)
        press.switch_on()
        press.home()
        while emu.time_s < MACHINE_TIME_S:
            press.run_cycles()
        return (time.perf_counter() - began_s) * MACHINE_TIME_S / emu.time_s


def _sample() -> Any:
    specification = importlib.util.spec_from_file_location("press", SAMPLE)
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module

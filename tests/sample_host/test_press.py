"""The customer's tests of the press program: more than ten minutes of machine time, in about a second."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from clients.testing import Emulated

_SPEC = importlib.util.spec_from_file_location("press", Path(__file__).with_name("press.py"))
assert _SPEC is not None and _SPEC.loader is not None
press_module = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(press_module)
Press, Stopped, CYCLE = press_module.Press, press_module.Stopped, press_module.CYCLE

MACHINE = """
[axis1.travel]
home_from_rev = 25.0
home_to_rev = 26.0
"""


@pytest.fixture
def oem6250_machine() -> str:
    return MACHINE


@pytest.fixture
def press(oem6250: Emulated):
    line = oem6250.line()
    machine = Press(line, line.sleep)
    machine.set_up()
    return machine


def test_homing_finds_the_switch(oem6250: Emulated, press) -> None:
    press.switch_on()
    press.home()
    assert oem6250.signals["axis1.position.true"] == pytest.approx(26.0, abs=0.01)
    assert press.position() == pytest.approx(0, abs=8)
    assert 25 < oem6250.time_s < 60


def test_a_download_is_verified(press) -> None:
    press.download("CYCLE", CYCLE)


def test_production(oem6250: Emulated, press) -> None:
    """Ten strokes take five minutes of machine time."""
    press.download("CYCLE", CYCLE)
    press.switch_on()
    press.home()
    began_s = oem6250.time_s
    assert press.run_cycles() == 10
    assert oem6250.time_s - began_s == pytest.approx(10 * (2 * 10.1 + 2.0), rel=0.02)
    assert press.position() == pytest.approx(0, abs=8)


def test_a_drive_fault_in_the_fourth_stroke(oem6250: Emulated, press) -> None:
    press.download("CYCLE", CYCLE)
    press.switch_on()
    press.home()
    fault = oem6250.faults.drive_fault(axis=1).at(oem6250.time_s + 75.0, lasting_s=20.0)
    with pytest.raises(Stopped) as stopped:
        press.run_cycles()
    assert {13, 14} <= stopped.value.bits
    fault.assert_fired()
    assert press.strokes() == 3
    oem6250.advance(0.5)  # the motor coasts
    oem6250.assert_no_motion(5.0)
    press.recover()
    assert not fault.in_force
    assert oem6250.signals["axis1.position.true"] == pytest.approx(26.0, abs=0.01)
    assert press.run_cycles() == 13
    press.move_to(10.0)
    assert press.position() == pytest.approx(40000, abs=8)


def test_broken_limit_switches(oem6250: Emulated, press) -> None:
    press.switch_on()
    switches = oem6250.faults.limit_open
    with switches(axis=1, direction="positive") as fault, switches(axis=1, direction="negative"):
        with pytest.raises(Stopped):
            press.home()
        fault.assert_fired()
    press.home()

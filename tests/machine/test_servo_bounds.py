"""Numbers of the machine file that would make the servo compute with what is no number are refused by name."""

from __future__ import annotations

import pytest

from emulator.machine import Machine
from emulator.machine_errors import MachineError


@pytest.mark.parametrize("value", ["nan", "inf", "0.0", "-1.0", "1e7"])
@pytest.mark.parametrize("name", ["sgp", "sgi", "sgv", "sgvf", "sgaf"])
def test_units_of_the_gains(name: str, value: str) -> None:
    with pytest.raises(MachineError, match=f"servo.unit_factors.{name}"):
        Machine.parse(f"[servo.unit_factors]\n{name} = {value}\n")


@pytest.mark.parametrize(
    "row", ["volts_per_rev = nan", "volts_per_rev = inf", "volts_at_zero = nan", "volts_at_zero = 11"]
)
def test_analog_sensor(row: str) -> None:
    with pytest.raises(MachineError, match=r"axis1\.ani"):
        Machine.parse(f"[axis1.ani]\n{row}\n")

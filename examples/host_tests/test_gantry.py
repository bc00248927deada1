"""Tests of the gantry: the first ones run anywhere, the last one breaks a wire and needs the emulator."""

import pytest
from gantry import Gantry

from clients import MotionError, UnitError


def test_it_goes_where_it_is_told(gantry: Gantry) -> None:
    gantry.go(x_mm=12.5, y_mm=-5.0)
    assert gantry.place_mm == pytest.approx((12.5, -5.0), abs=0.2)
    gantry.go(x_mm=0, y_mm=0)
    assert gantry.place_mm == pytest.approx((0, 0), abs=0.2)


def test_it_does_not_move_when_switched_off(gantry: Gantry) -> None:
    gantry.switch_off()
    with pytest.raises(UnitError, match="DRIVE SHUTDOWN"):
        gantry.go(x_mm=1, y_mm=0)
    assert gantry.place_mm == pytest.approx((0, 0), abs=0.2)


def test_an_end_of_travel_is_an_error(gantry: Gantry, oem6250) -> None:  # type: ignore[no-untyped-def]
    oem6250.faults.limit_open(axis=1, direction="positive").at(oem6250.time_s + 0.5)
    with pytest.raises(MotionError, match="positive hard limit hit"):
        gantry.go(x_mm=200, y_mm=0)

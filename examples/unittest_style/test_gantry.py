"""The gantry of ../host_tests with the standard library's unittest: each test has an emulator, `self.emu`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "host_tests"))

from gantry import Gantry

from clients import UnitError
from clients.testing import EmulatedMixin


class TestGantry(EmulatedMixin):
    names = {"door": "enable"}  # noqa: RUF012

    def setUp(self) -> None:
        super().setUp()
        self.gantry = Gantry(self.emu.client)
        self.gantry.switch_on()

    def test_a_long_way_takes_no_time(self) -> None:
        self.gantry.go(x_mm=400, y_mm=100)
        x_mm, y_mm = self.gantry.place_mm
        self.assertAlmostEqual(x_mm, 400, delta=0.2)
        self.assertAlmostEqual(y_mm, 100, delta=0.2)
        self.assertGreater(self.emu.time_s, 10)

    def test_an_open_door_keeps_it_where_it_is(self) -> None:
        self.emu.inputs["door"] = False
        with self.emu.no_motion(), self.assertRaises(UnitError) as refusal:
            self.gantry.go(x_mm=1, y_mm=0)
        self.assertIn("ENABLE INPUT", refusal.exception.text)

"""For tests of the standard library's unittest: a mixin that gives each test an emulator."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar
from unittest import TestCase

if TYPE_CHECKING:
    from clients.testing.in_process import Emulated
    from emulator.machine import Machine


class EmulatedMixin(TestCase):
    """``self.emu`` is a new emulator for each test; ``machine``, ``units``, ``names`` of the class say which.

    class TestHoming(EmulatedMixin):
        machine = "axis.toml"

        def test_home(self):
            self.emu.client.send("DRIVE1")
    """

    machine: ClassVar[Machine | str | Path | None] = None
    units: ClassVar[int] = 1
    names: ClassVar[Mapping[str, str]] = {}
    emu: Emulated

    def setUp(self) -> None:
        from clients.testing.in_process import Emulated

        super().setUp()
        self.emu = Emulated(self.machine, units=self.units, names=self.names)
        self.addCleanup(self.emu.close)

"""A device as the engine thread drives it: virtual time and nothing to say by itself."""

from __future__ import annotations

from collections.abc import Sequence

from emulator.channel import OutputLike

from .device import RmcDevice


class RmcUnit:
    """An RMC among the units of an engine thread; masters come in by `EngineThread.call`."""

    def __init__(self, device: RmcDevice) -> None:
        self.device = device

    @property
    def now_ns(self) -> int:
        """Virtual time."""
        return self.device.now_ns

    @property
    def busy(self) -> bool:
        """A target or an output is on its way."""
        return self.device.busy

    def input_full(self, channel: int) -> bool:
        """It has no channels of bytes."""
        return False

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        """It has no channels of bytes."""

    def advance(self, until_ns: int) -> None:
        """Run to a time."""
        self.device.advance(until_ns)

    def take_output(self) -> Sequence[OutputLike]:
        """It never speaks unasked."""
        return ()

    def detach(self, channel: int) -> None:
        """It has no channels of bytes."""

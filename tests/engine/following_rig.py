"""A slave and its master in an engine: axis 1 follows, the encoder of axis 2 is turned by hand, count by count."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from emulator.engine import AxisHardware, Engine, MasterSource, RatioSegment, ServoRates, rates_for

SLAVE, MASTER = 0, 1
ALL_CLOSED = 0xFFF
SETTLED = 6
"""System updates after which a slave has reached what a resting master asks for."""


class Gearing:
    """An engine whose axis 1, drive on, has the encoder of axis 2 as its master; that axis's drive is off."""

    def __init__(
        self,
        *,
        rates: ServoRates | None = None,
        prediction: bool = True,
        corner_hz: float | None = None,
        sign: int = 1,
        master: AxisHardware | None = None,
        **options: Any,
    ) -> None:
        self.engine = Engine([AxisHardware(), master or AxisHardware()], rates=rates or rates_for(2, 4), **options)
        self.engine.set_wires(ALL_CLOSED)
        self.engine.set_position_error_limit(SLAVE, 0)
        self.engine.run(self.engine.next_system_update_ns)
        self.engine.enable(SLAVE)
        self.engine.set_master(SLAVE, source=MasterSource.ENCODER, master_index=MASTER, sign=sign)
        self.engine.set_prediction(SLAVE, prediction)
        self.engine.set_master_filter(SLAVE, corner_hz)

    @property
    def period_s(self) -> float:
        return self.engine.rates.system_ns / 1e9

    @property
    def slave(self) -> int:
        return self.engine.commanded_position(SLAVE)

    @property
    def master(self) -> int:
        return self.engine.encoder_position(MASTER)

    def follow(self, segments: Iterable[RatioSegment], *, preset: bool = False, start_at: int | None = None) -> None:
        self.engine.start_following(SLAVE, tuple(segments), preset=preset, start_at=start_at)

    def at_ratio(self, ratio: Fraction | int) -> None:
        """Follow at a constant ratio from here on."""
        self.follow([RatioSegment(None, Fraction(ratio), Fraction(ratio))])

    def turn(self, *steps: int) -> None:
        """Turn the master by some counts in each system update, and come to rest just after the last."""
        for counts in steps:
            self.engine.slip_encoder(MASTER, counts)
            self.pass_updates(1)

    def turn_to(self, places: Iterable[int]) -> None:
        """Turn the master so that its encoder shows these positions at the next system updates."""
        for place in places:
            self.turn(place - self.master)

    def pass_updates(self, count: int) -> None:
        for _ in range(count):
            until_ns = self.engine.next_system_update_ns
            while self.engine.time_ns < until_ns:
                self.engine.run(until_ns)

    def settle(self) -> None:
        """Let the slave reach what the resting master asks for."""
        self.pass_updates(SETTLED)


def rounded(position: Fraction) -> int:
    """Whole counts, halves upwards, as commanded positions are rounded."""
    return (2 * position.numerator + position.denominator) // (2 * position.denominator)

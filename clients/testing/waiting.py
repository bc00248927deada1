"""What "at rest" and "no motion" mean to a test."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from protocol.status import AxisStatus

if TYPE_CHECKING:
    from emulator.controller import Controller

AT_REST_COUNTS = 2
"""How far a shaft may stir and still count as not having moved: the servo hunts by a count (design choice)."""


def in_zone(controller: Controller, axis_index: int) -> bool:
    """No profile is running and the axis is where it should be: AS bit 24, with STRGTD and STRGTV in force."""
    return bool(controller.engine.status(axis_index) & AxisStatus.IN_TARGET_ZONE.mask)


def at_rest(controller: Controller) -> bool:
    """Nothing is under way, and every axis with its drive on is in its target zone."""
    if not controller.powered:
        return True
    axes = range(controller.settings.axes)
    engine = controller.engine
    return not controller.busy and all(in_zone(controller, i) for i in axes if engine.is_enabled(i))


class MotionWatch:
    """Sees any motion of some axes between its making and `complain`.

    `look` is to be called whenever something has happened; a profile that began and ended between two looks still
    shows, because its end is something that happens.
    """

    def __init__(self, controller: Controller, axis_indexes: Iterable[int], *, tolerance_counts: int) -> None:
        self._controller = controller
        self._began = {index: controller.engine.encoder_position(index) for index in axis_indexes}
        self._tolerance = tolerance_counts
        self._seen: list[str] = []
        self.look()

    def look(self) -> None:
        """Remember the first motion there is."""
        if self._seen:
            return
        engine, at_s = self._controller.engine, self._controller.now_ns / 1e9
        for index, began in self._began.items():
            moved = engine.encoder_position(index) - began
            if engine.is_moving(index):
                self._seen.append(f"axis {index + 1} had a profile running at {at_s:.6f} s")
            elif abs(moved) > self._tolerance:
                self._seen.append(f"axis {index + 1} had moved by {moved:+d} counts at {at_s:.6f} s")

    def complain(self) -> None:
        """AssertionError if there was motion."""
        self.look()
        if self._seen:
            raise AssertionError(f"there was to be no motion, but {self._seen[0]}")


@contextmanager
def listed(watches: list[Callable[[], None]], look: Callable[[], None]) -> Iterator[None]:
    """Have a function called whenever something has happened, within a block."""
    watches.append(look)
    try:
        yield
    finally:
        watches.remove(look)

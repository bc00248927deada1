"""One axis of a profile while PCOMP reads it: its segments planned as they come, its loops as they close."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, TypeVar

from emulator.controller.compiled.loops import Loop, Planned, Planner, Speed, plan_loop, plan_segment
from protocol.errors import NEST_LEVEL_TOO_DEEP, CommandError, invalid_conditions

MAX_NESTED_LOOPS = 4
"""PLOOPs that may be open at once on an axis (assumed M)."""

Move = TypeVar("Move")
Piece = TypeVar("Piece")


@dataclass(slots=True)
class _Open(Generic[Move, Speed]):
    """A PLOOP without its PLN yet, and where the axis was at it."""

    loop: Loop[Move]
    speed: Speed
    position: Fraction


class AxisBuilder(Generic[Move, Piece, Speed]):
    """The profile of one axis so far; ``speed`` and ``position`` (counts) are those at its present end."""

    def __init__(
        self, axis_index: int, planner: Planner[Move, Piece, Speed], *, position: Fraction, at_rest: Speed
    ) -> None:
        self._axis = axis_index + 1
        self._planner: Planner[Move, Piece, Speed] = planner
        self._open: list[_Open[Move, Speed]] = []
        self._endless = False
        self._at_rest: Speed = at_rest
        self.planned: list[Planned[Piece]] = []
        self.position = position
        self.speed: Speed = at_rest

    def add(self, move: Move) -> None:
        """A segment.  Raises what the planner raises."""
        planned, self.speed = plan_segment(self._planner, move, self.speed)
        self.position += planned.travel
        if self._open:
            self._open[-1].loop.body.append(move)
        elif not self._endless:
            self.planned.append(planned)

    def open_loop(self, passes: int | None) -> None:
        """PLOOP.

        Raises:
            CommandError: NEST LEVEL TOO DEEP.
        """
        if len(self._open) == MAX_NESTED_LOOPS:
            raise CommandError(NEST_LEVEL_TOO_DEEP)
        self._open.append(_Open(Loop(passes), self.speed, self.position))

    def close_loop(self, *, keep: bool) -> None:
        """PLN; ``keep`` False if the axis has no segments yet, whose loop a bare PLOOP has opened.  Raises Unsteady.

        Raises:
            CommandError: INVALID CONDITIONS FOR COMMAND-AXIS n, there is no loop to close.
        """
        if not self._open:
            raise invalid_conditions(self._axis)
        opened = self._open.pop()
        if not keep:
            return
        planned, self.speed = plan_loop(self._planner, opened.loop, opened.speed)
        self.position = opened.position + planned.travel
        if self._open:
            self._open[-1].loop.body.append(opened.loop)
        elif not self._endless:
            self.planned.append(planned)
            self._endless = planned.endless

    @property
    def in_loop(self) -> bool:
        """A PLOOP is open."""
        return bool(self._open)

    def finish(self) -> None:
        """END.

        Raises:
            CommandError: INVALID CONDITIONS FOR COMMAND-AXIS n, a PLOOP has no PLN.
        """
        if self._open:
            raise invalid_conditions(self._axis)

    @property
    def ends_moving(self) -> bool:
        """The profile comes to an end, and not to rest."""
        return not self._endless and self.speed != self._at_rest

"""A unit whose axis 1 follows encoder 2, turned count by count from outside, as a host sees it.

Axis 2 has its drive off and its encoder is turned on the shaft by so many counts between two system updates, so every
master position is known exactly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tests.controller.session import SYSTEM_NS, S, Session

ARRIVE = (0,) * 5
"""System updates after which a slave has arrived behind a master that stopped: two to get there, two for prediction to
see that it has stopped, and one to begin with."""


class FollowingRig(Session):
    """Axis 1 is the slave, encoder 2 the master; ``commands`` are carried out after FOLMAS and FOLEN1."""

    def __init__(self, *commands: str, machine: str = "", update_ns: int = SYSTEM_NS, **defaults: str | int) -> None:
        super().__init__(machine, **({"COMEXC": 1} | defaults))
        self.update_ns = update_ns
        self.ok("1DRIVE1", "1FOLMAS+21", "1FOLEN1", *commands)
        self.master_counts = 0

    def turn(self, steps: Iterable[int]) -> Iterator[int]:
        """Turn the master by each step in a system update of its own; the slave's position after each update."""
        for step in steps:
            if step:
                self.unit.do("slip_encoder", axis=2, counts=step)
                self.master_counts += step
            self.advance(self.update_ns / S)
            yield int(self.number("axis1.position.commanded"))

    def travel(self, counts: int, *, step: int = 50) -> int:
        """Turn the master by so many counts and let the slave arrive; its position."""
        sign = 1 if counts >= 0 else -1
        whole, rest = divmod(abs(counts), step)
        *_, position = self.turn([sign * step] * whole + [sign * rest, *ARRIVE])
        return position

    def following_bits(self, axis: int = 1) -> str:
        """FS without separators: bit n is ``[n - 1]``."""
        return self.look(f"!{axis}TFS").removeprefix(f"{axis}TFS").replace("_", "")

    def following_bit(self, number: int, axis: int = 1) -> bool:
        return self.following_bits(axis)[number - 1] == "1"

"""An emulator that notes what only its inside knows: `python -m tests.bench.stamped RECORD serve ...`.

It is the program itself, command line and all, around controllers that also note when, in virtual time, each output
left, how virtual time lies to the wall's, and the exact line an axis moves on. On exit RECORD holds that as JSON, and
stderr the engine thread's own account of its lateness.
"""

from __future__ import annotations

import json
import logging
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict

from emulator.channel import ControllerLike, OutputLike
from emulator.cli import main
from emulator.controller import Controller
from emulator.options import ServeOptions
from emulator.server import build_controllers


class Record(TypedDict):
    """What a run leaves behind. `outputs` are (virtual ns, text)."""

    virtual_ahead_ns: int
    """Virtual minus monotonic wall time: the largest difference seen. A controller is told the time it is, never a
    later one, and always a little after, so the largest is the truest."""
    line: tuple[int, float, float] | None
    """Axis 1 at constant velocity: a virtual time, the exact position then (counts), the velocity (counts/s)."""
    trajectory_ns: int
    outputs: list[tuple[int, str]]


class Stamped:
    """A controller that takes notes; to the engine thread it is like any other."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.record: Record = {
            "virtual_ahead_ns": -(2**63),
            "line": None,
            "trajectory_ns": controller.engine.rates.trajectory_ns,
            "outputs": [],
        }

    @property
    def now_ns(self) -> int:
        return self._controller.now_ns

    @property
    def busy(self) -> bool:
        return self._controller.busy

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        self._compare(at_ns)
        self._controller.receive(data, at_ns=at_ns, channel=channel)
        if self.record["line"] is None:
            self._look_for_line()

    def advance(self, until_ns: int) -> None:
        self._compare(until_ns)
        self._controller.advance(until_ns)

    def take_output(self) -> Sequence[OutputLike]:
        outputs = self._controller.take_output()
        self.record["outputs"] += [(output.at_ns, output.data.decode("latin-1")) for output in outputs]
        return outputs

    def input_full(self, channel: int) -> bool:
        return self._controller.input_full(channel)

    def detach(self, channel: int) -> None:
        self._controller.detach(channel)

    def _compare(self, at_ns: int) -> None:
        self.record["virtual_ahead_ns"] = max(self.record["virtual_ahead_ns"], at_ns - time.monotonic_ns())

    def _look_for_line(self) -> None:
        """Once axis 1 has a velocity and no acceleration any more, its profile is a straight line."""
        state = self._controller.engine.profile_state(0)
        if state.velocity and not state.acceleration:
            self.record["line"] = (self._controller.engine.next_trajectory_ns, state.position, state.velocity)


def run(path: Path, arguments: Sequence[str]) -> int:
    """The command line with controllers that take notes; the record of the first unit goes to `path`."""
    made: list[Stamped] = []

    def build(options: ServeOptions) -> Sequence[ControllerLike]:
        for controller in build_controllers(options):
            assert isinstance(controller, Controller)
            made.append(Stamped(controller))
        return made

    logging.getLogger("oem6250.server").setLevel(logging.INFO)
    status = main(arguments, build=build)
    if made:
        path.write_text(json.dumps(made[0].record))
    return status


if __name__ == "__main__":
    sys.exit(run(Path(sys.argv[1]), sys.argv[2:]))

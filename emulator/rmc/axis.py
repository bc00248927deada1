"""One axis of an RMC as Python sees it between two loops: fields by name, error bits, the plan of its target."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

from emulator.engine.kernels import Record
from emulator.engine.layout import places_of
from protocol.rmc.bits import ControlMode, ErrorBits

from .layout import AXIS
from .memory import Memory
from .ramps import LINEAR, S_CURVE, Ramp, plan_distance
from .target import RAMPS, rest

_PLACES = places_of(AXIS)


class Complaint(IntEnum):
    """Last Error Number of an axis. The numbers are our own (assumed): no page lists Delta's."""

    UNKNOWN_COMMAND = 1
    BAD_PARAMETER = 2
    NOT_ENABLED = 3
    WRONG_MODE = 4
    NOT_BUILT = 5
    CLIPPED_TO_TRAVEL_LIMIT = 6
    VALUE_OUT_OF_RANGE = 7
    WRITTEN_WHILE_ENABLED = 8


class Refused(Exception):
    """A command that cannot be carried out; the axis stays as it is."""

    def __init__(self, complaint: Complaint) -> None:
        super().__init__(complaint.name)
        self.complaint = complaint


class Axis:
    """Windows on the records of one axis."""

    def __init__(self, memory: Memory, index: int) -> None:
        self.memory = memory
        self.index = index
        self.last_error = 0
        self.began: tuple[float, ...] = ()
        """Number and parameters of the motion command last begun."""
        self.sync_group: int | None = None
        """Group of the sync move last begun, None for any other command."""
        self._plan: tuple[Ramp, ...] = ()
        self._words = memory.axis[index]

    @property
    def plan(self) -> tuple[Ramp, ...]:
        """The plan last begun."""
        return self._plan

    @property
    def record(self) -> Record:
        """The record itself, for functions of the kernel that are called from Python."""
        return self.memory.axes[self.index]

    def __getitem__(self, field: str) -> float:
        word, is_int = _PLACES[field]
        return self._words.ints[word] if is_int else self._words.floats[word]

    def integer(self, field: str) -> int:
        """An integer field."""
        return self._words.ints[_PLACES[field][0]]

    def write(self, **fields: float) -> None:
        """Set fields."""
        self.memory.write(self.index, **fields)

    @property
    def mode(self) -> ControlMode:
        """Current Control Mode."""
        return ControlMode(self.integer("mode"))

    @property
    def next_mode(self) -> ControlMode:
        """Next Pos/Vel Control Mode."""
        return ControlMode(self.integer("next_mode"))

    @property
    def shape(self) -> int:
        """Of ramps, as Requested Jerk chooses it."""
        return S_CURVE if self.integer("s_curve") else LINEAR

    @property
    def moving(self) -> bool:
        """Something is under way that ends by itself."""
        return not self.integer("target_done") or bool(self.integer("halt_wanted"))

    @property
    def running(self) -> tuple[float, ...]:
        """`began`, as long as its plan is what the target follows."""
        under_way = self.integer("generator") == RAMPS and not self.integer("halted")
        return self.began if under_way and not self.integer("target_done") else ()

    def complain(self, bit: ErrorBits, complaint: Complaint) -> None:
        """Set an error bit; the next loop sees it rise."""
        self.last_error = complaint
        self.write(errors=self.integer("errors") | bit)

    def clear_faults(self) -> None:
        """Clear error bits whose cause has gone, and the halts."""
        live = self.integer("errors") & self.integer("live_errors")
        self.write(errors=live, seen_errors=live & self.integer("seen_errors"), halted=0, external_halt=0)

    def follow(self, plan: Sequence[Ramp], *, end: float | None = None) -> None:
        """Let the target run through a plan from where it is, ending at `end` (default: where the plan leads)."""
        start = self["target_position"]
        self._plan = tuple(plan)
        if not plan:
            rest(self.record)
            self.write(target_position=start if end is None else end)
            return
        self.memory.store_plan(self.index, plan)
        goal = start + plan_distance(plan) if end is None else end
        self.write(plan_start=start, plan_end=goal, generator=RAMPS, target_done=0)

    def shift(self, change: float) -> None:
        """Move the origin: every position of the axis changes together."""
        names = [
            *("actual_position", "previous_position", "shown_position", "target_position", "command_position"),
            *("plan_start", "plan_end", "gear_slave_at", "gear_slave_to", "track_goal"),
        ]
        self.write(position_offset=self["position_offset"] + change, **{name: self[name] + change for name in names})

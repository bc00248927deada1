"""Motion that has been commanded but waits: for a GOWHEN condition, or for a trigger (TRGFN).

Whatever starts motion (GO, GOL, FSHFC, FSHFD, a compiled profile) hands what it would do to ``start``, which does it
at once on an axis without a condition, and otherwise when the condition has come true.  Nobody looks in between: the
servo watches positions, an alarm stands for a time, inputs and triggers tell when they change.

Of GOWHEN only the reference's summary survives.  Assumed: a condition that is true already lets the motion begin at
once (with ER bit 14); a condition is for one start; S and K forget it whether or not a start is waiting.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol

from emulator.controller.registration.master_reached import MasterReached
from protocol.status import ErrorStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

Begin = Callable[[], None]
BeginAt = Callable[[int], None]


class StartCondition(Protocol):
    """What a start may wait for."""

    def holds(self, controller: Controller) -> bool:
        """Whether it is true now; one that has come true is not asked again."""
        ...

    def await_it(self, controller: Controller, axis_index: int) -> None:
        """Have ``HeldStarts.look`` called when it may have come true; ``axis_index`` is the axis that waits."""
        ...


class Awaited(NamedTuple):
    """A condition with the axis it was set for and the command that set it."""

    axis_index: int
    command: str
    condition: StartCondition


@dataclass(slots=True)
class HeldStart:
    """Motion of one or more axes with what each still waits for."""

    axes: tuple[int, ...]
    begin: Begin
    waiting_for: list[Awaited]
    in_servo: bool = False
    """The servo has the motion already and holds it back to the very count of master travel."""


class HeldStarts:
    """The conditions of one unit's next starts, and the starts that wait."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._conditions: list[dict[str, StartCondition]] = [{} for _ in range(controller.settings.axes)]
        self._held: list[HeldStart] = []

    def reset(self) -> None:
        """Power-up: no condition, nothing waits."""
        self._held.clear()
        for conditions in self._conditions:
            conditions.clear()

    @property
    def pending(self) -> bool:
        """Some start waits."""
        return bool(self._held)

    def holds(self, axis_index: int) -> bool:
        """A start of this axis waits (AS bit 26)."""
        return any(axis_index in held.axes for held in self._held)

    def set_condition(self, axis_index: int, command: str, condition: StartCondition) -> None:
        """The next start of an axis waits for this, in place of what the same command set before."""
        self._conditions[axis_index][command] = condition

    def has_condition(self, axis_index: int, command: str) -> bool:
        """A command's condition waits for a start of this axis, or a start for it."""
        waiting = any((axis_index, command) == each[:2] for held in self._held for each in held.waiting_for)
        return waiting or command in self._conditions[axis_index]

    def remove_condition(self, axis_index: int, command: str) -> None:
        """The next start of an axis does not wait for what this command set."""
        self._conditions[axis_index].pop(command, None)

    def start(self, axes: Sequence[int], begin: Begin, *, begin_at: BeginAt | None = None) -> None:
        """Begin the motion of axes when everything they wait for has come true: at once if that is nothing.

        A start that waited on one of the axes is given up for this one.  A condition that is true already sets ER bit
        14 and holds nothing.

        ``begin_at``, for a slave that can begin at a master position (its travel in counts), is called at once in place
        of ``begin`` later, if that is all the axis waits for.
        """
        self._give_up(axes)
        awaited = [each for axis_index in axes for each in self._take(axis_index)]
        held = HeldStart(tuple(axes), begin, [each for each in awaited if not each.condition.holds(self._controller)])
        if len(held.waiting_for) < len(awaited):
            self._controller.faults.latch(ErrorStatus.GOWHEN_ALREADY_TRUE)
        if not held.waiting_for:
            begin()
            return
        self._held.append(held)
        self._show(axes)
        for each in held.waiting_for:
            each.condition.await_it(self._controller, each.axis_index)
        if begin_at is not None and len(held.waiting_for) == 1:
            self._hand_over(held, begin_at)

    def _hand_over(self, held: HeldStart, begin_at: BeginAt) -> None:
        """Let the servo begin the motion where the slave's own master comes to the position waited for."""
        axis_index, _, condition = held.waiting_for[0]
        if not isinstance(condition, MasterReached) or condition.axis_index != axis_index:
            return
        master_travel = condition.begins_at(self._controller)
        if master_travel is not None:
            held.in_servo = True
            begin_at(master_travel)

    def withdraw(self, axes: Iterable[int]) -> None:
        """A new start is coming: motion that the servo holds back for axes at rest is taken from it again."""
        for axis_index in axes:
            in_servo = any(held.in_servo and axis_index in held.axes for held in self._held)
            if in_servo and self._controller.engine.following_ratio(axis_index) == 0:
                self._controller.engine.cancel_profile(axis_index)

    def _take(self, axis_index: int) -> list[Awaited]:
        """What the next start of an axis waits for; the one after it waits for nothing."""
        conditions, self._conditions[axis_index] = self._conditions[axis_index], {}
        return [Awaited(axis_index, command, condition) for command, condition in conditions.items()]

    def look(self) -> None:
        """Something a start waits for may have come true: begin what waits no longer."""
        for held in list(self._held):
            self._let_go(held, [each for each in held.waiting_for if not each.condition.holds(self._controller)])

    def fulfil(self, axis_index: int, command: str) -> None:
        """What an axis waits for has happened (its trigger has come)."""
        for held in list(self._held):
            self._let_go(held, [each for each in held.waiting_for if (axis_index, command) != each[:2]])

    def _let_go(self, held: HeldStart, waiting_for: list[Awaited]) -> None:
        held.waiting_for = waiting_for
        if waiting_for or held not in self._held:
            return
        self._held.remove(held)
        self._show(held.axes)
        if not held.in_servo and all(self._controller.engine.is_enabled(axis_index) for axis_index in held.axes):
            held.begin()

    def forget(self, axes: Iterable[int]) -> None:
        """Stop, kill, a drive shut down: neither a start nor a condition is left on these axes."""
        axes = tuple(axes)
        self._give_up(axes)
        for axis_index in axes:
            self._conditions[axis_index].clear()

    def _give_up(self, axes: Sequence[int]) -> None:
        given_up = [held for held in self._held if not set(axes).isdisjoint(held.axes)]
        self._held = [held for held in self._held if held not in given_up]
        for held in given_up:
            self._show(held.axes)

    def _show(self, axes: Iterable[int]) -> None:
        for axis_index in axes:
            self._controller.refresh_axis_bits(axis_index)

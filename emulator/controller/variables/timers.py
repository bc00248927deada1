"""The millisecond timer: TIMST, TIMSTP, TTIM and what TIM reads.

TIMINT is stored and reported only: its alarm interrupts the computer behind a bus card, and this unit has no bus
(assumed L)."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles, require_no_fields
from emulator.controller.waits import NEVER
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, CommandError
from protocol.reply_shapes import numbers_line

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NS_PER_MS = 1_000_000
LARGEST_MS = 999_999_999
"""The timer stands still there (range assumed M, standing still L)."""

FROM_ZERO, GO_ON = "0", "1"


class Timer:
    """Elapsed milliseconds of virtual time while started; it survives no RESET (assumed)."""

    def __init__(self) -> None:
        self._started_ns: int | None = None
        self._before_ns = 0

    def start(self, now_ns: int, *, from_zero: bool) -> None:
        """TIMST."""
        if from_zero:
            self._before_ns = 0
        elif self._started_ns is not None:
            return
        self._started_ns = now_ns

    def stop(self, now_ns: int) -> None:
        """TIMSTP: the reading stays."""
        if self._started_ns is not None:
            self._before_ns += now_ns - self._started_ns
            self._started_ns = None

    def elapsed_ms(self, now_ns: int) -> int:
        """What TTIM shows."""
        running_ns = 0 if self._started_ns is None else now_ns - self._started_ns
        return min((self._before_ns + running_ns) // NS_PER_MS, LARGEST_MS)

    def reaches_ns(self, elapsed_ms: int) -> int:
        """When the reading becomes this, NEVER if it stands still."""
        if self._started_ns is None or elapsed_ms > LARGEST_MS:
            return NEVER
        return self._started_ns + elapsed_ms * NS_PER_MS - self._before_ns


@handles("TIMST")
def start(controller: Controller, command: Command) -> Lines:
    """TIMST0 from zero, TIMST1 on from where it stands."""
    if command.mask not in (FROM_ZERO, GO_ON):
        raise CommandError(INCORRECT_DATA)
    controller.timer.start(controller.now_ns, from_zero=command.mask == FROM_ZERO)
    return None


@handles("TIMSTP")
def stop(controller: Controller, command: Command) -> Lines:
    """TIMSTP."""
    require_no_fields(command)
    controller.timer.stop(controller.now_ns)
    return None


@handles("TTIM")
def report(controller: Controller, command: Command) -> Lines:
    """TTIM."""
    assert command.row is not None
    return [numbers_line(command.row, None, [Decimal(controller.timer.elapsed_ms(controller.now_ns))], [0])]

"""How far the machines may run: virtual time made from the wall's.

Controllers never look at a clock; this object tells the engine thread up to which virtual nanosecond it may run
them. It is pure logic over an injected wall clock, so every promise below is tested without sleeping.

Paced (x1, xN): virtual time is the wall time since the start, times the speed, in exact integer arithmetic, so that
it does not drift over hours. When the machines are behind (the process was stopped, the host was busy), they catch up
at full speed in slices of a few milliseconds of wall time each, and input is served between slices. No virtual time
is lost over a stall.

A host that cannot keep the asked speed never catches up. That is told from a stall by its result: over a second of
uninterrupted catching up the gap has not become smaller. Then virtual time is re-anchored where the machines are, the
gap is forgotten, and the factor reached is reported (every ten seconds at most). Nothing ever asks for more work
in order to catch up.

`max` (speed None): while any machine is busy (motion, dwell, wait, running program) virtual time runs as fast as the
CPU allows, slice after slice; while all are idle it goes at x1, because nothing would be gained by burning the CPU.
Input that arrives during a free run takes effect at the time the machines have reached.
"""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

SLICE_WALL_NS = 4_000_000
"""A slice of catching up aims at this much wall time: the longest that input waits behind it (design choice)."""
MIN_SLICE_NS = 1_000_000
MAX_SLICE_NS = 1_000_000_000
FIRST_SLICE_NS = 20_000_000
STALL_WALL_NS = 250_000_000
"""A gap or a slice this long on the wall means the process was not running; it says nothing about the host's speed."""
WINDOW_WALL_NS = 1_000_000_000
REPORT_EVERY_WALL_NS = 10_000_000_000
LATENESS_SAMPLES = 8192


class Lateness(NamedTuple):
    """How old the machines were, in wall nanoseconds, just before they were advanced: latest samples and the worst."""

    p50_ns: int
    p99_ns: int
    max_ns: int
    samples: int


class LatenessMeter:
    """Percentiles over the last `LATENESS_SAMPLES` samples, and the maximum since the start, in bounded memory."""

    def __init__(self) -> None:
        self._ring = array("q", bytes(8 * LATENESS_SAMPLES))
        self._count = 0
        self._max_ns = 0

    def add(self, late_ns: int) -> None:
        self._ring[self._count % LATENESS_SAMPLES] = late_ns
        self._count += 1
        self._max_ns = max(self._max_ns, late_ns)

    def read(self) -> Lateness:
        kept = sorted(self._ring[: min(self._count, LATENESS_SAMPLES)])
        if not kept:
            return Lateness(0, 0, 0, 0)
        return Lateness(kept[len(kept) // 2], kept[len(kept) * 99 // 100], self._max_ns, self._count)


class _Window(NamedTuple):
    """Where a stretch of uninterrupted catching up began."""

    wall_ns: int
    reached_ns: int
    gap_ns: int


class Clock:
    """Virtual time for one engine thread. All times are integer nanoseconds; not for use from several threads.

    `speed` is virtual over wall time, None for `max`. `wall` is a monotonic clock in nanoseconds. `report` is called
    with the factor reached when the host cannot keep the speed. Raises ValueError for a speed that is not positive.
    """

    def __init__(
        self,
        speed: float | None = 1.0,
        *,
        start_ns: int = 0,
        wall: Callable[[], int] = time.monotonic_ns,
        report: Callable[[float], None] = lambda factor: None,
    ) -> None:
        if speed is not None and not 0 < speed < float("inf"):
            raise ValueError(f"speed must be a positive number, not {speed}")
        ratio = max(Fraction(1 if speed is None else speed).limit_denominator(10**9), Fraction(1, 10**9))
        self._numerator, self._denominator = ratio.numerator, ratio.denominator
        self._wall = wall
        self._report = report
        self._may_run_free = speed is None
        self._anchor_wall_ns = self._asked_at_wall_ns = self._ended_wall_ns = wall()
        self._anchor_ns = start_ns
        self._slice_ns = FIRST_SLICE_NS
        self._window: _Window | None = None
        self._reported_wall_ns: int | None = None
        self.reached_ns = start_ns
        """How far the machines have been run."""
        self.free_running = False
        """True while `max` runs as fast as the CPU allows."""
        self.lateness = LatenessMeter()

    def now_ns(self) -> int:
        """The virtual time it is by the wall; in a free run, the time reached."""
        return self.reached_ns if self.free_running else self._virtual_ns(self._wall())

    def skip(self, ns: int) -> None:
        """So much virtual time is to pass at once, beside what the wall gives: the machines catch up with it."""
        self._anchor_ns += ns

    @property
    def behind(self) -> bool:
        """True while the machines have more to catch up than one slice."""
        return not self.free_running and self.now_ns() - self.reached_ns > self._slice_ns

    def input_ns(self) -> int:
        """When bytes that have just arrived take effect: now, or while catching up as near to it as a slice allows."""
        if self.free_running:
            return self.reached_ns
        return min(self._virtual_ns(self._wall()), self.reached_ns + self._slice_ns)

    def tick_ns(self) -> int:
        """How far to run all machines in the tick that begins now; call `ran_to` with it when that is done."""
        self._asked_at_wall_ns = wall_ns = self._wall()
        if self.free_running:
            return self.reached_ns + self._slice_ns
        return max(self.reached_ns, min(self._virtual_ns(wall_ns), self.reached_ns + self._slice_ns))

    def ran_to(self, at_ns: int, *, busy: bool) -> None:
        """All machines have been run to `at_ns`; `busy` says whether any has something under way."""
        began_ns = self._asked_at_wall_ns
        ended_ns = self._wall()
        if not self.free_running and busy:
            late_ns = self._virtual_ns(began_ns) - self.reached_ns
            self.lateness.add(late_ns * self._denominator // self._numerator)
        full_slice = at_ns - self.reached_ns >= self._slice_ns
        self.reached_ns = at_ns
        if full_slice:
            self._judge(began_ns, ended_ns)
            self._fit_slice(ended_ns - began_ns)
        else:
            self._window = None
        self._ended_wall_ns = ended_ns
        self._choose_run(busy=busy, wall_ns=ended_ns)

    def _virtual_ns(self, wall_ns: int) -> int:
        return self._anchor_ns + (wall_ns - self._anchor_wall_ns) * self._numerator // self._denominator

    def _fit_slice(self, cost_wall_ns: int) -> None:
        if cost_wall_ns > 2 * SLICE_WALL_NS:
            self._slice_ns = max(self._slice_ns // 2, MIN_SLICE_NS)
        elif cost_wall_ns < SLICE_WALL_NS // 2:
            self._slice_ns = min(self._slice_ns * 2, MAX_SLICE_NS)

    def _judge(self, began_ns: int, ended_ns: int) -> None:
        """Re-anchor when a whole window of catching up has not made the gap smaller."""
        if self.free_running:
            return
        gap_ns = self._virtual_ns(ended_ns) - self.reached_ns
        if self._window is None or self._was_stopped(began_ns, ended_ns):
            self._window = _Window(ended_ns, self.reached_ns, gap_ns)
            return
        elapsed_ns = ended_ns - self._window.wall_ns
        if elapsed_ns < WINDOW_WALL_NS:
            return
        if gap_ns >= self._window.gap_ns:
            self._anchor(ended_ns)
            self._say((self.reached_ns - self._window.reached_ns) / elapsed_ns, ended_ns)
            self._window = None
        else:
            self._window = _Window(ended_ns, self.reached_ns, gap_ns)

    def _was_stopped(self, began_ns: int, ended_ns: int) -> bool:
        """A pause of the process between slices, or in one that was long although it could have been cut shorter."""
        paused = began_ns - self._ended_wall_ns >= STALL_WALL_NS
        return paused or (ended_ns - began_ns >= STALL_WALL_NS and self._slice_ns > MIN_SLICE_NS)

    def _say(self, factor: float, wall_ns: int) -> None:
        if self._reported_wall_ns is None or wall_ns - self._reported_wall_ns >= REPORT_EVERY_WALL_NS:
            self._reported_wall_ns = wall_ns
            self._report(factor)

    def _anchor(self, wall_ns: int) -> None:
        self._anchor_wall_ns, self._anchor_ns = wall_ns, self.reached_ns

    def _choose_run(self, *, busy: bool, wall_ns: int) -> None:
        if not self._may_run_free:
            return
        if self.free_running and not busy:
            self._anchor(wall_ns)
        self.free_running = busy

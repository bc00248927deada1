"""Time that moves only while the host waits, for hosts that sit behind real ports and know nothing of it.

A host that commands a move of 30 s and waits for its end should not wait 30 s. Nobody tells us that a host waits; it
shows by silence. The rules:

1. Characters take their time, each way, as on a line of 9600 baud. So a host that polls without a pause sees time
   pass with every poll, and a move comes to an end under its eyes.
2. A host from which nothing has come for the *quiet time* (of the wall's clock) is taken to wait. Then, while anything
   is under way, time runs as fast as the processor allows: up to the next thing said to a host, which starts a new
   quiet time, or until nothing is under way any more.
3. While nothing is under way and the host waits, time goes at the wall's rate: nothing would be gained by more.
4. Otherwise time stands still, however long the host computes.
5. Whoever runs the test may say that the host waits (no quiet time is needed), that it does not (time stands still
   whatever happens), or let a given time pass.

What follows from rule 2: how long a host means to wait is not known, so a host that sleeps 50 ms in the middle of a
move may wake to find it over. Where that matters the test says how much time passes (`skip`), or is run at a speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from emulator.agenda import Agenda
from emulator.channel import ControllerLike, HearsOfConnections, OutputLike
from emulator.clock import Clock

QUIET_NS = 5_000_000
"""Silence of a host that counts as waiting, wall ns (design choice: a few times what waking a process takes)."""
CHARACTER_NS = 1_041_667
"""Time of a character at 9600 baud, 8N1."""
SLICE_NS = 100_000_000
"""Virtual time between two looks at the ports while time runs freely."""
STRIDE_NS = 10_000_000
"""Virtual time between two looks at what a unit has said: how late a host can be in hearing it."""


class HostPacedClock(Clock):
    """A clock by the rules above, for one line.

    Args:
        start_ns: virtual time at the beginning.
        quiet_ns: silence that counts as waiting, wall ns.
        character_ns: what each character to and from a host takes; 0 on a line that is timed by itself.
        wall: a monotonic clock, ns.
    """

    def __init__(
        self,
        *,
        start_ns: int = 0,
        quiet_ns: int = QUIET_NS,
        character_ns: int = CHARACTER_NS,
        wall: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        super().__init__(1.0, start_ns=start_ns, wall=wall)
        self._quiet_ns = quiet_ns
        self._character_ns = character_ns
        self._heard_wall_ns = self._idle_wall_ns = wall()
        self._owed_ns = 0
        self._skip_to_ns = start_ns
        self._busy = False
        self._waits = 0
        self._holds = 0
        self._stopped_ns: int | None = None

    # What the test says.

    def declare_waiting(self, by: int) -> None:
        """The host waits (+1), or that is over (-1)."""
        self._waits += by

    def declare_working(self, by: int) -> None:
        """The host does not wait, whatever it looks like (+1), or that is over (-1)."""
        self._holds += by

    def skip(self, ns: int) -> None:
        self._skip_to_ns = max(self._skip_to_ns, self.reached_ns) + ns

    # What passes.

    def exchanged(self, at_ns: int, characters: int) -> None:
        """Characters have passed, either way, with the unit at a virtual time."""
        self._heard_wall_ns = self._wall()
        self._owed_ns += characters * self._character_ns
        self.reached_ns = max(self.reached_ns, at_ns)

    def stopped_at(self, at_ns: int) -> None:
        """The unit has come no further than this in the slice asked for: it has said something."""
        self._stopped_ns = at_ns

    @property
    def stops_at_output(self) -> bool:
        """A unit is to stop when it has said something."""
        return self._skip_to_ns <= self.reached_ns

    # What the engine thread asks.

    def now_ns(self) -> int:
        return self.reached_ns

    @property
    def behind(self) -> bool:
        return self._skip_to_ns > self.reached_ns

    def input_ns(self) -> int:
        """Bytes that have just arrived take effect after the time of the characters before them."""
        owed_ns, self._owed_ns = self._owed_ns, 0
        return self.reached_ns + owed_ns

    def tick_ns(self) -> int:
        self._stopped_ns = None
        wall_ns = self._wall()
        idle_ns, self._idle_wall_ns = wall_ns - self._idle_wall_ns, wall_ns
        if self.behind:
            return min(self._skip_to_ns, self.reached_ns + SLICE_NS)
        if not self._host_waits(wall_ns):
            return self.reached_ns
        return self.reached_ns + (SLICE_NS if self._busy else min(idle_ns, SLICE_NS))

    def ran_to(self, at_ns: int, *, busy: bool) -> None:
        self.reached_ns = at_ns if self._stopped_ns is None else self._stopped_ns
        self._busy = busy
        self.free_running = busy and self._host_waits(self._wall())

    def _host_waits(self, wall_ns: int) -> bool:
        if self._holds:
            return False
        return self._waits > 0 or wall_ns - self._heard_wall_ns >= self._quiet_ns


class TimetabledUnit:
    """A unit to which things are done at virtual times, and which tells a host-paced clock what passes.

    Has the face of a controller. Anything may stand on its agenda; it is carried out on the engine thread, between two
    samples.
    """

    def __init__(self, inner: ControllerLike, clock: HostPacedClock | None = None) -> None:
        self._inner = inner
        self._clock = clock
        self._outputs: list[OutputLike] = []
        self.agenda = Agenda()

    @property
    def now_ns(self) -> int:
        return self._inner.now_ns

    @property
    def busy(self) -> bool:
        return self._inner.busy

    def input_full(self, channel: int) -> bool:
        return self._inner.input_full(channel)

    def receive(self, data: bytes, *, at_ns: int, channel: int) -> None:
        """Bytes from a host; what they have to wait for comes first."""
        self._run_to(at_ns)
        if self._clock is not None:
            self._clock.exchanged(at_ns, len(data))
        self._inner.receive(data, at_ns=at_ns, channel=channel)

    def advance(self, until_ns: int) -> None:
        """Run to a virtual time, or, where a clock wants that, to the first thing said on the way."""
        clock = self._clock
        if clock is None or not clock.stops_at_output:
            self._run_to(until_ns)
            return
        while self._inner.now_ns < until_ns:
            self._run_to(min(until_ns, self._inner.now_ns + STRIDE_NS))
            if self._heard_something() or not self._inner.busy:
                clock.stopped_at(self._inner.now_ns)
                return

    def take_output(self) -> Sequence[OutputLike]:
        self._heard_something()
        taken, self._outputs = self._outputs, []
        if self._clock is not None and taken:
            self._clock.exchanged(self._inner.now_ns, sum(len(output.data) for output in taken))
        return taken

    def attach(self, channel: int) -> None:
        """A connection was made."""
        if isinstance(self._inner, HearsOfConnections):
            self._inner.attach(channel)

    def detach(self, channel: int) -> None:
        self._inner.detach(channel)

    def at(self, at_ns: int, function: Callable[[], None]) -> None:
        """Have a function called at a virtual time."""
        self.agenda.enter(at_ns, function)

    def _heard_something(self) -> bool:
        self._outputs += self._inner.take_output()
        return bool(self._outputs)

    def _run_to(self, at_ns: int) -> None:
        while self.agenda.next_ns <= at_ns:
            due_ns = max(self.agenda.next_ns, self._inner.now_ns)
            self._inner.advance(due_ns)
            self.agenda.carry_out(due_ns)
        self._inner.advance(at_ns)

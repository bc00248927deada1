"""What befalls characters between the line and the unit: they may be spoiled, lost, or held back.

Nothing here happens by itself: faults of the control surface (``emulator.faults``) put functions in and take them out.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from emulator.controller.output import Output
from emulator.controller.waits import NEVER

Spoil = Callable[[int, bytes], bytes]
"""Gets the virtual time (ns) and characters, returns what is left of them."""


class Disturbances:
    """The disturbances of one unit's line; ``active`` is False while there are none and nothing is held back.

    Args:
        take: what the unit has said since last asked. It is asked before anything changes, so that each character
            meets the disturbances of its own time.
    """

    def __init__(self, take: Callable[[], Sequence[Output]]) -> None:
        self._take = take
        self._heard: list[Spoil] = []
        self._said: list[Spoil] = []
        self._delay_ns = 0
        self._note: Callable[[int], None] = lambda at_ns: None
        self._late: deque[Output] = deque()
        self.active = False

    def add(self, *, heard: Spoil | None, said: Spoil | None) -> Callable[[], None]:
        """Pass what the unit hears, or says, through a function; what to call to end that."""
        self._pull()
        places = [(spoils, spoil) for spoils, spoil in ((self._heard, heard), (self._said, said)) if spoil is not None]
        for spoils, spoil in places:
            spoils.append(spoil)
        self.active = True

        def remove() -> None:
            self._pull()
            for spoils, spoil in places:
                spoils.remove(spoil)
            self._look()

        return remove

    def delay(self, delay_ns: int, note: Callable[[int], None]) -> None:
        """Hold all output back for a time; ``note`` hears of each piece."""
        self._pull()
        self._delay_ns, self._note, self.active = delay_ns, note, True

    def no_delay(self) -> None:
        """Hold nothing back any more; what is held comes at once."""
        self._pull()
        self._delay_ns = 0
        self._look()

    def clear(self) -> None:
        """The unit is switched off: what was held back is never heard."""
        self._late.clear()
        self._look()

    @property
    def next_ns(self) -> int:
        """When something held back is due; NEVER if nothing is."""
        return self._late[0].at_ns if self._late else NEVER

    def hear(self, at_ns: int, data: bytes) -> bytes:
        """What of a host's characters reaches the unit."""
        for spoil in self._heard:
            data = spoil(at_ns, data)
        return data

    def say(self, now_ns: int) -> list[Output]:
        """What of the unit's output has reached the line by now."""
        self._pull()
        due: list[Output] = []
        while self._late and (self._late[0].at_ns <= now_ns or not self._delay_ns):
            late = self._late.popleft()
            due.append(late._replace(at_ns=min(late.at_ns, now_ns)))
        self._look()
        return due

    def _pull(self) -> None:
        """Put what the unit has said through the disturbances there are."""
        for output in self._take():
            data = output.data
            for spoil in self._said:
                data = spoil(output.at_ns, data)
            if data and self._delay_ns:
                self._note(output.at_ns)
            if data:
                self._late.append(Output(output.at_ns + self._delay_ns, data, output.channel))

    def _look(self) -> None:
        self.active = bool(self._heard or self._said or self._delay_ns or self._late)

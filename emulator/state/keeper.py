"""The thread that writes the state file, and what it does when it cannot.

Snapshots come through a queue; each is answered once it is durable, on this thread. While writing fails nothing waits:
the answer comes at once, what is owed is remembered and tried again every second, and the person is told when it begins
and when it is over.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping
from queue import Empty, SimpleQueue

from emulator.logs import event_line
from emulator.state.contents import Contents
from emulator.state.errors import StateError
from emulator.state.store import Store

RETRY_S = 1.0
"""How often a file that cannot be written is tried again (design choice)."""

_log = logging.getLogger("oem6250.state")
Snapshots = Mapping[int, Contents]
Job = tuple[Snapshots, Callable[[], None]]


class Keeper:
    """Owns an open `Store` from `start` to the end of `stop`."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._jobs: SimpleQueue[Job | None] = SimpleQueue()
        self._owed: dict[int, Contents] = {}
        self._failing = False
        self._try_again_s = 0.0
        self._thread = threading.Thread(target=self._run, name="state", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def submit(self, snapshots: Snapshots, done: Callable[[], None]) -> None:
        """Make snapshots durable, then call `done` on the keeper's thread; without waiting while writing fails."""
        self._jobs.put((snapshots, done))

    def stop(self, timeout_s: float) -> bool:
        """Work off what was submitted, try once more what is owed, close the file; False if that takes longer."""
        self._jobs.put(None)
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        while (job := self._next_job()) is not None:
            self._owed.update(job[0])
            if not self._failing or time.monotonic() >= self._try_again_s:
                self._pay()
            job[1]()
        if self._owed:
            self._pay()
        if self._owed:
            _log.error(event_line("state file not written at the end", file=self._store.path))
        self._store.close()

    def _next_job(self) -> Job | None:
        while True:
            try:
                return self._jobs.get(timeout=self._patience_s())
            except Empty:
                self._pay()

    def _patience_s(self) -> float | None:
        return max(0.0, self._try_again_s - time.monotonic()) if self._owed else None

    def _pay(self) -> None:
        """Write what is owed. Whatever goes wrong, this thread goes on: replies wait for it."""
        try:
            self._store.write(self._owed)
        except Exception as error:
            self._note_failure(error)
            return
        self._owed.clear()
        if self._failing:
            self._failing = False
            _log.warning(event_line("state file written again", file=self._store.path))

    def _note_failure(self, error: Exception) -> None:
        self._try_again_s = time.monotonic() + RETRY_S
        if not self._failing:
            self._failing = True
            surprise = None if isinstance(error, StateError) else error
            _log.warning(event_line("state file not written, trying again", reason=error), exc_info=surprise)

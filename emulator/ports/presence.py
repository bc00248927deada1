"""Whether any host has the pseudo-terminal open.

Our own side keeps the slave open (see `pty`), so the kernel never reports a hang-up; on Linux inotify tells of each
open and close of the device node. Like events that nobody has read yet are told as one, so two hosts that open within
the same moment count as one host. Elsewhere, or when inotify instances have run out, a host is taken to be present
always.
"""

from __future__ import annotations

import logging
import sys
from typing import Any, NamedTuple

from emulator.logs import event_line

_log = logging.getLogger("oem6250.port")


class Change(NamedTuple):
    """What has happened since the last look: has the last host left in between, and is any there now."""

    left: bool
    present: bool


class Presence:
    """Counts who has the node open."""

    def __init__(self, node: str) -> None:
        self._opens = 0
        self._inotify = _watch(node)

    @property
    def known(self) -> bool:
        """False where openings cannot be watched."""
        return self._inotify is not None

    def fileno(self) -> int:
        """The descriptor that becomes readable when there is something to poll; only if `known`."""
        return int(self._inotify.fileno())

    def poll(self) -> Change:
        """Work off what has happened. Cheap when nothing has."""
        if self._inotify is None:
            return Change(left=False, present=True)
        from inotify_simple import flags

        left = False
        for event in self._inotify.read(timeout=0):
            if event.mask & flags.OPEN:
                self._opens += 1
            elif event.mask & (flags.CLOSE_WRITE | flags.CLOSE_NOWRITE):
                left = left or self._opens == 1
                self._opens = max(0, self._opens - 1)
        return Change(left=left, present=self._opens > 0)

    def close(self) -> None:
        if self._inotify is not None:
            self._inotify.close()


def _watch(node: str) -> Any:
    """An inotify watch on the node, or None."""
    if sys.platform != "linux":
        return None
    try:
        from inotify_simple import INotify, flags

        inotify = INotify()
        inotify.add_watch(node, flags.OPEN | flags.CLOSE_WRITE | flags.CLOSE_NOWRITE)
    except (ImportError, OSError) as error:
        _log.warning(event_line("cannot tell whether a host has the pty open", node=node, error=error))
        return None
    return inotify

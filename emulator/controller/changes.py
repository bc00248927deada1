"""A counter of changes to what a unit keeps over power-off: whatever stores a kept thing steps it.

It is how a state file learns that there is something to write without comparing anything, and costs one addition where
nobody asks.
"""

from __future__ import annotations

from emulator.state.contents import KEPT_SETTINGS

KEPT_COMMANDS = frozenset(key.partition("@")[0] for key in KEPT_SETTINGS)
"""The commands of the settings that are kept."""


class Changes:
    """How often something that is kept has changed."""

    __slots__ = ("count",)

    def __init__(self) -> None:
        self.count = 0

    def note(self) -> None:
        """Something that is kept has changed."""
        self.count += 1

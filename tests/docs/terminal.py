"""Sessions with `oem6250 terminal` as a person has them, typed at a real one.

    the unit has ...    what is shown before the first line is typed
    > TAS               a line typed behind the prompt `> `
    *1TAS...            what is shown then

The words that must have come before the next line is typed are the last ones of what the block shows.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest


def play(text: str, port: str, history: Path) -> str:
    """Type the lines of a session; what is on the screen at its end."""
    # Meant: Windows has no pseudo-terminals.
    if not hasattr(os, "openpty"):
        pytest.skip("needs pseudo-terminals")
    from tests.clients.terminal.screen import Screen

    first, *rest = re.split(r"^> ", text, flags=re.MULTILINE)
    with Screen(port, history=history) as screen:
        screen.wait_for(_last_words(first))
        for part in rest:
            typed, _, shown = part.partition("\n")
            screen.enter(typed, _last_words(shown))
        return screen.shown


def _last_words(shown: str) -> str:
    """The end of what a block shows, as far as it is given word for word."""
    return shown.rstrip().removesuffix("...").splitlines()[-1].split("...")[-1].strip()

"""What can be wrong with a state file or its readable form; each is one line for the person who named it."""

from __future__ import annotations


class StateError(Exception):
    """Something about the file its owner can mend; the text is one line that begins with the file's name."""


class DamagedError(StateError):
    """The file is one of ours and what is in it is not what was written."""

"""What goes wrong in a test with an emulator."""

from __future__ import annotations


class NotReached(AssertionError):
    """Something that was waited for did not come within the virtual time allowed for it."""

    def __init__(self, what: str, *, within_s: float, at_s: float) -> None:
        super().__init__(f"{what} not reached within {within_s:g} s of virtual time (it is now {at_s:.6f} s)")


class NotPossible(RuntimeError):
    """Something this kind of fixture cannot do; the text says which can."""

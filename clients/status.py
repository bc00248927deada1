"""Status words: enum flags and objects with a property a bit, both made from `protocol.status`.

status = ctl.status.axis(1)
status.moving, status.in_target_zone
AxisFlags.DRIVE_SHUTDOWN in status.flags
"""

from __future__ import annotations

from enum import IntFlag
from typing import Generic, TypeVar

from clients.typed.flags import (
    AxisFlags,
    ErrorFlags,
    ExtendedAxisFlags,
    FollowingFlags,
    OtherInputFlags,
    SystemFlags,
)
from protocol.reply import bits_word, group_bits

__all__ = [
    "AxisFlags",
    "ErrorFlags",
    "ExtendedAxisFlags",
    "FollowingFlags",
    "OtherInputFlags",
    "StatusWord",
    "SystemFlags",
]

F = TypeVar("F", bound=IntFlag)


class StatusWord(Generic[F]):
    """A status word as it was reported: `flags`, `bits` (bit 1 first), `bit(n)`."""

    __slots__ = ("bits", "flags")

    def __init__(self, bits: str, kind: type[F]) -> None:
        self.bits = bits
        self.flags = kind(bits_word(bits))

    def bit(self, number: int) -> bool:
        """A bit by its number, 1 first."""
        return self.bits[number - 1] == "1"

    def __contains__(self, flag: F) -> bool:
        return flag in self.flags

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, StatusWord) and other.bits == self.bits

    def __hash__(self) -> int:
        return hash((type(self), self.bits))

    def __repr__(self) -> str:
        names = ", ".join(flag.name.lower() for flag in self.flags if flag.name)
        return f"{type(self).__name__}({group_bits(self.bits)}: {names or 'none set'})"

"""Settings whose numbers have names."""

from __future__ import annotations

from enum import IntEnum


class EndOfTravel(IntEnum):
    """Which end-of-travel limits act (LH, LS)."""

    NONE = 0
    NEGATIVE_ONLY = 1
    POSITIVE_ONLY = 2
    BOTH = 3


class FeedbackSource(IntEnum):
    """What closes the servo loop (SFB)."""

    OPEN_LOOP = 0
    ENCODER = 1
    ANALOG_INPUT = 2


class ErrorLevel(IntEnum):
    """How much the unit says by itself (ERRLVL)."""

    DATA_ONLY = 0
    MARKED_DATA = 1
    NAMED_DATA = 2
    PROMPTS = 3
    EVERYTHING = 4

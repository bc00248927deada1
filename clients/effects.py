"""How a conversation is written once for both faces of the library.

A `Procedure` is a generator that yields what it wants done on the line and is sent the bytes that came; it never does
I/O and never waits. `OEM6250` carries the wishes out on a blocking line, `AsyncOEM6250` on the event loop. A procedure
returns its result, or raises.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import NamedTuple, TypeVar


class Send(NamedTuple):
    """Write these bytes."""

    data: bytes


class Receive(NamedTuple):
    """Give back what arrives, waiting at most so long for the first byte."""

    timeout_s: float


class Converse(NamedTuple):
    """Write these bytes and give back what arrives: one step, because it is what nearly all exchanges are."""

    data: bytes
    timeout_s: float


class Pause(NamedTuple):
    """Let time pass, and others use the line meanwhile; gives back what came unasked, if anything was read."""

    seconds: float


Effect = Converse | Send | Receive | Pause

Result_co = TypeVar("Result_co", covariant=True)

Procedure = Generator[Effect, bytes, Result_co]

"""What the generated classes and the hand-written parts of both faces stand on."""

from __future__ import annotations

from collections.abc import Awaitable
from typing import Protocol, TypeVar

from clients.effects import Procedure
from clients.session import Session

T = TypeVar("T")


class Run(Protocol):
    """Carries a procedure out and waits."""

    def __call__(self, procedure: Procedure[T], /) -> T: ...


class RunAsync(Protocol):
    """Carries a procedure out on the event loop."""

    def __call__(self, procedure: Procedure[T], /) -> Awaitable[T]: ...


class BlockingFace:
    """A part of a unit's surface; `axis` counts from 1, None is the unit."""

    def __init__(self, run: Run, session: Session, axis: int | None = None) -> None:
        self._run, self._session, self._axis = run, session, axis


class AwaitableFace:
    """The same for asyncio."""

    def __init__(self, run: RunAsync, session: Session, axis: int | None = None) -> None:
        self._run, self._session, self._axis = run, session, axis

"""What a client does when it connects, as a procedure, and what it says about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from clients.effects import Procedure
from clients.errors import InDefinition
from clients.session import DEFAULT_QUIET_S, DEFAULT_TIMEOUT_S, Session


class ConnectOptions(TypedDict, total=False):
    """How a client treats its line: the keyword arguments of both faces."""

    timeout_s: float
    """For each answer, 1 s."""
    quiet_s: float
    """Where only silence ends an answer, 0.05 s."""
    retries: int
    """How often a query is asked again after no answer or a garbled one, 1."""
    echo: bool | None
    """A wish for ECHO; None leaves it as it is."""
    error_level: int | None
    """A wish for ERRLVL; None leaves it as it is."""
    end_definition: bool
    """END a program definition that somebody left open, instead of raising InDefinition."""
    address: int | None
    """The unit's number in a daisy chain."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """The same with defaults."""

    timeout_s: float = DEFAULT_TIMEOUT_S
    quiet_s: float = DEFAULT_QUIET_S
    retries: int = 1
    echo: bool | None = None
    error_level: int | None = None
    end_definition: bool = False
    address: int | None = None

    @classmethod
    def of(cls, options: ConnectOptions) -> Options:
        """What was given, and defaults for the rest; TypeError for a name that is none."""
        return cls(**options)


def connect(session: Session, options: Options) -> Procedure[None]:
    """Synchronise, then carry out the wishes; `session.changed` lists the commands that changed something.

    Raises:
        NoAnswer, Garbled: see Session.synchronise. InDefinition: a definition is open and was not to be ended.
    """
    found = yield from session.synchronise()
    if found.defining:
        if not options.end_definition:
            raise InDefinition("on connecting")
        yield from end_definition(session)
    if options.echo is not None and options.echo != session.link.echo:
        yield from _change(session, f"!ECHO{options.echo:d}")
    if options.error_level is not None and options.error_level != session.link.level:
        yield from _change(session, f"!ERRLVL{options.error_level:d}")


def end_definition(session: Session) -> Procedure[None]:
    """END, if a definition is open."""
    if session.defining:
        yield from _change(session, "END")
        session.defining = False


def _change(session: Session, line: str) -> Procedure[None]:
    yield from session.command(line)
    session.changed.append(line.removeprefix("!"))

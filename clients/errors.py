"""What can go wrong between a host and a unit, as exceptions that say what was expected, what came and what to try.

ClientError
  UnitError        the unit refused a command (`text`, `command`)
  LinkError        nothing sensible came over the line
    NoAnswer       (also a TimeoutError) nothing came
    Garbled        something came that is no answer
    LineLost       (also a ConnectionError) the line itself is gone
  InDefinition     the unit is between DEF and END
  MotionError      a move ended elsewhere than it should (`status`)
  VerificationError  what was stored is not what was sent
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from clients.status import AxisFlags

SHOWN_BYTES = 200
"""So much of what came is quoted in a message; exceptions keep all of it."""


def quoted(data: bytes) -> str:
    """Bytes for a message, the last ones when there are many."""
    if not data:
        return "nothing"
    return repr(data) if len(data) <= SHOWN_BYTES else f"{len(data)} bytes ending in {data[-SHOWN_BYTES:]!r}"


class ClientError(Exception):
    """Anything this library raises on purpose, wrong arguments (ValueError, TypeError) apart."""


class UnitError(ClientError):
    """The unit refused a command.

    `text` is the unit's own message (empty where its error level sends none), `command` what it refused; `late` says
    that the refusal came when another command was already under way.
    """

    def __init__(self, text: str, command: str, *, late: bool = False) -> None:
        self.text, self.command, self.late = text, command, late
        said = f"{text}: refused {command!r}" if text else f"the unit refused {command!r}"
        if not text:
            said += "; it tells the reason at ERRLVL4 only"
        super().__init__(f"{said} (an earlier command; the refusal has just come)" if late else said)


class LinkError(ClientError):
    """The line did not bring what was expected: `expected` in words, `received` the bytes that came."""

    def __init__(self, expected: str, received: bytes, advice: str) -> None:
        self.expected, self.received, self.advice = expected, received, advice
        super().__init__(f"expected {expected}; came {quoted(received)}; {advice}")


class NoAnswer(LinkError, TimeoutError):
    """Nothing that looks like an answer came in time."""


class Garbled(LinkError):
    """Something came in time, but not the answer that was asked for."""


class LineLost(LinkError, ConnectionError):
    """The port or connection is gone. The unit goes on by itself: a lost line stops no motion."""

    def __init__(self, name: str, cause: object, received: bytes = b"") -> None:
        advice = (
            f"{name} is gone ({cause}); the unit goes on with whatever it was doing, a move included: "
            "reconnect and ask, or stop it with its ENABLE input"
        )
        super().__init__("a line that stays open", received, advice)


class InDefinition(ClientError):
    """The unit is in the middle of a program definition, where commands are stored instead of carried out."""

    def __init__(self, what: str) -> None:
        super().__init__(
            f"{what}: the unit is in the middle of a program definition (DEF without END); "
            "end it with end_definition() or open(..., end_definition=True), which keeps the half program, then DEL it"
        )


class MotionError(ClientError):
    """A move did not end where it should; `status` is the axis status read then, `axis` counts from 1."""

    def __init__(self, axis: int, what: str, status: AxisFlags) -> None:
        self.axis, self.status = axis, status
        names = ", ".join(flag.name.lower().replace("_", " ") for flag in status if flag.name) or "no bit set"
        super().__init__(f"axis {axis}: {what}; axis status: {names}")


class VerificationError(ClientError):
    """The listing of a stored program differs from what was sent; `line` counts commands from 1."""

    def __init__(self, program: str, line: int, sent: str | None, stored: str | None) -> None:
        self.program, self.line, self.sent, self.stored = program, line, sent, stored
        super().__init__(
            f"program {program}, command {line}: sent {sent!r}, stored {stored!r}; "
            "the line may have lost characters: download it again, with ECHO0 and XONOFF1"
        )

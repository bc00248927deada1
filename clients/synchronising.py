"""Finding out how a unit talks: echo, error level, framing, whatever state its line is in.

A host that connects knows nothing: the last one may have left ECHO0, ERRLVL1, another EOT, half a command, a running
program or an open definition. The way out uses what every unit of the family does:

1. listen until the line is quiet (a program may be writing; that is waited for only so long);
2. send as many backspaces as the longest command has characters and, on the same line, `!ERRLVL`. Backspaces take a
   half-typed command back without running it (an end of line would run it); `!` is answered at once whatever program or
   move is under way. The reply's own form says which level is in force, what precedes it whether there is an echo, what
   follows it is EOT and the prompt;
3. ask for the framing settings and the system status one by one; each reply ends with what the first one ended with.

Nothing is changed by it. A few wishes (`!ECHO0`, `!ERRLVL4`) are carried out afterwards if the caller has them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from clients.effects import Procedure, Receive, Send
from clients.errors import Garbled, InDefinition, LinkError, NoAnswer
from clients.link import FRAMING_COMMANDS, Link
from protocol.reply import LEVEL_RULES, Framing, character_codes
from protocol.status import SystemStatus

if TYPE_CHECKING:
    from clients.session import Wire

BACKSPACES = 100
"""The longest command (assumed: settled by hosts' own buffers of 80 to 120 characters)."""

ATTEMPTS = 3

LONGEST_TAIL = 7
"""EOT and ERROK have three and four characters; more than that is something else."""

_FIRST = "!ERRLVL"
_LEVEL_FORMS = (
    re.compile(rb"\*ERRLVL(?P<level>[2-4])(?!\d)"),
    re.compile(rb"\*(?P<level>[01])(?![\w,.+-])"),
    re.compile(rb"(?<![\w*,.+-])(?P<level>0)(?![\w,.])"),
)
_CODES = re.compile(rb"\d{1,3}(?:,\d{1,3}){2,3}")
_WORD = re.compile(rb"[01]{4}(?:_[01]{4}){7}")
_DEFAULT_TAIL = b"\r\r\n> "
_DEFINING = b"- "


@dataclass(frozen=True)
class Synchronised:
    """What was found: the link, whether the unit is between DEF and END, and what it had said before."""

    link: Link
    defining: bool
    running: bool
    before: str


@dataclass(frozen=True)
class _First:
    """The first answer, taken apart; `tail` is what follows a reply: EOT and prompt."""

    echo: bool
    level: int
    tail: bytes


def find_link(wire: Wire, prefix: str) -> Procedure[Synchronised]:
    """Find out how the unit talks.

    Raises:
        NoAnswer: nothing came at all. Garbled: what came is no unit of this family, or the line spoils it.
    """
    before = yield from _drain(wire)
    error: LinkError | None = None
    for attempt in range(ATTEMPTS):
        try:
            first = yield from _first_answer(wire, prefix)
            found = yield from _rest(wire, prefix, first, before)
            return found
        except (NoAnswer, Garbled) as failure:
            error = failure
            if isinstance(failure, NoAnswer) and attempt and not failure.received:
                break
            yield from _drain(wire)
    assert error is not None
    raise error


def _drain(wire: Wire) -> Procedure[bytes]:
    """Take in what comes until the line is quiet, at most for the time-out; kept as output of the unit."""
    deadline = wire.clock() + wire.timeout_s
    got = b""
    while wire.clock() < deadline and (data := (yield Receive(wire.quiet_s))):
        got += data
    wire.keep(got)
    return got


def _collect(wire: Wire, *, until: bytes = b"", least: int = 0) -> Procedure[bytes]:
    """What comes until it ends with `until`, or the line is quiet again, or time is over."""
    deadline = wire.clock() + wire.timeout_s
    got = b""
    while (left := deadline - wire.clock()) > 0:
        data = yield Receive(min(left, wire.quiet_s) if got else left)
        got += data.replace(b"\x00", b"")
        if (got and not data) or (until and len(got) > least and got.endswith(until)):
            break
    return got


def _first_answer(wire: Wire, prefix: str) -> Procedure[_First]:
    text = f"{prefix}{_FIRST}"
    yield Send(b"\x08" * BACKSPACES + text.encode() + b"\r")
    got = yield from _collect(wire, until=b"*ERRLVL4" + _DEFAULT_TAIL)
    if not got:
        raise NoAnswer(
            f"an answer to {text!r}",
            got,
            "is it the unit's port, at its baud rate, with this address? Is the unit on, and its serial port (E1)?",
        )
    return _read_first(got, text)


def _read_first(got: bytes, text: str) -> _First:
    echo_at = got.upper().rfind(text.encode())
    echo = echo_at >= 0
    rest = got[echo_at + len(text) :] if echo else got
    for form in _LEVEL_FORMS:
        if match := form.search(rest):
            tail = rest[match.end() :]
            return _First(echo, int(match["level"]), tail if len(tail) <= LONGEST_TAIL else b"")
    if rest.endswith(_DEFINING):
        raise InDefinition(f"{text!r} was answered by {rest!r}")
    only = "only its echo came; " if echo and not rest.strip() else ""
    raise Garbled(
        f"a reply *ERRLVL4 (or *1, 0 ...) to {text!r}",
        got,
        f"{only}is this a 6000 Series controller, at this baud rate? Do other programs use the port?",
    )


def _rest(wire: Wire, prefix: str, first: _First, before: bytes) -> Procedure[Synchronised]:
    """Ask for the framing one by one, then for the state of the unit."""
    codes: dict[str, bytes] = {}
    for name in FRAMING_COMMANDS:
        match = yield from _ask(wire, prefix, name, first, _CODES)
        codes[FRAMING_COMMANDS[name]] = character_codes([int(code) for code in match.split(b",")])
    word = (yield from _ask(wire, prefix, "TSS", first, _WORD)).replace(b"_", b"")
    framing = Framing(**codes, rules=LEVEL_RULES[first.level])
    defining = word[SystemStatus.DEFINING_PROGRAM - 1] == ord("1")
    running = word[SystemStatus.EXECUTING_PROGRAM - 1] == ord("1")
    return Synchronised(Link(first.echo, first.level, framing), defining, running, before.decode("latin-1"))


def _ask(wire: Wire, prefix: str, name: str, first: _First, form: re.Pattern[bytes]) -> Procedure[bytes]:
    """The value of one reply."""
    text = f"{prefix}!{name}".encode()
    yield Send(text + b"\r")
    got = yield from _collect(wire, until=first.tail, least=len(text) + 2 if first.echo else 0)
    rest = got
    if first.echo and (at := got.upper().rfind(text)) >= 0:
        rest = got[at + len(text) :]
    label = name.encode() if LEVEL_RULES[first.level].names else b""
    star = b"*" if LEVEL_RULES[first.level].asterisk else b""
    at = rest.find(star + label)
    match = form.search(rest, at + len(star + label)) if at >= 0 else None
    if match is None:
        kind = Garbled if got else NoAnswer
        raise kind(f"a reply {(star + label).decode()}... to {text.decode()!r}", got, "is the line free of noise?")
    return match[0]

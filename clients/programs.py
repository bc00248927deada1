"""Stored programs as procedures: listing, download with verification, running.

A download goes line by line, each line waiting for its prompt (or its echo), then the unit's own listing (TPROG) is
compared with what was sent, command by command.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from clients.effects import Pause, Procedure
from clients.errors import InDefinition, NoAnswer, UnitError, VerificationError
from clients.session import Session
from clients.status import SystemFlags
from clients.typed.words import SystemWord
from clients.values import ask
from protocol.command import check_program_name, parse_command
from protocol.errors import CommandError
from protocol.line import LineAssembler, TokenKind

POLL_S = 0.02

_ENTRY = re.compile(r"(\d+) - (\w+) USES (\d+) BYTES\s*(.*)")

Progress = Callable[[int, int], None]
"""Called with commands done and commands in all."""


@dataclass(frozen=True)
class StoredProgram:
    """A line of the directory: name, bytes used, and whether it is compiled."""

    name: str
    size_bytes: int
    compiled: bool


def commands_of(text: str | Iterable[str]) -> list[str]:
    """The commands of a program file: comments, empty lines and its own DEF and END left out, as a listing shows them.

    Commands that this library cannot read are left to the unit's judgement.
    """
    lines = text.splitlines() if isinstance(text, str) else list(text)
    assembler = LineAssembler()
    data = "".join(f"{line}\r" for line in lines).encode("latin-1", "replace")
    read = [_normal(token.text) for token in assembler.feed(data) if token.kind is TokenKind.COMMAND]
    if read and re.match(r"DEF\b", read[0]):
        read = read[1:]
    return read[:-1] if read and read[-1] == "END" else read


def _normal(text: str) -> str:
    try:
        return parse_command(text).text
    except CommandError:
        return text.strip()


def system_status(session: Session) -> Procedure[SystemWord]:
    """SS."""
    answer = yield from ask(session, "TSS")
    return SystemWord(answer.parsed().bits, SystemFlags)


def directory(session: Session) -> Procedure[list[StoredProgram]]:
    """TDIR: the stored programs."""
    answer = yield from ask(session, "TDIR")
    found = [_ENTRY.fullmatch(line.strip()) for line in answer.lines]
    return [StoredProgram(entry[2], int(entry[3]), bool(entry[4])) for entry in found if entry]


def upload(session: Session, name: str) -> Procedure[list[str]]:
    """TPROG: the commands of a stored program.

    Raises:
        UnitError: there is none of this name.
    """
    answer = yield from session.command(f"!TPROG {_name(name)}")
    return list(answer.lines)


def download(
    session: Session,
    name: str,
    text: str | Iterable[str],
    *,
    replace: bool = True,
    verify: bool = True,
    progress: Progress | None = None,
) -> Procedure[int]:
    """Store a program and compare the unit's listing with it; the number of commands.

    Raises:
        UnitError: a command or the name was refused; the definition is ended and the program deleted again.
        VerificationError: the listing differs.
        InDefinition: another definition is open.
    """
    commands = commands_of(text)
    state = yield from system_status(session)
    if state.defining_program:
        raise InDefinition(f"download of {name}")
    if replace:
        yield from session.command(f"DEL {_name(name)}")
    yield from session.command(f"DEF {_name(name)}")
    try:
        for done, command in enumerate(commands, start=1):
            yield from session.command(command)
            if progress is not None:
                progress(done, len(commands))
    except UnitError:
        yield from session.command("END")
        yield from session.command(f"DEL {name}")
        raise
    yield from session.command("END")
    if verify:
        stored = yield from upload(session, name)
        compare(name, commands, stored)
    return len(commands)


def compare(name: str, sent: list[str], stored: list[str]) -> None:
    """Raise VerificationError at the first difference; letters outside quotes and blanks do not count."""
    stored = [_normal(line) for line in stored]
    for number in range(max(len(sent), len(stored))):
        ours = sent[number] if number < len(sent) else None
        theirs = stored[number] if number < len(stored) else None
        if ours != theirs:
            raise VerificationError(name, number + 1, ours, theirs)


def run(session: Session, name: str, *, timeout_s: float | None = None) -> Procedure[None]:
    """RUN; with a time-out wait until it has ended.

    Raises:
        UnitError: there is no such program.
    """
    yield from session.immediate(f"RUN {_name(name)}")
    if timeout_s is not None:
        yield from wait_until_ended(session, timeout_s=timeout_s)


def wait_until_ended(session: Session, *, timeout_s: float, poll_s: float = POLL_S) -> Procedure[None]:
    """Until no program is executing (SS bit 3).

    Raises:
        NoAnswer: it still runs after `timeout_s`.
    """
    clock = session.wire.clock
    deadline = clock() + timeout_s
    while True:
        status = yield from system_status(session)
        if not status.executing_program:
            return
        if clock() >= deadline:
            advice = f"allow more than {timeout_s:g} s, or halt it"
            raise NoAnswer("the end of the program", repr(status).encode("ascii"), advice)
        session.idle((yield Pause(poll_s)))


def halt(session: Session) -> Procedure[None]:
    """End the running program at once (!HALT); motion goes on."""
    yield from session.immediate("HALT")


def _name(name: str) -> str:
    try:
        return check_program_name(name.upper())
    except CommandError as error:
        raise ValueError(f"not a program name (1 to 6 letters and digits, a letter first): {name!r}") from error

"""The terminal's own commands: they begin with a slash, which no command of the 6000 language does."""

from __future__ import annotations

import asyncio
import os
import shlex
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Final, get_args

from clients import programs
from clients.effects import Procedure
from clients.errors import ClientError
from clients.motion import axis_status
from clients.session import Session
from clients.terminal.completion import OwnCommand
from clients.terminal.conversation import Conversation, Shown, Style
from clients.terminal.decoding import Detail
from clients.terminal.program_files import (
    Outside,
    Program,
    ProgramFileError,
    format_programs,
    name_from_path,
    read_programs,
)
from clients.values import ask
from protocol.help import describe, matching

OWN: Final = (
    OwnCommand("/help", "/help [COMMAND]", "these commands and keys, or what the catalogue says of a command"),
    OwnCommand("/status", "/status", "TAS, TSS, TER and TINO, in words"),
    OwnCommand("/decode", "/decode off|set|all", "status words in words: not, the bits that are set, all bits"),
    OwnCommand("/watch", "/watch SECONDS|off", "positions in the toolbar, asked so often while the line is idle"),
    OwnCommand("/download", "/download FILE [NAME]", "store the programs of a file in the unit and compare", True),
    OwnCommand("/upload", "/upload FILE [NAME ...]", "write programs of the unit, or all of them, to a new file", True),
    OwnCommand("/sync", "/sync", "find out again how the unit talks, after another host has changed it"),
    OwnCommand("/quit", "/quit", "leave; the unit goes on"),
)

KEYS: Final = (
    "Tab completes, arrow keys bring lines back, Ctrl-R searches them.",
    "Ctrl-C sends !K: all motion and the program are killed. It also stops a transfer. Ctrl-D leaves.",
)

SHORTEST_WATCH_S: Final = 0.1
_STATUS: Final = ("!TAS", "!TSS", "!TER", "!TINO")


class Mistyped(ValueError):
    """An own command that cannot be carried out as it was typed; the text says what is allowed."""


class OwnCommands:
    """Carries the terminal's own commands out on a conversation."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._known: dict[str, Callable[[list[str]], Awaitable[None]]] = {
            "/help": self._help,
            "/status": self._status,
            "/decode": self._decode,
            "/watch": self._watch,
            "/download": self._download,
            "/upload": self._upload,
            "/sync": self._sync,
        }
        self.progress = ""
        """How far a transfer has come, for the toolbar; "" while there is none."""
        self.watched = ""
        """What the last look at the axes showed, for the toolbar."""
        self._watching: asyncio.Task[None] | None = None

    async def carry_out(self, line: str) -> None:
        """Do what a line that begins with a slash says; what is wrong with it is shown."""
        try:
            name, *words = _words(line)
            if name not in self._known:
                raise Mistyped(f"{name} is not a command of the terminal; /help lists them")
            await self._known[name](words)
        except (Mistyped, ProgramFileError, ClientError, OSError) as error:
            self._show(str(error), "error")
        finally:
            self._progress("")

    def stop_watching(self) -> None:
        """No more looks at the axes."""
        if self._watching is not None:
            self._watching.cancel()
        self._watching, self.watched = None, ""

    async def _help(self, words: list[str]) -> None:
        if not words:
            rows = [f"{each.syntax:<26} {each.sentence}" for each in OWN]
            self._show_all(["Everything else goes to the unit as it is typed.", *rows, *KEYS])
            return
        told = describe(words[0])
        if told is None:
            near = ", ".join(row.name for row in matching(words[0][:1]))
            raise Mistyped(f"the language has no {words[0].upper()}; with this letter: {near or 'nothing'}")
        self._show_all(told.splitlines())

    async def _status(self, words: list[str]) -> None:
        _nothing_more("/status", words)
        for line in _STATUS:
            await self._conversation.type_line(line)

    async def _decode(self, words: list[str]) -> None:
        details = {each: each for each in get_args(Detail)}
        if len(words) != 1 or words[0] not in details:
            raise Mistyped(f"/decode takes {' or '.join(details)}")
        self._conversation.detail = details[words[0]]

    async def _sync(self, words: list[str]) -> None:
        _nothing_more("/sync", words)
        await self._conversation.find_out()

    async def _watch(self, words: list[str]) -> None:
        seconds = _seconds(words)
        self.stop_watching()
        if seconds is not None:
            self._watching = asyncio.create_task(self._look_again_and_again(seconds))
        self._conversation.changed()

    async def _look_again_and_again(self, seconds: float) -> None:
        conversation = self._conversation
        while True:
            if conversation.idle and not self.progress:
                try:
                    self.watched = await conversation.carry_out(look(conversation.session))
                except ClientError as error:
                    self.watched = ""
                    self._show(f"no longer watched: {error}", "error")
                    return
                conversation.changed()
            await asyncio.sleep(seconds)

    async def _download(self, words: list[str]) -> None:
        if not 1 <= len(words) <= 2:
            raise Mistyped("/download takes a file, and a name for a program that has none in it")
        text = Path(words[0]).expanduser().read_text("utf-8", "replace")
        parts = read_programs(text, name=words[-1].upper() if len(words) == 2 else name_from_path(words[0]))
        stored = 0
        for part in parts:
            if isinstance(part, Outside):
                await self._send_all(part)
            else:
                stored += await self._store(part)
        told = f"stored and compared: {', '.join(part.name for part in parts if isinstance(part, Program))}"
        self._show(f"{told} ({stored} commands)")

    async def _send_all(self, part: Outside) -> None:
        for command in part.commands:
            await self._conversation.carry_out(self._conversation.session.command(command))

    async def _store(self, program: Program) -> int:
        def tell(done: int, of: int) -> None:
            self._progress(f"{program.name}: {done} of {of} commands {bar(done, of)}")

        session = self._conversation.session
        procedure = programs.download(session, program.name, program.commands, progress=tell)
        try:
            count = await self._conversation.carry_out(procedure)
        except asyncio.CancelledError:
            await self._conversation.carry_out(abandon(session, program.name))
            self._show(f"stopped; {program.name} is deleted", "error")
            raise
        self._conversation.programs.add(program.name)
        return count

    async def _upload(self, words: list[str]) -> None:
        if not words:
            raise Mistyped("/upload takes a file, and names of programs (none: all that are stored)")
        path = Path(words[0]).expanduser()
        if path.exists():
            raise Mistyped(f"{path} is there already: give the name of a new file")
        session = self._conversation.session
        names = words[1:] or [each.name for each in await self._conversation.carry_out(programs.directory(session))]
        if not names:
            raise Mistyped("no program is stored in the unit")
        found: dict[str, list[str]] = {}
        for done, name in enumerate(names, start=1):
            self._progress(f"{name}: {done} of {len(names)} programs {bar(done, len(names))}")
            found[name.upper()] = await self._conversation.carry_out(upload_twice(session, name))
        path.write_text(format_programs(found), "utf-8")
        self._conversation.programs.update(found)
        self._show(f"written to {path}: {', '.join(found)}")

    def _progress(self, text: str) -> None:
        self.progress = text
        self._conversation.changed()

    def _show(self, text: str, style: Style = "own") -> None:
        self._conversation.show([Shown(text, style)])

    def _show_all(self, lines: list[str]) -> None:
        self._conversation.show([Shown(line, "own") for line in lines])


def look(session: Session) -> Procedure[str]:
    """Encoder positions and what moves, in one line; asked with ! and answered at once."""
    positions = (yield from ask(session, "TPE")).parsed().numbers
    told = []
    for axis, position in enumerate(positions, start=1):
        status = yield from axis_status(session, axis)
        told.append(f"axis {axis}: {position:+f}{' moving' if status.moving else ''}")
    return "   ".join(told)


def upload_twice(session: Session, name: str) -> Procedure[list[str]]:
    """The commands of a program, listed twice and compared: a damaged listing is not taken for the program.

    Raises:
        UnitError: there is none. VerificationError: the listings differ. ValueError: this is no program's name.
    """
    try:
        first = yield from programs.upload(session, name)
    except ValueError as error:
        raise Mistyped(str(error)) from None
    second = yield from programs.upload(session, name)
    programs.compare(name, first, second)
    return first


def abandon(session: Session, name: str) -> Procedure[None]:
    """After a download was broken off: end the definition and delete the half program."""
    yield from session.synchronise()
    if session.defining:
        yield from session.command("END")
        session.defining = False
    yield from session.command(f"DEL {name}")


def bar(done: int, of: int, *, width: int = 20) -> str:
    """`[#####---------------]`."""
    filled = width * done // of if of else width
    return f"[{'#' * filled}{'-' * (width - filled)}]"


def _words(line: str) -> list[str]:
    """The words of a line; a file name with blanks is put in quotes."""
    try:
        return shlex.split(line, posix=os.name == "posix")
    except ValueError as error:
        raise Mistyped(f"{line}: {error}") from None


def _seconds(words: list[str]) -> float | None:
    if words == ["off"]:
        return None
    try:
        seconds = float(words[0]) if len(words) == 1 else 0.0
    except ValueError:
        seconds = 0.0
    if not SHORTEST_WATCH_S <= seconds < float("inf"):
        raise Mistyped(f"/watch takes off or a number of seconds, at least {SHORTEST_WATCH_S}")
    return seconds


def _nothing_more(name: str, words: list[str]) -> None:
    if words:
        raise Mistyped(f"{name} takes nothing more, not {' '.join(words)!r}")

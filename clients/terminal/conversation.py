"""The terminal's connection: a port that is read all the time, lines sent as they are typed, and procedures in between.

A procedure of the client library (a download, a look at the axes for the toolbar) has the line to itself while it runs;
what the unit says unasked meanwhile is shown afterwards. A lost port is opened again as soon as it can be.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeVar

from clients.async_lines import AsyncLine, open_async_line
from clients.awaitable import AsyncDriver
from clients.effects import Procedure, Receive, Send
from clients.errors import ClientError, LineLost
from clients.lines import DEFAULT_BAUD
from clients.link import Link
from clients.plan import Kind, make_plan
from clients.session import Session, Wire
from clients.synchronising import Synchronised
from clients.terminal.decoding import Detail, command_of, decode, error_row, hint
from clients.terminal.incoming import Incoming, Piece, PromptKind
from protocol.command import Command

T = TypeVar("T")

POLL_S = 0.03
"""So long one look at the port takes, and a typed line may have to wait."""

SETTLED_S = 0.3
"""So long nothing must have been said before the terminal says something by itself."""

RECONNECT_S = 1.0

Style = Literal["reply", "words", "error", "hint", "own"]


@dataclass(frozen=True)
class Shown:
    """A line for the screen."""

    text: str
    style: Style


class Conversation:
    """What is said on one port.

    Args:
        show: called with lines for the screen, on the event loop.
        changed: called when the toolbar or the prompt may have changed.
        ask: whether the terminal may ask the unit by itself, on connecting and after the framing has changed.
    """

    def __init__(
        self,
        url: str,
        *,
        show: Callable[[list[Shown]], None],
        changed: Callable[[], None] = lambda: None,
        baud: int = DEFAULT_BAUD,
        address: int | None = None,
        ask: bool = True,
    ) -> None:
        self.url = url
        self.show, self.changed = show, changed
        self.detail: Detail = "set"
        self.prompt: PromptKind = "good"
        self.programs: set[str] = set()
        self.connected = False
        self._baud, self._address, self._ask = baud, address, ask
        self._asked: Command | None = None
        self._last_said = 0.0
        self._find_out = False
        self._begin_on(None)

    def _begin_on(self, line: AsyncLine | None) -> None:
        self._driver = None if line is None else AsyncDriver(line)
        clock = (lambda: 0.0) if line is None else line.clock
        self.session = Session(Wire(clock), address=self._address)
        self._incoming = Incoming()
        self.connected = line is not None

    async def open(self) -> None:
        """Open the port and find out how the unit talks.

        Raises:
            LineLost: it cannot be opened. ValueError: the URL is not understood.
        """
        self._begin_on(await open_async_line(self.url, baud=self._baud))
        self._own(f"connected to {self.url}")
        if self._ask:
            try:
                await self.find_out()
            except LineLost:
                await self.close()
                raise
        self.changed()

    async def find_out(self) -> None:
        """Ask the unit for echo, error level and framing; the terminal goes on without if it does not answer."""
        self._find_out = False
        try:
            found = await self.carry_out(self.session.synchronise())
        except LineLost:
            raise
        except ClientError as error:
            self.show([Shown(str(error), "error"), Shown("going on without knowing how the unit talks", "own")])
            return
        self._own(describe(found))
        self.prompt = "defining" if found.defining else "good"

    async def run(self) -> None:
        """Read the port for ever, and open it again whenever it is lost."""
        while True:
            try:
                await self._listen()
            except LineLost as error:
                await self._lost(error)

    async def _listen(self) -> None:
        while True:
            driver = self._require()
            data = await driver.run(_listen())
            if data:
                self._last_said = driver.line.clock()
            self._take(self._incoming.feed(data) if data else self._incoming.quiet())
            if self._find_out and self.idle:
                await self.find_out()

    async def _lost(self, error: LineLost) -> None:
        self.connected = False
        self.show([Shown(str(error), "error"), Shown("waiting for the port to come back; Ctrl-D ends", "own")])
        self.changed()
        await self.close()
        while True:
            with contextlib.suppress(LineLost):
                await self.open()
                return
            await asyncio.sleep(RECONNECT_S)

    async def close(self) -> None:
        """Let go of the port; the unit goes on by itself."""
        self.connected = False
        if self._driver is not None:
            await self._driver.line.close()

    @property
    def idle(self) -> bool:
        """Whether nothing has been typed or said for a while."""
        return self.connected and self._require().line.clock() - self._last_said > SETTLED_S

    async def type_line(self, line: str) -> None:
        """Send a line as it was typed; nothing is waited for.

        Raises:
            LineLost, ValueError: characters that cannot be sent.
        """
        plan = make_plan(line, "", self.session.link)
        driver = self._require()
        self._asked = command_of(line) or self._asked
        self._find_out = self._find_out or (self._ask and plan.kind is Kind.LINK)
        if self.session.link.echo or self._find_out:
            self._incoming.sent(line)
        await driver.run(self._typed(plan.data, line, plan.count))

    def _typed(self, data: bytes, line: str, count: int) -> Procedure[None]:
        yield Send(data)
        self._last_said = self.session.wire.clock()
        if self.session.link.prompting:
            self.session.owed += [line] * count

    async def kill(self) -> bool:
        """Send !K at once, into the middle of whatever procedure has the line; False without a port.

        Raises:
            LineLost.
        """
        if not self.connected:
            return False
        line = self._require().line
        self._incoming.sent("!K")
        self.session.wire.in_doubt = self._ask
        if self.session.link.prompting:
            self.session.owed.append("!K")
        try:
            await line.write(b"!K\r")
        except OSError as error:
            raise LineLost(line.name, error) from error
        return True

    async def carry_out(self, procedure: Procedure[T]) -> T:
        """Carry out a procedure of the client library, and show what the unit said unasked meanwhile.

        Raises:
            LineLost, or whatever the procedure raises.
        """
        driver = self._require()
        try:
            return await driver.run(procedure)
        finally:
            self._incoming.use(self.session.link.framing)
            self._last_said = driver.line.clock()
            said = self.session.take_output().encode("latin-1")
            self._take(self._incoming.feed(said) + self._incoming.quiet())

    def _require(self) -> AsyncDriver:
        if self._driver is None or not self.connected:
            raise LineLost(self.url, "not connected")
        return self._driver

    def _take(self, pieces: list[Piece]) -> None:
        lines: list[Shown] = []
        for piece in pieces:
            if piece.prompt is not None:
                self._prompted(piece.prompt)
            else:
                lines += self._said(piece.text)
        if lines:
            self.show(lines)

    def _prompted(self, kind: PromptKind) -> None:
        del self.session.owed[:1]
        if kind != "bad":
            self.session.defining = kind == "defining"
        if self.prompt != kind:
            self.prompt = kind
            self.changed()

    def _said(self, text: str) -> list[Shown]:
        if error_row(text) is not None:
            about = hint(text, self._asked)
            return [Shown(text, "error"), *([Shown(about, "hint")] if about else [])]
        words = decode(text, detail=self.detail, asked=self._asked)
        return [Shown(text, "reply"), *(Shown(each, "words") for each in words)]

    def _own(self, text: str) -> None:
        self.show([Shown(text, "own")])


def _listen() -> Procedure[bytes]:
    data = yield Receive(POLL_S)
    return data


def describe(found: Synchronised) -> str:
    """What synchronising found, in one line."""
    state = [text for flag, text in ((found.running, "a program is running"), (found.defining, IN_DEFINITION)) if flag]
    return "; ".join([_settings(found.link), *state])


IN_DEFINITION = "the unit is in the middle of a program definition: END ends it"


def _settings(link: Link) -> str:
    eot = ",".join(str(byte) for byte in link.framing.eot) or "nothing"
    return f"the unit has ERRLVL{link.level}, ECHO{link.echo:d}, and ends a reply with {eot}"

"""The screen: prompt_toolkit reads lines with history and completion while what the unit says appears above them.

prompt_toolkit rather than textual: a session with a controller is a scroll of lines, and it is to stay one, in the
terminal emulator's own scrollback, over ssh and on a serial console, when the program has long ended. textual draws
whole screens. Where the port is concerned both would do; prompt_toolkit is the smaller one.
"""

from __future__ import annotations

import asyncio
import glob
import os
import signal
from collections.abc import Coroutine, Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from prompt_toolkit import PromptSession, print_formatted_text
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document
from prompt_toolkit.formatted_text import FormattedText
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.styles import Style

from clients.errors import LineLost
from clients.terminal.commands import OWN, OwnCommands
from clients.terminal.completion import Candidate, candidates, own_candidates, syntax_under
from clients.terminal.conversation import Conversation, Shown

STYLE: Final = Style.from_dict(
    {
        "error": "ansired bold",
        "hint": "ansiyellow",
        "words": "ansicyan",
        "own": "ansibrightblack",
        "reply": "",
        "bottom-toolbar": "noreverse ansibrightblack",
    }
)
PROMPTS: Final = {"good": "> ", "bad": "? ", "defining": "- "}
"""As the unit's own: the last one it sent."""

INDENT: Final = "    "
TRANSFER_RUNNING: Final = "a transfer is under way; Ctrl-C stops it"


class CatalogueCompleter(Completer):
    """What `completion` finds, as prompt_toolkit wants it."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterator[Completion]:
        """The candidates at the cursor, each with its syntax and title."""
        text = document.text_before_cursor
        for each in self._candidates(text, asked=complete_event.completion_requested):
            meta = f"{each.syntax}  {each.title}".strip()
            yield Completion(each.text, start_position=-each.replaces, display_meta=meta)

    def _candidates(self, text: str, *, asked: bool) -> list[Candidate]:
        if text.startswith("/"):
            return own_candidates(text, OWN, files_beginning)
        return candidates(text, programs=self._conversation.programs, asked=asked)


def files_beginning(text: str) -> Iterable[str]:
    """Files and folders whose names begin so; folders end with a separator."""
    found = glob.glob(glob.escape(os.path.expanduser(text)) + "*")
    return sorted(name + os.sep if os.path.isdir(name) else name for name in found)


def kept_history(path: Path) -> History:
    """The history in a file, or only in memory where the file cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch(mode=0o600)
    except OSError:
        return InMemoryHistory()
    return FileHistory(str(path))


class Console:
    """One terminal with one conversation."""

    def __init__(self, conversation: Conversation, *, history: History) -> None:
        self._conversation = conversation
        self._own = OwnCommands(conversation)
        self._transfer: asyncio.Task[None] | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self._prompt: PromptSession[str] = PromptSession(
            message=self._message,
            completer=CatalogueCompleter(conversation),
            complete_while_typing=True,
            auto_suggest=AutoSuggestFromHistory(),
            history=history,
            key_bindings=self._keys(),
            bottom_toolbar=self._toolbar,
            style=STYLE,
        )
        conversation.show, conversation.changed = self.show, self._prompt.app.invalidate

    async def run(self) -> None:
        """Talk until the user leaves; the port is open already."""
        listening = asyncio.create_task(self._conversation.run())
        listening.add_done_callback(self._listened)
        self._catch_interrupts()
        try:
            while (line := await self._next_line()) is not None:
                await self._entered(line)
        finally:
            self._own.stop_watching()
            for task in (listening, self._transfer, *self._tasks):
                if task is not None:
                    task.cancel()
            await asyncio.gather(listening, *([self._transfer] if self._transfer else []), return_exceptions=True)
            await self._conversation.close()

    def _listened(self, listening: asyncio.Task[None]) -> None:
        """Reading the port ends only by a mistake in this program, which is not to be hidden."""
        if not listening.cancelled() and self._prompt.app.is_running:
            self._prompt.app.exit(exception=listening.exception() or EOFError())

    async def _next_line(self) -> str | None:
        """A line as it was typed; None when the user leaves."""
        try:
            line = await self._prompt.prompt_async(handle_sigint=False)
        except EOFError:
            return None
        return None if line.strip() == "/quit" else line

    async def _entered(self, line: str) -> None:
        if self._transfer is not None and not self._transfer.done():
            self.show([Shown(TRANSFER_RUNNING, "error")])
        elif not line.startswith("/"):
            await self._type(line)
        elif line.startswith(("/download", "/upload")):
            self._transfer = asyncio.create_task(self._own.carry_out(line))
        else:
            await self._own.carry_out(line)

    async def _type(self, line: str) -> None:
        if not self._conversation.connected:
            self.show([Shown("not connected: nothing was sent", "error")])
            return
        try:
            await self._conversation.type_line(line)
        except (LineLost, ValueError) as error:
            self.show([Shown(str(error), "error")])

    def interrupt(self) -> None:
        """Ctrl-C: kill all motion and the program, and break a transfer off."""
        if self._transfer is not None and not self._transfer.done():
            self._transfer.cancel()
        self._soon(self._kill())

    async def _kill(self) -> None:
        try:
            sent = await self._conversation.kill()
        except LineLost:
            sent = False
        self.show([Shown("!K sent" if sent else "not connected: !K NOT sent", "own" if sent else "error")])

    def _soon(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _catch_interrupts(self) -> None:
        """Ctrl-C between two lines comes as a signal, within one as a key."""
        if os.name == "posix":
            asyncio.get_running_loop().add_signal_handler(signal.SIGINT, self.interrupt)

    def _keys(self) -> KeyBindings:
        keys = KeyBindings()

        @keys.add("c-c", eager=True)
        def _(event: KeyPressEvent) -> None:
            event.current_buffer.reset()
            self.interrupt()

        return keys

    def show(self, lines: list[Shown]) -> None:
        """Print lines above the one that is being typed."""
        parts: list[tuple[str, str]] = []
        for line in lines:
            indent = INDENT if line.style in ("words", "hint") else ""
            parts.append((f"class:{line.style}", f"{indent}{line.text}\n"))
        print_formatted_text(FormattedText(parts), style=STYLE, end="", output=self._prompt.output)

    def _message(self) -> str:
        return PROMPTS[self._conversation.prompt] if self._conversation.connected else "(not connected) "

    def _toolbar(self) -> str:
        """How far a transfer is; what the command being typed takes; or where the axes are."""
        typed = self._prompt.default_buffer.document.text_before_cursor
        about = "" if typed.startswith("/") else syntax_under(typed)
        place = self._conversation.url if self._conversation.connected else f"{self._conversation.url} LOST"
        return self._own.progress or about or self._own.watched or f"{place}   /help   Ctrl-C: !K   Ctrl-D: leave"

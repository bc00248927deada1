"""The terminal's own commands and its conversation with a real emulator behind a port, without the screen."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path

import pytest

from clients.terminal.commands import OWN, OwnCommands, bar
from clients.terminal.conversation import Conversation, Shown
from clients.testing import Served

PATIENCE_S = 10.0


class Session:
    """A conversation whose lines are kept."""

    def __init__(self, conversation: Conversation, lines: list[Shown]) -> None:
        self.conversation, self.lines = conversation, lines
        self.own = OwnCommands(conversation)

    def texts(self, *styles: str) -> list[str]:
        return [line.text for line in self.lines if not styles or line.style in styles]

    async def until(self, condition: Callable[[], bool]) -> None:
        async with asyncio.timeout(PATIENCE_S):
            while not condition():
                await asyncio.sleep(0.005)  # the port is read in a thread, in real time

    async def enter(self, line: str, answer: str) -> None:
        """Type a line and wait for something in what comes."""
        before = len(self.lines)
        await (self.own.carry_out(line) if line.startswith("/") else self.conversation.type_line(line))
        await self.until(lambda: any(answer in each.text for each in self.lines[before:]))


@pytest.fixture
def server() -> Iterator[Served]:
    with Served() as server:
        yield server


@pytest.fixture
async def session(server: Served) -> AsyncIterator[Session]:
    lines: list[Shown] = []
    conversation = Conversation(server.tcp_url, show=lines.extend)
    await conversation.open()
    reading = asyncio.create_task(conversation.run())
    session = Session(conversation, lines)
    yield session
    session.own.stop_watching()
    reading.cancel()
    await conversation.close()


async def test_programs_go_to_the_unit_and_come_back(session: Session, tmp_path: Path) -> None:
    source = tmp_path / "press.prg"
    source.write_text("; press\nSCALE0\nDEF HOMER\nHOM0\nEND\nDEL CYCLE\nDEF CYCLE\nL2 ; twice\nD1000:GO1\nLN\nEND\n")
    seen: list[str] = []
    session.conversation.changed = lambda: seen.append(session.own.progress)
    await session.enter(f"/download {source}", "stored and compared: HOMER, CYCLE (5 commands)")
    assert "CYCLE: 2 of 4 commands [##########----------]" in seen
    assert session.own.progress == ""
    await session.enter(f"/upload {tmp_path / 'all.prg'}", "written to")
    kept = (tmp_path / "all.prg").read_text()
    assert kept == "DEL HOMER\nDEF HOMER\nHOM0\nEND\n\nDEL CYCLE\nDEF CYCLE\nL2\nD1000\nGO1\nLN\nEND\n"
    await session.enter(f"/upload {tmp_path / 'all.prg'}", "is there already")
    await session.enter(f"/upload {tmp_path / 'one.prg'} homer", "written to")
    assert (tmp_path / "one.prg").read_text().startswith("DEL HOMER\n")
    assert session.conversation.programs == {"HOMER", "CYCLE"}
    await session.enter("TDIR", "CYCLE USES")


async def test_a_program_that_is_refused_says_so_and_leaves_nothing(session: Session, tmp_path: Path) -> None:
    source = tmp_path / "bad.prg"
    source.write_text("D5\nDEFX(\nGO1\n")
    await session.enter(f"/download {source} PART", "refused 'DEFX('")
    await session.enter("TDIR", "NO PROGRAMS DEFINED")
    assert session.conversation.prompt == "good"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("/download", "takes a file"),
        ("/download /no/such/file.prg", "No such file"),
        ("/upload", "takes a file"),
        ("/upload /tmp/never.prg NONE", "UNDEFINED LABEL"),
        ("/upload /tmp/never.prg far-too-long", "not a program name"),
        ("/watch fast", "at least 0.1"),
        ("/watch nan", "at least 0.1"),
        ("/decode some", "off or set or all"),
        ("/status now", "takes nothing more"),
        ("/nothing", "is not a command of the terminal"),
        ("/help NOSUCH", "the language has no NOSUCH"),
        ('/download "half', "No closing quotation"),
    ],
)
async def test_mistyped_commands_are_told_and_nothing_is_sent(
    session: Session, server: Served, line: str, said: str
) -> None:
    await session.enter(line, said)
    assert not Path("/tmp/never.prg").exists()
    await session.enter("1TPE", "*1TPE+0")


async def test_help_and_status(session: Session) -> None:
    await session.enter("/help", "Ctrl-C sends !K")
    assert all(any(each.syntax in text for text in session.texts("own")) for each in OWN)
    await session.enter("/help sgp", "Proportional feedback gain")
    await session.enter("/status", "6 Enable Input")
    words = session.texts("words")
    assert words[0] == "axis 1: 13 Drive Shutdown; 24 In Target Zone"


async def test_the_axes_are_watched_and_what_is_typed_meanwhile_is_answered(session: Session, server: Served) -> None:
    server.client.axis[1].drive_enabled = True
    await session.own.carry_out("/watch 0.1")
    await session.until(lambda: session.own.watched == "axis 1: +0   axis 2: +0")
    shown = len(session.lines)
    server.client.axis[1].move_to(4000)
    await session.until(lambda: session.own.watched.startswith("axis 1: +40"))
    assert len(session.lines) == shown
    await session.enter("1TAS.1", "bit 1, Moving: off")
    await session.own.carry_out("/watch off")
    assert session.own.watched == ""


async def test_the_terminal_follows_a_change_of_the_framing(session: Session) -> None:
    for line in ("ERRLVL1", "EOT10,0,0", "ECHO0", "ERRLVL4"):
        before = len(session.lines)
        await session.conversation.type_line(line)
        await session.until(lambda start=before: any("the unit has" in each.text for each in session.lines[start:]))
    assert "ERRLVL4, ECHO0, and ends a reply with 10" in session.texts("own")[-1]
    await session.enter("1TPE", "*1TPE+0")
    assert not session.texts("error")


async def test_a_unit_in_the_middle_of_a_definition_is_told(server: Served) -> None:
    server.client.send("DEF HALF")
    lines: list[Shown] = []
    conversation = Conversation(server.tcp_url, show=lines.extend)
    await conversation.open()
    assert conversation.prompt == "defining"
    assert any("END ends it" in line.text for line in lines)
    await conversation.close()


async def test_a_kill_does_not_wait_for_a_procedure_that_waits() -> None:
    received = bytearray()

    async def swallow(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while data := await reader.read(1000):
            received.extend(data)
        writer.close()

    async with await asyncio.start_server(swallow, "127.0.0.1", 0) as silent:
        port = silent.sockets[0].getsockname()[1]
        conversation = Conversation(f"tcp://127.0.0.1:{port}", show=lambda lines: None, ask=False)
        await conversation.open()
        asking = asyncio.create_task(conversation.find_out())
        async with asyncio.timeout(PATIENCE_S):
            while b"!ERRLVL" not in received:
                await asyncio.sleep(0.005)  # the port is read in a thread, in real time
            assert await conversation.kill()
            while b"!K\r" not in received:
                await asyncio.sleep(0.005)  # the port is read in a thread, in real time
        assert not asking.done()
        await asking
        await conversation.close()
        assert not await conversation.kill()


async def test_raw_says_nothing_by_itself(server: Served) -> None:
    conversation = Conversation(server.tcp_url, show=lambda lines: None, ask=False)
    await conversation.open()
    await conversation.close()
    assert not [line for line in server.traffic.lines() if " > " in line]


async def test_a_port_where_nobody_answers_stays_open() -> None:
    received = bytearray()

    async def swallow(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while data := await reader.read(1000):
            received.extend(data)
        writer.close()

    async with await asyncio.start_server(swallow, "127.0.0.1", 0) as silent:
        port = silent.sockets[0].getsockname()[1]
        lines: list[Shown] = []
        conversation = Conversation(f"tcp://127.0.0.1:{port}", show=lines.extend)
        await conversation.open()
        assert [line.style for line in lines] == ["own", "error", "own"]
        assert "is it the unit's port, at its baud rate" in lines[1].text
        await conversation.type_line("TAS")
        async with asyncio.timeout(PATIENCE_S):
            while not received.endswith(b"TAS\r"):
                await asyncio.sleep(0.005)  # the port is read in a thread, in real time
        await conversation.close()


def test_a_bar() -> None:
    assert [bar(done, 4, width=4) for done in range(5)] == ["[----]", "[#---]", "[##--]", "[###-]", "[####]"]
    assert bar(0, 0, width=2) == "[##]"

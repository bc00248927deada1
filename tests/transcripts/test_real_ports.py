"""The same transcripts through a running server, over every transport of `transports.py`, in real time.

Order and bytes are asserted exactly, moments only generously: a host's clock is not the unit's. One server process
serves all files with the same machine; RESET between two of them brings the unit back to its power-up state. Long
sessions run at a higher speed, still paced by the wall.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from clients import LineClient
from emulator.machine import Machine
from tests.transcripts.format import Expect, Match, Pass, Send, Transcript, load
from tests.transcripts.test_virtual import Mismatch, matched, wanted
from tests.transcripts.transports import ALL, Transport

HERE = Path(__file__).parent


def resets_to_its_own_defaults(transcript: Transcript) -> bool:
    """RESET would bring back the server's power-up settings, not those the transcript's machine has."""
    resets = any(isinstance(step, Send) and b"RESET" in step.data.upper() for step in transcript.steps)
    return resets and "[defaults]" in transcript.machine


SESSIONS = [
    transcript
    for transcript in map(load, sorted(HERE.glob("*.txt")))
    if not transcript.virtual_only and not resets_to_its_own_defaults(transcript)
]

DEFAULT_SHARE = 16
"""Of the sessions that are not those of known hosts one in so many is played in the default run, all with --runslow."""
USUAL = ("tcp", "pty")
"""Transports with that share, and with the hosts' sessions; of the others one in SMALL_SHARE is played."""
SMALL_SHARE = 128

REAL_TIME_UP_TO_S = 1.6
"""Sessions that take longer are played faster, so that the whole file stays under a minute."""
FAST = 8.0
PATIENCE_S = 3.0
"""How long bytes may be late on a busy machine before the session is given up."""
QUIET_S = 0.03
SET_UP_DONE = b"~"
LAST_OF_SET_UP = b'WRITE"\\126"\n'
"""Makes the unit say so at every error level; the character is not in its echo."""
OPTIONAL_ENDS = (b"?", b"*", b"+", b"}")
"""A pattern that ends so may go on matching; only then it is worth waiting for more."""
COASTING_S = 0.5
"""Virtual time after a kill in which a motor comes to rest: 0.1 s from 10 rev/s, then time constants of the servo."""


@dataclass(frozen=True)
class Server:
    """A running emulator and where it listens."""

    process: subprocess.Popen[str]
    speed: float
    told: dict[str, object]
    transports: dict[str, Transport]


class Servers:
    """One server for each wiring and speed, started when first needed."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._running: dict[tuple[str, float], Server] = {}

    def server(self, transcript: Transcript) -> Server:
        """A server wired like the machine of `transcript`, at a speed that suits its length."""
        speed = 1.0 if transcript.duration_s <= REAL_TIME_UP_TO_S else FAST
        key = (without_defaults(transcript.machine), speed)
        if key not in self._running:
            self._running[key] = self._start(*key)
        return self._running[key]

    def _start(self, machine: str, speed: float) -> Server:
        number = len(self._running)
        file = self._folder / f"{number}.toml"
        file.write_text(machine, encoding="utf-8")
        ways = [make() for make in ALL]
        options = [str(file), "--speed", f"{speed:g}", "--announce", "-"]
        for way in ways:
            options += way.prepare(self._folder, number) if not way.missing or way.name == "pty" else []
        command = [sys.executable, "-m", "emulator", "serve", *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=HERE.parents[1])
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line, f"the server ended with status {process.wait()}"
        return Server(process, speed, json.loads(line), {way.name: way for way in ways})

    def close(self) -> None:
        """Stop every server started here; each must leave cleanly."""
        for server in self._running.values():
            server.process.terminate()
        for server in self._running.values():
            with server.process:
                assert server.process.wait(timeout=10) == 0
            for transport in server.transports.values():
                transport.close()


@pytest.fixture(scope="module")
def servers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Servers]:
    started = Servers(tmp_path_factory.mktemp("real"))
    yield started
    started.close()


class RealSession:
    """One transcript being played through a port."""

    def __init__(self, transcript: Transcript, client: LineClient, *, speed: float) -> None:
        self._transcript = transcript
        self._client = client
        self._speed = speed
        self._pending = b""

    def run(self) -> None:
        """Play every step; Mismatch where something else comes, or nothing in time."""
        for step in self._transcript.steps:
            match step:
                case Send():
                    self._client.write(step.data)
                case Pass():
                    # Real ports, real time: the server paces itself by the wall clock.
                    time.sleep(step.seconds / self._speed)
                case Expect() | Match():
                    self._expect(step)
        self._pending += self._client.read_available(QUIET_S)
        if self._pending:
            raise Mismatch(f"{self._transcript.path.name}: at the end also received {self._pending!r}")

    def _expect(self, step: Expect | Match) -> None:
        wait_s = PATIENCE_S + (step.timing.at_s / self._speed if step.timing else 0.0)
        deadline = time.monotonic() + wait_s
        while (length := matched(step, self._pending)) == 0 and (left := deadline - time.monotonic()) > 0:
            self._pending += self._client.receive(left)
        if isinstance(step, Match) and length and step.pattern.pattern.endswith(OPTIONAL_ENDS):
            self._pending += self._client.read_available(QUIET_S)
            length = matched(step, self._pending)
        if length == 0:
            where = f"{self._transcript.path.name}:{step.line}"
            raise Mismatch(f"{where}: expected {wanted(step)}, received {self._pending!r}")
        self._pending = self._pending[length:]


def without_defaults(machine: str) -> str:
    """The machine file without its [defaults] table, which is entered as commands instead."""
    tables = re.split(r"^(?=\[)", machine, flags=re.MULTILINE)
    return "".join(table for table in tables if not table.startswith("[defaults]"))


def moves(transcript: Transcript) -> bool:
    """Whether the session may leave a motor turning."""
    return any(isinstance(step, Send) and b"GO" in step.data.upper() for step in transcript.steps)


def bring_to_rest(client: LineClient, *, speed: float) -> None:
    """Stop the motors: RESET does not, and the next session counts from where they are."""
    client.write(b"!K\n")
    time.sleep(COASTING_S / speed)


def power_cycle(client: LineClient, transcript: Transcript) -> None:
    """Bring the unit to the power-up state the transcript wants; swallow what it says on the way.

    The lines end with LF, because the unit would swallow a LF that comes straight after a CR.
    """
    memory = Machine.parse(transcript.machine).memory
    division = f"!MEMORY{memory.program_bytes},{memory.compiled_bytes}\n"
    kept_over_reset = b"!VARCLR\n!STARTP CLR\n!CMDDIR00\n!ENCPOL00\n"
    client.write(b"!HALT\n!K\n" + division.encode() + kept_over_reset + b"!RESET\n")
    received, deadline = b"", time.monotonic() + PATIENCE_S
    while b"REMOTE PANEL\r" not in received and time.monotonic() < deadline:
        received += client.receive(QUIET_S)
    settings = tomllib.loads(transcript.machine).get("defaults", {})
    fields = Machine.parse(transcript.machine).defaults
    client.write("".join(f"{name}{fields[name]}\n" for name in settings).encode() + LAST_OF_SET_UP)
    received, deadline = b"", time.monotonic() + PATIENCE_S
    while SET_UP_DONE not in received and time.monotonic() < deadline:
        received += client.receive(QUIET_S)
    assert SET_UP_DONE in received, f"{transcript.path.name}: set up, the unit said {received!r}"
    client.read_available(QUIET_S)


def _sessions() -> Iterator[object]:
    """Every session over every transport; the hosts' own and a share of the others run by default."""
    for transport in ALL:
        for index, transcript in enumerate(SESSIONS):
            marks = [] if _by_default(transport.name, transcript, index) else [pytest.mark.slow]
            if transport.missing:
                marks.append(pytest.mark.skip(reason=transport.missing))
            yield pytest.param(transcript, transport.name, id=f"{transcript.path.stem}-{transport.name}", marks=marks)


def _by_default(transport: str, transcript: Transcript, index: int) -> bool:
    if transport in USUAL:
        return transcript.path.stem.startswith("host_") or index % DEFAULT_SHARE == 0
    return index % SMALL_SHARE == 0


@pytest.mark.parametrize(("transcript", "transport"), list(_sessions()))
def test_transcript(transcript: Transcript, transport: str, servers: Servers) -> None:
    server = servers.server(transcript)
    with server.transports[transport].open(server.told, timeout_s=PATIENCE_S) as client:
        power_cycle(client, transcript)
        try:
            RealSession(transcript, client, speed=server.speed).run()
        finally:
            if moves(transcript):
                bring_to_rest(client, speed=server.speed)

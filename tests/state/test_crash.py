"""SIGKILL at random moments: everything that was acknowledged is there afterwards, and the file is sound.

Most rounds kill a bare writer, which is quick to start; some kill the whole emulator under a host that writes variables
and programs over TCP.
"""

from __future__ import annotations

import random
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from emulator.state.contents import Contents
from emulator.state.store import Store
from tests.ports.served import OEM6250, REPOSITORY, Served
from tests.state.writer import contents_made_of

OPTIONS = ("--tcp", "127.0.0.1:0", "--pty", "none")


def found_in(path: Path) -> Contents:
    """What a restart finds; raises if the file is not sound."""
    store = Store(path)
    try:
        return store.contents(0)
    finally:
        store.close()


def kill_a_writer(path: Path, after_s: float) -> int:
    """Let it write, kill it; the last number it confirmed."""
    arguments = [sys.executable, "-m", "tests.state.writer", str(path)]
    with subprocess.Popen(arguments, cwd=REPOSITORY, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        first = process.stdout.readline()
        killer = threading.Timer(after_s, process.kill)
        killer.start()
        said = first + process.stdout.read()
        killer.join()
    return int(said[: said.rindex("\n")].splitlines()[-1])


class Host:
    """Writes variables and programs to an emulator and remembers what was acknowledged."""

    def __init__(self) -> None:
        self.acknowledged: dict[str, int] = {}
        self.attempted: tuple[str, int] = ("", 0)
        self._number = 0

    def write(self, served: Served, choice: random.Random) -> None:
        """Until the connection breaks."""
        with served.connect() as host:
            try:
                self._exchange(host.sock, b"ECHO0\r", 1)
                while True:
                    self._number += 1
                    name = choice.choice(("VAR1", "VAR2", "VAR150", "ALPHA", "BETA"))
                    self.attempted = (name, self._number)
                    if name.startswith("VAR"):
                        self._exchange(host.sock, b"%s=%d\r" % (name.encode(), self._number), 1)
                    else:
                        text = b"DEL %s\rDEF %s\rVAR3=%d\rV2\rEND\r" % (name.encode(), name.encode(), self._number)
                        self._exchange(host.sock, text, 2)
                    self.acknowledged[name] = self._number
            except ConnectionError:
                return

    @staticmethod
    def _exchange(sock: socket.socket, data: bytes, prompts: int) -> None:
        """Send, and wait for prompts outside a definition."""
        sock.sendall(data)
        answer = b""
        while answer.count(b"> ") < prompts:
            part = sock.recv(4096)
            if not part:
                raise ConnectionResetError
            answer += part
        assert b"?" not in answer, answer

    def check(self, found: Contents) -> None:
        """All that was acknowledged is there; of what was under way, the old, the new, or part of the new."""
        under_way, number = self.attempted
        programs = {program.name: program.lines for program in found.programs}
        for name, acknowledged in self.acknowledged.items():
            if name.startswith("VAR"):
                allowed = {acknowledged, number} if name == under_way else {acknowledged}
                assert int(found.numbers[int(name[3:]) - 1]) in allowed, name
            elif name != under_way:
                assert programs[name] == (f"VAR3={acknowledged}", "V2"), name
            else:
                assert programs.get(name, ()) in (
                    (f"VAR3={acknowledged}", "V2"),
                    (),
                    (f"VAR3={number}",),
                    (f"VAR3={number}", "V2"),
                )
        if not under_way.startswith("VAR") and self.acknowledged.get(under_way) != number:
            self.acknowledged.pop(under_way, None)
        elif under_way in self.acknowledged:
            self.acknowledged[under_way] = int(found.numbers[int(under_way[3:]) - 1])


def kill_writers(path: Path, rounds: int, seed: int) -> None:
    choice = random.Random(seed)
    for _ in range(rounds):
        confirmed = kill_a_writer(path, choice.uniform(0.0, 0.06))
        found = found_in(path)
        number = int(found.texts[1])
        assert confirmed <= number <= confirmed + 1
        assert repr(found) == repr(contents_made_of(number)), "a change is there whole or not at all"


def kill_emulators(path: Path, rounds: int, seed: int) -> None:
    choice = random.Random(seed)
    host = Host()
    for number in range(rounds):
        announce = path.with_name(f"announce-{number}")
        with Served(*OPTIONS, "--state", str(path), announce=announce, command=OEM6250) as served:
            killer = threading.Timer(choice.uniform(0.05, 0.4), served.process.kill)
            killer.start()
            host.write(served, choice)
            killer.join()
        host.check(found_in(path))
    assert host.acknowledged


def test_a_writer_killed(tmp_path: Path) -> None:
    kill_writers(tmp_path / "state", rounds=18, seed=6250)


def test_an_emulator_killed(tmp_path: Path) -> None:
    kill_emulators(tmp_path / "state", rounds=2, seed=6250)


@pytest.mark.slow
def test_killed_two_hundred_times(tmp_path: Path) -> None:
    kill_writers(tmp_path / "writer", rounds=140, seed=1)
    kill_emulators(tmp_path / "emulator", rounds=60, seed=2)

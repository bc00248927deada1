"""The whole emulator with --state: over TCP, killed, ended, started twice, and on a disk that is full."""

from __future__ import annotations

import os
import signal
import socket
import sqlite3
import subprocess
from decimal import Decimal
from pathlib import Path

import pytest

from emulator.state.contents import Contents
from emulator.state.store import FORMAT_VERSION, Store
from tests.ports.served import OEM6250, REPOSITORY, Host, Served, wait_until

resource = pytest.importorskip("resource", reason="limits of processes are Unix's")

OPTIONS = ("--tcp", "127.0.0.1:0", "--pty", "none")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "unit.state"


def serving(path: Path, *options: str) -> Served:
    announce = path.with_name(f"announce-{len(list(path.parent.iterdir()))}")
    return Served(*OPTIONS, "--state", str(path), *options, announce=announce, command=OEM6250)


def ask(host: Host, text: bytes) -> bytes:
    """One command and its answer, with the prompt."""
    host.sock.sendall(text + b"\r")
    answer = b""
    while not answer.endswith((b"> ", b"? ")):
        part = host.sock.recv(4096)
        assert part
        answer += part
    return answer


def kept(path: Path, unit: int = 0) -> Contents:
    store = Store(path, create=False)
    try:
        return store.contents(unit)
    finally:
        store.close()


def refusal(path: Path) -> str:
    """The one line of an emulator that does not start."""
    done = subprocess.run(
        [*OEM6250, "serve", *OPTIONS, "--state", str(path)],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1, done.stderr
    return done.stderr.removeprefix(f"oem6250: --state {path}: ")


def test_kept_over_a_kill_used_by_one_and_flushed_at_the_end(path: Path) -> None:
    """One story, because starting takes longer than all of it."""
    with serving(path) as served:
        with served.connect() as host:
            ask(host, b"ECHO0")
            assert ask(host, b"VAR1=5") == b"\r\n> "
            assert refusal(path) == "in use by another emulator\n"
            assert ask(host, b"VAR1") == b"*VAR1=+5.0\r\r\n> ", "the first has not noticed"
        served.process.send_signal(signal.SIGKILL)
        served.process.wait()
    with serving(path) as served:
        with served.connect() as host:
            ask(host, b"ECHO0")
            assert ask(host, b"VAR1") == b"*VAR1=+5.0\r\r\n> "
            host.sock.sendall(b"DEF COUNT:L:VAR2=VAR2+1:LN:END\rCOUNT\r")
            ask(host, b"!VAR2")
        status, _, errors = served.stop()
        assert (status, errors) == (0, "")
    assert kept(path).numbers[1] > 0, "what nobody heard of is flushed at the end"
    assert [entry.name for entry in path.parent.iterdir() if entry.name.startswith(path.name)] == [path.name]


def test_a_chain_keeps_every_unit(path: Path) -> None:
    store = Store(path)
    store.write({1: Contents(numbers=(Decimal(7),))})
    store.close()
    with serving(path, "--units", "2") as served, served.connect() as host:
        said(host, b"0_ERRLVL1\r2_VAR1\r", b"*+7.0")
        said(host, b"1_VAR1=5\r2_TREV\r", b"OEM6250")
        served.stop()
    assert kept(path, 0).numbers[0] == 5
    assert kept(path, 1).numbers[0] == 7


def said(host: Host, data: bytes, answer: bytes) -> None:
    """Send, and read until the answer."""
    host.sock.sendall(data)
    received = b""
    while answer not in received:
        received += host.sock.recv(4096)


def test_a_damaged_file_is_told_and_set_aside(path: Path) -> None:
    store = Store(path)
    store.write({0: Contents(texts=("A",))})
    store.close()
    os.truncate(path, path.stat().st_size // 2)
    with serving(path) as served:
        with served.connect() as host:
            ask(host, b"ECHO0")
            assert ask(host, b"TSS.22") == b"*1\r\r\n> "
            host.sock.sendall(b"VAR1=5:VAR1\r")
            host.sock.shutdown(socket.SHUT_WR)
            assert host.read_to_end().endswith(b"*VAR1=+5.0\r\r\n> "), "a reply that waits for the disk is not lost"
        status, _, errors = served.stop()
    assert status == 0
    assert errors.count("\n") == 1
    assert 'event="state file damaged, memory cleared"' in errors
    assert f"kept_as={path}.damaged-1" in errors


@pytest.mark.skipif(not hasattr(resource, "prlimit"), reason="limits of other processes are Linux's")
def test_a_full_disk_stops_nobody_and_is_made_up_for(path: Path) -> None:
    with serving(path) as served:
        with served.connect() as host:
            ask(host, b"ECHO0")
            full = path.with_name(path.name + "-wal").stat().st_size
            resource.prlimit(served.process.pid, resource.RLIMIT_FSIZE, (full, resource.RLIM_INFINITY))
            assert ask(host, b"VAR1=5") == b"\r\n> "
            assert ask(host, b"VAR1=6") == b"\r\n> "
            resource.prlimit(
                served.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
            )
            wait_until(lambda: path.with_name(path.name + "-wal").stat().st_size > full)
        status, _, errors = served.stop()
    assert status == 0
    first, second = errors.splitlines()
    assert 'event="state file not written, trying again"' in first
    assert 'event="state file written again"' in second
    assert kept(path).numbers[0] == 6


def test_a_newer_file_is_refused(path: Path) -> None:
    Store(path).close()
    connection = sqlite3.connect(path)
    connection.execute(f"PRAGMA user_version = {FORMAT_VERSION + 1}")
    connection.close()
    assert "newer oem6250" in refusal(path)

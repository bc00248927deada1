"""Recordings of a real server over TCP: they replay, also when the server was killed."""

from __future__ import annotations

import re
import signal
import socket
from pathlib import Path
from random import Random

import pytest

from emulator.recording import read, replay
from emulator.recording.comparison import render
from emulator.recording.format import Attached, Received, Sent
from tests.ports.served import OEM6250, PATIENCE_S, Served, wait_until
from tests.recording.sessions import packets

LAST = b"1TPC\r"
QUIET = "[defaults]\nECHO = 0\n"


def serve(tmp_path: Path, *options: str, name: str = "a.rec") -> Served:
    (tmp_path / "m.toml").write_text(QUIET if "--units" not in options else "")
    (tmp_path / "ready").unlink(missing_ok=True)
    fixed = [str(tmp_path / "m.toml"), "--tcp", "127.0.0.1:0", "--pty", "none", "--record", str(tmp_path / name)]
    return Served(*fixed, *options, announce=tmp_path / "ready", command=OEM6250)


def exchange(sock: socket.socket, data: bytes, *, until: bytes) -> bytes:
    """Send, and read until an answer is in."""
    sock.settimeout(PATIENCE_S)
    sock.sendall(data)
    said = b""
    while until not in said:
        part = sock.recv(65536)
        assert part, said
        said += part
    return said


def random_session(served: Served, seed: int) -> bytes:
    """Two hosts send a random session between them; what the first one heard."""
    random = Random(seed)
    with served.connect() as first, served.connect() as second:
        for packet in packets(random, 60):
            random.choice((first, first, second)).sock.sendall(packet)
        heard = exchange(first.sock, b"\r!C\r!K\r!HALT\r!K\r!1TPC\r", until=b"*1TPC")
    return heard


def same(path: Path) -> None:
    outcome = replay(path)
    assert outcome.difference is None, render(outcome.difference, path=str(path))
    assert not outcome.raised


@pytest.mark.parametrize(
    ("seed", "options"),
    [
        (1, ()),
        pytest.param(2, ("--speed", "20"), marks=pytest.mark.slow),
        (3, ("--speed", "max")),
        (4, ("--line", "115200")),
        (5, ("--units", "3")),
    ],
)
def test_a_session_over_tcp_replays(tmp_path: Path, seed: int, options: tuple[str, ...]) -> None:
    with serve(tmp_path, *options) as served:
        if "--units" in options:
            with served.connect() as host:
                exchange(host.sock, b"0_ERRLVL1\r1_VAR1=3\r0_VAR1\r", until=b"+0.0")
        else:
            random_session(served, seed)
        status, _, errors = served.stop()
    assert status == 0, errors
    recording = read(tmp_path / "a.rec")
    assert recording.complete
    assert recording.header.texts["machine u0"] == (tmp_path / "m.toml").read_text()
    kinds = {type(entry) for entry in recording.entries}
    assert {Attached, Received, Sent} <= kinds
    same(tmp_path / "a.rec")


def test_what_the_host_heard_is_what_was_recorded(tmp_path: Path) -> None:
    with serve(tmp_path) as served:
        with served.connect() as host:
            heard = exchange(host.sock, b"1D7\r1D\rTREV\r", until=b"TREV")
        served.stop()
    sent = [entry for entry in read(tmp_path / "a.rec").entries if isinstance(entry, Sent) and entry.channel == 0]
    assert b"".join(entry.data for entry in sent).startswith(heard)


def test_a_killed_server_leaves_a_recording(tmp_path: Path) -> None:
    with serve(tmp_path) as served:
        random_session(served, 7)
        wait_until(lambda: b"!1TPC" in (tmp_path / "a.rec").read_bytes(), PATIENCE_S)
        served.process.send_signal(signal.SIGKILL)
        served.process.wait(PATIENCE_S)
    assert not read(tmp_path / "a.rec").complete
    same(tmp_path / "a.rec")


def test_a_session_with_a_stored_memory_replays(tmp_path: Path) -> None:
    state = ("--state", str(tmp_path / "unit.state"))
    for name, commands in (("a.rec", b"DEF MAIN\rVAR1=VAR1+1\rEND\rSTARTP MAIN\rVAR1\r"), ("b.rec", b"VAR1\rTSTAT\r")):
        with serve(tmp_path, *state, name=name) as served:
            with served.connect() as host:
                exchange(host.sock, commands + LAST, until=b"*1TPC+")
            assert served.stop()[0] == 0
    assert '| STARTP = "MAIN"' in (tmp_path / "b.rec").read_text()
    assert re.search(r"VAR1=\+1\.0", (tmp_path / "b.rec").read_text())
    same(tmp_path / "a.rec")
    same(tmp_path / "b.rec")


# Meant: Windows has no such signal.
@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no SIGHUP")
def test_a_machine_file_read_again_replays(tmp_path: Path) -> None:
    with serve(tmp_path) as served:
        with served.connect() as host:
            exchange(host.sock, b"DRIVE11:1TAS\r", until=b"*1TAS")
            (tmp_path / "m.toml").write_text(QUIET + '[wires]\nenable = "open"\n')
            served.process.send_signal(signal.SIGHUP)
            wait_until(lambda: b"reload_machine_file" in (tmp_path / "a.rec").read_bytes(), PATIENCE_S)
            said = exchange(host.sock, b"TER\rGO1\r1TAS\r", until=b"*1TAS")
        served.stop()
    assert b"TER" in said
    same(tmp_path / "a.rec")
    without = re.sub(r".*reload_machine_file.*\n", "", (tmp_path / "a.rec").read_text())
    (tmp_path / "c.rec").write_text(without)
    assert replay(tmp_path / "c.rec").difference is not None


def test_a_file_that_exists_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.rec").write_text("something")
    with pytest.raises(AssertionError, match=r"ended with 2: .*--record .*a\.rec: there is such a file already"):
        serve(tmp_path)
    assert (tmp_path / "a.rec").read_text() == "something"

"""What the TCP port does with each kind of client, over real sockets and with the system's own telnet client."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

from emulator.ports.errors import PortError
from emulator.ports.tcp import TcpPort
from emulator.ports.telnet import ARE_YOU_THERE, DO, ECHO, IAC, SB, SE, SUPPRESS_GO_AHEAD, WILL, WONT
from emulator.ports.telnet_session import HERE_I_AM
from tests.ports.served import OEM6250, REPOSITORY, Host, Served
from tests.ports.test_telnet import OFFER
from tests.transcripts.transports import TelnetLine

ANSWER = b"1TPE\r\n*1TPE+0\r\r\n> "
"""With the unit's echo, which is on when it powers up."""
# Meant: telnet is a program of the system, not of the package index; `apt install telnet` brings it.
needs_telnet = pytest.mark.skipif(
    not (shutil.which("telnet") and hasattr(os, "openpty")), reason="no telnet client here"
)


@pytest.fixture(scope="module")
def unit(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    options = ("--tcp", "127.0.0.1:0", "--telnet", "127.0.0.1:0", "--pty", "none")
    with Served(*options, announce=tmp_path_factory.mktemp("tcp") / "announce", command=OEM6250) as served:
        yield served


@pytest.fixture
def raw(unit: Served) -> Iterator[Host]:
    with unit.connect() as host:
        host.sock.settimeout(5)
        yield host


def test_a_raw_client_is_told_nothing_but_what_the_unit_says(raw: Host) -> None:
    raw.sock.settimeout(0.1)
    with pytest.raises(TimeoutError):
        raw.sock.recv(1)
    raw.sock.settimeout(5)
    every_other_byte = bytes(byte for byte in range(0x80, 0xFF))
    shown = raw.ask(b"; " + every_other_byte + b"\r", 2 + len(every_other_byte))
    assert shown == b"; " + every_other_byte
    raw.sock.sendall(b"1TPE\r")
    assert raw.read_until(ANSWER)


@pytest.mark.parametrize(
    "noise", [b"\xff", b"\xff\xff\xff", b"\xff\xfa", b"\xff\xf0", b"\xff\xfa\x2c\x01", b"\xff\x80"]
)
def test_noise_with_iac_does_not_hang_a_raw_client(raw: Host, noise: bytes) -> None:
    raw.sock.sendall(b"; " + noise)
    raw.sock.sendall(b"\r1TPE\r")
    assert raw.read_until(ANSWER).startswith(b"; " + noise)


def test_a_held_iac_is_executed_when_the_client_closes(raw: Host) -> None:
    raw.sock.sendall(b";\xff")
    raw.sock.shutdown(socket.SHUT_WR)
    assert raw.read_to_end() == b";\xff"


@pytest.mark.parametrize("before", [b"", b"1TPE\r"])
def test_a_client_that_negotiates_is_answered(raw: Host, before: bytes) -> None:
    """At the beginning of the stream and within it, byte by byte."""
    raw.sock.sendall(before)
    if before:
        raw.read_until(ANSWER)
    for byte in (IAC, DO, SUPPRESS_GO_AHEAD, IAC, WILL, 24, IAC, DO, 200, IAC, SB, 24, 0, IAC, SE):
        raw.sock.sendall(bytes((byte,)))
    refused = bytes((IAC, 254, 24, IAC, WONT, 200))
    assert raw.read(len(OFFER + refused)) == OFFER + refused
    assert raw.ask(b"1TPE\r\0", len(ANSWER) + 1) == b"1TPE\r\n*1TPE+0\r\0\r\n> "


def test_are_you_there_is_answered_while_the_unit_waits(raw: Host) -> None:
    raw.sock.sendall(b"T.5\r1TPE\r" + bytes((IAC, ARE_YOU_THERE)))
    assert raw.read(len(OFFER + HERE_I_AM)) == OFFER + HERE_I_AM
    assert raw.read_until(b"*1TPE+0\r\0\r\n> ").startswith(b"T.5\r\n")


def test_a_data_mark_out_of_band_is_not_missing_from_the_stream(raw: Host) -> None:
    raw.sock.sendall(bytes((IAC, DO, ECHO)))
    raw.read(len(OFFER))
    raw.sock.sendall(bytes((IAC,)))
    raw.sock.send(bytes((242,)), socket.MSG_OOB)
    assert raw.ask(b"1TPE\r", len(ANSWER) + 1).startswith(b"1TPE\r\n*1TPE")


def test_a_telnet_port_speaks_first(unit: Served) -> None:
    host, _, port = unit.announced["telnet"][0].rpartition(":")
    with socket.create_connection((host, int(port)), timeout=5) as sock:
        assert Host(sock).read(len(OFFER)) == OFFER


@needs_telnet
@pytest.mark.parametrize(("kind", "dash"), [("tcp", "-"), ("telnet", "")])
def test_the_telnet_client_shows_each_character_once(unit: Served, kind: str, dash: str) -> None:
    host, _, port = unit.announced[kind][0].rpartition(":")
    line = TelnetLine("-E", "--", host, dash + port)
    try:
        shown = b""
        for byte in b"1TPE":
            line.write(bytes((byte,)))
            shown += line.read(5.0)
        assert shown == b"1TPE"
        line.write(b"\r")
        while not shown.endswith(b"> "):
            shown += line.read(5.0)
        assert shown == ANSWER
    finally:
        line.close()


@pytest.mark.parametrize("host", ["0.0.0.0", ""])
@pytest.mark.parametrize("negotiate", [False, True])
def test_others_are_let_in_only_on_request(host: str, negotiate: bool) -> None:
    option = "--telnet" if negotiate else "--tcp"
    with pytest.raises(PortError, match=rf"^{option} {host}:0: .*--allow-remote"):
        TcpPort(host, 0, negotiate=negotiate)
    port = TcpPort(host, 0, negotiate=negotiate, allow_remote=True)
    try:
        assert port.remote_addresses == port.addresses
    finally:
        port.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "127.1.2.3", "localhost"])
def test_loopback_needs_no_permission(host: str) -> None:
    port = TcpPort(host, 0)
    try:
        assert port.addresses and not port.remote_addresses
    finally:
        port.close()


def test_the_command_line_says_what_remote_means(unit: Served) -> None:
    serve = [sys.executable, "-m", "tests.ports.toy", "serve", "--pty", "none", "--announce", "-"]
    command = [*serve, "--tcp", "0.0.0.0:0"]
    refused = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=20, check=False)
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert "--allow-remote" in refused.stderr
    command = [*serve, "--tcp", "0.0.0.0:0", "--tcp", "127.0.0.1:0", "--allow-remote"]
    with subprocess.Popen(command, cwd=REPOSITORY, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None and server.stderr is not None
        assert server.stdout.readline()
        server.terminate()
        said = server.stderr.read()
    assert "no password" in said and "0.0.0.0" in said and "127.0.0.1" not in said
    assert said.count("\n") == 1

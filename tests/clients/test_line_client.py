"""The line client against a foreign peer: a plain socket server and a bare pty, no emulator."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator

import pytest

from clients import LineClient, UnitTimeout

Answer = Callable[[bytes], list[bytes]]


class Peer:
    """One TCP connection answered by a function; every packet goes out by itself."""

    def __init__(self, answer: Answer) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.url = f"tcp://127.0.0.1:{self._server.getsockname()[1]}"
        self.got = b""
        self._answer = answer
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        connection, _ = self._server.accept()
        with connection, contextlib.suppress(ConnectionError):
            while data := connection.recv(4096):
                self.got += data
                self._send(connection, self._answer(data))

    def _send(self, connection: socket.socket, packets: list[bytes]) -> None:
        for packet in packets:
            connection.sendall(packet)
            time.sleep(0.002)  # so that the packets arrive apart: the client runs against the wall clock

    def close(self) -> None:
        self._server.close()
        self._thread.join(2)


@pytest.fixture
def peer() -> Iterator[Callable[[Answer], Peer]]:
    peers: list[Peer] = []

    def start(answer: Answer) -> Peer:
        peers.append(Peer(answer))
        return peers[-1]

    yield start
    for each in peers:
        each.close()


def test_exchange_adds_cr_and_returns_the_answer_with_its_prompt(peer: Callable[[Answer], Peer]) -> None:
    unit = peer(lambda _: [b"*1TPE", b"+0\r\r", b"\n> "])
    with LineClient.open(unit.url) as client:
        assert client.exchange("1TPE") == b"*1TPE+0\r\r\n> "
    assert unit.got == b"1TPE\r"


@pytest.mark.parametrize("line", [b"A5\r", b"A5\n", b"A5:"])
def test_a_delimiter_is_not_doubled(peer: Callable[[Answer], Peer], line: bytes) -> None:
    unit = peer(lambda _: [b"\r\n> "])
    with LineClient.open(unit.url) as client:
        client.exchange(line)
    assert unit.got == line


@pytest.mark.parametrize("prompt", [b"\r\n> ", b"\r\n? ", b"\r\n- "])
def test_each_prompt_ends_an_answer(peer: Callable[[Answer], Peer], prompt: bytes) -> None:
    unit = peer(lambda _: [prompt])
    with LineClient.open(unit.url) as client:
        assert client.exchange(b"X") == prompt


def test_two_answers_in_one_packet_come_one_by_one(peer: Callable[[Answer], Peer]) -> None:
    unit = peer(lambda _: [b"*1\r\r\n> *2\r\r\n? tail"])
    with LineClient.open(unit.url) as client:
        assert client.exchange(b"A:B") == b"*1\r\r\n> "
        assert client.read_until_prompt() == b"*2\r\r\n? "
        assert client.read_available(0.02) == b"tail"


def test_timeout_tells_what_had_arrived(peer: Callable[[Answer], Peer]) -> None:
    unit = peer(lambda _: [b"*1TPE"])
    with LineClient.open(unit.url, timeout_s=0.2) as client, pytest.raises(UnitTimeout) as failure:
        client.exchange(b"1TPE")
    assert failure.value.received == b"*1TPE"
    assert "*1TPE" in str(failure.value)


def test_a_peer_that_keeps_talking_cannot_stretch_the_timeout(peer: Callable[[Answer], Peer]) -> None:
    unit = peer(lambda _: [b"."] * 200)
    began = time.monotonic()
    with LineClient.open(unit.url, timeout_s=0.1) as client, pytest.raises(UnitTimeout):
        client.exchange(b"1TPE")
    assert time.monotonic() - began < 1.0


def test_a_closed_connection_is_an_error(peer: Callable[[Answer], Peer]) -> None:
    server = socket.create_server(("127.0.0.1", 0))
    with server, LineClient.open(f"tcp://127.0.0.1:{server.getsockname()[1]}") as client:
        server.accept()[0].close()
        with pytest.raises(ConnectionError):
            client.read_until_prompt()


@pytest.mark.parametrize("kind", ["tcp", "socket"])
def test_a_lost_connection_leaves_no_socket_open(kind: str) -> None:
    with warnings.catch_warnings(), socket.create_server(("127.0.0.1", 0)) as server:
        warnings.simplefilter("error")
        client = LineClient.open(f"{kind}://127.0.0.1:{server.getsockname()[1]}")
        inner = client._line._port._socket if kind == "socket" else client._line._socket  # type: ignore[attr-defined]
        server.accept()[0].close()
        with pytest.raises(OSError):
            client.read_until_prompt()
        client.close()
        assert inner.fileno() == -1


@pytest.mark.parametrize("url", ["tcp://", "tcp://host", "tcp://host:x", "tcp://:1"])
def test_a_bad_url_is_refused(url: str) -> None:
    with pytest.raises(ValueError, match="tcp://host:port"):
        LineClient.open(url)


def test_nobody_listening_is_an_os_error() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    with pytest.raises(OSError):
        LineClient.open(f"tcp://127.0.0.1:{port}", timeout_s=0.5)


# Meant: Windows has none, and the library is to be tested there too.
@pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")
def test_a_serial_port() -> None:
    ours, theirs = os.openpty()
    try:
        with LineClient.open(os.ttyname(theirs), timeout_s=1.0) as client:
            client.write(b"1TPE\r")
            assert os.read(ours, 100) == b"1TPE\r"
            os.write(ours, b"*1TPE+0\r\r\n> ")
            assert client.read_until_prompt() == b"*1TPE+0\r\r\n> "
            assert client.receive(0.01) == b""
    finally:
        os.close(ours)
        os.close(theirs)


def test_the_client_never_imports_the_emulator() -> None:
    code = "import sys, clients; print([m for m in sys.modules if m.split('.')[0] in ('emulator', 'numpy', 'numba')])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"

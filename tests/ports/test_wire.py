"""The battery of `battery.py`, on the toy controller over real sockets."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator

import pytest

from tests.ports import battery
from tests.ports.served import OEM6250, Served

OPTIONS = ("--tcp", "127.0.0.1:0", "--pty", "none")


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with Served(*OPTIONS, announce=tmp_path_factory.mktemp("wire") / "announce") as served:
        yield served


@pytest.fixture(scope="module")
def oem6250(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """The real unit, with the echo off, as most hosts have it."""
    with Served(*OPTIONS, announce=tmp_path_factory.mktemp("unit") / "announce", command=OEM6250) as served:
        with served.connect() as host:
            host.sock.sendall(b"ECHO0\r1TPE\r")
            host.read_until(OEM6250_DIALECT.answer)
        yield served


OEM6250_DIALECT = battery.Dialect(question=b"1TPE\r", answer=b"*1TPE+0\r\r\n> ")
Scenario = Callable[[Served, battery.Dialect], None]


@pytest.mark.parametrize("scenario", battery.ALL, ids=lambda scenario: scenario.__name__)
def test_wire(served: Served, scenario: Scenario) -> None:
    scenario(served, battery.Dialect())


@pytest.mark.parametrize("scenario", battery.ALL, ids=lambda scenario: scenario.__name__)
def test_wire_of_the_unit(oem6250: Served, scenario: Scenario) -> None:
    scenario(oem6250, OEM6250_DIALECT)


@pytest.mark.slow
def test_a_client_that_never_reads_for_ten_seconds(served: Served) -> None:
    battery.never_reading(served, battery.Dialect(), seconds=10.0)


def test_a_half_closed_client_waits_for_what_is_under_way(served: Served) -> None:
    with served.connect() as host:
        host.sock.sendall(b"HOLD 200\rA\r")
        host.sock.shutdown(1)
        assert host.read_to_end() == b"*A\r\n> *HELD\r\n> "


def test_many_visitors_during_a_long_motion_do_not_use_up_descriptors(served: Served) -> None:
    with served.connect() as host:
        host.ask(b"HOLD 2500\rA\r", 6)
        before = served.descriptors()
        for _ in range(300):
            served.connect().sock.close()
        assert host.ask(b"B\r", 6) == b"*B\r\n> "
        assert served.descriptors() - before < 300
        assert host.read(9) == b"*HELD\r\n> "


def test_output_for_everybody_reaches_everybody(served: Served) -> None:
    with served.connect() as first, served.connect() as second:
        second.ask(b"A\r", 6)
        first.sock.sendall(b"WAIT 1\r")
        assert first.read(9) == second.read(9) == b"*DONE\r\n> "


def test_a_long_reply_to_a_slow_reader_arrives_whole(served: Served) -> None:
    with served.connect() as host:
        host.sock.sendall(b"FILL 200000\r" * 3 + b"END\r")
        text = host.read(3 * 200_005 + 8)
        assert text == (b"*" + b"x" * 200_000 + b"\r\n> ") * 3 + b"*END\r\n> "


def test_output_that_nobody_reads_needs_no_memory(served: Served) -> None:
    with served.connect() as greedy, served.connect() as other:
        other.ask(b"A\r", 6)
        before = served.resident_bytes()
        for _ in range(50):
            greedy.sock.sendall(b"FILL 100000\r" * 20)
            assert other.ask(b"A\r", 6) == b"*A\r\n> "
            assert served.resident_bytes() - before < battery.GROWTH_BYTES


def test_a_raising_command_leaves_the_others_alone(tmp_path_factory: pytest.TempPathFactory) -> None:
    announce = tmp_path_factory.mktemp("boom") / "announce"
    with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=announce) as served:
        with served.connect() as host, served.connect() as other:
            host.sock.sendall(b"BOOM\r")
            assert other.ask(b"A\r", 6) == b"*A\r\n> "
            assert host.ask(b"B\r", 6) == b"*B\r\n> "
        status, _, errors = served.stop()
    assert status == 0
    assert 'event="controller raised"' in errors
    assert r"BOOM\r" in errors


def send_some(sock: socket.socket, text: memoryview) -> int:
    try:
        return sock.send(text[:65536]) if text else 0
    except BlockingIOError:
        return 0


def receive_some(sock: socket.socket) -> bytes:
    try:
        return sock.recv(65536)
    except BlockingIOError:
        return b""


def test_commands_behind_a_long_dwell_wait_on_the_wire_and_none_is_lost(oem6250: Served) -> None:
    commands = 60_000
    with oem6250.connect() as sender, oem6250.connect() as other:
        before = oem6250.resident_bytes()
        sender.sock.setblocking(False)
        text = memoryview(b"T1\r" + b"1D7\r" * commands + b"1TPC\r")
        received = bytearray()
        stopped = False
        while text or not received.endswith(b"*1TPC+0\r\r\n> "):
            text = text[send_some(sender.sock, text) :]
            received += receive_some(sender.sock)
            if not stopped:
                other.sock.sendall(b"!1TAS.1\r")
                assert other.read_until(b"> ") == b"*0\r\r\n> "
                stopped = True
        assert bytes(received) == b"\r\n> " * (1 + commands) + b"*1TPC+0\r\r\n> "
        assert oem6250.resident_bytes() - before < 20_000_000
        other.sock.sendall(b"1D4000\r")
        other.read_until(b"> ")

"""Several hosts on one line at once: who hears what, and that nobody's command is cut by another's."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.ports.served import OEM6250, Host, Served, opened, read_pty, wait_until

OK = b"\r\r\n> "
"""What ends the last reply of a command at ERRLVL4, and the prompt."""
pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="pseudo-terminals are a thing of Unix")


def start(folder: Path, *options: str) -> Served:
    pty = ("--pty", str(folder / "tty"))
    return Served("--tcp", "127.0.0.1:0", *pty, *options, announce=folder / "announce", command=OEM6250)


@pytest.fixture(scope="module")
def apart(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A unit as it comes: each connection hears what it asked for."""
    with start(tmp_path_factory.mktemp("apart")) as served:
        yield served


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with start(tmp_path_factory.mktemp("shared"), "--shared-line") as served:
        yield served


class Taps:
    """Two TCP hosts; the unit is as after RESET, without echo, and has told both so."""

    def __init__(self, served: Served, stack: ExitStack, *, shared: bool = False) -> None:
        self.served = served
        self._settled = 0
        self.first, self.second = (stack.enter_context(served.connect()) for _ in range(2))
        self.first.sock.sendall(b"!K\r!RESET\rDEL TALK\rDEL MAIN\rECHO0\r")
        self.settle(self.first)
        self.settle(self.second)
        said = self.settle(self.first)
        if shared:
            self.second.read_until(said)

    def settle(self, host: Host) -> bytes:
        """Read until the unit has done all that was asked before this; what was read last."""
        self._settled += 1
        text = b"SETTLED %d" % self._settled
        host.sock.sendall(b'WRITE"' + text + b'"\r')
        host.read_until(text + b"\r\n> ")
        return text + b"\r\n> "

    def silent(self, host: Host) -> None:
        """What was said to others has not reached this one: its next answer is the next thing it hears."""
        host.sock.sendall(b"1A\r")
        assert host.read_until(OK) == b"*1A10.0000" + OK


@pytest.fixture
def taps(apart: Served) -> Iterator[Taps]:
    with ExitStack() as stack:
        yield Taps(apart, stack)


@pytest.fixture
def shared_taps(shared: Served) -> Iterator[Taps]:
    with ExitStack() as stack:
        yield Taps(shared, stack, shared=True)


def define(host: Host, name: bytes, *commands: bytes) -> None:
    """Store a program; the unit answers each line with a prompt."""
    host.sock.sendall(b"\r".join((b"DEF " + name, *commands, b"END", b'WRITE"STORED"', b"")))
    host.read_until(b"STORED\r\n> ")


class TestApart:
    def test_replies_go_to_the_connection_that_asked(self, taps: Taps) -> None:
        for number in range(50):
            taps.first.sock.sendall(b"VAR1=%d:VAR1\r" % number)
            taps.second.sock.sendall(b"1V\r")
            assert taps.first.read_until(b".0" + OK) == b"\r\n> *VAR1=+%d.0" % number + OK
            assert taps.second.read_until(OK) == b"*1V1.0000" + OK

    def test_a_program_speaks_to_the_connection_that_started_it(self, taps: Taps) -> None:
        define(taps.second, b"TALK", b"T0.05", b'WRITE"FROM TALK"', b"1V")
        taps.first.sock.sendall(b"TALK\r")
        assert taps.first.read_until(b"1V1.0000" + OK) == b"FROM TALK*1V1.0000" + OK
        taps.silent(taps.second)

    def test_another_may_ask_while_it_runs(self, taps: Taps) -> None:
        define(taps.first, b"TALK", b"T0.1", b'WRITE"FROM TALK"')
        taps.first.sock.sendall(b"TALK\r")
        taps.second.sock.sendall(b"!1A\r")
        assert taps.second.read_until(OK) == b"*1A10.0000" + OK
        assert taps.first.read_until(b"> ") == b"FROM TALK\r\n> "
        taps.silent(taps.second)

    def test_when_its_starter_has_gone_a_program_speaks_to_all(self, taps: Taps) -> None:
        define(taps.second, b"TALK", b"T0.3", b'WRITE"FROM TALK"')
        with taps.served.connect() as starter, taps.served.connect() as third:
            third.ask(b"1A\r", len(b"*1A10.0000" + OK))
            starter.sock.sendall(b"TALK\r1V\r")
            wait_until(lambda: self._running(taps))
            starter.reset()
            for host in (taps.first, taps.second, third):
                assert host.read(9) == b"FROM TALK"
            taps.silent(taps.first)

    def test_a_program_nobody_typed_speaks_to_all(self, taps: Taps) -> None:
        define(taps.first, b"MAIN", b'WRITE"FROM MAIN"')
        taps.first.sock.sendall(b"STARTP MAIN\r")
        assert taps.first.read_until(b"> ") == b"\r\n> "
        taps.second.sock.sendall(b"!RESET\r")
        for host in (taps.first, taps.second):
            assert b"PARKER" in host.read_until(b"FROM MAIN")
        taps.second.sock.sendall(b"STARTP CLR\r")

    def test_hosts_that_type_at_once_never_cut_each_others_commands(self, taps: Taps) -> None:
        """Byte by byte in turn, on the wire as well: every command is executed as its host meant it."""
        for host in (taps.first, taps.second):
            host.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for number in range(10):
            lines = (b"VAR1=1%02d:VAR1\r" % number, b"VAR2=2%02d:VAR2\r" % number)
            for pair in zip(*lines, strict=True):
                for host, byte in zip((taps.first, taps.second), pair, strict=True):
                    host.sock.sendall(bytes((byte,)))
            assert taps.first.read_until(OK) == b"\r\n> *VAR1=+1%02d.0" % number + OK
            assert taps.second.read_until(OK) == b"\r\n> *VAR2=+2%02d.0" % number + OK

    def test_pty_and_tcp_together(self, taps: Taps) -> None:
        define(taps.first, b"TALK", b"T0.05", b'WRITE"FROM TALK"')
        assert taps.served.pty is not None
        with opened(taps.served.pty) as fd:
            os.write(fd, b"1V\r")
            assert read_pty(fd, 14) == b"*1V1.0000" + OK
            os.write(fd, b"TALK\r")
            assert read_pty(fd, 13) == b"FROM TALK\r\n> "
        taps.silent(taps.first)

    def test_a_program_whose_pty_host_closed_speaks_to_all(self, taps: Taps) -> None:
        define(taps.first, b"TALK", b"T0.3", b'WRITE"FROM TALK"')
        assert taps.served.pty is not None
        with opened(taps.served.pty) as fd:
            os.write(fd, b"1V\r")
            assert read_pty(fd, 14) == b"*1V1.0000" + OK
            os.write(fd, b"TALK\r")
            wait_until(lambda: self._running(taps))
        assert taps.first.read(9) == taps.second.read(9) == b"FROM TALK"

    @staticmethod
    def _running(taps: Taps) -> bool:
        taps.second.sock.sendall(b"!TSS.3\r")
        return taps.second.read_until(OK) == b"*1" + OK


class TestShared:
    """`--shared-line`: a Y-cable on the unit's transmitter."""

    def test_every_tap_hears_everything(self, shared_taps: Taps) -> None:
        first, second = shared_taps.first, shared_taps.second
        first.sock.sendall(b"1V\r")
        assert first.read_until(OK) == second.read_until(OK) == b"*1V1.0000" + OK
        second.sock.sendall(b"XYZZY\r")
        assert first.read_until(b"? ") == second.read_until(b"? ")

    def test_the_echo_too(self, shared_taps: Taps) -> None:
        first, second = shared_taps.first, shared_taps.second
        first.sock.sendall(b"ECHO1\r1v\r")
        text = b"\r\n> 1V\r\n*1V1.0000" + OK
        assert first.read(len(text)) == second.read(len(text)) == text

    def test_programs_too_and_the_pty(self, shared_taps: Taps) -> None:
        first, second = shared_taps.first, shared_taps.second
        pty = shared_taps.served.pty
        assert pty is not None
        with opened(pty) as fd:
            os.write(fd, b"1V\r")
            text = b"*1V1.0000" + OK
            assert read_pty(fd, len(text)) == first.read(len(text)) == second.read(len(text)) == text
            define(first, b"TALK", b'WRITE"FROM TALK"')
            second.read_until(b"STORED\r\n> ")
            read_pty(fd, 5 * 3)
            second.sock.sendall(b"TALK\r")
            heard = second.read(13)
            assert heard == first.read(13) == b"FROM TALK\r\n> "
            assert read_pty(fd, 65536, patience_s=0.2).endswith(heard)

    def test_commands_are_still_put_together_for_each_tap(self, shared_taps: Taps) -> None:
        first, second = shared_taps.first, shared_taps.second
        first.sock.sendall(b"VAR1=1")
        second.sock.sendall(b"1V\r")
        assert first.read_until(OK) == second.read_until(OK) == b"*1V1.0000" + OK
        first.sock.sendall(b"7:VAR1\r")
        assert first.read_until(OK) == second.read_until(OK) == b"\r\n> *VAR1=+17.0" + OK

    def test_a_tap_that_does_not_read_holds_nobody_up(self, shared_taps: Taps) -> None:
        """The second one never reads; the first has each of its answers all the same."""
        for number in range(400):
            shared_taps.first.sock.sendall(b"VAR1=%d:TASF:VAR1\r" % number)
            assert shared_taps.first.read_until(b"VAR1=+%d.0" % number + OK)

"""The virtual serial port: a cable that hosts plug into and out of, over a real pseudo-terminal."""

from __future__ import annotations

import fcntl
import os
import sys
import termios
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from tests.ports.served import Served, opened, read_pty, wait_until

# Meant: Windows has none.
pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="pseudo-terminals are a thing of Unix")
linux_only = pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells who has a pseudo-terminal open")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    options = ("--tcp", "127.0.0.1:0", "--pty", str(tmp_path / "tty"))
    with Served(*options, announce=tmp_path / "announce") as served:
        yield served


@pytest.fixture
def link(served: Served) -> str:
    assert served.pty is not None
    return served.pty


def ask(fd: int, text: bytes) -> bytes:
    os.write(fd, text + b"\r")
    return read_pty(fd, len(text) + 5)


def answer(text: bytes) -> bytes:
    return b"*" + text + b"\r\n> "


def seen(served: Served) -> int:
    """How many lines the controller has executed, asked over TCP."""
    with served.connect() as host:
        host.sock.sendall(b"SEEN\rEND\r")
        return int(host.read_until(b"*END\r\n> ").split(b"\r")[0][1:])


def test_a_host_is_answered_byte_for_byte(link: str) -> None:
    with opened(link) as fd:
        assert ask(fd, b"1TPE") == b"*1TPE\r\n> "


@pytest.mark.parametrize("baud", [300, 9600, 115200])
def test_any_baud_rate_will_do(link: str, baud: int) -> None:
    with serial.Serial(link, baud, timeout=5, exclusive=True) as port:
        port.write(b"1TPE\r")
        assert port.read(9) == b"*1TPE\r\n> "


def test_all_bytes_pass_unchanged_both_ways(link: str) -> None:
    """No echo, no signals, no flow control, no translation: 0x03, 0x11, 0x13, 0x7f and 0xff are data."""
    text = bytes(byte for byte in range(256) if byte not in b"\r\n")
    with opened(link) as fd:
        os.write(fd, text[:90] + b"\r" + text[90:180] + b"\r" + text[180:] + b"\r")
        expected = answer(text[:90]) + answer(text[90:180]) + answer(text[180:])
        assert read_pty(fd, len(expected)) == expected


@linux_only
def test_settings_of_one_host_do_not_reach_the_next(served: Served, link: str) -> None:
    with opened(link) as fd:
        settings = termios.tcgetattr(fd)
        settings[0] |= termios.ICRNL | termios.IXON
        settings[3] |= termios.ECHO | termios.ICANON
        termios.tcsetattr(fd, termios.TCSANOW, settings)
        fcntl.ioctl(fd, termios.TIOCEXCL)
    notice(served)
    with opened(link) as fd:
        assert not termios.tcgetattr(fd)[3] & termios.ECHO
        assert ask(fd, b"A") == answer(b"A")


def notice(served: Served) -> None:
    """Whatever happened to the pseudo-terminal before has reached the engine thread when this returns."""
    seen(served)
    seen(served)


def test_open_close_reopen(link: str) -> None:
    """As fast as a host can: no reply is lost."""
    for _ in range(500):
        with opened(link) as fd:
            assert ask(fd, b"A") == answer(b"A")


@linux_only
def test_the_next_host_sees_nothing_stale(served: Served, link: str) -> None:
    for number in range(100):
        with opened(link) as fd:
            os.write(fd, b"STALE\r" * (number % 7 + 1))
        notice(served)
        with opened(link) as fd:
            assert ask(fd, b"B%d" % number) == answer(b"B%d" % number)


@linux_only
def test_output_while_nobody_has_it_open_is_lost(served: Served, link: str) -> None:
    with served.connect() as host:
        host.sock.sendall(b"WAIT 1\r")
        assert host.read(9) == b"*DONE\r\n> "
    with opened(link) as fd:
        assert ask(fd, b"A") == answer(b"A")


@linux_only
def test_unread_output_does_not_outlive_its_host(served: Served, link: str) -> None:
    """Also when it is more than the kernel's buffer holds."""
    with opened(link) as fd:
        os.write(fd, b"FILL 40000\r")
        wait_until(lambda: seen(served) > 0)
    notice(served)
    with opened(link) as fd:
        assert ask(fd, b"A") == answer(b"A")


def test_a_host_that_never_reads_does_not_stop_its_commands(served: Served, link: str) -> None:
    with opened(link) as fd:
        for _ in range(200):
            os.write(fd, b"FILL 5000\r" * 5)
        wait_until(lambda: seen(served) >= 1000)


def test_commands_of_a_host_that_writes_and_closes_are_executed(served: Served, link: str) -> None:
    with opened(link) as fd:
        os.write(fd, b"A\r" * 100)
    wait_until(lambda: seen(served) >= 100)


@linux_only
def test_half_a_command_of_a_host_that_closed_is_forgotten(served: Served, link: str) -> None:
    for _ in range(20):
        with opened(link) as fd:
            os.write(fd, b"HAL")
        notice(served)
        with opened(link) as fd:
            assert ask(fd, b"F") == answer(b"F")


def test_a_long_reply_to_a_slow_reader_arrives_whole(link: str) -> None:
    with opened(link) as fd:
        os.write(fd, b"FILL 50000\rEND\r")
        assert read_pty(fd, 50_013) == answer(b"x" * 50_000) + answer(b"END")


def test_a_program_listing_in_one_write_is_executed_whole(served: Served, link: str) -> None:
    """64 KiB at once: more than any buffer on the way."""
    with opened(link) as fd:
        data = b"D4000\r" * 10_000
        sent = 0
        while sent < len(data):
            sent += os.write(fd, data[sent : sent + 4096])
            read_pty(fd, 65536, patience_s=0.0)
        wait_until(lambda: seen(served) >= 10_000)


def test_two_hosts_may_have_it_open_and_one_may_leave(link: str) -> None:
    with opened(link) as fd:
        assert ask(fd, b"A") == answer(b"A")
        with opened(link):
            assert ask(fd, b"B") == answer(b"B")
        assert ask(fd, b"C") == answer(b"C")

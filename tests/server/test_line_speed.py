"""`serve --line BAUD` on the wall's clock: the same bytes as without, at the pace of the wire."""

from __future__ import annotations

import os
import time
from pathlib import Path

from tests.ports.served import OEM6250, Served, opened, read_pty

POLLS = 10
QUESTION = b"1TPE\r"
ANSWER = b"1TPE\r\n*1TPE+0\r\r\n> "
SETTLED = b"4.7 OEM6250\r\r\n> "
"""The end of the answer to TREV: a slow line may still be at the sign-on when the host comes."""

LEAST_S = POLLS * (len(QUESTION) + 14) * 10 / 9600
"""Five characters in, fourteen out after the last of them."""


def poll(pty: str) -> tuple[bytes, float]:
    """What a host hears that asks ten times, and how long it takes."""
    with opened(pty) as fd:
        os.write(fd, b"TREV\r")
        heard = b""
        while not heard.endswith(SETTLED):
            byte = read_pty(fd, 1)
            assert byte, heard
            heard += byte
        began = time.monotonic()
        said = b""
        for _ in range(POLLS):
            os.write(fd, QUESTION)
            said += read_pty(fd, len(ANSWER))
        return said, time.monotonic() - began


def serve(folder: Path, *options: str) -> Served:
    places = ("--no-tcp", "--pty", str(folder / "tty"))
    return Served(*places, *options, announce=folder / "announce", command=OEM6250)


def test_a_host_on_a_pty_is_answered_at_the_pace_of_9600_baud(tmp_path: Path) -> None:
    with serve(tmp_path, "--line", "9600") as served:
        assert served.pty is not None
        said, seconds = poll(served.pty)
    assert said == ANSWER * POLLS
    assert LEAST_S <= seconds < 10 * LEAST_S


def test_the_machine_file_can_set_it_and_the_option_can_take_it_back(tmp_path: Path) -> None:
    machine = tmp_path / "slow.toml"
    machine.write_text("[serial]\nbaud = 300\n")
    with serve(tmp_path, str(machine), "--line", "instant") as served:
        assert served.pty is not None
        said, seconds = poll(served.pty)
    assert said == ANSWER * POLLS
    assert seconds < LEAST_S * 9600 / 300


def test_a_tcp_host_that_leaves_at_once_is_carried_out_and_xoff_holds_the_next(tmp_path: Path) -> None:
    options = ("--tcp", "127.0.0.1:0", "--pty", "none", "--line", "9600")
    with Served(*options, announce=tmp_path / "announce", command=OEM6250) as served:
        with served.connect() as host:
            host.sock.sendall(b"VAR1=7\r" * 20)
        with served.connect() as host:
            host.sock.sendall(b"ECHO0\rVAR1\r")
            assert host.read_until(b"> \r\n> *VAR1=+7.0\r\r\n> ".removeprefix(b"> "))
            host.sock.sendall(b"\x13!1TPE\r")
            host.sock.settimeout(0.2)
            try:
                silent = host.sock.recv(1) == b""
            except TimeoutError:
                silent = True
            assert silent
            host.sock.settimeout(20)
            assert host.ask(b"\x11", 12) == b"*1TPE+0\r\r\n> "

"""The command-line contract, on a server process: what it announces, how it ends, what it refuses."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.ports.served import REPOSITORY, TOY, Host, Served, opened, read_pty, wait_until


def run(*arguments: str, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """The toy server with options that make it end by itself."""
    return subprocess.run(
        [*TOY, *arguments],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=20,
        env={**os.environ, **(environment or {})},
        check=False,
    )


def refused(result: subprocess.CompletedProcess[str]) -> str:
    """The one line of a refusal."""
    assert result.returncode == 2
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.startswith("oem6250: ")
    return result.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_cleanly_within_a_second(tmp_path: Path, number: int) -> None:
    options = ("--tcp", "127.0.0.1:0", "--pty", str(tmp_path / "tty"))
    with Served(*options, announce=tmp_path / "announce") as served:
        with served.connect() as host, opened(str(tmp_path / "tty")):
            host.ask(b"HOLD 60000\rA\r", 6)
            status, seconds, errors = served.stop(number)
            assert host.read_to_end() == b""
        assert (status, errors) == (0, "")
        assert seconds < 1.0
        assert not (tmp_path / "tty").is_symlink()
        with pytest.raises(ConnectionRefusedError):
            served.connect()


def test_a_signal_is_obeyed_while_clients_flood_it(tmp_path: Path) -> None:
    with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=tmp_path / "announce") as served:
        with served.connect() as host:
            host.sock.settimeout(0.2)
            with pytest.raises(TimeoutError):
                host.sock.sendall(b"A\r" * 50_000_000)
            status, seconds, _ = served.stop()
        assert status == 0
        assert seconds < 1.0


def test_a_person_is_told_where_to_connect_and_what_to_type(tmp_path: Path) -> None:
    arguments = [*TOY, "serve", "--tcp", "127.0.0.1:0", "--pty", str(tmp_path / "tty")]
    with subprocess.Popen(arguments, cwd=REPOSITORY, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        up, serial_port, tcp, typing = (process.stderr.readline() for _ in range(4))
        process.terminate()
    assert "Ctrl-C" in up
    assert str(tmp_path / "tty") in serial_port
    assert "telnet -- 127.0.0.1 -" in tcp
    assert "DRIVE11" in typing


def test_announcement_in_a_file(tmp_path: Path) -> None:
    options = ("--tcp", "127.0.0.1:0", "--tcp", "[::1]:0", "--pty", str(tmp_path / "tty"))
    with Served(*options, announce=tmp_path / "announce") as served:
        told = served.announced
        assert list(told) == ["tcp", "pty", "pid", "speed"]
        assert [address.rpartition(":")[0] for address in told["tcp"]] == ["127.0.0.1", "[::1]"]
        assert told["pty"] == str(tmp_path / "tty")
        assert told["pid"] == served.process.pid
        assert told["speed"] == 1.0
        port = int(told["tcp"][1].rpartition(":")[2])
        with socket.create_connection(("::1", port), timeout=5) as sock:
            sock.sendall(b"A\r")
            assert sock.recv(6) == b"*A\r\n> "


def test_announcement_on_stdout_and_nothing_else() -> None:
    arguments = [*TOY, "serve", "--no-tcp", "--pty", "none", "--announce", "-", "--speed", "max"]
    with subprocess.Popen(arguments, cwd=REPOSITORY, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        process.terminate()
        assert process.stdout.read() == ""
    assert told == {"tcp": [], "pty": None, "pid": process.pid, "speed": "max"}
    assert process.returncode == 0


def test_the_automatic_link_is_in_the_runtime_directory_and_two_servers_share_it(tmp_path: Path) -> None:
    os.environ["XDG_RUNTIME_DIR"], before = str(tmp_path), os.environ.get("XDG_RUNTIME_DIR")
    try:
        with (
            Served("--no-tcp", announce=tmp_path / "a") as first,
            Served("--no-tcp", announce=tmp_path / "b") as second,
        ):
            assert first.pty == str(tmp_path / "oem6250" / "tty0")
            assert second.pty == str(tmp_path / "oem6250" / "tty1")
            first.process.kill()
            first.process.wait()
            with Served("--no-tcp", announce=tmp_path / "c") as third:
                assert third.pty == first.pty
    finally:
        del os.environ["XDG_RUNTIME_DIR"]
        if before is not None:
            os.environ["XDG_RUNTIME_DIR"] = before


def test_a_port_in_use_is_refused(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = run("serve", "--tcp", f"127.0.0.1:{port}", "--pty", str(tmp_path / "tty"))
    assert "in use" in refused(result)
    assert not (tmp_path / "tty").is_symlink()


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--tcp", "127.0.0.1"], "HOST:PORT"),
        (["--tcp", "127.0.0.1:65536"], "HOST:PORT"),
        (["--tcp", "::1:6250"], "HOST:PORT"),
        (["--tcp", "no.such.host.invalid:0", "--pty", "none"], "no such address"),
        (["--tcp", "127.0.0.1:0", "--no-tcp"], "--no-tcp"),
        (["--speed", "0"], "positive"),
        (["--speed", "-1"], "positive"),
        (["--speed", "nan"], "positive"),
        (["--speed", "fast"], "positive"),
        (["--line", "9"], "baud"),
        (["--line", "slow"], "baud"),
        (["--no-tcp", "--pty", "/no/such/directory/tty"], "cannot make the link"),
        (["--no-tcp", "--pty", "/"], "not a link"),
        (["--no-tcp", "--pty", "none", "--announce", "/no/such/directory/file"], "cannot be written"),
        (["--nonsense"], "--nonsense"),
        (["one.toml", "two.toml"], "two.toml"),
    ],
)
def test_mistakes_are_one_line_and_status_2(arguments: list[str], word: str) -> None:
    assert word in refused(run("serve", *arguments))


def test_an_unknown_command_is_a_mistake() -> None:
    assert "sevre" in refused(run("sevre"))


@pytest.mark.parametrize(("arguments", "text"), [([], "usage: oem6250"), (["--help"], "usage: oem6250")])
def test_no_command_is_help(arguments: list[str], text: str) -> None:
    result = run(*arguments)
    assert result.returncode == 0
    assert result.stdout.startswith(text)


def test_version() -> None:
    from emulator import __version__

    assert run("--version").stdout == f"oem6250 {__version__}\n"


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from emulator.cli import main\n"
        "try: main(['serve', '--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'numba', 'llvmlite', 'msgspec', 'asyncio', 'serial'} & set(sys.modules)\n"
        "sys.exit(str(heavy) if heavy else 0)"
    )
    result = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


def test_traffic_is_logged_in_readable_form_when_asked_for(tmp_path: Path) -> None:
    options = ("--tcp", "127.0.0.1:0", "--pty", "none", "-v")
    with Served(*options, announce=tmp_path / "announce") as served:
        with served.connect() as host:
            host.ask(b"1TPE\r", 9)
        _, _, errors = served.stop()
    lines = errors.splitlines()
    assert any('event="received"' in line and r'data="1TPE\r"' in line and "at_s=" in line for line in lines)
    assert any('event="sent"' in line and r'data="*1TPE\r\n> "' in line and "channel=0" in line for line in lines)
    assert any('event="stopped"' in line and "p99_ns=" in line for line in lines)


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGSTOP")
def test_no_virtual_time_is_lost_while_the_process_is_stopped(tmp_path: Path) -> None:
    options = ("--tcp", "127.0.0.1:0", "--pty", "none")
    with Served(*options, announce=tmp_path / "announce") as served, served.connect() as host:
        before_ns = virtual_ns(host)
        began_ns = time.monotonic_ns()
        served.process.send_signal(signal.SIGSTOP)
        wait_until(lambda: time.monotonic_ns() - began_ns > 400_000_000)
        served.process.send_signal(signal.SIGCONT)
        wait_until(lambda: virtual_ns(host) - before_ns >= time.monotonic_ns() - began_ns - 5_000_000)


def virtual_ns(host: Host) -> int:
    host.sock.sendall(b"TIME\r")
    return int(host.read_until(b"> ")[1:-4])


def test_max_runs_a_dwell_in_no_time_and_is_idle_at_real_time(tmp_path: Path) -> None:
    options = ("--tcp", "127.0.0.1:0", "--pty", "none", "--speed", "max")
    with Served(*options, announce=tmp_path / "announce") as served, served.connect() as host:
        began = time.monotonic()
        assert host.ask(b"HOLD 3600000\r", 9) == b"*HELD\r\n> "
        assert time.monotonic() - began < 5.0
        began_ns = time.monotonic_ns()
        first_ns = virtual_ns(host)
        wait_until(lambda: time.monotonic_ns() - began_ns > 50_000_000)
        assert virtual_ns(host) - first_ns <= time.monotonic_ns() - began_ns


def test_the_pty_hears_the_controller_by_itself(tmp_path: Path) -> None:
    options = ("--no-tcp", "--pty", str(tmp_path / "tty"))
    with Served(*options, announce=tmp_path / "announce"), opened(str(tmp_path / "tty")) as fd:
        os.write(fd, b"WAIT 5\r")
        assert read_pty(fd, 9) == b"*DONE\r\n> "

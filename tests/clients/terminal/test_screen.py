"""The terminal as a person has it: a pseudo-terminal, a real emulator behind a port, nothing imitated."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from clients.testing import Served
from tests.ports.served import OEM6250 as COMMAND
from tests.ports.served import Served as ServedProcess

# Meant: Windows has no pseudo-terminals, and the library is to be tested there too.
pytestmark = pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")

if hasattr(os, "openpty"):
    from tests.clients.terminal.screen import REPOSITORY, Screen


@pytest.fixture
def server() -> Iterator[Served]:
    with Served() as server:
        yield server


@pytest.fixture
def history(tmp_path: Path) -> Path:
    return tmp_path / "state" / "history"


def test_a_session_over_the_serial_port(server: Served, history: Path) -> None:
    with Screen(server.port, history=history) as screen:
        assert "ERRLVL4, ECHO1" in screen.wait_for("the unit has")
        assert "axis 2: 13 Drive Shutdown; 24 In Target Zone" in screen.enter("TAS", "axis 2:")
        told = screen.enter("1V99999", "0.0 to 200.0")
        assert "*INVALID DATA" in told
        screen.enter("V5:1TPE", "*1TPE+0")
        screen.type("!tre")
        screen.wait_for("Report firmware revision")
        screen.type("\t")
        screen.wait_for("!TREV")
        screen.enter("", "*TREV")
        screen.enter("/decode all", "> ")
        screen.enter("TSS", " 1 1 System Ready")
        screen.type("/quit\r")
        assert screen.ended() == 0
    assert "+1V99999" in history.read_text()


def test_lines_of_an_earlier_session_come_back(server: Served, history: Path) -> None:
    history.parent.mkdir()
    history.write_text("\n# then\n+TREV\n")
    with Screen(server.tcp_url, history=history) as screen:
        screen.wait_for("the unit has")
        screen.type("\x1b[A\r")
        screen.wait_for("OEM6250")
        screen.type("\x04")
        assert screen.ended() == 0


def test_ctrl_c_kills_a_move_that_the_unit_does_not_answer_for(history: Path) -> None:
    with Served(speed=1) as server, Screen(server.tcp_url, history=history) as screen:
        screen.wait_for("the unit has")
        screen.enter("DRIVE11:MC1:V1:1GO", "1GO")
        server.run_until(lambda: bool(server.signals["axis1.moving"]))
        screen.type("half a li\x03")
        screen.wait_for("!K sent")
        server.run_until(lambda: not server.signals["axis1.moving"])
        assert "half" not in "".join(server.traffic.lines())


def test_what_a_program_writes_does_not_break_the_line_that_is_being_typed(server: Served, history: Path) -> None:
    with Screen(server.tcp_url, history=history) as screen:
        screen.wait_for("the unit has")
        for line in ("DEF TALK", "L3", 'WRITE"PART\\13"', "T.2", "LN"):
            screen.enter(line, "\n-")
        screen.enter("END", "\n>")
        screen.type("!RUN TALK\r!1TP")
        for _ in range(3):
            screen.wait_for("PART")
        screen.enter("E", "*1TPE+0")
        assert screen.shown.splitlines().count("PART") == 3


@pytest.mark.parametrize("kind", ["socket", "rfc2217"])
def test_any_port_the_client_knows(server: Served, history: Path, kind: str) -> None:
    host, port = server.address
    with Screen(f"{kind}://{host}:{port}", history=history) as screen:
        screen.wait_for("the unit has")
        screen.enter("TREV", "OEM6250")


def test_a_port_that_comes_back(tmp_path: Path, history: Path) -> None:
    options = ("--no-tcp", "--pty", str(tmp_path / "tty"))
    with ServedProcess(*options, announce=tmp_path / "first", command=COMMAND):
        screen = Screen(str(tmp_path / "tty"), history=history, program=("-m", "emulator", "terminal"))
        screen.wait_for("the unit has")
    with screen:
        screen.wait_for("waiting for the port to come back")
        screen.enter("TREV", "not connected")
        screen.type("\x03")
        screen.wait_for("!K NOT sent")
        with ServedProcess(*options, announce=tmp_path / "second", command=COMMAND):
            screen.wait_for("the unit has ERRLVL4")
            screen.enter("TREV", "*TREV")


def test_a_transfer_can_be_stopped(tmp_path: Path, history: Path) -> None:
    program = tmp_path / "long.prg"
    program.write_text("DEF LONG\n" + "D1000\n" * 1500 + "END\n")
    with Served(speed=1, machine="[serial]\nbaud = 9600\n") as server, Screen(server.port, history=history) as screen:
        screen.wait_for("the unit has")
        screen.type(f"/download {program}\r")
        screen.wait_for("of 1500 commands")
        screen.enter("TREV", "a transfer is under way")
        screen.type("\x03")
        screen.wait_for("stopped; LONG is deleted")
        screen.enter("TDIR", "NO PROGRAMS DEFINED")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["tcp://127.0.0.1:1"], "cannot open tcp://127.0.0.1:1: "),
        (["tcp://nowhere"], "'tcp://nowhere' is not tcp://host:port"),
        (["/dev/no-such-port"], "cannot open /dev/no-such-port"),
        (["x", "--baud", "fast"], "'fast' is not a baud rate"),
        (["x", "--address", "100"], "'100' is not a unit address"),
    ],
)
def test_what_cannot_be_opened_is_one_line_and_status_2(history: Path, arguments: list[str], said: str) -> None:
    with Screen(*arguments, history=history) as screen:
        assert screen.ended() == 2
        assert said in screen.shown
        assert len(screen.shown.strip().splitlines()) == 1


def test_without_a_screen_or_without_the_extra_it_says_what_is_missing(history: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "clients", "x"], input="", capture_output=True, text=True, cwd=REPOSITORY, check=False
    )
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert "needs a terminal" in done.stderr
    hiding = "import sys; sys.modules['prompt_toolkit'] = None; import clients.__main__"
    with Screen("x", history=history, program=("-c", hiding)) as screen:
        assert screen.ended() == 2
        assert screen.shown.strip().endswith("the terminal needs prompt_toolkit: pip install 'oem6250[terminal]'")


def test_the_terminal_never_imports_the_emulator() -> None:
    code = (
        "import sys, clients.terminal.console, clients.terminal.command; "
        "print([m for m in sys.modules if m.split('.')[0] in ('emulator', 'numpy', 'numba')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=REPOSITORY, check=True)
    assert done.stdout.strip() == "[]"

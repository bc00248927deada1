"""A shell in a folder, in which `oem6250` is this program; a server it starts goes on beside it, and is ended later.

A block that serves goes on once the server is ready, as a reader does in a second terminal.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Final

import psutil

from tests.docs.blocks import REPOSITORY
from tests.ports.served import wait_until

PATIENCE_S: Final = 60.0
_PROGRAM: Final = """\
#!{python}
import os, pathlib, subprocess, sys, time
command = [sys.executable, "-m", "emulator", *sys.argv[1:]]
if sys.argv[1:2] != ["serve"]:
    os.execv(sys.executable, command)
folder = pathlib.Path({folder!r})
ready = folder / f"ready-{{os.getpid()}}"
options = ["--announce", str(ready)]
other_device = "--device" in sys.argv
if not other_device and not any(option.startswith(("--tcp", "--no-tcp")) for option in sys.argv):
    options += ["--tcp", "127.0.0.1:{port}"]
if not other_device and "--pty" not in sys.argv:
    options += ["--pty", "none"]
with open(folder / "log", "ab") as log:
    server = subprocess.Popen([*command, *options], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
with open(folder / "servers", "a") as servers:
    print(server.pid, file=servers)
while not ready.exists() and server.poll() is None:
    time.sleep(0.01)
sys.exit(server.poll() or 0)
"""


class Shell:
    """Runs commands in `folder`; a context manager that ends the servers they have started."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._own = folder / ".shell"
        self._port = _free_port()

    def __enter__(self) -> Shell:
        (self._own / "bin").mkdir(parents=True)
        program = self._own / "bin" / "oem6250"
        program.write_text(_PROGRAM.format(python=sys.executable, folder=str(self._own), port=self._port))
        program.chmod(0o755)
        for name in ("python", "python3"):
            (self._own / "bin" / name).symlink_to(sys.executable)
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        servers = self._own / "servers"
        for pid in servers.read_text().split() if servers.exists() else ():
            _end(int(pid))

    def run_script(self, text: str) -> str:
        """Run lines of a shell script; AssertionError unless all succeed. What it printed."""
        status, printed = self._run("set -eu\n" + text)
        assert status == 0, f"ended with {status}: {printed}{self._log()}"
        return printed

    def run_command(self, command: str) -> tuple[int, str]:
        """Run one command; its exit status and what it printed."""
        return self._run(command)

    def _run(self, text: str) -> tuple[int, str]:
        environment = {
            **os.environ,
            "PATH": f"{self._own / 'bin'}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(REPOSITORY),
        }
        output = self._own / "output"
        with output.open("w+") as file:
            status = subprocess.call(
                ["bash", "-c", self._placed(text)],
                cwd=self._folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                timeout=PATIENCE_S,
            )
        return status, output.read_text()

    def _placed(self, text: str) -> str:
        """The text with a free port for the usual ones, and this folder for /tmp."""
        return re.sub(r"\b(6250|1502)\b", str(self._port), text).replace("/tmp/", f"{self._folder}/")

    def _log(self) -> str:
        log = self._own / "log"
        return log.read_text() if log.exists() else ""


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def _end(pid: int) -> None:
    """End a server; it is no child of ours, so somebody else collects its status, or nobody."""
    with contextlib.suppress(psutil.NoSuchProcess):
        process = psutil.Process(pid)
        process.send_signal(signal.SIGTERM)
        wait_until(lambda: not process.is_running() or process.status() == psutil.STATUS_ZOMBIE)

"""The processes of a benchmark: servers that announce themselves, and the load generator."""

from __future__ import annotations

import json
import os
import selectors
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import psutil

from tests.bench.load import PATIENCE_S, PROMPT, Hammering, connect, receive

REPOSITORY = Path(__file__).resolve().parents[2]
START_PATIENCE_S = 120.0
"""A cold start compiles the servo kernel."""
SERVE = ("serve", "--tcp", "127.0.0.1:0", "--pty", "none", "--announce", "-")
BYTES_PER_MB = 1_000_000


class Server:
    """A child process that announces on stdout where it listens. A context manager."""

    def __init__(self, *arguments: str, environment: Mapping[str, str] | None = None) -> None:
        self.began_s = time.perf_counter()
        self.process = subprocess.Popen(
            [sys.executable, *arguments],
            cwd=REPOSITORY,
            env={**os.environ, **(environment or {})},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        line = _read_line(self.process)
        if not line:
            raise RuntimeError(f"{' '.join(arguments)} ended: {self.process.communicate()[1]}")
        told = json.loads(line)
        host, _, port = told["tcp"][0].rpartition(":")
        self.pty: str | None = told.get("pty")
        self.address: tuple[str, int] = (host, int(port))
        self._statistics = psutil.Process(self.process.pid)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        told = self.stop()
        if value is not None and told:
            print(told, file=sys.stderr)

    def stop(self) -> str:
        """End it; what it wrote to stderr."""
        if self.process.poll() is None:
            self.process.terminate()
        try:
            return self.process.communicate(timeout=PATIENCE_S)[1]
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.communicate()[1]
        except ValueError:
            return ""

    @property
    def resident_mb(self) -> float:
        return int(self._statistics.memory_info().rss) / BYTES_PER_MB

    @property
    def cpu_s(self) -> float:
        """Processor time used so far."""
        times = self._statistics.cpu_times()
        return float(times.user + times.system)

    def tell(self, commands: bytes) -> list[bytes]:
        """Commands from a connection of their own; the answers without their prompts, once all are given."""
        wanted = commands.count(b"\r")
        with connect(self.address) as sock:
            sock.sendall(commands)
            data = b""
            while data.count(PROMPT) < wanted:
                data += receive(sock)
        return data.split(PROMPT)[:-1]


def oem6250(*options: str, environment: Mapping[str, str] | None = None) -> Server:
    """The emulator on a free port."""
    return Server("-m", "emulator", *SERVE, *options, environment=environment)


def echo() -> Server:
    """The bare asyncio echo."""
    return Server("-m", "tests.bench.echo")


class Load:
    """The load generator. A context manager."""

    def __enter__(self) -> Self:
        arguments = [sys.executable, "-m", "tests.bench.load"]
        self._process = subprocess.Popen(
            arguments, cwd=REPOSITORY, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, tb: TracebackType | None) -> None:
        self._process.kill()
        self._process.communicate()

    def hammer(
        self,
        server: Server,
        question: bytes,
        answer_bytes: int,
        *,
        clients: int,
        seconds: float,
        depth: int = 1,
        opening: bytes = b"",
        path: str | None = None,
    ) -> Hammering:
        """Ask a server as fast as it answers; see `tests.bench.load.hammer`."""
        result: Hammering = self._do(
            job="hammer",
            address=path or server.address,
            opening=opening.decode("latin-1"),
            question=question.decode("latin-1"),
            answer_bytes=answer_bytes,
            clients=clients,
            depth=depth,
            seconds=seconds,
        )
        return result

    def poll(
        self, server: Server, question: bytes, *, seconds: float, interval_s: float = 0.0
    ) -> Sequence[tuple[int, int, str]]:
        """Ask a server steadily; see `tests.bench.load.poll`."""
        result: Sequence[tuple[int, int, str]] = self._do(
            job="poll",
            address=server.address,
            question=question.decode("latin-1"),
            seconds=seconds,
            interval_s=interval_s,
        )
        return result

    def _do(self, **job: object) -> Any:
        assert self._process.stdin is not None and self._process.stdout is not None
        print(json.dumps(job), file=self._process.stdin, flush=True)
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError(f"the load generator failed at {job}")
        return json.loads(line)


def run_time_s(*arguments: str, patience_s: float = PATIENCE_S) -> float:
    """Seconds from starting a Python process to its successful end."""
    began_s = time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments], cwd=REPOSITORY, check=True, stdout=subprocess.DEVNULL, timeout=patience_s
    )
    return time.perf_counter() - began_s


def _read_line(process: subprocess.Popen[str]) -> str:
    """The first line of a process's stdout; empty if it ended, RuntimeError if it keeps silent."""
    assert process.stdout is not None
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        if not selector.select(START_PATIENCE_S):
            process.kill()
            raise RuntimeError(f"{process.args!r} said nothing for {START_PATIENCE_S:.0f} s")
    return process.stdout.readline()

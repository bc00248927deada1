"""Hosts behind real ports: time moves only while they wait, at a speed, or as the test says."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Iterator

import pytest
import serial

from clients.testing import NotReached, Served, served
from clients.testing.errors import NotPossible
from clients.testing.process import ServedProcess
from emulator.host_paced import CHARACTER_NS, HostPacedClock, TimetabledUnit
from emulator.recording import replay
from tests.ports.toy import ToyController

# Meant: the server here is reached over a pseudo-terminal, which Windows lacks.
pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs pseudo-terminals")
MS = 1_000_000
MOVE = b"D120000:GO1\r"
MOVE_S = 30.1
"""30 revolutions at 1 rev/s, A10."""


@pytest.fixture(scope="module")
def server() -> Iterator[Served]:
    with served("[defaults]\nECHO = 0\nDRIVE = '11'\n") as one:
        yield one


class Host:
    """A host program with a serial port; prompts are what it knows."""

    def __init__(self, port: str) -> None:
        self.port = serial.Serial(port, 9600, timeout=10)
        self.ask(b"COMEXC0:A10:V1:PSET0\r", prompts=4)

    def ask(self, line: bytes, *, prompts: int = 1) -> bytes:
        self.port.write(line)
        answer = b"".join(self.port.read_until(b"> ") for _ in range(prompts))
        assert answer.endswith(b"> "), answer
        return answer

    def moving(self) -> bool:
        return b"*1" in self.ask(b"!1TAS.1\r")


@pytest.fixture
def host(server: Served) -> Iterator[Host]:
    one = Host(server.port)
    yield one
    one.port.close()


class Stopwatch:
    def __init__(self, server: Served) -> None:
        self._server = server
        self._began = time.monotonic(), server.time_s

    @property
    def wall_s(self) -> float:
        return time.monotonic() - self._began[0]

    @property
    def virtual_s(self) -> float:
        return self._server.time_s - self._began[1]


class TestWaitingHosts:
    def test_a_blocking_read(self, server: Served, host: Host) -> None:
        watch = Stopwatch(server)
        host.ask(MOVE, prompts=2)
        assert watch.virtual_s == pytest.approx(MOVE_S, abs=0.2)
        assert watch.wall_s < 5.0

    def test_polling_with_sleep(self, server: Served, host: Host) -> None:
        watch = Stopwatch(server)
        host.ask(b"COMEXC1:" + MOVE, prompts=3)
        while host.moving():
            time.sleep(0.05)  # what is tested: hosts that poll with a sleep on the wall clock
        assert watch.virtual_s >= MOVE_S
        assert watch.wall_s < 5.0

    def test_polling_without_a_pause(self, server: Served, host: Host) -> None:
        """Each poll and its answer take the time of their characters."""
        watch, polls = Stopwatch(server), 0
        host.ask(b"COMEXC1:D8000:GO1\r", prompts=3)
        while host.moving():
            polls += 1
        assert 2.0 < watch.virtual_s < 6.0
        assert polls > 10

    def test_virtual_sleep(self, server: Served, host: Host) -> None:
        """The host's own clockwork keeps its proportions: as many polls as on a real machine."""
        watch, polls = Stopwatch(server), 0
        with server.virtual_sleep(), server.working():
            host.ask(b"COMEXC1:" + MOVE, prompts=3)
            while host.moving():
                polls += 1
                time.sleep(0.25)  # virtual here: what is tested
        assert watch.virtual_s == pytest.approx(MOVE_S, abs=0.6)
        assert polls == pytest.approx(MOVE_S / 0.265, rel=0.1)
        assert watch.wall_s < 10.0
        assert time.sleep.__module__ == "time"

    def test_the_host_says_that_it_works(self, server: Served, host: Host) -> None:
        with server.working():
            host.ask(b"COMEXC1:" + MOVE, prompts=3)
            began_s = server.time_s
            threading.Event().wait(0.05)
            assert server.time_s == began_s
            server.advance(1.0)
            assert server.time_s == pytest.approx(began_s + 1.0, abs=1e-6)
            assert host.moving()
        server.settle()

    def test_the_host_says_that_it_waits(self, server: Served, host: Host) -> None:
        with server.waiting():
            watch = Stopwatch(server)
            host.ask(MOVE, prompts=2)
            assert watch.virtual_s >= MOVE_S

    def test_run_until(self, server: Served, host: Host) -> None:
        with server.working():
            host.ask(b"COMEXC1:" + MOVE, prompts=3)
            server.run_until(lambda: int(server.signals["axis1.position.encoder"]) > 20000)
            assert 20000 < int(server.signals["axis1.position.encoder"]) < 20500
            with pytest.raises(NotReached):
                server.run_until(lambda: False, timeout_s=0.05)
        server.settle()


class TestFaultsBehindPorts:
    def test_in_a_move(self, server: Served, host: Host) -> None:
        fault = server.faults.limit_open(axis=1).at(server.time_s + 5.0, lasting_s=1000.0)
        host.ask(MOVE, prompts=2)
        assert fault.fired
        assert int(server.signals["axis1.position.encoder"]) == pytest.approx(5 * 4000, rel=0.1)
        fault.lift()
        assert not fault.in_force and server.inputs["axis1.positive_limit"]
        with server.faults.unit_silent() as silent:
            host.port.timeout = 0.1
            host.port.write(b"TREV\r")
            assert host.port.read(1) == b""
        silent.assert_fired()

    def test_the_recording_replays(self, server: Served, host: Host, tmp_path: object) -> None:
        from pathlib import Path

        asked = 5
        for _ in range(asked):
            with server.faults.limit_open(axis=1):
                host.ask(b"TLIM\r", prompts=1)
        path = Path(str(tmp_path)) / "session.rec"
        path.write_bytes(server.recording())
        outcome = replay(path)
        assert outcome.difference is None and outcome.inputs >= asked


class TestSpeeds:
    def test_a_factor(self) -> None:
        with served(speed=100) as server:
            watch = Stopwatch(server)
            threading.Event().wait(0.1)
            assert watch.virtual_s == pytest.approx(100 * watch.wall_s, rel=0.5)
            with pytest.raises(NotPossible, match="speed 100"), server.waiting():
                pass
            watch = Stopwatch(server)
            server.advance(50.0)
            assert watch.virtual_s >= 50.0

    def test_a_chain(self) -> None:
        with served("[defaults]\nERRLVL = 1\n", chain=2) as server:
            assert len(server.units) == 2
            server.units[1].faults.limit_open(axis=2).apply()
            assert server.units[0].inputs["axis2.positive_limit"] and not server.units[1].inputs["axis2.positive_limit"]

    def test_a_process(self) -> None:
        with ServedProcess("[defaults]\nECHO = 0\n") as server:
            host = Host(server.port)
            assert host.ask(b"1TPE\r").startswith(b"*1TPE")
            host.port.close()
            assert server.address[1] > 0
            with pytest.raises(AttributeError, match="process=True"):
                server.faults  # noqa: B018


class Wall:
    ns = 0

    def __call__(self) -> int:
        return self.ns


class TestRules:
    """The clock by itself, on a wall clock that the test turns."""

    def setup_method(self) -> None:
        self.wall = Wall()
        self.clock = HostPacedClock(quiet_ns=5 * MS, wall=self.wall)

    def tick(self, *, busy: bool, after_ms: float = 0.0) -> int:
        self.wall.ns += round(after_ms * MS)
        at_ns = self.clock.tick_ns()
        self.clock.ran_to(at_ns, busy=busy)
        return at_ns

    def test_it_stands_while_the_host_computes(self) -> None:
        self.clock.exchanged(0, 0)
        for _ in range(4):
            assert self.tick(busy=True, after_ms=1.0) == 0

    def test_it_runs_freely_after_the_quiet_time(self) -> None:
        self.tick(busy=True)
        reached = [self.tick(busy=True, after_ms=2.0) for _ in range(5)]
        assert reached[0] == reached[1] == 0 and reached[2] > 50 * MS and self.clock.free_running
        self.clock.exchanged(self.clock.reached_ns, 1)
        self.tick(busy=True)
        assert not self.clock.free_running, "somebody has said something"

    def test_it_keeps_to_the_wall_while_nothing_is_under_way(self) -> None:
        self.tick(busy=False, after_ms=10.0)
        before = self.clock.reached_ns
        assert self.tick(busy=False, after_ms=3.0) - before == 3 * MS

    def test_characters_take_their_time(self) -> None:
        self.clock.exchanged(0, 5)
        self.clock.exchanged(0, 14)
        assert self.clock.input_ns() == 19 * CHARACTER_NS
        assert self.clock.input_ns() == 0, "owed once"

    def test_skip(self) -> None:
        self.clock.declare_working(+1)
        self.clock.skip(250 * MS)
        self.clock.skip(50 * MS)
        assert self.clock.behind and not self.clock.stops_at_output
        while self.clock.behind:
            self.tick(busy=False)
        assert self.clock.reached_ns == 300 * MS

    def test_a_unit_that_says_something_stops_it(self) -> None:
        toy = ToyController()
        unit = TimetabledUnit(toy, self.clock)
        unit.receive(b"WAIT 500\r", at_ns=0, channel=0)
        unit.take_output()
        self.clock.declare_waiting(+1)
        self.tick(busy=True)
        while not (said := unit.take_output()):
            at_ns = self.clock.tick_ns()
            unit.advance(at_ns)
            self.clock.ran_to(at_ns, busy=unit.busy)
        assert said[0].at_ns == 500 * MS
        assert 500 * MS <= unit.now_ns == self.clock.reached_ns <= 510 * MS

    def test_the_agenda_is_kept_to_the_nanosecond(self) -> None:
        unit = TimetabledUnit(ToyController())
        seen: list[int] = []
        for at_ns in (300, 100, 200, 100):
            unit.at(at_ns, lambda: seen.append(unit.now_ns))
        unit.advance(150)
        assert seen == [100, 100]
        unit.receive(b"", at_ns=250, channel=0)
        unit.advance(1000)
        assert seen == [100, 100, 200, 300]


def test_a_host_that_connects_does_not_meet_the_sign_on() -> None:
    """However soon it does: a unit says so at power-up, which was before."""
    for _ in range(10):
        with Served() as server, socket.create_connection(server.address, timeout=5) as host:
            host.sendall(b"1TPE\r")
            answer = b""
            while not answer.endswith(b"> "):
                answer += host.recv(100)
            assert answer.startswith(b"1TPE")

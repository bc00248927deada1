"""The engine thread with toy controllers: order, fairness, faults, calls, and the end."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from functools import partial

import pytest

from emulator.channel import TURN_BYTES, Channel, Item
from emulator.clock import Clock
from emulator.pacing import FAILURES_TO_RETIRE, MAX_LINGERING, EngineThread
from tests.ports.served import wait_until
from tests.ports.toy import Boom, ToyController

PATIENCE_S = 10.0


class Ear:
    """A wire that only listens, and remembers on which thread it was called."""

    descriptors: tuple[int, ...] = ()

    def __init__(self) -> None:
        self.heard = b""
        self.threads: set[str] = set()

    def send(self, data: bytes) -> None:
        self.heard += data
        self.threads.add(threading.current_thread().name)

    def arrived(self, channel: Channel) -> None:
        raise AssertionError("nothing to read here")


class Pipe(Ear):
    """A wire that always has something to read, until its portions are used up."""

    def __init__(self, portions: list[bytes]) -> None:
        super().__init__()
        self.portions = portions
        self.most_waiting = 0
        self._ours, self._theirs = socket.socketpair()
        self.descriptors = (self._ours.fileno(),)
        self.knock()

    def knock(self) -> None:
        self._theirs.send(b"!")

    def arrived(self, channel: Channel) -> None:
        self.most_waiting = max(self.most_waiting, len(channel.waiting))
        if self.portions:
            channel.waiting.append(self.portions.pop(0))
        else:
            self._ours.recv(1)

    def close(self, bench: Bench, channel: Channel) -> None:
        """Detach, as a port must, before closing."""
        done = threading.Event()
        bench.engine.drop(channel, done.set)
        assert done.wait(PATIENCE_S)
        self._ours.close()
        self._theirs.close()


class Bench:
    """Two toys on one engine thread."""

    def __init__(self, speed: float | None = 1.0) -> None:
        self.toys = [ToyController(), ToyController()]
        self.engine = EngineThread(self.toys, Clock(speed))
        self.ears = [Ear(), Ear()]
        self.channels = [self.engine.attach(index, ear) for index, ear in enumerate(self.ears)]

    def put(self, index: int, item: Item) -> None:
        self.engine.put(self.channels[index], item)

    def settle(self) -> None:
        """All that was put before is done: each channel answers a function put last."""
        for channel in self.channels:
            done = threading.Event()
            self.engine.put(channel, done.set)
            assert done.wait(PATIENCE_S)


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    bench.engine.start()
    yield bench
    assert bench.engine.stop(PATIENCE_S)


def test_replies_go_to_the_unit_that_was_asked_on_the_engine_thread(bench: Bench) -> None:
    bench.put(0, b"A\r")
    bench.put(1, b"B\r")
    bench.settle()
    assert [ear.heard for ear in bench.ears] == [b"*A\r\n> ", b"*B\r\n> "]
    assert bench.ears[0].threads == {"engine"}


def test_replies_go_to_the_channel_whose_bytes_caused_them(bench: Bench) -> None:
    ear = Ear()
    bench.engine.put(bench.engine.attach(0, ear), b"C\r")
    bench.put(0, b"A\r")
    wait_until(lambda: bool(ear.heard and bench.ears[0].heard))
    assert (ear.heard, bench.ears[0].heard) == (b"*C\r\n> ", b"*A\r\n> ")


def test_input_takes_effect_now_and_not_at_the_last_tick(bench: Bench) -> None:
    for _ in range(50):
        before_ns = bench.engine.clock.now_ns()
        bench.put(0, b"TIME\r")
        bench.settle()
        after_ns = bench.engine.clock.now_ns()
        assert before_ns <= bench.toys[0].received[-1][0] <= after_ns


def test_output_comes_by_itself_when_it_is_due(bench: Bench) -> None:
    bench.put(0, b"WAIT 20\r")
    wait_until(lambda: bench.ears[0].heard == b"*DONE\r\n> ")
    assert bench.ears[1].heard == b"", "another unit has other hosts"


def test_a_busy_channel_yields_to_the_others(bench: Bench) -> None:
    """The flood is put first; the other's question is answered after a few commands of it, not at its end."""
    order: list[str] = []
    gate, entered = threading.Event(), threading.Event()
    bench.put(0, lambda: (entered.set(), gate.wait(PATIENCE_S), None)[-1])
    assert entered.wait(PATIENCE_S)
    bench.put(0, b"A\r" * (20 * TURN_BYTES))
    bench.put(0, lambda: order.append("flood"))
    bench.put(1, b"B\r")
    bench.put(1, lambda: order.append("polite"))
    gate.set()
    bench.settle()
    assert order == ["polite", "flood"]


def test_a_chunk_is_executed_in_turns_and_in_order(bench: Bench) -> None:
    lines = [b"%d" % number for number in range(5000)]
    bench.put(0, b"\r".join(lines) + b"\r")
    bench.settle()
    assert bench.ears[0].heard == b"".join(b"*" + line + b"\r\n> " for line in lines)


def test_a_wire_is_read_only_when_its_earlier_bytes_are_done(bench: Bench) -> None:
    """So what a host sends too fast waits in the operating system, and no memory is needed for it."""
    wire = Pipe([b"A\r" * TURN_BYTES] * 20)
    channel = bench.engine.attach(0, wire)
    wait_until(lambda: len(wire.heard) == 20 * TURN_BYTES * 6)
    assert wire.most_waiting == 0
    assert wire.heard == b"*A\r\n> " * (20 * TURN_BYTES)
    wire.close(bench, channel)


def test_a_detached_wire_is_not_touched_even_if_detached_twice(bench: Bench) -> None:
    """Its descriptor's number may belong to another connection by then."""
    first = Pipe([])
    channel = bench.engine.attach(0, first)
    first.close(bench, channel)
    second = Pipe([])
    assert set(second.descriptors) <= set(first.descriptors), "the number is used again"
    other = bench.engine.attach(0, second)
    bench.engine.drop(channel, lambda: None)
    bench.settle()
    second.portions = [b"B\r"]
    second.knock()
    wait_until(lambda: second.heard == b"*B\r\n> ")
    second.close(bench, other)


def test_a_raising_controller_is_logged_with_its_bytes_and_goes_on(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.ERROR, "oem6250"):
        bench.put(0, b"BOOM\r")
        bench.settle()
        bench.put(0, b"A\r")
        bench.settle()
    assert bench.ears[0].heard == b"*A\r\n> "
    [record] = caplog.records
    assert r'data="BOOM\r"' in record.getMessage()
    assert "at_ns=" in record.getMessage()
    assert record.exc_info is not None and record.exc_info[0] is Boom


def test_one_that_raises_again_and_again_is_retired_and_the_others_go_on(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.ERROR, "oem6250"):
        bench.toys[0].fail_on_advance = True
        wait_until(lambda: "out of service" in caplog.text)
        bench.put(0, b"A\r")
        bench.put(1, b"B\r")
        bench.settle()
        bench.engine.call(lambda: None).result(PATIENCE_S)
    assert caplog.text.count("controller raised") == FAILURES_TO_RETIRE
    assert caplog.text.count("out of service") == 1
    assert (bench.ears[0].heard, bench.ears[1].heard) == (b"", b"*B\r\n> ")


def test_a_call_runs_on_the_engine_thread_with_the_machines_at_the_present(bench: Bench) -> None:
    before_ns = bench.engine.clock.now_ns()
    name, now_ns = bench.engine.call(lambda: (threading.current_thread().name, bench.toys[1].now_ns)).result(PATIENCE_S)
    assert name == "engine"
    assert before_ns <= now_ns <= bench.engine.clock.now_ns()


def test_a_call_that_raises_gives_the_exception_to_the_caller(bench: Bench) -> None:
    with pytest.raises(ZeroDivisionError):
        bench.engine.call(lambda: 1 // 0).result(PATIENCE_S)
    assert bench.engine.call(lambda: 7).result(PATIENCE_S) == 7


def test_calls_after_the_end_are_cancelled() -> None:
    bench = Bench()
    bench.engine.start()
    assert bench.engine.stop(PATIENCE_S)
    with pytest.raises(CancelledError):
        bench.engine.call(lambda: 7).result(PATIENCE_S)


def test_a_dropped_channel_is_detached_after_its_input_and_never_written_to_again(bench: Bench) -> None:
    done = threading.Event()
    bench.put(0, b"A\rHAL")
    bench.engine.drop(bench.channels[0], done.set)
    assert done.wait(PATIENCE_S)
    assert bench.toys[0].detached == [bench.channels[0].number]
    heard = bench.ears[0].heard
    bench.engine.put(bench.engine.attach(0, Ear()), b"WAIT 1\r")
    wait_until(
        lambda: bench.engine.call(lambda: bench.toys[0].executed == 2 and not bench.toys[0].busy).result(PATIENCE_S)
    )
    assert bench.ears[0].heard == heard == b"*A\r\n> "


def finish(bench: Bench, channel: Channel, done: Callable[[], None]) -> None:
    """As a wire does when its host has said its last."""
    bench.engine.put(channel, lambda: bench.engine.finish(channel, done))


def test_a_finished_channel_waits_for_what_is_under_way(bench: Bench) -> None:
    heard_at_the_end: list[bytes] = []
    done = threading.Event()
    bench.put(0, b"HOLD 30\r")
    finish(bench, bench.channels[0], lambda: (heard_at_the_end.append(bench.ears[0].heard), done.set())[-1])
    assert done.wait(PATIENCE_S)
    assert heard_at_the_end == [b"*HELD\r\n> "]


def test_finished_channels_of_a_busy_unit_are_few(bench: Bench) -> None:
    bench.put(0, b"HOLD 3600000\r")
    ended: list[int] = []
    for number in range(MAX_LINGERING + 5):
        finish(bench, bench.engine.attach(0, Ear()), partial(ended.append, number))
    bench.settle()
    wait_until(lambda: ended == [0, 1, 2, 3, 4])


def test_a_forgotten_channel_stays_attached(bench: Bench) -> None:
    bench.put(0, b"HAL")
    bench.put(0, partial(bench.engine.forget, bench.channels[0]))
    bench.put(0, b"F\r")
    bench.settle()
    assert bench.ears[0].heard == b"*F\r\n> "


def test_a_channel_detached_while_in_line_for_its_turn_is_passed_over(bench: Bench) -> None:
    channel = bench.channels[0]

    def detach_in_line() -> None:
        bench.engine._enqueue(channel, lambda: None)
        bench.engine._detach(channel, lambda: None)

    bench.engine.call(detach_in_line).result(PATIENCE_S)
    bench.settle()

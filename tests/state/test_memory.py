"""Replies wait for the disk, in order, and only those that must; a disk that fails stops nobody."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest

from emulator.controller import Controller
from emulator.machine import Machine
from emulator.state import memory as memory_module
from emulator.state.contents import Contents
from emulator.state.errors import StateError
from emulator.state.memory import Memory
from emulator.state.store import Store

PATIENCE_S = 10.0


class Bench:
    """Two units with a memory whose writing can be held up and made to fail; the test is the engine thread."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.memory = Memory(path)
        self.units = [Controller(Machine.default()) for _ in range(2)]
        self.memory.restore(self.units)
        for unit in self.units:
            unit.power_up()
            unit.take_output()
        self.writes: list[set[int]] = []
        self.gate = threading.Event()
        self.gate.set()
        self.failing: Exception | None = None
        self._write = self.memory._store.write
        self.memory._store.write = self._gated  # type: ignore[method-assign]
        self.released: list[tuple[int, list[Any]]] = []
        self._inbox: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self.memory.run(post=self._inbox.put, release=lambda line, outputs: self.released.append((line, list(outputs))))

    def _gated(self, snapshots: Mapping[int, Contents]) -> None:
        assert self.gate.wait(PATIENCE_S)
        self.writes.append(set(snapshots))
        if self.failing:
            raise self.failing
        self._write(snapshots)

    def change(self, line: int = 0, value: int = 1) -> None:
        self.units[line].receive(b"VAR1=%d\r" % value, at_ns=0, channel=0)

    def confirm(self) -> None:
        """What the keeper has posted next."""
        self._inbox.get(timeout=PATIENCE_S)()

    def hold_back(self, line: int, *outputs: str) -> Sequence[Any]:
        return self.memory.hold_back(line, outputs)

    def kept(self) -> Contents:
        self.memory.close()
        store = Store(self.path)
        try:
            return store.contents(0)
        finally:
            store.close()


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    bench = Bench(tmp_path / "state")
    yield bench
    bench.gate.set()
    bench.memory.close()


def test_a_unit_that_has_changed_nothing_is_heard_at_once(bench: Bench) -> None:
    assert bench.hold_back(0, "a") == ("a",)
    assert bench.writes == []


def test_output_after_a_change_waits_for_it_and_keeps_its_order(bench: Bench) -> None:
    bench.gate.clear()
    bench.change()
    assert bench.hold_back(0, "a", "b") == ()
    assert bench.hold_back(0, "c") == (), "a later turn that changed nothing waits its turn"
    assert bench.memory.holds(0)
    assert bench.hold_back(1, "other unit") == ("other unit",)
    bench.gate.set()
    bench.confirm()
    assert bench.released == [(0, ["a", "b", "c"])]
    assert not bench.memory.holds(0)
    assert bench.hold_back(0, "d") == ("d",)
    assert bench.kept().numbers[0] == 1


def test_what_changes_while_a_commit_is_under_way_goes_into_the_next_together(bench: Bench) -> None:
    bench.gate.clear()
    for value in range(1, 101):
        bench.change(value=value)
        bench.hold_back(0, str(value))
    bench.change(line=1)
    bench.hold_back(1, "x")
    bench.gate.set()
    bench.confirm()
    assert bench.released == [(0, ["1"])], "the rest was changed after the first snapshot"
    bench.confirm()
    assert bench.released[1:] == [(0, [str(value) for value in range(2, 101)]), (1, ["x"])]
    assert bench.writes == [{0}, {0, 1}]


def test_changes_nobody_hears_of_are_written_a_few_times_a_second(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_ns = [10**18]
    monkeypatch.setattr(memory_module.time, "monotonic_ns", lambda: now_ns[0])
    for value in range(1, 1001):
        bench.change(value=value)
        bench.hold_back(0)
        if value == 1:
            bench.confirm()
    assert len(bench.writes) == 1
    now_ns[0] += memory_module.SILENT_NS
    bench.hold_back(0)
    bench.confirm()
    assert len(bench.writes) == 2
    assert bench.released == []
    assert bench.kept().numbers[0] == 1000


def test_the_end_makes_everything_durable_and_is_heard(bench: Bench) -> None:
    bench.gate.clear()
    bench.change(value=5)
    bench.hold_back(0, "a")
    bench.change(value=6)
    bench.hold_back(0, "b")
    bench.gate.set()
    bench.memory.finish()
    assert bench.released == [(0, ["a", "b"])]
    assert bench.kept().numbers[0] == 6


@pytest.mark.parametrize(
    "error", [StateError("state: no space left"), RuntimeError("no space left in a mistake of ours")]
)
def test_a_disk_that_fails_is_told_once_and_delays_nobody(
    error: Exception, bench: Bench, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logging.getLogger("oem6250"), "propagate", True)
    monkeypatch.setattr("emulator.state.keeper.RETRY_S", 0.02)
    bench.failing = error
    for value in range(1, 4):
        bench.change(value=value)
        assert bench.hold_back(0, str(value)) == ()
        bench.confirm()
    assert bench.released == [(0, ["1"]), (0, ["2"]), (0, ["3"])]
    bench.failing = None
    assert bench.kept().numbers[0] == 3, "what was owed is written when it can be"
    told = [record.getMessage() for record in caplog.records]
    assert [text.partition(" reason")[0] for text in told] == [
        'event="state file not written, trying again"',
        f'event="state file written again" file={bench.path}',
    ]
    assert "no space left" in told[0]


def test_a_disk_that_never_recovers_is_told_at_the_end(
    bench: Bench, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logging.getLogger("oem6250"), "propagate", True)
    bench.failing = StateError("no space left")
    bench.change()
    bench.hold_back(0, "a")
    bench.confirm()
    bench.memory.finish()
    assert "state file not written at the end" in caplog.text

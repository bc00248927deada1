"""The clock's promises, with a wall clock that the test turns."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import MAX_SLICE_NS, REPORT_EVERY_WALL_NS, SLICE_WALL_NS, Clock

MS = 1_000_000
S = 1_000_000_000
DAY_NS = 86_400 * S


class Wall:
    """A monotonic clock that stands still until it is turned."""

    def __init__(self) -> None:
        self.ns = 123_456_789

    def __call__(self) -> int:
        return self.ns


class Bench:
    """A clock and a machine that needs `cost` wall nanoseconds per virtual nanosecond."""

    def __init__(self, speed: float | None, cost: float = 0.0) -> None:
        self.wall = Wall()
        self.factors: list[float] = []
        self.clock = Clock(speed, wall=self.wall, report=self.factors.append)
        self.cost = cost
        self.busy = True

    def tick(self) -> int:
        """One tick of the engine thread; returns the wall time it took."""
        at_ns = self.clock.tick_ns()
        cost_ns = int((at_ns - self.clock.reached_ns) * self.cost)
        self.wall.ns += cost_ns
        self.clock.ran_to(at_ns, busy=self.busy)
        return cost_ns

    def run(self, wall_ns: int) -> None:
        """Tick each millisecond, or without pause while behind, for this long on the wall."""
        end_ns = self.wall.ns + wall_ns
        while self.wall.ns < end_ns:
            cost_ns = self.tick()
            if not (self.clock.behind or self.clock.free_running):
                self.wall.ns += MS - cost_ns % MS


@given(st.integers(0, 365 * DAY_NS), st.sampled_from([0.1, 1.0, 2.5, 20.0, 1000.0]))
def test_virtual_time_is_the_wall_times_the_speed_exactly(wall_ns: int, speed: float) -> None:
    bench = Bench(speed)
    bench.wall.ns += wall_ns
    assert bench.clock.now_ns() == wall_ns * round(speed * 10) // 10


@pytest.mark.parametrize("speed", [0.0, -1.0, float("inf"), float("nan")])
def test_a_speed_must_be_positive(speed: float) -> None:
    with pytest.raises(ValueError, match="speed"):
        Clock(speed)


@pytest.mark.parametrize("stall_ns", [300 * MS, 5 * S, 600 * S])
def test_a_stall_loses_no_time_and_is_caught_up_in_short_slices(stall_ns: int) -> None:
    bench = Bench(1.0, cost=0.01)
    bench.run(1 * S)
    bench.wall.ns += stall_ns
    costs = [bench.tick()]
    while bench.clock.behind:
        costs.append(bench.tick())
    assert bench.clock.now_ns() - bench.clock.reached_ns <= MAX_SLICE_NS
    assert max(costs) <= 3 * SLICE_WALL_NS
    bench.run(100 * MS)
    assert bench.clock.now_ns() - bench.clock.reached_ns <= 1 * MS
    assert bench.clock.now_ns() == bench.wall.ns - Wall().ns
    assert bench.factors == []


def test_stalls_again_and_again_lose_no_time_either() -> None:
    bench = Bench(1.0, cost=0.3)
    for _ in range(50):
        bench.wall.ns += 400 * MS
        bench.run(50 * MS)
    bench.run(20 * S)
    assert bench.clock.reached_ns >= bench.wall.ns - Wall().ns - 2 * MS
    assert bench.factors == []


@pytest.mark.parametrize(("speed", "cost", "factor"), [(1.0, 2.0, 0.5), (1000.0, 0.005, 200.0), (1.0, 1.25, 0.8)])
def test_a_host_too_slow_reports_the_factor_and_never_spirals(speed: float, cost: float, factor: float) -> None:
    bench = Bench(speed, cost=cost)
    bench.run(60 * S)
    assert bench.factors
    assert bench.factors[-1] == pytest.approx(factor, rel=0.05)
    gap_ns = bench.clock.now_ns() - bench.clock.reached_ns
    assert gap_ns < 3 * S * speed, "the debt stays bounded"
    assert bench.clock.reached_ns == pytest.approx(60 * S * factor, rel=0.05)
    assert len(bench.factors) <= 60 * S // REPORT_EVERY_WALL_NS


def test_full_speed_is_kept_again_when_the_load_has_gone() -> None:
    bench = Bench(1.0, cost=2.0)
    bench.run(5 * S)
    bench.cost = 0.01
    bench.run(5 * S)
    reached_ns, wall_ns = bench.clock.reached_ns, bench.wall.ns
    bench.run(10 * S)
    assert bench.clock.reached_ns - reached_ns == pytest.approx(bench.wall.ns - wall_ns, abs=2 * MS)


def test_input_while_catching_up_is_at_most_one_slice_ahead_of_the_machines() -> None:
    bench = Bench(1.0, cost=0.01)
    bench.wall.ns += 5 * S
    assert 0 < bench.clock.input_ns() - bench.clock.reached_ns < 5 * S
    bench.run(1 * S)
    assert bench.clock.input_ns() == bench.clock.now_ns() == bench.wall.ns - Wall().ns


@given(st.lists(st.tuples(st.integers(0, 3 * S), st.booleans(), st.floats(0, 3)), max_size=40), st.booleans())
def test_time_never_runs_backwards(steps: list[tuple[int, bool, float]], at_max: bool) -> None:
    bench = Bench(None if at_max else 1.0)
    last_ns = 0
    for pause_ns, busy, cost in steps:
        bench.busy, bench.cost = busy, cost
        bench.wall.ns += pause_ns
        assert bench.clock.input_ns() >= last_ns
        bench.tick()
        assert bench.clock.reached_ns >= last_ns
        last_ns = bench.clock.reached_ns


def test_max_runs_free_while_busy_and_at_real_time_when_idle() -> None:
    bench = Bench(None, cost=0.002)
    bench.run(1 * S)
    free_ns = bench.clock.reached_ns
    assert free_ns == pytest.approx(500 * S, rel=0.1)
    assert bench.clock.input_ns() == free_ns, "input takes effect where the machines are"
    bench.busy = False
    bench.tick()
    reached_ns, wall_ns = bench.clock.reached_ns, bench.wall.ns
    bench.run(2 * S)
    assert bench.clock.reached_ns - reached_ns == pytest.approx(bench.wall.ns - wall_ns, abs=2 * MS)
    assert bench.factors == []


def test_lateness_is_what_the_wall_says() -> None:
    bench = Bench(2.0)
    for late_ns in [1 * MS] * 98 + [3 * MS, 7 * MS]:
        bench.wall.ns += late_ns
        bench.tick()
    late = bench.clock.lateness.read()
    assert (late.p50_ns, late.p99_ns, late.max_ns, late.samples) == (1 * MS, 7 * MS, 7 * MS, 100)


def test_idle_ticks_are_not_late() -> None:
    bench = Bench(1.0)
    bench.busy = False
    bench.run(1 * S)
    assert bench.clock.lateness.read().samples == 0

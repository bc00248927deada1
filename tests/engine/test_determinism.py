"""The same settings at the same times give the same state, however time is sliced and however the kernel is had."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.engine import (
    AxisHardware,
    Engine,
    Event,
    Gains,
    TorqueDrive,
    VelocityDrive,
    plan_continuous,
    plan_preset,
    plan_stop,
    rates_for,
)
from emulator.engine.machine_code import MODE_VARIABLE

MS = 1_000_000


def new_engine() -> Engine:
    axes = [AxisHardware(VelocityDrive(), encoder_phase=0.3), AxisHardware(TorqueDrive())]
    engine = Engine(axes, rates=rates_for(2, 4))
    engine.set_gains(0, Gains(5.0, 3.0, 2.0, 20.0, 0.1, 5.0))
    engine.set_gains(1, Gains(20.0, 5.0, 400.0))
    return engine


def begin(engine: Engine) -> None:
    engine.set_wires(0xFFF)
    engine.enable(0)
    engine.enable(1)
    engine.set_target_zone(0, enable=True, distance_counts=5, velocity_counts_s=500.0, timeout_ms=100)
    engine.start_profile(0, plan_preset(0.0, 0.0, 800.0, 40_000.0, 1e6, 1e6, 5e5, 7e5))
    engine.start_profile(1, plan_continuous(0.0, 0.0, -3000.0, 40_000.0, 40_000.0))
    engine.watch_value(0, 0, "PE", ">", 300)


def change(engine: Engine) -> None:
    position, velocity, _ = engine.profile_state(1)
    engine.start_profile(1, plan_stop(position, velocity, 20_000.0))
    engine.set_position(0, 12_345)
    engine.set_wires(0xFDF)


def overload(engine: Engine) -> None:
    engine.set_position_error_limit(1, 50)
    engine.start_profile(1, plan_continuous(*engine.profile_state(1)[:2], 400_000.0, 1e7, 1e7))
    engine.set_rates(rates_for(2, 2))


SCRIPT: tuple[tuple[int, Callable[[Engine], None]], ...] = ((3 * MS, begin), (151 * MS, change), (200 * MS, overload))
END_NS = 900 * MS


def play(engine: Engine, slices: Iterable[int]) -> tuple[bytes, list[tuple[int, Event]]]:
    """Run the script, stopping at `slices` as well; the final state and every event with its time."""
    actions = dict(SCRIPT)
    told: list[tuple[int, Event]] = []
    for stop_ns in sorted({*actions, *slices, END_NS}):
        while engine.time_ns < stop_ns:
            event = engine.run(stop_ns)
            if event:
                told.append((engine.time_ns, event))
        if stop_ns in actions:
            actions[stop_ns](engine)
    return engine.snapshot(), told


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(1, END_NS), max_size=200))
def test_slicing_changes_nothing(slices: list[int]) -> None:
    assert play(new_engine(), slices) == play(new_engine(), [])


def test_the_script_visits_what_it_is_meant_to() -> None:
    _, told = play(new_engine(), [])
    seen = Event.NONE
    for _, event in told:
        seen |= event
    wanted = Event.MOVE_ENDED | Event.SETTLED | Event.POSITION_ERROR | Event.VALUE | Event.WIRES
    assert seen & wanted == wanted


def test_snapshots_of_different_histories_differ() -> None:
    one, other = new_engine(), new_engine()
    one.set_output(0, offset_v=0.01)
    one.run(END_NS)
    other.run(END_NS)
    assert one.snapshot() != other.snapshot()


def test_interpreted_and_compiled_agree_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = play(new_engine(), [])
    monkeypatch.setenv(MODE_VARIABLE, "interpreted")
    interpreted = new_engine()
    assert interpreted.kernel_origin == "interpreted"
    assert play(interpreted, []) == compiled

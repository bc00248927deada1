"""The millisecond timer, alone and in a condition."""

from __future__ import annotations

import pytest

from emulator.controller.variables.timers import LARGEST_MS, Timer
from emulator.controller.waits import NEVER
from tests.controller.session import MS, OK, SYSTEM_NS, Session


def test_it_counts_while_started() -> None:
    timer = Timer()
    assert timer.elapsed_ms(5 * MS) == 0
    timer.start(5 * MS, from_zero=True)
    assert timer.elapsed_ms(8 * MS - 1) == 2
    timer.stop(8 * MS)
    assert timer.elapsed_ms(100 * MS) == 3
    timer.start(100 * MS, from_zero=False)
    timer.start(101 * MS, from_zero=False)
    assert timer.elapsed_ms(102 * MS) == 5
    timer.start(200 * MS, from_zero=True)
    assert timer.elapsed_ms(201 * MS) == 1


def test_it_stands_still_at_its_largest_value() -> None:
    timer = Timer()
    timer.start(0, from_zero=True)
    assert timer.elapsed_ms((LARGEST_MS + 10) * MS) == LARGEST_MS


def test_when_it_will_have_counted_so_far() -> None:
    timer = Timer()
    assert timer.reaches_ns(10) == NEVER
    timer.start(7 * MS, from_zero=True)
    assert timer.elapsed_ms(timer.reaches_ns(10)) == 10
    assert timer.elapsed_ms(timer.reaches_ns(10) - 1) == 9


@pytest.mark.parametrize(
    ("condition", "after_ms"),
    [("TIM>=300", 300), ("TIM>300", 301), ("TIM=VAR1", 250), ("NOT TIM<300", 300), ("TIM/2>100", 201)],
)
def test_a_condition_on_it_is_met_at_the_next_system_update(condition: str, after_ms: int) -> None:
    session = Session()
    session.ok("VAR1=250", "TIMST0")
    started_ns = session.now_ns
    found = session.timed(f"WAIT({condition.replace('TIM=VAR1', 'TIM>=VAR1')})", wait_s=1.0)
    assert [stamped.text for stamped in found] == [OK]
    late_ns = found[0].at_ns - after_ms * MS
    assert 0 <= late_ns < SYSTEM_NS + MS, (started_ns, found)


def test_a_stopped_timer_costs_no_looks() -> None:
    session = Session()
    assert session.ask("WAIT(TIM>100)") == ""
    session.advance(1.0)
    assert session.unit.controller.alarms.next_ns == NEVER
    assert session.ask("!TIMST0") == OK
    session.advance(0.2)
    assert session.read() == OK

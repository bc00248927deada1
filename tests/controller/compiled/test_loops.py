"""PLOOP and PLN: how often, how deep, and that the thousandth pass is as exact as the first."""

from __future__ import annotations

import pytest

from tests.controller.compiled.rig import COUNTS, compiled, refusal, run_time
from tests.controller.session import ONE_UPDATE_EACH_NS, S

SETTLES_WITHIN = ONE_UPDATE_EACH_NS / S
MOVE = ("A10", "AD10", "V1", "D4000", "VF0", "GOBUF1")
MOVE_S = 1.1


def test_a_loop_repeats_its_segments() -> None:
    session = compiled("PLOOP3", *MOVE, "PLN1")
    assert run_time(session) == pytest.approx(3 * MOVE_S, abs=SETTLES_WITHIN)
    assert session.position() == 3 * COUNTS


def test_loops_nest_four_deep() -> None:
    session = compiled("PLOOP2", "PLOOP3", "PLOOP2", "PLOOP2", *MOVE, "PLN1", "PLN1", "PLN1", "PLN1")
    assert run_time(session) == pytest.approx(24 * MOVE_S, abs=SETTLES_WITHIN)
    assert session.position() == 24 * COUNTS


def test_five_deep_is_refused() -> None:
    assert refusal(*["PLOOP2"] * 5, *MOVE, *["PLN1"] * 5) == "NEST LEVEL TOO DEEP"


@pytest.mark.parametrize("program", [("PLOOP2", *MOVE), (*MOVE, "PLN1"), (*MOVE, "PLOOP2", "PLN1")])
def test_a_loop_needs_both_its_ends_and_something_between(program: tuple[str, ...]) -> None:
    assert refusal(*program) == "INVALID CONDITIONS FOR COMMAND-AXIS 1"


def test_a_loop_of_no_duration_is_refused() -> None:
    assert refusal("V1", "MC1", "GOBUF1", "PLOOP", "GOBUF1", "PLN1") == "INVALID CONDITIONS FOR COMMAND-AXIS 1"


def test_each_axis_has_its_own_loops() -> None:
    session = compiled("A10,10", "V1,1", "D4000,4000", "PLOOP2,3", "VF0,0", "GOBUF11", "PLN11")
    assert run_time(session, 2) == pytest.approx(3 * MOVE_S, abs=SETTLES_WITHIN)
    assert (session.position(1), session.position(2)) == (2 * COUNTS, 3 * COUNTS)


def test_passes_entered_at_different_velocities() -> None:
    """The first pass speeds up within its distance, the others are all at V."""
    session = compiled("A10", "AD10", "V2", f"D{2 * COUNTS}", "PLOOP4", "GOBUF1", "PLN1", "VF0", "GOBUF1")
    first, middle, last = 0.2 + (2 - 0.2) / 2, 1.0, (2 - 0.2) / 2 + 0.2
    assert run_time(session) == pytest.approx(first + 3 * middle + last, abs=SETTLES_WITHIN)
    assert session.position() == 10 * COUNTS


@pytest.mark.parametrize("loop", ["PLOOP", "PLOOP0", "1PLOOP"])
def test_an_endless_loop_goes_on_until_it_is_stopped(loop: str) -> None:
    session = compiled(loop, *MOVE, "PLN1", COMEXC="1")
    session.ok("PRUN P")
    session.advance(100 * MOVE_S + 0.05)
    assert 100 * COUNTS < session.position() < 101 * COUNTS
    session.ok("!S1")
    session.until_rest()
    assert session.ask("PRUN P") == "\r\n> "


@pytest.mark.parametrize(
    ("program", "travel"),
    [
        (("V1", "D4001", "VF0", "GOBUF1", "D-3998", "VF0", "GOBUF1"), 3),
        (("V3", "A7", "AD11", "D-1000", "VF0", "GOBUF1"), -1000),
        (("V20", "A50", "AD50", "D120000", "VF0", "GOBUF1", "V1", "D1", "VF0", "GOBUF1"), 120001),
    ],
)
def test_an_hour_without_drift(program: tuple[str, ...], travel: int) -> None:
    session = compiled("PLOOP", *program, "PLN1", COMEXC="1")
    seconds = _duration(program)
    session.ok("PRUN P")
    begin_ns = session.unit.controller.engine.next_trajectory_ns
    passes = int(3600 / seconds)
    session.emulator.advance_to(begin_ns + round(passes * seconds * S) + 2_000_000)
    # Just at the beginning of a pass the axis has hardly moved.
    assert session.position() == pytest.approx(passes * travel, abs=1)


def _duration(program: tuple[str, ...]) -> float:
    """Equations of 5.2 for presets from rest to rest."""
    values = {"V": 1.0, "A": 10.0, "AD": 10.0, "D": 0.0}
    total = 0.0
    for command in program:
        name = next((name for name in ("AD", "A", "V", "D") if command.startswith(name)), None)
        if command == "GOBUF1":
            v, a, ad, d = values["V"], values["A"], values["AD"], abs(values["D"]) / COUNTS
            peak = min(v, (2 * d * a * ad / (a + ad)) ** 0.5)
            ramps = peak**2 / (2 * a) + peak**2 / (2 * ad)
            total += peak / a + peak / ad + (d - ramps) / peak
        elif name and not command.startswith("VF"):
            values[name] = float(command.removeprefix(name))
    return total

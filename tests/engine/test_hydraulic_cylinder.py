"""A hydraulic cylinder against scipy's solution of its valve, and against the documented cylinder."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from emulator.engine import HydraulicCylinder, PlantError
from tests.engine.rig import PERIODS_S, TURN, Rig, exact_linear, volts_sequence


@pytest.mark.parametrize(("volts", "speed"), [(1.0, 3.0), (-1.0, -2.3), (4.0, 12.0), (-4.0, -9.2), (0.0, 0.0)])
def test_the_documented_cylinder_moves_faster_outwards(volts: float, speed: float) -> None:
    rig = Rig(HydraulicCylinder(), 280e-6)
    rows = rig.record(["true_velocity", "true_position"], [volts] * 2000)
    assert rows[-1, 0] == pytest.approx(speed, abs=1e-9)
    # A second-order valve lags behind its command by 2 damping / natural frequency in the long run.
    lag_s = 2.0 * 0.8 / (TURN * 60.0)
    assert rows[-1, 1] == pytest.approx(speed * (2000 * 280e-6 - lag_s), abs=1e-9)


@pytest.mark.parametrize("period_s", PERIODS_S)
@pytest.mark.parametrize(("hz", "damping"), [(60.0, 0.8), (200.0, 0.1), (15.0, 1.0), (1500.0, 3.0)])
def test_the_valve_is_exact_under_zero_order_hold(period_s: float, hz: float, damping: float) -> None:
    plant = HydraulicCylinder(valve_hz=hz, valve_damping=damping, retract_units_s_per_v=3.0)
    w = TURN * hz
    system = np.array([[0.0, 1.0, 0.0], [-w * w, -2.0 * damping * w, 0.0], [3.0, 0.0, 0.0]])
    volts = [each + 20.0 for each in volts_sequence(120)]
    rows = Rig(plant, period_s).record(["spool", "true_position"], volts)
    expected = exact_linear(system, np.array([0.0, w * w, 0.0]), volts, period_s)
    assert rows[:, 0] == pytest.approx(expected[:, 0], rel=1e-9)
    assert rows[:, 1] == pytest.approx(expected[:, 2], rel=1e-9)


def test_nothing_flows_within_the_overlap() -> None:
    for volts, speed in ((0.4, 0.0), (-0.5, 0.0), (0.6, 0.3), (-0.7, -0.46)):
        rig = Rig(HydraulicCylinder(overlap_v=0.5, valve_damping=1.0), 280e-6)
        rows = rig.record(["true_velocity", "true_position"], [volts] * 3000)
        assert rows[-1, 0] == pytest.approx(speed, abs=1e-9)
        assert (rows[-1, 1] == 0.0) == (speed == 0.0)


def test_overlap_and_full_flow_agree_with_a_fine_numerical_solution() -> None:
    plant = HydraulicCylinder(overlap_v=0.5, valve_hz=25.0, valve_damping=0.5, max_speed_units_s=8.0)
    w, period_s, steps = TURN * 25.0, 280e-6, 1500

    def volts(step: int) -> float:
        return 5.0 * math.sin(step * 0.01)

    def slope(t: float, state: np.ndarray) -> list[float]:
        opening = max(abs(state[0]) - 0.5, 0.0)
        speed = min(3.0 * opening, 8.0) if state[0] > 0 else -min(2.3 * opening, 8.0)
        command = volts(int(t / period_s))
        return [state[1], w * w * (command - state[0]) - w * state[1], speed]

    rows = Rig(plant, period_s).record(["spool", "true_position"], [volts(k) for k in range(steps)])
    fine: Any = solve_ivp(slope, (0.0, steps * period_s), [0.0, 0.0, 0.0], max_step=period_s / 4, rtol=1e-6, atol=1e-9)
    assert rows[-1] == pytest.approx([fine.y[0, -1], fine.y[2, -1]], rel=1e-3, abs=1e-3)
    assert np.abs(np.diff(rows[:, 1])).max() == pytest.approx(8.0 * period_s, rel=1e-9)


def test_end_stops_stop_it() -> None:
    rig = Rig(HydraulicCylinder(extended_stop_units=0.5, retracted_stop_units=-0.2), 280e-6)
    out = rig.record(["true_position", "true_velocity"], [5.0] * 1000)
    assert out[-1].tolist() == [0.5, 0.0]
    back = rig.record(["true_position", "true_velocity"], [-5.0] * 1000)
    assert back[-1].tolist() == [-0.2, 0.0]
    assert back[:, 0].max() <= 0.5


def test_a_valve_without_current_shuts() -> None:
    rig = Rig(HydraulicCylinder(), 280e-6)
    rig.record(["spool"], [5.0] * 500)
    rig["enabled"] = 0
    rows = rig.record(["true_position", "spool"], [5.0] * 3000)
    assert abs(rows[-1, 1]) < 1e-12
    assert np.ptp(rows[-1000:, 0]) < 1e-9


@pytest.mark.parametrize(
    ("values", "parameter"),
    [
        ({"extend_units_s_per_v": 0.0}, "extend_units_s_per_v"),
        ({"retract_units_s_per_v": math.inf}, "retract_units_s_per_v"),
        ({"overlap_v": -0.1}, "overlap_v"),
        ({"valve_hz": 1e6}, "valve_hz"),
        ({"valve_damping": math.nan}, "valve_damping"),
        ({"max_speed_units_s": 0.0}, "max_speed_units_s"),
        ({"extended_stop_units": -1.0, "retracted_stop_units": 1.0}, "extended_stop_units"),
    ],
)
def test_impossible_cylinders_are_named(values: dict[str, Any], parameter: str) -> None:
    with pytest.raises(PlantError) as failure:
        HydraulicCylinder(**values)
    assert failure.value.parameter == parameter

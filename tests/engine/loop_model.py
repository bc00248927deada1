"""The sampled position loop simulated apart from the engine: matrix exponential for the plant, the law of the notes,
quantisers. What a proof compares the engine with when there is no closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm
from scipy.signal import cont2discrete

from emulator.engine import Engine, Gains, VelocityDrive, plan_preset
from emulator.engine.trace import Source, Trace

COUNTS_PER_REV = 4000
STEP_V = 20 / 65536
"""One step of the 16-bit converter, V."""

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LoopModel:
    """A velocity-mode drive without torque limit in the loop, at one servo period."""

    plant: VelocityDrive
    gains: Gains
    servo_s: float
    delay_s: float = 0.0
    limit_v: float = 10.0
    offset_v: float = 0.0
    phase: float = 0.0

    def _advance(self, period_s: float) -> Floats:
        tau, lag = self.plant.loop_time_constant_s, self.plant.command_lag_s
        system = np.zeros((4, 4))
        system[0, 1], system[1, 1], system[1, 2] = 1.0, -1 / tau, 1 / tau
        system[2, 2], system[2, 3] = -1 / lag, self.plant.speed_per_volt_rev_s / lag
        return np.asarray(expm(system * period_s))

    def step(self, target: int, samples: int) -> tuple[Floats, Floats]:
        """Shaft (rev) and output (V) at each sample after the command has stepped to `target` counts."""
        gains, ts = self.gains, self.servo_s
        before, after = self._advance(self.delay_s), self._advance(ts - self.delay_s)
        state, last, integral, volts, previous = np.zeros(4), 0, 0.0, 0.0, 0.0
        positions, outputs = np.zeros(samples), np.zeros(samples)
        for k in range(samples):
            state[3] = previous
            state = before @ state
            state[3] = volts
            state = after @ state
            counts = math.floor(state[0] * COUNTS_PER_REV + self.phase)
            error = target - counts
            integral += 1e-3 * gains.integral_mv_per_count_s * error * ts
            integral = min(gains.integral_limit_v, max(-gains.integral_limit_v, integral))
            wanted = 1e-3 * gains.proportional_mv_per_count * error + integral
            wanted -= 1e-6 * gains.velocity_uv_per_count_s * (counts - last) / ts
            wanted = min(self.limit_v, max(-self.limit_v, wanted + self.offset_v))
            previous, last = volts, counts
            volts = min(32767, math.floor(wanted / STEP_V + 0.5)) * STEP_V
            positions[k], outputs[k] = state[0], volts
        return positions, outputs


def recorded_step(engine: Engine, target: int, samples: int, *more: Source) -> Trace:
    """The engine's axis 1 after a step of the commanded position, one row a servo sample, the first being the one at
    which the command arrives. Columns: shaft (rev), output (V), then those asked for."""
    engine.start_profile(0, plan_preset(0.0, 0.0, float(target), 1e9, 1e15, 1e15))
    # The profile begins at the next trajectory update at rest and is over at the one after it: a step.
    engine.run(engine.next_trajectory_ns)
    engine.run(engine.next_trajectory_ns - 1)
    engine.scope.arm([Source("true_position", 0), Source("dac_v", 0), *more], rows=samples)
    run_for(engine, samples * engine.rates.servo_ns * 1e-9 + engine.rates.system_ns * 1e-9)
    return engine.scope.read()


def run_for(engine: Engine, seconds: float) -> None:
    """Run on through whatever events come."""
    until_ns = engine.time_ns + round(seconds * 1e9)
    while engine.time_ns < until_ns:
        engine.run(until_ns)


def closed_loop_response(
    model: LoopModel, frequencies_hz: Sequence[float] | npt.NDArray[np.floating]
) -> npt.NDArray[np.complex128]:
    """Actual over commanded position of the loop without quantisers, from the z-transform of plant and law."""
    tau, lag, k = model.plant.loop_time_constant_s, model.plant.command_lag_s, model.plant.speed_per_volt_rev_s
    a = np.array([[0.0, 1.0, 0.0], [0.0, -1 / tau, 1 / tau], [0.0, 0.0, -1 / lag]])
    b = np.array([[0.0], [0.0], [k * COUNTS_PER_REV / lag]])
    ad, bd, cd, _, _ = cont2discrete((a, b, np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 1))), model.servo_s, "zoh")
    z = np.exp(2j * np.pi * np.asarray(frequencies_hz) * model.servo_s)
    plant = np.array([(cd @ np.linalg.solve(zi * np.eye(3) - ad, bd))[0, 0] for zi in z])
    gains, ts = model.gains, model.servo_s
    forward = 1e-3 * gains.proportional_mv_per_count + 1e-3 * gains.integral_mv_per_count_s * ts * z / (z - 1)
    damping = 1e-6 * gains.velocity_uv_per_count_s * (1 - 1 / z) / ts
    return np.asarray(plant * forward / (1 + plant * (forward + damping)))

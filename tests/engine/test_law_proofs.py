"""The servo law proved against closed forms and against an independent simulation of the sampled loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from emulator.engine import Engine, Gains, TorqueDrive, VelocityDrive, plan_continuous, plan_preset
from emulator.engine.trace import Source
from tests.engine.loop_model import COUNTS_PER_REV, STEP_V, LoopModel, closed_loop_response, recorded_step, run_for

MakeEngine = Callable[..., Engine]

FREE = VelocityDrive(max_acceleration_rev_s2=math.inf)
K = FREE.speed_per_volt_rev_s * COUNTS_PER_REV
"""Speed per volt, counts/s."""

SERVO_S, TRAJECTORY_S = 280e-6, 1120e-6


def open_range(engine: Engine) -> None:
    """Nothing but the law acts: no SMPER, no limits."""
    engine.set_position_error_limit(0, 0)
    engine.set_hard_limits(0, enable=0)


class TestStep:
    GAINS = (Gains(0.5), Gains(2.0, 5.0, 1.0), Gains(5.0, 3.0, 2.0), Gains(15.0, 0.0, 20.0))

    @pytest.mark.parametrize("gains", GAINS)
    def test_every_sample_is_that_of_the_simulated_loop(self, make_engine: MakeEngine, gains: Gains) -> None:
        """Shaft and converter, sample for sample, saturation included."""
        engine = make_engine(FREE)
        open_range(engine)
        engine.set_gains(0, gains)
        trace = recorded_step(engine, 2001, 1500)
        positions, outputs = LoopModel(FREE, gains, SERVO_S).step(2001, 1500)
        assert trace.columns[0] == pytest.approx(positions, rel=1e-6, abs=1e-7)
        assert trace.columns[1] == pytest.approx(outputs, abs=1e-9)

    def test_second_order_overshoot(self, make_engine: MakeEngine) -> None:
        """Loop gain Kv = SGP K, lag tau, delay d = Ts/2 + input lag, to first order tau s2 + (1 - Kv d) s + Kv:
        overshoot exp(-pi z / sqrt(1 - z2)) with z = (1 - Kv d) / (2 sqrt(Kv tau))."""
        engine = make_engine(VelocityDrive(10.0, 0.010, 0.0003, math.inf))
        open_range(engine)
        engine.set_gains(0, Gains(5.0))
        trace = recorded_step(engine, 1500, 3000)
        zeta = (1 - 5e-3 * K * (0.0003 + SERVO_S / 2)) / (2 * math.sqrt(5e-3 * K * 0.010))
        overshoot = float(np.max(trace.columns[0])) * COUNTS_PER_REV / 1500 - 1
        assert overshoot == pytest.approx(math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), abs=0.01)


@pytest.mark.parametrize("velocity", [4000.0, -20_000.0])
@pytest.mark.parametrize(
    ("sgp", "sgv", "sgvf"), [(0.5, 0, 0), (2, 10, 0), (2, 10, 5), (2, 0, 25), (2, 10, 35), (1, 0, 40)]
)
def test_ramp_error(make_engine: MakeEngine, velocity: float, sgp: float, sgv: float, sgvf: float) -> None:
    """At constant velocity the terms must make v / K volts: error = v (1/K + SGV - SGVF) / SGP, on the mean of the
    commanded staircase, which lies half a trajectory update less half a sample below its newest value."""
    engine = make_engine()
    open_range(engine)
    engine.set_gains(0, Gains(sgp, 0.0, sgv, sgvf))
    engine.start_profile(0, plan_continuous(0.0, 0.0, velocity, 4e5, 4e5))
    run_for(engine, 3.0)
    engine.run(engine.next_system_update_ns)
    engine.scope.arm([Source("commanded_counts", 0, "feedback_counts")], rows=4000)
    run_for(engine, 1.2)
    mean_error = float(np.mean(engine.scope.read().columns[0]))
    expected = velocity * (1 / K + (sgv - sgvf) * 1e-6) / (sgp * 1e-3)
    assert mean_error == pytest.approx(expected, abs=0.6)


class TestDisturbance:
    """A torque drive under a constant load: all it takes is load / torque_per_volt volts."""

    LOAD_NM, PER_VOLT = 0.15, 0.3
    PLANT = TorqueDrive(torque_per_volt_nm=PER_VOLT, coulomb_nm=0.0, viscous_nm_s_per_rev=2e-3, load_torque_nm=LOAD_NM)

    def _hold(self, make_engine: MakeEngine, gains: Gains, seconds: float) -> Engine:
        engine = make_engine(self.PLANT)
        open_range(engine)
        engine.set_gains(0, gains)
        run_for(engine, seconds)
        return engine

    @pytest.mark.parametrize("sgp", [1.0, 2.0, 5.0])
    def test_without_sgi_the_error_is_load_over_gain(self, make_engine: MakeEngine, sgp: float) -> None:
        engine = self._hold(make_engine, Gains(sgp, 0.0, 30.0), 4.0)
        assert engine.position_error(0) == pytest.approx(self.LOAD_NM / self.PER_VOLT / (sgp * 1e-3), abs=1)
        assert engine.terms(0)["I"] == 0.0

    def test_with_sgi_it_is_none(self, make_engine: MakeEngine) -> None:
        engine = self._hold(make_engine, Gains(2.0, 10.0, 30.0), 8.0)
        assert abs(engine.position_error(0)) <= 1
        assert engine.terms(0)["I"] == pytest.approx(self.LOAD_NM / self.PER_VOLT, abs=0.01)

    def test_an_sgilim_too_low_leaves_the_rest_to_sgp(self, make_engine: MakeEngine) -> None:
        engine = self._hold(make_engine, Gains(2.0, 10.0, 30.0, integral_limit_v=0.2), 8.0)
        assert engine.terms(0)["I"] == 0.2
        assert engine.position_error(0) == pytest.approx((self.LOAD_NM / self.PER_VOLT - 0.2) / 2e-3, abs=1)


class TestWindup:
    """A long step that saturates: the integral gathers volts that overshoot has to take away again."""

    TARGET, SAMPLES = 40_000, 6000

    def _peak(self, make_engine: MakeEngine, limit_v: float) -> tuple[float, float]:
        gains = Gains(0.5, 2.0, 0.0, integral_limit_v=limit_v)
        engine = make_engine(FREE)
        open_range(engine)
        engine.set_gains(0, gains)
        trace = recorded_step(engine, self.TARGET, self.SAMPLES, Source("term_i", 0))
        positions, _ = LoopModel(FREE, gains, SERVO_S).step(self.TARGET, self.SAMPLES)
        assert trace.columns[0] == pytest.approx(positions, rel=1e-6, abs=1e-6)
        return float(np.max(trace.columns[0])) * COUNTS_PER_REV / self.TARGET - 1, float(np.max(trace.columns[2]))

    def test_sgilim_cuts_the_overshoot(self, make_engine: MakeEngine) -> None:
        wild, gathered = self._peak(make_engine, 200.0)
        tame, limited = self._peak(make_engine, 0.5)
        assert gathered > 3.0
        assert limited == 0.5
        assert wild > 0.1
        assert tame < 0.3 * wild

    def test_above_ten_volts_it_is_inactive_for_what_can_be_reached(self, make_engine: MakeEngine) -> None:
        assert self._peak(make_engine, 200.0) == self._peak(make_engine, 100.0)


@pytest.mark.parametrize("limit_v", [10.0, 4.0, 1.0])
def test_saturation_at_the_converter_and_at_daclim(make_engine: MakeEngine, limit_v: float) -> None:
    """A step far too large: the drive runs at the limit's speed for the distance, and never above it."""
    gains = Gains(5.0, 0.0, 5.0)
    engine = make_engine(FREE)
    open_range(engine)
    engine.set_gains(0, gains)
    engine.set_output(0, limit_v=limit_v)
    trace = recorded_step(engine, 40_000, 4000, Source("control_v", 0))
    positions, outputs = LoopModel(FREE, gains, SERVO_S, limit_v=limit_v).step(40_000, 4000)
    assert trace.columns[1] == pytest.approx(outputs, abs=1e-9)
    assert trace.columns[0] == pytest.approx(positions, rel=1e-6, abs=1e-6)
    assert float(np.max(trace.columns[2])) == limit_v
    assert float(np.max(trace.columns[1])) == pytest.approx(limit_v, abs=STEP_V)
    # At the limit the shaft runs K volts: half the way takes this long.
    half_s = float(np.argmax(trace.columns[0] > 5.0)) * SERVO_S
    assert half_s == pytest.approx(20_000 / (K * limit_v) + 0.0023, abs=0.001)


class TestChatter:
    """One count more or less in a sample is SGV / Ts volts: high SGV makes chatter of the encoder's steps.

    The plant is L of the tuning notes with its output delay of 0.875 samples. An offset of 0.022 V would rest at 1.5
    counts of error with SGP 15, which the encoder does not have: it toggles between two counts.
    """

    PLANT = VelocityDrive(13_550 / 4000, 1.74e-3, 0.238e-3, math.inf)
    DELAY_S = 0.875 * SERVO_S

    def _ripple(self, make_engine: MakeEngine, sgv: float, phase: float, offset_v: float) -> float:
        gains = Gains(15.0, 0.0, sgv)
        engine = make_engine(self.PLANT, encoder_phase=phase, output_delay_s=self.DELAY_S)
        open_range(engine)
        engine.set_gains(0, gains)
        engine.set_output(0, offset_v=offset_v)
        trace = recorded_step(engine, 100, 5000)
        return float(np.ptp(trace.columns[1][3500:]))

    @pytest.mark.parametrize("phase", [0.1, 0.5, 0.8])
    @pytest.mark.parametrize("sgv", [2.0, 20.0, 80.0, 200.0])
    def test_its_size_is_a_count_of_sgp_and_two_of_sgv(self, make_engine: MakeEngine, sgv: float, phase: float) -> None:
        """Peak to peak SGP + 2 SGV / Ts: 29 mV with SGV 2, 1.44 V with SGV 200, and no more than that."""
        ripple = self._ripple(make_engine, sgv, phase, 0.022)
        assert ripple == pytest.approx(15e-3 + 2 * sgv * 1e-6 / SERVO_S, abs=4 * STEP_V)

    @pytest.mark.parametrize("phase", [0.1, 0.5, 0.8])
    def test_nothing_to_hold_nothing_to_chatter_about(self, make_engine: MakeEngine, phase: float) -> None:
        assert self._ripple(make_engine, 2.0, phase, 0.0) == 0.0

    @pytest.mark.parametrize("phase", [0.1, 0.5, 0.8])
    def test_beyond_what_the_delay_allows_it_is_a_limit_cycle_at_the_stops(
        self, make_engine: MakeEngine, phase: float
    ) -> None:
        assert self._ripple(make_engine, 400.0, phase, 0.0) == pytest.approx(20.0, abs=2 * STEP_V)


class TestDither:
    @pytest.mark.parametrize(("amplitude", "half_period"), [(0.25, 1), (0.5, 7), (1.0, 99)])
    def test_square_wave_at_the_converter(self, make_engine: MakeEngine, amplitude: float, half_period: int) -> None:
        """+amplitude for SDTFR samples, -amplitude for SDTFR samples, around the offset, with every gain zero."""
        engine = make_engine()
        open_range(engine)
        engine.set_gains(0, Gains(0.0))
        engine.set_output(0, offset_v=1.0)
        engine.set_dither(0, amplitude_v=amplitude, half_period_samples=half_period)
        engine.scope.arm([Source("dac_v", 0)], rows=20 * half_period)
        run_for(engine, 21 * half_period * SERVO_S + 0.01)
        volts = engine.scope.read().columns[0]
        expected = 1.0 + amplitude * np.where(np.arange(20 * half_period) // half_period % 2 == 0, 1.0, -1.0)
        assert volts == pytest.approx(expected, abs=STEP_V)

    def test_it_obeys_daclim_and_ends_with_the_drive(self, make_engine: MakeEngine) -> None:
        engine = make_engine()
        engine.set_gains(0, Gains(0.0))
        engine.set_output(0, offset_v=0.5, limit_v=1.0)
        engine.set_dither(0, amplitude_v=5.0, half_period_samples=4)
        engine.scope.arm([Source("dac_v", 0)], rows=400)
        run_for(engine, 0.2)
        assert set(np.round(engine.scope.read().columns[0], 3)) == {1.0, -1.0}
        engine.disable(0)
        engine.scope.arm([Source("dac_v", 0)], rows=400)
        run_for(engine, 0.2)
        assert engine.scope.read().columns[0] == pytest.approx(np.full(400, 0.5), abs=STEP_V)

    def test_it_frees_a_stuck_shaft(self, make_engine: MakeEngine) -> None:
        """What it is for: 3 counts of error are too few volts for the friction, with dither the error goes."""
        plant = TorqueDrive(coulomb_nm=0.02, viscous_nm_s_per_rev=0.01)
        errors = []
        for amplitude in (0.0, 0.2):
            engine = make_engine(plant)
            open_range(engine)
            engine.set_gains(0, Gains(5.0, 0.0, 30.0))
            engine.set_dither(0, amplitude_v=amplitude, half_period_samples=2)
            engine.start_profile(0, plan_preset(0.0, 0.0, 10.0, 1000.0, 1e5, 1e5))
            run_for(engine, 2.0)
            errors.append(abs(engine.position_error(0)))
        assert errors[0] >= 3
        assert errors[1] <= 1


class TestGainChange:
    """A change of gains takes effect with one sample, and the integral term goes over it as it is."""

    @pytest.mark.parametrize("moving", [False, True])
    def test_no_step_from_the_integral(self, make_engine: MakeEngine, moving: bool) -> None:
        engine = make_engine()
        open_range(engine)
        engine.set_output(0, offset_v=0.5)
        engine.set_gains(0, Gains(2.0, 20.0, 5.0))
        if moving:
            engine.start_profile(0, plan_continuous(0.0, 0.0, 8000.0, 4e4, 4e4))
        run_for(engine, 3.0)
        names = ("term_p", "term_i", "term_v", "control_v")
        error = Source("commanded_counts", 0, "feedback_counts")
        engine.scope.arm([*(Source(name, 0) for name in names), error], rows=400)
        run_for(engine, 200 * SERVO_S)
        held = engine.terms(0)["I"]
        assert abs(held) > 0.1
        new = Gains(6.0, 80.0, 1.0)
        engine.set_gains(0, new)
        run_for(engine, 0.1)
        p, i, v, control, e = (np.asarray(column, float) for column in engine.scope.read().columns)
        at = int(np.argmax(np.abs(p - 2e-3 * e) > 1e-12)) if np.any(np.abs(p - 2e-3 * e) > 1e-12) else 200
        # The state moves on by SGI e Ts of this one sample and by nothing else.
        assert abs(i[at] - held) <= 80e-3 * (abs(e[at]) + 1) * SERVO_S + 1e-12
        steps = np.abs(np.diff(i))
        assert float(np.max(steps)) <= 80e-3 * float(np.max(np.abs(e))) * SERVO_S + 1e-12
        # What the output jumps by is what the new P and V terms differ by.
        assert control == pytest.approx(p + i + v + 0.5, abs=1e-9)

    def test_sgi_zero_drops_the_integral_and_a_lower_sgilim_cuts_it(self, make_engine: MakeEngine) -> None:
        engine = make_engine()
        open_range(engine)
        engine.set_output(0, offset_v=0.5)
        wound = Gains(2.0, 20.0)
        engine.set_gains(0, wound)
        run_for(engine, 3.0)
        assert engine.terms(0)["I"] == pytest.approx(-0.5, abs=0.01)
        engine.set_gains(0, replace(wound, integral_limit_v=0.125))
        run_for(engine, 2 * SERVO_S)
        assert engine.terms(0)["I"] == -0.125
        engine.set_gains(0, Gains(2.0))
        run_for(engine, 2 * SERVO_S)
        assert engine.terms(0)["I"] == 0.0


class TestDriveHandOver:
    def test_with_the_integrator_wound(self, make_engine: MakeEngine) -> None:
        """DRIVE0 with 0.5 V in the integrator, DRIVE1 a second later: it begins empty and where the shaft is."""
        engine = make_engine()
        open_range(engine)
        engine.set_output(0, offset_v=0.5)
        engine.set_gains(0, Gains(2.0, 20.0))
        run_for(engine, 3.0)
        assert abs(engine.terms(0)["I"]) > 0.4
        engine.disable(0)
        run_for(engine, 1.0)
        engine.set_output(0, offset_v=0.0)
        run_for(engine, 0.01)
        before = engine.encoder_position(0)
        engine.enable(0)
        engine.scope.arm([Source("dac_v", 0), Source("commanded_counts", 0, "feedback_counts")], rows=1000)
        run_for(engine, 0.5)
        volts, error = engine.scope.read().columns
        assert float(np.max(np.abs(volts))) <= STEP_V
        assert not np.any(error)
        assert engine.encoder_position(0) == before

    def test_while_coasting(self, make_engine: MakeEngine) -> None:
        """The command takes over at the last sample: the error starts at one sample's travel and the loop brakes the
        shaft from there, as the simulated loop with the shaft at speed would; nothing jumps."""
        engine = make_engine()
        open_range(engine)
        engine.start_profile(0, plan_continuous(0.0, 0.0, 40_000.0, 4e5, 4e5))
        run_for(engine, 2.0)
        engine.disable(0)
        run_for(engine, 0.01)
        speed = engine.true_velocity_rev_s(0) * COUNTS_PER_REV
        assert speed > 20_000
        engine.enable(0)
        engine.scope.arm([Source("dac_v", 0), Source("commanded_counts", 0, "feedback_counts")], rows=3000)
        run_for(engine, 1.0)
        volts, error = engine.scope.read().columns
        assert error[0] == pytest.approx(-speed * SERVO_S, abs=2)
        assert float(volts[0]) == pytest.approx(0.5e-3 * error[0], abs=STEP_V)
        assert abs(engine.position_error(0)) <= 1
        assert engine.commanded_velocity(0) == 0.0


def test_frequency_response_of_the_model_is_that_of_its_steps() -> None:
    """The two independent references agree with each other: z-transform and simulation without visible quantisers."""
    model = LoopModel(FREE, Gains(2.0, 0.0, 5.0), SERVO_S)
    positions, _ = model.step(4000, 4096)
    impulse = np.diff(positions * COUNTS_PER_REV / 4000, prepend=0.0)
    frequencies = np.fft.rfftfreq(4096, SERVO_S)[1:40]
    assert np.fft.rfft(impulse)[1:40] == pytest.approx(closed_loop_response(model, frequencies), abs=0.003)

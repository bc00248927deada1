"""The tuning guide's seven documented steps on the demonstration axis, with the commands of the guide.

OEM6250 Installation Guide p. 50 and 6250 User Guide PDF p. 48 describe a 100-count step (A999 AD999 V30 D100) for seven
pairs of SGP and SGV in words; the bounds that stand for the words are inferred. The chatter is a limit cycle of one or
two encoder counts: it depends on where between two counts the shaft starts, so every step is run from several places.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from emulator.emulator import Emulator
from emulator.machine import Machine
from emulator.tuning.measures import measure_step

MACHINE = Path(__file__).parents[2] / "docs" / "tuning" / "demonstration.toml"
COUNTS_PER_REV = 4000
STEP = 100
SECONDS = 1.5
RESTING_FROM_S = 1.0
PHASES = (0.03, 0.28, 0.53, 0.78, 0.97)

SLOW, SLIGHTLY_UNDER_DAMPED, WELL_DAMPED = (2, 0), (15, 0), (15, 2)
CHATTERING, STILL_CHATTERING, NOT_REDUCED_MUCH = (105, 2), (105, 2.6), (105, 2.3)
CHATTER_GONE = (85, 2.3)
CHATTERING_STEPS = (CHATTERING, STILL_CHATTERING, NOT_REDUCED_MUCH)
STEPS = (SLOW, SLIGHTLY_UNDER_DAMPED, WELL_DAMPED, *CHATTERING_STEPS, CHATTER_GONE)


class Response(NamedTuple):
    """What a step of the scenario showed: percent, seconds, volts."""

    overshoot_percent: float
    time_to_90_s: float
    ripple_v: float


@cache
def response(gains: tuple[float, float], phase: float) -> Response:
    """The guide's move with a pair of SGP and SGV, the shaft starting at `phase` of a count."""
    machine = Machine.load(MACHINE)
    axis = replace_phase(machine, phase)
    emulator = Emulator(axis)
    unit = emulator.unit()
    unit.send(f"SGP{gains[0]}:SGV{gains[1]}:DRIVE1:A999:AD999:V30:D{STEP}\r".encode())
    emulator.advance(0.1)
    signals = ["axis1.position.commanded", "axis1.position.true", "axis1.dac"]
    unit.scope.record(signals, seconds=SECONDS)
    unit.send(b"GO1\r")
    emulator.advance(SECONDS + 0.01)
    recording = unit.scope.read()
    commanded, revs, output_v = (recording[name] for name in signals)
    # The true position, as on an instrument at the shaft: the encoder shows no part of a count.
    actual = revs * COUNTS_PER_REV
    measures = measure_step(recording.time_s, commanded, actual, output_v, start=0.0, setpoint=STEP)
    resting = recording.time_s - recording.time_s[0] >= RESTING_FROM_S
    return Response(measures.overshoot_percent, measures.time_to_90_s, float(np.ptp(output_v[resting])))


def replace_phase(machine: Machine, phase: float) -> Machine:
    import msgspec

    encoder = msgspec.structs.replace(machine.axis1.encoder, phase=phase)
    return msgspec.structs.replace(machine, axis1=msgspec.structs.replace(machine.axis1, encoder=encoder))


@pytest.mark.parametrize("phase", PHASES)
class TestScenario:
    """One test a sentence of the guide."""

    def test_1_slow(self, phase: float) -> None:
        assert response(SLOW, phase).overshoot_percent < 1.0
        assert response(SLOW, phase).time_to_90_s >= 3 * response(SLIGHTLY_UNDER_DAMPED, phase).time_to_90_s

    def test_2_slightly_under_damped(self, phase: float) -> None:
        assert 2.0 <= response(SLIGHTLY_UNDER_DAMPED, phase).overshoot_percent <= 15.0
        assert response(SLIGHTLY_UNDER_DAMPED, phase).ripple_v == 0.0

    def test_3_well_damped(self, phase: float) -> None:
        under, well = response(SLIGHTLY_UNDER_DAMPED, phase), response(WELL_DAMPED, phase)
        assert well.overshoot_percent < under.overshoot_percent - 0.4
        assert well.ripple_v == 0.0

    def test_4_overshoot_significant_and_chattering(self, phase: float) -> None:
        assert (
            response(CHATTERING, phase).overshoot_percent > 3 * response(SLIGHTLY_UNDER_DAMPED, phase).overshoot_percent
        )
        assert 0.15 < response(CHATTERING, phase).ripple_v < 1.0

    def test_5_overshoot_reduced_chatter_still_pronounced(self, phase: float) -> None:
        assert response(STILL_CHATTERING, phase).overshoot_percent < response(CHATTERING, phase).overshoot_percent
        assert 0.15 < response(STILL_CHATTERING, phase).ripple_v < 1.0

    def test_6_chattering_not_reduced_much(self, phase: float) -> None:
        assert 0.15 < response(NOT_REDUCED_MUCH, phase).ripple_v < 1.0

    def test_7_chatter_gone_overshoot_still_there(self, phase: float) -> None:
        assert response(CHATTER_GONE, phase).ripple_v < 0.05
        assert response(CHATTER_GONE, phase).overshoot_percent > response(WELL_DAMPED, phase).overshoot_percent
        assert response(CHATTER_GONE, phase).overshoot_percent < response(CHATTERING, phase).overshoot_percent

"""What turns an encoder, from the machine file into the engine."""

from __future__ import annotations

import pytest

from emulator.controller.build import axis_hardware
from emulator.engine import EncoderMotion
from emulator.machine import Machine, MachineError


def motion_of(text: str) -> EncoderMotion | None:
    machine = Machine.parse(f"[axis2.encoder_motion]\n{text}" if text else "")
    return axis_hardware(machine.axis2).motion


@pytest.mark.parametrize(
    ("text", "motion"),
    [
        ("", None),
        ('kind = "shaft"', None),
        ('kind = "driven"', EncoderMotion()),
        ('kind = "constant"\nvelocity_counts_s = -500.0\nstart_s = 2.0', EncoderMotion(-500.0, start_s=2.0)),
        ('kind = "ramp"\nvelocity_counts_s = 500.0\nramp_s = 4.0', EncoderMotion(500.0, ramp_s=4.0)),
        (
            'kind = "sine"\nswing_counts = 30.0\nfrequency_hz = 2.5\nvelocity_counts_s = 70.0',
            EncoderMotion(70.0, 70.0, swing_counts=30.0, frequency_hz=2.5),
        ),
    ],
)
def test_each_kind_reaches_the_engine(text: str, motion: EncoderMotion | None) -> None:
    assert motion_of(text) == motion


@pytest.mark.parametrize(
    ("text", "key", "allowed"),
    [
        ('kind = "spring"', "kind", "'constant'"),
        ("velocity_counts_s = 3", "kind", "'shaft'"),
        ('kind = "constant"\nvelocity_counts_s = 1e10', "velocity_counts_s", "<= 1,000,000,000"),
        ('kind = "ramp"\nramp_s = -1', "ramp_s", ">= 0"),
        ('kind = "sine"\nfrequency_hz = inf', "frequency_hz", "<= 10,000"),
        ('kind = "constant"\nvelocity_counts_s = nan', "velocity_counts_s", ">= -1"),
        ('kind = "driven"\nramp_s = 1', "ramp_s", "no keys besides kind"),
    ],
)
def test_what_cannot_be_is_one_line(text: str, key: str, allowed: str) -> None:
    with pytest.raises(MachineError) as failure:
        Machine.parse(f"[axis2.encoder_motion]\n{text}", name="bench.toml")
    assert str(failure.value).startswith(f"bench.toml: axis2.encoder_motion.{key}: ")
    assert allowed in failure.value.allowed
    assert "\n" not in str(failure.value)


def test_the_measurement_of_masters_is_a_table_of_its_own() -> None:
    machine = Machine.parse('[following]\npredictor = "one_sample"\nfilter_order = 2')
    assert (machine.following.predictor, machine.following.filter_order) == ("one_sample", 2)
    with pytest.raises(MachineError, match=r"following\.filter_order"):
        Machine.parse("[following]\nfilter_order = 3")

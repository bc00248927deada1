"""The axis under test: a unit of its own for every try, driven with the commands one types and looked at with the
scope.

Each response begins with a unit just powered up, from the same place and at rest, so that tries compare whatever became
of the one before, and a list of gains gives the same table in any order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from emulator.emulator import Emulator, Unit
from emulator.engine import Gains
from emulator.engine.trace import Source, Trace
from emulator.machine import Machine
from emulator.tuning.gains import gain_commands, tidy
from emulator.tuning.measures import Floats, StepMeasures, measure_step

NS_PER_S = 1_000_000_000

SETTING_UP_S = 1.0
"""Time for the commands to act and the axis to come to rest before the move, s (design choice)."""

LATENCY_S = 0.05
"""Most that passes between sending GO and the first motion, s (design choice)."""

CRUISE_COMMANDS = ("A100", "AD100", "V5")
"""The move by which feedforward is set: half a second at 5 rev/s, reached in 50 ms. The guide's page on feedforward is
missing; assumed, so that the lag stays far below SMPER."""
CRUISE_REVOLUTIONS = 2.75
CRUISE_S = 0.7


class RigError(RuntimeError):
    """The unit refused to do what was asked, or has no axis to tune; the message is one line."""


class StepProfile(NamedTuple):
    """The commands of the step and its length: the guide's, A999 AD999 V30 D100 (OEM6250 Installation Guide p. 48)."""

    commands: tuple[str, ...] = ("A999", "AD999", "V30")
    distance_counts: int = 100


@dataclass(frozen=True, slots=True)
class StepResponse:
    """One step as recorded at servo rate: times from the start of the move, s; positions in reported counts."""

    gains: Gains
    times_s: Floats
    commanded_counts: Floats
    actual_counts: Floats
    output_v: Floats
    measures: StepMeasures
    tripped: bool
    """Its position error exceeded SMPER."""
    step_counts: int


@dataclass(frozen=True, slots=True)
class Tracking:
    """A move at constant velocity: mean position error (commanded less actual) in its two parts."""

    cruise_error_counts: float
    acceleration_error_counts: float
    velocity_counts_s: float
    acceleration_counts_s2: float
    peak_output_v: float
    tripped: bool


class Rig:
    """One axis of a machine, ready to be tried."""

    def __init__(
        self,
        machine: Machine,
        axis_index: int,
        *,
        profile: StepProfile | None = None,
        duration_s: float = 1.0,
        settle_counts: float | None = None,
    ) -> None:
        self.machine, self.axis_index = machine, axis_index
        self.profile = profile or StepProfile()
        self._duration_s, self._settle_counts = duration_s, settle_counts
        self._lead = "," * axis_index

    def step(self, gains: Gains) -> StepResponse:
        """The response to the step; RigError if the unit refuses."""
        distance = self.profile.distance_counts
        emulator = self._ready(gains, self.profile.commands, distance)
        fields = ("commanded_counts", "feedback_counts")
        sources = [*(Source(name, self.axis_index, "offset_counts") for name in fields), self._source("dac_v")]
        trace = self._move(emulator, sources, self._duration_s)
        commanded, actual, output = (np.asarray(column, np.float64) for column in trace.columns)
        first = max(int((commanded != commanded[0]).argmax()) - 1, 0)
        times_s = (trace.times_ns[first:] - trace.times_ns[first]) / NS_PER_S
        begun = commanded[0]
        measures = measure_step(
            times_s,
            commanded[first:],
            actual[first:],
            output[first:],
            start=begun,
            setpoint=begun + distance,
            settle_counts=self._settle_counts,
        )
        tripped = not emulator.units[0].controller.engine.is_enabled(self.axis_index)
        return StepResponse(
            gains, times_s, commanded[first:], actual[first:], output[first:], measures, tripped, distance
        )

    def cruise(self, gains: Gains) -> Tracking:
        """How well the axis follows a move at constant velocity; RigError if the unit refuses."""
        resolution = self.machine_counts_per_rev
        emulator = self._ready(gains, CRUISE_COMMANDS, round(CRUISE_REVOLUTIONS * resolution))
        names = ("commanded_counts", "feedback_counts", "commanded_velocity", "commanded_acceleration", "dac_v")
        trace = self._move(emulator, [self._source(name) for name in names], CRUISE_S)
        commanded, actual, velocity, acceleration, output = (np.asarray(c, np.float64) for c in trace.columns)
        error = commanded - actual
        return Tracking(
            cruise_error_counts=_late_mean(error, (acceleration == 0.0) & (velocity > 0.0)),
            acceleration_error_counts=_late_mean(error, acceleration > 0.0),
            velocity_counts_s=float(velocity.max()),
            acceleration_counts_s2=float(acceleration.max()),
            peak_output_v=float(np.abs(output).max()),
            tripped=not emulator.units[0].controller.engine.is_enabled(self.axis_index),
        )

    @property
    def machine_counts_per_rev(self) -> int:
        """ERES of the axis at power-up."""
        return Emulator(self.machine).units[0].controller.settings.integer("ERES", self.axis_index)

    def commands_for(self, gains: Gains) -> list[str]:
        """The commands that set the gains."""
        return gain_commands(gains, self.axis_index)

    def _source(self, field: str) -> Source:
        return Source(field, self.axis_index)

    def _ready(self, gains: Gains, profile: Sequence[str], distance_counts: int) -> Emulator:
        """A unit powered up with the gains set, the drive on and the move loaded."""
        emulator = Emulator(self.machine)
        unit = emulator.units[0]
        emulator.advance(SETTING_UP_S)
        unit.read()
        with_axis = [_for_axis(command, self._lead) for command in (*profile, f"D{distance_counts}", "MA0", "MC0")]
        self._send(emulator, ["SCALE0", *self.commands_for(gains), *with_axis, f"DRIVE{self._mask}"])
        emulator.advance(SETTING_UP_S)
        return emulator

    @property
    def _mask(self) -> str:
        return "X" * self.axis_index + "1"

    def _move(self, emulator: Emulator, sources: Sequence[Source], duration_s: float) -> Trace:
        """Start the loaded move with the scope on; the recording lasts `duration_s` and a little more.

        An axis whose position error has already shut it down stays where it is.
        """
        engine = emulator.units[0].controller.engine
        rows = round((duration_s + LATENCY_S) * NS_PER_S) // engine.rates.servo_ns
        engine.scope.arm(sources, rows=rows)
        if engine.is_enabled(self.axis_index):
            self._send(emulator, [f"GO{self._mask}"])
        while engine.scope.running:
            emulator.advance(LATENCY_S)
        return engine.scope.read()

    def _send(self, emulator: Emulator, commands: Sequence[str]) -> None:
        unit = emulator.units[0]
        for command in commands:
            unit.send(f"{command}\r".encode())
            emulator.advance(LATENCY_S / 2 if not command.startswith("GO") else 0.0)
            _check_reply(unit, command)


def _for_axis(command: str, lead: str) -> str:
    """`A999` for axis 1, `A,999` for axis 2, as the guide has it."""
    digits = len(command) - len(command.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ"))
    return command[:digits] + lead + command[digits:]


def _check_reply(unit: Unit, command: str) -> None:
    """RigError if the unit complained: nothing that is sent here has any other reply."""
    for line in unit.read().decode("latin-1").splitlines():
        if line.strip().startswith("*"):
            raise RigError(f"the unit refuses {command}: {line.strip().lstrip('*')}")


def _late_mean(values: Floats, during: np.ndarray) -> float:
    """Mean over the second half of a part of a recording."""
    part = values[during]
    return float(part[len(part) // 2 :].mean()) if len(part) else 0.0


def describe(profile: StepProfile) -> str:
    """The step in the commands' words."""
    return " ".join((*profile.commands, f"D{tidy(profile.distance_counts)}"))

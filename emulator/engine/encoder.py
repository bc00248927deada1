"""What the unit believes about position: the encoder and its input, the analogue sensor, and which of them counts.

They are kept apart from the plant because the machine's true position and the position the unit believes in are two
different things, and most of what goes wrong on a real machine lies between them: an encoder that slips or is wired the
wrong way round, an input that is too slow, noise, play between motor and load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from .encoder_motion import drive_encoder
from .kernels import Record, kernel, seldom
from .plants import drag_load, keep_in_world, place_of_load

ANI_COUNTS_PER_VOLT = 819.2
"""14 bits over +-10 V (6250 User Guide PDF p. 76 names 14 bits; the range is assumed, medium confidence)."""

ANI_HIGHEST_COUNT = 8191
ANI_LOWEST_COUNT = -8192

OPEN_LOOP = 0
ENCODER_SOURCE = 1
ANI_SOURCE = 2
"""Codes of SFB (6K configurations; the 6250's own are assumed)."""

NOISE_FACTOR = 48271
NOISE_MODULUS = 2147483647
"""The noise's random sequence, state * factor % modulus, of full period (Park and Miller); the product fits 63 bits."""

EASY_STEP_COUNTS = 1e6
"""A larger step in one servo sample is looked at more closely even without a limit (design choice): at a million counts
a sample it takes decades to leave 64 bits."""

LARGEST_NOISE_COUNTS = 1e6
HIGHEST_COUNTS_PER_REV = 100_000_000
LARGEST_SENSOR_V = 1e6
"""Bounds (design choice) that keep counts within 64 bits up to the end of the world."""


class EncoderWiring(IntEnum):
    """How an encoder is connected, as the sign of what arrives."""

    NORMAL = 1
    REVERSED = -1
    OPEN = 0


@dataclass(frozen=True, slots=True)
class EncoderTraits:
    """Where an encoder sits, and what keeps it from being ideal.

    `noise_counts_rms` is jitter of its position, drawn anew every servo sample: near a normal distribution, never
    beyond three times its rms value. `max_rate_counts_s` is what the input can follow, counts beyond it are lost
    (told apart to within one count a servo sample; a rate below that means one count a sample).
    """

    on_load: bool = False
    """It sits on the load, behind coupling and backlash, and not on the motor's shaft."""
    noise_counts_rms: float = 0.0
    noise_seed: int = 0
    max_rate_counts_s: float = math.inf

    def __post_init__(self) -> None:
        if not 0.0 <= self.noise_counts_rms <= LARGEST_NOISE_COUNTS:
            raise ValueError(f"noise_counts_rms must be 0 to {LARGEST_NOISE_COUNTS:g}, not {self.noise_counts_rms}")
        if not self.max_rate_counts_s > 0.0:
            raise ValueError(f"max_rate_counts_s must be above 0, not {self.max_rate_counts_s}")

    def fields(self, axis_index: int) -> dict[str, float]:
        """Fields of the axis record at power-up."""
        return {
            "encoder_sign": 1,
            "encoder_polarity": 1,
            "encoder_wiring": EncoderWiring.NORMAL,
            "encoder_on_load": self.on_load,
            "encoder_noise": self.noise_counts_rms,
            "noise_state": noise_state(self.noise_seed, axis_index),
        }

    def step_fields(self, period_s: float, *, load_apart: bool, driven: bool = False) -> dict[str, float]:
        """Fields of the axis record that depend on the servo period, on the plant, and on what turns the encoder."""
        limit = max(1.0, self.max_rate_counts_s * period_s)
        simple = not load_apart and not driven and self.noise_counts_rms == 0.0
        return {
            "encoder_step_limit": limit,
            "encoder_easy_step": min(limit + 1.0, EASY_STEP_COUNTS) if simple else -1.0,
        }


def noise_state(seed: int, axis_index: int) -> int:
    """Where an axis's random sequence begins; axes with the same seed have different ones."""
    state = (seed * 1_000_003 + axis_index * 7_919) % (NOISE_MODULUS - 1) + 1
    # Neighbouring seeds give neighbouring states, and the first numbers of neighbouring states are alike.
    return state * pow(NOISE_FACTOR, 1000, NOISE_MODULUS) % NOISE_MODULUS


@dataclass(frozen=True, slots=True)
class AnalogSensor:
    """A position sensor at an ANI feedback input: its voltage with the load at 0 rev, and what a revolution adds."""

    volts_at_zero: float = 0.0
    volts_per_rev: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("volts_at_zero", self.volts_at_zero), ("volts_per_rev", self.volts_per_rev)):
            if not abs(value) <= LARGEST_SENSOR_V:
                raise ValueError(f"{name} must be -{LARGEST_SENSOR_V:g} to {LARGEST_SENSOR_V:g}, not {value}")

    def fields(self) -> dict[str, float]:
        """Fields of the axis record."""
        return {"ani_rest_v": self.volts_at_zero, "ani_volts_per_rev": self.volts_per_rev}


@kernel
def next_uniform(axis: Record) -> float:
    """The next number of the noise's sequence, evenly spread between 0 and 1."""
    state = axis["noise_state"] * NOISE_FACTOR % NOISE_MODULUS
    axis["noise_state"] = state
    return float(state / NOISE_MODULUS)


@kernel
def encoder_noise(axis: Record) -> float:
    """Noise of this sample, counts: three uniform numbers added up, whose standard deviation is a half."""
    total = next_uniform(axis)
    total += next_uniform(axis)
    total += next_uniform(axis)
    return float((total - 1.5) * 2.0 * axis["encoder_noise"])


@kernel
def counts_taken(axis: Record, moved: int) -> int:
    """How many of more counts than the input can follow in a sample it takes, fractions carried over."""
    credit = axis["encoder_credit"] + axis["encoder_step_limit"]
    taken = math.floor(credit)
    axis["encoder_credit"] = credit - taken
    return taken if moved > 0 else -taken


@kernel
def count_to(axis: Record, reading: int) -> None:
    """Take the counts up to a reading into the encoder position, with the sign in force."""
    moved = reading - axis["encoder_reading"]
    axis["encoder_reading"] = reading
    # A count more than the limit is what a speed below it makes of a sample now and then.
    if abs(moved) > axis["encoder_step_limit"] + 1.0:
        moved = counts_taken(axis, moved)
    axis["encoder_counts"] += axis["encoder_sign"] * moved


@seldom
def read_with_care(axis: Record, now_ns: int) -> None:
    """Read an encoder that has moved far, is noisy, is driven by something else, or belongs to a machine whose load is
    not where its motor is."""
    keep_in_world(axis)
    if axis["load_apart"] != 0:
        drag_load(axis)
    if axis["encoder_driven"] != 0:
        drive_encoder(axis, now_ns)
        counts = axis["driven_counts"] + axis["encoder_phase"]
    else:
        position = place_of_load(axis) if axis["encoder_on_load"] != 0 else axis["true_position"]
        counts = position * axis["counts_per_rev"] + axis["encoder_phase"]
    if axis["encoder_noise"] > 0.0:
        counts += encoder_noise(axis)
    count_to(axis, math.floor(counts))


@kernel
def read_encoder(axis: Record, now_ns: int) -> int:
    """Take the encoder's counts since the last sample into the encoder position, and return that.

    What is out of the ordinary hides behind one comparison, so that an ordinary axis pays for nothing else.
    """
    counts = axis["true_position"] * axis["counts_per_rev"] + axis["encoder_phase"]
    if abs(counts - axis["encoder_reading"]) < axis["encoder_easy_step"]:
        reading = math.floor(counts)
        position = axis["encoder_counts"] + axis["encoder_sign"] * (reading - axis["encoder_reading"])
        axis["encoder_counts"] = position
        axis["encoder_reading"] = reading
        return int(position)
    read_with_care(axis, now_ns)
    return int(axis["encoder_counts"])


@seldom
def read_ani(axis: Record) -> None:
    """Take a reading of the ANI feedback input's converter: whole counts of the voltage, held at the range's ends, with
    the sign in force."""
    volts = axis["ani_rest_v"] + axis["ani_volts_per_rev"] * place_of_load(axis)
    reading = math.floor(volts * ANI_COUNTS_PER_VOLT)
    if reading > ANI_HIGHEST_COUNT:
        reading = ANI_HIGHEST_COUNT
    if reading < ANI_LOWEST_COUNT:
        reading = ANI_LOWEST_COUNT
    axis["ani_counts"] = axis["ani_sign"] * reading


@kernel
def take_feedback(axis: Record, now_ns: int) -> int:
    """Read the sensors, and return the feedback position: what the selected one shows. In open loop that is the encoder
    (assumed)."""
    axis["previous_feedback_counts"] = axis["feedback_counts"]
    feedback_counts = read_encoder(axis, now_ns)
    if axis["ani_fitted"] != 0:
        read_ani(axis)
    if axis["feedback_source"] == ANI_SOURCE:
        feedback_counts = axis["ani_counts"]
    axis["feedback_counts"] = feedback_counts
    return int(feedback_counts)

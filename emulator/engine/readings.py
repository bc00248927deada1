"""What can be read of an engine's axes between two runs.

A read is one or two words of the axis's record, cheap enough for a host that polls as fast as it can. Positions are
reported counts (after `PSET`), velocities counts per second; `axis_index` counts from 0.
"""

from __future__ import annotations

from .encoder import ANI_COUNTS_PER_VOLT
from .layout import AXIS, word_of
from .memory import Memory
from .status import SETTLING


def axis_word(name: str) -> int:
    """Place of a field in the axis record."""
    return word_of(AXIS, name)


COMMANDED, FEEDBACK, OFFSET = (axis_word(name) for name in ("commanded_counts", "feedback_counts", "offset_counts"))
ENCODER, ENCODER_OFFSET = axis_word("encoder_counts"), axis_word("encoder_offset_counts")
ANI, ANI_OFFSET = axis_word("ani_counts"), axis_word("ani_offset_counts")
ACTIVE, ENABLED = axis_word("profile_active"), axis_word("enabled")
SETTLING_TIME = axis_word("settling_ns")
VELOCITY, ACCELERATION = axis_word("commanded_velocity"), axis_word("commanded_acceleration")
ACTUAL_VELOCITY, DAC = axis_word("actual_velocity"), axis_word("dac_v")
TRUE_POSITION, TRUE_VELOCITY = axis_word("true_position"), axis_word("true_velocity")
LOAD_POSITION, LOAD_APART = axis_word("load_position"), axis_word("load_apart")

CAPTURED = axis_word("captured_counts")
READING, INDEX_READING, COUNTS_PER_REV = (
    axis_word(name) for name in ("encoder_reading", "index_reading", "counts_per_rev")
)

TERMS = {
    "P": axis_word("term_p"),
    "I": axis_word("term_i"),
    "V": axis_word("term_v"),
    "VF": axis_word("term_vf"),
    "AF": axis_word("term_af"),
    "offset": axis_word("offset_v"),
    "output": axis_word("control_v"),
}

NS_PER_MS = 1_000_000
_SETTLING, _ANI_SIGN = axis_word("settling"), axis_word("ani_sign")


class DriveShutDown(RuntimeError):
    """A move was started on an axis whose drive is off."""


class AxisReadings:
    """The reading half of `Engine`."""

    def __init__(self, memory: Memory) -> None:
        self._ints = [words.ints for words in memory.axis]
        self._floats = [words.floats for words in memory.axis]

    def is_enabled(self, axis_index: int) -> bool:
        """Whether the drive is on."""
        return bool(self._ints[axis_index][ENABLED])

    def is_moving(self, axis_index: int) -> bool:
        """Whether a profile is running or waits for its first trajectory update."""
        return bool(self._ints[axis_index][ACTIVE])

    def is_settling(self, axis_index: int) -> bool:
        """Whether a profile has ended (target zone enabled) and the axis is neither in the zone nor timed out."""
        return self._ints[axis_index][_SETTLING] == SETTLING

    def settling_time_ms(self, axis_index: int) -> int:
        """Last time from the end of a profile to the target zone (TSTLT), ms, rounded down.

        Grows once more if the axis leaves the zone and comes back within the time-out.
        """
        return self._ints[axis_index][SETTLING_TIME] // NS_PER_MS

    def commanded_position(self, axis_index: int) -> int:
        """Commanded position (TPC), counts."""
        ints = self._ints[axis_index]
        return ints[COMMANDED] - ints[OFFSET]

    def encoder_position(self, axis_index: int) -> int:
        """Encoder position (TPE), counts."""
        ints = self._ints[axis_index]
        return ints[ENCODER] - ints[ENCODER_OFFSET]

    def ani_position(self, axis_index: int) -> int:
        """Position of the ANI feedback input (TANI), counts; 0 without the option."""
        ints = self._ints[axis_index]
        return ints[ANI] - ints[ANI_OFFSET]

    def ani_volts(self, axis_index: int) -> float:
        """Voltage at the ANI feedback input as converted, V; 0 without the option."""
        ints = self._ints[axis_index]
        return ints[_ANI_SIGN] * ints[ANI] / ANI_COUNTS_PER_VOLT

    def feedback_position(self, axis_index: int) -> int:
        """Position of the selected feedback source (TFB), counts."""
        ints = self._ints[axis_index]
        return ints[FEEDBACK] - ints[OFFSET]

    def position_error(self, axis_index: int) -> int:
        """Commanded less actual position (TPER), counts."""
        ints = self._ints[axis_index]
        return ints[COMMANDED] - ints[FEEDBACK]

    def commanded_velocity(self, axis_index: int) -> float:
        """Velocity of the profile at the last trajectory update, counts/s."""
        return self._floats[axis_index][VELOCITY]

    def commanded_acceleration(self, axis_index: int) -> float:
        """Acceleration of the profile at the last trajectory update, counts/s2."""
        return self._floats[axis_index][ACCELERATION]

    def actual_velocity(self, axis_index: int) -> float:
        """Feedback difference over the last system update period, counts/s (the period is assumed)."""
        return self._floats[axis_index][ACTUAL_VELOCITY]

    def dac_volts(self, axis_index: int) -> float:
        """Voltage at the analogue output (TDAC), V."""
        return self._floats[axis_index][DAC]

    def terms(self, axis_index: int) -> dict[str, float]:
        """Terms of the control law in volts: P, I, V, VF, AF, offset, and their limited sum as output."""
        floats = self._floats[axis_index]
        return {name: floats[word] for name, word in TERMS.items()}

    def captured_position(self, axis_index: int) -> int:
        """Feedback position at the last captured home edge or index pulse, counts."""
        ints = self._ints[axis_index]
        return ints[CAPTURED] - ints[OFFSET]

    def index_active(self, axis_index: int) -> bool:
        """Whether the encoder stands on its index (Z) pulse, one count wide."""
        ints = self._ints[axis_index]
        return (ints[READING] - ints[INDEX_READING]) % self._floats[axis_index][COUNTS_PER_REV] == 0

    def true_position_rev(self, axis_index: int) -> float:
        """Where the motor's shaft (or the piston) really is, rev."""
        return self._floats[axis_index][TRUE_POSITION]

    def load_position_rev(self, axis_index: int) -> float:
        """Where the load really is, behind coupling and backlash, rev."""
        return self._floats[axis_index][LOAD_POSITION if self._ints[axis_index][LOAD_APART] else TRUE_POSITION]

    def true_velocity_rev_s(self, axis_index: int) -> float:
        """How fast the shaft really turns, rev/s."""
        return self._floats[axis_index][TRUE_VELOCITY]

"""What can be read of a slave and its master between two runs.

Master positions are counts since the master was assigned, after the sign of the assignment, as of the last system
update; slave positions are reported counts.
"""

from __future__ import annotations

import math

from .feedback_inputs import FeedbackInputs
from .following_status import FOLLOWING, HELD, following_status
from .readings import ACTIVE, COMMANDED, OFFSET, axis_word

_COUNTS, _CYCLE, _NUMBER = axis_word("master_counts"), axis_word("cycle_counts"), axis_word("cycle_number")
_MASTER_VELOCITY = axis_word("master_velocity")
_RATIO_COUNT, _RATIO_INDEX = axis_word("ratio_count"), axis_word("ratio_index")
_RATIO = axis_word("ratio_now")
_SHIFTING, _SHIFT = axis_word("shift_active"), axis_word("shift_counts")


class FollowingReadings(FeedbackInputs):
    """The reading half of `FollowingAxes`."""

    def is_following(self, axis_index: int) -> bool:
        """Whether the axis is the slave of a ratio move or a shift that is not over."""
        return self._ints[axis_index][ACTIVE] == FOLLOWING

    def is_shifting(self, axis_index: int) -> bool:
        """Whether a phase shift is under way."""
        return bool(self._ints[axis_index][_SHIFTING])

    def is_held(self, axis_index: int) -> bool:
        """Whether a ratio move waits for the master position it is to begin at."""
        return bool(self.following_status(axis_index) & HELD)

    def ratio_pieces_left(self, axis_index: int) -> int:
        """Pieces of the ratio move still to come after the one the master is in; 0 in the last."""
        ints = self._ints[axis_index]
        return ints[_RATIO_COUNT] - ints[_RATIO_INDEX] - 1

    def master_counts(self, axis_index: int) -> int:
        """Master travel since the master was assigned, whatever its cycles, counts."""
        return self._ints[axis_index][_COUNTS]

    def master_position(self, axis_index: int) -> int:
        """Position in the master cycle (TPMAS), counts."""
        return self._ints[axis_index][_CYCLE]

    def master_cycle_number(self, axis_index: int) -> int:
        """Master cycles finished since the last restart (TNMCY)."""
        return self._ints[axis_index][_NUMBER]

    def master_velocity(self, axis_index: int) -> float:
        """Velocity of the filtered master over two system updates (TVMAS), counts/s."""
        return self._floats[axis_index][_MASTER_VELOCITY]

    def slave_position(self, axis_index: int) -> int:
        """Commanded position of the slave (TPSLV), counts."""
        ints = self._ints[axis_index]
        return ints[COMMANDED] - ints[OFFSET]

    def shift_counts(self, axis_index: int) -> int:
        """Net shift (TPSHF), whole counts, halves upwards."""
        return math.floor(self._floats[axis_index][_SHIFT] + 0.5)

    def net_shift(self, axis_index: int) -> float:
        """Net shift, counts and what the profile of a shift under way makes of them."""
        return self._floats[axis_index][_SHIFT]

    def present_ratio(self, axis_index: int) -> float:
        """Ratio at the last system update, slave counts per master count; 0 for an axis that does not follow."""
        return self._floats[axis_index][_RATIO]

    def following_status(self, axis_index: int) -> int:
        """The FS word as far as the servo knows it, bit n of the manual = 1 << (n - 1); bits 6, 9, 13 are not its own.

        0 for an axis without a master. Bit 32 (`following_status.HELD`) is not of the manual.
        """
        return following_status(self._memory.axes[axis_index])

    def watch_following(self, axis_index: int, mask: int) -> None:
        """Report STATUS when any FS bit of `mask` differs from now, or from the last report; 0 ends the watch."""
        watched = self.following_status(axis_index) & mask
        self._write(axis_index, following_watch_mask=mask, watched_following=watched)

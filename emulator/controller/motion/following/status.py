"""FS, the Following status word of an axis: what the servo knows of the motion, and what is set.

An axis without a master reads all zero (settled from the Gemini sample, inferred).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.controller.motion.following.advance import advance_refusal
from emulator.controller.motion.following.assignment import has_master, is_following
from emulator.controller.motion.following.shifts import shift_refusal
from emulator.controller.words import WORD
from protocol.reply import word_bits
from protocol.status import FollowingStatus

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def following_status(controller: Controller, axis_index: int) -> str:
    """FS of one axis."""
    if not has_master(controller, axis_index):
        return word_bits(0, WORD)
    ready = controller.engine.is_enabled(axis_index)
    conditions = {
        FollowingStatus.FOLEN_ACTIVE: is_following(controller, axis_index),
        FollowingStatus.OK_TO_SHIFT: ready and not shift_refusal(controller, axis_index),
        FollowingStatus.MASTER_CYCLE_TRIGGER_PENDING: controller.trigger_functions.awaits_cycle(axis_index),
        FollowingStatus.GEARED_ADVANCE_UNDER_WAY: controller.ratio_moves.advancing(axis_index),
        FollowingStatus.OK_FOR_GEARED_ADVANCE: ready and not advance_refusal(controller, axis_index),
    }
    word = controller.engine.following_status(axis_index) & _OF_THE_MANUAL
    return word_bits(word | sum(bit.mask for bit, on in conditions.items() if on), WORD)


_OF_THE_MANUAL = sum(bit.mask for bit in FollowingStatus)
"""The servo has a bit of its own besides."""

SHIFT_AND_ADVANCE = frozenset({FollowingStatus.OK_TO_SHIFT, FollowingStatus.OK_FOR_GEARED_ADVANCE})
_THEY_DEPEND_ON = (
    FollowingStatus.SLAVE_IN_RATIO_MOVE.mask
    | FollowingStatus.RATIO_CHANGING.mask
    | FollowingStatus.AT_RATIO.mask
    | FollowingStatus.SHIFTING.mask
    | FollowingStatus.SHIFT_CONTINUOUS.mask
)


def bits_to_watch(bit: int | None) -> int:
    """The bits of the servo's own word that FS, or one bit of it, depends on."""
    if bit is None:
        return 0xFFFFFFFF
    return _THEY_DEPEND_ON if bit in SHIFT_AND_ADVANCE else 1 << (bit - 1)

"""What a FOLMAS value means, and which assignments a unit refuses (6000 PG p.195).  Pure functions.

A value names a master axis and what of it is counted: ``+21`` is encoder 2 as it counts, ``-24`` the commanded position
of axis 2 with its counts negated; 0 makes the axis no slave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from protocol.errors import INVALID_FOLMAS_SPECIFIED, CommandError


class MasterKind(IntEnum):
    """What of the master axis is counted: the second digit of FOLMAS."""

    ENCODER = 1
    ANI = 2
    COMMANDED = 4


SFB_OF_KIND = {MasterKind.ENCODER: 1, MasterKind.ANI: 2}
"""The SFB code under which a source is its axis's feedback."""


@dataclass(frozen=True, slots=True)
class Master:
    """The master of a slave axis; ``sign`` is +1, or -1 for counts negated before use."""

    axis_index: int
    kind: MasterKind
    sign: int


def read_master(value: int, *, axes: int, ani_fitted: bool) -> Master | None:
    """The master that a FOLMAS field names; None for 0.

    Raises:
        CommandError: INVALID FOLMAS SPECIFIED for an axis or a source this unit does not have (assumed for an ANI
            input that is not fitted).
    """
    if value == 0:
        return None
    axis, digit = divmod(abs(value), 10)
    kinds = {kind.value: kind for kind in MasterKind if ani_fitted or kind is not MasterKind.ANI}
    if not 1 <= axis <= axes or digit not in kinds:
        raise CommandError(INVALID_FOLMAS_SPECIFIED)
    return Master(axis - 1, kinds[digit], 1 if value > 0 else -1)


def check_masters(masters: Sequence[Master | None], feedback: Sequence[int]) -> None:
    """Refuse assignments that contradict themselves; ``feedback`` holds SFB of each axis.

    Raises:
        CommandError: INVALID FOLMAS SPECIFIED for a slave that would follow its own commanded position or its own
            selected feedback, and for two slaves that count different sources of one master axis.
    """
    for axis_index, master in enumerate(masters):
        if master is not None and follows_itself(axis_index, master, feedback[axis_index]):
            raise CommandError(INVALID_FOLMAS_SPECIFIED)
    sources = {(master.axis_index, master.kind) for master in masters if master is not None}
    if len({axis_index for axis_index, _ in sources}) < len(sources):
        raise CommandError(INVALID_FOLMAS_SPECIFIED)


def follows_itself(axis_index: int, master: Master, sfb: int) -> bool:
    """Whether a slave's master is its own commanded position or, under an SFB code, its own feedback."""
    own = master.axis_index == axis_index
    return own and (master.kind is MasterKind.COMMANDED or SFB_OF_KIND[master.kind] == sfb)

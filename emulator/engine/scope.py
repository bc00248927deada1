"""The scope: any words of the servo's records, written into a ring at servo rate.

Because every field of a record is one 8-byte word, a channel is nothing but the number of a word, and a row of the ring
a copy of those words taken at the end of a servo sample, whatever they mean: the kernel neither knows nor converts
anything, which is what keeps recording cheap. The words of the axis records are numbered one axis after the other.

Rows go round the ring until the trigger; from then on as many as were asked for after it are written, and the scope is
full. A condition acts when it comes to hold, not when it holds already, and not before the rows wanted ahead of the
trigger are there.
"""

from __future__ import annotations

from typing import NamedTuple

from .following_status import following_status
from .kernels import Floats, Record, Records, Words, kernel, seldom
from .status import axis_status
from .watches import holds

SCOPE_OFF = 0
SCOPE_WAITING = 1
SCOPE_TRIGGERED = 2

NEVER_FULL = -1
"""A count of rows that is not reached."""

NO_WORD = -1
"""Stands for "no word" where one may be left out."""


class ScopeArrays(NamedTuple):
    """What the scope works on: its record (one row), the words its channels copy, the words themselves, the ring.

    The channels of the unit's record come after those of the axes in each row.
    """

    records: Records
    channels: Words
    unit_channels: Words
    unit_words: Words
    unit_floats: Floats
    axis_words: Words
    axis_floats: Floats
    ring: Words


@kernel
def write_row(
    place: int, channels: Words, unit_channels: Words, unit_words: Words, axis_words: Words, ring: Words
) -> None:
    """Copy the channels' words into the row that begins at `place`. Both lists of channels end with NO_WORD."""
    # Ending at a mark rather than at a count keeps the compiler from making vector code for lists this short.
    channel = 0
    number = channels[0]
    while number != NO_WORD:
        ring[place] = axis_words[number]
        place += 1
        channel += 1
        number = channels[channel]
    channel = 0
    number = unit_channels[0]
    while number != NO_WORD:
        ring[place] = unit_words[number]
        place += 1
        channel += 1
        number = unit_channels[channel]


@kernel
def trigger_value(record: Record, words: Words, floats: Floats) -> float:
    """The value the trigger's condition looks at."""
    number = record["trigger_word"]
    minus = record["trigger_minus"]
    if record["trigger_is_float"] != 0:
        return float(floats[number])
    if record["trigger_mask"] != 0:
        return 1.0 if (words[number] & record["trigger_mask"]) != 0 else 0.0
    return float(words[number] - words[minus]) if minus != NO_WORD else float(words[number])


@kernel
def condition_came(record: Record, words: Words, floats: Floats) -> bool:
    """Whether the trigger's condition has come to hold since the row before."""
    value = trigger_value(record, words, floats)
    holding = 1 if holds(value, record["trigger_relation"], record["trigger_threshold"]) else 0
    came = holding != 0 and record["trigger_held"] == 0
    record["trigger_held"] = holding
    return came


@seldom
def triggers(scope: ScopeArrays, rows_written: int) -> bool:
    """Whether the row about to be written is the trigger's: its condition has come to hold (at once if there is none)
    and enough rows lie behind it."""
    record = scope.records[0]
    if record["trigger_on"] != 0:
        if record["trigger_unit"] != 0:
            came = condition_came(record, scope.unit_words, scope.unit_floats)
        else:
            came = condition_came(record, scope.axis_words, scope.axis_floats)
        if not came:
            return False
    if rows_written < record["pre_trigger_rows"]:
        return False
    record["trigger_row"] = rows_written
    return True


@seldom
def refresh_status(axes: Records, axis_count: int) -> None:
    """Work out the AS and FS words, which otherwise are only when the kernel returns."""
    for axis_index in range(axis_count):
        axes[axis_index]["status"] = axis_status(axes[axis_index])
        axes[axis_index]["following_status"] = following_status(axes[axis_index])

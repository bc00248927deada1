"""OUTPA and OUTPB: an auxiliary output that comes on when the encoder passes a position (OUTFNC25-H, 26-H).

With an on-time of 0 the output follows the comparison.  Otherwise it is on for the time from each passing on, whose
exact instant the servo finds between its samples, as the unit's hardware compares the encoder all the time (assumed).
The unit itself hears of a passing at the next system update, and with it whoever reads the output.
"""

from __future__ import annotations

import re
from decimal import ROUND_DOWN, Decimal
from typing import TYPE_CHECKING

from emulator.controller.dispatch import Lines, handles
from protocol.command import Command
from protocol.errors import INCORRECT_DATA, CommandError, invalid_data_field
from protocol.numbers import format_signed
from protocol.reply import ReplyLine

if TYPE_CHECKING:
    from emulator.controller.controller import Controller

NS_PER_MS = 1_000_000
FIELDS = 4
LONGEST_ON_MS = 65_535
"""Largest on-time (assumed L)."""

_NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)", re.ASCII)


class OutputOnPosition:
    """Output on position of one axis.

    An incremental position counts from where the encoder stood when the command was given and, with an on-time, again
    from each position reached (assumed L).
    """

    def __init__(self, controller: Controller, axis_index: int) -> None:
        self._controller = controller
        self._axis_index = axis_index
        self._fields = [Decimal(0)] * FIELDS
        self._threshold_counts = 0
        self._upwards = True
        self._until_ns = 0
        self._waits_for_passing = False
        self.passed_ns: int | None = None
        """When the position was last passed, virtual ns; None before the first time and with an on-time of 0."""

    def power_up(self) -> None:
        """Off."""
        self._controller.engine.compare_no_position(self._axis_index)
        self._fields = [Decimal(0)] * FIELDS
        self._until_ns = 0
        self.passed_ns = None

    @property
    def fields(self) -> list[Decimal]:
        """Enable, incremental, position in user units, on-time in ms: as entered."""
        return list(self._fields)

    @property
    def _enabled(self) -> bool:
        return self._fields[0] == 1

    @property
    def _incremental(self) -> bool:
        return self._fields[1] == 1

    @property
    def on(self) -> bool:
        """Whether the output is on."""
        if not self._enabled:
            return False
        if self._fields[3] == 0:
            return self._passed()
        return self._controller.now_ns < self._until_ns

    def _encoder_counts(self) -> int:
        return self._controller.engine.encoder_position(self._axis_index)

    def _passed(self) -> bool:
        position = self._encoder_counts()
        return position >= self._threshold_counts if self._upwards else position <= self._threshold_counts

    def set(self, fields: list[Decimal]) -> None:
        """The four fields changed."""
        self._fields = fields
        self._until_ns = 0
        self._controller.engine.compare_no_position(self._axis_index)
        if not self._enabled:
            return
        step = self._step_counts()
        self._upwards = step >= 0 or not self._incremental
        self._threshold_counts = step + (self._encoder_counts() if self._incremental else 0)
        if self._fields[3] != 0:
            self._watch(passing=not self._passed())

    def _step_counts(self) -> int:
        factor = self._controller.settings.factor("distance", self._axis_index)
        return int((self._fields[2] * factor).to_integral_value(ROUND_DOWN))

    def _watch(self, *, passing: bool) -> None:
        """Have the servo tell when the position is passed, or when the axis has come back behind it."""
        self._waits_for_passing = passing
        upwards = self._upwards == passing
        behind = 0 if passing else (-1 if self._upwards else 1)
        self._controller.engine.compare_position(self._axis_index, self._threshold_counts + behind, upwards=upwards)

    def check(self) -> None:
        """A value watch of this axis fired, or the position has been passed."""
        passed_ns = self._controller.engine.passed_position_ns(self._axis_index)
        if passed_ns is None:
            return
        if not self._waits_for_passing:
            self._watch(passing=True)
            return
        self.passed_ns = passed_ns
        self._until_ns = passed_ns + int(self._fields[3]) * NS_PER_MS
        step = self._step_counts()
        if self._incremental and step != 0:
            while self._passed():
                self._threshold_counts += step
            self._watch(passing=True)
        else:
            self._watch(passing=False)

    def report(self, name: str) -> ReplyLine:
        """``*OUTPA0,0,+0,0``."""
        enable, incremental, position, on_ms = self._fields
        places = self._controller.settings.places("distance", self._axis_index, 0)
        return ReplyLine(name, f"{enable},{incremental},{format_signed(position, places)},{on_ms}")


@handles("OUTPA", "OUTPB")
def output_on_position(controller: Controller, command: Command) -> Lines:
    """OUTPA, OUTPB enable,incremental,position,on-time."""
    on_position = controller.on_position[0 if command.name == "OUTPA" else 1]
    if command.is_query:
        return [on_position.report(command.name)]
    texts = command.argument.split(",")
    if len(texts) > FIELDS or any(text and not _NUMBER.fullmatch(text) for text in texts):
        raise CommandError(INCORRECT_DATA)
    fields = on_position.fields
    for index, text in enumerate(texts):
        if text:
            fields[index] = Decimal(text)
    for index in (0, 1):
        if fields[index] not in (0, 1):
            raise invalid_data_field(index + 1)
    if not 0 <= fields[3] <= LONGEST_ON_MS or fields[3] % 1:
        raise invalid_data_field(FIELDS)
    on_position.set(fields)
    return None

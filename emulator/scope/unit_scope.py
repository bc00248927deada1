"""The scope of a unit by the names of the registry's signals: what an engineer would hang on the real one, and more.

    unit.scope.record(["axis1.position.commanded", "axis1.position.actual", "axis1.dac"], seconds=0.5)
    unit.send(b"GO1\\r")
    emu.advance(0.5)
    recording = unit.scope.read()
    recording.time_s, recording["axis1.dac"]

Signals are taken in every servo sample, inside the compiled cycle (``emulator.engine.scope``).  Outputs are those the
controller had last set when the sample was taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from emulator.controller import Controller
from emulator.engine import Relation
from emulator.engine.trace import Column, Source, Trigger, most_rows
from emulator.registry import Signal, describe_signals

NS_PER_S = 1_000_000_000
_CONDITION = re.compile(r"\s*(?P<name>[a-z0-9_.]+?)\s*(?P<sign><=|>=|<>|<|>|=)\s*(?P<threshold>\S+)\s*")


class ScopeError(ValueError):
    """A recording that cannot be made; the text is one line for the user."""


@dataclass(frozen=True, slots=True)
class Recording(Mapping[str, Column]):
    """What the scope has recorded: a column a signal, all of the length of ``time_s``.

    ``time_s`` is the unit's virtual time; ``trigger_s`` that of the trigger, None if there is none or it has not come;
    ``complete`` tells whether the ring was filled after it.  Bits are 0 and 1.
    """

    time_s: npt.NDArray[np.float64]
    columns: Mapping[str, Column]
    units: Mapping[str, str]
    trigger_s: float | None
    complete: bool

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)


class UnitScope:
    """The scope of one unit; off until ``record``."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._signals: dict[str, Signal] = {}
        self._recorded: list[str] = []
        self._triggered = False
        self.endless = False
        """The recording has no end of its own."""

    def signals(self) -> dict[str, Signal]:
        """Every signal that can be recorded, by name."""
        if not self._signals:
            described = describe_signals(self._controller)
            self._signals = {name: signal for name, signal in described.items() if signal.source is not None}
        return self._signals

    def record(
        self,
        names: Sequence[str],
        *,
        seconds: float | None,
        trigger: str | None = None,
        pre_trigger_s: float = 0.0,
        every: int = 1,
    ) -> None:
        """Begin to record ``seconds`` of these signals, one row every ``every`` servo samples; None: until stopped, or
        until the memory is full.

        With a ``trigger``, ``NAME < | <= | = | <> | >= | > NUMBER``, the recording is made around the moment at which
        that comes to hold, ``pre_trigger_s`` of it before.  A recording under way is given up.

        Raises:
            ScopeError: an unknown signal, a condition that cannot be read, a recording too long for the memory.
        """
        sources = [self._source(name) for name in names]
        if not names:
            raise ScopeError("no signals to record")
        if every < 1:
            raise ScopeError(f"one row every {every} samples is not possible")
        self.endless, self._triggered = seconds is None, trigger is not None
        row_s = every * self._controller.engine.rates.servo_ns / NS_PER_S
        try:
            self._controller.engine.scope.arm(
                sources,
                rows=_rows(seconds, row_s, "seconds") if seconds is not None else most_rows(sources),
                pre_trigger_rows=_rows(pre_trigger_s, row_s, "pre-trigger time"),
                every=every,
                trigger=None if trigger is None else self._trigger(trigger),
            )
        except ValueError as error:
            raise ScopeError(str(error)) from None
        self._recorded = list(names)
        self._controller.outputs_watched = any(source.field == "outputs" for source in sources)
        self._controller.show_outputs()

    def stop(self) -> None:
        """Record no more; what has been recorded can still be read."""
        self._controller.engine.scope.stop()
        self._controller.outputs_watched = False

    @property
    def running(self) -> bool:
        """Recording, or waiting for the trigger."""
        return self._controller.engine.scope.running

    @property
    def filling(self) -> bool:
        """Recording towards an end that time alone will bring."""
        scope = self._controller.engine.scope
        return scope.running and scope.triggered and not self.endless

    def read(self) -> Recording:
        """What has been recorded so far; ScopeError if nothing was ever asked for."""
        if not self._recorded:
            raise ScopeError("the scope has not been started")
        trace = self._controller.engine.scope.read()
        time_s = trace.times_ns / NS_PER_S
        return Recording(
            time_s=time_s,
            columns=dict(zip(self._recorded, trace.columns, strict=True)),
            units={name: self._signals[name].unit for name in self._recorded},
            trigger_s=float(time_s[trace.trigger_row]) if self._triggered and trace.trigger_row is not None else None,
            complete=trace.complete,
        )

    def _source(self, name: str) -> Source:
        signal = self.signals().get(name)
        if signal is None or signal.source is None:
            raise ScopeError(
                f"no signal {name!r} can be recorded; the nearest: {', '.join(_nearest(name, self._signals))}"
            )
        return signal.source

    def _trigger(self, text: str) -> Trigger:
        found = _CONDITION.fullmatch(text)
        try:
            threshold = float(found["threshold"]) if found else np.nan
        except ValueError:
            threshold = np.nan
        if found is None or not np.isfinite(threshold):
            raise ScopeError(f"trigger {text!r}: not of the form NAME < | <= | = | <> | >= | > NUMBER")
        return Trigger(self._source(found["name"]), Relation.of(found["sign"]), threshold)


def _rows(seconds: float, row_s: float, what: str) -> int:
    if not 0.0 <= seconds < 1e9:
        raise ScopeError(f"{what}: {seconds} is not possible")
    return round(seconds / row_s)


def _nearest(name: str, names: Mapping[str, Signal]) -> list[str]:
    from difflib import get_close_matches

    return get_close_matches(name, names, n=4, cutoff=0.3) or list(names)[:4]

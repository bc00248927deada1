"""The guide's tuning procedure, walked by rule (OEM6250 Installation Guide p. 48, 6250 User Guide p. 46).

Step 4: SGP from 0.5, raised while sluggish and lowered when oscillatory until slightly under-damped; then SGV from 0.1,
raised for damping and lowered when sluggish or chattering; and again SGP and SGV in turn as long as the response gets
faster, as the guide's own example goes on. Step 5, if there is a steady-state error: SGI from 0.1, raised
until the error is gone, lowered when overshoot grows or the response oscillates; then, should the output saturate,
SGILIM
is lowered. Step 6, whose page is missing (assumed): SGVF until the error at constant velocity is gone, SGAF for the
accelerating part.

The guide leaves "raise" and "lower" to the engineer's feeling. Here a gain is doubled until it is too much and the
range is then halved, in ratio, so that a walk is always the same and always ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from emulator.engine import Gains
from emulator.tuning.gains import changed, short, value_of
from emulator.tuning.measures import StepMeasures
from emulator.tuning.rig import StepResponse, Tracking
from emulator.tuning.verdict import Verdict, beyond_percent, verdict

START_SGP = 0.5
"""Where the guide starts SGP, mV/count."""
LEAST_SGP = START_SGP / 4
"""SGP below which lowering it further is no cure for oscillation; SGV is then tried at the start (design choice)."""
START_SGV = 0.1
"""Where the guide starts SGV, uV per count/s."""
START_SGI = 0.1
"""Where the guide starts SGI, mV per count and second."""

MAX_TRIES = 18
"""Tries for one gain (design choice): doublings over five decades."""
RAISE = 2.0
RAISE_SGI = 4.0
"""By how much a gain is raised at a time; SGI has furthest to go (design choice)."""
CLOSE_RATIO = 1.1
"""A gain is known well enough when too much is no more than this above enough (design choice)."""
NO_ERROR_COUNTS = 0.5
"""Mean error below which there is none: half a count (design choice)."""
GROWTH_PERCENT = 5.0
"""Growth of the overshoot, in percent of the step, that makes SGI too high (design choice)."""
TRACKING_COUNTS = 1.0
"""Error in motion that feedforward need not better, counts (design choice)."""
FEEDFORWARD_TRIES = 4
MAX_ROUNDS = 6
"""Times SGP and SGV are gone through in turn at most (design choice)."""
FASTER = 0.9
"""What the settling time (without one, the time to 90 %) must shrink to for another round to be worth it (design
choice)."""
SATURATED_V = 9.99
LOWERED_SGILIM_V = 5.0
"""SGILIM where integral action saturates the output, V: under the guide's 10 V (value a design choice)."""

TOO_LITTLE = frozenset({Verdict.OVER_DAMPED, Verdict.WELL_DAMPED})
RESTLESS = frozenset({Verdict.CHATTERING, Verdict.OSCILLATORY, Verdict.UNSTABLE})


class Bench(Protocol):
    """What the procedure tries gains on."""

    def step(self, gains: Gains) -> StepResponse:
        """The response to the step."""
        ...

    def cruise(self, gains: Gains) -> Tracking:
        """The errors in a move at constant velocity."""
        ...


@dataclass(frozen=True, slots=True)
class Try:
    """One response of the walk: why it was made, and what it was called."""

    reason: str
    response: StepResponse
    verdict: Verdict

    @property
    def gains(self) -> Gains:
        """The gains tried."""
        return self.response.gains

    @property
    def measures(self) -> StepMeasures:
        """Its measures."""
        return self.response.measures


class NotTunable(RuntimeError):
    """No gain makes the axis stable; the message is one line."""


class Search:
    """A gain between too little and too much, raised by a factor until both are known, then halved in ratio."""

    def __init__(self, start: float, raise_by: float, *, low: float | None = None) -> None:
        """`low`: what is known to be too little already."""
        self.value, self._raise_by = start, raise_by
        self.low = low
        self.high: float | None = None

    def too_little(self) -> None:
        """Raise."""
        self.low = self.value
        self._next()

    def too_much(self) -> None:
        """Lower."""
        self.high = self.value
        self._next()

    @property
    def closed(self) -> bool:
        """Too much is so near to too little that nothing is left to try."""
        return self.low is not None and self.high is not None and self.high <= CLOSE_RATIO * self.low

    def _next(self) -> None:
        if self.low is None or self.high is None:
            self.value = self.value * self._raise_by if self.high is None else self.value / self._raise_by
        else:
            self.value = math.sqrt(self.low * self.high)
        self.value = three_digits(self.value)


class Walk:
    """The procedure on one bench. Iterate `tries`; afterwards `gains` are the result."""

    def __init__(self, bench: Bench, gains: Gains) -> None:
        """`gains`: those of the axis as it is; only SGILIM is taken from them."""
        self._bench = bench
        self.gains = Gains(0.0, integral_limit_v=gains.integral_limit_v)
        self.notes: list[str] = []
        self._last: Try | None = None

    def tries(self) -> Iterator[Try]:
        """Every step response in the order made.

        Raises:
            NotTunable: the axis is unstable with the smallest SGP.
        """
        yield from self._proportional(Search(START_SGP, RAISE), "SGP: start")
        yield from self._velocity()
        for _ in range(MAX_ROUNDS):
            before = self._kept
            sgp = value_of(self.gains, "SGP")
            faster = Search(three_digits(RAISE * sgp), RAISE, low=sgp)
            yield from self._proportional(faster, "SGP raised: try a faster response")
            yield from self._velocity()
            if not _faster(self._kept, before):
                self._keep(before)
                break
        yield from self._integral()
        yield from self._feedforward()

    def _try(self, reason: str, **values: float) -> Try:
        response = self._bench.step(changed(self.gains, values))
        word = verdict(response.measures, step_counts=response.step_counts, tripped=response.tripped)
        self._last = Try(reason, response, word)
        return self._last

    def _keep(self, best: Try) -> None:
        self.gains, self._last = best.gains, best

    def _proportional(self, search: Search, reason: str) -> Iterator[Try]:
        best = first = self._last
        for _ in range(MAX_TRIES):
            made = self._try(reason, SGP=search.value)
            first = first or made
            yield made
            if made.verdict == Verdict.SLIGHTLY_UNDER_DAMPED:
                best = made
                break
            if made.verdict in TOO_LITTLE:
                best, reason = made, "SGP raised: not yet under-damped"
                search.too_little()
            elif best is None and search.low is None and search.value <= LEAST_SGP:
                self.notes.append("SGP alone cannot calm this axis, which has little damping of its own: SGV has to")
                best = first
                break
            else:
                reason = f"SGP lowered: {made.verdict}"
                search.too_much()
            if search.closed:
                break
        if best is None:
            raise RuntimeError("a search for SGP ends with one")
        self._keep(best)

    def _velocity(self) -> Iterator[Try]:
        before = best = self._kept
        if before.verdict in TOO_LITTLE:
            return
        search, reason = Search(self._next_sgv(), RAISE), "SGV raised: more damping"
        for _ in range(MAX_TRIES):
            made = self._try(reason, SGV=search.value)
            yield made
            if made.verdict == Verdict.WELL_DAMPED:
                best = made
                break
            calmed = best.verdict not in RESTLESS
            if made.verdict in {Verdict.CHATTERING, Verdict.OVER_DAMPED} or (calmed and made.verdict in RESTLESS):
                reason = f"SGV lowered: {made.verdict}"
                search.too_much()
            else:
                best = made if _calmer(made, best) else best
                reason = "SGV raised: more damping"
                search.too_little()
            if search.closed or search.value <= value_of(before.gains, "SGV"):
                break
        if best.verdict in RESTLESS:
            raise NotTunable("no SGP and SGV calm this axis: look at its polarity (ENCPOL, CMDDIR), SOFFS and load")
        self._keep(best)

    def _next_sgv(self) -> float:
        return three_digits(max(START_SGV, RAISE * value_of(self.gains, "SGV")))

    def _integral(self) -> Iterator[Try]:
        before = self._kept
        if abs(before.measures.steady_error_counts) < NO_ERROR_COUNTS:
            self.notes.append("SGI stays 0: there is no steady-state error")
            return
        search, reason, best, limit_v = Search(START_SGI, RAISE_SGI), "SGI: start", before, self.gains.integral_limit_v
        for _ in range(MAX_TRIES):
            made = self._try(reason, SGI=search.value, SGILIM=limit_v)
            yield made
            if made.verdict in RESTLESS or _beyond(made) > _beyond(before) + GROWTH_PERCENT:
                if search.high is not None and limit_v > LOWERED_SGILIM_V and _saturates(made):
                    limit_v, reason = LOWERED_SGILIM_V, "SGILIM lowered: the output saturates"
                    continue
                reason = (
                    "SGI lowered: overshoot grows" if made.verdict not in RESTLESS else f"SGI lowered: {made.verdict}"
                )
                search.too_much()
            elif abs(made.measures.steady_error_counts) < NO_ERROR_COUNTS:
                best = made
                break
            else:
                best = made if _error(made) < _error(best) else best
                reason = "SGI raised: still a steady-state error"
                search.too_little()
            if search.closed:
                break
        self._keep(best)

    def _feedforward(self) -> Iterator[Try]:
        if self._bench.cruise(self.gains).tripped:
            self.notes.append("no feedforward: the move at constant velocity exceeds SMPER")
            return
        self._cancel("SGVF", lambda tracking: (tracking.cruise_error_counts, tracking.velocity_counts_s))
        self._cancel("SGAF", lambda tracking: (tracking.acceleration_error_counts, tracking.acceleration_counts_s2))
        if value_of(self.gains, "SGVF") or value_of(self.gains, "SGAF"):
            before = self._kept
            made = self._try("SGVF and SGAF set: errors in motion gone")
            yield made
            if before.verdict in TOO_LITTLE and made.verdict not in TOO_LITTLE:
                self.notes.append(f"feedforward left out: the step would be {made.verdict} ({short(made.gains)})")
                made = before
            self._keep(made)

    def _cancel(self, name: str, read: ErrorOf) -> None:
        """Set a feedforward gain so that its error in motion vanishes: a first value from the error that SGP now holds
        against, then straight lines through the last two."""
        error, rate = read(self._bench.cruise(self.gains))
        best, points = (abs(error), 0.0), [(0.0, error)]
        value = three_digits(value_of(self.gains, "SGP") * error / rate * 1e3) if rate else 0.0
        for _ in range(FEEDFORWARD_TRIES):
            if best[0] < TRACKING_COUNTS or value <= 0.0:
                break
            tracking = self._bench.cruise(changed(self.gains, {name: value}))
            error = math.inf if tracking.tripped or tracking.peak_output_v >= SATURATED_V else read(tracking)[0]
            if math.isinf(error):
                self.notes.append(f"{name} goes no further: the output saturates")
                break
            best = min(best, (abs(error), value))
            points.append((value, error))
            value = _crossing(*points[-2:])
        self.gains = changed(self.gains, {name: best[1]})

    @property
    def _kept(self) -> Try:
        if self._last is None:
            raise RuntimeError("nothing has been tried yet")
        return self._last


class ErrorOf(Protocol):
    """Reads an error in motion and the velocity or acceleration it belongs to."""

    def __call__(self, tracking: Tracking) -> tuple[float, float]: ...


def three_digits(value: float) -> float:
    """A value as one would type it."""
    return float(f"{value:.3g}")


def _crossing(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Where the line through two points meets zero; 0 where it does not."""
    slope = (second[1] - first[1]) / (second[0] - first[0]) if second[0] != first[0] else 0.0
    return three_digits(second[0] - second[1] / slope) if slope else 0.0


def _beyond(made: Try) -> float:
    return beyond_percent(made.measures)


def _calmer(made: Try, best: Try) -> bool:
    """Whether a try is a better one to go on from: at rest rather than restless, then with less overshoot."""
    return (made.verdict in RESTLESS, _beyond(made)) < (best.verdict in RESTLESS, _beyond(best))


def _faster(made: Try, before: Try) -> bool:
    """Whether a round has brought something: still well damped, and sooner there."""
    damped = made.verdict in TOO_LITTLE or before.verdict not in TOO_LITTLE
    settle = made.measures.settled and before.measures.settled
    now_s, then_s = (each.measures.settling_s if settle else each.measures.time_to_90_s for each in (made, before))
    return damped and now_s < FASTER * then_s


def _error(made: Try) -> float:
    return abs(made.measures.steady_error_counts)


def _saturates(made: Try) -> bool:
    return made.measures.peak_output_v >= SATURATED_V

"""Following as the controller sets and reads it: masters, ratio moves, phase shifts, master cycles.

The kernel (`following`) does the work at system updates; here its records are prepared, and what it knows in integers
is put together again as exact rationals, so that a new ratio move begins precisely where the slave is.

Master positions are counts since the master was assigned, after the sign of the assignment; slave positions are
reported counts; ratios are slave counts per master count; `axis_index` counts from 0.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction

from .following import MASTER_ANI, MASTER_COMMANDED, MASTER_ENCODER, MASTER_NONE, ONE_SAMPLE, TWO_SAMPLES, raw_master
from .following_readings import FollowingReadings
from .following_status import FOLLOWING, PHASE_END, PHASE_HELD, PHASE_NONE, PHASE_WAITING
from .layout import UNIT, word_of
from .memory import write_fields
from .profile import Segments, State, evaluate, profile_duration
from .rates import NS_PER_S, ServoRates
from .ratio_profile import ZERO, RatioSegment, master_travel, ratio_at
from .ratio_rows import rows_of
from .readings import ACTIVE, COMMANDED, ENABLED, OFFSET, DriveShutDown, axis_word

_SOURCE, _RAW, _COUNTS = (axis_word(name) for name in ("master_source", "master_raw", "master_counts"))
_USED, _USED_PART = axis_word("master_used"), axis_word("master_used_part")
_FIRST, _INDEX, _PHASE = (axis_word(name) for name in ("first_ratio", "ratio_index", "ratio_phase"))
_START, _START_PART = axis_word("ratio_master"), axis_word("ratio_master_part")
_DIRECTION, _LEFT = axis_word("ratio_direction"), axis_word("ratio_updates_left")
_SUM_PIECE, _SUM_MASTER = axis_word("sum_piece"), axis_word("sum_master")
_SUM_COUNTS, _SUM_PART = axis_word("sum_counts"), axis_word("sum_part")
_STEP, _VELOCITY, _ACCELERATION = (axis_word(f"slave_{name}") for name in ("step", "velocity", "acceleration"))
_SHIFTING, _SHIFT_START, _SHIFT = (axis_word(f"shift_{name}") for name in ("active", "start_ns", "counts"))
_TO_SYSTEM, _PER_SYSTEM = word_of(UNIT, "trajectories_to_system"), word_of(UNIT, "trajectories_per_system")

_REGISTERS = ("slave_from", "slave_target", "slave_next")

PLACE_PARTS = 1 << 30
"""Parts of a count in which a place within a ramp, or a shift, is taken over into a new move (design choice)."""


class MasterSource(IntEnum):
    """What an axis follows; the values are the source digits of FOLMAS."""

    NONE = MASTER_NONE
    ENCODER = MASTER_ENCODER
    ANI = MASTER_ANI
    COMMANDED = MASTER_COMMANDED


@dataclass(frozen=True, slots=True)
class MasterMeasurement:
    """How masters are measured, where the guide leaves it open."""

    one_sample_predictor: bool = False
    """FPPEN1 takes the master velocity from one sample instead of two."""
    filter_order: int = 1
    """Order of the low-pass of FFILT, 1 or 2."""


CORNER_OF_STAGE = {1: 1.0, 2: 1.0 / math.sqrt(math.sqrt(2.0) - 1.0)}
"""Corner of each stage over that of the whole filter (-3 dB), by order."""


class NoMaster(RuntimeError):
    """A Following move or a shift was started on an axis without a master."""


@dataclass(frozen=True, slots=True)
class RatioMove:
    """The last ratio move of an axis: its pieces, the raw slave position it began at, the ratio held before it.

    `hold` is None for a move that runs in whichever direction the master goes.
    """

    segments: tuple[RatioSegment, ...]
    base: Fraction
    hold: Fraction | None

    def piece(self, index: int) -> RatioSegment | None:
        """The piece of a row of the kernel's table; None for its end."""
        rows = self.segments if self.hold is None else (RatioSegment(None, self.hold, self.hold), *self.segments)
        return rows[index] if index < len(rows) else None

    def end(self, direction: int) -> Fraction:
        """Raw slave position at the end; ValueError for an endless move."""
        return self.base + direction * sum((segment.slave for segment in self.segments), ZERO)


@dataclass(frozen=True, slots=True)
class _Place:
    """A master position, whole counts and part, with the slave's exact raw position there."""

    master: int
    part: float
    slave: Fraction


def _parts(value: float) -> Fraction:
    return Fraction(round(value * PLACE_PARTS), PLACE_PARTS)


class FollowingAxes(FollowingReadings, ABC):
    """The Following half of `Engine`."""

    def _init_following(self, axis_count: int, measurement: MasterMeasurement) -> None:
        self._measurement = measurement
        self._moves: list[RatioMove | None] = [None] * axis_count
        self._shifts: list[Segments] = [()] * axis_count
        self._corners_hz: list[float | None] = [None] * axis_count
        for axis_index in range(axis_count):
            self._write(axis_index, master_sign=1, filter_stages=measurement.filter_order, ratio_direction=1)
            self.set_prediction(axis_index, True)

    @property
    @abstractmethod
    def rates(self) -> ServoRates:
        """The servo, trajectory and system update rates in force."""

    @property
    @abstractmethod
    def next_trajectory_ns(self) -> int:
        """Time of the first trajectory update to come."""

    @abstractmethod
    def _bind(self) -> None:
        """Tell the kernel where the arrays lie."""

    # Master

    def set_master(self, axis_index: int, *, source: MasterSource, master_index: int = 0, sign: int = 1) -> None:
        """FOLMAS: what the axis follows. Its position, filter and cycle begin at 0; FFILT, FPPEN and FMCLEN stay.

        ValueError for a master axis the unit has not, or while the axis is a slave in motion.
        """
        if not 0 <= master_index < len(self._ints):
            raise ValueError(f"there is no axis {master_index + 1} to follow")
        if self.is_following(axis_index):
            raise ValueError(f"axis {axis_index + 1} is following its master")
        self._write(axis_index, master_source=source, master_index=master_index, master_sign=1 if sign >= 0 else -1)
        raw = raw_master(self._memory.axes[axis_index], self._memory.axes)
        self._write(axis_index, master_raw=raw, master_counts=0, master_moved=0, master_used=0, master_used_part=0.0)
        self._write(axis_index, master_lag=0.0, first_master_lag=0.0, previous_master_lag=0.0, master_velocity=0.0)
        self._write(axis_index, cycle_counts=0, cycle_number=0, ratio_phase=PHASE_NONE, shift_counts=0.0)
        self._moves[axis_index] = None
        slaves = sum(ints[_SOURCE] != MASTER_NONE for ints in self._ints)
        write_fields(self._memory.unit, UNIT, {"slaves": slaves})

    def master_source(self, axis_index: int) -> MasterSource:
        """What the axis follows."""
        return MasterSource(self._ints[axis_index][_SOURCE])

    def set_master_filter(self, axis_index: int, corner_hz: float | None) -> None:
        """FFILT: corner of the low-pass on the master position, Hz; None: no filter."""
        self._corners_hz[axis_index] = corner_hz
        period_s = self.rates.system_ns / NS_PER_S
        each_hz = (corner_hz or 0.0) * CORNER_OF_STAGE[self._measurement.filter_order]
        decay = 0.0 if corner_hz is None else math.exp(-2.0 * math.pi * each_hz * period_s)
        self._write(axis_index, master_decay=decay)

    def set_prediction(self, axis_index: int, on: bool) -> None:
        """FPPEN: extrapolate the master position over the two sample periods the slave needs."""
        samples = ONE_SAMPLE if self._measurement.one_sample_predictor else TWO_SAMPLES
        self._write(axis_index, prediction=samples if on else 0)

    def set_master_cycle(self, axis_index: int, length: int) -> None:
        """FMCLEN: length of the master cycle, counts; 0 = endless."""
        self._write(axis_index, cycle_length=length)

    def restart_master_cycle(self, axis_index: int, position: int = 0, *, at: int | None = None) -> None:
        """FMCNEW: the cycle number becomes 0, the position in the cycle `position` (FMCP).

        `at` is the master position at which that is, or was; None: the present one.
        """
        passed = 0 if at is None else self._ints[axis_index][_COUNTS] - at
        self._write(axis_index, cycle_counts=position + passed, cycle_number=0)

    @contextmanager
    def _masters_unmoved(self) -> Iterator[None]:
        """What positions do within jumps no slave."""
        before = [raw_master(axis, self._memory.axes) for axis in self._memory.axes]
        yield
        for axis, ints, raw in zip(self._memory.axes, self._ints, before, strict=True):
            ints[_RAW] += raw_master(axis, self._memory.axes) - raw

    def set_feedback(self, axis_index: int, source: int) -> None:
        """As `FeedbackInputs.set_feedback`; a slave of the axis's commanded position does not jump with it."""
        with self._masters_unmoved():
            super().set_feedback(axis_index, source)

    def set_polarity(
        self, axis_index: int, *, encoder: int | None = None, command: int | None = None, ani: int | None = None
    ) -> None:
        """As `FeedbackInputs.set_polarity`; a slave of the ANI input does not jump with it."""
        with self._masters_unmoved():
            super().set_polarity(axis_index, encoder=encoder, command=command, ani=ani)

    # Ratio moves

    def start_following(
        self, axis_index: int, segments: Sequence[RatioSegment], *, preset: bool, start_at: int | None = None
    ) -> None:
        """Start a ratio move, in place of whatever moves the axis; the next system update is its first.

        A `preset` move runs in the positive master direction only: what the master backs up before it has begun does
        not count, backing up later retraces it, not beyond its beginning. Any other begins in either direction,
        mirrored, and once its ratio is final that holds in both.

        With `start_at`, a master position, the move begins when the master gets there (if it is not preset, from the
        side on which the master is), the present ratio being kept until then. No segments: the move is over there,
        or at once, where the slave is. DriveShutDown if the drive is off, NoMaster without a master.
        """
        self._require_master(axis_index)
        ratio = self.following_ratio(axis_index)
        place = self._absorb_shift(axis_index, self._place(axis_index))
        direction, hold = 1, None
        if start_at is not None:
            direction = 1 if preset or start_at >= self._ints[axis_index][_COUNTS] else -1
            place = _Place(start_at, 0.0, place.slave + ratio * (start_at - place.master - Fraction(place.part)))
        if start_at is not None or (segments and preset):
            hold = ratio
        move = RatioMove(tuple(segments), place.slave, hold)
        self._forget_streams(axis_index)
        self._write(
            axis_index,
            ratio_master=place.master,
            ratio_master_part=place.part,
            ratio_direction=direction,
            ratio_mirrored=hold is None and bool(segments),
            ratio_waiting=preset and start_at is None and hold == 0,
            ratio_held=start_at is not None,
            ratio_phase=PHASE_WAITING if start_at is None else PHASE_HELD,
        )
        self._begin_move(axis_index, move)

    def _begin_move(self, axis_index: int, move: RatioMove) -> None:
        """Hand a ratio move to the kernel, with its base split into whole counts and a part."""
        counts, part = divmod(move.base, 1)
        rows = rows_of(move.segments, base_part=part, hold_ratio=move.hold)
        if self._memory.reserve_ratios(len(rows)):
            self._bind()
        self._memory.store_ratios(axis_index, rows)
        self._moves[axis_index] = move
        if not self.is_following(axis_index):
            self._stand_at(axis_index, counts, float(part))
        self._write(
            axis_index,
            profile_active=FOLLOWING,
            ratio_base=counts,
            ratio_count=len(rows),
            ratio_index=0,
            ratio_updates_left=0,
            ratio_now=float(move.hold or 0),
            sum_piece=-1,
            settling=0,
        )

    def _stand_at(self, axis_index: int, counts: int, part: float) -> None:
        """The slave rests: where it goes from and to is one place."""
        for register in _REGISTERS:
            self._write(axis_index, **{register: counts, f"{register}_part": part})
        self._write(axis_index, slave_step=0.0, slave_velocity=0.0, slave_acceleration=0.0)
        self._write(axis_index, commanded_velocity=0.0, commanded_acceleration=0.0)
        self._write(axis_index, shift_active=0, shift_counts=0.0, shift_velocity=0.0, shift_acceleration=0.0)

    def following_ratio(self, axis_index: int) -> Fraction:
        """The present ratio, within a ramp that of the last system update; 0 for an axis that does not follow."""
        move, ints = self._moves[axis_index], self._ints[axis_index]
        if move is None or not self.is_following(axis_index):
            return ZERO
        piece = move.piece(ints[_INDEX])
        if piece is None:
            return ZERO
        if piece.start_ratio == piece.end_ratio or ints[_SUM_PIECE] < 0:
            return piece.start_ratio
        used = self._master_travel(axis_index) * ints[_DIRECTION]
        return ratio_at(move.segments, used)

    def _master_travel(self, axis_index: int) -> Fraction:
        """Master travel from the beginning of the ratio move to the position last used."""
        ints, floats = self._ints[axis_index], self._floats[axis_index]
        return ints[_USED] - ints[_START] + _parts(floats[_USED_PART] - floats[_START_PART])

    def _place(self, axis_index: int) -> _Place:
        """Where master and slave are as of the last system update; exact except within a ramp."""
        ints, floats = self._ints[axis_index], self._floats[axis_index]
        move = self._moves[axis_index]
        if move is None or not self.is_following(axis_index):
            return _Place(ints[_USED], floats[_USED_PART], self._rest(axis_index))
        direction = ints[_DIRECTION]
        if ints[_LEFT] != 0:
            return _Place(ints[_USED], floats[_USED_PART], move.end(direction))
        if ints[_SUM_PIECE] < 0:
            held_travel = (move.hold or ZERO) * self._master_travel(axis_index)
            return _Place(ints[_USED], floats[_USED_PART], move.base + held_travel)
        row = self._memory.ratios[ints[_FIRST] + ints[_INDEX]]
        if row["slope"] != 0.0:
            travel = self._register(axis_index, "slave_next")
            return _Place(ints[_USED], floats[_USED_PART], travel)
        travel = ints[_SUM_COUNTS] + Fraction(ints[_SUM_PART], int(row["denominator"]))
        master = ints[_START] + direction * ints[_SUM_MASTER]
        return _Place(master, floats[_START_PART], move.base + direction * travel)

    def _register(self, axis_index: int, name: str) -> Fraction:
        axis = self._memory.axes[axis_index]
        return int(axis[name]) + _parts(float(axis[f"{name}_part"]))

    def _rest(self, axis_index: int) -> Fraction:
        """Raw position of a resting axis: exactly where its last ratio move ended, if it is still there."""
        ints, move = self._ints[axis_index], self._moves[axis_index]
        if move is not None and ints[_PHASE] in (PHASE_NONE, PHASE_END):
            end = move.end(ints[_DIRECTION]) + _parts(self._floats[axis_index][_SHIFT])
            if math.floor(end + Fraction(1, 2)) == ints[COMMANDED]:
                return end
        return Fraction(ints[COMMANDED])

    def _absorb_shift(self, axis_index: int, place: _Place) -> _Place:
        """Make the net shift part of the slave's position, unless one is under way."""
        if not self.is_following(axis_index) or self.is_shifting(axis_index):
            return place
        shift = _parts(self._floats[axis_index][_SHIFT])
        for name in _REGISTERS:
            counts, part = divmod(self._register(axis_index, name) + shift, 1)
            self._write(axis_index, **{name: counts, f"{name}_part": float(part)})
        self._write(axis_index, shift_counts=0.0)
        return _Place(place.master, place.part, place.slave + shift)

    def _forget_streams(self, axis_index: int) -> None:
        """No streamed profile moves the axis any longer, in time or over master travel."""

    def _give_up_motion(self, axis_index: int) -> None:
        """The axis moves by something else, or not at all; the shift stays readable."""
        self._forget_streams(axis_index)
        self._moves[axis_index] = None
        self._write(axis_index, shift_active=0, shift_velocity=0.0, shift_acceleration=0.0)
        self._write(axis_index, ratio_phase=PHASE_NONE, ratio_now=0.0)

    def _require_master(self, axis_index: int) -> None:
        if not self._ints[axis_index][ENABLED]:
            raise DriveShutDown(f"the drive of axis {axis_index + 1} is off")
        if self._ints[axis_index][_SOURCE] == MASTER_NONE:
            raise NoMaster(f"axis {axis_index + 1} has no master")

    # Phase shifts

    def start_shift(self, axis_index: int, segments: Segments, *, continuous: bool = False) -> None:
        """Superimpose a profile in time, its positions the net shift in counts, in place of a shift under way.

        It begins at the next trajectory update. An axis at rest is shifted as a slave of ratio 0. ValueError for no
        segments or an axis that another kind of move has; DriveShutDown, NoMaster as for a ratio move.
        """
        self._require_master(axis_index)
        if not segments:
            raise ValueError("a shift needs at least one segment")
        if not self.is_following(axis_index):
            self._stand_by(axis_index, segments[0].position)
        if self._memory.reserve_segments(len(segments)):
            self._bind()
        self._memory.store_segments(axis_index, segments, shift=True)
        self._shifts[axis_index] = segments
        duration_s = profile_duration(segments)
        self._write(
            axis_index,
            shift_active=1,
            shift_continuous=continuous,
            shift_start_ns=self.next_trajectory_ns,
            shift_end_s=duration_s,
            shift_end_counts=evaluate(segments, duration_s).position if duration_s < math.inf else 0.0,
            shift_count=len(segments),
            shift_index=0,
        )

    def _stand_by(self, axis_index: int, shift: float) -> None:
        """A resting axis becomes a slave at the end of an empty move, the net shift being `shift` there."""
        if self._ints[axis_index][ACTIVE]:
            raise ValueError(f"axis {axis_index + 1} is moving otherwise")
        self._forget_streams(axis_index)
        base = self._rest(axis_index) - _parts(shift)
        self._begin_move(axis_index, RatioMove((), base, None))
        self._write(axis_index, ratio_phase=PHASE_NONE, ratio_updates_left=1, shift_counts=shift, ratio_direction=1)

    def cancel_shift(self, axis_index: int) -> None:
        """Give up the shift at once: the net shift stays what it is (FSHFC3)."""
        self._write(axis_index, shift_active=0, shift_velocity=0.0, shift_acceleration=0.0)

    def shift_state(self, axis_index: int) -> State:
        """Net shift, its velocity and acceleration at the next trajectory update: what a new shift starts from."""
        ints = self._ints[axis_index]
        if not ints[_SHIFTING]:
            return State(self._floats[axis_index][_SHIFT], 0.0, 0.0)
        return evaluate(self._shifts[axis_index], (self.next_trajectory_ns - ints[_SHIFT_START]) / NS_PER_S)

    # What profiles and rates mean to a slave

    def _slave_state(self, axis_index: int) -> State:
        """Position, velocity and acceleration of a slave at the next trajectory update, reported counts."""
        unit, floats = self._unit, self._floats[axis_index]
        steps = unit[_PER_SYSTEM] - unit[_TO_SYSTEM] + 1
        position = float(self._register(axis_index, "slave_from")) + steps * floats[_STEP]
        shift = self.shift_state(axis_index)
        return State(
            position + shift.position - self._ints[axis_index][OFFSET],
            floats[_VELOCITY] + shift.velocity,
            floats[_ACCELERATION] + shift.acceleration,
        )

    def _slave_end(self, axis_index: int) -> float | None:
        """Reported counts at which the ratio move ends, a shift left aside; None for one that goes on."""
        move = self._moves[axis_index]
        if move is None or master_travel(move.segments) is None:
            return None
        return float(move.end(self._ints[axis_index][_DIRECTION]) - self._ints[axis_index][OFFSET])

    def _retime_following(self, axis_index: int) -> None:
        """The rates have changed and a system update begins anew: a slave goes on from where it is."""
        self.set_master_filter(axis_index, self._corners_hz[axis_index])
        if self.is_following(axis_index):
            here = self._ints[axis_index][COMMANDED] - self._floats[axis_index][_SHIFT]
            counts, part = divmod(_parts(here), 1)
            step = float(self._register(axis_index, "slave_target") - counts - part) / self._unit[_PER_SYSTEM]
            self._write(axis_index, slave_from=counts, slave_from_part=float(part), slave_step=step)

"""The servo engine of one unit: its axes in virtual time, and the only face the controller sees of them.

`run` advances the unit to a given time, or to the first system update at which something happened that the
controller must see. Everything else reads or sets state between runs; a setting takes effect at the next servo
sample, a profile at the next trajectory update.

Positions are *reported* counts, that is after `PSET`, velocities counts per second; `axis_index` counts from 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from .control_law import Gains, UnitFactors, gain_fields
from .converter import DEFAULT_DAC_BITS, dac_fields
from .encoder import ENCODER_SOURCE
from .events import EVENT_ROWS_LOW, MAX_AXES, Event, Relation, Signal
from .following_axes import MasterMeasurement, MasterSource
from .layout import UNIT, word_of
from .machine_code import Calls, Kernel, OnBuild, load_kernel
from .machinery import AxisHardware
from .memory import Memory, write_fields
from .profile import Segments, State, evaluate, profile_duration
from .profile_streaming import TIMED, ProfileStreams
from .rates import NS_PER_S, ServoRates
from .readings import (
    ANI_OFFSET,
    COMMANDED,
    ENABLED,
    ENCODER,
    ENCODER_OFFSET,
    FEEDBACK,
    NS_PER_MS,
    OFFSET,
    DriveShutDown,
    axis_word,
)
from .status import CLEARED_BY_ENABLE
from .streaming import NO_REFILL, Portion
from .trace import Scope
from .travel import Capture
from .watches import WATCH_SLOTS

SHORT_RUN_SAMPLES = 40
"""Runs of fewer samples keep the interpreter lock: handing it over would cost more than the samples."""

FIRST_LASTING_WATCH = WATCH_SLOTS - 2
"""Value watches from this slot on outlive `clear_watches`: they belong to starts that wait for a position (GOWHEN), one
an axis."""

DEFAULT_POSITION_ERROR_LIMIT = 4000
"""SMPER at power-up, counts. Assumed, medium confidence."""

_TIME, _NEXT_SAMPLE, _SERVO = (word_of(UNIT, name) for name in ("time_ns", "next_sample_ns", "servo_ns"))
_TO_TRAJECTORY, _TO_SYSTEM = (word_of(UNIT, name) for name in ("samples_to_trajectory", "trajectories_to_system"))
_FIRED = word_of(UNIT, "fired_watches")
_SOURCE, _ORIGIN = axis_word("feedback_source"), axis_word("profile_origin_counts")
_LATCHED, _EXTRA, _STATUS = (axis_word(name) for name in ("latched_status", "extra_status", "status"))
_EVENTS = axis_word("events")

_EVENT_OF = {0: Event.NONE} | {event.value: event for event in Event}


def _event(mask: int) -> Event:
    try:
        return _EVENT_OF[mask]
    except KeyError:
        return _EVENT_OF.setdefault(mask, Event(mask))


class Engine(ProfileStreams):
    """The servo of one unit. Drives are off, wires open and gains those of power-up until set."""

    def __init__(
        self,
        axes: Sequence[AxisHardware],
        *,
        rates: ServoRates,
        dac_bits: int = DEFAULT_DAC_BITS,
        on_build: OnBuild | None = None,
        unit_factors: UnitFactors | None = None,
        drive_off_to_zero: bool = False,
        output_delay_s: float = 0.0,
        measurement: MasterMeasurement | None = None,
    ) -> None:
        """`output_delay_s` is the time from a servo sample to the moment at which the output computed in it appears at
        the terminals; more than a sample counts as a whole one."""
        if not 1 <= len(axes) <= MAX_AXES:
            raise ValueError(f"a unit has 1 to {MAX_AXES} axes, not {len(axes)}")
        super().__init__(Memory(len(axes)), output_delay_s=output_delay_s)
        self._gains = [Gains() for _ in axes]
        self._factors = unit_factors or UnitFactors()
        self._kernel = load_kernel(on_build)
        self._bind()
        self.scope = Scope(self._memory, self._bind)
        """Records signals at servo rate."""
        write_fields(
            self._memory.unit,
            UNIT,
            {"axis_count": len(axes), "drive_off_to_zero": drive_off_to_zero, **dac_fields(dac_bits)},
        )
        self._init_following(len(axes), measurement or MasterMeasurement())
        self._init_ratio_streams(len(axes))
        self._init_profile_streams(len(axes))
        for axis_index, hardware in enumerate(axes):
            self._power_up(axis_index, hardware)
        self.set_rates(rates)

    def _bind(self) -> None:
        """Tell the kernel where the arrays lie; to be repeated when one has moved."""
        self._calls: Calls = self._kernel.bind(self._memory)

    def _power_up(self, axis_index: int, hardware: AxisHardware) -> None:
        self._connect(axis_index, hardware)
        self.connect_trigger(axis_index, 0)
        self._write(
            axis_index, position_error_limit=DEFAULT_POSITION_ERROR_LIMIT, output_limit_v=10.0, hard_limit_enable=3
        )
        self.set_gains(axis_index, Gains())
        self.set_target_zone(axis_index, distance_counts=50, velocity_counts_s=hardware.counts_per_rev, timeout_ms=1000)

    def power_up(self) -> None:
        """Switch the electronics off and on: drives off, counters at 0, latched status and masters gone; shafts, wires
        and time go on. Gains, limits and zones keep their values until they are set again."""
        for axis_index, ints in enumerate(self._ints):
            self.disable(axis_index)
            self.set_master(axis_index, source=MasterSource.NONE)
            ints[_LATCHED] = ints[_EXTRA] = ints[_EVENTS] = 0
            ints[_SOURCE] = ENCODER_SOURCE
            ints[COMMANDED] = ints[OFFSET] = ints[ENCODER_OFFSET] = ints[FEEDBACK] = ints[ENCODER]
            ints[ANI_OFFSET] = 0
            self._write(axis_index, previous_feedback_counts=ints[ENCODER], system_feedback_counts=ints[ENCODER])
            self._write(axis_index, pending_events=0, term_i=0.0, settling_ns=0, capture_mode=Capture.NONE)
        self.clear_watches()
        self.forget_captures()

    # Time

    @property
    def time_ns(self) -> int:
        """Virtual time the unit has reached, ns."""
        return self._unit[_TIME]

    @property
    def rates(self) -> ServoRates:
        """The servo, trajectory and system update rates in force."""
        return self._rates

    @property
    def next_trajectory_ns(self) -> int:
        """Time of the first trajectory update after `time_ns`."""
        unit = self._unit
        return unit[_NEXT_SAMPLE] + (unit[_TO_TRAJECTORY] - 1) * unit[_SERVO]

    @property
    def next_system_update_ns(self) -> int:
        """Time of the first system update after `time_ns`."""
        return self.next_trajectory_ns + (self._unit[_TO_SYSTEM] - 1) * self._rates.trajectory_ns

    def run(self, until_ns: int) -> Event:
        """Run every sample up to `until_ns`, or up to the first system update with events; returns the events.

        Afterwards `time_ns` is that system update's time, or `until_ns`. A time already passed changes nothing.
        """
        unit = self._unit
        ahead_ns = until_ns - unit[_NEXT_SAMPLE]
        if ahead_ns < 0:
            if until_ns > unit[_TIME]:
                unit[_TIME] = until_ns
            return Event.NONE
        self._stale = False
        short = ahead_ns < self._short_run_ns
        events = self._calls.short_run(until_ns) if short else self._calls.long_run(until_ns)
        if events & EVENT_ROWS_LOW:
            self._feed_streams()
        return _event(events)

    def set_rates(self, rates: ServoRates) -> None:
        """Change the rates; the grid of samples and updates begins anew at `time_ns`."""
        self._rates = rates
        self._short_run_ns = SHORT_RUN_SAMPLES * rates.servo_ns
        fields = {
            "servo_ns": rates.servo_ns,
            "servo_s": rates.servo_ns / NS_PER_S,
            "servo_hz": NS_PER_S / rates.servo_ns,
            "system_hz": NS_PER_S / rates.system_ns,
            "samples_per_trajectory": rates.samples_per_trajectory,
            "trajectories_per_system": rates.trajectories_per_system,
            "samples_to_trajectory": rates.samples_per_trajectory,
            "trajectories_to_system": rates.trajectories_per_system,
            "next_sample_ns": self.time_ns + rates.servo_ns,
        }
        write_fields(self._memory.unit, UNIT, fields)
        self.scope.note_rates()
        self._set_steps()
        for axis_index in range(len(self._ints)):
            self._retime_following(axis_index)

    # Faults

    def stick_output(self, axis_index: int, volts: float | None) -> None:
        """The analogue output stays at a voltage from the next servo sample on; None: it follows the law again."""
        self._write(axis_index, output_stuck=volts is not None, stuck_v=volts or 0.0)

    # Drive

    def enable(self, axis_index: int) -> None:
        """Drive on: the commanded position takes over the feedback, AS bits 13, 14 and 23 clear, nothing jumps."""
        ints = self._ints[axis_index]
        if not ints[ENABLED]:
            ints[COMMANDED] = ints[FEEDBACK]
            self._write(axis_index, enabled=1, term_i=0.0, previous_feedback_counts=ints[FEEDBACK])
        ints[_LATCHED] &= ~CLEARED_BY_ENABLE
        self._stale = True

    def disable(self, axis_index: int) -> None:
        """Drive off: any profile is given up, the command follows the feedback, the motor coasts.

        The output becomes SOFFS at the next servo sample.
        """
        self.cancel_profile(axis_index)
        self._write(axis_index, enabled=0, commanded_counts=self._ints[axis_index][FEEDBACK])

    # Profiles

    def start_profile(self, axis_index: int, segments: Segments) -> None:
        """Start a profile (reported counts) at the next trajectory update, in place of one that is running.

        DriveShutDown if the drive is off, ValueError for no segments. In open loop (SFB0) a profile runs out its
        time without moving anything (assumed).
        """
        if not segments:
            raise ValueError("a profile needs at least one segment")
        if not self._ints[axis_index][ENABLED]:
            raise DriveShutDown(f"the drive of axis {axis_index + 1} is off")
        offset = self._ints[axis_index][OFFSET]
        raw = tuple(segment.moved(offset) for segment in segments)
        self._give_up_motion(axis_index)
        duration_s = profile_duration(raw)
        end = evaluate(raw, duration_s).position if duration_s < math.inf else 0.0
        self._load(axis_index, Portion(self.next_trajectory_ns, 0, 0.0, raw, duration_s, end, NO_REFILL))
        self._write(axis_index, profile_active=TIMED, settling=0)

    def cancel_profile(self, axis_index: int) -> None:
        """Give up the profile at once: the commanded position stays where it is."""
        self._give_up_motion(axis_index)
        self._write(axis_index, profile_active=0, commanded_velocity=0.0, commanded_acceleration=0.0, settling=0)

    def profile_state(self, axis_index: int) -> State:
        """Position, velocity, acceleration the profile will have at the next trajectory update: what a new plan
        starts from. At rest the commanded position."""
        position, velocity, acceleration = self._raw_state(axis_index)
        return State(position - self._ints[axis_index][OFFSET], velocity, acceleration)

    def profile_target(self, axis_index: int) -> float | None:
        """Reported counts at which the running profile ends; None for one that goes on for ever."""
        if self.is_following(axis_index):
            return self._slave_end(axis_index)
        segments = self._profiles[axis_index]
        duration_s = profile_duration(segments)
        if duration_s == float("inf"):
            return None
        ints = self._ints[axis_index]
        return evaluate(segments, duration_s).position + ints[_ORIGIN] - ints[OFFSET]

    # Settings

    def set_gains(self, axis_index: int, gains: Gains) -> None:
        """Put a gain set into force at the next servo sample; ValueError for a gain that is not a finite number.

        The integrator's state is a voltage and goes over as it is, so a change of gains, also in motion, makes no step
        of the integral term; only SGI 0 clears it and a lower SGILIM cuts it.
        """
        self._write(axis_index, **gain_fields(gains, self._factors))
        self._gains[axis_index] = gains

    def gains(self, axis_index: int) -> Gains:
        """The gain set in force."""
        return self._gains[axis_index]

    def set_output(self, axis_index: int, *, offset_v: float | None = None, limit_v: float | None = None) -> None:
        """SOFFS and DACLIM, V; ValueError for what is not a number."""
        if not all(volts is None or math.isfinite(volts) for volts in (offset_v, limit_v)):
            raise ValueError(f"the output cannot be set to {offset_v} V, {limit_v} V")
        self._write(axis_index, offset_v=offset_v, output_limit_v=limit_v)

    def set_position_error_limit(self, axis_index: int, counts: int) -> None:
        """SMPER, counts; 0 = position error not watched."""
        self._write(axis_index, position_error_limit=counts)

    def set_dither(self, axis_index: int, *, amplitude_v: float, half_period_samples: int) -> None:
        """SDTAMP, V, and SDTFR, servo samples in half a period of the square wave; 0 = none.

        ValueError for an amplitude that is not a number.
        """
        if not math.isfinite(amplitude_v):
            raise ValueError(f"a dither of {amplitude_v} V is not possible")
        self._write(axis_index, dither_v=amplitude_v, dither_samples=half_period_samples, dither_sample=0)

    def set_hard_limits(
        self,
        axis_index: int,
        *,
        enable: int | None = None,
        positive_active_level: int | None = None,
        negative_active_level: int | None = None,
    ) -> None:
        """LH (0 none, 1 positive direction disabled, 2 negative direction disabled, 3 both enabled) and LHLVL.

        Active level 0: an open input is the limit; 1: a grounded one.
        """
        self._write(
            axis_index,
            hard_limit_enable=enable,
            positive_active_level=positive_active_level,
            negative_active_level=negative_active_level,
        )

    def set_soft_limits(
        self, axis_index: int, *, enable: int | None = None, positive: int | None = None, negative: int | None = None
    ) -> None:
        """LS (codes as LH), LSPOS and LSNEG in reported counts; in force only while the two positions differ."""
        self._write(axis_index, soft_limit_enable=enable, positive_soft_limit=positive, negative_soft_limit=negative)

    def set_target_zone(
        self,
        axis_index: int,
        *,
        enable: bool | None = None,
        distance_counts: float | None = None,
        velocity_counts_s: float | None = None,
        timeout_ms: int | None = None,
    ) -> None:
        """STRGTE, STRGTD, STRGTV, STRGTT."""
        self._write(
            axis_index,
            target_zone_enable=enable,
            target_distance=distance_counts,
            target_velocity=velocity_counts_s,
            target_timeout_ns=None if timeout_ms is None else timeout_ms * NS_PER_MS,
            settling=0 if enable is not None and not enable else None,
        )

    # Status, watches, events

    def latch_status(self, axis_index: int, mask: int) -> None:
        """Set latched AS bits."""
        self._ints[axis_index][_LATCHED] |= mask
        self._stale = True

    def clear_status(self, axis_index: int, mask: int) -> None:
        """Clear latched AS bits."""
        self._ints[axis_index][_LATCHED] &= ~mask
        self._stale = True

    def set_extra_status(self, axis_index: int, word: int) -> None:
        """Set the AS bits the controller owns; they are or-ed into the word."""
        self._ints[axis_index][_EXTRA] = word
        self._stale = True

    def status(self, axis_index: int) -> int:
        """The AS word, bit n of the manual = 1 << (n - 1)."""
        if self._stale:
            self._refresh()
        return self._ints[axis_index][_STATUS]

    def _refresh(self) -> None:
        """Bring the status words up to date; no sample is due at a time already reached."""
        self._calls.short_run(self._unit[_TIME])
        self._stale = False

    def watch_status(self, axis_index: int, mask: int) -> None:
        """Report STATUS when any AS bit of `mask` differs from now, or from the last report; 0 ends the watch."""
        self._write(axis_index, watch_mask=mask, watched_status=self.status(axis_index) & mask)

    def watch_value(
        self, slot: int, axis_index: int, signal: Signal | str, relation: Relation | str, threshold: float
    ) -> None:
        """Report VALUE at the first system update at which `signal relation threshold` holds, then disarm.

        `signal` is a Signal or its name, `relation` a Relation or one of = <> < > <= >=. There are WATCH_SLOTS slots.
        """
        if not 0 <= slot < WATCH_SLOTS:
            raise ValueError(f"watch slots are 0 to {WATCH_SLOTS - 1}, not {slot}")
        code = Signal[signal] if isinstance(signal, str) else Signal(signal)
        sign = Relation.of(relation) if isinstance(relation, str) else Relation(relation)
        self._memory.watches[slot] = (1, axis_index, code, sign, threshold)
        self._memory.units["armed_watches"] = self._memory.watches["armed"].sum()

    def clear_watches(self) -> None:
        """Disarm every status watch and the value watches below FIRST_LASTING_WATCH."""
        self._memory.watches["armed"][:FIRST_LASTING_WATCH] = 0
        self._memory.units["armed_watches"] = self._memory.watches["armed"].sum()
        self._memory.units["fired_watches"] = 0
        self._memory.axes["watch_mask"] = 0
        self._memory.axes["following_watch_mask"] = 0

    def disarm_watch(self, slot: int) -> None:
        """Disarm one value watch."""
        self._memory.watches["armed"][slot] = 0
        self._memory.units["armed_watches"] = self._memory.watches["armed"].sum()

    def fired_watches(self) -> int:
        """Slots that fired since last asked, bit = slot; reading clears them."""
        fired = self._unit[_FIRED]
        self._unit[_FIRED] = 0
        return fired

    def axis_events(self, axis_index: int) -> Event:
        """Events of one axis since last asked; reading clears them."""
        ints = self._ints[axis_index]
        events = ints[_EVENTS]
        ints[_EVENTS] = 0
        return _event(events)

    # The whole

    @property
    def kernel_origin(self) -> str:
        """Where the kernel came from: interpreted, cache, built, or memory (built, could not be stored)."""
        return self._kernel.origin

    @property
    def memory(self) -> Memory:
        """The arrays the servo lives in; for copies of a whole engine (`batch`)."""
        return self._memory

    @property
    def kernel(self) -> Kernel:
        """The kernel the engine runs on."""
        return self._kernel

    def snapshot(self) -> bytes:
        """The whole servo state; equal bytes mean equal states."""
        self._refresh()
        return self._memory.snapshot()

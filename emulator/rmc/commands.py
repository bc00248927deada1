"""What each command does to its axis, between two loops.

`execute` looks a command up in the table of `protocol.rmc.commands`, checks its parameters, and has the function marked
`@carries_out("name")` do it. What cannot be done leaves the axis as it is and sets the Command Error bit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

from protocol.rmc.bits import ControlMode, ErrorBits
from protocol.rmc.commands import COMMAND_BY_NUMBER, REQUEST, CommandType
from protocol.rmc.maps import STATUS_FILE, VARIABLE_FILES, Place

from .axis import Axis, Complaint, Refused
from .laws import FULL_PERCENT, clear_terms, take_over
from .memory import master_word

if TYPE_CHECKING:
    from .parameters import Parameters

COMMAND_FOLLOWS_BOTH, COMMAND_FOLLOWS_VELOCITY, COMMAND_FOLLOWS_POSITION, COMMAND_STANDS = 3, 2, 1, 0

MASTER_FIELDS = {
    8: "actual_position",
    9: "actual_velocity",
    33: "control_v",
    45: "pfid",
    53: "target_position",
    54: "target_velocity",
    56: "command_position",
    57: "command_velocity",
}
"""Status elements that can be the master of a gear, and their fields (design choice: what moves)."""


class DeviceLike(Protocol):
    """What commands know of the device around an axis."""

    enable_output_follows: bool

    @property
    def axes(self) -> Sequence[Axis]: ...
    @property
    def parameters(self) -> Sequence[Parameters]: ...
    def next_mode_of(self, code: int) -> ControlMode | None:
        """The mode of a code of Set Pos/Vel Ctrl Mode."""

    def value_of_master(self, place: Place) -> float:
        """What a register that is a master shows."""


Values = Sequence[float]
Carry = Callable[[DeviceLike, Axis, Values], None]

CARRIED: dict[str, Carry] = {}


def carries_out(*names: str) -> Callable[[Carry], Carry]:
    """Mark the function that does these commands."""

    def mark(function: Carry) -> Carry:
        CARRIED.update(dict.fromkeys(names, function))
        return function

    return mark


def execute(device: DeviceLike, axis: Axis, numbers: Sequence[float]) -> None:
    """Carry out a command block: the number as it was written, REQ included, and its parameters."""
    try:
        command = _command_of(numbers[0])
        if command.number == 0:
            return
        values = _values_of(command, numbers[1:])
        if command.motion:
            _refuse_while_disabled(axis, command)
            if _goes_on(axis, command, values):
                return
        _do(device, axis, command, values)
    except Refused as refused:
        axis.complain(ErrorBits.COMMAND, refused.complaint)


def _command_of(number: float) -> CommandType:
    if not math.isfinite(number) or number != int(number):
        raise Refused(Complaint.UNKNOWN_COMMAND)
    bare = int(number) - REQUEST if number >= REQUEST else int(number)
    command = COMMAND_BY_NUMBER.get(bare)
    if command is None:
        raise Refused(Complaint.UNKNOWN_COMMAND)
    if not command.built:
        raise Refused(Complaint.NOT_BUILT)
    return command


def _values_of(command: CommandType, given: Sequence[float]) -> list[float]:
    """As many values as the command has parameters; those not written are 0."""
    values = [*given, *[0.0] * len(command.fields)][: len(command.fields)]
    if not all(field.allows(value) for field, value in zip(command.fields, values, strict=True)):
        raise Refused(Complaint.BAD_PARAMETER)
    return values


def _refuse_while_disabled(axis: Axis, command: CommandType) -> None:
    if not axis.integer("enabled") and command.name != "direct_output":
        raise Refused(Complaint.NOT_ENABLED)


def _goes_on(axis: Axis, command: CommandType, values: list[float]) -> bool:
    """The same absolute command once more, while its motion runs, changes nothing (H param_requested_jerk)."""
    return command.name in {"move_absolute", "move_velocity"} and axis.running == (command.number, *values)


def _do(device: DeviceLike, axis: Axis, command: CommandType, values: list[float]) -> None:
    if not command.motion:
        CARRIED[command.name](device, axis, values)
        return
    # Cleared first: what the command itself has to complain of shall stay.
    axis.clear_faults()
    axis.sync_group = None
    CARRIED[command.name](device, axis, values)
    axis.began = (command.number, *values)


# Into a loop, out of it


def close(axis: Axis, mode: ControlMode) -> None:
    """Change over to a closed-loop mode. From open loop the target begins where the axis is, and as fast."""
    before = axis.mode
    axis.write(speed_limit=0.0, jump=0, off_when_done=0)
    if before == mode:
        return
    record = axis.record
    if not before.closed_loop:
        still = abs(axis["shown_velocity"]) < axis["stop_threshold"]
        axis.write(target_velocity=0.0 if still else axis["shown_velocity"], target_acceleration=0.0)
        axis.write(target_position=axis["actual_position"])
    percent = (axis["control_v"] - axis["output_bias"]) / axis["output_scale"] * FULL_PERCENT
    axis.write(mode=mode)
    if mode in {ControlMode.POSITION_I_PD, ControlMode.VELOCITY_I_PD} or before.closed_loop:
        take_over(record, percent - (0.0 if _is_i_pd(mode) else axis["term_vff"]))
    else:
        clear_terms(record)


def _is_i_pd(mode: ControlMode) -> bool:
    return mode in {ControlMode.POSITION_I_PD, ControlMode.VELOCITY_I_PD}


def close_position(axis: Axis) -> None:
    """Close the position loop in the next mode; Refused if that controls velocity."""
    if axis.next_mode.velocity:
        raise Refused(Complaint.WRONG_MODE)
    close(axis, axis.next_mode)


def go_for(axis: Axis, position: float) -> float:
    """Make a position the Command Position, held to the travel limits; the one that is gone for."""
    upper, lower = axis["positive_travel_limit"], axis["negative_travel_limit"]
    goal = max(lower, min(upper, position)) if upper > lower else position
    if goal != position:
        axis.complain(ErrorBits.COMMAND_MODIFIED, Complaint.CLIPPED_TO_TRAVEL_LIMIT)
    axis.write(command_position=goal, moves_to_position=1, command_follows=COMMAND_FOLLOWS_VELOCITY)
    return goal


def base_of(axis: Axis, relative_to: float) -> float:
    """What a relative command counts from: 0 Command, 1 Actual, 2 Target Position (M734)."""
    return axis[("command_position", "actual_position", "target_position")[int(relative_to)]]


def find_master(device: DeviceLike, axis: Axis, number: float) -> dict[str, float]:
    """Fields of the axis record that make a register its master; Refused for one that cannot be."""
    place = Place.of_number(int(number))
    index = place.file - STATUS_FILE
    if place.file in VARIABLE_FILES and place.element < 256 and number == int(number):
        variable = (place.file - VARIABLE_FILES[0]) * 256 + place.element
        found = {"master_word": -1, "master_variable": variable}
    elif 0 <= index < len(device.axes) and index != axis.index and place.element in MASTER_FIELDS:
        found = {"master_word": master_word(index, MASTER_FIELDS[place.element])}
    else:
        raise Refused(Complaint.BAD_PARAMETER)
    value = device.value_of_master(place)
    return {**found, "master": value, "previous_master": value}

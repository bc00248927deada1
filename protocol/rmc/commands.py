"""The commands of an axis: number, parameters with their ranges, and whether they move it.

A command is a REAL followed by up to nine REAL parameters. Parameters a page names stand in its order; where the order
is inferred the source says so. `built` is false for what this device refuses with the Command Error bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

LAST_REGISTER: Final = 59 * 4096 + 255
"""The last register there is, as a parameter names it: a variable."""
REQUEST: Final = 256
"""Added to a command's number by a host that toggles REQ (M424)."""


@dataclass(frozen=True, slots=True)
class Field:
    """A parameter of a command and what it may be."""

    name: str
    low: float = -math.inf
    high: float = math.inf
    positive: bool = False
    """Must be above 0."""
    choices: tuple[int, ...] = ()

    def allows(self, value: float) -> bool:
        """Whether a value may be given."""
        if not math.isfinite(value) or (self.positive and value <= 0.0) or not self.low <= value <= self.high:
            return False
        return not self.choices or value in self.choices


@dataclass(frozen=True, slots=True)
class CommandType:
    """One command."""

    number: int
    name: str
    title: str
    fields: tuple[Field, ...]
    source: str
    motion: bool = False
    """Moves the axis: refused while it is disabled (all but Direct Output), clears Halted and error bits."""
    built: bool = True


_SPEED = Field("speed", positive=True)
_ACCEL = Field("accel", positive=True)
_DECEL = Field("decel", positive=True)
_POSITION = Field("position")
_DISTANCE = Field("distance")
_RELATIVE_TO = Field("relative_to", choices=(0, 1, 2))
_GROUP = Field("group", choices=tuple(range(11)))
_MASTER = Field("master", low=0, high=LAST_REGISTER)
_OUTPUT = Field("output_v", low=-10.0, high=10.0)
_RAMP = Field("ramp_v_s", positive=True)
_NOT_BUILT: Final = ()


def _left_out(number: int, name: str, title: str, source: str) -> CommandType:
    return CommandType(number, name, title, _NOT_BUILT, source, motion=True, built=False)


COMMANDS: Final = (
    CommandType(0, "no_op", "No-op", (), "L Send_RMC150_Commands"),
    CommandType(1, "closed_loop_halt", "Closed Loop Halt", (), "H Halt_Closed_Loop"),
    CommandType(2, "open_loop_halt", "Open Loop Halt", (), "H Halt_Open_Loop"),
    CommandType(3, "direct_output_halt", "Direct Output Halt", (), "H Halt_Direct_Output"),
    CommandType(4, "clear_faults", "Clear Faults", (), "H Status_Error_Bits"),
    CommandType(
        5, "hold_position", "Hold Current Position", (Field("behaviour", choices=(0, 1)),), "M718", motion=True
    ),
    CommandType(6, "stop_closed_loop", "Stop (Closed Loop)", (_DECEL,), "M716", motion=True),
    CommandType(7, "enable_controller", "Enable Controller", (), "H Command_List, assumed M"),
    CommandType(8, "fault_controller", "Fault Controller", (), "H Command_List, assumed M"),
    CommandType(9, "direct_output", "Direct Output", (_OUTPUT, _RAMP), "H Cmd_Direct_Output", motion=True),
    CommandType(10, "open_loop_rate", "Open Loop Rate", (_OUTPUT, _RAMP), "M722", motion=True),
    CommandType(
        11, "open_loop_absolute", "Open Loop Absolute", (_OUTPUT, _POSITION), "M111; fields assumed L", motion=True
    ),
    CommandType(
        12, "open_loop_relative", "Open Loop Relative", (_OUTPUT, _DISTANCE), "M128; fields assumed L", motion=True
    ),
    CommandType(
        13,
        "sync_move_absolute",
        "Sync Move Absolute",
        (_POSITION, _SPEED, _ACCEL, _DECEL, _GROUP),
        "M729, order inferred",
        motion=True,
    ),
    CommandType(
        14,
        "sync_move_relative",
        "Sync Move Relative",
        (_DISTANCE, _SPEED, _ACCEL, _DECEL, _RELATIVE_TO, _GROUP),
        "M729",
        motion=True,
    ),
    CommandType(
        15,
        "quick_move_absolute",
        "Quick Move Absolute",
        (_POSITION, Field("output_v", low=0.0, high=10.0), _RAMP, _DECEL),
        "M736",
        motion=True,
    ),
    CommandType(
        16,
        "quick_move_relative",
        "Quick Move Relative",
        (_DISTANCE, Field("output_v", low=0.0, high=10.0), _RAMP, _DECEL, _RELATIVE_TO),
        "M737",
        motion=True,
    ),
    CommandType(17, "sync_stop", "Sync Stop", (_DECEL, _GROUP), "M729, order inferred", motion=True),
    CommandType(
        20,
        "move_absolute",
        "Move Absolute",
        (_POSITION, _SPEED, _ACCEL, _DECEL, Field("direction", choices=(-1, 0, 1, 2))),
        "H Commands",
        motion=True,
    ),
    CommandType(
        21, "move_relative", "Move Relative", (_DISTANCE, _SPEED, _ACCEL, _DECEL, _RELATIVE_TO), "M734", motion=True
    ),
    CommandType(22, "stop_open_loop", "Stop (Open Loop)", (_RAMP,), "M718, ramp assumed M", motion=True),
    CommandType(
        23,
        "time_move_absolute",
        "Time Move Absolute",
        (_POSITION, Field("time_s", low=0.0)),
        "M136, order inferred",
        motion=True,
    ),
    CommandType(
        24,
        "time_move_relative",
        "Time Move Relative",
        (_DISTANCE, Field("time_s", low=0.0), _RELATIVE_TO),
        "M136, order inferred",
        motion=True,
    ),
    CommandType(
        25,
        "gear_absolute",
        "Gear Absolute",
        (
            _MASTER,
            Field("master_a"),
            Field("master_b"),
            Field("slave_a"),
            Field("slave_b"),
            Field("end_point", choices=(0, 1, 2)),
        ),
        "M747, order inferred",
        motion=True,
    ),
    CommandType(
        26,
        "advanced_time_move_absolute",
        "Advanced Time Move Absolute",
        (_POSITION, Field("velocity"), Field("acceleration"), Field("time_s", positive=True)),
        "M743",
        motion=True,
    ),
    CommandType(
        27,
        "advanced_time_move_relative",
        "Advanced Time Move Relative",
        (_DISTANCE, Field("velocity"), Field("acceleration"), Field("time_s", positive=True), _RELATIVE_TO),
        "M743",
        motion=True,
    ),
    CommandType(28, "move_absolute_i_pd", "Move Absolute (I-PD)", (_POSITION, _SPEED), "M112", motion=True),
    CommandType(
        29, "move_relative_i_pd", "Move Relative (I-PD)", (_DISTANCE, _SPEED, _RELATIVE_TO), "M743", motion=True
    ),
    CommandType(
        30,
        "gear_clutch_by_time",
        "Gear Pos (Clutch by Time)",
        (Field("numerator"), Field("denominator"), _MASTER, Field("clutch_s", low=0.0)),
        "H cmd_gear_pos_(clutch_by_time)",
        motion=True,
    ),
    CommandType(
        32,
        "gear_clutch_by_distance",
        "Gear Pos (Clutch by Distance)",
        (
            Field("ratio"),
            _MASTER,
            Field("master_sync"),
            Field("slave_sync"),
            Field("start_distance", positive=True),
            Field("master_direction", choices=(-1, 1)),
            Field("slave_direction", choices=(-1, 0, 1, 2)),
        ),
        "H cmd_Gear_Pos_(Clutch_by_Distance)",
        motion=True,
    ),
    CommandType(36, "speed_at_position", "Speed at Position", (_POSITION, Field("velocity")), "M773", motion=True),
    CommandType(
        37,
        "move_velocity",
        "Move Velocity",
        (Field("speed"), _ACCEL, _DECEL, Field("direction", choices=(-1, 1, 2, 4))),
        "M800",
        motion=True,
    ),
    CommandType(38, "move_velocity_i_pd", "Move Velocity (I-PD)", (Field("velocity"),), "M113", motion=True),
    CommandType(
        39,
        "gear_clutch_by_rate",
        "Gear Pos (Clutch by Rate)",
        (Field("numerator"), Field("denominator"), _MASTER, _ACCEL),
        "M751",
        motion=True,
    ),
    CommandType(47, "offset_position", "Offset Position", (Field("change"),), "M838"),
    CommandType(49, "set_position", "Set Actual Position", (_POSITION,), "M838"),
    CommandType(
        57,
        "track_position",
        "Track Position",
        (
            _MASTER,
            Field("velocity_limit", positive=True),
            Field("accel_limit", positive=True),
            Field("jerk_limit", positive=True),
            Field("deadband", low=0.0),
        ),
        "M770",
        motion=True,
    ),
    CommandType(
        58,
        "track_position_i_pd",
        "Track Position (I-PD)",
        (_MASTER, Field("velocity_limit", positive=True)),
        "M772",
        motion=True,
    ),
    CommandType(67, "set_enable_output", "Set Enable Output", (Field("on", choices=(0, 1)),), "H Command_List"),
    CommandType(68, "set_control_mode", "Set Pos/Vel Ctrl Mode", (Field("mode", choices=(0, 1, 4, 5)),), "M840"),
    CommandType(69, "feed_forward_adjust", "Feed Forward Adjust", (), "M840"),
    CommandType(
        70,
        "integrator_adjust",
        "Integrator Adjust",
        (Field("percent", low=-100.0, high=100.0), Field("select", choices=(0, 1))),
        "M841",
    ),
    CommandType(
        71, "set_integrator_mode", "Set Integrator Mode", (Field("mode", choices=(0, 1, 2)),), "H Integrator_Adjust"
    ),
    _left_out(72, "sine_start", "Sine Start", "M136"),
    _left_out(82, "curve_add", "Curve Add", "M136"),
    _left_out(86, "curve_start", "Curve Start", "M794"),
    _left_out(88, "curve_start_advanced", "Curve Start Advanced", "M794"),
    _left_out(90, "start_task", "Start Task", "F enable-axis-from-c"),
    CommandType(97, "enable_axis", "Enable/Disable Axis", (Field("enable", choices=(0, 1)),), "F enable-axis-from-c"),
    _left_out(98, "run_mode", "RUN Mode", "H Command_List"),
    _left_out(99, "program_mode", "PROGRAM Mode", "H Command_List"),
)

COMMAND_BY_NUMBER: Final = {command.number: command for command in COMMANDS}
COMMAND_BY_NAME: Final = {command.name: command for command in COMMANDS}

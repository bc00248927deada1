"""An axis: its registers by tag, its commands, and waiting for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from clients.rmc.errors import RmcFault, RmcTimeout
from protocol.rmc.bits import ControlMode, ErrorBits, StatusBits
from protocol.rmc.commands import COMMAND_BY_NAME, REQUEST
from protocol.rmc.maps import Place
from protocol.rmc.registers import PARAMETER_BY_TAG, STATUS_BY_TAG
from protocol.rmc.words import Number, RegisterType

if TYPE_CHECKING:
    from clients.rmc.controller import RMC

PATIENCE_S = 60.0
"""How long waiting takes before it fails, unless told otherwise."""
LINEAR = 0
SIGNED = 4
"""Direction of Move Velocity: as the sign of the speed."""


class RmcAxis:
    """One axis of an `RMC`, counted from 0."""

    def __init__(self, rmc: RMC, index: int) -> None:
        self._rmc = rmc
        self.index = index
        self._request = False

    # Registers

    def read(self, tag: str) -> Number:
        """A status register or parameter; KeyError for an unknown tag."""
        place, kind = self._place(tag)
        return self._rmc.read(place, kind)

    def write(self, tag: str, value: Number) -> None:
        """A parameter; RmcRefused for a status register, KeyError for an unknown tag."""
        place, kind = self._place(tag)
        self._rmc.write(place, value, kind)

    def _place(self, tag: str) -> tuple[Place, RegisterType]:
        if tag in STATUS_BY_TAG:
            register = STATUS_BY_TAG[tag]
            return self._rmc.map.status(self.index, register.element), register.kind
        parameter = PARAMETER_BY_TAG[tag]
        return self._rmc.map.parameter(self.index, parameter.element), parameter.kind

    @property
    def status(self) -> StatusBits:
        """Status Bits."""
        return StatusBits(int(self.read("StatusBits")))

    @property
    def errors(self) -> ErrorBits:
        """Error Bits."""
        return ErrorBits(int(self.read("ErrorBits")))

    @property
    def mode(self) -> ControlMode:
        """Current Control Mode."""
        return ControlMode(int(self.read("CurrentControlMode")))

    @property
    def position(self) -> float:
        """Actual Position, pu."""
        return float(self.read("ActPos"))

    @property
    def velocity(self) -> float:
        """Actual Velocity, pu/s."""
        return float(self.read("ActVel"))

    # Commands

    def command(self, name: str, **values: float) -> None:
        """Any command of the table in `protocol.rmc.commands`, its parameters by name; ValueError for wrong ones."""
        command = COMMAND_BY_NAME[name]
        names = [field.name for field in command.fields]
        if unknown := sorted(set(values) - set(names)):
            raise ValueError(f"{name} has no parameter {', '.join(unknown)}; it has {', '.join(names) or 'none'}")
        self._rmc.send(self.index, [float(command.number), *(values.get(each, 0.0) for each in names)])

    def acknowledged(self, name: str, *, timeout_s: float = 5.0, **values: float) -> None:
        """As `command`, with REQ toggled, and wait for ACK: from then on the status belongs to this command (M425)."""
        command = COMMAND_BY_NAME[name]
        self._request = not bool(self.status & StatusBits.ACKNOWLEDGE)
        number = command.number + (REQUEST if self._request else 0)
        self._rmc.send(self.index, [float(number), *(values.get(field.name, 0.0) for field in command.fields)])
        wanted = self._request
        self.wait_until(
            lambda axis: bool(axis.status & StatusBits.ACKNOWLEDGE) == wanted, timeout_s=timeout_s, what="ACK"
        )

    def enable(self) -> None:
        """Accept motion commands from now on."""
        self.command("enable_axis", enable=1)

    def disable(self) -> None:
        """Refuse motion commands; the output goes to 0."""
        self.command("enable_axis", enable=0)

    def clear_faults(self) -> None:
        """Clear error bits whose cause has gone."""
        self.command("clear_faults")

    def move_absolute(self, position: float, *, speed: float, accel: float, decel: float | None = None) -> None:
        """To a position, pu; `decel` is as `accel` unless given."""
        values = {"speed": speed, "accel": accel, "decel": accel if decel is None else decel}
        self.command("move_absolute", position=position, direction=LINEAR, **values)

    def move_relative(self, distance: float, *, speed: float, accel: float, decel: float | None = None) -> None:
        """By a distance from the Command Position."""
        values = {"speed": speed, "accel": accel, "decel": accel if decel is None else decel}
        self.command("move_relative", distance=distance, relative_to=0, **values)

    def move_velocity(self, speed: float, *, accel: float, decel: float | None = None) -> None:
        """Run at a signed speed until told otherwise."""
        values = {"accel": accel, "decel": accel if decel is None else decel}
        self.command("move_velocity", speed=speed, direction=SIGNED, **values)

    def stop(self, *, decel: float) -> None:
        """Ramp the target to rest."""
        self.command("stop_closed_loop", decel=decel)

    def hold(self) -> None:
        """Hold the present position."""
        self.command("hold_position", behaviour=0)

    def set_mode(self, code: int) -> None:
        """Next control mode: 0 Position PID, 1 Position I-PD, 4 Velocity PID, 5 Velocity I-PD (names inferred)."""
        self.command("set_control_mode", mode=code)

    def open_loop(self, volts: float, *, ramp_v_s: float = 100.0) -> None:
        """A voltage in open loop."""
        self.command("open_loop_rate", output_v=volts, ramp_v_s=ramp_v_s)

    def direct_output(self, volts: float, *, ramp_v_s: float = 100.0) -> None:
        """A voltage with the AutoStops off."""
        self.command("direct_output", output_v=volts, ramp_v_s=ramp_v_s)

    # Waiting

    def wait_done(self, *, timeout_s: float = PATIENCE_S) -> None:
        """Wait for the target to have arrived; the axis itself may lag."""
        self._wait_for(StatusBits.TARGET_DONE, timeout_s)

    def wait_in_position(self, *, timeout_s: float = PATIENCE_S) -> None:
        """Wait for the axis to be where it was sent."""
        self._wait_for(StatusBits.IN_POSITION, timeout_s)

    def wait_at_velocity(self, *, timeout_s: float = PATIENCE_S) -> None:
        """Wait for the axis to run at the velocity asked for; in velocity control only."""
        self._wait_for(StatusBits.AT_VELOCITY, timeout_s)

    def wait_until(
        self, condition: Callable[[RmcAxis], bool], *, timeout_s: float = PATIENCE_S, what: str = "a condition"
    ) -> None:
        """Look again and again until the condition holds; RmcTimeout."""
        until_s = self._rmc.link.now_s() + timeout_s
        while not condition(self):
            if self._rmc.link.now_s() > until_s:
                raise RmcTimeout(f"axis {self.index}: no {what} within {timeout_s:g} s")
            self._rmc.link.pause()

    def _wait_for(self, bit: StatusBits, timeout_s: float) -> None:
        """Wait for a status bit; RmcFault if the axis is halted meanwhile."""
        self.wait_until(lambda axis: axis.shows(bit), timeout_s=timeout_s, what=str(bit.name))

    def shows(self, bit: StatusBits) -> bool:
        """Whether a status bit is set; RmcFault if the axis has been halted."""
        first = self._rmc.read_bits(self._rmc.map.status(self.index, 0), 2)
        if first[0] & (StatusBits.HALTED | StatusBits.EXTERNAL_HALT):
            raise RmcFault(f"axis {self.index} is halted, error bits {ErrorBits(first[1])!r}")
        return bool(first[0] & bit)

"""One RMC in virtual time: axes, parameters, variables, and the kernel that runs its loops.

Python is between two loops whenever it is anywhere: `advance` runs the kernel up to a time, and what a master writes
then takes effect at the next loop, on all axes together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from emulator.engine.layout import places_of
from emulator.engine.machine_code import OnBuild
from emulator.engine.plants import Plant, load_fields, plant_fields
from emulator.engine.travel import Travel
from emulator.machine import Machine
from protocol.rmc.bits import AUTOSTOP_BITS, AUTOSTOP_FIELDS, ControlMode, ErrorBits
from protocol.rmc.maps import MAPS, STATUS_FILE, VARIABLE_FILES, Place
from protocol.rmc.registers import PARAMETER_BY_TAG

from . import motion_commands, state_commands, sync_moves
from .axis import Axis
from .commands import MASTER_FIELDS, execute
from .layout import BODIES_PER_AXIS, DEVICE, MACHINE, MODEL
from .machine_code import bind, load_kernel
from .memory import Memory
from .parameters import Parameters
from .sync_moves import match_times
from .tables import HALT_LEVELS, RmcAxis

NS_PER_US = 1_000
SHORT_LOOPS = 20
"""Loops up to which the kernel keeps the interpreter lock: handing it over costs more than they do."""
TRANSDUCER_RANGES = {"quadrature": (-(2**31), 2**31 - 1), "mdt": (0, 1_048_575)}
HIGH_ORDERS = ("none", "acceleration_control", "active_damping")

_DEVICE_WORDS = {name: word for name, (word, _) in places_of(DEVICE).items()}

COMMAND_MODULES = (motion_commands, state_commands, sync_moves)
"""Imported for the commands they carry out."""


class RmcDevice:
    """A controller with the axes of a machine file; raises nothing once it is built."""

    def __init__(self, machine: Machine | None = None, *, on_build: OnBuild | None = None) -> None:
        machine = machine or Machine.default()
        self.machine = machine
        self.rmc = machine.rmc
        self.map = MAPS[self.rmc.map]
        self.enable_output_follows = self.rmc.enable_output_follows
        self.loop_ns = self.rmc.loop_us * NS_PER_US
        self.memory = Memory(self.rmc.axes, self.loop_ns)
        self._calls = bind(load_kernel(on_build), self.memory)
        self._now_ns = 0
        self.axes = [Axis(self.memory, index) for index in range(self.rmc.axes)]
        self.parameters = [self._parameters(axis) for axis in self.axes]
        self._plants: list[Plant] = []
        for axis in self.axes:
            self._power_up(axis)
        self._modes = {
            self.rmc.mode_codes.position_pid: ControlMode.POSITION_PID,
            self.rmc.mode_codes.position_i_pd: ControlMode.POSITION_I_PD,
            self.rmc.mode_codes.velocity_pid: ControlMode.VELOCITY_PID,
            self.rmc.mode_codes.velocity_i_pd: ControlMode.VELOCITY_I_PD,
        }
        self._mode_codes = {mode: code for code, mode in self._modes.items()}
        self._refresh()

    # Power-up

    def _table(self, axis: Axis) -> RmcAxis:
        return self.machine.all_axes[axis.index].rmc

    def _parameters(self, axis: Axis) -> Parameters:
        return Parameters(axis, map_name=self.rmc.map, simulate=self._table(axis).simulate)

    def _power_up(self, axis: Axis) -> None:
        table = self._table(axis)
        lowest, highest = TRANSDUCER_RANGES[table.transducer]
        axis.write(
            mode=ControlMode.OPEN_LOOP,
            next_mode=ControlMode.POSITION_PID,
            target_done=1,
            command_follows=3,
            master_word=-1,
            simulated=table.simulate != "off",
            high_order=HIGH_ORDERS.index(table.high_order),
            halt_group=table.halt_group,
            lowest_count=lowest,
            highest_count=highest,
            output_limit=self.rmc.output_limit_v,
            closed_loop_halt_decel=self.rmc.closed_loop_halt_decel,
            open_loop_halt_ramp=self.rmc.open_loop_halt_ramp,
        )
        self._connect(axis, table)
        self.parameters[axis.index].load(self._start_parameters(table))
        if self.rmc.enabled_at_start:
            state_commands.enable(self, axis)

    def _start_parameters(self, table: RmcAxis) -> Mapping[int, float]:
        """Parameters at power-up: AutoStops as the machine file has them, and what it gives by tag."""
        level = HALT_LEVELS.index(self.rmc.autostop)
        word = sum(level << AUTOSTOP_BITS * field for field in range(AUTOSTOP_FIELDS))
        given = {PARAMETER_BY_TAG[tag].element: value for tag, value in table.parameters.items()}
        return {106: word, 107: word, 108: word, **given}

    def _connect(self, axis: Axis, table: RmcAxis) -> None:
        """The machine and the transducer of an axis, and the model's."""
        from emulator.controller.build import axis_hardware

        hardware = axis_hardware(self.machine.all_axes[axis.index], max_rate_counts_s=self.machine.encoder.max_rate)
        period_s = float(self.memory.device["loop_s"][0])
        body = BODIES_PER_AXIS * axis.index + MACHINE
        traits = hardware.encoder
        self._plants.append(hardware.plant)
        self.memory.write_plant(body, plant_fields(hardware.plant, period_s))
        self.memory.write_body(
            body,
            {
                **traits.fields(axis.index),
                **load_fields(hardware.plant),
                **traits.step_fields(
                    period_s, load_apart=hardware.plant.load_apart, driven=hardware.motion is not None
                ),
                **({} if hardware.motion is None else hardware.motion.fields(origin_counts=0.0, now_ns=0)),
                "counts_per_rev": hardware.counts_per_rev,
                "encoder_phase": hardware.encoder_phase,
                "encoder_counts": table.start_counts,
            },
        )
        self._wire(axis, hardware.travel)
        model = BODIES_PER_AXIS * axis.index + MODEL
        self.memory.write_body(model, {"enabled": 1, "encoder_sign": 1, "counts_per_rev": 1.0})
        self.memory.write_body(model, {"encoder_step_limit": 2.0**31, "encoder_easy_step": 2.0**31})
        axis.write(raw_counts=table.start_counts if table.simulate == "off" else 0)

    def _wire(self, axis: Axis, travel: Travel) -> None:
        """Limit and fault inputs: an open limit contact is active, and a closed fault contact (assumed)."""
        wires = self.machine.all_axes[axis.index].wires
        axis.write(positive_switch=travel.positive_limit_rev, negative_switch=travel.negative_limit_rev)
        self.set_input(axis.index, ErrorBits.POSITIVE_LIMIT_INPUT, active=wires.positive_limit == "open")
        self.set_input(axis.index, ErrorBits.NEGATIVE_LIMIT_INPUT, active=wires.negative_limit == "open")
        self.set_input(axis.index, ErrorBits.FAULT_INPUT, active=wires.drive_fault == "closed")

    # Time

    @property
    def now_ns(self) -> int:
        """Virtual time."""
        return self._now_ns

    @property
    def busy(self) -> bool:
        """A target or an output is on its way."""
        return any(axis.moving for axis in self.axes)

    def advance(self, until_ns: int) -> None:
        """Run every loop up to `until_ns`."""
        loops = (until_ns - self._now_ns) // self.loop_ns
        (self._calls.short_run if loops <= SHORT_LOOPS else self._calls.long_run)(until_ns)
        self._now_ns = until_ns

    def advance_to_change(self, until_ns: int, mask: int) -> bool:
        """Run up to `until_ns`, or to the loop in which a status bit of `mask` changes; whether one did."""
        words = self.memory.device_words.ints
        place = _DEVICE_WORDS["watch_mask"]
        for axis in self.axes:
            axis.write(watched_status=axis.integer("status") & mask)
        words[place] = mask
        changed = bool(self._calls.long_run(until_ns))
        words[place] = 0
        self._now_ns = max(self._now_ns, words[_DEVICE_WORDS["next_loop_ns"]] - self.loop_ns) if changed else until_ns
        return changed

    def _refresh(self) -> None:
        """Bring the status words up to date; no loop is due at a time already reached."""
        self._calls.short_run(self._now_ns)

    # What a master does

    def execute(self, blocks: Mapping[int, Sequence[float]]) -> None:
        """Carry out the command blocks of one write, by axis index: all take effect at the next loop."""
        for index, numbers in blocks.items():
            execute(self, self.axes[index], numbers)
        if len(blocks) > 1:
            match_times([self.axes[index] for index in blocks])
        self._refresh()

    def write_parameter(self, axis_index: int, element: int, bits: int) -> None:
        """Write a parameter register."""
        self.parameters[axis_index].write(element, bits)
        self._refresh()

    # What commands ask

    def next_mode_of(self, code: int) -> ControlMode | None:
        """The mode of a code of Set Pos/Vel Ctrl Mode."""
        return self._modes.get(code)

    def code_of_mode(self, mode: ControlMode) -> int:
        """The code of Next Pos/Vel Control Mode."""
        return self._mode_codes[mode]

    def value_of_master(self, place: Place) -> float:
        """What a register that is a master shows."""
        if place.file in VARIABLE_FILES:
            return float(self.memory.variables[(place.file - VARIABLE_FILES[0]) * 256 + place.element])
        return self.axes[place.file - STATUS_FILE][MASTER_FIELDS[place.element]]

    # What a test does

    def true_position(self, axis_index: int) -> float:
        """Where the machine of an axis is, in its encoder's units."""
        return float(self.memory.bodies[BODIES_PER_AXIS * axis_index + MACHINE]["true_position"])

    def change_machine(self, axis_index: int, **keys: float) -> None:
        """Change keys of an axis's plant while it runs, such as `load_torque_nm`; PlantError if that cannot be."""
        changes: dict[str, Any] = dict(keys)
        plant: Plant = replace(self._plants[axis_index], **changes)
        self._plants[axis_index] = plant
        body = BODIES_PER_AXIS * axis_index + MACHINE
        self.memory.write_plant(body, plant_fields(plant, float(self.memory.device["loop_s"][0])))
        self.memory.write_body(body, load_fields(plant))

    def set_input(self, axis_index: int, bit: ErrorBits, *, active: bool) -> None:
        """Operate the fault input or a limit input of an axis."""
        axis = self.axes[axis_index]
        wired = axis.integer("wired_inputs")
        axis.write(wired_inputs=wired | bit if active else wired & ~bit)

    def snapshot(self) -> bytes:
        """The whole state; equal bytes mean equal states."""
        return self.memory.snapshot()

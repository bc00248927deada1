"""The control surface: every signal that can be read and every action that can be done from outside the wire.

Each is declared once, as data: a name, a sentence, parameters with their units, a function.  The Python API is made
from this table, and whatever comes later (recording, an HTTP API, a panel) is made from the same one.  Axis signals
are declared once and exist for every axis as ``axis1.`` ..."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from emulator.controller import Controller
from emulator.controller import words as status
from emulator.controller.wires.panel_commands import press, release
from emulator.controller.wires.thumbwheel_bank import dial
from emulator.engine import EncoderMotion, EncoderWiring
from emulator.engine.trace import Source
from emulator.faults import FAULTS, Fault
from emulator.parameters import Parameter, Value, checked

__all__ = ["ACTIONS", "FAULTS", "Action", "Fault", "Parameter", "Signal", "Value", "describe_signals"]

NS_PER_S = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Signal:
    """Something to read: ``unit`` is empty for texts and bits.

    ``source`` is what the scope records for it at servo rate; None for what only exists between two runs of the servo.
    """

    name: str
    sentence: str
    unit: str
    read: Callable[[Controller], Value]
    source: Source | None = None


@dataclass(frozen=True, slots=True)
class Action:
    """Something to do; the function gets the controller and the parameters by name."""

    name: str
    sentence: str
    parameters: tuple[Parameter, ...]
    function: Callable[..., None]

    def carry_out(self, controller: Controller, values: Mapping[str, Value]) -> None:
        """Check the parameters and do it.

        Raises:
            KeyError: a parameter is missing or unknown.
            TypeError: a parameter has the wrong type.
        """
        values = checked(self.name, self.parameters, values)
        if controller.around_action is None:
            self.function(controller, **values)
            return
        with controller.around_action(self.name, values):
            self.function(controller, **values)


AxisRead = Callable[[Controller, int], Value]


@dataclass(frozen=True, slots=True)
class AxisSignal:
    """A signal every axis has; ``field``, ``minus`` and ``mask`` say what the scope records (see ``trace.Source``).

    A signal without a field cannot be recorded.
    ``field_without_load`` takes the place of ``field`` on an axis whose load turns rigidly with its motor.
    """

    name: str
    sentence: str
    unit: str
    read: AxisRead
    field: str | None
    minus: str | None = None
    mask: int = 0
    field_without_load: str | None = None

    def of(self, axis_index: int, *, load_apart: bool) -> Signal:
        """The signal of one axis."""
        field = self.field if load_apart or self.field_without_load is None else self.field_without_load
        return Signal(
            f"axis{axis_index + 1}.{self.name}",
            f"axis {axis_index + 1}: {self.sentence}",
            self.unit,
            lambda controller: self.read(controller, axis_index),
            None if field is None else Source(field, axis_index, self.minus, self.mask),
        )


AXIS_SIGNALS: tuple[AxisSignal, ...] = (
    AxisSignal(
        "position.commanded",
        "commanded position as reported",
        "counts",
        lambda c, i: c.engine.commanded_position(i),
        "commanded_counts",
        minus="offset_counts",
    ),
    AxisSignal(
        "position.actual",
        "position of the selected feedback as reported",
        "counts",
        lambda c, i: c.engine.feedback_position(i),
        "feedback_counts",
        minus="offset_counts",
    ),
    AxisSignal(
        "position.encoder",
        "encoder position as reported",
        "counts",
        lambda c, i: c.engine.encoder_position(i),
        "encoder_counts",
        minus="encoder_offset_counts",
    ),
    AxisSignal(
        "position.ani",
        "position of the ANI feedback input as reported",
        "counts",
        lambda c, i: c.engine.ani_position(i),
        "ani_counts",
        minus="ani_offset_counts",
    ),
    AxisSignal(
        "position.true",
        "where the motor's shaft really is",
        "rev",
        lambda c, i: c.engine.true_position_rev(i),
        "true_position",
    ),
    AxisSignal(
        "position.load",
        "where the load really is, behind coupling and backlash",
        "rev",
        lambda c, i: c.engine.load_position_rev(i),
        "load_position",
        field_without_load="true_position",
    ),
    AxisSignal(
        "position.error",
        "commanded less actual position",
        "counts",
        lambda c, i: c.engine.position_error(i),
        "commanded_counts",
        minus="feedback_counts",
    ),
    AxisSignal(
        "velocity.commanded",
        "velocity of the profile",
        "counts/s",
        lambda c, i: c.engine.commanded_velocity(i),
        "commanded_velocity",
    ),
    AxisSignal(
        "velocity.actual",
        "velocity seen by the feedback over a system update",
        "counts/s",
        lambda c, i: c.engine.actual_velocity(i),
        "actual_velocity",
    ),
    AxisSignal(
        "velocity.true",
        "how fast the shaft really turns",
        "rev/s",
        lambda c, i: c.engine.true_velocity_rev_s(i),
        "true_velocity",
    ),
    AxisSignal(
        "acceleration.commanded",
        "acceleration of the profile",
        "counts/s2",
        lambda c, i: c.engine.commanded_acceleration(i),
        "commanded_acceleration",
    ),
    AxisSignal("servo.proportional", "SGP term", "V", lambda c, i: c.engine.terms(i)["P"], "term_p"),
    AxisSignal(
        "servo.integral", "SGI term: the integrator's state", "V", lambda c, i: c.engine.terms(i)["I"], "term_i"
    ),
    AxisSignal("servo.velocity", "SGV term", "V", lambda c, i: c.engine.terms(i)["V"], "term_v"),
    AxisSignal("servo.velocity_feedforward", "SGVF term", "V", lambda c, i: c.engine.terms(i)["VF"], "term_vf"),
    AxisSignal("servo.acceleration_feedforward", "SGAF term", "V", lambda c, i: c.engine.terms(i)["AF"], "term_af"),
    AxisSignal(
        "servo.output",
        "limited control signal before the converter",
        "V",
        lambda c, i: c.engine.terms(i)["output"],
        "control_v",
    ),
    AxisSignal("dac", "voltage at the analogue output", "V", lambda c, i: c.engine.dac_volts(i), "dac_v"),
    AxisSignal(
        "ani",
        "voltage at the ANI feedback input as converted",
        "V",
        lambda c, i: c.engine.ani_volts(i),
        None,
    ),
    AxisSignal(
        "master.position",
        "position in the master cycle",
        "counts",
        lambda c, i: c.engine.master_position(i),
        "cycle_counts",
    ),
    AxisSignal(
        "master.cycle",
        "master cycles finished since the last restart",
        "cycles",
        lambda c, i: c.engine.master_cycle_number(i),
        "cycle_number",
    ),
    AxisSignal(
        "master.velocity",
        "velocity of the filtered master",
        "counts/s",
        lambda c, i: c.engine.master_velocity(i),
        "master_velocity",
    ),
    AxisSignal(
        "slave.position",
        "commanded position of the slave as reported",
        "counts",
        lambda c, i: c.engine.slave_position(i),
        "commanded_counts",
        minus="offset_counts",
    ),
    AxisSignal("slave.shift", "net phase shift", "counts", lambda c, i: c.engine.net_shift(i), "shift_counts"),
    AxisSignal(
        "slave.ratio",
        "ratio of the slave at the last system update",
        "counts/count",
        lambda c, i: c.engine.present_ratio(i),
        "ratio_now",
    ),
    AxisSignal("drive", "the drive is on", "", lambda c, i: c.engine.is_enabled(i), "enabled"),
    AxisSignal("moving", "a profile is running", "", lambda c, i: c.engine.is_moving(i), "profile_active", mask=3),
    AxisSignal("settling", "waiting for the target zone", "", lambda c, i: c.engine.is_settling(i), "settling"),
    AxisSignal("status", "AS, bit 1 first", "", status.axis_status, "status"),
)


def _status_bit(number: int) -> AxisSignal:
    mask = 1 << (number - 1)
    return AxisSignal(
        f"status.{number}", f"AS bit {number}", "", lambda c, i: bool(c.engine.status(i) & mask), "status", mask=mask
    )


STATUS_BITS = tuple(_status_bit(number) for number in range(1, status.WORD + 1))

UNIT_SIGNALS: tuple[Signal, ...] = (
    Signal("time", "virtual time since power-up of the emulator", "s", lambda c: c.now_ns / NS_PER_S),
    Signal("power", "the unit is switched on", "", lambda c: c.powered),
    Signal("status.system", "SS, bit 1 first", "", status.system_status),
    Signal("status.error", "ER, bit 1 first", "", status.error_status),
    Signal("limits", "LIM, electrical", "", status.limit_inputs),
    Signal("inputs", "IN, after levels and overrides", "", status.inputs),
    Signal("outputs", "OUT, after functions and overrides", "", status.outputs),
    Signal(
        "outputs.sinking", "outputs that sink current, after OUTLVL", "", lambda c: c.output_functions.sinking_bits()
    ),
    Signal("status.user", "US, bit 1 first", "", status.user_status),
    Signal("line.received", "have reached the unit", "characters", lambda c: c.line.received),
    Signal("line.sent", "have left the unit", "characters", lambda c: c.line.sent),
    Signal("line.overruns", "lost in a full input buffer (timed line)", "characters", lambda c: c.line.overruns),
    Signal("line.buffered", "in the input buffer (timed line)", "characters", lambda c: c.line.buffered),
    Signal("line.held", "a host's XOFF holds the unit's output", "", lambda c: c.line.held),
    Signal("line.holds_hosts", "the unit has sent XOFF and not yet XON (timed line)", "", lambda c: c.line.holds_hosts),
    Signal("panel.display", "the operator panel's two lines of 40 characters", "", lambda c: "\n".join(c.panel.text)),
    Signal("panel.leds", "the operator panel's lamps, first lamp first", "", lambda c: c.panel.leds),
)


def _wire_signal(controller: Controller, wire: str) -> Signal:
    word, mask = controller.wiring.word(wire)
    return Signal(
        f"wire.{wire}",
        f"contact {wire} is closed (grounded)",
        "",
        lambda c: c.wiring.closed(wire),
        Source(word, mask=mask),
    )


def _output_signal(number: int) -> Signal:
    return Signal(
        f"output.{number}",
        f"output {number} is on",
        "",
        lambda c: c.output_functions.bits()[number - 1] == "1",
        Source("outputs", mask=1 << (number - 1)),
    )


def _analog_signal(channel: int) -> Signal:
    return Signal(
        f"analog.{channel}", f"voltage at joystick channel {channel}", "V", lambda c: c.wiring.analog_volts[channel - 1]
    )


def _trigger_signals(trigger_index: int, letter: str) -> list[Signal]:
    def edge_s(controller: Controller) -> float:
        edge_ns = controller.engine.captured_at_ns(trigger_index)
        return -1.0 if edge_ns is None else edge_ns / NS_PER_S

    return [
        Signal(f"capture.{letter}.time", f"when trigger {letter} last latched positions; -1 = never", "s", edge_s),
        Signal(
            f"capture.{letter}.count",
            f"captures of trigger {letter} since power-up",
            "captures",
            lambda c: c.engine.capture_count(trigger_index),
        ),
    ]


def _passing_signal(axis_index: int) -> Signal:
    def passed_s(controller: Controller) -> float:
        passed_ns = controller.on_position[axis_index].passed_ns
        return -1.0 if passed_ns is None else passed_ns / NS_PER_S

    return Signal(
        f"output_on_position.{axis_index + 1}.time",
        f"when axis {axis_index + 1} last passed its output position, with an on-time; -1 = never",
        "s",
        passed_s,
    )


def describe_signals(controller: Controller) -> dict[str, Signal]:
    """Every signal a unit has, by name."""
    signals = {signal.name: signal for signal in UNIT_SIGNALS}
    for axis_index in range(controller.settings.axes):
        for row in (*AXIS_SIGNALS, *STATUS_BITS):
            signal = row.of(axis_index, load_apart=controller.engine.plant(axis_index).load_apart)
            signals[signal.name] = signal
    for wire in controller.wiring.names:
        signals[f"wire.{wire}"] = _wire_signal(controller, wire)
    outputs = [_output_signal(number) for number in range(1, controller.output_functions.count + 1)]
    analog = [_analog_signal(channel) for channel in range(1, len(controller.wiring.analog_volts) + 1)]
    triggers = [each for index, letter in enumerate("ab") for each in _trigger_signals(index, letter)]
    passings = [_passing_signal(axis_index) for axis_index in range(controller.settings.axes)]
    for signal in (*outputs, *analog, *triggers, *passings):
        signals[signal.name] = signal
    return signals


def _set_wire(controller: Controller, name: str, closed: bool) -> None:
    controller.wiring.set(name, closed=closed)


def _press_trigger(controller: Controller, trigger: str, at: float, hold: float) -> None:
    """Errors: KeyError for a trigger that is not there, ValueError for a time that is over or no hold."""
    wire = f"trigger.{trigger.lower()}"
    resting = controller.wiring.closed_at_rest(wire)
    press_ns = round(at * NS_PER_S) if at else controller.now_ns
    if press_ns < controller.now_ns:
        raise ValueError(f"{at} s is over; it is {controller.now_ns / NS_PER_S} s")
    if not hold > 0.0:
        raise ValueError(f"hold must be above 0 s, not {hold}")
    controller.alarms.at(press_ns, lambda: controller.wiring.set(wire, closed=not resting))
    controller.alarms.at(press_ns + round(hold * NS_PER_S), lambda: controller.wiring.set(wire, closed=resting))
    controller.alarms.carry_out(controller.now_ns)


def _set_analog(controller: Controller, channel: int, volts: float) -> None:
    controller.wiring.set_analog(channel, volts=volts)


def _force_ani(controller: Controller, axis: int, volts: float) -> None:
    controller.wiring.force_ani(axis, volts=volts)


def _release_ani(controller: Controller, axis: int) -> None:
    controller.wiring.release_ani(axis)


def _cut_power(controller: Controller) -> None:
    controller.power_down()


def _restore_power(controller: Controller) -> None:
    if not controller.powered:
        controller.power_up()


def _damage_memory(controller: Controller) -> None:
    controller.memory_damaged = True


def _advance_time(controller: Controller, seconds: float) -> None:
    controller.advance(controller.now_ns + round(seconds * NS_PER_S))


def _axis_index(controller: Controller, axis: int) -> int:
    if not 1 <= axis <= controller.settings.axes:
        raise ValueError(f"axis must be 1 to {controller.settings.axes}, not {axis}")
    return axis - 1


def _set_load(controller: Controller, axis: int, torque: float) -> None:
    controller.engine.set_load(_axis_index(controller, axis), torque)


def _set_friction(controller: Controller, axis: int, torque: float) -> None:
    controller.engine.set_friction(_axis_index(controller, axis), torque)


def _wire_encoder(controller: Controller, axis: int, wiring: str) -> None:
    if wiring not in ENCODER_WIRINGS:
        raise ValueError(f"wiring must be {' or '.join(ENCODER_WIRINGS)}, not {wiring!r}")
    controller.engine.wire_encoder(_axis_index(controller, axis), ENCODER_WIRINGS[wiring])


def _drive_encoder(controller: Controller, axis: int, velocity: float, ramp: float) -> None:
    engine, axis_index = controller.engine, _axis_index(controller, axis)
    present = engine.encoder_velocity(axis_index)
    engine.move_encoder(axis_index, EncoderMotion(velocity, start_velocity_counts_s=present, ramp_s=ramp))


def _turn_encoder(controller: Controller, axis: int, counts: int, velocity: float) -> None:
    controller.engine.move_encoder(_axis_index(controller, axis), EncoderMotion.by(counts, velocity))


def _release_encoder(controller: Controller, axis: int) -> None:
    controller.engine.release_encoder(_axis_index(controller, axis))


def _slip_encoder(controller: Controller, axis: int, counts: int) -> None:
    controller.engine.slip_encoder(_axis_index(controller, axis), counts)


ENCODER_WIRINGS = {wiring.name.lower(): wiring for wiring in EncoderWiring}

AXIS = Parameter("axis", int, "1 or 2")

MACHINE_ACTIONS: tuple[tuple[str, str, Parameter, Callable[..., None]], ...] = (
    (
        "set_load",
        "change the load torque on an axis; positive acts against positive motion, as gravity on a lifted load does",
        Parameter("torque", float, "from now on", unit="Nm"),
        _set_load,
    ),
    (
        "set_friction",
        "change the dry friction of an axis",
        Parameter("torque", float, "from now on", unit="Nm"),
        _set_friction,
    ),
    (
        "wire_encoder",
        "connect an encoder rightly, with its channels exchanged, or not at all: then nothing is counted",
        Parameter("wiring", str, "normal, reversed or open"),
        _wire_encoder,
    ),
    (
        "slip_encoder",
        "turn an encoder on its shaft by some counts",
        Parameter("counts", int, "forwards positive", unit="counts"),
        _slip_encoder,
    ),
)
"""What can be changed about drives, loads and encoders while they run; each takes the axis as well."""


def _fault_actions(fault: Fault) -> Iterator[Action]:
    """A fault as actions, so that whatever carries out or records actions knows faults too."""
    yield Action(
        f"fault_{fault.name}",
        fault.sentence,
        fault.parameters,
        lambda controller, **values: fault.apply(controller, values),
    )
    if fault.lasting:
        yield Action(
            f"lift_{fault.name}",
            f"put an end to this: {fault.sentence}",
            fault.place_parameters(),
            lambda controller, **values: fault.lift(controller, values),
        )


ACTIONS: Mapping[str, Action] = {
    action.name: action
    for action in (
        Action(
            "set_wire",
            "close (ground) or open a contact at the unit's terminals",
            (Parameter("name", str, "the contact"), Parameter("closed", bool, "true grounds it")),
            _set_wire,
        ),
        Action(
            "press_trigger",
            "change a trigger's contact over at an exact time, between servo samples too, and back again",
            (
                Parameter("trigger", str, "A or B"),
                Parameter("at", float, "virtual time since power-up of the emulator; 0 = now", unit="s", default=0.0),
                Parameter("hold", float, "until it changes back", unit="s", default=0.01),
            ),
            _press_trigger,
        ),
        Action(
            "set_analog",
            "set the voltage of a joystick channel",
            (
                Parameter("channel", int, "1 to 3"),
                Parameter("volts", float, "0 to 2.5", unit="V"),
            ),
            _set_analog,
        ),
        Action(
            "force_ani",
            "hold an ANI feedback input at a voltage, whatever the shaft does (a lost or stuck sensor)",
            (Parameter("axis", int, "1 or 2"), Parameter("volts", float, "-10 to 10", unit="V")),
            _force_ani,
        ),
        Action(
            "release_ani",
            "let an ANI feedback input follow its sensor again",
            (Parameter("axis", int, "1 or 2"),),
            _release_ani,
        ),
        Action(
            "drive_encoder",
            "turn an encoder by something else than its motor (a conveyor, say), from now on at a velocity",
            (
                AXIS,
                Parameter("velocity", float, "negative turns it backwards, 0 stops it", unit="counts/s"),
                Parameter("ramp", float, "time until it has that velocity", unit="s"),
            ),
            _drive_encoder,
        ),
        Action(
            "turn_encoder",
            "turn an encoder by some counts by something else than its motor; it rests then",
            (
                AXIS,
                Parameter("counts", int, "forwards positive", unit="counts"),
                Parameter("velocity", float, "magnitude; 0 turns it at once", unit="counts/s"),
            ),
            _turn_encoder,
        ),
        Action("release_encoder", "let the axis turn its encoder again", (AXIS,), _release_encoder),
        Action("press_key", "press a key of the operator panel", (Parameter("key", str, "its label"),), press),
        Action(
            "release_key",
            "let go of an arrow key of the operator panel",
            (Parameter("key", str, "its label"),),
            release,
        ),
        Action(
            "dial_thumbwheels",
            "dial a number on the thumbwheels wired as INSTW and OUTTW say",
            (Parameter("set_number", int, "1 to 4"), Parameter("value", int, "sign and up to eight digits")),
            dial,
        ),
        Action("cut_power", "switch the unit off; its motors coast", (), _cut_power),
        Action("restore_power", "switch the unit on; it signs on", (), _restore_power),
        Action(
            "damage_memory",
            "spoil the non-volatile memory: the next power-up finds a bad checksum, clears it and sets SS bit 22",
            (),
            _damage_memory,
        ),
        Action(
            "advance_time",
            "let virtual time pass in this unit",
            (Parameter("seconds", float, "how long", unit="s"),),
            _advance_time,
        ),
        *(Action(name, sentence, (AXIS, parameter), do) for name, sentence, parameter, do in MACHINE_ACTIONS),
        *(action for fault in FAULTS.values() for action in _fault_actions(fault)),
    )
}

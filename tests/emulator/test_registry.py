"""The control surface: every signal has a name and a sentence and can be read, every action does what it says."""

from __future__ import annotations

import inspect
from fractions import Fraction

import pytest

from emulator import Emulator, Machine
from emulator.emulator import Unit
from emulator.engine import MasterSource, plan_ratio_change
from emulator.registry import ACTIONS, Value, describe_signals

SYSTEM_S = 2.24e-3


@pytest.fixture
def emulator() -> Emulator:
    return Emulator(Machine.parse("[defaults]\nECHO = 0"))


@pytest.fixture
def unit(emulator: Emulator) -> Unit:
    return emulator.unit(0)


def ask(unit: Unit, text: str) -> str:
    unit.read()
    unit.send(text.encode("latin-1") + b"\r")
    return unit.read().decode("latin-1").partition("\r")[0]


class TestMachine:
    TORQUE = "[defaults]\nECHO = 0\n[axis1.plant]\npreset = 'large_brushless'\n"

    def test_a_load_and_friction_change_while_it_runs(self) -> None:
        emulator = Emulator(Machine.parse(self.TORQUE))
        unit = emulator.unit(0)
        unit.do("set_load", axis=1, torque=0.3)
        emulator.advance(0.2)
        assert unit.signals["axis1.position.true"] < 0, "it acts against positive motion"
        unit.do("set_friction", axis=1, torque=5.0)
        emulator.advance(0.2)
        assert unit.signals["axis1.velocity.true"] == 0.0

    def test_a_load_the_plant_cannot_feel_is_refused(self, unit: Unit) -> None:
        with pytest.raises(ValueError, match="droop"):
            unit.do("set_load", axis=2, torque=1.0)
        with pytest.raises(ValueError, match="axis must be 1 to 2, not 3"):
            unit.do("set_friction", axis=3, torque=1.0)

    @pytest.mark.parametrize("wiring", ["open", "reversed"])
    def test_a_bad_encoder_connection_trips_the_position_error(
        self, emulator: Emulator, unit: Unit, wiring: str
    ) -> None:
        unit.send(b"COMEXC1:DRIVE11:MC1:V5:GO10\r")
        emulator.advance(0.5)
        unit.do("wire_encoder", axis=1, wiring=wiring)
        emulator.advance(2.0)
        assert str(unit.signals["axis1.status"]).replace("_", "")[22] == "1", "AS bit 23"
        assert unit.signals["axis1.drive"] is False
        assert unit.signals["axis2.drive"] is True

    def test_a_conveyor_turns_an_encoder_as_a_test_says(self, emulator: Emulator, unit: Unit) -> None:
        unit.do("drive_encoder", axis=2, velocity=10_000.0, ramp=0.0)
        emulator.advance(0.5)
        assert unit.signals["axis2.position.encoder"] == pytest.approx(5000, abs=5)
        unit.do("drive_encoder", axis=2, velocity=0.0, ramp=0.1)
        emulator.advance(0.2)
        assert unit.signals["axis2.position.encoder"] == pytest.approx(5500, abs=5)
        here = int(unit.signals["axis2.position.encoder"])
        unit.do("turn_encoder", axis=2, counts=-1000, velocity=50_000.0)
        emulator.advance(0.2)
        assert unit.signals["axis2.position.encoder"] == here - 1000
        unit.do("release_encoder", axis=2)
        emulator.advance(0.1)
        assert unit.signals["axis2.position.encoder"] == here - 1000
        with pytest.raises(ValueError, match="not 2000000000"):
            unit.do("drive_encoder", axis=2, velocity=2e9, ramp=0.0)

    def test_a_slip_is_seen_at_once(self, unit: Unit) -> None:
        unit.do("slip_encoder", axis=2, counts=-40)
        assert ask(unit, "2TPE") == "*2TPE-40"
        with pytest.raises(ValueError, match="normal or reversed or open"):
            unit.do("wire_encoder", axis=1, wiring="cut")


class TestFollowingSignals:
    def test_what_a_slave_and_its_master_do(self, emulator: Emulator, unit: Unit) -> None:
        unit.send(b"DRIVE1\r")
        engine = unit.controller.engine
        engine.set_master(0, source=MasterSource.ENCODER, master_index=1)
        engine.set_master_cycle(0, 1000)
        engine.start_following(0, plan_ratio_change(Fraction(0), Fraction(3, 2), 0), preset=False)
        unit.do("drive_encoder", axis=2, velocity=10_000.0, ramp=0.1)
        emulator.advance(0.5)
        assert unit.signals["axis1.slave.ratio"] == 1.5
        assert unit.signals["axis1.master.cycle"] == 4
        assert unit.signals["axis1.master.position"] == pytest.approx(500, abs=30)
        assert unit.signals["axis1.master.velocity"] == pytest.approx(10_000, rel=0.05)
        assert unit.signals["axis1.slave.position"] == pytest.approx(6750, abs=50)
        assert unit.signals["axis1.slave.shift"] == 0.0
        unit.do("turn_encoder", axis=2, counts=0, velocity=0.0)
        emulator.advance(0.1)
        assert unit.signals["axis1.master.velocity"] == 0.0


class TestSignals:
    def test_all_can_be_read(self, unit: Unit) -> None:
        assert len(unit.signals) > 70
        for name in unit.signals:
            assert isinstance(unit.signals[name], float | int | bool | str), name

    def test_all_are_named_and_described(self, unit: Unit) -> None:
        for name, signal in describe_signals(unit.controller).items():
            assert signal.name == name
            assert len(signal.sentence) > 8
            assert name == name.lower()

    def test_numbers_have_units(self, unit: Unit) -> None:
        for name, signal in describe_signals(unit.controller).items():
            is_number = isinstance(unit.signals[name], float | int) and not isinstance(unit.signals[name], bool)
            assert bool(signal.unit) == is_number, name

    def test_unknown_name(self, unit: Unit) -> None:
        with pytest.raises(KeyError, match="axis3"):
            unit.signals["axis3.moving"]
        assert "axis1.moving" in unit.signals
        for name in ("axis1", "wire", "nonsense", "axisx.moving", ""):
            with pytest.raises(KeyError):
                unit.signals[name]

    def test_what_the_registry_must_offer_first(self, unit: Unit) -> None:
        """Positions, velocities, error, terms of the law, DAC volts, status words, every input wire and limit, time."""
        for axis in (1, 2):
            for name in (
                "position.commanded",
                "position.encoder",
                "position.error",
                "velocity.commanded",
                "velocity.actual",
                "servo.proportional",
                "servo.integral",
                "servo.velocity",
                "servo.velocity_feedforward",
                "servo.acceleration_feedforward",
                "dac",
                "status",
            ):
                assert f"axis{axis}.{name}" in unit.signals
        assert {"time", "status.system", "status.error", "limits", "inputs", "outputs", "wire.enable"} <= set(
            unit.signals
        )

    def test_they_agree_with_the_wire(self, emulator: Emulator, unit: Unit) -> None:
        unit.send(b"COMEXC1:DRIVE11:D8000,-8000:SGV5,5:GO11\r")
        emulator.advance(0.5)
        for axis in (1, 2):
            signal = {
                name: unit.signals[f"axis{axis}.{name}"] for name in ("position.commanded", "position.encoder", "dac")
            }
            assert ask(unit, f"{axis}TPC") == f"*{axis}TPC{signal['position.commanded']:+d}"
            assert ask(unit, f"{axis}TPE") == f"*{axis}TPE{signal['position.encoder']:+d}"
            assert ask(unit, f"{axis}TPER") == f"*{axis}TPER{unit.signals[f'axis{axis}.position.error']:+d}"
            assert ask(unit, f"{axis}TDAC") == f"*{axis}TDAC{signal['dac']:+.3f}"
            assert ask(unit, f"{axis}TAS").replace("_", "") == f"*{axis}TAS{unit.signals[f'axis{axis}.status']}"
        assert ask(unit, "!TER").replace("_", "") == f"*TER{unit.signals['status.error']}"
        assert ask(unit, "TIN").replace("_", "") == f"*TIN{unit.signals['inputs']}"
        assert ask(unit, "TLIM").replace("_", "") == f"*TLIM{unit.signals['limits']}"
        assert unit.signals["time"] == pytest.approx(0.5)

    def test_the_terms_make_the_output(self, emulator: Emulator, unit: Unit) -> None:
        unit.send(b"COMEXC1:DRIVE1:MC1:SGI3:SGV4:SGVF9:SGAF1:GO1\r")
        for _ in range(40):
            emulator.advance(0.0101)
            terms = ("proportional", "integral", "velocity", "velocity_feedforward", "acceleration_feedforward")
            total = sum(float(unit.signals[f"axis1.servo.{term}"]) for term in terms)
            assert unit.signals["axis1.servo.output"] == pytest.approx(total, abs=1e-9)
            assert unit.signals["axis1.dac"] == pytest.approx(total, abs=20 / 2**16)


WIRES = Emulator().unit(0).controller.wiring.names


class TestWires:
    @pytest.mark.parametrize("wire", WIRES)
    def test_every_one_opens_and_closes(self, wire: str, unit: Unit) -> None:
        for closed in (True, False, True):
            unit.do("set_wire", name=wire, closed=closed)
            assert unit.signals[f"wire.{wire}"] is closed

    @pytest.mark.parametrize("wire", WIRES)
    def test_no_other_changes(self, wire: str, unit: Unit) -> None:
        before = {name: unit.signals[name] for name in unit.signals if name.startswith("wire.")}
        unit.do("set_wire", name=wire, closed=not before[f"wire.{wire}"])
        after = {name: unit.signals[name] for name in before}
        assert [name for name in before if before[name] != after[name]] == [f"wire.{wire}"]

    def test_all_terminals_are_there(self) -> None:
        axis_wires = {
            f"axis{n}.{w}" for n in (1, 2) for w in ("positive_limit", "negative_limit", "home", "drive_fault")
        }
        inputs = {f"input.{n}" for n in range(1, 25)}
        joystick = {f"joystick.{w}" for w in ("auxiliary", "trigger", "axes_select", "velocity_select", "release")}
        assert set(WIRES) == {"enable", "trigger.a", "trigger.b", *axis_wires, *inputs, *joystick}

    def test_fewer_inputs(self) -> None:
        emulator = Emulator(Machine.parse("[io]\ninputs = 8\noutputs = 8\n[defaults]\nECHO = 0"))
        unit = emulator.unit(0)
        assert "wire.input.9" not in unit.signals
        unit.do("set_wire", name="trigger.a", closed=True)
        emulator.advance(0.03)  # longer than the trigger inputs' debounce time
        assert ask(unit, "TIN") == "*TIN0000_0000_10"
        assert ask(unit, "TOUT") == "*TOUT0000_0000_00"

    @pytest.mark.parametrize(
        ("wire", "report", "opened", "closed"),
        [
            ("axis1.positive_limit", "TLIM", "*TLIM010_110", "*TLIM110_110"),
            ("axis1.negative_limit", "TLIM", "*TLIM100_110", "*TLIM110_110"),
            ("axis1.home", "TLIM", "*TLIM110_110", "*TLIM111_110"),
            ("axis2.positive_limit", "TLIM", "*TLIM110_010", "*TLIM110_110"),
            ("axis2.home", "TLIM", "*TLIM110_110", "*TLIM110_111"),
            ("enable", "TINO", "*TINO0000_0000", "*TINO0000_0100"),
            ("input.1", "TIN.1", "*0", "*1"),
            ("input.24", "TIN.24", "*0", "*1"),
            ("trigger.a", "TIN.25", "*0", "*1"),
            ("trigger.b", "TIN.26", "*0", "*1"),
            ("axis1.drive_fault", "1TASX.4", "*0", "*1"),
        ],
    )
    def test_the_reports_show_them(
        self, wire: str, report: str, opened: str, closed: str, emulator: Emulator, unit: Unit
    ) -> None:
        for is_closed in (True, False):
            unit.do("set_wire", name=wire, closed=is_closed)
            emulator.advance(0.03)  # longer than the trigger inputs' debounce time
            assert ask(unit, report) == (closed if is_closed else opened)

    def test_the_next_system_update_sees_an_open_contact(self, emulator: Emulator, unit: Unit) -> None:
        unit.send(b"COMEXC1:MC1:DRIVE1:GO1\r")
        emulator.advance(0.5)
        emulator.advance(0.0003)
        update_ns = unit.controller.engine.next_system_update_ns
        unit.do("set_wire", name="enable", closed=False)
        emulator.advance_to(update_ns - 1)
        assert unit.signals["axis1.drive"] is True
        emulator.advance_to(update_ns)
        assert unit.signals["axis1.drive"] is False


class TestActions:
    def test_described(self) -> None:
        for name, action in ACTIONS.items():
            assert action.name == name
            assert len(action.sentence) > 15
            if name.startswith(("fault_", "lift_")):
                continue  # made from a table of their own: test_fault_injection
            parameters = list(inspect.signature(action.function).parameters)[1:]
            assert [parameter.name for parameter in action.parameters] == parameters
            assert all(parameter.sentence for parameter in action.parameters)

    def test_power(self, emulator: Emulator, unit: Unit) -> None:
        unit.send(b"COMEXC1:MC1:DRIVE1:GO1\r")
        emulator.advance(0.5)
        unit.do("cut_power")
        assert unit.signals["power"] is False
        turning = float(unit.signals["axis1.velocity.true"])
        assert turning > 0.5, "the motor coasts"
        emulator.advance(1.0)
        assert abs(float(unit.signals["axis1.velocity.true"])) < turning / 100
        unit.read()
        unit.do("restore_power")
        unit.do("restore_power")
        assert unit.read().count(b"MOTION CONTROLLER") == 1, "it signs on once"
        assert unit.signals["power"] is True

    def test_time(self, emulator: Emulator, unit: Unit) -> None:
        unit.do("advance_time", seconds=1.25)
        assert unit.signals["time"] == pytest.approx(1.25)
        unit.do("advance_time", seconds=1)
        assert unit.signals["time"] == pytest.approx(2.25)

    @pytest.mark.parametrize(
        ("action", "parameters", "error"),
        [
            ("explode", {}, KeyError),
            ("set_wire", {}, KeyError),
            ("set_wire", {"name": "enable"}, KeyError),
            ("set_wire", {"name": "enable", "closed": False, "more": 1}, KeyError),
            ("set_wire", {"name": "nothing", "closed": False}, KeyError),
            ("set_wire", {"name": "enable", "closed": "no"}, TypeError),
            ("set_wire", {"name": 5, "closed": True}, TypeError),
            ("cut_power", {"now": True}, KeyError),
            ("advance_time", {"seconds": "1"}, TypeError),
            ("advance_time", {"seconds": True}, TypeError),
        ],
    )
    def test_misuse(self, action: str, parameters: dict[str, Value], error: type[Exception], unit: Unit) -> None:
        before = {name: unit.signals[name] for name in unit.signals}
        with pytest.raises(error):
            unit.do(action, **parameters)
        assert {name: unit.signals[name] for name in unit.signals} == before

    def test_time_does_not_run_back(self, emulator: Emulator, unit: Unit) -> None:
        emulator.advance(1)
        unit.do("advance_time", seconds=-0.5)
        assert unit.signals["time"] == pytest.approx(1.0)

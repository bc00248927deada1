"""Every fault acts, proves that it has acted, shows as the reference says, and is gone when it is lifted."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path

import pytest

from emulator import Emulator, Machine
from emulator.cli import main
from emulator.emulator import Unit
from emulator.faults import FAULTS, FaultError
from emulator.recording import replay
from emulator.registry import ACTIONS

ALL_ERRORS = "ERROR" + "1" * 32
TORQUE = """
[axis1.plant]
kind = "torque_drive"
torque_per_volt_nm = 0.3
coulomb_nm = 0.02
[defaults]
ECHO = 0
COMEXC = 1
SGV = 40
SGP = 40
"""
AS, ER = "axis1.status", "status.error"


def powered(machine: str = "[defaults]\nECHO = 0\nCOMEXC = 1") -> tuple[Emulator, Unit]:
    emulator = Emulator(Machine.parse(machine))
    unit = emulator.unit()
    unit.send(f"{ALL_ERRORS}:INFEN1:DRIVE11:A50:V2\r".encode())
    emulator.advance(0.1)
    unit.read()
    return emulator, unit


def bits(unit: Unit, name: str) -> set[int]:
    return {number for number, digit in enumerate(str(unit.signals[name]), start=1) if digit == "1"}


def ask(unit: Unit, text: str) -> bytes:
    unit.read()
    unit.send(text.encode() + b"\r")
    return unit.read()


class TestDeclarations:
    @pytest.mark.parametrize("name", FAULTS)
    def test_each_is_described(self, name: str) -> None:
        fault = FAULTS[name]
        assert fault.name == name
        assert all(len(text) > 10 for text in (fault.sentence, fault.shows))
        assert [each.name for each in fault.parameters] == list(inspect.signature(fault.begin).parameters)[1:]
        assert set(fault.place) <= {each.name for each in fault.parameters}
        assert all(each.unit or each.kind is not float for each in fault.parameters), "numbers have units"
        assert f"fault_{name}" in ACTIONS
        assert (f"lift_{name}" in ACTIONS) == fault.lasting

    def test_the_command_line_lists_them(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["faults"]) == 0
        listed = capsys.readouterr().out
        assert all(f"{name}(" in listed and FAULTS[name].sentence.split()[1] in listed for name in FAULTS)

    @pytest.mark.parametrize(
        ("name", "values", "error"),
        [
            ("nonsense", {}, FaultError),
            ("limit_open", {}, KeyError),
            ("limit_open", {"axis": 1, "more": 2}, KeyError),
            ("limit_open", {"axis": "1"}, TypeError),
        ],
    )
    def test_misuse(self, name: str, values: dict[str, int], error: type[Exception]) -> None:
        with pytest.raises(error):
            Emulator().unit().faults.inject(name, **values)

    @pytest.mark.parametrize(
        ("name", "values"),
        [
            ("limit_open", {"axis": 3}),
            ("limit_open", {"axis": 1, "direction": "up"}),
            ("load_step", {"axis": 1, "torque_nm": 0.1}),
            ("output_stuck", {"axis": 1, "volts": 11.0}),
            ("line_noise", {"chance": 1.5}),
            ("line_noise", {"direction": "away"}),
            ("unit_slow", {"delay_s": -1.0}),
        ],
    )
    def test_what_a_unit_cannot_have(self, name: str, values: dict[str, float | str]) -> None:
        unit = Emulator().unit()
        with pytest.raises(FaultError):
            unit.faults.inject(name, **values).apply()
        assert not unit.controller.injected

    def test_unknown_attribute(self) -> None:
        faults = Emulator().unit().faults
        assert "limit_open" in dir(faults) and list(faults) == list(FAULTS)
        with pytest.raises(AttributeError, match="limit_open"):
            faults.limit_opened  # noqa: B018

    def test_one_at_a_place(self) -> None:
        faults = Emulator().unit().faults
        with faults.limit_open(axis=1) as first, faults.limit_open(axis=2):
            with pytest.raises(FaultError, match="already"):
                faults.limit_open(axis=1).apply()
            assert first.in_force
        with faults.limit_open(axis=1):
            pass
        with pytest.raises(FaultError, match="not in force"):
            ACTIONS["lift_enable_open"].carry_out(Emulator().unit().controller, {})


class TestProof:
    def test_a_fault_that_was_never_applied(self) -> None:
        fault = Emulator().unit().faults.limit_open(axis=1)
        assert not fault.fired and fault.first_s is None
        with pytest.raises(AssertionError, match="never put into force"):
            fault.assert_fired()

    def test_a_fault_that_changed_nothing(self) -> None:
        unit = Emulator(Machine.parse("bare = true")).unit()
        with unit.faults.limit_open(axis=1) as fault:
            assert not fault.fired, "it was open before"
            with pytest.raises(AssertionError, match="proves nothing"):
                fault.assert_fired()


class TestContacts:
    @pytest.mark.parametrize(("direction", "bit", "sign"), [("positive", 15, ""), ("negative", 16, "-")])
    def test_limit(self, direction: str, bit: int, sign: str) -> None:
        emulator, unit = powered()
        unit.send(f"D{sign}40000:GO1\r".encode())
        emulator.advance(1.0)
        with unit.faults.limit_open(axis=1, direction=direction) as fault:
            emulator.advance(1.0)
            assert fault.fired and fault.count == 1 and fault.first_s == pytest.approx(1.1)
            assert bit in bits(unit, AS) and 1 not in bits(unit, AS) and 2 in bits(unit, ER)
        assert unit.signals[f"wire.axis1.{direction}_limit"] is True
        assert fault.fired and not fault.in_force

    def test_enable(self) -> None:
        emulator, unit = powered()
        unit.send(b"MC1:GO1\r")
        emulator.advance(1.0)
        with unit.faults.enable_open() as fault:
            emulator.advance(0.5)
            assert fault.fired and 13 in bits(unit, AS) and 9 in bits(unit, ER)
            assert b"ENABLE INPUT INACTIVE" in ask(unit, "DRIVE1")
        assert b"?" not in ask(unit, "DRIVE1") and 13 not in bits(unit, AS)

    @pytest.mark.parametrize("level", [0, 1])
    def test_drive_fault(self, level: int) -> None:
        emulator, unit = powered()
        unit.do("set_wire", name="axis1.drive_fault", closed=bool(level))
        ask(unit, f"DRFLVL{level}{level}")
        emulator.advance(0.1)
        ask(unit, "DRIVE1")
        assert 14 not in bits(unit, AS)
        with unit.faults.drive_fault(axis=1) as fault:
            emulator.advance(0.1)
            assert fault.fired and {13, 14} <= bits(unit, AS) and 4 in bits(unit, ER)
        emulator.advance(0.1)
        ask(unit, "DRIVE1")
        assert not {13, 14} & bits(unit, AS)


class TestAxes:
    @pytest.mark.parametrize("name", ["encoder_lost", "encoder_reversed"])
    def test_encoder_wired_wrongly(self, name: str) -> None:
        emulator, unit = powered()
        with unit.faults.inject(name, axis=1) as fault:
            emulator.advance(0.5)
            assert not fault.fired, "an axis that stands still shows nothing of it"
            unit.send(b"D40000:GO1\r")
            emulator.advance(3.0)
            assert fault.fired and fault.count > 1000
            assert {13, 23} <= bits(unit, AS) and 12 in bits(unit, ER)
            assert ask(unit, "ENCPOL00:CMDDIR00")
            counted = int(unit.signals["axis1.position.encoder"])
        assert counted == 0 if name == "encoder_lost" else counted < -1000
        ask(unit, "DRIVE1:PSET0")
        unit.send(b"D4000:GO1\r")
        emulator.advance(2.0)
        assert unit.signals["axis1.position.encoder"] == pytest.approx(4000, abs=2), "whole again"

    def test_encoder_lost_survives_the_polarity_commands(self) -> None:
        emulator, unit = powered()
        ask(unit, "DRIVE0")
        with unit.faults.encoder_lost(axis=1):
            ask(unit, "ENCPOL1:ENCPOL0")
            ask(unit, "DRIVE1:D4000:GO1")
            emulator.advance(0.5)
            assert unit.signals["axis1.position.encoder"] == 0
            assert float(unit.signals["axis1.position.true"]) > 0.1

    @pytest.mark.parametrize("counts", [700, -700])
    def test_slip(self, counts: int) -> None:
        emulator, unit = powered()
        fault = unit.faults.encoder_slip(axis=1, counts=counts).apply()
        emulator.advance(2.0)
        assert fault.fired and fault.count == 700
        assert unit.signals["axis1.position.encoder"] == pytest.approx(0, abs=2), "the servo has put it right"
        assert unit.signals["axis1.position.true"] == pytest.approx(-counts / 4000, abs=2 / 4000)
        fault.lift()
        fault.apply()
        assert fault.count == 700, "each slip is one of its own"

    def test_slip_beyond_smper(self) -> None:
        emulator, unit = powered()
        unit.faults.encoder_slip(axis=1, counts=5000).apply()
        emulator.advance(0.5)
        assert {13, 23} <= bits(unit, AS) and 12 in bits(unit, ER)

    def test_load_step(self) -> None:
        """At rest the proportional term holds the load: error = torque / (Nm per V * V per count)."""
        emulator, unit = powered(TORQUE)
        plant = unit.controller.engine.plant(0)
        with unit.faults.load_step(axis=1, torque_nm=0.6) as fault:
            emulator.advance(3.0)
            expected = 0.6 / (0.3 * 0.040)
            friction = 0.02 / (0.3 * 0.040)
            assert float(unit.signals["axis1.position.error"]) == pytest.approx(expected, abs=friction + 1)
            assert fault.fired
        assert unit.controller.engine.plant(0) == plant
        emulator.advance(3.0)
        assert float(unit.signals["axis1.position.error"]) == pytest.approx(0, abs=friction + 1)

    def test_friction(self) -> None:
        """A shaft held by more friction than the loop brings up stays where it is."""
        emulator, unit = powered(TORQUE)
        with unit.faults.friction_up(axis=1, torque_nm=50.0) as fault:
            unit.send(b"D4000:GO1\r")
            emulator.advance(0.2)
            assert fault.fired and abs(float(unit.signals["axis1.position.true"])) < 0.001
            emulator.advance(2.0)
            assert int(unit.signals["axis1.position.error"]) > 3900

    @pytest.mark.parametrize("volts", [0.5, -0.5])
    def test_output_stuck(self, volts: float) -> None:
        """10 rev/s per V: the shaft runs at 5 rev/s until the error passes SMPER, one revolution."""
        emulator, unit = powered()
        with unit.faults.output_stuck(axis=1, volts=volts) as fault:
            emulator.advance(0.1)
            assert unit.signals["axis1.dac"] == volts
            assert float(unit.signals["axis1.velocity.true"]) == pytest.approx(10 * volts, rel=0.01)
            emulator.advance(0.5)
            assert fault.fired and {13, 23} <= bits(unit, AS) and 12 in bits(unit, ER)
        emulator.advance(0.1)
        assert unit.signals["axis1.dac"] == 0.0


class TestLine:
    def test_noise_is_seeded(self) -> None:
        def session(seed: int, pieces: Callable[[bytes], list[bytes]]) -> tuple[bytes, int]:
            emulator, unit = powered()
            with unit.faults.line_noise(chance=0.05, seed=seed) as fault:
                for piece in pieces(b"1TPE\rTREV\rA10\r" * 20):
                    unit.send(piece)
                emulator.advance(0.1)
                return unit.read(), fault.count

        whole = session(1, lambda data: [data])
        assert whole == session(1, lambda data: [data])
        assert whole == session(1, lambda data: [data[i : i + 1] for i in range(len(data))])
        assert whole != session(2, lambda data: [data])
        assert whole[1] > 10
        assert b"UNDEFINED LABEL" in whole[0]

    def test_dropped(self) -> None:
        _, unit = powered()
        with unit.faults.bytes_dropped(chance=0.5, direction="from_unit") as fault:
            answer = ask(unit, "TREV" + ":TREV" * 20)
        assert 0.3 < fault.count / (fault.count + len(answer)) < 0.7
        assert len(ask(unit, "TREV" + ":TREV" * 20)) == fault.count + len(answer)
        with unit.faults.bytes_dropped(chance=1.0, direction="to_unit") as fault:
            assert ask(unit, "1TPE") == b""
        assert fault.count == 5

    def test_silent(self) -> None:
        emulator, unit = powered()
        with unit.faults.unit_silent() as fault:
            assert ask(unit, "D4000:GO1") == b""
            emulator.advance(2.0)
            assert unit.signals["axis1.position.encoder"] == pytest.approx(4000, abs=2), "it obeys"
            assert unit.read() == b"" and fault.count > 0
        assert ask(unit, "1TPE").startswith(b"*1TPE")

    def test_deaf(self) -> None:
        emulator, unit = powered()
        ask(unit, "MC1:GO1")
        with unit.faults.unit_deaf() as fault:
            assert ask(unit, "!K") == b"" and fault.count == 3
            emulator.advance(1.0)
            assert unit.signals["axis1.moving"] is True
        ask(unit, "!K")
        emulator.advance(0.1)
        assert unit.signals["axis1.moving"] is False

    def test_slow(self) -> None:
        emulator, unit = powered()
        before_s = emulator.time_s
        with unit.faults.unit_slow(delay_s=0.25) as fault:
            assert ask(unit, "1TPE") == b""
            assert unit.controller.busy, "something is still to come"
            emulator.advance(0.2499)
            assert unit.read() == b""
            emulator.advance(0.0001)
            unit.take_output()
            unit.send(b"1TPC\r")
        assert fault.count == 2 and fault.first_s == pytest.approx(before_s)
        assert unit.read() == b"*1TPE+0\r\r\n> *1TPC+0\r\r\n> "
        assert unit.take_output()[-1].at_ns <= unit.controller.now_ns

    def test_a_timed_line_is_disturbed_too(self) -> None:
        emulator, unit = powered("[serial]\nbaud = 9600\n[defaults]\nECHO = 0")
        emulator.advance(1.0)
        unit.read()
        with unit.faults.unit_slow(delay_s=0.5):
            unit.send(b"1TPE\r")
            emulator.advance(0.4)
            assert unit.read() == b""
            emulator.advance(0.2)
            assert unit.read().startswith(b"*1TPE")

    def test_power(self) -> None:
        emulator, unit = powered()
        ask(unit, "MC1:GO1")
        emulator.advance(1.0)
        with unit.faults.power_cut() as fault:
            assert unit.signals["power"] is False and fault.fired
            assert ask(unit, "1TPE") == b""
            emulator.advance(1.0)
        assert b"PARKER OEM6250" in unit.read()
        assert 13 in bits(unit, AS)


class TestSchedule:
    def test_at_its_time_to_the_nanosecond(self) -> None:
        emulator, unit = powered()
        fault = unit.faults.enable_open().at(1.234567891, lasting_s=0.1)
        emulator.advance(10.0)
        assert fault.first_s == 1.234567891 and fault.fired and not fault.in_force
        assert unit.signals["wire.enable"] is True and 9 in bits(unit, ER)

    def test_a_recording_replays_it(self, tmp_path: Path) -> None:
        path = tmp_path / "session.rec"
        with Emulator(Machine.parse("[defaults]\nECHO = 0"), record=path) as emulator:
            unit = emulator.unit()
            unit.faults.limit_open(axis=1).at(0.75, lasting_s=0.3)
            unit.faults.unit_slow(delay_s=0.01).at(0.1)
            unit.faults.line_noise(chance=0.1, seed=7).at(0.5)
            unit.send(b"ERROR11111111111111111111111111111111:DRIVE1:A10:V1:D40000:GO1\r")
            for _ in range(20):
                emulator.advance(0.1)
                unit.send(b"!1TPE\r")
                unit.read()
        text = path.read_text()
        assert '0.750000000 u0 ! fault_limit_open axis=1 direction="positive"' in text
        assert '1.050000000 u0 ! lift_limit_open axis=1 direction="positive"' in text
        outcome = replay(path)
        assert outcome.difference is None and outcome.complete

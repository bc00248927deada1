"""A changed machine file: what a running unit takes over, what it leaves, and what SIGHUP does."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from emulator.chain import build_chain
from emulator.machine import Machine
from emulator.machine_keys import differing_keys
from emulator.reload import Reload, compare, take_over
from tests.controller.session import Session, both_on
from tests.ports.served import OEM6250, REPOSITORY, TOY, Served, wait_until

QUIET = '[defaults]\nECHO = "0"\n'


def changed(session: Session, text: str) -> Reload:
    """The unit of a session takes over a file that says this besides what it said before."""
    defaults = "[defaults]\n" + "".join(f'{k} = "{v}"\n' for k, v in session.unit.controller.machine.defaults.items())
    return take_over([session.unit.controller], Machine.parse(f"{text}\n{defaults}"))


class TestTakingOver:
    def test_nothing_changed_changes_nothing(self) -> None:
        session = Session()
        assert changed(session, "")[1:] == ((), ())

    def test_what_the_unit_says(self) -> None:
        session = Session()
        reload = changed(session, '[identity]\nrevision = "92-1-1 X"\n[serial]\nerror_lead = "none"')
        assert reload.applied == ("identity.revision", "serial.error_lead")
        assert session.query("TREV") == "TREV92-1-1 X"
        assert session.ask("XYZZY") == "*UNDEFINED LABEL\r\r\n? "

    def test_prompts_from_the_next_command_on(self) -> None:
        session = Session()
        assert session.ask("V1:A1") == "\r\n> \r\n> "
        changed(session, '[serial]\nprompt_per = "line"')
        assert session.ask("V1:A1") == "\r\n> "

    def test_the_error_levels(self) -> None:
        session = Session()
        session.ask("ERRLVL0")
        changed(session, "[errlvl.0]\nok_prompt = true")
        assert session.ask("V1") == "\r\n> "

    def test_contacts_move_when_the_file_moves_them(self) -> None:
        session = Session()
        assert session.query("TLIM") == "TLIM110_110"
        text = '[axis1.wires]\npositive_limit = "open"\n[wires]\ninputs = [2, 25]\nanalog = [0.5, 1.25, 2.0]'
        applied = changed(session, text).applied
        assert applied == ("axis1.wires.positive_limit", "wires.inputs", "wires.analog")
        session.advance(0.1)
        assert session.query("TLIM") == "TLIM010_110"
        assert session.query("TIN.2") == session.query("TIN.25") == "1"
        assert session.unit.controller.wiring.analog_volts == [0.5, 1.25, 2.0]

    def test_contacts_somebody_else_moved_stay(self) -> None:
        session = Session()
        session.unit.do("set_wire", name="axis1.positive_limit", closed=False)
        changed(session, "[wires]\ninputs = [2]")
        session.advance(0.1)
        assert session.query("TLIM") == "TLIM010_110"

    def test_enable_opens(self) -> None:
        session = both_on()
        changed(session, '[wires]\nenable = "open"')
        session.advance(0.1)
        assert session.query("DRIVE") == "DRIVE00"

    def test_what_belongs_to_the_building_is_named_and_stays(self) -> None:
        session = Session()
        reload = changed(session, "[servo]\ndac_bits = 12\n[memory]\nvar = 10\n[identity]\nrevision = 'X'")
        assert reload.applied == ("identity.revision",)
        assert reload.needs_restart == ("memory.var", "servo.dac_bits")
        session.ok("VAR150=1")
        again = changed(session, "[servo]\ndac_bits = 12\n[memory]\nvar = 10\n[identity]\nrevision = 'X'")
        assert again[1:] == ((), ("memory.var", "servo.dac_bits")), "still not in force, so still named"

    def test_input_numbers_of_another_unit_wait_for_the_restart(self) -> None:
        session = Session("[io]\ninputs = 8")
        reload = changed(session, "[io]\ninputs = 24\n[wires]\ninputs = [20]")
        assert reload[1:] == ((), ("io.inputs", "wires.inputs"))

    def test_a_plant_changes_under_a_moving_axis(self) -> None:
        """The move goes on; a drive with a fifth of the gain follows five times further behind (proportional law)."""
        session = both_on()
        session.ok("COMEXC1", "V1", "MC1")
        session.ask("GO1")
        session.advance(1.0)
        lag, position = self._lag_and_position(session)
        text = (
            "[axis1.plant]\nspeed_per_volt_rev_s = 2.0\nkind = 'velocity_drive'\n[axis2.plant]\nkind = 'torque_drive'"
        )
        assert changed(session, text).applied == ("axis1.plant", "axis2.plant")
        session.advance(1.0)
        later_lag, later_position = self._lag_and_position(session)
        assert later_lag == pytest.approx(5 * lag, rel=0.05)
        assert later_position - position == pytest.approx(4000 - 4 * lag, rel=0.02), "one revolution a second"

    @staticmethod
    def _lag_and_position(session: Session) -> tuple[int, int]:
        """How far axis 1 is behind its commanded position, and where it is, counts."""
        commanded, encoder = (session.unit.signals[f"axis1.position.{name}"] for name in ("commanded", "encoder"))
        assert isinstance(commanded, int) and isinstance(encoder, int)
        return commanded - encoder, encoder

    def test_the_units_of_a_chain_keep_their_addresses(self) -> None:
        chain = build_chain(Machine.parse(QUIET), 2)
        chain.power_up()
        reload = take_over([chain], Machine.parse(QUIET + "[identity]\nrevision = 'X'"))
        assert reload[1:] == (("identity.revision",), ())
        addresses = [controller.machine.defaults["ADDR"] for controller in chain.controllers]
        assert addresses == ["1", "2"]
        assert {controller.machine.identity.revision for controller in chain.controllers} == {"X"}

    def test_the_machine_in_force_is_one_the_keys_describe(self) -> None:
        """Whatever the two files, what is neither applied nor named is alike in both."""
        old = Machine.parse("bare = true")
        new = Machine.parse("[axis1.travel]\npositive_limit_rev = 5.0\n[timing]\ncommands_per_update = 3")
        reload = compare(old, new)
        assert differing_keys(reload.machine, new) == list(reload.needs_restart) == ["axis1.travel.positive_limit_rev"]


@pytest.fixture
def machine_file(tmp_path: Path) -> Path:
    path = tmp_path / "bench.toml"
    path.write_text(QUIET)
    return path


@pytest.fixture
def served(tmp_path: Path, machine_file: Path) -> Iterator[Served]:
    options = (str(machine_file), "--tcp", "127.0.0.1:0", "--pty", "none")
    with Served(*options, announce=tmp_path / "announce", command=OEM6250) as served:
        yield served


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="SIGHUP is a thing of Unix")
class TestSignal:
    def test_a_good_file_is_taken_over_and_a_bad_one_refused(self, served: Served, machine_file: Path) -> None:
        with served.connect() as host:
            host.sock.sendall(b"DRIVE11:COMEXC1:MC1:GO1\r")
            host.read_until(b"> \r\n> \r\n> \r\n> ")
            machine_file.write_text(QUIET + "[identity]\nrevision = 'NEW'\n[servo]\ndac_bits = 12\n")
            served.process.send_signal(signal.SIGHUP)
            wait_until(lambda: self._revision(host) == b"*TREVNEW")
            machine_file.write_text(QUIET + "[identity]\nrevison = 'TYPO'\n")
            served.process.send_signal(signal.SIGHUP)
            assert served.process.stderr is not None
            taken, refused = (served.process.stderr.readline() for _ in range(2))
            host.sock.sendall(b"1TAS.1\r")
            assert host.read_until(b"\r\r\n> ") == b"*1\r\r\n> ", "still moving"
            assert self._revision(host) == b"*TREVNEW"
        assert 'event="machine file re-read"' in taken
        assert "applied=identity.revision needs_restart=servo.dac_bits" in taken
        assert 'event="machine file not used, all stays as it was"' in refused
        assert "did you mean revision?" in refused
        assert served.stop()[0] == 0

    @staticmethod
    def _revision(host: object) -> bytes:
        host.sock.sendall(b"TREV\r")  # type: ignore[attr-defined]
        return bytes(host.read_until(b"\r\r\n> "))[: -len(b"\r\r\n> ")]  # type: ignore[attr-defined]

    def test_what_the_command_line_decided_stays_decided(self, tmp_path: Path, machine_file: Path) -> None:
        options = (str(machine_file), "--no-tcp", "--pty", "none", "--line", "9600")
        with Served(*options, announce=tmp_path / "announce", command=OEM6250) as served:
            served.process.send_signal(signal.SIGHUP)
            assert served.process.stderr is not None
            assert "applied=nothing needs_restart=nothing" in served.process.stderr.readline()

    def test_a_recording_goes_on_over_it(self, tmp_path: Path, machine_file: Path) -> None:
        record = ("--record", str(tmp_path / "session.rec"))
        options = (str(machine_file), "--no-tcp", "--pty", "none", *record)
        with Served(*options, announce=tmp_path / "announce", command=OEM6250) as served:
            served.process.send_signal(signal.SIGHUP)
            assert served.process.stderr is not None
            assert "machine file re-read" in served.process.stderr.readline()

    def test_without_a_machine_file_it_ends(self, tmp_path: Path) -> None:
        with Served("--tcp", "127.0.0.1:0", "--pty", "none", announce=tmp_path / "announce") as served:
            assert served.stop(signal.SIGHUP)[0] == 0

    def test_it_ends_with_its_terminal(self, tmp_path: Path, machine_file: Path) -> None:
        """Closing the terminal window ends a server that was started there, machine file or not."""
        master, slave = pty.openpty()
        announce = tmp_path / "announce"
        arguments = [*TOY, "serve", str(machine_file), "--tcp", "127.0.0.1:0", "--pty", "none", "--announce"]
        take_terminal = (
            "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(*eval(sys.argv[1]))"
        )
        command = [sys.executable, "-c", take_terminal, repr((sys.executable, [*arguments, str(announce)]))]
        with subprocess.Popen(
            command, cwd=REPOSITORY, stdin=slave, stdout=slave, stderr=slave, start_new_session=True
        ) as process:
            os.close(slave)
            wait_until(announce.exists)
            os.close(master)
            assert process.wait(20) == 0

"""What a unit keeps over the end of the process, seen by a host; and what happens when the memory is bad."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from emulator import Emulator, Machine
from emulator.controller import nonvolatile
from emulator.emulator import Unit
from emulator.state.contents import rows_of
from emulator.state.errors import StateError
from emulator.state.store import Store

QUIET = "[defaults]\nECHO = 0\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "unit.state"


def running(path: Path | None, machine: str = "") -> Emulator:
    return Emulator(Machine.parse(machine + QUIET), state=path)


def ask(unit: Unit, text: str) -> str:
    unit.read()
    unit.send(text.encode("latin-1") + b"\r")
    return unit.read().decode("latin-1").replace("\r\r\n> ", "\r").removesuffix("\r")


KEPT = {
    'DEF MAIN:V2:WRITE"it\'s":END': ("TPROG MAIN", '*V2\r\n*WRITE"it\'s"'),
    "DEF IDLE:END": ("TDIR", "1 - IDLE USES 0 BYTES"),
    "SCALE1:SCLV25000:DEF SLOW:V2.5:END": ("RUN SLOW:SCALE0:ERES25000:V", "V2.5"),
    "DATSIZ3,5:DATPTR3,2,1:VAR9=7:DATTCH9": ("TPROG DATP3", "*DATA=+0.0,+7.0,+0.0,+0.0"),
    "VAR150=-1234.5678": ("VAR150", "*VAR150=-1234.5678"),
    "VARB25=b10X": ("VARB25", "*VARB25=10XX_"),
    'VARS25="a\\13b"': ("VARS25", '*VARS25="a\\013b"'),
    "MEMORY20000,19000": ("MEMORY", "*MEMORY20000,19000"),
    "DEF P:V2:END:STARTP P": ("STARTP", "*STARTP P"),
    "ADDR7": ("ADDR", "*ADDR7"),
    "SGP7,8:SGSET3": ("TSGSET3", "*SGP7,8"),
    "CMDDIR01": ("CMDDIR", "*CMDDIR01"),
    "ENCPOL10": ("ENCPOL", "*ENCPOL10"),
    "DRPCHK2": ("DRPCHK", "*DRPCHK2"),
    "PORT2:DRPCHK3": ("PORT2:DRPCHK", "DRPCHK3"),
}


@pytest.mark.parametrize("stored", KEPT)
def test_kept(stored: str, path: Path) -> None:
    question, answer = KEPT[stored]
    with running(path) as emulator:
        assert "?" not in ask(emulator.unit(), stored)
    with running(path) as emulator:
        assert answer in ask(emulator.unit(), question)


@pytest.mark.parametrize("command", ["A77,77", "SGP7,8", "LH0,0", "SCALE1", "ERRLVL1", "DRIVE11", "MC11", "EOL45"])
def test_not_kept(command: str, path: Path) -> None:
    name = command.rstrip("0123456789,")
    with running(path) as emulator:
        fresh = ask(emulator.unit(), name)
        ask(emulator.unit(), command)
    with running(path) as emulator:
        assert ask(emulator.unit(), name) == fresh


def test_the_panel_password_is_kept(path: Path) -> None:
    with running(path) as emulator:
        ask(emulator.unit(), "DPASS1234")
    with running(path) as emulator:
        assert emulator.unit().controller.panel_password == 1234


def test_everything_comes_back_exactly(path: Path) -> None:
    with running(path) as emulator:
        unit = emulator.unit()
        for stored in KEPT:
            unit.send(stored.encode("latin-1") + b":DEL P:SCALE0\r")
        unit.read()
        before = nonvolatile.collect(unit.controller)
    with running(path) as emulator:
        after = nonvolatile.collect(emulator.unit().controller)
    assert rows_of(after) == rows_of(before)
    assert repr(after._replace(gains=())) == repr(before._replace(gains=()))


def test_gain_sets_come_back_with_the_feedback_source_they_were_saved_under(path: Path) -> None:
    fitted = "[options]\nani = true\n"
    with running(path, fitted) as emulator:
        unit = emulator.unit()
        ask(unit, "SGP15,7:SGV2.5:SMPER900:SGSET2:SFB2,1:SGP40:SOFFS.125:SGSET5")
        shown = [ask(unit, f"TSGSET{number}") for number in (2, 5)]
        ask(unit, "SGENB5")
        enabled = ask(unit, "TGAIN")
    with running(path, fitted) as emulator:
        unit = emulator.unit()
        assert [ask(unit, f"TSGSET{number}") for number in (2, 5)] == shown
        sources = {number: [saved.source for saved in axes] for number, axes in unit.controller.gain_sets.items()}
        assert sources == {2: [1, 1], 5: [2, 1]}
        ask(unit, "SFB2,1:SGENB5,5")
        assert ask(unit, "TGAIN") == enabled


def test_the_start_up_program_runs(path: Path) -> None:
    with running(path) as emulator:
        ask(emulator.unit(), "DEF BOOT:VAR1=VAR1+1:END:STARTP BOOT")
    for starts in (1, 2, 3):
        with running(path) as emulator:
            emulator.advance(0.1)
            assert ask(emulator.unit(), "VAR1") == f"*VAR1=+{starts}.0"


def test_what_is_heard_is_on_the_disk(path: Path) -> None:
    """Not closed: the file is looked at as a crash would leave it."""
    emulator = running(path)
    emulator.unit().send(b"VAR1=5\r")
    emulator.unit().read()
    copy = path.with_name("copy")
    for suffix in ("", "-wal"):
        copy.with_name(f"copy{suffix}").write_bytes(path.with_name(path.name + suffix).read_bytes())
    store = Store(copy)
    assert store.contents(0).numbers[0] == 5
    store.close()
    emulator.close()


def test_each_unit_has_its_own(path: Path) -> None:
    machines = [Machine.parse(QUIET)] * 2
    with Emulator(machines, state=path) as emulator:
        for number in (0, 1):
            ask(emulator.unit(number), f"VAR1={number + 5}")
    with Emulator(machines, state=path) as emulator:
        assert [ask(emulator.unit(number), "VAR1") for number in (0, 1)] == ["*VAR1=+5.0", "*VAR1=+6.0"]


def test_a_smaller_machine_leaves_what_it_cannot_hold(path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with running(path) as emulator:
        ask(emulator.unit(), "VAR150=7:VAR1=1:MEMORY30000,10000:DEF P:END:DEF BIG:V1:V2:END")
    with running(path, "[memory]\nvar = 20\nprograms = 1\ntotal_bytes = 39000\nprogram_bytes = 20000\n"
                 "compiled_bytes = 19000\n") as emulator:  # fmt: skip
        assert ask(emulator.unit(), "VAR1") == "*VAR1=+1.0"
        ask(emulator.unit(), "VAR1=2")
    with running(path) as emulator:
        assert ask(emulator.unit(), "VAR150") == "*VAR150=+7.0"
        assert ask(emulator.unit(), "VAR1") == "*VAR1=+2.0"
        assert "*V1\r\n*V2" in ask(emulator.unit(), "TPROG BIG")


def test_closed_is_closed(path: Path) -> None:
    emulator = running(path)
    with pytest.raises(StateError, match="in use"):
        running(path)
    emulator.close()
    emulator.close()
    assert ask(emulator.unit(), "TREV").startswith("*TREV")
    running(path).close()


class TestBadMemory:
    def test_a_damaged_file(self, path: Path) -> None:
        with running(path) as emulator:
            ask(emulator.unit(), "VAR1=5:ADDR3:DEF P:V1:END")
        os.truncate(path, path.stat().st_size // 2)
        with running(path) as emulator:
            unit = emulator.unit()
            assert "MOTION CONTROLLER" in unit.read().decode(), "address 0 again"
            assert ask(unit, "TSS.22") == "*1"
            assert ask(unit, "VAR1") == "*VAR1=+0.0"
            assert "NO PROGRAMS DEFINED" in ask(unit, "TDIR")
        assert path.with_name(f"{path.name}.damaged-1").exists()
        with running(path) as emulator:
            assert ask(emulator.unit(), "TSS.22") == "*0"

    @pytest.mark.parametrize("with_file", [False, True])
    def test_the_fault(self, with_file: bool, path: Path) -> None:
        with running(path if with_file else None) as emulator:
            unit = emulator.unit()
            ask(unit, "VAR1=5:SGSET1:DPASS1:MEMORY20000,20000:DEF P:V1:END")
            unit.do("damage_memory")
            assert ask(unit, "VAR1") == "*VAR1=+5.0", "nothing shows before the next power-up"
            ask(unit, "RESET")
            assert ask(unit, "VAR1") == "*VAR1=+5.0", "RESET checks nothing"
            unit.do("cut_power")
            unit.do("restore_power")
            assert ask(unit, "TSS.22") == "*1"
            assert unit.signals["status.system"][21] == "1"  # type: ignore[index]
            assert ask(unit, "VAR1") == "*VAR1=+0.0"
            assert ask(unit, "MEMORY") == "*MEMORY21400,18600"
            assert "NO PROGRAMS DEFINED" in ask(unit, "TDIR")
            assert ask(unit, "SGENB1").endswith("? "), "the gain set is gone"
            assert unit.controller.panel_password == 6250
            ask(unit, "RESET")
            assert ask(unit, "TSS.22") == "*1", "until a power-up finds it good"
            unit.do("cut_power")
            unit.do("restore_power")
            assert ask(unit, "TSS.22") == "*0"
        if with_file:
            with running(path) as emulator:
                assert ask(emulator.unit(), "VAR1") == "*VAR1=+0.0"

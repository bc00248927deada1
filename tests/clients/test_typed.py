"""The generated commands: up to date, complete, and typed for a user's project."""

from __future__ import annotations

import contextlib
import subprocess
import sys
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from clients import OEM6250, AxisFlags, Gains, SystemFlags, UnitError
from clients import status as status_module
from clients.generate import CLASSES, FOLDER, LEFT_OUT, members, modules
from clients.names import readable_name
from clients.status import StatusWord
from clients.typed.words import AxisWord
from clients.values import mask, number_text, quoted
from protocol.catalogue import rows
from protocol.status import AxisStatus
from tests.clients.peers import EmulatedLine

HERE = Path(__file__).parent


@pytest.mark.parametrize("name", sorted(modules()))
def test_generated_files_are_up_to_date(name: str) -> None:
    assert (FOLDER / name).read_text("utf-8") == modules()[name], "run python -m clients.generate"


def test_every_command_of_the_unit_has_a_name() -> None:
    named = [row.name for _, _, axis, kinds in CLASSES for row in members(axis=axis, kinds=kinds)]
    wanted = {row.name for row in rows() if row.applies_to_oem6250 and row.kind in ("setting", "report", "action")}
    assert sorted(named) == sorted(wanted - LEFT_OUT)


@pytest.mark.parametrize("entry", CLASSES, ids=lambda entry: str(entry[0]))
def test_names_are_identifiers_and_unique(entry: tuple[str, str, bool, tuple[str, ...]]) -> None:
    names = [readable_name(row) for row in members(axis=entry[2], kinds=entry[3])]
    assert len(set(names)) == len(names)
    assert all(name.isidentifier() for name in names)


def properties(face: object) -> list[str]:
    return [name for name in dir(type(face)) if isinstance(getattr(type(face), name), property)]


def known(face: object, name: str) -> Any:
    """The value of a property; None where this unit says that it has not the command."""
    try:
        return getattr(face, name)
    except UnitError as error:
        assert error.text in ("COMMAND NOT IMPLEMENTED", "UNDEFINED LABEL"), error
        return None


def test_every_axis_property_reads_from_the_emulator_and_takes_its_own_value_back() -> None:
    ctl = OEM6250(EmulatedLine())
    axis, seen = ctl.axis[1], 0
    for name in properties(axis):
        value = known(axis, name)
        if value is None:
            continue
        seen += 1
        if getattr(type(axis), name).fset is not None:
            setattr(axis, name, value)
            assert getattr(axis, name) == value, name
    assert seen >= 70


def test_every_unit_property_reads_from_the_emulator() -> None:
    ctl = OEM6250(EmulatedLine())
    values = [known(face, name) for face in (ctl.settings, ctl.reports) for name in properties(face)]
    assert sum(value is not None for value in values) >= 60


def test_unit_settings_and_actions() -> None:
    line = EmulatedLine()
    ctl = OEM6250(line)
    ctl.settings.outputs = "1X1"
    assert ctl.reports.outputs[:4] == "1010"
    ctl.settings.input_debounce_time = (8, 24)
    assert ctl.settings.input_debounce_time == (8, 24)
    ctl.settings.set_input_function("3-D")
    assert ctl.settings.get_input_function(3)[0].startswith("INFNC3-D")
    ctl.programs.download("AAA1", ["D5"])
    ctl.settings.start_up_program = "AAA1"
    assert ctl.settings.start_up_program == "AAA1"
    ctl.actions.transmit("hello")
    ctl.actions.set_outputs(1, 3, 0)
    assert ctl.reports.outputs[:4] == "0000"
    assert ctl.reports.revision.endswith("OEM6250")
    ctl.actions.delete_program("AAA1")
    ctl.axis[1].drive_enabled = True
    ctl.axis[1].start_homing(negative=True)
    line.emulator.advance(0.05)
    assert ctl.status.axis(1).direction_negative
    ctl.axis[1].kill()
    assert ctl.status.error().bits == "0" * 32
    assert ctl.status.other_inputs().enable
    with contextlib.suppress(UnitError):
        assert ctl.status.following(2).bits == "0" * 32
    assert not ctl.status.extended_axis(1).motor_fault


def test_status_words_are_flags_by_the_bit_numbers_of_the_manuals() -> None:
    word = AxisWord("1" + "0" * 11 + "1" + "0" * 10 + "1" + "0" * 8, AxisFlags)
    assert (word.moving, word.drive_shutdown, word.in_target_zone, word.drive_faulted) == (True, True, True, False)
    assert word.flags == AxisFlags.MOVING | AxisFlags.DRIVE_SHUTDOWN | AxisFlags.IN_TARGET_ZONE
    assert AxisFlags.MOVING in word
    assert (word.bit(13), word.bit(14)) == (True, False)
    assert "moving, drive_shutdown, in_target_zone" in repr(word)
    assert {flag.name: flag.value for flag in AxisFlags} == {bit.name: bit.mask for bit in AxisStatus}
    assert SystemFlags.DEFINING_PROGRAM == 64
    assert isinstance(word, StatusWord)
    assert status_module.AxisFlags is AxisFlags


@pytest.mark.parametrize(
    ("value", "text"),
    [(5, "5"), (5.0, "5.0"), (1e-7, "0.0000001"), (Decimal("2.50"), "2.50"), (-1e9, "-1000000000.0"), (True, "1")],
)
def test_numbers_are_written_without_exponents(value: float, text: str) -> None:
    assert number_text(value) == text


@pytest.mark.parametrize("value", [float("nan"), float("inf"), Decimal("NaN")])
def test_what_is_no_number_is_refused(value: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        number_text(value)


def test_masks_and_quoted_texts() -> None:
    assert (mask([2]), mask([1, 2]), mask([1], "0", "1")) == ("X1", "11", "0")
    with pytest.raises(ValueError, match="count from 1"):
        mask([0])
    for text in ('a"b', "a\rb", "\u00e9"):
        with pytest.raises(ValueError, match="quoted text"):
            quoted(text)
    ctl = OEM6250(EmulatedLine())
    for bad in ("A5\rK", "A\n"):
        with pytest.raises(ValueError, match="one line at a time"):
            ctl.send(bad)
    with pytest.raises(IndexError):
        ctl.axis[0]


def test_a_user_s_project_passes_mypy_strict(tmp_path: Path) -> None:
    """The sample must pass, and its deliberate mistakes must be found."""
    sample = HERE / "typed_project.py.txt"
    good = tmp_path / "project.py"
    good.write_text(sample.read_text("utf-8"), "utf-8")
    bad = tmp_path / "mistakes.py"
    bad.write_text(
        "from clients import OEM6250\n"
        "def f(ctl: OEM6250) -> None:\n"
        "    ctl.axis[1].velocity = 'fast'\n"
        "    ctl.axis[1].velocitty = 5.0\n"
        "    position: str = ctl.axis[1].position\n"
        "    ctl.axis[1].position = 5.0\n"
        "    ctl.status.axis(1).movin\n",
        "utf-8",
    )
    command = [sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--follow-imports=silent"]
    config = tmp_path / "mypy.ini"
    config.write_text("[mypy]\n[mypy-serial.*]\nignore_missing_imports = True\n", "utf-8")
    told = subprocess.run(
        [*command, "--config-file", str(config), str(good), str(bad)],
        capture_output=True,
        text=True,
        check=False,
        cwd=HERE.parents[1],
    ).stdout
    errors = [line for line in told.splitlines() if ": error:" in line]
    assert [line for line in errors if "project.py" in line] == []
    assert [int(line.split(":")[1]) for line in errors if "mistakes.py" in line] == [3, 4, 5, 6, 7], told


def test_gains_need_their_lines() -> None:
    from clients import Garbled
    from clients.gains import parse

    lines = ["SGP2,1", "0,0", "SGV0,0", "SGVF0,0", "SGAF0,0", "SGILIM200,200"]
    assert parse(lines)[1] == Gains(1, 0, 0, 0, 0, 200)
    for bad in (lines[:3], ["SGP"], [*lines[:5], "SGILIM200"]):
        with pytest.raises(Garbled, match="a list of gains"):
            parse(bad)

"""The machine file: defaults as the reference settles them, wiring, and one clear line for every mistake."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from emulator.machine import Machine, MachineError, TorqueDrive, VelocityDrive
from emulator.machine_settings import DEFAULT_SETTINGS


def test_the_default_machine_is_an_empty_file() -> None:
    assert Machine.parse("") == Machine.default()


def test_settled_values() -> None:
    machine = Machine.default()
    assert machine.sign_on_lines == ("*PARKER OEM6250 MOTION CONTROLLER", "*NO REMOTE PANEL")
    assert machine.identity.revision == "92-000000-01-4.7 OEM6250"
    assert (machine.options.following, machine.options.ani, machine.options.expanded_memory) == (True, False, False)
    assert (machine.serial.max_command, machine.serial.buffer.size) == (100, 2000)
    assert (machine.serial.buffer.xoff_at_left, machine.serial.buffer.xon_at_left) == (200, 1000)
    assert (machine.limits.accel.minimum, machine.limits.accel.maximum) == (0.00025, 24_999_975)
    assert (machine.memory.program_bytes, machine.memory.compiled_bytes) == (21_400, 18_600)
    assert machine.memory.compiled_bytes // machine.memory.segment_bytes == 244
    assert machine.aliases == {"LSCW": "LSPOS", "LSCCW": "LSNEG"}
    assert (machine.servo.dac_bits, machine.encoder.max_rate) == (16, 1_600_000)


@pytest.mark.parametrize(
    ("indax", "ssfr", "periods_us"),
    [
        (1, 1, (330, 330, 1320)),
        (1, 2, (185, 370, 1480)),
        (1, 4, (160, 640, 1920)),
        (1, 8, (150, 1200, 2400)),
        (2, 1, (580, 580, 2320)),
        (2, 2, (325, 650, 1950)),
        (2, 4, (280, 1120, 2240)),
        (2, 8, (265, 2120, 2120)),
    ],
)
def test_update_periods(indax: int, ssfr: int, periods_us: tuple[int, int, int]) -> None:
    row = Machine.default().servo.ssfr_table.row(indax=indax, ssfr=ssfr)
    assert (row.servo_us, row.trajectory_us, row.system_us) == periods_us
    assert row.trajectory_us == ssfr * row.servo_us


def test_the_panel_changes_the_last_sign_on_line() -> None:
    machine = Machine.parse("[rp240]\nfitted = true")
    assert machine.sign_on_lines == ("*PARKER OEM6250 MOTION CONTROLLER", "*RP240 CONNECTED")


def test_error_levels_lose_something_on_the_way_down() -> None:
    forms = [Machine.default().errlvl.form(level) for level in range(5)]
    assert all(msgspec.structs.astuple(forms[4]))
    assert not any(msgspec.structs.astuple(forms[0]))
    assert (forms[3].ok_prompt, forms[3].error_text) == (True, False)
    assert (forms[2].names, forms[2].ok_prompt, forms[2].bad_prompt) == (True, False, True)
    assert (forms[1].star, forms[1].names, forms[1].bad_prompt) == (True, False, False)


def test_an_error_level_can_be_corrected() -> None:
    assert Machine.parse("[errlvl.3]\nerror_text = true").errlvl.form(3).error_text


@pytest.mark.parametrize("text", ["bare = true", 'wiring = "bare"', 'bare = true\nwiring = "bare"'])
def test_bare_means_nothing_is_wired(text: str) -> None:
    machine = Machine.parse(text)
    assert machine.bare and machine.wiring == "bare"
    assert machine.wires.enable == "open"
    for axis in machine.axes:
        assert (axis.wires.positive_limit, axis.wires.negative_limit, axis.wires.drive_fault) == ("open",) * 3


def test_full_wiring_is_the_default() -> None:
    machine = Machine.default()
    assert not machine.bare and machine.wiring == "full"
    assert machine.wires.enable == "closed"
    assert machine.axis1.wires.positive_limit == machine.axis2.wires.negative_limit == "closed"
    assert machine.axis1.wires.home == machine.axis1.wires.drive_fault == "open"


def test_a_given_contact_wins_over_bare() -> None:
    machine = Machine.parse('bare = true\n[axis2.wires]\nnegative_limit = "closed"')
    assert machine.axis2.wires.negative_limit == "closed"
    assert machine.axis2.wires.positive_limit == machine.axis1.wires.negative_limit == "open"


def test_plants() -> None:
    machine = Machine.parse('[axis2.plant]\nkind = "torque_drive"\ninertia_kg_m2 = 1e-3')
    assert machine.axis1.plant == VelocityDrive()
    assert machine.axis2.plant == TorqueDrive(inertia_kg_m2=1e-3)


def test_defaults_are_merged_and_normalised() -> None:
    machine = Machine.parse('[defaults]\nECHO = 0\nLH = [0, 3]\nDRIVE = "10"\nEOT = [13, 10, 0]')
    assert machine.defaults["ECHO"] == "0"
    assert machine.defaults["LH"] == "0,3"
    assert machine.defaults["DRIVE"] == "10"
    assert machine.defaults["EOT"] == "13,10,0"
    assert machine.defaults["ERRLVL"] == DEFAULT_SETTINGS["ERRLVL"][0]


def test_load_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "unit.toml"
    path.write_text("[servo]\ndac_bits = 12\n", encoding="utf-8")
    assert Machine.load(path).servo.dac_bits == 12
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(MachineError, match=r"unit\.toml: found bytes that are not UTF-8"):
        Machine.load(path)
    with pytest.raises(MachineError, match=r"absent\.toml: found No such file"):
        Machine.load(tmp_path / "absent.toml")


PROBLEMS = [
    # text, key, found, allowed
    ("a =", "", "Invalid value", "a TOML document"),
    ("colour = 1", "colour", "1", "keys identity, rp240"),
    ("[servo]\ndac_bits = 40", "servo.dac_bits", "40", "a whole number >= 8 and <= 24"),
    ("[servo]\ndac_bits = 12.5", "servo.dac_bits", "12.5", "a whole number"),
    ("[servo]\ndacbits = 4", "servo.dacbits", "4", "did you mean dac_bits?"),
    ("[serial.buffer]\nsize = true", "serial.buffer.size", "true", "a whole number >= 64"),
    ("bare = 1", "bare", "1", "true or false"),
    ('bare = true\nwiring = "full"', "wiring", "'full'", '"bare"'),
    ('wiring = "half"', "wiring", "'half'", "'bare' or 'full'"),
    ('[wires]\nenable = "shut"', "wires.enable", "'shut'", "'closed' or 'open'"),
    ("[wires]\ninputs = [3, 27]", "wires.inputs", "27", "input numbers 1 to 26"),
    ("[io]\ninputs = 8\n[wires]\ninputs = [11]", "wires.inputs", "11", "input numbers 1 to 10"),
    ("[wires]\nanalog = [1, 2, 3]", "wires.analog.2", "3", "a number >= 0.0 and <= 2.5"),
    ("[io]\ninputs = 7", "io.inputs", "7", "8 or 16 or 24"),
    ("axis1 = [1]", "axis1", "[1]", "a table"),
    ("[axis9]", "axis9", "a table", "keys identity"),
    ("[axis1.plant]\nkind = 'piston'", "axis1.plant.kind", "'piston'", "'velocity_drive'"),
    ("[axis1.plant]\ninertia_kg_m2 = 1", "axis1.plant.kind", "nothing", "'velocity_drive'"),
    (
        "[axis1.plant]\nkind = 'velocity_drive'\nspeed = 3",
        "axis1.plant.speed",
        "3",
        "keys preset, speed_per_volt_rev_s",
    ),
    ("[axis1.plant]\nkind = 'torque_drive'\ninertia_kg_m2 = 0", "axis1.plant.inertia_kg_m2", "0", "a number > 0"),
    ("[axis2.encoder]\nphase = 1.0", "axis2.encoder.phase", "1.0", "a number >= 0 and < 1"),
    ("[identity]\nsign_on = []", "identity.sign_on", "[]", "a list of at least 1"),
    ('[identity]\nrevision = "a\\n"', "identity.revision", r"'a\\n'", "a text of the form"),
    ("[errlvl.4]\nstar = true", "errlvl.4", "a table", "keys 3, 2, 0"),
    ("[memory]\nprogram_bytes = 30000", "memory.compiled_bytes", "18600", "at most 10000"),
    ("[memory]\nprogram_bytes = 1001", "memory.program_bytes", "1001", "a multiple of 2"),
    ("[limits.accel]\nminimum = 3", "limits.accel.maximum", "nothing", "a number > 0"),
    ("[limits.accel]\nminimum = 3\nmaximum = 2", "limits.accel.maximum", "2", "above minimum"),
    ("aliases = {LSCW = 3}", "aliases", "a table", "each value a text"),
    ("defaults = 3", "defaults", "3", "a table"),
    ("[defaults]\necho = 1", "defaults.echo", "'echo'", "in capitals"),
    ("[defaults]\nTPE = 1", "defaults.TPE", "'TPE'", "a command that is a setting"),
    ("[defaults]\nWARP = 1", "defaults.WARP", "'WARP'", "a command that is a setting"),
    ("[defaults]\nECHO = 2", "defaults.ECHO", "2", "fields as in"),
    ("[defaults]\nLH = [0, 4]", "defaults.LH", "[0, 4]", "INVALID DATA-FIELD 2"),
    ("[defaults]\nLH = [0, 3, 1]", "defaults.LH", "[0, 3, 1]", "INCORRECT AXIS"),
    ("[defaults]\nDRIVE = '111'", "defaults.DRIVE", "'111'", "INCORRECT AXIS"),
    ("[defaults]\nECHO = ''", "defaults.ECHO", "''", "a value is needed"),
    ("[defaults]\nECHO = {a = 1}", "defaults.ECHO", "{'a': 1}", "a number, a text, or a list"),
    # keys of commands that are not part of this machine yet
    ("[following]\npredictor = 1", "following.predictor", "1", "'one_sample' or 'two_samples'"),
    ("[rcm]\nport = 502", "rcm", "a table", "keys identity"),
]


@pytest.mark.parametrize(
    ("text", "key", "found", "allowed"), PROBLEMS, ids=[problem[1] or "toml" for problem in PROBLEMS]
)
def test_every_mistake_is_one_line(text: str, key: str, found: str, allowed: str) -> None:
    with pytest.raises(MachineError) as failure:
        Machine.parse(text, name="bench.toml")
    line = str(failure.value)
    assert "\n" not in line
    assert line.startswith(f"bench.toml: {key}: found " if key else "bench.toml: found ")
    told_found, told_allowed = line.split(": found ", 1)[1].split("; allowed: ", 1)
    assert found.replace("\\\\", "\\") in told_found
    assert allowed in told_allowed


RATES = """
[servo.ssfr_table]
indax2 = [
  {{ ssfr = 1, servo_us = 500, trajectory_us = 500, system_us = 2000 }},
  {{ ssfr = 2, servo_us = 300, trajectory_us = {trajectory}, system_us = 1800 }},
  {{ ssfr = {ratio}, servo_us = 250, trajectory_us = 1000, system_us = {system} }},
  {{ ssfr = 8, servo_us = 250, trajectory_us = 2000, system_us = 2000 }},
]
"""


def test_a_rate_table_can_be_given() -> None:
    machine = Machine.parse(RATES.format(trajectory=600, ratio=4, system=2000))
    assert machine.servo.ssfr_table.row(indax=2, ssfr=4).servo_us == 250
    assert machine.servo.ssfr_table.row(indax=1, ssfr=4).servo_us == 160


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (
            {"trajectory": 650, "ratio": 4, "system": 2000},
            r"indax2\.1\.trajectory_us: found 650; allowed: a multiple of 300",
        ),
        (
            {"trajectory": 600, "ratio": 4, "system": 2500},
            r"indax2\.2\.system_us: found 2500; allowed: a multiple of 1000",
        ),
        ({"trajectory": 600, "ratio": 2, "system": 2000}, r"indax2: found ssfr \[1, 2, 2, 8\]"),
        ({"trajectory": 600, "ratio": 3, "system": 2000}, r"indax2\.2\.ssfr: found 3; allowed: 1 or 2 or 4 or 8"),
    ],
)
def test_rates_must_divide(values: dict[str, int], said: str) -> None:
    with pytest.raises(MachineError, match=said):
        Machine.parse(RATES.format(**values))


def test_a_machine_cannot_be_changed() -> None:
    with pytest.raises(AttributeError):
        Machine.default().bare = True  # type: ignore[misc]


def test_an_analog_feedback_sensor_belongs_to_its_axis() -> None:
    machine = Machine.parse("[options]\nani = true\n[axis2.ani]\nvolts_per_rev = -0.5\n")
    assert machine.options.ani
    assert (machine.axis1.ani.volts_per_rev, machine.axis2.ani.volts_per_rev) == (1.0, -0.5)


@pytest.mark.parametrize(
    ("fields", "found"), [('"+14,0"', "'+14,0'"), ('"+31"', "'+31'"), ('"22"', "'22'"), ("[21, 21]", "'21,21'")]
)
def test_a_master_that_no_host_could_assign_is_refused(fields: str, found: str) -> None:
    with pytest.raises(MachineError, match=r"mine\.toml: defaults\.FOLMAS: found ") as refused:
        Machine.parse(f"[defaults]\nFOLMAS = {fields}", name="mine.toml")
    assert found in str(refused.value)


def test_a_unit_may_come_up_as_a_slave() -> None:
    machine = Machine.parse('[defaults]\nFOLMAS = "+21,0"\nFOLEN = "10"')
    assert machine.defaults["FOLMAS"] == "+21,0"

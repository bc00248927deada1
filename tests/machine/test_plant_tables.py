"""The plant tables: presets, one clear line for every impossible machine, and the way into the engine."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import msgspec
import pytest
from msgspec import inspect

from emulator import engine
from emulator.controller.build import axis_hardware
from emulator.machine import Machine, MachineError
from emulator.plant_tables import KINDS, PRESETS, engine_plant


def keys_of(table: type) -> set[str]:
    info: Any = inspect.type_info(table)
    return {field.name for field in info.fields} - {"preset"}


@pytest.mark.parametrize("kind", KINDS)
def test_each_table_has_the_parameters_of_its_plant(kind: str) -> None:
    plant = engine_plant(KINDS[kind]())
    assert keys_of(KINDS[kind]) == set(type(plant).__dataclass_fields__)


@pytest.mark.parametrize(("kind", "preset"), [(kind, preset) for kind in KINDS for preset in PRESETS[kind]])
def test_every_preset_makes_a_plant_of_its_kind(kind: str, preset: str) -> None:
    machine = Machine.parse(f'[axis2.plant]\npreset = "{preset}"\nkind = "{kind}"')
    assert machine == Machine.parse(f'[axis2.plant]\npreset = "{preset}"'), "the kind follows from the preset"
    values = msgspec.structs.asdict(machine.axis2.plant)
    assert PRESETS[kind][preset].items() <= values.items()
    assert machine.axis2.plant == msgspec.convert(
        {"kind": kind, "preset": preset, **PRESETS[kind][preset]}, KINDS[kind]
    )
    engine_plant(machine.axis2.plant)


def test_what_is_given_wins_over_the_preset() -> None:
    machine = Machine.parse('[axis1.plant]\npreset = "timing_belt"\nload_inertia_kg_m2 = 2e-3')
    plant = engine_plant(machine.axis1.plant)
    assert isinstance(plant, engine.ElasticCoupling)
    assert (plant.load_inertia_kg_m2, plant.stiffness_nm_per_rad) == (2e-3, 20.0)


def test_a_linear_axis_counts_in_its_own_unit() -> None:
    machine = Machine.parse('[axis1.plant]\nkind = "hydraulic_cylinder"\n[axis1.encoder]\ncounts_per_unit = 10_000')
    assert axis_hardware(machine.axis1).counts_per_rev == 10_000


def test_the_encoder_table_reaches_the_engine() -> None:
    machine = Machine.parse('[axis1.encoder]\nat = "load"\nnoise_counts = 1.5\nnoise_seed = 9')
    hardware = axis_hardware(machine.axis1, max_rate_counts_s=machine.encoder.max_rate)
    assert hardware.encoder == engine.EncoderTraits(
        on_load=True, noise_counts_rms=1.5, noise_seed=9, max_rate_counts_s=1_600_000.0
    )


PROBLEMS = [
    # table of axis 1, key, found, allowed
    ('kind = "piston"', "kind", "'piston'", "'elastic_coupling' or 'hydraulic_cylinder'"),
    ('preset = "steam"', "preset", "'steam'", "small_brushless"),
    (
        'kind = "torque_drive"\npreset = "timing_belt"',
        "preset",
        "'timing_belt'",
        "or vertical_axis for a torque",
    ),
    ("preset = 3", "kind", "nothing", "'velocity_drive'"),
    ('kind = "velocity_drive"\nloop_time_constant_s = 0', "loop_time_constant_s", "0", "> 0"),
    ('kind = "velocity_drive"\nspeed_per_volt_rev_s = inf', "speed_per_volt_rev_s", "inf", "from 1e-12 to 1e+12"),
    ('kind = "velocity_drive"\nload_torque_nm = 1', "load_torque_nm", "1", "0 on a velocity drive without droop"),
    ('kind = "torque_drive"\ninertia_kg_m2 = -1', "inertia_kg_m2", "-1", "> 0"),
    ('kind = "torque_drive"\ninertia_kg_m2 = nan', "inertia_kg_m2", "nan", "> 0"),
    ('kind = "torque_drive"\nload_torque_nm = nan', "load_torque_nm", "nan", "a number"),
    ('kind = "torque_drive"\nload_torque_nm = inf', "load_torque_nm", "inf", "from -1e+12 to 1e+12"),
    (
        'kind = "elastic_coupling"\nstiffness_nm_per_rad = 1e9',
        "stiffness_nm_per_rad",
        "1e+09 (a resonance at",
        "20000 Hz",
    ),
    ('kind = "elastic_coupling"\ndrive = "speed"', "drive", "'speed'", "'torque' or 'velocity'"),
    ('kind = "elastic_coupling"\ndamping_nm_s_per_rad = 1e5', "damping_nm_s_per_rad", "100000", "at most 100"),
    ('kind = "hydraulic_cylinder"\noverlap_v = -1', "overlap_v", "-1", ">= 0"),
    (
        'kind = "hydraulic_cylinder"\nextended_stop_units = -1\nretracted_stop_units = 1',
        "extended_stop_units",
        "-1",
        "1",
    ),
]


@pytest.mark.parametrize(("table", "key", "found", "allowed"), PROBLEMS, ids=[text for text, *_ in PROBLEMS])
def test_every_impossible_plant_is_one_line(table: str, key: str, found: str, allowed: str) -> None:
    with pytest.raises(MachineError) as failure:
        Machine.parse(f"[axis1.plant]\n{table}", name="bench.toml")
    line = str(failure.value)
    assert line.startswith(f"bench.toml: axis1.plant.{key}: found {found}")
    assert allowed in line.split("; allowed: ")[1]
    assert "\n" not in line


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("counts_per_rev = 4000\ncounts_per_unit = 100", "axis2.encoder.counts_per_unit"),
        ("counts_per_unit = 100", "axis2.encoder.counts_per_unit"),
        ("noise_counts = inf", "axis2.encoder.noise_counts"),
        ("noise_seed = -1", "axis2.encoder.noise_seed"),
        ('at = "table"', "axis2.encoder.at"),
    ],
)
def test_contradictions_of_the_encoder_are_one_line(text: str, key: str) -> None:
    with pytest.raises(MachineError) as failure:
        Machine.parse(f"[axis2.encoder]\n{text}", name="bench.toml")
    assert str(failure.value).startswith(f"bench.toml: {key}: found ")


def test_not_a_number_is_refused_wherever_it_stands() -> None:
    with pytest.raises(MachineError, match=r"axis1\.travel\.positive_limit_rev: found nan"):
        Machine.parse("[axis1.travel]\npositive_limit_rev = nan")


def test_infinite_where_there_is_none() -> None:
    plant = engine_plant(Machine.parse('[axis1.plant]\nkind = "torque_drive"\npeak_torque_nm = inf').axis1.plant)
    assert isinstance(plant, engine.TorqueDrive)
    assert plant.peak_torque_nm == math.inf


def test_the_guide_to_the_plants_is_true() -> None:
    guide = (Path(__file__).parents[2] / "docs" / "plants.md").read_text(encoding="utf-8")
    machine = Machine.parse(guide.split("```toml\n")[1].split("```")[0])
    assert isinstance(engine_plant(machine.axis1.plant), engine.ElasticCoupling)
    assert machine.axis2.encoder.counts == 10_000
    for word in [*KINDS, *(preset for presets in PRESETS.values() for preset in presets)]:
        assert f"`{word}`" in guide

"""`oem6250 check`: one line a machine file, and the nearest valid key for a typo."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.cli import main
from emulator.machine import Machine, MachineError


def written(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.write_text(text)
    return str(path)


def test_an_empty_file_is_the_default_machine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, "empty.toml", "")
    assert main(["check", path]) == 0
    axes = "axis 1: velocity drive, 4000 counts/rev; axis 2: velocity drive, 4000 counts/rev"
    said = f"{path}: {axes}; 24 inputs, 24 outputs; Following; wired; 0 keys differ from the default machine\n"
    assert capsys.readouterr() == (said, "")


def test_it_says_what_each_would_be(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plant = '[axis2.plant]\nkind = "torque_drive"\n[axis2.encoder]\ncounts_per_rev = 8000\n[rp240]\nfitted = true\n'
    paths = [written(tmp_path, "bench.toml", plant), written(tmp_path, "bare.toml", "bare = true")]
    assert main(["check", *paths]) == 0
    bench, bare = capsys.readouterr().out.splitlines()
    assert "axis 2: torque drive, 8000 counts/rev" in bench
    assert "RP240; wired; 3 keys differ" in bench
    assert "; bare; " in bare


def test_every_file_is_told_of_and_one_bad_one_is_enough(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = written(tmp_path, "good.toml", ""), written(tmp_path, "bad.toml", "[servo]\ndac_bits = 40")
    missing = str(tmp_path / "missing.toml")
    assert main(["check", bad, missing, good]) == 2
    out, errors = capsys.readouterr()
    assert out.startswith(f"{good}: ")
    assert errors.splitlines() == [
        f"oem6250: {bad}: servo.dac_bits: found 40; allowed: a whole number >= 8 and <= 24",
        f"oem6250: {missing}: found No such file or directory; allowed: a readable TOML file",
    ]


@pytest.mark.parametrize(
    ("text", "key", "meant"),
    [
        ("[servo]\ndac_bit = 12", "servo.dac_bit", "dac_bits"),
        ("[axsi1]\n", "axsi1", "axis1"),
        ("[axis1.plant]\nkind = 'torque_drive'\ncolomb_nm = 1.0", "axis1.plant.colomb_nm", "coulomb_nm"),
        ("counts_per_rev = 8000", "counts_per_rev", "axis1.encoder.counts_per_rev"),
        ("[axis2]\npositive_limit = 'open'", "axis2.positive_limit", "axis2.wires.positive_limit"),
        ("[wires]\ncoulomb_nm = 1.0", "wires.coulomb_nm", "axis1.plant.coulomb_nm"),
        ("[defaults]\nERLVL = 1", "defaults.ERLVL", "ERRLVL"),
        ("[defaults]\necho = 0", "defaults.echo", "ECHO"),
    ],
)
def test_a_typo_names_the_nearest_valid_key(text: str, key: str, meant: str) -> None:
    with pytest.raises(MachineError) as refused:
        Machine.parse(text, name="m.toml")
    assert str(refused.value).startswith(f"m.toml: {key}: ")
    assert str(refused.value).endswith(f"(did you mean {meant}?)")


def test_what_looks_like_nothing_is_only_refused() -> None:
    with pytest.raises(MachineError, match="keys") as refused:
        Machine.parse("[servo]\nzzz = 1")
    assert "did you mean" not in str(refused.value)


def test_every_kind_of_plant_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "press.toml"
    path.write_text('[axis1.plant]\npreset = "documented_cylinder"\n[axis2.plant]\nkind = "elastic_coupling"\n')
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr().out
    assert "axis 1: hydraulic cylinder" in told
    assert "axis 2: elastic coupling" in told

"""Where the machine code comes from: cache, build, damage, directories that cannot be written."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from emulator.engine import AxisHardware, Engine, machine_code, rates_for
from emulator.engine.machine_code import CACHE_VARIABLE, MODE_VARIABLE, ObjectCode

START = """
import sys, time
begin = time.perf_counter()
from emulator.engine import AxisHardware, Engine, rates_for
engine = Engine([AxisHardware()], rates=rates_for(2, 4), on_build=print)
engine.run(10_000_000)
print(engine.kernel_origin, "numba" in sys.modules, time.perf_counter() - begin)
"""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache directory of the test's own, holding a whole kernel file; the file's path."""
    Engine([AxisHardware()], rates=rates_for(2, 4))
    whole = machine_code.cache_path().read_bytes()
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    path = machine_code.cache_path()
    path.write_bytes(whole)
    return path


@pytest.fixture
def builds(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Builds asked for, none of them done."""
    asked: list[Path] = []

    def build(path: Path) -> Any:
        asked.append(path)
        return SimpleNamespace(origin="built")

    monkeypatch.setattr(machine_code, "build", build)
    return asked


def start_process(**environment: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", START], capture_output=True, text=True, check=True, env={**os.environ, **environment}
    )
    return done.stdout.split()


def test_a_warm_start_does_not_import_numba(cache: Path) -> None:
    origin, numba_imported, seconds = start_process()
    assert (origin, numba_imported) == ("cache", "False")
    assert float(seconds) < 2.0


def test_interpreted_needs_neither_numba_nor_llvm() -> None:
    origin, numba_imported, _ = start_process(**{MODE_VARIABLE: "interpreted"})
    assert (origin, numba_imported) == ("interpreted", "False")


@pytest.mark.parametrize("place", [0, 30, 60, 5000, -1])
def test_a_damaged_file_is_built_anew(cache: Path, builds: list[Path], place: int) -> None:
    content = bytearray(cache.read_bytes())
    content[place] ^= 0x10
    cache.write_bytes(content)
    told: list[str] = []
    assert machine_code.load_compiled(told.append).origin == "built"
    assert builds == [cache]
    assert len(told) == 1
    assert "building the servo kernel" in told[0]


@pytest.mark.parametrize("content", [b"", b"OEM6250", b"\0" * 100_000])
def test_a_file_that_is_none_of_ours_is_built_anew(cache: Path, builds: list[Path], content: bytes) -> None:
    cache.write_bytes(content)
    machine_code.load_compiled()
    assert builds == [cache]


def test_object_code_without_its_entry_point_is_built_anew(cache: Path, builds: list[Path]) -> None:
    whole = machine_code.read_object(cache)
    assert whole is not None
    machine_code.write_object(cache, ObjectCode("entry", whole.code))
    machine_code.load_compiled()
    assert builds == [cache]


def test_a_whole_file_is_used_without_a_word(cache: Path, builds: list[Path]) -> None:
    told: list[str] = []
    assert machine_code.load_compiled(told.append).origin == "cache"
    assert (builds, told) == ([], [])


def test_object_code_survives_the_file(tmp_path: Path) -> None:
    compiled = ObjectCode("entry.point", b"\n\0\xff code \n")
    path = tmp_path / "deep" / "kernel"
    assert machine_code.write_object(path, compiled)
    assert machine_code.read_object(path) == compiled
    assert [file.name for file in path.parent.iterdir()] == ["kernel"], "no half-written file stays behind"


def test_a_directory_that_cannot_be_written_only_costs_the_build(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file" / "cache"))
    library = SimpleNamespace(_get_compiled_object=lambda: b"code")
    function = SimpleNamespace(_wrapper_name="entry", _library=library, address=4096)
    monkeypatch.setattr(machine_code, "_compile", lambda: function)
    kernel = machine_code.load_compiled()
    assert (kernel.origin, kernel.address) == ("memory", 4096)


def test_a_numba_that_hides_its_object_code_still_gives_a_kernel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine_code, "_compile", lambda: SimpleNamespace(address=4096))
    assert machine_code.build(tmp_path / "kernel").origin == "memory"
    assert not (tmp_path / "kernel").exists()


def test_the_installed_numba_knows_every_option_that_keeps_functions_lean() -> None:
    known = machine_code.known_options(import_module("numba.core.options"))
    assert known == machine_code.LEAN_FUNCTIONS


def test_an_option_that_a_numba_does_not_know_is_left_out() -> None:
    another = SimpleNamespace(DefaultOptions=SimpleNamespace(no_cfunc_wrapper=object()))
    assert machine_code.known_options(another) == {"no_cfunc_wrapper": True}


@pytest.mark.slow
def test_a_real_build_runs_and_is_kept(cache: Path) -> None:
    cache.write_bytes(b"damaged")
    first = start_process()
    assert first[:6] == ["building", "the", "servo", "kernel", "for", "this"]
    assert first[-3:-1] == ["built", "True"]
    assert start_process()[:2] == ["cache", "False"]

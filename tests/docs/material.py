"""Files that blocks of the pages work on and that no page shows: machine files, moves, a recording, a state file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from emulator import Emulator

REPOSITORY: Final = Path(__file__).resolve().parents[2]
MOVE: Final = "DRIVE1\nA100\nV5\nD4000\nGO1\n"
AXIS: Final = "[axis1.encoder]\ncounts_per_rev = 8000\n"
BENCH: Final = '[axis1.plant]\nkind = "torque_drive"\n[axis1.encoder]\ncounts_per_rev = 8000\n'


def _recording(path: Path) -> None:
    with Emulator(record=path) as emulator:
        emulator.unit().send(b"1TPE\r")
        emulator.advance(0.5)
        emulator.unit().do("set_wire", name="enable", closed=False)
        emulator.unit().send(b"!1TAS\r")
        emulator.advance(0.5)


def _state(path: Path) -> None:
    with Emulator(state=path) as emulator:
        emulator.unit().send(b"VAR3=12.5\rSTARTP MAIN\r")
        emulator.unit().read()


def _text(text: str) -> Callable[[Path], None]:
    def make(path: Path) -> None:
        path.write_text(text, encoding="utf-8")

    return make


def _copy(name: str) -> Callable[[Path], None]:
    return _text((REPOSITORY / name).read_text(encoding="utf-8"))


MATERIAL: Final[Mapping[str, Callable[[Path], None]]] = {
    "axis.toml": _text(AXIS),
    "mine.toml": _text(AXIS),
    "bench.toml": _text(BENCH),
    "torque.toml": _text(BENCH),
    "spare.toml": _text("[servo]\ndac_bit = 12\n"),
    "move.txt": _text(MOVE),
    "press.toml": _text(AXIS),
    "OTHER.toml": _text(""),
    "session.rec": _recording,
    "sniffed.log": _text("1700000000.100 TX 31 54 50 45 0D\n1700000000.112 RX 2A 31\n"),
    "plant.state": _state,
    "press.py": _copy("tests/sample_host/press.py"),
}
"""Name of a file -> what makes it."""


def lay_out(folder: Path, names: str) -> None:
    """Make the named files (separated by blanks) in a folder."""
    for name in names.split():
        MATERIAL[name](folder / name)

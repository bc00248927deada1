"""`oem6250 state FILE show|export|import|clear`: a state file as a person reads it, while no emulator uses it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.state.contents import Contents, Rows
    from emulator.state.store import Store

STANDARD = "-"

EXAMPLES = """\
  show             what each unit keeps, in short
  export [TEXT]    all of it as text (TOML), to standard output or a file
  import [TEXT]    put a text in place of all that is kept, from standard input or a file; makes FILE if it is absent
  clear            nothing is kept any more, as after a flat battery
"""


def add_state(commands: Any) -> None:
    """The parser of the subcommand."""
    state = commands.add_parser(
        "state",
        description="Look at and change a file of non-volatile memory (serve --state FILE) that no emulator is using.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    state.add_argument("file", metavar="FILE", help="the state file")
    state.add_argument("action", choices=("show", "export", "import", "clear"), metavar="show|export|import|clear")
    state.add_argument("text", nargs="?", default=STANDARD, metavar="TEXT", help="file of the text form; - is standard "
        "input or output (default: -)")  # fmt: skip
    state.set_defaults(carry_out=do_state)


def do_state(parsed: argparse.Namespace) -> int:
    """Carry it out; 0, or 2 after one line about what is wrong."""
    from emulator.state.errors import StateError

    try:
        if parsed.action in ("show", "clear") and parsed.text != STANDARD:
            raise StateError(f"{parsed.action} takes no text")
        _ACTIONS[parsed.action](Path(parsed.file), parsed.text)
        sys.stdout.flush()
    except StateError as error:
        print(f"oem6250: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        sys.stderr.close()
    return 0


def _show(file: Path, _: str) -> None:
    from emulator.state.contents import contents_of

    units = _read(file)
    if not units:
        print("nothing is kept")
    for unit in sorted(units):
        print(f"unit {unit + 1}")
        for name, text in _summary(contents_of(units[unit])):
            print(f"  {name:<9} {text}")


def _summary(contents: Contents) -> list[tuple[str, str]]:
    settings = [f"{name.partition('@')[0]} {text}" for name, text in contents.settings if not name.endswith("@2")]
    variables = [f"VAR{place}={value}" for place, value in enumerate(contents.numbers, start=1) if value]
    bits = [f"VARB{place}={value}" for place, value in enumerate(contents.bits, start=1) if set(value) != {"X"}]
    texts = [f"VARS{place}={value!r}" for place, value in enumerate(contents.texts, start=1) if value]
    programs = [f"{program.name} ({len(program.lines)} commands)" for program in contents.programs]
    sets = sorted({gain.set_number for gain in contents.gains})
    found = {
        "settings": settings,
        "programs": programs,
        "VAR": variables,
        "VARB": bits,
        "VARS": texts,
        "gain sets": list(map(str, sets)),
        "profiles": [name for name, _ in contents.profiles],
    }
    return [(name, ", ".join(texts)) for name, texts in found.items() if texts]


def _export(file: Path, place: str) -> None:
    from emulator.state.errors import StateError
    from emulator.state.text import export

    text = export(_read(file))
    if place == STANDARD:
        sys.stdout.buffer.write(text.encode())
        return
    try:
        Path(place).write_text(text, encoding="utf-8")
    except OSError as error:
        raise StateError(f"{place}: cannot be written ({error.strerror})") from None


def _import(file: Path, place: str) -> None:
    from emulator.state.errors import StateError
    from emulator.state.text import read

    try:
        data = sys.stdin.buffer.read() if place == STANDARD else Path(place).read_bytes()
        text = data.decode()
    except OSError as error:
        raise StateError(f"{place}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise StateError(f"{place}: cannot be read (bytes that are not UTF-8)") from None
    units = read(text, name="standard input" if place == STANDARD else place)
    _replace(file, units, create=True)


def _clear(file: Path, _: str) -> None:
    _replace(file, {}, create=False)


def _read(file: Path) -> dict[int, Rows]:
    store = _open(file, create=False)
    try:
        return {unit: rows for unit, rows in store.units.items() if rows}
    finally:
        store.close()


def _replace(file: Path, units: dict[int, Rows], *, create: bool) -> None:
    store = _open(file, create=create)
    try:
        store.replace(units)
    finally:
        store.close()


def _open(file: Path, *, create: bool) -> Store:
    from emulator.state.store import Store

    return Store(file, create=create)


_ACTIONS = {"show": _show, "export": _export, "import": _import, "clear": _clear}

"""What the head of a recording says, and the machine set up again from it."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

from emulator import __version__
from emulator.chain import Chain, build_chain
from emulator.channel import ControllerLike
from emulator.machine import Machine
from emulator.machine_tables import FASTEST_BAUD
from emulator.recording.format import RecordingError
from emulator.recording.header import Header

DAMAGED = "# found damaged and cleared"


def versions() -> dict[str, str]:
    """What the bytes of a session may depend on beside the session."""
    interpreted = os.environ.get("OEM6250_KERNEL") == "interpreted"
    return {
        "program": __version__,
        "python": platform.python_version(),
        "kernel": "interpreted" if interpreted else f"compiled by numba {_installed('numba')}",
        "numpy": _installed("numpy"),
        "processor": platform.machine(),
    }


def describe(
    machine_texts: Sequence[str],
    *,
    speed: str,
    chain: int = 1,
    options: Mapping[str, str] | None = None,
    states: Mapping[int, str] | None = None,
) -> Header:
    """The head of a session that begins now.

    Args:
        machine_texts: one machine file for each unit.
        speed: as given on the command line, or `virtual`.
        chain: units of the daisy chain on each line.
        options: further options that change what is sent, or when.
        states: by unit number, the non-volatile memory at the start in its text form.
    """
    fields = {
        "source": "emulator",
        **versions(),
        "units": str(len(machine_texts)),
        "chain": str(chain),
        "speed": speed,
        **(options or {}),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    texts = {f"machine u{unit}": text for unit, text in enumerate(machine_texts)}
    texts |= {f"state u{unit}": text for unit, text in (states or {}).items()}
    return Header(fields, texts)


def different_versions(header: Header) -> list[str]:
    """What this program has otherwise than the one that recorded, for the reader of a difference."""
    return [
        f"{name} {header.fields[name]} then, {now} now"
        for name, now in versions().items()
        if header.fields.get(name, now) != now
    ]


def build_units(header: Header, *, machine: Machine | None = None) -> list[ControllerLike]:
    """The units of a recording, switched on, with nothing said yet; `machine` takes the place of the recorded ones.

    Raises:
        RecordingError: the head does not say enough.
        MachineError: the recorded machine file cannot be used by this program.
    """
    chain_of = header.number("chain", 1)
    return [_build(header, unit, chain_of, machine) for unit in range(header.number("units", 1))]


def _build(header: Header, unit: int, chain_of: int, machine: Machine | None) -> ControllerLike:
    name = f"machine u{unit}"
    if machine is None and name not in header.texts and not header.from_line:
        raise RecordingError(f"the head has no [{name}]; name a machine file with --machine")
    machine = machine or Machine.parse(header.texts.get(name, ""), name=name)
    chain = build_chain(machine.on_line(_line_baud(header)), chain_of)
    _restore(chain, header, unit)
    chain.power_up()
    return chain if chain_of > 1 else chain.controllers[0]


def _line_baud(header: Header) -> int | None:
    """The speed of the line that the command line asked for, if it did."""
    text = header.fields.get("line")
    if text is None:
        return None
    if not (text.isascii() and text.isdigit() and int(text) <= FASTEST_BAUD):
        raise RecordingError(f"line = {text!r} in the head is not a baud rate")
    return int(text)


def stored_memory(chain: Chain) -> str:
    """What the units of a line, not switched on yet, have in their non-volatile memory: the text `oem6250 state FILE
    export` writes, with a comment before it if the memory was found damaged."""
    from emulator.controller.nonvolatile import collect
    from emulator.state.contents import rows_of
    from emulator.state.text import export

    text = export({index: rows_of(collect(controller)) for index, controller in enumerate(chain.controllers)})
    return f"{DAMAGED}\n{text}" if any(controller.memory_damaged for controller in chain.controllers) else text


def _restore(chain: Chain, header: Header, unit: int) -> None:
    """Give units the non-volatile memory they started with."""
    name = f"state u{unit}"
    if name not in header.texts:
        return
    from emulator.controller.nonvolatile import put_back
    from emulator.state.contents import contents_of
    from emulator.state.errors import StateError
    from emulator.state.text import read

    try:
        kept = read(header.texts[name], name=name)
    except StateError as error:
        raise RecordingError(str(error)) from None
    for index, controller in enumerate(chain.controllers):
        put_back(controller, contents_of(kept.get(index, {})))
        controller.memory_damaged = header.texts[name].startswith(DAMAGED)


def _installed(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "none"

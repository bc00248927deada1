"""What of a changed machine file a running unit takes over without a restart.

Only differences count: a contact that somebody has opened since the start stays as it is unless the file now says
something else about it than before. What a unit settles when it is built (memory, servo tables, power-up settings)
stays as it was and is named, so that nobody believes it changed.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol, cast, runtime_checkable

import msgspec

from emulator.chain import addressed
from emulator.controller import Controller
from emulator.controller.communications import framing_in_force
from emulator.logs import event_line
from emulator.machine import Machine, MachineError
from emulator.machine_keys import differing_keys, keys_and_values
from emulator.pacing import EngineThread
from emulator.plant_tables import engine_plant

_IN_PLACE = re.compile(
    r"identity\..*|rp240\.sign_on_line|errlvl\..*|aliases|wiring|bare"
    r"|startp_needs_enable|answer_tpm|tas_layout|del_missing_is_error"
    r"|serial\.(prompt_per|empty_prompt|echo_terminator|error_lead|go_prompt)"
    r"|timing\.commands_per_update"
    r"|axis[12]\.(plant|wires\..*)|wires\..*"
)
"""Keys that take effect in a running unit: those it looks up when it needs them, drives and loads, and contacts."""


_log = logging.getLogger("oem6250.server")


@runtime_checkable
class HearsOfMachines(Protocol):
    """A unit that wants to know when a machine file has been read again (a recorded one does)."""

    def machine_changes(self, machine: Machine) -> None: ...


class Reload(NamedTuple):
    """What became of a changed machine file."""

    machine: Machine
    """The machine now in force."""
    applied: tuple[str, ...]
    """Keys that changed and took effect."""
    needs_restart: tuple[str, ...]
    """Keys that changed and did not."""


def compare(old: Machine, new: Machine) -> Reload:
    """Sort the keys in which two machines differ, and make the machine that a running unit becomes."""
    after, changed = dict(keys_and_values(new)), differing_keys(old, new)
    applied = [key for key in changed if _in_place(key, changed)]
    machine: Machine = old
    for key in applied:
        machine = _with(machine, key.split("."), after[key])
    return Reload(machine, tuple(applied), tuple(key for key in changed if key not in applied))


def reload_machine_file(
    path: Path, engine: EngineThread, units: Sequence[object], *, line_baud: int | None = None
) -> None:
    """Read a machine file again for running units (controllers or chains of them), and log what came of it.

    `line_baud` is the speed of the line that the command line has put over the file's.
    What is logged answers a signal that somebody has sent, so it is logged at the level that is always shown.
    """
    try:
        new = Machine.load(path).on_line(line_baud)
    except MachineError as error:
        _log.warning(event_line("machine file not used, all stays as it was", reason=error))
        return
    engine.call(lambda: take_over(units, new)).add_done_callback(partial(_report, path))


def take_over(units: Sequence[object], new: Machine) -> Reload:
    """Have running units take over what they can of another machine; on the engine thread."""
    controllers = [controller for unit in units for controller in _controllers(unit)]
    old = controllers[0].machine
    reload = compare(old, addressed(new, 1) if len(controllers) > 1 else new)
    for unit in units:
        if isinstance(unit, HearsOfMachines):
            unit.machine_changes(new)
    for controller in controllers:
        _apply(controller, old, reload)
    return reload


def _controllers(unit: object) -> Sequence[Controller]:
    return cast("Sequence[Controller]", getattr(unit, "controllers", (unit,)))


def _report(path: Path, done: Future[Reload]) -> None:
    if done.cancelled():
        return
    if (error := done.exception()) is not None:
        _log.error(event_line("machine file not used", file=path), exc_info=error)
        return
    applied, rest = (", ".join(keys) or "nothing" for keys in done.result()[1:])
    _log.warning(event_line("machine file re-read", file=path, applied=applied, needs_restart=rest))


def takes_effect(key: str) -> bool:
    """Whether a running unit takes over another value of a key; a plant is one key."""
    return _IN_PLACE.fullmatch(key) is not None


def _in_place(key: str, changed: list[str]) -> bool:
    """Input numbers mean other terminals while the file speaks of a unit with other inputs than this one has."""
    if key == "wires.inputs" and "io.inputs" in changed:
        return False
    return takes_effect(key)


def _with(table: Any, steps: list[str], value: Any) -> Any:
    name = next(field.name for field in msgspec.structs.fields(table) if field.encode_name == steps[0])
    inner = value if len(steps) == 1 else _with(getattr(table, name), steps[1:], value)
    return msgspec.structs.replace(table, **{name: inner})


def _apply(controller: Controller, old: Machine, reload: Reload) -> None:
    # Each unit of a chain has power-up settings of its own, which never change here.
    new = msgspec.structs.replace(reload.machine, defaults=controller.machine.defaults)
    controller.machine = new
    controller.framing = framing_in_force(controller)
    for key in reload.applied:
        if key.endswith(".plant"):
            axis_index = int(key[len("axis")]) - 1
            controller.engine.set_plant(axis_index, engine_plant(new.axes[axis_index].plant))
    for name, closed in _changed_contacts(controller, old, new):
        controller.wiring.set(name, closed=closed)
    for channel, (was, volts) in enumerate(zip(old.wires.analog, new.wires.analog, strict=True), start=1):
        if volts != was:
            controller.wiring.set_analog(channel, volts=volts)


def _changed_contacts(controller: Controller, old: Machine, new: Machine) -> Iterator[tuple[str, bool]]:
    """Wire names and their new states."""
    if new.wires.enable != old.wires.enable:
        yield "enable", new.wires.enable == "closed"
    for number, (was, axis) in enumerate(zip(old.axes, new.axes, strict=True), start=1):
        for key, value in keys_and_values(axis.wires):
            if value != getattr(was.wires, key):
                yield f"axis{number}.{key}", value == "closed"
    for number in sorted(set(old.wires.inputs) ^ set(new.wires.inputs)):
        yield controller.wiring.input_name(number), number in new.wires.inputs

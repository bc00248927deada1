"""Battery-backed memory: what of a unit survives power-off, taken out of it and put back into it.

Within one process a controller keeps these things by itself; a state file needs them as plain values. Whether
anything has changed is told by a counter that whatever stores a kept thing steps, so that nobody has to compare.

At power-up a real unit checks a checksum over this memory. If it is bad everything is cleared and SS bit 22 is set
(knowledge base, 6K); the bit stays until a power-up finds the memory good, RESET does not check (assumed L).
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from emulator.controller.motion.gain_sets import SavedGains, never_saved
from emulator.controller.scaling import Quantity
from emulator.controller.variables.store import Snapshot
from emulator.controller.wires.panel_commands import DEFAULT_PASSWORD
from emulator.state.contents import KEPT_SETTINGS, PASSWORD, Contents, GainValue
from emulator.state.sense import read_setting
from protocol.errors import INVALID_DATA, CommandError

if TYPE_CHECKING:
    from emulator.controller.controller import Controller


def collect(controller: Controller) -> Contents:
    """What the unit keeps, at this moment."""
    variables = controller.variables.snapshot()
    password = (PASSWORD, str(controller.panel_password))
    return Contents(
        settings=(*((key, controller.settings.kept_text(key)) for key in KEPT_SETTINGS), password),
        numbers=variables.numbers,
        bits=variables.bits,
        texts=variables.texts,
        programs=controller.programs.snapshot(),
        gains=_collect_gains(controller),
    )


def put_back(controller: Controller, contents: Contents) -> list[str]:
    """Put what was collected into a unit that is switched off; what this unit cannot hold, in words."""
    misfits = _put_back_settings(controller, contents.settings)
    controller.programs.capacity_bytes = controller.settings.integer("MEMORY")
    misfits += controller.programs.restore(contents.programs)
    misfits += _put_back_variables(controller, contents)
    _put_back_gains(controller, contents.gains)
    return misfits


def clear(controller: Controller) -> None:
    """Everything a unit keeps to what a new one has; the unit is switched off."""
    controller.settings.reset(keep=())
    controller.programs.erase()
    controller.variables.clear()
    controller.gain_sets.clear()
    controller.panel_password = DEFAULT_PASSWORD
    controller.changes.note()


def _put_back_settings(controller: Controller, settings: tuple[tuple[str, str], ...]) -> list[str]:
    misfits = []
    for key, text in settings:
        try:
            _put_back_setting(controller, key, text)
        except CommandError:
            misfits.append(f"{key}{text}")
    return misfits


def _put_back_setting(controller: Controller, key: str, text: str) -> None:
    if key == PASSWORD:
        controller.panel_password = int(text)
        return
    fields = read_setting(key, text)
    if key == "MEMORY" and sum(map(int, fields)) > controller.machine.memory.total_bytes:
        raise CommandError(INVALID_DATA)
    controller.settings.keep(key, fields)


def _put_back_variables(controller: Controller, contents: Contents) -> list[str]:
    kept = Snapshot(contents.numbers, contents.bits, contents.texts)
    controller.variables.restore(kept)
    room = controller.variables.snapshot()
    return [
        f"{name}{len(has) + 1} to {name}{len(wanted)}"
        for name, wanted, has in zip(("VAR", "VARB", "VARS"), kept, room, strict=True)
        if len(wanted) > len(has)
    ]


def _collect_gains(controller: Controller) -> tuple[GainValue, ...]:
    """Gain sets as one list of values, each under the feedback source it was saved under."""
    return tuple(
        GainValue(number, axis_index + 1, saved.source, name, quantity)
        for number, axes in controller.gain_sets.items()
        for axis_index, saved in enumerate(axes)
        for name, quantity in saved.values.items()
    )


def _put_back_gains(controller: Controller, gains: tuple[GainValue, ...]) -> None:
    """A set as it was saved; what the file lacks of one (an axis, a command) is as at power-up."""
    settings = controller.settings
    for number in sorted({gain.set_number for gain in gains}):
        sets = [never_saved() for _ in range(settings.axes)]
        for gain in gains:
            if gain.set_number == number and gain.axis <= settings.axes:
                value, factor = gain.value
                values = {**sets[gain.axis - 1].values, gain.command: Quantity(Decimal(value), factor)}
                sets[gain.axis - 1] = SavedGains(gain.feedback, values)
        controller.gain_sets[number] = sets

"""`oem6250 check MACHINE.toml ...`: whether machine files can be used, and what unit each would make."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from emulator.machine import Axis, Machine, MachineError
from emulator.machine_keys import differing_keys


def check_files(paths: Sequence[str]) -> int:
    """One line a file: what it would be on stdout, or what is wrong with it on stderr. 2 if any is wrong, else 0."""
    status = 0
    for path in paths:
        try:
            machine = Machine.load(path)
        except MachineError as error:
            print(f"oem6250: {error}", file=sys.stderr)
            status = 2
        else:
            print(f"{path}: {describe(machine)}")
    return status


def describe(machine: Machine) -> str:
    """A machine in one line: axes with drive and encoder, inputs and outputs, options, wiring, what was changed."""
    parts = [_axis(number, axis) for number, axis in enumerate(machine.axes, start=1)]
    parts.append(f"{machine.io.inputs} inputs, {machine.io.outputs} outputs")
    parts += _options(machine)
    parts.append("wired" if machine.wiring == "full" else "bare")
    changed = len(differing_keys(Machine.default(), machine))
    parts.append(f"{changed} {'key differs' if changed == 1 else 'keys differ'} from the default machine")
    return "; ".join(parts)


def _axis(number: int, axis: Axis) -> str:
    kind = str(axis.plant.__struct_config__.tag).replace("_", " ")
    return f"axis {number}: {kind}, {axis.encoder.counts_per_rev} counts/rev"


def _options(machine: Machine) -> list[str]:
    fitted = {
        "Following": machine.options.following,
        "ANI": machine.options.ani,
        "expanded memory": machine.options.expanded_memory,
        "RP240": machine.rp240.fitted,
    }
    return [name for name, is_fitted in fitted.items() if is_fitted]

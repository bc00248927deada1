"""The machine of a test, however it is given."""

from __future__ import annotations

from pathlib import Path

from emulator.machine import Machine


def machine_of(given: Machine | str | Path | None) -> Machine:
    """A Machine, the text of a machine file, or its path; None is the default machine.

    Text that holds a line break, ``=`` or ``[`` is a machine file's, other text a path.

    Raises:
        MachineError: it cannot be used.
    """
    if given is None:
        return Machine.default()
    if isinstance(given, Machine):
        return given
    if isinstance(given, str) and (not given or set(given) & set("\n=[")):
        return Machine.parse(given, name="machine of the test")
    return Machine.load(given)

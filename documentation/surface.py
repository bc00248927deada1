"""The control surface reference: what can be read and done from outside the wire, from the registry."""

from __future__ import annotations

from typing import Final

from documentation.markdown import code, page, plain, table
from emulator.emulator import Emulator
from emulator.faults import FAULTS
from emulator.parameters import Parameter
from emulator.registry import ACTIONS, describe_signals

_FAULT_ACTIONS: Final = ("fault_", "lift_")


def reference() -> str:
    """Signals, actions and faults of a default unit."""
    signals = describe_signals(Emulator().unit().controller).values()
    actions = [action for action in ACTIONS.values() if not action.name.startswith(_FAULT_ACTIONS)]
    return page(
        "Signals, actions, faults",
        "Made from the control registry: the one list behind `unit.signals`, `unit.do`, the scope, the fixtures and "
        "recordings. What begins with `axis1` is there for `axis2` as well.",
        "## Signals",
        table(
            ("name", "what", "unit", "at servo rate"),
            [
                (code(each.name), plain(each.sentence), plain(each.unit), "yes" if each.source else "")
                for each in signals
                if "axis2" not in each.name
            ],
        ),
        "## Actions",
        table(
            ("name", "what", "parameters"),
            [(code(each.name), plain(each.sentence), _parameters(each.parameters)) for each in actions],
        ),
        "## Faults",
        "`unit.faults.NAME(...)`, see [testing](../testing.md#faults).",
        table(
            ("name", "what", "parameters", "what the unit shows"),
            [
                (code(each.name), plain(each.sentence), _parameters(each.parameters), plain(each.shows))
                for each in FAULTS.values()
            ],
        ),
    )


def _parameters(parameters: tuple[Parameter, ...]) -> str:
    return "; ".join(f"{code(each.name)}: {plain(each.sentence)}" for each in parameters)

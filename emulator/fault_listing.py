"""`oem6250 faults`: what can be made to go wrong, with parameters and what the unit shows of it."""

from __future__ import annotations

import argparse
from textwrap import fill
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from emulator.faults.fault import Fault
    from emulator.parameters import Parameter

WIDTH = 100


def add_faults(commands: Any) -> None:
    """The command's arguments."""
    faults = commands.add_parser(
        "faults",
        description="Every fault of the control surface: unit.faults.NAME(...) in Python and in the pytest fixtures.",
        allow_abbrev=False,
    )
    faults.set_defaults(carry_out=_do_faults)


def _do_faults(parsed: argparse.Namespace) -> int:
    """Print the list."""
    from emulator.faults import FAULTS

    print("\n\n".join(describe(fault) for fault in FAULTS.values()))
    return 0


def describe(fault: Fault) -> str:
    """A fault in a few lines."""
    once = "" if fault.lasting else "  (happens once)"
    lines = [
        f"{fault.name}({', '.join(each.name for each in fault.parameters)}){once}",
        _paragraph(fault.sentence),
        *(_paragraph(_parameter(each), indent=6) for each in fault.parameters),
        _paragraph(f"shows: {fault.shows}"),
        _paragraph(f"counts: {fault.counts}"),
    ]
    return "\n".join(lines)


def _parameter(parameter: Parameter) -> str:
    unit = f", {parameter.unit}" if parameter.unit not in ("", "1") else ""
    usual = "" if parameter.default is None else f" (default {parameter.default})"
    return f"{parameter.name}: {parameter.sentence}{unit}{usual}"


def _paragraph(text: str, indent: int = 2) -> str:
    return fill(text, WIDTH, initial_indent=" " * indent, subsequent_indent=" " * (indent + 2))

"""The `[defaults]` table of a machine file: power-up settings, by command name.

A real unit's power-up values are known only in part, and a site may want to start from its own.
Any setting of the catalogue can be overridden with what a host would send after the name: `ECHO = 0`,
`LH = [0, 3]`, `DRIVE = "10"`. They are checked here with the language's own rules, so that a bad one is
found in the file and not when the unit starts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from decimal import Decimal
from difflib import get_close_matches
from typing import Any, Final

from emulator.machine_errors import MachineError, nearest
from emulator.table_fields import Provenance
from protocol.catalogue import CommandRow, commands, rows
from protocol.command import parse_command
from protocol.errors import INVALID_DATA, CommandError
from protocol.fields import checked_number, place_mask, place_values, range_of
from protocol.masters import check_masters, read_master

DEFAULT_SETTINGS: Final[dict[str, tuple[str, Provenance, str, str]]] = {
    "ECHO": ("1", "assumed", "H", ""),
    "ERRLVL": ("4", "assumed", "H", ""),
    "COMEXC": ("0", "assumed", "H", ""),
    "COMEXL": ("00", "assumed", "M", ""),
    "LH": ("3,3", "assumed", "H", ""),
    "LS": ("0,0", "assumed", "H", ""),
    "DRIVE": ("00", "assumed", "H", ""),
    "INDAX": ("2", "assumed", "H", ""),
    "SSFR": ("4", "documented", "", "OEM6250 Installation Guide 47"),
    "SFB": ("1,1", "assumed", "M", ""),
    "INFEN": ("0", "assumed", "M", ""),
    "FPPEN": ("11", "documented", "", "PG 214"),
}
"""Power-up settings the reference settles: command -> (field text, provenance, confidence, source)."""

AXES: Final = 2
_COMMAND: Final = re.compile(r"[A-Z]+")


def usual_settings() -> dict[str, str]:
    """The `[defaults]` of an empty file."""
    return {command: setting[0] for command, setting in DEFAULT_SETTINGS.items()}


def merged_settings(raw: Any, *, file: str) -> dict[str, str]:
    """The usual settings with those of the table `raw` over them, in the order they are to be entered.

    INDAX comes last: with one axis in use the second field of the others would be refused.
    """
    merged = usual_settings() | read_settings(raw, file=file)
    merged["INDAX"] = merged.pop("INDAX")
    return merged


def check_command_name(name: str, *, table: str, file: str) -> None:
    """MachineError, naming the nearest, for what is not the name of a command of this unit."""
    names = [row.name for row in rows() if row.kind not in ("operator", "operand") and row.applies_to_oem6250]
    if name in names:
        return
    close = get_close_matches(name.upper(), names, n=1)
    hint = f" (did you mean {close[0]}?)" if close else ""
    allowed = f"the name of a command, in capitals, without an axis number{hint}"
    raise MachineError(file=file, key=f"{table}.{name}", found=repr(name), allowed=allowed)


def read_settings(raw: Any, *, file: str) -> dict[str, str]:
    """The table `raw` as command -> field text; MachineError for what no host could set."""
    if not isinstance(raw, dict):
        raise MachineError(file=file, key="defaults", found=repr(raw), allowed="a table")
    return {key: _checked(key, value, file=file) for key, value in raw.items()}


def _checked(key: str, value: Any, *, file: str) -> str:
    row = commands().get(key) if _COMMAND.fullmatch(key) else None
    if row is None or row.kind != "setting":
        allowed = "the name of a command that is a setting, in capitals, without an axis number"
        settings = (name for name, other in commands().items() if other.kind == "setting")
        if close := nearest(key.upper(), settings):
            allowed += f" (did you mean {close}?)"
        raise MachineError(file=file, key=f"defaults.{key}", found=repr(key), allowed=allowed)
    text = _field_text(key, value, file=file)
    try:
        _check(row, key, text)
    except CommandError as error:
        allowed = f"fields as in {row.syntax} ({error.text})"
        raise MachineError(file=file, key=f"defaults.{key}", found=repr(value), allowed=allowed) from None
    return text


def _check(row: CommandRow, name: str, text: str) -> None:
    command = parse_command(name + text)
    if command.row is not row:
        raise CommandError(INVALID_DATA)
    if not command.argument:
        raise CommandError("a value is needed")
    if row.fields.type == "binary":
        place_mask(command, AXES if row.fields.per_axis else row.fields.count)
    if row.fields.type in ("real", "int"):
        values = place_values(command, AXES if row.fields.per_axis else row.fields.count)
        for field, value in enumerate(values, start=1):
            if value is not None:
                checked_number(value, range_of(row), field=field, fields=row.fields.count)


def _field_text(key: str, value: Any, *, file: str) -> str:
    if isinstance(value, list) and value and all(_is_scalar(item) for item in value):
        return ",".join(_scalar_text(item) for item in value)
    if _is_scalar(value):
        return _scalar_text(value)
    allowed = "a number, a text, or a list of them, one an axis"
    raise MachineError(file=file, key=f"defaults.{key}", found=repr(value), allowed=allowed)


def _is_scalar(value: Any) -> bool:
    return isinstance(value, str | int | float)


def _scalar_text(value: str | int | float) -> str:
    return str(int(value)) if isinstance(value, bool) else str(value)


def master_conflicts(settings: Mapping[str, str], *, ani_fitted: bool) -> list[tuple[str, str, str]]:
    """What is wrong with FOLMAS of `[defaults]` given SFB there: key, what was found, what is allowed."""
    if "FOLMAS" not in settings:
        return []
    feedback = _whole_fields("SFB", settings["SFB"])
    try:
        wanted = _whole_fields("FOLMAS", settings["FOLMAS"])
        check_masters([read_master(value, axes=AXES, ani_fitted=ani_fitted) for value in wanted], feedback)
    except CommandError:
        allowed = "sign, axis of the master, 1 encoder, 2 ANI (option) or 4 commanded position; not what is its own"
        return [("defaults.FOLMAS", repr(settings["FOLMAS"]), allowed)]
    return []


def _whole_fields(name: str, text: str) -> list[int]:
    """The fields of a setting as whole numbers, 0 for what is not given."""
    values = place_values(parse_command(name + text), AXES)
    return [int(value) if isinstance(value, Decimal) else 0 for value in values]

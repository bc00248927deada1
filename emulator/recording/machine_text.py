"""A machine as the text of a machine file, for sessions whose machine did not come from a file.

Only what differs from the default machine is written. TOML because that is what a machine file is; the standard
library reads it but does not write it, and the few shapes a machine has need no library.
"""

from __future__ import annotations

import json
import math
import re
from typing import Any

import msgspec

from emulator.machine import Machine

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_SETTINGS = "defaults"
"""The one table whose keys are merged with the default machine's; others are written whole."""


def machine_text(machine: Machine) -> str:
    """The shortest plain machine file that `Machine.parse` reads as `machine`.

    Raises:
        ValueError: there is none (a machine put together in a way no file can say).
    """
    built, usual = msgspec.to_builtins(machine), msgspec.to_builtins(Machine.default())
    different = {name: value for name, value in built.items() if value != usual[name]}
    if _SETTINGS in different:
        settings = usual[_SETTINGS]
        different[_SETTINGS] = {key: text for key, text in built[_SETTINGS].items() if settings.get(key) != text}
    text = _document(different)
    if Machine.parse(text) != machine:
        raise ValueError("this machine cannot be written as a machine file, so it cannot be recorded")
    return text


def _document(tables: dict[str, Any]) -> str:
    lines = [f"{toml_key(name)} = {toml_value(value)}" for name, value in tables.items() if not isinstance(value, dict)]
    for name, value in tables.items():
        if isinstance(value, dict):
            lines += [
                f"[{toml_key(name)}]",
                *(f"{toml_key(key)} = {toml_value(inner)}" for key, inner in value.items()),
            ]
    return "".join(f"{line}\n" for line in lines)


def toml_key(name: str) -> str:
    """A key as TOML writes it."""
    return name if _BARE_KEY.fullmatch(name) else _string(name)


def toml_value(value: Any) -> str:
    """A plain value (numbers, texts, lists and dicts of them) as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml_key(key)} = {toml_value(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(inner) for inner in value) + "]"
    return repr(value) if isinstance(value, int) or math.isfinite(value) else str(value)


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")

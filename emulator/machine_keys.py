"""The keys of a machine, as they are written in a machine file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec


def keys_and_values(table: msgspec.Struct, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every dotted key with its value. A plant is one value, since its keys depend on its kind."""
    for field in msgspec.structs.fields(table):
        value, key = getattr(table, field.name), path + field.encode_name
        if isinstance(value, msgspec.Struct) and field.name != "plant":
            yield from keys_and_values(value, key + ".")
        else:
            yield key, value


def differing_keys(old: msgspec.Struct, new: msgspec.Struct) -> list[str]:
    """The keys in which two machines differ, in the order of the tables."""
    before = dict(keys_and_values(old))
    return [key for key, value in keys_and_values(new) if value != before[key]]

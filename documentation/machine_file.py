"""The machine file reference: every key of every table, from the annotations that also check the file."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import msgspec
from msgspec import inspect

from documentation.markdown import anchor, code, page, plain, table
from emulator.fidelity import NOT_YET, WORDS
from emulator.machine import Machine
from emulator.plant_tables import PRESETS
from emulator.recording.machine_text import toml_key, toml_value
from emulator.reload import takes_effect

TOP: Final = "the top of the file"
_ALIKE: Final = frozenset(f"axis{number}" for number in range(2, 9))
"""Tables with the keys of `axis1`."""
_OTHER_AXES: Final = " `[axis2...]`, and of an RMC `[axis3...]` to `[axis8...]`, have the same keys."


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a table: what may be written behind it, and what is known of it."""

    name: str
    path: str
    type: str
    range: str
    default: Any
    what: str
    known: str
    at_reload: bool


@dataclass(frozen=True, slots=True)
class TableOfKeys:
    """One table of the machine file with its keys in the order of the file; `path` is dotted, empty at the top."""

    path: str
    what: str
    keys: tuple[Key, ...]
    kind: str = ""


def reference() -> str:
    """The whole page."""
    return page("Machine file reference", _INTRODUCTION, *(_section(each) for each in tables()), _presets())


_INTRODUCTION: Final = """\
Made from the schema that checks the file. What the tables are for: [the machine file](../machine-file.md).
A key that is not given has its default, so an empty file is a complete machine. *Known* says how sure we are that the
default is what the unit does; a design choice is no claim about the unit, but what is connected to it. A key marked
*reload* takes effect in a running server when the file is
[read again](../hosting.md#when-the-machine-file-changes-sighup)."""


def tables() -> list[TableOfKeys]:
    """Every table of the file, of the axes only the first (the others are as it is); one for each kind of a table."""
    return list(_tables(Machine.default(), "", "what is true of the whole unit"))


def example(each: TableOfKeys) -> str:
    """The table as it would be written in a machine file, every key with its default, if it has one."""
    lines = [f"[{each.path}]"] if each.path else []
    lines += [f'kind = "{each.kind}"'] if each.kind else []
    lines += [_assignment(key) for key in each.keys if key.default is not None]
    return "".join(f"{line}\n" for line in lines)


def _assignment(key: Key) -> str:
    return f"{toml_key(key.name)} = {toml_value(msgspec.to_builtins(key.default))}"


def _tables(value: msgspec.Struct, path: str, what: str) -> Iterator[TableOfKeys]:
    """A table and those within it, depth first."""
    info = inspect.type_info(type(value))
    assert isinstance(info, inspect.StructType)
    prefix = f"{path}." if path else ""
    if keys := _keys(value, prefix):
        yield TableOfKeys(path, what, keys)
    for field in info.fields:
        inner, inner_path = getattr(value, field.name), prefix + field.encode_name
        if kinds := _kinds(field.type):
            yield from (_of_kind(each, inner_path, _about(field.type)[0]) for each in kinds)
        elif isinstance(inner, msgspec.Struct) and field.name not in _ALIKE:
            yield from _tables(inner, inner_path, _about(field.type)[0])


def _kinds(node: inspect.Type) -> list[inspect.StructType]:
    """The tables a field may hold, where its `kind` says which; none for other fields."""
    node = _bare(node)
    members = node.types if isinstance(node, inspect.UnionType) else ()
    return [each for each in members if isinstance(each, inspect.StructType) and each.tag is not None]


def _of_kind(node: inspect.StructType, path: str, what: str) -> TableOfKeys:
    kind = str(node.tag)
    return TableOfKeys(path, f"{what}: {kind.replace('_', ' ')}", _keys(node.cls(), f"{path}."), kind)


def _keys(value: msgspec.Struct, prefix: str) -> tuple[Key, ...]:
    info = inspect.type_info(type(value))
    assert isinstance(info, inspect.StructType)
    return tuple(
        _key(field, getattr(value, field.name), prefix)
        for field in info.fields
        if not isinstance(getattr(value, field.name), msgspec.Struct) and not _kinds(field.type)
    )


def _key(field: inspect.Field, default: Any, prefix: str) -> Key:
    what, known = _about(field.type)
    node = field.type.type if isinstance(field.type, inspect.Metadata) else field.type
    path = prefix + field.encode_name
    return Key(field.encode_name, path, type_name(node), range_text(node), default, what, known, _at_reload(path))


def _at_reload(path: str) -> bool:
    found = re.match(r"axis[12]\.plant", path)
    return takes_effect(found[0] if found else path)


def _about(node: inspect.Type) -> tuple[str, str]:
    """What a field is, and how that is known."""
    if not isinstance(node, inspect.Metadata):
        return "", ""
    extra, schema = node.extra or {}, node.extra_json_schema or {}
    sure = f" ({extra['confidence']})" if extra.get("confidence") else ""
    source = f": {extra['source']}" if extra.get("source") else ""
    what = str(schema.get("description", "")) + ("" if extra.get("acts", True) else NOT_YET)
    return what, WORDS.get(str(extra.get("provenance")), "") + sure + source


def type_name(node: inspect.Type) -> str:
    """A type in the words of TOML."""
    node = _bare(node)
    match node:
        case inspect.DictType():
            return f"table of {type_name(node.value_type)}s by name"
        case inspect.VarTupleType():
            return f"list of {type_name(node.item_type)}s"
        case inspect.TupleType():
            return f"list of {len(node.item_types)} {type_name(node.item_types[0])}s"
        case inspect.UnionType():
            return " or ".join(map(type_name, node.types))
    return _WORDS[type(node)]


_WORDS: Final[Mapping[type[inspect.Type], str]] = {
    inspect.BoolType: "true or false",
    inspect.IntType: "whole number",
    inspect.FloatType: "number",
    inspect.StrType: "text",
    inspect.LiteralType: "one of",
    inspect.StructType: "table",
    inspect.NoneType: "nothing",
}


def range_text(node: inspect.Type) -> str:
    """What of its type a value may be, as far as the schema of the key itself says."""
    node = _bare(node)
    match node:
        case inspect.LiteralType():
            return ", ".join(map(_literal, node.values))
        case inspect.IntType() | inspect.FloatType():
            return _number_range(node)
        case inspect.VarTupleType() | inspect.TupleType():
            return "; ".join(part for part in (_length(node), _of_items(node)) if part)
        case inspect.DictType():
            inner = range_text(node.value_type)
            return f"each {inner}" if inner else ""
    return ""


def _bare(node: inspect.Type) -> inspect.Type:
    return _bare(node.type) if isinstance(node, inspect.Metadata) else node


def _literal(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value)


def _number_range(node: inspect.IntType | inspect.FloatType) -> str:
    limits = ((">=", node.ge), (">", node.gt), ("<=", node.le), ("<", node.lt))
    said = [f"{sign} {limit:,.10g}" for sign, limit in limits if limit is not None]
    if isinstance(node, inspect.IntType) and node.multiple_of is not None:
        said.append(f"a multiple of {node.multiple_of}")
    return ", ".join(said)


def _length(node: inspect.VarTupleType | inspect.TupleType) -> str:
    if isinstance(node, inspect.TupleType):
        return ""
    least, most = node.min_length, node.max_length
    if least is not None and least == most:
        return f"{least} of them"
    return f"at least {least}" if least else ""


def _of_items(node: inspect.VarTupleType | inspect.TupleType) -> str:
    item = _bare(node.item_type if isinstance(node, inspect.VarTupleType) else node.item_types[0])
    if isinstance(item, inspect.StructType):
        return "; ".join(f"{field.encode_name} {range_text(field.type)}" for field in item.fields)
    inner = range_text(item)
    return f"each {inner}" if inner else ""


def _section(each: TableOfKeys) -> str:
    head = ("key", "type", "range", "default", "what", "known")
    title = code(f"[{each.path}]") if each.path else TOP.capitalize()
    title += f", kind {code(each.kind)}" if each.kind else ""
    label = anchor(f"machine-{each.path.replace('.', '-') or 'top'}{'-' + each.kind if each.kind else ''}")
    axis = (
        " `[axis2...]`, and of an RMC `[axis3...]` to `[axis8...]`, have the same keys."
        if each.path.startswith("axis1")
        else ""
    )
    return "\n\n".join(
        [
            f"{label}## {title}",
            f"{plain(each.what[:1].upper() + each.what[1:])}.{axis}",
            table(head, map(_row, each.keys)).strip(),
            f"```toml\n{example(each)}```",
        ]
    )


def _row(key: Key) -> tuple[str, ...]:
    what = plain(key.what) + (" *(reload)*" if key.at_reload else "")
    return code(key.name), key.type, code(key.range), code(_shown(key.default)), what, plain(key.known)


def _shown(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and math.isfinite(value) and value == int(value) and abs(value) >= 1e6:
        return f"{value:,.0f}"
    return toml_value(msgspec.to_builtins(value))


def _presets() -> str:
    head = "## Presets of `[axis1.plant]`\n\n`preset` names one; keys given beside it win. All are design choices."
    rows = [
        (code(name), code(kind), ", ".join(code(f"{key} = {toml_value(value)}") for key, value in values.items()))
        for kind, presets in PRESETS.items()
        for name, values in presets.items()
    ]
    return f"{head}\n\n{table(('preset', 'kind', 'gives'), rows)}"

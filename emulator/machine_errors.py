"""One line for everything that can be wrong in a machine file.

msgspec says *where* and roughly *what*; a person editing a file also wants to see what was found
there and what would have been accepted. This module turns msgspec's path into a dotted key, looks
up the value in the raw data and the allowed values in the type.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from difflib import get_close_matches
from typing import Any

import msgspec
from msgspec import inspect

_UNKNOWN = re.compile(r"unknown field `([^`]*)`")
_MISSING = re.compile(r"missing required field `([^`]*)`")
_PATH = re.compile(r" - at `(?:key in )?\$([^`]*)`$")
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+|\.\.\.)\]")


class MachineError(ValueError):
    """A machine file that cannot be used; `str()` is one line naming file, key, what was found, what is allowed."""

    def __init__(self, *, file: str, key: str, found: str, allowed: str) -> None:
        self.file, self.key, self.found, self.allowed = file, key, found, allowed
        where = f"{file}: {key}: " if key else f"{file}: "
        super().__init__(" ".join(f"{where}found {found}; allowed: {allowed}".split()))


def explain(error: msgspec.ValidationError, *, raw: dict[str, Any], model: type, file: str) -> MachineError:
    """The `MachineError` for msgspec's complaint about `raw` read as `model`."""
    text = str(error)
    steps = _steps(text)
    missing, unknown = _MISSING.search(text), _UNKNOWN.search(text)
    node = _descend(inspect.type_info(model), raw, steps)
    if unknown:
        key, allowed = [*steps, unknown[1]], _keys(node, [*steps, unknown[1]], inspect.type_info(model))
        return MachineError(file=file, key=_dotted(key), found=_show(_value(raw, key)), allowed=allowed)
    if missing:
        child = _descend(node, _value(raw, steps), [missing[1]])
        return MachineError(file=file, key=_dotted([*steps, missing[1]]), found="nothing", allowed=_allowed(child))
    return MachineError(file=file, key=_dotted(steps), found=_show(_value(raw, steps)), allowed=_allowed(node))


def _steps(text: str) -> list[str]:
    path = _PATH.search(text)
    steps = [name or index for name, index in _STEP.findall(path[1])] if path else []
    return steps[: steps.index("...")] if "..." in steps else steps


def _dotted(steps: list[str]) -> str:
    return ".".join(steps)


def _value(raw: Any, steps: list[str]) -> Any:
    for step in steps:
        if isinstance(raw, list):
            raw = raw[int(step)]
        elif isinstance(raw, dict):
            raw = raw.get(step)
    return raw


def _show(value: Any) -> str:
    if isinstance(value, dict):
        return "a table"
    text = {True: "true", False: "false"}[value] if isinstance(value, bool) else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _descend(node: Any, raw: Any, steps: list[str]) -> Any:
    for step in steps:
        node = _child(_settled(node, raw), step)
        raw = _value(raw, [step])
    return _settled(node, raw)


def _settled(node: Any, raw: Any) -> Any:
    node = _bare(node)
    return _member(node, raw) if isinstance(node, inspect.UnionType) else node


def _bare(node: Any) -> Any:
    return node.type if isinstance(node, inspect.Metadata) else node


def _child(node: Any, step: str) -> Any:
    if isinstance(node, inspect.StructType):
        return next((f.type for f in node.fields if f.encode_name == step), inspect.LiteralType(_tags(node)))
    if isinstance(node, inspect.TupleType):
        return node.item_types[int(step)]
    return getattr(node, "item_type", node)


def _member(union: Any, raw: Any) -> Any:
    kind = raw.get("kind") if isinstance(raw, dict) else None
    structs = [_bare(member) for member in union.types]
    found = [member for member in structs if getattr(member, "tag", None) == kind]
    return found[0] if found else _Kinds(structs)


class _Kinds:
    """A union of tagged tables whose tag is missing or wrong: only the tags can be offered."""

    def __init__(self, structs: list[Any]) -> None:
        self.tags = tuple(str(struct.tag) for struct in structs)
        self.item_type = inspect.LiteralType(self.tags)


def _tags(node: Any) -> tuple[str, ...]:
    return (str(node.tag),) if node.tag else ()


def _keys(node: Any, steps: list[str], top: Any) -> str:
    names = [field.encode_name for field in getattr(node, "fields", ())]
    close = nearest(steps[-1], names) or _elsewhere(steps, top)
    listed = "keys " + ", ".join(names) if names else "no keys besides kind"
    return f"{listed} (did you mean {close}?)" if close else listed


def nearest(wrong: str, names: Iterable[str]) -> str | None:
    """The one of some names that somebody may have meant, if any looks like it."""
    close = get_close_matches(wrong, names, n=1)
    return close[0] if close else None


def _elsewhere(steps: list[str], top: Any) -> str | None:
    """The dotted key of a key that belongs into another table; of the same axis, if there are several."""
    own = _dotted(steps)
    found = [path for path in _paths(top) if path.rpartition(".")[2] == steps[-1] and path != own]
    return next((path for path in found if path.startswith(steps[0] + ".")), found[0] if found else None)


def _paths(node: Any, path: str = "") -> Iterator[str]:
    node = _bare(node)
    for member in node.types if isinstance(node, inspect.UnionType) else (node,):
        for field in getattr(_bare(member), "fields", ()):
            yield path + field.encode_name
            yield from _paths(field.type, path + field.encode_name + ".")


def _allowed(node: Any) -> str:
    for kind, words in _WORDS:
        if isinstance(node, kind):
            return words(node)
    return "a table"


def _list(node: Any) -> str:
    if isinstance(node, inspect.TupleType):
        return f"a list of {len(node.item_types)}: " + _allowed(_bare(node.item_types[0]))
    return "a list" + _length(node) + ", each " + _allowed(_bare(node.item_type))


def _range(node: Any) -> str:
    bounds = [(node.ge, ">="), (node.gt, ">"), (node.le, "<="), (node.lt, "<")]
    said = [f"{sign} {value:,}" for value, sign in bounds if value is not None]
    said += [f"a multiple of {node.multiple_of}"] if node.multiple_of else []
    return " " + " and ".join(said) if said else ""


def _length(node: Any) -> str:
    low, high = node.min_length, node.max_length
    if low and low == high:
        return f" of {low}"
    return f" of at least {low}" if low else ""


_WORDS: list[tuple[Any, Callable[[Any], str]]] = [
    (inspect.BoolType, lambda _: "true or false"),
    (inspect.LiteralType, lambda node: " or ".join(_show(value) for value in node.values)),
    (inspect.IntType, lambda node: "a whole number" + _range(node)),
    (inspect.FloatType, lambda node: "a number" + _range(node)),
    (inspect.StrType, lambda node: "a text" + (f" of the form {node.pattern}" if node.pattern else "")),
    (inspect.TupleType | inspect.VarTupleType, _list),
    (inspect.DictType, lambda node: "a table, each value " + _allowed(_bare(node.value_type))),
]
